"""The load-dependent mesh law of a flank from its contact at many torques, and how well it meets them.

At every position the contact gives force and slope at the deflections of each torque; a cubic through two
neighbours gives them at deflections common to all positions, the levels. Each level then has a Fourier
series over the pitch. Below the first level the force is F1 (x / x1)^n with n = k1 x1 / F1, each pair's own:
touching bodies are not linear, and the hats of the lattice do not resolve so light a touch.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Array, Integers
from facegear.errors import FacegearError
from facegear.mesh_law.load_dependent import ForceTable, load_dependent_law

GEARS, FLANKS = ("upper", "lower"), ("drive", "back")
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
LIGHTEST = 1.0 / 32.0
"""Smallest torque solved, over the largest."""
EXPONENT = 1.3
"""Of the force over the deflection, roughly: with it levels lie evenly in the root of the deflection."""
INTERVALS = 12
"""Between the torques that are solved."""
CHOICES = ((0, 4, 8, 12), (0, 4, 7, 10, 12), (0, 2, 5, 7, 9, 12), (0, 2, 4, 6, 8, 10, 12))
"""Those of them that give levels, the fewest first: a motion stops at every level that it passes."""
REACH = 1.2
"""Largest torque solved over the one that the law is to reach at every position of the pitch."""
BELOW = (0.5, 0.25, 0.125)
"""Further levels, as parts of the first."""
RMS, LARGEST = 1e-3, 4e-3
"""What is aimed at: the table's error over the largest mean force."""
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
        """Some of the forces."""
        chosen = list(rows)
        return FlankContacts(self.forces[chosen], self.deflections[chosen], self.slopes[chosen])


@dataclass(frozen=True, eq=False)
class TableError:
    """Largest and rms difference of a table from contact solutions between its levels, over `force`, the
    mean force (N) at its last level.
    """

    rms: float
    largest: float
    force: float

    @property
    def percent(self) -> tuple[float, float]:
        """Rms and largest, in percent."""
        return 100.0 * self.rms, 100.0 * self.largest

    @property
    def meets_aim(self) -> bool:
        """Whether no finer table is needed."""
        return self.rms <= RMS and self.largest <= LARGEST


def law_torques(largest: float) -> list[float]:
    """Torques (N m) at which contact is solved for a law that reaches the largest at every phase, rising."""
    power, largest = 2.0 * EXPONENT, REACH * largest
    parts = np.linspace(LIGHTEST ** (1.0 / power), 1.0, INTERVALS + 1)
    return [float(largest * part**power) for part in parts[:-1]] + [float(largest)]


def fitted_tables(flanks: Sequence[FlankContacts], orders: int) -> tuple[list[ForceTable], list[TableError]]:
    """Tables of flanks with the fewest levels that meet the aim, else with the most, and their errors.

    orders: harmonics kept, at most as many as the positions give. Raises FacegearError where the force falls
    while the deflection grows.
    """
    for rows in CHOICES:
        tables = [force_table(flank.at(rows), orders) for flank in flanks]
        errors = [table_error(*both) for both in zip(tables, flanks, strict=True)]
        if all(error.meets_aim for error in errors):
            break
    return tables, errors


def force_table(contacts: FlankContacts, orders: int) -> ForceTable:
    """The table with a level for each force of the contacts. Raises FacegearError where it would fall."""
    kept = min(orders, (contacts.deflections.shape[1] - 1) // 2)
    reached = contacts.deflections
    levels = reached.mean(axis=1)
    levels[0], levels[-1] = reached[0].max(), reached[-1].min()
    if (np.diff(levels) <= 0.0).any():
        raise FacegearError("mesh law: the deflections over a pitch overlap those of the next torque")
    forces, slopes = _at_levels(contacts, levels)
    first, exponent = levels[0], levels[0] * slopes[0] / forces[0]
    parts = np.sort(BELOW)[:, None]
    lower = forces[0] * parts**exponent
    lower_slopes = exponent * lower / (parts * first)
    nothing = np.zeros((1, reached.shape[1]))
    table = ForceTable(
        np.concatenate([[0.0], parts[:, 0] * first, levels]),
        _series(np.concatenate([nothing, lower, forces]), kept),
        _series(np.concatenate([nothing, lower_slopes, slopes]), kept),
    )
    if table.min_slope < -ROUNDING * table.steepest:
        raise FacegearError(
            f"mesh law: the force falls with the deflection, by {table.min_slope:.4g} N/m: the mesh of the "
            f"flanks is too coarse for the lightest contact, {contacts.forces[0]:.3g} N"
        )
    return table


def table_error(table: ForceTable, contacts: FlankContacts) -> TableError:
    """The table against contact solutions up to its last level."""
    positions = np.arange(contacts.deflections.shape[1]) / contacts.deflections.shape[1]
    law = load_dependent_law([table])
    given = law.force(positions, contacts.deflections[..., None])[..., 0]
    within = contacts.deflections <= table.levels[-1]
    force = float(table.forces[-1, 1, 0])
    missed = (given - contacts.forces[:, None])[within] / force
    return TableError(float(np.sqrt((missed**2).mean())), float(np.abs(missed).max()), force)


def law_arrays(tables: Sequence[ForceTable], numbers: Integers) -> dict[str, AnyArray]:
    """Arrays as LAW_ARRAYS; numbers (gears, flanks): the table that each flank has."""
    return {
        "level_m": np.array([table.levels for table in tables]),
        "force_n": np.array([table.forces for table in tables]),
        "slope_n_per_m": np.array([table.slopes for table in tables]),
        "flank_variant": numbers,
    }


def level_table(
    tables: Sequence[ForceTable], errors: Sequence[TableError], numbers: Integers, base_radius: float
) -> pd.DataFrame:
    """Mean force and slope of every gear's flanks at every level, with the error of the table beside them."""
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
    """Forces and slopes (levels, p) by the cubic between the two nearest solutions of each position."""
    forces, slopes = np.empty((2, levels.size, contacts.deflections.shape[1]))
    for p, (reached, stiffness) in enumerate(zip(contacts.deflections.T, contacts.slopes.T, strict=True)):
        at = np.clip(np.searchsorted(reached, levels, side="right") - 1, 0, reached.size - 2)
        width = reached[at + 1] - reached[at]
        rise = (contacts.forces[at + 1] - contacts.forces[at]) / width
        begin, end = stiffness[at], stiffness[at + 1]
        ahead = levels - reached[at]
        bend, twist = (3.0 * rise - 2.0 * begin - end) / width, (begin + end - 2.0 * rise) / width**2
        forces[:, p] = contacts.forces[at] + ahead * (begin + ahead * (bend + ahead * twist))
        slopes[:, p] = begin + ahead * (2.0 * bend + 3.0 * ahead * twist)
    return forces, slopes


def _series(values: Array, orders: int) -> Array:
    """Fourier series (rows, 2, orders + 1) of samples (rows, p)."""
    terms = np.fft.rfft(values, axis=1)[:, : orders + 1] / values.shape[1]
    terms[:, 1:] *= 2.0
    return np.stack([-terms.imag, terms.real], axis=1)
