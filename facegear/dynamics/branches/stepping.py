"""Steps along a branch: the guess ahead, when a step is accepted, how long the next one is."""

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint, solve_point
from facegear.errors import NotConverged

STRAIGHT = 0.9
"""Least cosine between neighbouring tangents."""
CORRECTION = 0.2
"""Largest correction over the step."""
TURN, AIM, FASTEST = 0.3, 0.15, 2.5
"""Angle between tangents and correction over the step that steps are made for; their fastest growth."""
DRIFT = 0.3
"""Largest change of the multipliers' moduli near the unit circle over a step."""
SURE = 1e-3
"""A change of parity over a longer step is tried again: the other leg of a fold may have been met."""


def step_along(
    period_map: PeriodMap, here: BranchPoint, before: BranchPoint | None, step: float
) -> BranchPoint:
    """One step along the tangent, bent as over the step before. Raises NotConverged if it is refused."""
    guess = _ahead(here, before, step)
    there = solve_point(period_map, guess, here.tangent, here.tangent, here.linear, CORRECTION * step)
    reason = _refusal(here, there, step)
    if reason:
        raise NotConverged("branches", f"{period_map.family.name} = {there.value:.9g}", reason)
    return there


def _ahead(here: BranchPoint, before: BranchPoint | None, step: float) -> Array:
    """A guess at a step's length ahead."""
    guess = here.x + step * here.tangent
    if before is None:
        return guess
    bend = (here.tangent - before.tangent) / np.linalg.norm(here.x - before.x)
    return guess + 0.5 * step**2 * bend if np.linalg.norm(bend) * step < 0.5 else guess


def _refusal(here: BranchPoint, there: BranchPoint, step: float) -> str:
    """Why a step is not accepted, or an empty string."""
    chord = (there.x - here.x) / np.linalg.norm(there.x - here.x)
    straight = min(here.tangent @ there.tangent, chord @ here.tangent, chord @ there.tangent)
    if here.linear.neutral.shape != there.linear.neutral.shape and step <= SURE:
        return ""
    if straight < STRAIGHT:
        return "the branch turns too sharply"
    if here.parity != there.parity and step > SURE:
        return "the branch may have been left"
    if step > SURE and _drift(here, there) > DRIFT:
        return "multipliers move too far"
    return ""


def _drift(here: BranchPoint, there: BranchPoint) -> float:
    """Largest change of a modulus, in sorted order, among those near the unit circle."""
    first, second = np.abs(here.multipliers), np.abs(there.multipliers)
    if first.size != second.size:
        return 0.0
    near = (first > 0.6) | (second > 0.6)
    scale = np.maximum(np.maximum(first, second), 1.0)
    return float((np.abs(first - second) / scale)[near].max(initial=0.0))


def next_length(step: float, before: BranchPoint | None, here: BranchPoint, there: BranchPoint) -> float:
    """The next step: one that turns by TURN and needs a correction of AIM, as far as the last one tells."""
    angle = float(np.arccos(np.clip(here.tangent @ there.tangent, -1.0, 1.0)))
    off = float(np.linalg.norm(there.x - _ahead(here, before, step))) / step
    growth = min(TURN / max(angle, 1e-6), np.sqrt(AIM / max(off, 1e-9)))
    return step * float(np.clip(growth, 0.5, FASTEST))
