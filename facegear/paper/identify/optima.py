"""Separate optima of a search: best points that are not neighbours of better ones."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.paper.identify.inputs import Space

APART = 0.1
"""Distance in the unit cube (phase cyclic) below which two points belong to one optimum."""


def unit_points(rows: pd.DataFrame, space: Space) -> NDArray[np.float64]:
    """Positions in the unit cube, shape (rows, 3): log torque, tail share, phase of e(t)."""
    low, high = np.log(space.torque)
    first, last = space.tail_share
    return np.column_stack(
        [
            (np.log(rows["per_input_n_m"]) - low) / (high - low),
            (rows["tail_share"] - first) / (last - first),
            rows["error_phase_deg"] / 360.0,
        ]
    )


def separate_optima(rows: pd.DataFrame, space: Space, most: int) -> pd.DataFrame:
    """At most `most` rows, best first.

    Within a branch they are at least APART from each other; different branches are different optima.
    """
    ranked = rows.sort_values("misfit", kind="stable").reset_index(drop=True)
    points = unit_points(ranked, space)
    kept: list[int] = []
    for i in range(len(ranked)):
        same = [j for j in kept if ranked["branch"].iloc[j] == ranked["branch"].iloc[i]]
        if all(_distance(points[i], points[j]) > APART for j in same):
            kept.append(i)
        if len(kept) == most:
            break
    return ranked.iloc[kept].reset_index(drop=True)


def _distance(first: NDArray[np.float64], second: NDArray[np.float64]) -> float:
    apart = np.abs(first - second)
    apart[2] = min(apart[2], 1.0 - apart[2])
    return float(np.linalg.norm(apart))
