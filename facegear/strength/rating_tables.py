"""Tables of a rating: safety of every flank, a row a way to fail, and the damage of each bin."""

from collections.abc import Mapping, Sequence
from itertools import groupby

import numpy as np
import pandas as pd

from facegear.strength.columns import CURVE_COLUMNS, DAMAGE_COLUMNS, RATING_COLUMNS, SAFETY_COLUMNS
from facegear.strength.contact_pressure import ContactPressure
from facegear.strength.duty import DutyBin
from facegear.strength.rating import Rated
from facegear.strength.root_stress import RootStress

POINTS = 61
"""Of a curve of allowed stress."""
WORST_FIRST = ("red", "amber", "green")


def safety_table(found: Sequence[Rated], pressure: ContactPressure) -> pd.DataFrame:
    """One row a flank, columns as SAFETY_COLUMNS: each way to fail beside the others, and the first to come.

    Reliability is the product of those of both failures, each by its worst method. `pressure` tells of the
    tip edges under the largest torque of any cycle.
    """
    rows = []
    for (body, flank), group in groupby(found, key=lambda one: (one.duty.body, one.duty.flank)):
        ways = list(group)
        safety = {(one.failure, one.method): one.safety for one in ways}
        nearest = min(ways, key=lambda one: one.safety / one.required)
        known = [
            np.nanmin(some)
            for failure in ("bending", "pitting")
            if np.isfinite(some := [one.reliability for one in ways if one.failure == failure]).any()
        ]
        edge_load, edge_length = pressure.edge_at(ways[0].duty.largest)
        rows.append(
            (
                *(body, flank, min((one.verdict for one in ways), key=WORST_FIRST.index)),
                safety["bending", "finite elements"],
                safety.get(("bending", "ISO 6336-3"), np.nan),
                *(safety.get(("pitting", "contact analysis"), np.nan), safety["pitting", "ISO 6336-2"]),
                *(1e-3 * edge_load, 1e3 * edge_length),
                min(one.life for one in ways) / 3600.0,
                float(np.prod(known)) if known else np.nan,
                f"{nearest.failure} ({nearest.method})",
                "; ".join(dict.fromkeys(reason for one in ways for reason in one.reasons)),
                all(bool(_within(one, pressure).all()) for one in ways),
            )
        )
    return _stated(pd.DataFrame(rows, columns=list(SAFETY_COLUMNS)), found)


def rating_table(
    found: Sequence[Rated], pressure: ContactPressure, roots: Mapping[str, RootStress]
) -> pd.DataFrame:
    """Safety and life, columns as RATING_COLUMNS; stress is that of the hardest load of any cycle.

    The error is that of the contact analysis' `pressure`, or of the mesh at the largest of `roots`; other
    methods have none.
    """
    rows = [
        (
            *_subject(one),
            1e-6 * float(one.stress.max(where=one.duty.cycles > 0.0, initial=0.0)),
            1e-6 * _error(one, pressure, roots),
            1e-6 * one.allowed,
            float(one.duty.cycles.sum()),
            one.safety,
            one.required,
            one.verdict,
            "; ".join(one.reasons),
            float(one.damage.sum()),
            one.life / 3600.0,
            one.reliability,
            bool(_within(one, pressure).all()),
        )
        for one in found
    ]
    return _stated(pd.DataFrame(rows, columns=list(RATING_COLUMNS)), found)


def _stated(table: pd.DataFrame, found: Sequence[Rated]) -> pd.DataFrame:
    """The table without reliability where no card has the shape of its distribution of lives."""
    return table if any(one.has_shape for one in found) else table.drop(columns="reliability")


def _error(one: Rated, pressure: ContactPressure, roots: Mapping[str, RootStress]) -> float:
    """Of the stress (Pa) under the hardest load, nan where it is not known."""
    if one.method == "contact analysis":
        return pressure.error_at(one.duty.largest)
    return roots[one.duty.gear].error_at(one.duty.largest) if one.method == "finite elements" else np.nan


def curve_table(found: Sequence[Rated]) -> pd.DataFrame:
    """Stress that may be repeated so many times, columns as CURVE_COLUMNS."""
    parts = []
    for one in found:
        cycles = np.geomspace(one.limit.cycles[0], one.limit.cycles[-1], POINTS)
        columns = (*_subject(one), cycles, 1e-6 * one.allowed * one.limit.factor(cycles))
        parts.append(pd.DataFrame(dict(zip(CURVE_COLUMNS, columns, strict=True))))
    return pd.concat(parts, ignore_index=True)


def damage_table(found: Sequence[Rated], duty: Sequence[DutyBin], pressure: ContactPressure) -> pd.DataFrame:
    """Largest torque (with all load factors) and stress, cycles and damage of each bin that loads a flank.

    Columns as DAMAGE_COLUMNS.
    """
    rows = []
    for one in found:
        within = _within(one, pressure)
        for number in np.unique(one.duty.bins):
            here = one.duty.bins == number
            rows.append(
                (
                    *(*_subject(one), number + 1, float(one.duty.torque[here].max())),
                    *(60.0 * duty[number].speed, duty[number].time / 3600.0),
                    1e-6 * float(one.stress[here].max()),
                    *(float(one.duty.cycles[here].sum()), float(one.damage[here].sum())),
                    bool(within[here].all()),
                )
            )
    return pd.DataFrame(rows, columns=list(DAMAGE_COLUMNS))


def _subject(one: Rated) -> tuple[str, ...]:
    return one.duty.body, one.duty.gear, one.duty.flank, one.failure, one.method


def _within(one: Rated, pressure: ContactPressure) -> np.ndarray:
    """Whether each load lies within the torques of the contact analysis, (n,)."""
    return pressure.within(one.duty.torque) | (one.duty.cycles == 0.0)
