"""Tables of a rating: one row a body and failure, and the damage of each bin."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.strength.columns import CURVE_COLUMNS, DAMAGE_COLUMNS, RATING_COLUMNS
from facegear.strength.rating import DutyBin, Rated

POINTS = 61
"""Of a curve of allowed stress."""


def rating_table(found: Sequence[Rated]) -> pd.DataFrame:
    """Safety and life, columns as RATING_COLUMNS; stress is that of the hardest bin."""
    rows = [
        (
            one.body,
            one.failure,
            one.method,
            1e-6 * float(one.stress.max()),
            1e-6 * one.allowed,
            float(one.cycles.sum()),
            one.safety,
            one.required,
            one.verdict,
            float(one.damage.sum()),
            one.life / 3600.0,
        )
        for one in found
    ]
    return pd.DataFrame(rows, columns=list(RATING_COLUMNS))


def curve_table(found: Sequence[Rated]) -> pd.DataFrame:
    """Stress that may be repeated so many times, columns as CURVE_COLUMNS."""
    parts = []
    for one in found:
        cycles = np.geomspace(one.limit.cycles[0], one.limit.cycles[-1], POINTS)
        stress = 1e-6 * one.allowed * one.limit.factor(cycles)
        columns = (one.body, one.failure, one.method, cycles, stress)
        parts.append(pd.DataFrame(dict(zip(CURVE_COLUMNS, columns, strict=True))))
    return pd.concat(parts, ignore_index=True)


def damage_table(found: Sequence[Rated], duty: Sequence[DutyBin]) -> pd.DataFrame:
    """Stress, cycles and damage of each bin, columns as DAMAGE_COLUMNS; torque with all load factors."""
    parts = []
    for one in found:
        columns = (
            *(one.body, one.failure, one.method),
            np.arange(1, len(duty) + 1),
            np.array([load.torque for load in duty]),
            np.array([60.0 * load.speed for load in duty]),
            np.array([load.time / 3600.0 for load in duty]),
            *(1e-6 * one.stress, one.cycles, one.damage),
        )
        parts.append(pd.DataFrame(dict(zip(DAMAGE_COLUMNS, columns, strict=True))))
    return pd.concat(parts, ignore_index=True)
