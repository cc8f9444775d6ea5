"""Tables of the quasi-static hunting cycle."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.load_sharing.hunting import HuntingCycle, LoadHistory

MESH_COLUMNS = (
    "mesh",
    "group",
    "mean_n",
    "least_n",
    "largest_n",
    "k_gamma",
    "drive_share",
    "back_share",
    "open_share",
    "wedged_share",
    "first_open_cycle",
)


def mesh_table(run: LoadHistory) -> pd.DataFrame:
    """One row a mesh: load, path factor K_gamma, shares of the time on each flank, open, wedged (both).

    `first_open_cycle` is empty where the mesh never opens; `group` and `k_gamma` where it shares with nobody.
    """
    names = run.machine.layout.mesh_names
    group, factor = _factors(run)
    drive, back = (flank > 0.0 for flank in np.split(run.flank_forces, 2, axis=1))
    unloaded = ~drive & ~back
    rows = []
    for mesh, load in enumerate(run.loads.T):
        opens = np.flatnonzero(unloaded[:, mesh])
        rows.append(
            (
                names[mesh],
                group[mesh],
                load.mean(),
                load.min(),
                load.max(),
                factor[mesh],
                drive[:, mesh].mean(),
                back[:, mesh].mean(),
                unloaded[:, mesh].mean(),
                (drive & back)[:, mesh].mean(),
                run.cycles[opens[0]] if opens.size else np.nan,
            )
        )
    return pd.DataFrame(rows, columns=list(MESH_COLUMNS))


def group_table(run: HuntingCycle) -> pd.DataFrame:
    """One row a group: mean, least and largest coefficient, largest path factor, the torque it is for."""
    rows = []
    for group in run.groups:
        coefficient = run.coefficients(group)
        defined = coefficient[~np.isnan(coefficient)]
        low, mean, high = (
            (defined.min(), defined.mean(), defined.max()) if defined.size else (np.nan, np.nan, np.nan)
        )
        rows.append(
            {
                "group": group.name,
                "kind": group.kind.value,
                "mean": mean,
                "least": low,
                "largest": high,
                "k_gamma": run.path_factors(group).max(),
                "undefined_share": np.isnan(coefficient).mean(),
                "torque_n_m": np.abs(run.machine.torques[: len(run.machine.layout.pinions)]).max(),
                "mesh_cycles": len(run.cycles) // run.positions,
                "kkt_residual": run.found.residual.max(),
            }
        )
    return pd.DataFrame(rows)


def bearing_table(run: HuntingCycle) -> pd.DataFrame:
    """One row a body: mean force on its bearing along x, y, z and largest radial and axial force, N.

    A pinion's x is tangential and y along the gears' axis, both radial for its bearing; a face gear's axis
    is z.
    """
    layout = run.machine.layout
    rows = []
    for name, force in zip(layout.body_names, run.bearings.transpose(1, 0, 2), strict=True):
        radial = np.hypot(force[:, 0], force[:, 1])
        rows.append((name, *force.mean(axis=0), radial.mean(), radial.max(), np.abs(force[:, 2]).max()))
    columns = ("body", "mean_x_n", "mean_y_n", "mean_z_n", "mean_radial_n", "largest_radial_n")
    return pd.DataFrame(rows, columns=[*columns, "largest_axial_n"])


def cycle_table(run: LoadHistory) -> pd.DataFrame:
    """Mean load of every mesh in each mesh cycle, one row a cycle: columns cycle, then one a mesh, N."""
    loads = run.loads.reshape(-1, run.positions, len(run.machine.layout.meshes)).mean(axis=1)
    frame = pd.DataFrame(loads, columns=[f"{name} (N)" for name in run.machine.layout.mesh_names])
    frame.insert(0, "cycle", np.arange(len(frame)))
    return frame


def _factors(run: LoadHistory) -> tuple[list[str], NDArray[np.float64]]:
    """Group and path factor of every mesh (meshes,)."""
    names = [""] * len(run.machine.layout.meshes)
    factors = np.full(len(names), np.nan)
    for group in run.groups:
        for mesh, factor in zip(group.meshes, run.path_factors(group), strict=True):
            names[mesh], factors[mesh] = group.name, factor
    return names, factors
