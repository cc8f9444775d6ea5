"""Poses of all meshes as tables, and the load at which a contact leaves the face."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.errors import InvalidInput, NotConverged
from facegear.machine.machine import Machine
from facegear.machine.poses.fixed_point import OperatingPose, operating_pose
from facegear.machine.poses.posed_flanks import flank_surfaces, nominal_contact
from facegear.machine.poses.surface import QUANTITIES, RADIUS, STIFFNESS, PoseSurface

FRACTIONS = np.arange(1, 16) / 10.0
"""Fractions of the machine's mean torques at which its poses are computed."""
HALVINGS, REACH_HALVINGS = 8, 4
"""Halvings of a step of the load at which a path crosses the face's end, and to the end of the surface."""
SHORT = ("stiffness", "ste_peak_to_peak", "pressure", RADIUS, "pinion_root", "face_gear_root")
"""Short names of QUANTITIES, with which columns begin."""
PERCENT = {
    name: f"{short}_by_pose_percent" for name, short in zip(QUANTITIES, SHORT, strict=True) if name != RADIUS
}
"""Columns with the change of each quantity by the pose alone, at the mesh's own load."""
REACTIONS = ("tangential_force_n", "axial_force_n", "overturning_moment_n_m")
"""Reactions of a mesh on its face gear: along the tangent, along the axis, and about the line through the
gear's centre that is parallel to the tangent.
"""
MESH_COLUMNS = (
    *("mesh", "flank", "force_n", "force_as_assembled_n", "torque_n_m"),
    *REACTIONS,
    *("offset_um", "gear_axial_um", "shaft_angle_error_deg", "outward_um", "closing_um"),
    *("unloaded_path_mm", "path_mm", "path_as_assembled_mm", "to_inner_end_mm", "to_outer_end_mm"),
    "stiffness_factor",
)
"""Columns of mesh_table() that are always there."""
MARGINS = {
    "pattern_to_inner_end_mm": "inner_end",
    "pattern_to_outer_end_mm": "outer_end",
    "pattern_to_pinion_tip_mm": "pinion_tip",
    "pattern_to_gear_tip_mm": "gear_tip",
    "pattern_to_undercut_mm": "undercut",
    "pattern_to_pointing_mm": "pointing",
}
"""Columns with the distance of the contact pattern of a mesh from every edge, nan without load."""
ENDS = {
    "pattern_to_inner_end_mm": "the inner end of the face",
    "pattern_to_outer_end_mm": "the outer end of the face",
}
"""Words for the margins at the ends of the face."""
TIPS = {"pattern_to_pinion_tip_mm": "the pinion's tip", "pattern_to_gear_tip_mm": "the gear's tip"}
"""Words for the margins at the tips."""
FINITE = tuple(
    name for name in MESH_COLUMNS if name not in ("path_mm", "path_as_assembled_mm", "mesh", "flank")
)
"""Columns whose numbers are always finite: a mesh without load has no loaded path."""
LOAD_COLUMNS = (
    "load_fraction",
    "mesh",
    "flank",
    "force_n",
    "unloaded_path_mm",
    "path_mm",
    "stiffness_factor",
)
"""Columns of the first table of load_tables()."""
LEAVING_COLUMNS = ("mesh", "load_fraction", "end", "face_end_mm")
"""Columns of the second table of load_tables()."""


def mesh_table(machine: Machine, surface: PoseSurface, result: OperatingPose, before: Array) -> pd.DataFrame:
    """Return force, pose and contact of each mesh.

    Paths are places along the pinion: of the unloaded contact, and of the loaded one at the mesh's torque, at
    the pose of the machine and as assembled. Quantities of a mesh without load are nan.

    Parameters
    ----------
    machine : Machine
        The machine as assembled.
    surface : PoseSurface
        Contact over the pose.
    result : OperatingPose
        Its converged pose.
    before : (meshes,) array
        Forces as assembled, N.

    Returns
    -------
    pd.DataFrame
        One row a mesh: MESH_COLUMNS and the columns PERCENT of the quantities that the surface has.
    """
    layout, rows = machine.layout, []
    drive, back = np.split(result.flank_closure, 2)
    surfaces = loaded_surfaces(result, surface)
    for mesh, (name, loaded_surface) in enumerate(zip(layout.mesh_names, surfaces, strict=True)):
        on_back, angle = result.forces[mesh] < 0.0, float(result.angle[mesh])
        at = float(result.torque[mesh]), float(result.path[mesh]), angle
        rest = nominal_contact(machine, surface, mesh, on_back)
        values = {quantity: loaded_surface.at(quantity, *at) for quantity in loaded_surface.values}
        nominal = {quantity: loaded_surface.at(quantity, at[0], *rest) for quantity in loaded_surface.values}
        has_load = result.forces[mesh] != 0.0
        rows.append(
            {
                "mesh": name,
                "flank": _flank(result.forces[mesh]),
                "force_n": result.forces[mesh],
                "force_as_assembled_n": before[mesh],
                "torque_n_m": at[0],
                **dict(zip(REACTIONS, gear_reactions(result, surface)[mesh].tolist(), strict=True)),
                "offset_um": 1e6 * result.poses.offset[mesh],
                "gear_axial_um": 1e6 * result.poses.gear_axial[mesh],
                "shaft_angle_error_deg": np.degrees(angle),
                "outward_um": 1e6 * result.poses.outward[mesh],
                "closing_um": 1e6 * (back if on_back else drive)[mesh],
                "unloaded_path_mm": 1e3 * at[1],
                "path_mm": 1e3 * values[RADIUS] if has_load else np.nan,
                "path_as_assembled_mm": 1e3 * nominal[RADIUS] if has_load else np.nan,
                "to_inner_end_mm": 1e3 * (at[1] - loaded_surface.pair.first_end),
                "to_outer_end_mm": 1e3 * (loaded_surface.pair.last_end - at[1]),
                "stiffness_factor": result.factor[mesh],
                **{
                    column: 100.0 * (values[quantity] / nominal[quantity] - 1.0) if has_load else np.nan
                    for quantity, column in PERCENT.items()
                    if quantity in values
                },
            }
        )
    return pd.DataFrame(rows)


def loaded_surfaces(result: OperatingPose, surface: PoseSurface) -> list[PoseSurface]:
    """Return the surface of the flank of each mesh that carries, of its drive flank where none does.

    Parameters
    ----------
    result : OperatingPose
        Converged pose.
    surface : PoseSurface
        Contact over the pose.

    Returns
    -------
    list of PoseSurface
        One for each mesh.
    """
    surfaces, meshes = flank_surfaces(result.machine, surface), len(result.forces)
    return [surfaces[mesh + meshes * int(force < 0.0)] for mesh, force in enumerate(result.forces)]


def gear_reactions(result: OperatingPose, surface: PoseSurface) -> Array:
    """Return the reactions of every mesh on its gear, as REACTIONS names them.

    The energy's derivatives by offset and axial shift are the components of the force F across both axes and
    along the gear's, its component along the pinion's axis is F times the sine of the base helix, and the
    derivative by the shaft angle is its moment about the middle of the pinion's face.

    Parameters
    ----------
    result : OperatingPose
        Converged pose.
    surface : PoseSurface
        Contact over the pose.

    Returns
    -------
    (meshes, 3) array
        N, N and N m.
    """
    rows = []
    for loaded_surface, force, reactions in zip(
        loaded_surfaces(result, surface), np.abs(result.forces), result.reactions, strict=True
    ):
        pair, (tangential, shifting, turning) = loaded_surface.pair, reactions.tolist()
        sine, cosine = pair.axes.sine, pair.axes.cosine
        outwards = (force * pair.base_helix_sine + shifting * cosine) / sine
        overturning = turning + pair.mean_radius * (sine * shifting + cosine * outwards)
        rows.append((tangential, -shifting, -overturning))
    return np.array(rows)


def with_margins(meshes: pd.DataFrame, margins: Sequence[Mapping[str, float] | None]) -> pd.DataFrame:
    """Add the columns MARGINS to the table of meshes.

    Parameters
    ----------
    meshes : pd.DataFrame
        Table of mesh_table().
    margins : Sequence[Mapping[str, float] or None]
        Distances (m) by name for each mesh, None where they are not known.

    Returns
    -------
    pd.DataFrame
        The table with margins in mm; nan for a mesh without load.
    """
    has_load = (meshes["torque_n_m"] > 0.0).to_numpy()
    return meshes.assign(
        **{
            column: [
                1e3 * float(margin[name]) if on and margin is not None else np.nan
                for on, margin in zip(has_load, margins, strict=True)
            ]
            for column, name in MARGINS.items()
        }
    )


def margin_text(meshes: pd.DataFrame) -> str:
    """Return a sentence on the edges that contact patterns reach, or the end of the face that is nearest.

    Parameters
    ----------
    meshes : pd.DataFrame
        Table with the columns MARGINS.

    Returns
    -------
    str
        Parts joined by semicolons.
    """
    edges = {**ENDS, **TIPS}
    edges_of_meshes: dict[str, list[str]] = {}
    for column, words in edges.items():
        names = meshes.loc[meshes[column] == 0.0, "mesh"].to_list()
        if names:
            mesh_names = ", ".join(names) if len(names) < len(meshes) else "every mesh"
            edges_of_meshes.setdefault(mesh_names, []).append(words)
    texts = [
        f"the pattern reaches {', '.join(edge_names)} in {mesh_names}"
        for mesh_names, edge_names in edges_of_meshes.items()
    ]
    free = meshes[list(ENDS)].where(meshes[list(ENDS)] > 0.0)
    if free.notna().to_numpy().any():
        row, column = free.stack().idxmin()
        distance = f"{free.loc[row, column]:.2f} mm"
        texts.append(f"the pattern of {meshes.loc[row, 'mesh']} stays {distance} from {ENDS[column]}")
    return "; ".join(texts)


def scaled_load(machine: Machine, fraction: float) -> Machine:
    """Return the machine with all mean torques times a fraction; other forces stay.

    Parameters
    ----------
    machine : Machine
        The machine.
    fraction : float
        The fraction.

    Returns
    -------
    Machine
        The machine with other torques.
    """
    return replace(machine, torques=fraction * machine.torques)


def load_tables(machine: Machine, surface: PoseSurface) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Compute the poses over FRACTIONS of the load as far as the surface reaches, and where contacts leave
    the face.

    A contact leaves where its unloaded path crosses an end of the face.

    Parameters
    ----------
    machine : Machine
        The machine as assembled.
    surface : PoseSurface
        Contact over the pose.

    Returns
    -------
    pair of DataFrame
        Columns LOAD_COLUMNS, and LEAVING_COLUMNS.
    """
    names, rows, exits = machine.layout.mesh_names, [], []
    last: tuple[float, Array] | None = None
    for fraction, result in _loads(machine, surface):
        rows += [
            {
                "load_fraction": fraction,
                "mesh": name,
                "flank": _flank(result.forces[mesh]),
                "force_n": result.forces[mesh],
                "unloaded_path_mm": 1e3 * result.path[mesh],
                "path_mm": 1e3 * _radius(surface, result, mesh),
                "stiffness_factor": result.factor[mesh],
            }
            for mesh, name in enumerate(names)
        ]
        pairs = [flank_surface.pair for flank_surface in loaded_surfaces(result, surface)]
        for end, sign in (("inner", -1.0), ("outer", 1.0)):
            radii = np.array([pair.first_end if end == "inner" else pair.last_end for pair in pairs])
            now = sign * (result.path - radii) > 0.0
            before = np.zeros(len(names), bool) if last is None else sign * (last[1] - radii) > 0.0
            for mesh in np.flatnonzero(now & ~before).tolist():
                start, radius = 0.0 if last is None else last[0], float(radii[mesh])
                crossing_fraction = _crossing(machine, surface, mesh, sign, radius, (start, fraction))
                exits.append((names[mesh], crossing_fraction, end, 1e3 * radius))
        last = fraction, result.path
    return pd.DataFrame(rows, columns=list(LOAD_COLUMNS)), pd.DataFrame(exits, columns=list(LEAVING_COLUMNS))


def _loads(machine: Machine, surface: PoseSurface) -> Iterator[tuple[float, OperatingPose]]:
    """Yield load fraction and pose at FRACTIONS of the load as far as they are found, then, where they
    end early, at the largest fraction that REACH_HALVINGS halvings of the last step reach.
    """
    reached_fraction = 0.0
    for fraction in FRACTIONS.tolist():
        result = _at_load(machine, surface, fraction)
        if result is None:
            break
        yield fraction, result
        reached_fraction = fraction
    else:
        return
    last, beyond = None, fraction
    for _ in range(REACH_HALVINGS):
        middle = 0.5 * (reached_fraction + beyond)
        result = _at_load(machine, surface, middle)
        if result is None:
            beyond = middle
        else:
            last, reached_fraction = result, middle
    if last is not None:
        yield reached_fraction, last


def leaving_text(exits: pd.DataFrame) -> str:
    """Return sentences on contacts that leave the face.

    Parameters
    ----------
    exits : pd.DataFrame
        Second table of load_tables().

    Returns
    -------
    str
        Sentences joined by semicolons.
    """
    return "; ".join(
        f"at {100 * row.load_fraction:.0f} % of the torque the contact of {row.mesh} leaves the face "
        f"at {row.face_end_mm:.4g} mm"
        for row in exits.itertuples()
    )


def _at_load(machine: Machine, surface: PoseSurface, fraction: float) -> OperatingPose | None:
    """Return the operating pose at a fraction of the mean torques; None where it lies beyond the surface
    or the iteration does not converge.
    """
    try:
        return operating_pose(scaled_load(machine, fraction), surface)
    except (InvalidInput, NotConverged):
        return None


def _crossing(
    machine: Machine,
    surface: PoseSurface,
    mesh: int,
    sign: float,
    radius: float,
    between: tuple[float, float],
) -> float:
    """Return the load fraction at which the unloaded path of a mesh crosses a radius (m), by HALVINGS
    halvings.

    sign: 1 if the path leaves outwards, -1 inwards; between: fractions before and after the crossing, of
    which the second is returned where the first is 0.
    """
    low, high = between
    for _ in range(HALVINGS if low > 0.0 else 0):
        middle = 0.5 * (low + high)
        result = _at_load(machine, surface, middle)
        beyond = result is None or sign * (result.path[mesh] - radius) > 0.0
        low, high = (low, middle) if beyond else (middle, high)
    return high


def _radius(surface: PoseSurface, result: OperatingPose, mesh: int) -> float:
    """Return the loaded contact radius of a mesh from the surface, m; nan without load."""
    if result.forces[mesh] == 0.0:
        return float("nan")
    at = float(result.torque[mesh]), float(result.path[mesh]), float(result.angle[mesh])
    return loaded_surfaces(result, surface)[mesh].at(RADIUS, *at)


def _flank(force: float) -> str:
    """Name the loaded flank by the sign of the force: drive, back or open."""
    return "drive" if force > 0.0 else "back" if force < 0.0 else "open"


def hardest_mesh(table: pd.DataFrame) -> int:
    """Return the loaded mesh whose stiffness its pose changes most, in magnitude.

    Parameters
    ----------
    table : pd.DataFrame
        Table of mesh_table(), with the column stiffness_by_pose_percent.

    Returns
    -------
    int
        Index of the mesh.
    """
    return int(table[PERCENT[STIFFNESS]].abs().fillna(-1.0).to_numpy().argmax())
