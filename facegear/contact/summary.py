"""Summary of the contact table for each torque: stiffness, peak-to-peak transmission error,
pressure, path.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays, Integers
from facegear.contact.pattern import SHARES
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import FLANKS, GEARS

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
"""Columns of table `by_torque`; units stand in the names."""

BY_FLANK_COLUMNS = (
    *("gear", "flank", "offset_um", "shaft_angle_error_deg", "gear_axial_um"),
    *COLUMNS,
    "path_radius_mm",
)
"""Columns of table `by_flank`: the flank with its assembly errors, and COLUMNS."""

WRENCH_QUANTITIES = (
    *("force_x_n", "force_y_n", "force_z_n", "moment_x_n_m", "moment_y_n_m", "moment_z_n_m"),
    "pinion_axial_n",
)
"""Columns of the wrench of the pinion on the gear, which the contact table of teeth other than spur ones has;
`by_flank` has their means over a pitch."""


def by_torque(ltca: pd.DataFrame, pressure: Arrays) -> pd.DataFrame:
    """Return the contact summary with the path radius as its last column.

    Parameters
    ----------
    ltca : pd.DataFrame
        Contact table, columns LTCA_COLUMNS.
    pressure : Arrays
        Arrays as PRESSURE_ARRAYS.

    Returns
    -------
    pd.DataFrame
        One row a torque, columns COLUMNS and `path_radius_mm`.
    """
    return contact_summary(ltca).merge(path_radii(pressure), on="torque_n_m", how="left")


def with_wrenches(by_torque: pd.DataFrame, ltca: pd.DataFrame) -> pd.DataFrame:
    """Add the largest share of a pair of teeth and the mean wrench to a table of `by_torque`.

    Parameters
    ----------
    by_torque : pd.DataFrame
        Result of `by_torque`.
    ltca : pd.DataFrame
        Contact table, columns LTCA_COLUMNS and WRENCH_QUANTITIES.

    Returns
    -------
    pd.DataFrame
        The table with columns `load_share_max` and WRENCH_QUANTITIES.
    """
    shares = ltca[list(SHARES)].max(axis=1).groupby(ltca["torque_n_m"]).max().rename("load_share_max")
    means = ltca.groupby("torque_n_m")[list(WRENCH_QUANTITIES)].mean()
    return by_torque.join(shares, on="torque_n_m").join(means, on="torque_n_m")


def by_flank(
    variants: Sequence[pd.DataFrame], different: Sequence[PairDesign], numbers: Integers
) -> pd.DataFrame:
    """Join the tables of `by_torque` of all gears and flanks.

    Parameters
    ----------
    variants : Sequence[pd.DataFrame]
        Result of `by_torque` for each of the `different` pairs.
    different : Sequence[PairDesign]
        Pairs that the flanks are part of.
    numbers : (gears, flanks) array of int
        Which of the pairs each flank is part of, as in `distinct_pairs`.

    Returns
    -------
    pd.DataFrame
        Columns BY_FLANK_COLUMNS, one row a flank and torque; further ones of the variants follow.
    """
    with_errors = [
        table.assign(
            offset_um=1e6 * pair.assembly.offset,
            shaft_angle_error_deg=np.degrees(pair.assembly.shaft_angle_error),
            gear_axial_um=1e6 * pair.assembly.gear_axial,
        )
        for table, pair in zip(variants, different, strict=True)
    ]
    table = join_flanks(with_errors, numbers)
    further = [name for name in table.columns if name not in BY_FLANK_COLUMNS]
    return table[[*BY_FLANK_COLUMNS, *further]]


def join_flanks(tables: Sequence[pd.DataFrame], numbers: Integers) -> pd.DataFrame:
    """Join the tables of contacts to one of all gears and flanks.

    Parameters
    ----------
    tables : Sequence[pd.DataFrame]
        Table of each contact.
    numbers : (gears, flanks) array of int
        Number of the contact of each gear (upper, lower) and flank (drive, back).

    Returns
    -------
    pd.DataFrame
        Rows of each flank's contact, with columns `gear` and `flank` in front.
    """
    parts = [
        tables[int(number)].assign(gear=GEARS[row], flank=FLANKS[column])
        for (row, column), number in np.ndenumerate(numbers)
    ]
    return pd.concat(parts, ignore_index=True)[["gear", "flank", *tables[0].columns]]


def contact_summary(ltca: pd.DataFrame) -> pd.DataFrame:
    """Summarise a contact table, one row a torque.

    A peak-to-peak value is the largest less the smallest of the `positions` solved in a pitch, so it
    cannot exceed the true one. `ste_peak_to_peak_half_um` takes every second position alone and shows how
    much their number matters (NaN for an odd number, whose every second position is not spread evenly).
    The pressure and its error are taken at the position where the pressure is largest. Line loads and the
    loaded length of tip edges, the share of the torque that fillets carry and the interference are the
    largest of all positions, which need not occur at the same one. A mean stiffness is nan if any position
    has none.

    Parameters
    ----------
    ltca : pd.DataFrame
        Contact table, columns LTCA_COLUMNS.

    Returns
    -------
    pd.DataFrame
        Columns COLUMNS.
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
    """Return one row of COLUMNS from the columns of the contact table at one torque, sorted by position."""
    error, average = at["ste_um"], at["k_average_n_per_m"]
    finite_average = average[~np.isnan(average)]
    whole = finite_average.size == average.size
    return (
        torque,
        len(error),
        average.mean(),
        finite_average.min() if finite_average.size else np.nan,
        finite_average.max() if finite_average.size else np.nan,
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
    """Return the largest pressure of all positions, and the error at that position (MPa); nan where none
    has one.
    """
    if np.isnan(pressure).all():
        return np.nan, np.nan
    at = int(np.nanargmax(pressure))
    return float(pressure[at]), float(error[at])


def path_radii(pressure: Arrays) -> pd.DataFrame:
    """Compute the centroid of all contact forces over a pitch.

    The radius is the distance along the pinion's axis from the axis of the face gear, as assembled without
    errors.

    Parameters
    ----------
    pressure : Arrays
        Arrays as PRESSURE_ARRAYS.

    Returns
    -------
    pd.DataFrame
        Columns torque_n_m and path_radius_mm.
    """
    return _centroids(pressure, ["torque_n_m"])


def path_by_position(pressure: Arrays) -> pd.DataFrame:
    """Compute the centroid of the contact forces at each position, with the radius defined in `path_radii`.

    Parameters
    ----------
    pressure : Arrays
        Arrays as PRESSURE_ARRAYS.

    Returns
    -------
    pd.DataFrame
        Columns torque_n_m, position and path_radius_mm.
    """
    return _centroids(pressure, ["torque_n_m", "position"])


def _centroids(pressure: Arrays, keys: list[str]) -> pd.DataFrame:
    """Return table `keys` and `path_radius_mm`: force-weighted mean y of the loaded nodes, mm, by
    combination of keys.

    y runs along the pinion's axis from the gear's axis; `pressure` holds PRESSURE_ARRAYS.
    """
    force = pressure["force_n"]
    moment = force * 1e3 * pressure["point_m"][:, 1][pressure["node"]]
    frame = pd.DataFrame({key: pressure[key] for key in keys} | {"force": force, "moment": moment})
    sums = frame.groupby(keys, as_index=False).sum()
    sums["path_radius_mm"] = sums["moment"] / sums["force"]
    return sums[[*keys, "path_radius_mm"]]


@dataclass(frozen=True, eq=False)
class StudiedContact:
    """Contact results of one case of a study, or of the machine itself (study and point `nominal`).

    `study`, `point`, `label`: names of the study and the case, and its text in legends. `pair`: the
    record of the pair's geometry as stored by its stage (it has `unloaded` and `backlash_um`); `ltca`
    (LTCA_COLUMNS), `by_torque` (COLUMNS and `path_radius_mm`), `pressure` (PRESSURE_ARRAYS): as the
    contact stage stores them.
    """

    study: str
    point: str
    label: str
    pair: Mapping[str, Any]
    ltca: pd.DataFrame
    by_torque: pd.DataFrame
    pressure: Arrays

    @property
    def unloaded_path_mm(self) -> float:
        """Mean radius (mm) of the unloaded contact on the drive side: distance from the gear's axis, as
        assembled.
        """
        return float(np.mean(self.pair["unloaded"]["drive"]["path_pinion_y_mm"]))

    def torque_near(self, torque: float) -> float:
        """Return the solved torque nearest to a torque.

        Parameters
        ----------
        torque : float
            On the pinion, N m.

        Returns
        -------
        float
            Solved torque, N m.
        """
        return min(
            (float(solved_torque) for solved_torque in self.by_torque["torque_n_m"]),
            key=lambda t: abs(t - torque),
        )

    def label_at(self, torque: float) -> str:
        """Return the label, with the nearest solved torque where that differs.

        Parameters
        ----------
        torque : float
            On the pinion, N m.

        Returns
        -------
        str
            Text for a legend.
        """
        near = self.torque_near(torque)
        return self.label if near == torque else f"{self.label} ({near:g} N m)"

    @classmethod
    def from_columns(cls, points: Sequence[Sequence[str]], *fields: Sequence[Any]) -> "list[StudiedContact]":
        """Build cases from study, point and label of each, and columns of the other fields.

        Parameters
        ----------
        points : Sequence[Sequence[str]]
            Study, point and label of each case.
        fields : Sequence[Any]
            One sequence for each further field, in the order of the fields.

        Returns
        -------
        list of StudiedContact
            Cases in the order of `points`.
        """
        return [cls(*point, *parts) for point, *parts in zip(points, *fields, strict=True)]

    def over_pitch(self, torque: float) -> pd.DataFrame:
        """Return the rows of `ltca` at the solved torque nearest to a torque, with `path_radius_mm`, by
        position.

        Parameters
        ----------
        torque : float
            On the pinion, N m.

        Returns
        -------
        pd.DataFrame
            Columns LTCA_COLUMNS and `path_radius_mm`.
        """
        rows = self.ltca[self.ltca["torque_n_m"] == self.torque_near(torque)].sort_values("position")
        return rows.merge(path_by_position(self.pressure), on=["torque_n_m", "position"], how="left")


def study_table(cases: Sequence[StudiedContact]) -> pd.DataFrame:
    """Tabulate the cases of a study, one row a case and torque.

    Shifts (mm, positive outwards) are from the first case, the machine itself: `path_shift_mm` of the
    loaded path at the same torque (NaN where the machine was not solved at it), `unloaded_path_shift_mm`
    of the unloaded one.

    Parameters
    ----------
    cases : Sequence[StudiedContact]
        Cases, the machine itself first.

    Returns
    -------
    pd.DataFrame
        Columns study, point and label, those of `by_torque`, unloaded path radius, both shifts and
        backlash_um.
    """
    machine = cases[0]
    nominal_radius = machine.by_torque.set_index("torque_n_m")["path_radius_mm"]
    parts = []
    for case in cases:
        rows = case.by_torque.copy()
        for column, name in enumerate(("study", "point", "label")):
            rows.insert(column, name, getattr(case, name))
        rows["path_shift_mm"] = rows["path_radius_mm"] - rows["torque_n_m"].map(nominal_radius)
        rows["unloaded_path_radius_mm"] = case.unloaded_path_mm
        rows["unloaded_path_shift_mm"] = case.unloaded_path_mm - machine.unloaded_path_mm
        rows["backlash_um"] = float(case.pair["backlash_um"]["smallest"])
        parts.append(rows)
    return pd.concat(parts, ignore_index=True)
