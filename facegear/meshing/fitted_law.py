"""The load-dependent mesh law of a flank from its contact at many torques, and how well it meets them.

At every position the contact gives force and slope at the deflections of each torque; the cubics that come
nearest to them begin and end at deflections common to all positions, the levels. Each level then has a
Fourier series over the pitch. Below the first level the force is F1 (x / x1)^n with n = k1 x1 / F1, each
pair's own: touching bodies are not linear, and the hats of the lattice do not resolve so light a touch.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Array, Arrays, Integers
from facegear.errors import FacegearError
from facegear.meshing.force_table import ForceTable
from facegear.meshing.load_dependent import load_dependent_law

GEARS, FLANKS = ("upper", "lower"), ("drive", "back")
"""Names of gears and flanks, in the order of the rows and columns of `flank_variant`."""
LAW_ARRAYS = {
    "level_m": (None, None),
    "force_n": (None, None, 2, None),
    "slope_n_per_m": (None, None, 2, None),
    "flank_variant": (2, 2),
}
"""Arrays of the law: a table a row, Fourier series with the sine part first; `flank_variant` says which row
each gear's (upper, lower) flank (drive, back) has.
"""
LEVEL_COLUMNS = ("deflection_um", "torque_n_m", "force_n", "slope_n_per_m", "table_rms_percent")
"""Columns of level_table() after gear and flank."""
LIGHTEST = 1.0 / 32.0
"""Smallest torque solved, over the largest."""
EXPONENT = 1.3
"""Approximate exponent of the force over the deflection: with it levels lie evenly in the root of the
deflection.
"""
TORQUE_COUNT = 13
"""Number of torques that are solved: every second one gives the table, those between show its error."""
PIECES = (1, 2, 3, 4, 5)
"""Numbers of cubics between the first level and the last, the fewest first: a motion stops at every level
that it passes.
"""
CROWDING = (1.0, 1.5, 2.0)
"""Exponents with which levels crowd towards the first; 1: they lie evenly."""
SLOPE_WEIGHT = 0.25
"""Part of the distance to the next solution over which a slope counts as much as a force."""
REACH = 1.2
"""Largest torque solved over the one that the law is to reach at every position of the pitch."""
BELOW = (0.5, 0.25, 0.125)
"""Further levels, as parts of the first."""
RMS, LARGEST = 1e-3, 4e-3
"""Aims for the rms and the largest error of a table, over the largest mean force."""
ROUNDING = 1e-6
"""Part of the steepest slope by which a force may fall, as the Fourier series are cut."""


@dataclass(frozen=True, eq=False)
class FlankContacts:
    """Solutions of one flank: forces (t,) in N, rising; deflections beyond first contact (t, p), m, and
    slopes (t, p), N/m, at p even positions of a pitch.
    """

    forces: Array
    deflections: Array
    slopes: Array

    def at(self, rows: Sequence[int]) -> "FlankContacts":
        """Return the solved contacts at some of the forces.

        Parameters
        ----------
        rows : Sequence of int
            Indices of the forces.

        Returns
        -------
        FlankContacts
            N, m and N/m.
        """
        indices = list(rows)
        return FlankContacts(self.forces[indices], self.deflections[indices], self.slopes[indices])


@dataclass(frozen=True, eq=False)
class TableError:
    """Difference between a force table and contact solutions up to its last level.

    rms, largest: root mean square and largest size over `force`, dimensionless; force: mean force at the
    table's last level, N.
    """

    rms: float
    largest: float
    force: float

    @property
    def percent(self) -> tuple[float, float]:
        """Root mean square and largest error, in percent of `force`."""
        return 100.0 * self.rms, 100.0 * self.largest

    @property
    def excess(self) -> float:
        """Larger of rms / RMS and largest / LARGEST, dimensionless: up to 1 both errors meet their aims."""
        return max(self.rms / RMS, self.largest / LARGEST)


def law_torques(largest: float) -> list[float]:
    """Return the torques at which contact is solved for a law that reaches the largest at every phase.

    TORQUE_COUNT torques from LIGHTEST to 1 times REACH times the largest; their roots of degree 2
    EXPONENT are evenly spaced.

    Parameters
    ----------
    largest : float
        Largest torque of the law, N m.

    Returns
    -------
    list of float
        N m, rising.
    """
    power, largest = 2.0 * EXPONENT, REACH * largest
    parts = np.linspace(LIGHTEST ** (1.0 / power), 1.0, TORQUE_COUNT)
    return [float(largest * part**power) for part in parts[:-1]] + [float(largest)]


def fitted_tables(flanks: Sequence[FlankContacts], orders: int) -> tuple[list[ForceTable], list[TableError]]:
    """Fit the tables of flanks with the fewest and evenest levels that meet the aim.

    All flanks get the same number of pieces and crowding. Every second solution is fitted; the others
    give the errors. If no choice meets the aims RMS and LARGEST, the one with the smallest error is
    returned. Choices whose force falls somewhere are refused.

    Parameters
    ----------
    flanks : Sequence of FlankContacts
        Contact solutions of the flanks at TORQUE_COUNT forces each.
    orders : int
        Number of harmonics kept, at most as many as the positions give.

    Returns
    -------
    pair of list of ForceTable and list of TableError
        Table of each flank, N and N/m, and its relative error.

    Raises
    ------
    FacegearError
        If the force falls while the deflection grows, for every choice.
    """
    fit_contacts = [flank.at(range(0, TORQUE_COUNT, 2)) for flank in flanks]
    between = [flank.at(range(1, TORQUE_COUNT, 2)) for flank in flanks]
    best, smallest = None, np.inf
    for pieces, crowding in product(PIECES, CROWDING):
        tables = [force_table(flank, pieces, crowding, orders) for flank in fit_contacts]
        errors = [table_error(*pair) for pair in zip(tables, between, strict=True)]
        excess = max(error.excess for error in errors)
        if any(map(falls, tables)) or excess >= smallest:
            continue
        best, smallest = (tables, errors), excess
        if excess <= 1.0:
            break
    if best is None:
        fall = min(table.min_slope for table in tables)
        raise FacegearError(
            f"mesh law: the force falls with the deflection, by {fall:.4g} N/m: the mesh of the flanks is "
            f"too coarse for the lightest contact, {flanks[0].forces[0]:.3g} N"
        )
    return best


def falls(table: ForceTable) -> bool:
    """Whether the force falls somewhere while the deflection grows, by more than cutting the series does.

    Parameters
    ----------
    table : ForceTable
        The table.

    Returns
    -------
    bool
        True if its smallest slope is below -ROUNDING of the steepest.
    """
    return table.min_slope < -ROUNDING * table.steepest


def force_table(contacts: FlankContacts, pieces: int, crowding: float, orders: int) -> ForceTable:
    """Fit the table whose cubics come nearest to the contacts' forces and slopes at every position, by least
    squares.

    Its first level has the largest deflection of the lightest contact, the last the smallest of the heaviest.

    Parameters
    ----------
    contacts : FlankContacts
        Contact solutions of a flank.
    pieces : int
        Number of cubics between these levels.
    crowding : float
        Exponent with which levels crowd towards the first, dimensionless.
    orders : int
        Number of harmonics kept, at most as many as the positions give.

    Returns
    -------
    ForceTable
        N and N/m.

    Raises
    ------
    FacegearError
        If the levels overlap.
    """
    order = min(orders, (contacts.deflections.shape[1] - 1) // 2)
    deflections = contacts.deflections
    first, last = deflections[0].max(), deflections[-1].min()
    if first >= last:
        raise FacegearError(
            "mesh law: over a pitch the deflections under the smallest of contact.torques_n_m reach "
            "those under the largest: the torques must lie further apart"
        )
    levels = first + (last - first) * np.linspace(0.0, 1.0, pieces + 1) ** crowding
    forces, slopes = _at_levels(contacts, levels)
    exponent = first * slopes[0] / forces[0]
    parts = np.sort(BELOW)[:, None]
    lower = forces[0] * parts**exponent
    lower_slopes = exponent * lower / (parts * first)
    zeros = np.zeros((1, deflections.shape[1]))
    return ForceTable(
        np.concatenate([[0.0], parts[:, 0] * first, levels]),
        _series(np.concatenate([zeros, lower, forces]), order),
        _series(np.concatenate([zeros, lower_slopes, slopes]), order),
    )


def table_error(table: ForceTable, contacts: FlankContacts) -> TableError:
    """Compare a table with contact solutions up to its last level.

    Parameters
    ----------
    table : ForceTable
        The table.
    contacts : FlankContacts
        Contact solutions.

    Returns
    -------
    TableError
        Errors relative to the mean force at the last level, N.
    """
    positions = np.arange(contacts.deflections.shape[1]) / contacts.deflections.shape[1]
    law = load_dependent_law([table])
    table_forces = law.force(positions, contacts.deflections[..., None])[..., 0]
    within = contacts.deflections <= table.levels[-1]
    force = float(table.forces[-1, 1, 0])
    differences = (table_forces - contacts.forces[:, None])[within] / force
    return TableError(float(np.sqrt((differences**2).mean())), float(np.abs(differences).max()), force)


def law_arrays(tables: Sequence[ForceTable], numbers: Integers) -> dict[str, AnyArray]:
    """Return the load-dependent law as the arrays that LAW_ARRAYS lists.

    Parameters
    ----------
    tables : Sequence of ForceTable
        Tables with as many levels and harmonics.
    numbers : (gears, flanks) array of int
        Index of the table that each flank has.

    Returns
    -------
    dict of str to array
        m, N and N/m, shapes as in LAW_ARRAYS (tables, levels, ...).
    """
    return {
        "level_m": np.array([table.levels for table in tables]),
        "force_n": np.array([table.forces for table in tables]),
        "slope_n_per_m": np.array([table.slopes for table in tables]),
        "flank_variant": numbers,
    }


def forces_over_pitch(law: Arrays, row: int, phases: Array, amounts: Array) -> Array:
    """Return the forces of one table of a stored law over deflection and mesh phase.

    Parameters
    ----------
    law : Arrays
        Arrays as LAW_ARRAYS.
    row : int
        Index of the table.
    phases : (phases,) array
        Mesh periods.
    amounts : (amounts,) array
        Compression, m.

    Returns
    -------
    (amounts, phases) array
        N.
    """
    table = ForceTable(law["level_m"][row], law["force_n"][row], law["slope_n_per_m"][row])
    beyond = np.broadcast_to(amounts[:, None, None], (amounts.size, phases.size, 1))
    return load_dependent_law([table]).force(phases, beyond)[..., 0]


def level_table(
    tables: Sequence[ForceTable], errors: Sequence[TableError], numbers: Integers, base_radius: float
) -> pd.DataFrame:
    """Return mean force and slope of every gear's flanks at every level, with the error of the table beside
    them.

    Parameters
    ----------
    tables : Sequence of ForceTable
        The tables.
    errors : Sequence of TableError
        Error of each table.
    numbers : (gears, flanks) array of int
        Index of the table that each flank has.
    base_radius : float
        Base radius of the pinion, m.

    Returns
    -------
    pd.DataFrame
        Columns gear, flank, LEVEL_COLUMNS and table_largest_percent.
    """
    rows = [
        (gear, flank, 1e6 * level, base_radius * force, force, slope, *error.percent)
        for gear, row in zip(GEARS, numbers, strict=True)
        for flank, number in zip(FLANKS, row, strict=True)
        for table, error in [(tables[number], errors[number])]
        for level, force, slope in zip(
            table.levels, table.forces[:, 1, 0], table.slopes[:, 1, 0], strict=True
        )
    ]
    return pd.DataFrame(rows, columns=["gear", "flank", *LEVEL_COLUMNS, "table_largest_percent"])


def _at_levels(contacts: FlankContacts, levels: Array) -> tuple[Array, Array]:
    """Return forces (N) and slopes (N/m) at levels (n,), m, each (n, p), by least squares at each of p
    positions.

    They define the cubics that come nearest to forces and slopes of the contacts there. At the first
    level they are those of the cubic between the two lightest contacts, as the force below it follows
    from them. Unknown slopes are counted in units of the mean slope of a cubic with unit force at its
    end, so that all columns of the least squares are of one size.
    """
    count = levels.size
    coefficients = np.empty((2 * count, contacts.deflections.shape[1]))
    known_columns, unknown_columns = np.array([0, count]), np.delete(np.arange(2 * count), [0, count])
    units = np.repeat([1.0, count / levels[-1]], count)
    for p, (deflections, stiffness) in enumerate(zip(contacts.deflections.T, contacts.slopes.T, strict=True)):
        lightest = np.concatenate([contacts.forces[:2], stiffness[:2]])
        coefficients[known_columns, p] = np.concatenate(_cubics(deflections[:2], levels[:1])) @ lightest
        weight = SLOPE_WEIGHT * np.gradient(deflections)
        values, slopes = _cubics(levels, deflections)
        rows = np.concatenate([values, weight[:, None] * slopes])
        right_side = (
            np.concatenate([contacts.forces, weight * stiffness])
            - rows[:, known_columns] @ coefficients[known_columns, p]
        )
        solution = np.linalg.lstsq((rows * units)[:, unknown_columns], right_side)[0]
        coefficients[unknown_columns, p] = units[unknown_columns] * solution
    return coefficients[:count], coefficients[count:]


def _cubics(levels: Array, amounts: Array) -> tuple[Array, Array]:
    """Return values and slopes (a, 2 n) of the Hermite cubics between levels (n,), m, at amounts (a,), m.

    The first n columns are cubics with unit force at one level, the others with unit slope. Beyond the
    levels the outer cubics go on.
    """
    at = np.clip(np.searchsorted(levels, amounts, side="right") - 1, 0, levels.size - 2)
    width = levels[at + 1] - levels[at]
    t = (amounts - levels[at]) / width
    values, slopes = np.zeros((2, amounts.size, 2, levels.size))
    rows = np.arange(amounts.size)
    for side, force, slope, force_rise, slope_rise in (
        (0, (1 + 2 * t) * (1 - t) ** 2, t * (1 - t) ** 2, 6 * t * (t - 1), (1 - t) * (1 - 3 * t)),
        (1, t**2 * (3 - 2 * t), t**2 * (t - 1), 6 * t * (1 - t), t * (3 * t - 2)),
    ):
        values[rows, 0, at + side], values[rows, 1, at + side] = force, slope * width
        slopes[rows, 0, at + side], slopes[rows, 1, at + side] = force_rise / width, slope_rise
    return values.reshape(amounts.size, -1), slopes.reshape(amounts.size, -1)


def _series(values: Array, orders: int) -> Array:
    """Return the Fourier series (rows, 2, orders + 1), sine part first, of samples (rows, p) over even
    phases, cut after `orders`; in the unit of the samples.
    """
    terms = np.fft.rfft(values, axis=1)[:, : orders + 1] / values.shape[1]
    terms[:, 1:] *= 2.0
    return np.stack([-terms.imag, terms.real], axis=1)
