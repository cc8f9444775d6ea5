"""Text and tables of the chapter on operating poses: poses under forces, and their effects."""

from collections.abc import Mapping
from operator import itemgetter

import pandas as pd

from facegear.number_format import begin_with_capital, format_number
from facegear.report.table import Table

MESHES = (
    "Where contacts run under the mean torques: paths along the pinion, unloaded, and loaded where the "
    "machine puts it and as assembled; to inner and outer end: from the unloaded path to the ends of the "
    "face; by pose: change at the mesh's own load"
)
"""Caption of the table of meshes."""
POSE_COLUMNS = (
    *("mesh", "force_n", "unloaded_path_mm", "path_mm", "path_as_assembled_mm"),
    *("to_inner_end_mm", "to_outer_end_mm"),
    *("stiffness_by_pose_percent", "pressure_by_pose_percent", "face_gear_root_by_pose_percent"),
)
"""Columns of the table of meshes."""
POSE = (
    "Every mesh in full. offset, axial shift, shaft angle: errors of assembly that the motions of both "
    "bodies amount to; outward: shift of the pinion along its axis; closing: what the flanks close "
    "beyond the deflection of the mesh"
)
"""Caption of the table of poses."""
FORCE_TOLERANCE = 1e-6
"""Change of a mesh force over the largest one to which poses and forces are iterated."""
LEAVING_COLUMNS = (
    "Loads, as a fraction of the mean torques, at which the unloaded contact of a mesh crosses an end "
    "of the face"
)
"""Caption of the table of contacts that leave the face."""
EDGES = (
    "Distance of the contact pattern of every mesh, as it runs, to both ends of the face, to the tips of "
    "pinion and gear, and to the radii where undercut begins and tips are pointed"
)
"""Caption of the table of distances to edges."""
STRESS = (
    "Pressure and root stress of every mesh at its own torque, from contact solved where the machine's own "
    "forces put its teeth, and as assembled"
)
"""Caption of the table of stress at the pose."""
PATTERN = "pattern_to_"
"""Beginning of the names of columns with distances of the contact pattern to edges."""
CHECK = "The surface beside the contact solved directly, for the mesh that its pose changes most"
"""Caption of the table that compares the surface with direct solutions."""
CHANGE_COLUMNS = {
    "stiffness_by_pose_percent": "stiffness",
    "pressure_by_pose_percent": "pressure",
    "face_gear_root_by_pose_percent": "root stress of the face gear",
}
"""Columns of what poses change, in words."""


def pose_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Return poses of all meshes, contacts that leave the face, and the surface's error.

    Parameters
    ----------
    tables : Mapping[str, pd.DataFrame]
        Tables of the report by name: `poses_meshes`, `poses_leaving`, `poses_check`, `posed_stress`.

    Returns
    -------
    list[Table]
        Four to six tables with captions; none without `poses_meshes`.
    """
    if "poses_meshes" not in tables:
        return []
    meshes, leaving_contacts = tables["poses_meshes"], tables["poses_leaving"]
    edges = [name for name in meshes.columns if name.startswith(PATTERN)]
    return [
        Table(MESHES, meshes[[name for name in POSE_COLUMNS if name in meshes]], 4),
        *([Table(EDGES, meshes[["mesh", *edges]], 4)] if edges else []),
        *([Table(STRESS, tables["posed_stress"], 4)] if "posed_stress" in tables else []),
        *([Table(LEAVING_COLUMNS, leaving_contacts, 4)] if len(leaving_contacts) else []),
        Table(POSE, meshes.drop(columns=edges), is_folded=True),
        Table(CHECK, tables["poses_check"], is_folded=True),
    ]


def pose_text(tables: Mapping[str, pd.DataFrame]) -> str:
    """Write a paragraph on the computed poses.

    Parameters
    ----------
    tables : Mapping[str, pd.DataFrame]
        Tables of the report by name: `poses_meshes`, `poses_leaving`, `poses_loads`.

    Returns
    -------
    str
        The paragraph; empty without poses.
    """
    if "poses_meshes" not in tables:
        return ""
    meshes = tables["poses_meshes"]
    loaded_meshes = meshes[meshes["path_mm"].notna()]
    parts = [
        *_path(loaded_meshes),
        _pattern(loaded_meshes),
        _changes(loaded_meshes),
        _force(meshes),
        _ends(tables),
    ]
    return " ".join(part for part in parts if part)


def _path(loaded_meshes: pd.DataFrame) -> list[str]:
    """Return two sentences: which loaded contact path moves furthest between `path_as_assembled_mm` and
    `path_mm`, and which unloaded path is nearest to an end of the face. `loaded_meshes`: rows with a
    path_mm.
    """
    if loaded_meshes.empty:
        return ["No mesh carries load."]
    shift = loaded_meshes["path_mm"] - loaded_meshes["path_as_assembled_mm"]
    mesh = loaded_meshes.loc[shift.abs().idxmax()]
    ends = loaded_meshes[["to_inner_end_mm", "to_outer_end_mm"]]
    near = loaded_meshes.loc[ends.min(axis=1).idxmin()]
    end, margin = min(
        ("inner", near["to_inner_end_mm"]), ("outer", near["to_outer_end_mm"]), key=itemgetter(1)
    )
    nearest = f"The unloaded contact of {near['mesh']}"
    distance = format_number(abs(margin), 2)
    left = (
        f"{nearest} comes nearest to an end of the face: {distance} mm are left to the {end} one."
        if margin >= 0.0
        else f"{nearest} lies {distance} mm beyond the {end} end of the face."
    )
    before, after = (
        format_number(mesh["path_as_assembled_mm"], 4),
        format_number(mesh["path_mm"], 4),
    )
    moves = (
        f"The loaded contact of {mesh['mesh']} moves furthest, from {before} mm as assembled to {after} mm"
    )
    return [f"{moves} as the machine runs.", left]


def _pattern(loaded_meshes: pd.DataFrame) -> str:
    """Say at which ends of the face the loaded pattern ends, and how far it stays from tips, mm. Empty
    without the columns `pattern_to_..._mm` (distances, 0 or less at the edge).
    """
    if f"{PATTERN}inner_end_mm" not in loaded_meshes or loaded_meshes.empty:
        return ""
    sentences = []
    for end in ("inner", "outer"):
        left = loaded_meshes[f"{PATTERN}{end}_end_mm"]
        meshes_at_edge = loaded_meshes.loc[left <= 0.0, "mesh"].to_list()
        if meshes_at_edge:
            names = "every mesh" if len(meshes_at_edge) == len(loaded_meshes) else ", ".join(meshes_at_edge)
            sentences.append(f"the loaded pattern of {names} reaches the {end} end of the face")
        else:
            sentences.append(f"{format_number(left.min(), 2)} mm of the face stay free at its {end} end")
    for tip in ("pinion", "gear"):
        left = loaded_meshes[f"{PATTERN}{tip}_tip_mm"]
        if left.min() > 0.0:
            sentences.append(f"the pattern stays {format_number(left.min(), 2)} mm from the tip of the {tip}")
    text = "; ".join(sentences)
    return f"{begin_with_capital(text)}."


def _changes(loaded_meshes: pd.DataFrame) -> str:
    """Return smallest and largest change (%) of stiffness, pressure and root stress by the pose, over
    all loaded meshes; empty without loaded meshes. Columns: keys of CHANGE_COLUMNS.
    """
    parts = [
        f"the {words} changes by {loaded_meshes[column].min():+.1f} to {loaded_meshes[column].max():+.1f} %"
        for column, words in CHANGE_COLUMNS.items()
        if column in loaded_meshes and len(loaded_meshes)
    ]
    return begin_with_capital(f"{'; '.join(parts)}.") if parts else ""


def _force(meshes: pd.DataFrame) -> str:
    """Say which mesh force magnitude (N) the pose changes most, from column force_as_assembled_n to
    force_n, or that none changes, as where torques alone decide the forces.
    """
    before, after = meshes["force_as_assembled_n"].abs(), meshes["force_n"].abs()
    row = (after - before).abs().idxmax()
    if abs(after[row] - before[row]) < FORCE_TOLERANCE * before.max():
        return "No mesh force changes."
    return (
        f"The force of {meshes['mesh'][row]} changes most, from {format_number(before[row], 4)} N to "
        f"{format_number(after[row], 4)} N."
    )


def _ends(tables: Mapping[str, pd.DataFrame]) -> str:
    """Say at which loads (% of the mean torques) contacts leave the face (table `poses_leaving`), or
    that none does up to the largest load computed (table `poses_loads`, column load_fraction).
    """
    leaving_contacts, largest_percent = (
        tables["poses_leaving"],
        100 * tables["poses_loads"]["load_fraction"].max(),
    )
    if leaving_contacts.empty:
        return f"Up to {largest_percent:.0f} % of the torque no contact leaves the face."
    sentences = [
        f"at {100 * row.load_fraction:.0f} % of the torque the contact of {row.mesh} leaves the face at "
        f"{row.face_end_mm:.4g} mm"
        for row in leaving_contacts.itertuples()
    ]
    text = begin_with_capital("; ".join(sentences))
    return f"{text} (loads up to {largest_percent:.0f} % were looked at)."
