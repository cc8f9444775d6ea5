"""What the contact table says of each torque: stiffness, peak-to-peak transmission error, pressure, path."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays, Integers
from facegear.geometry.design import PairDesign
from facegear.geometry.flank_errors import FLANKS, GEARS

COLUMNS = (
    "torque_n_m",
    "positions",
    "k_average_mean_n_per_m",
    "k_average_min_n_per_m",
    "k_average_max_n_per_m",
    "k_local_mean_n_per_m",
    "ste_peak_to_peak_um",
    "ste_peak_to_peak_half_um",
    "unloaded_peak_to_peak_um",
    "pairs_min",
    "pairs_max",
    "pressure_mpa",
    "pressure_error_mpa",
    "tip_line_load_n_per_mm",
    "tip_length_mm",
    "fillet_share",
    "interference_um",
)

BY_FLANK_COLUMNS = (
    *("gear", "flank", "offset_um", "shaft_angle_error_deg", "axial_shift_um"),
    *COLUMNS,
    "path_radius_mm",
)


def by_torque(ltca: pd.DataFrame, pressure: Arrays) -> pd.DataFrame:
    """`contact_summary` and, as its last column, `path_radii`."""
    return contact_summary(ltca).merge(path_radii(pressure), on="torque_n_m", how="left")


def by_flank(
    variants: Sequence[pd.DataFrame], different: Sequence[PairDesign], numbers: Integers
) -> pd.DataFrame:
    """Tables of `by_torque` of all gears and flanks, columns as BY_FLANK_COLUMNS.

    `variants`: those of each of the `different` pairs that the flanks are part of; `numbers` as
    `distinct_pairs` has them.
    """
    parts = []
    for (row, column), number in np.ndenumerate(numbers):
        met = different[int(number)].assembly
        known = {
            "gear": GEARS[row],
            "flank": FLANKS[column],
            "offset_um": 1e6 * met.offset,
            "shaft_angle_error_deg": np.degrees(met.shaft_angle_error),
            "axial_shift_um": 1e6 * met.axial_shift,
        }
        parts.append(variants[int(number)].assign(**known))
    return pd.concat(parts, ignore_index=True)[list(BY_FLANK_COLUMNS)]


def contact_summary(ltca: pd.DataFrame) -> pd.DataFrame:
    """One row a torque, columns as COLUMNS, of a contact table.

    A peak-to-peak value is the largest less the smallest of the `positions` solved in a pitch, so it cannot
    exceed the true one; `ste_peak_to_peak_half_um` takes every second position alone and shows how much
    their number matters (NaN for an odd number, whose every second position is not spread evenly). The
    pressure and its error are those of the position where it is largest; line loads and the loaded length of
    tip edges, the share of the torque that fillets carry and the interference are the largest of all
    positions, which need not be one position's. A mean stiffness over positions of which one has none is nan.
    """
    values = dict(zip(ltca.columns, ltca.to_numpy(float).T, strict=True))
    torques = np.unique(values["torque_n_m"])
    order = np.argsort(values["position"], kind="stable")
    groups = [order[values["torque_n_m"][order] == torque] for torque in torques]
    rows = [
        _row(float(torque), {name: column[rows] for name, column in values.items()})
        for torque, rows in zip(torques, groups, strict=True)
    ]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _row(torque: float, at: Arrays) -> tuple[float, ...]:
    """Of columns of the contact table, position by position."""
    error, average = at["ste_um"], at["k_average_n_per_m"]
    known = average[~np.isnan(average)]
    whole = known.size == average.size
    return (
        torque,
        len(error),
        average.mean(),
        known.min() if known.size else np.nan,
        known.max() if known.size else np.nan,
        at["k_local_n_per_m"].mean() if whole else np.nan,
        float(np.ptp(error)),
        float(np.ptp(error[::2])) if len(error) % 2 == 0 else np.nan,
        float(np.ptp(at["unloaded_ste_um"])),
        int(at["pairs_in_contact"].min()),
        int(at["pairs_in_contact"].max()),
        *_largest_pressure(at["pressure_mpa"], at["pressure_error_mpa"]),
        at["tip_line_load_n_per_mm"].max(),
        at["tip_length_mm"].max(),
        at["fillet_share"].max(),
        at["interference_um"].max(),
    )


def _largest_pressure(pressure: Array, error: Array) -> tuple[float, float]:
    """The largest of all positions with its error (MPa); nan where no position has one."""
    if np.isnan(pressure).all():
        return np.nan, np.nan
    at = int(np.nanargmax(pressure))
    return float(pressure[at]), float(error[at])


def path_radii(pressure: Arrays) -> pd.DataFrame:
    """Columns torque_n_m and path_radius_mm: the centroid of all contact forces over a pitch.

    `pressure`: arrays as PRESSURE_ARRAYS. The radius is the distance along the pinion's axis from the axis of
    the face gear, as assembled without errors.
    """
    return _centroids(pressure, ["torque_n_m"])


def path_by_position(pressure: Arrays) -> pd.DataFrame:
    """Columns torque_n_m, position and path_radius_mm: as `path_radii`, of the forces at each position."""
    return _centroids(pressure, ["torque_n_m", "position"])


def _centroids(pressure: Arrays, keys: list[str]) -> pd.DataFrame:
    force = pressure["force_n"]
    moment = force * 1e3 * pressure["point_m"][:, 1][pressure["node"]]
    frame = pd.DataFrame({key: pressure[key] for key in keys} | {"force": force, "moment": moment})
    sums = frame.groupby(keys, as_index=False).sum()
    sums["path_radius_mm"] = sums["moment"] / sums["force"]
    return sums[[*keys, "path_radius_mm"]]
