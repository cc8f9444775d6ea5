"""Take steps along a branch: the guess ahead, when a step is accepted, and the length of the next step."""

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint, solve_point
from facegear.errors import NotConverged

STRAIGHT = 0.9
"""Least cosine between neighbouring tangents."""
CORRECTION = 0.2
"""Largest correction, as a fraction of the step."""
TURN, AIM, FASTEST = 0.3, 0.15, 2.5
"""Angle between tangents, rad, and ratio of correction to step for which a step is chosen; largest
growth of steps.
"""
DRIFT = 0.3
"""Largest change of the multipliers' moduli near the unit circle over a step."""
SURE = 1e-3
"""A change of parity over a longer step is tried again: the other leg of a fold may have been met."""


def step_along(
    period_map: PeriodMap, current_point: BranchPoint, before: BranchPoint | None, step: float
) -> BranchPoint:
    """Take one step along the tangent, bent as over the step before.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    current_point : BranchPoint
        Point from which to step.
    before : BranchPoint or None
        Point before it.
    step : float
        Length of the step, dimensionless.

    Returns
    -------
    BranchPoint
        The next point.

    Raises
    ------
    NotConverged
        If the step is refused, with the reason.
    """
    guess = _ahead(current_point, before, step)
    next_point = solve_point(
        period_map,
        guess,
        current_point.tangent,
        current_point.tangent,
        current_point.linear,
        CORRECTION * step,
    )
    reason = _refusal(current_point, next_point, step)
    if reason:
        raise NotConverged("branches", f"{period_map.family.name} = {next_point.value:.9g}", reason)
    return next_point


def _ahead(current_point: BranchPoint, before: BranchPoint | None, step: float) -> Array:
    """Predict the point one step ahead."""
    guess = current_point.x + step * current_point.tangent
    if before is None:
        return guess
    bend = (current_point.tangent - before.tangent) / np.linalg.norm(current_point.x - before.x)
    return guess + 0.5 * step**2 * bend if np.linalg.norm(bend) * step < 0.5 else guess


def _refusal(current_point: BranchPoint, next_point: BranchPoint, step: float) -> str:
    """Return why a step is not accepted, or an empty string."""
    chord = (next_point.x - current_point.x) / np.linalg.norm(next_point.x - current_point.x)
    straight = min(
        current_point.tangent @ next_point.tangent, chord @ current_point.tangent, chord @ next_point.tangent
    )
    if current_point.linear.neutral.shape != next_point.linear.neutral.shape and step <= SURE:
        return ""
    if straight < STRAIGHT:
        return "the branch turns too sharply"
    if current_point.parity != next_point.parity and step > SURE:
        return "the branch may have been left"
    if step > SURE and _drift(current_point, next_point) > DRIFT:
        return "multipliers move too far"
    return ""


def _drift(current_point: BranchPoint, next_point: BranchPoint) -> float:
    """Largest change of a modulus, in sorted order, among those near the unit circle."""
    first, second = np.abs(current_point.multipliers), np.abs(next_point.multipliers)
    if first.size != second.size:
        return 0.0
    near = (first > 0.6) | (second > 0.6)
    scale = np.maximum(np.maximum(first, second), 1.0)
    return float((np.abs(first - second) / scale)[near].max(initial=0.0))


def next_length(
    step: float, before: BranchPoint | None, current_point: BranchPoint, next_point: BranchPoint
) -> float:
    """Choose the next step so that it turns by TURN and needs a correction of AIM, as far as the last step
    tells.

    Parameters
    ----------
    step : float
        Length of the last step, dimensionless.
    before : BranchPoint or None
        Point before the last step's start.
    current_point, next_point : BranchPoint
        Start and end of the last step.

    Returns
    -------
    float
        Length of the next step, dimensionless.
    """
    angle = float(np.arccos(np.clip(current_point.tangent @ next_point.tangent, -1.0, 1.0)))
    off = float(np.linalg.norm(next_point.x - _ahead(current_point, before, step))) / step
    growth = min(TURN / max(angle, 1e-6), np.sqrt(AIM / max(off, 1e-9)))
    return step * float(np.clip(growth, 0.5, FASTEST))
