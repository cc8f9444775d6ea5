"""Tables of the quasi-static hunting cycle."""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.load_sharing.even_shares import even_shares
from facegear.load_sharing.hunting import HuntingCycle, LoadHistory, largest
from facegear.transmission.drive_line import DriveLine
from facegear.transmission.shaft_loads import bearing_names, shaft_bearing_loads

MESH_COLUMNS = (
    "mesh",
    "group",
    "mean_n",
    "least_n",
    "largest_n",
    "even_share_n",
    "torque_n_m",
    "k_gamma",
    "group_ratio",
    "drive_fraction",
    "back_fraction",
    "open_fraction",
    "wedged_fraction",
    "first_open_cycle",
)
"""Columns of mesh_table()."""


GROUP_COLUMNS = (
    *("group", "kind", "mean", "least", "largest", "k_gamma", "group_ratio", "undefined_fraction"),
    *("torque_n_m", "mesh_cycles", "kkt_residual"),
)
"""Columns of group_table()."""


def mesh_table(run: LoadHistory) -> pd.DataFrame:
    """Return load, mesh load factor and state of each mesh.

    `even_share_n` and `torque_n_m` (on the pinion) are the nominal even share that K_gamma counts from, empty
    with it where that is nothing. `group_ratio`: largest load over the mean of the group's own loads. The
    fractions are of the time on each flank, open, and wedged (both). `first_open_cycle` is empty where the
    mesh never opens; `group` and `group_ratio` where the mesh shares its load with none.

    Parameters
    ----------
    run : LoadHistory
        Loads over a motion.

    Returns
    -------
    pd.DataFrame
        One row a mesh, columns MESH_COLUMNS.
    """
    layout = run.machine.layout
    names, even = layout.mesh_names, even_shares(run.machine)
    group, ratio = _group_ratios(run)
    drive, back = (flank > 0.0 for flank in np.split(run.flank_forces, 2, axis=1))
    is_open = ~drive & ~back
    rows = []
    for mesh, load in enumerate(run.loads.T):
        opens = np.flatnonzero(is_open[:, mesh])
        rows.append(
            (
                names[mesh],
                group[mesh],
                load.mean(),
                load.min(),
                run.largest_loads[mesh],
                even[mesh],
                even[mesh] * layout.pinion_arm,
                run.mesh_load_factors[mesh],
                ratio[mesh],
                drive[:, mesh].mean(),
                back[:, mesh].mean(),
                is_open[:, mesh].mean(),
                (drive & back)[:, mesh].mean(),
                run.cycles[opens[0]] if opens.size else np.nan,
            )
        )
    return pd.DataFrame(rows, columns=list(MESH_COLUMNS))


def group_table(run: HuntingCycle) -> pd.DataFrame:
    """Return mean, least and largest coefficient, largest K_gamma and group ratio of each group.

    Parameters
    ----------
    run : HuntingCycle
        Quasi-static motion.

    Returns
    -------
    pd.DataFrame
        One row a group, columns GROUP_COLUMNS; `torque_n_m` is the largest torque on a pinion, to which all
        values belong.
    """
    rows = []
    for group in run.groups:
        coefficient = run.coefficients(group)
        defined_values = coefficient[~np.isnan(coefficient)]
        low, mean, high = (
            (defined_values.min(), defined_values.mean(), defined_values.max())
            if defined_values.size
            else (np.nan, np.nan, np.nan)
        )
        rows.append(
            (
                group.name,
                group.kind.value,
                mean,
                low,
                high,
                largest(run.path_factors(group)),
                run.group_ratios(group).max(),
                np.isnan(coefficient).mean(),
                run.largest_torque,
                len(run.cycles) // run.positions,
                run.at_rest.residual.max(),
            )
        )
    return pd.DataFrame(rows, columns=list(GROUP_COLUMNS))


def bearing_table(run: HuntingCycle, line: DriveLine | None = None) -> pd.DataFrame:
    """Return the forces on the bearings.

    A pinion's x is tangential and y along the gears' axis, both radial for its bearing; a face gear's axis is
    z.

    Parameters
    ----------
    run : HuntingCycle
        Quasi-static motion.
    line : DriveLine or None
        Drive line, whose shafts have bearings of their own.

    Returns
    -------
    pd.DataFrame
        One row a body, then one a bearing of the drive line's shafts: body, mean force along x, y, z, mean
        and largest radial force and largest axial force, N.
    """
    names, forces, rows = list(run.machine.layout.body_names), run.bearings, []
    if line is not None:
        names += [f"{names[pinion]} bearing {letter}" for pinion, letter in bearing_names(line)]
        forces = np.concatenate([forces, shaft_bearing_loads(line, forces)[..., :3]], axis=1)
    for name, force in zip(names, forces.transpose(1, 0, 2), strict=True):
        radial = np.hypot(force[:, 0], force[:, 1])
        rows.append((name, *force.mean(axis=0), radial.mean(), radial.max(), np.abs(force[:, 2]).max()))
    columns = ("body", "mean_x_n", "mean_y_n", "mean_z_n", "mean_radial_n", "largest_radial_n")
    return pd.DataFrame(rows, columns=[*columns, "largest_axial_n"])


def cycle_table(run: LoadHistory) -> pd.DataFrame:
    """Return the mean load of every mesh in each mesh cycle.

    Parameters
    ----------
    run : LoadHistory
        Loads over a motion.

    Returns
    -------
    pd.DataFrame
        One row a cycle: columns cycle, then one a mesh, N.
    """
    frame = pd.DataFrame(run.cycle_means, columns=[f"{name} (N)" for name in run.machine.layout.mesh_names])
    frame.insert(0, "cycle", np.arange(len(frame)))
    return frame


def _group_ratios(run: LoadHistory) -> tuple[list[str], Array]:
    """Return the group of every mesh and the ratio of its load to the group's own mean (meshes,)."""
    names = [""] * len(run.machine.layout.meshes)
    ratios = np.full(len(names), np.nan)
    for group in run.groups:
        for mesh, ratio in zip(group.meshes, run.group_ratios(group), strict=True):
            names[mesh], ratios[mesh] = group.name, ratio
    return names, ratios
