"""What the chapter on operating poses says: where forces put the teeth, and what follows, in numbers."""

from collections.abc import Mapping
from operator import itemgetter

import pandas as pd

from facegear.number_format import format_number
from facegear.report.page import Table

MESHES = (
    "Where contacts run under the mean torques: paths along the pinion, unloaded, and loaded where the "
    "machine puts it and as assembled; to inner and outer end: from the unloaded path to the ends of the "
    "face; by pose: change at the mesh's own load"
)
SHOWN = (
    *("mesh", "force_n", "unloaded_path_mm", "path_mm", "path_as_assembled_mm"),
    *("to_inner_end_mm", "to_outer_end_mm"),
    *("stiffness_by_pose_percent", "pressure_by_pose_percent", "face_gear_root_by_pose_percent"),
)
POSE = (
    "Every mesh in full. offset, axial shift, shaft angle: errors of assembly that the motions of both "
    "bodies amount to; outward: how far they move the unloaded contact; closing: what the flanks close "
    "beyond the deflection of the mesh"
)
LEAVING = (
    "Loads, as a fraction of the mean torques, at which the unloaded contact of a mesh crosses an end "
    "of the face"
)
EDGES = (
    "Distance of the contact pattern of every mesh, as it runs, to both ends of the face, to the tips of "
    "pinion and gear, and to the radii where undercut begins and tips are pointed"
)
STRESS = (
    "Pressure and root stress of every mesh at its own torque, from contact solved where the machine's own "
    "forces put its teeth, and as assembled"
)
PATTERN = "pattern_to_"
CHECK = "The surface beside the contact solved directly, for the mesh that its pose changes most"
CHANGED = {
    "stiffness_by_pose_percent": "stiffness",
    "pressure_by_pose_percent": "pressure",
    "face_gear_root_by_pose_percent": "root stress of the face gear",
}
"""Columns of what poses change, in words."""


def pose_tables(tables: Mapping[str, pd.DataFrame]) -> list[Table]:
    """Poses of all meshes, contacts that leave the face, and the surface's error; none without poses."""
    if "poses_meshes" not in tables:
        return []
    meshes, leaving = tables["poses_meshes"], tables["poses_leaving"]
    edges = [name for name in meshes.columns if name.startswith(PATTERN)]
    return [
        Table(MESHES, meshes[[name for name in SHOWN if name in meshes]], 4),
        *([Table(EDGES, meshes[["mesh", *edges]], 4)] if edges else []),
        *([Table(STRESS, tables["posed_stress"], 4)] if "posed_stress" in tables else []),
        *([Table(LEAVING, leaving, 4)] if len(leaving) else []),
        Table(POSE, meshes.drop(columns=edges), is_folded=True),
        Table(CHECK, tables["poses_check"], is_folded=True),
    ]


def pose_text(tables: Mapping[str, pd.DataFrame]) -> str:
    """A paragraph of what was computed; nothing without poses."""
    if "poses_meshes" not in tables:
        return ""
    meshes = tables["poses_meshes"]
    loaded = meshes[meshes["path_mm"].notna()]
    parts = [*_path(loaded), _pattern(loaded), _changes(loaded), _force(meshes), _ends(tables)]
    return " ".join(part for part in parts if part)


def _path(loaded: pd.DataFrame) -> list[str]:
    """The contact that moves most, and the one nearest to an end of the face."""
    if loaded.empty:
        return ["No mesh carries load."]
    shift = loaded["path_mm"] - loaded["path_as_assembled_mm"]
    shifted = loaded.loc[shift.abs().idxmax()]
    ends = loaded[["to_inner_end_mm", "to_outer_end_mm"]]
    near = loaded.loc[ends.min(axis=1).idxmin()]
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
    before, after = format_number(shifted["path_as_assembled_mm"], 4), format_number(shifted["path_mm"], 4)
    moved = (
        f"The loaded contact of {shifted['mesh']} moves furthest, from {before} mm as assembled to {after} mm"
    )
    return [f"{moved} as the machine runs.", left]


def _pattern(loaded: pd.DataFrame) -> str:
    """At which ends of the face the loaded pattern ends, and which tips carry none of it."""
    if f"{PATTERN}inner_end_mm" not in loaded or loaded.empty:
        return ""
    said = []
    for end in ("inner", "outer"):
        left = loaded[f"{PATTERN}{end}_end_mm"]
        reached = loaded.loc[left <= 0.0, "mesh"].to_list()
        if reached:
            names = "every mesh" if len(reached) == len(loaded) else ", ".join(reached)
            said.append(f"the loaded pattern of {names} reaches the {end} end of the face")
        else:
            said.append(f"{format_number(left.min(), 2)} mm of the face stay free at its {end} end")
    for tip in ("pinion", "gear"):
        left = loaded[f"{PATTERN}{tip}_tip_mm"]
        if left.min() > 0.0:
            said.append(f"the pattern stays {format_number(left.min(), 2)} mm from the tip of the {tip}")
    text = "; ".join(said)
    return f"{text[0].upper()}{text[1:]}."


def _changes(loaded: pd.DataFrame) -> str:
    """What poses change of the contact at the meshes' own loads, where there is any load."""
    parts = [
        f"the {words} changes by {loaded[column].min():+.1f} to {loaded[column].max():+.1f} %"
        for column, words in CHANGED.items()
        if column in loaded and len(loaded)
    ]
    return f"{'; '.join(parts)}.".capitalize() if parts else ""


def _force(meshes: pd.DataFrame) -> str:
    before, after = meshes["force_as_assembled_n"].abs(), meshes["force_n"].abs()
    changed = (after - before).abs().idxmax()
    return (
        f"The force of {meshes['mesh'][changed]} changes most, from {format_number(before[changed], 4)} N to "
        f"{format_number(after[changed], 4)} N."
    )


def _ends(tables: Mapping[str, pd.DataFrame]) -> str:
    """At which loads contacts leave the face, as far as loads were looked at."""
    leaving, reached = tables["poses_leaving"], 100 * tables["poses_loads"]["load_fraction"].max()
    if leaving.empty:
        return f"Up to {reached:.0f} % of the torque no contact leaves the face."
    said = [
        f"at {100 * row.load_fraction:.0f} % of the torque the contact of {row.mesh} leaves the face at "
        f"{row.face_end_mm:.4g} mm"
        for row in leaving.itertuples()
    ]
    return f"{'; '.join(said).capitalize()} (loads up to {reached:.0f} % were looked at)."
