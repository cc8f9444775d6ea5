"""Find how far stable motions are from their ends, and where several of them exist."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from facegear.motion.branches.continuation import (
    NON_LIMITING_KINDS,
    Branch,
    ContinuationSettings,
    follow,
    reverse_tangent,
)
from facegear.motion.branches.explore import crossings
from facegear.motion.branches.family import Family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint, at_parameter
from facegear.motion.branches.special import Kind, Special

SAME_SPEED = 1e-9
"""Relative difference below which two ends of ranges are one: rounding of their logarithms."""
ENDING = (Kind.FOLD, Kind.DOUBLING, Kind.TORUS, Kind.BRANCH)
"""Special points at which a motion may end or change its stability."""


@dataclass(frozen=True, eq=False)
class StabilityLimit:
    """Limit at which a stable motion first loses its stability or its existence when one parameter changes.

    Attributes
    ----------
    branch, period : int
        Number of the motion's branch, and its mesh periods.
    parameter, start : str, float
        Name of the parameter, and its value at the motion.
    direction : str
        "up" or "down".
    special : Special or None
        Special point that is met first; None if there is none within the range.
    end_value : float
        Value of the parameter at the special point, else at the end of the branch.
    """

    branch: int
    period: int
    parameter: str
    start: float
    direction: str
    special: Special | None
    end_value: float


def stable_at(branches: Sequence[Branch], value: float) -> list[tuple[int, BranchPoint]]:
    """Return the stable orbits at a value of the parameter.

    Parameters
    ----------
    branches : sequence of Branch
        Branches followed.
    value : float
        The parameter, in its unit.

    Returns
    -------
    list of tuple
        Index of the branch, and the orbit, one for each passage.
    """
    return [
        (number, point)
        for number, branch in enumerate(branches)
        for point in crossings(branch, value)
        if point.stable
    ]


def stability_limits(
    branches: Sequence[Branch], families: Sequence[tuple[Family, float, ContinuationSettings]], value: float
) -> list[StabilityLimit]:
    """Find the first special point of every stable motion, in both directions of each family.

    An image has the limits of its original.

    Parameters
    ----------
    branches : sequence of Branch
        Branches followed.
    families : sequence of tuple
        Family, the value of its parameter at the motion, and the range to search.
    value : float
        Parameter of the branches at which the motions are taken, in its unit.

    Returns
    -------
    list of StabilityLimit
        Limits sorted by branch; up, then down, in each family.
    """
    originals = [(n, point) for n, point in stable_at(branches, value) if branches[n].image_of is None]
    limits = []
    for number, point in originals:
        period_map = branches[number].period_map
        for family, start, run in families:
            limits += _limits_of(replace(period_map, family=family), number, point, start, run)
    images = [
        replace(limit, branch=number)
        for number, branch in enumerate(branches)
        for limit in limits
        if branch.image_of == limit.branch
    ]
    return sorted([*limits, *images], key=lambda limit: limit.branch)


def _limits_of(
    period_map: PeriodMap, number: int, point: BranchPoint, start: float, run: ContinuationSettings
) -> list[StabilityLimit]:
    """Follow a motion up and down a parameter from the value `start` to the first loss of stability, or
    the end of the range.

    The map `period_map` is over the family of that parameter; `number` is that of the motion's branch.
    """
    start_point = at_parameter(period_map, point.z, float(np.log(start)))
    run = replace(run, to_first=True)
    sides = []
    for direction in ("up", "down"):
        sign = 1.0 if direction == "up" else -1.0
        looking = start_point if start_point.tangent[-1] * sign > 0.0 else reverse_tangent(start_point)
        branch = follow(period_map, looking, run, both_ways=False)
        special = next(
            (
                special_point
                for special_point in branch.specials
                if special_point.kind not in NON_LIMITING_KINDS
            ),
            None,
        )
        end_value = branch.points[-1].value if special is None else special.point.value
        sides.append(
            StabilityLimit(
                number, period_map.period, period_map.family.name, start, direction, special, float(end_value)
            )
        )
    return sides


def coexistence_ranges(branches: Sequence[Branch]) -> list[tuple[float, float, tuple[int, ...]]]:
    """Find the ranges of the parameter, between special points, in which several stable motions exist.

    Parameters
    ----------
    branches : sequence of Branch
        Branches followed.

    Returns
    -------
    list of tuple
        Both ends in the parameter's unit, and the index of a branch for each stable motion (repeated if
        it has several).
    """
    edges = sorted(
        {
            special.point.value
            for b in branches
            for special in b.specials
            if special.kind not in NON_LIMITING_KINDS
        }
        | {float(b.values[i]) for b in branches for i in (0, -1)}
    )
    ranges: list[tuple[float, float, tuple[int, ...]]] = []
    for low, high in pairwise(edges):
        if high - low < SAME_SPEED * high:
            continue
        middle = float(np.log(0.5 * (low + high)))
        numbers = tuple(
            number for number, branch in enumerate(branches) for _ in range(_stable_passages(branch, middle))
        )
        if ranges and ranges[-1][2] == numbers and abs(ranges[-1][1] - low) < SAME_SPEED * low:
            ranges[-1] = (ranges[-1][0], high, numbers)
        else:
            ranges.append((low, high, numbers))
    return [limits for limits in ranges if len(limits[2]) > 1]


def _stable_passages(branch: Branch, u: float) -> int:
    """Count how many stable orbits a branch has at a parameter's logarithm `u`, from the points on both
    sides of it.

    Between a point and a special point at which stability changes the nearer side decides.
    """
    count, special_by_step = 0, {int(special.after): special for special in branch.of(*ENDING)}
    for index, (start_point, end_point) in enumerate(pairwise(branch.points)):
        if not min(start_point.u, end_point.u) <= u < max(start_point.u, end_point.u):
            continue
        special = special_by_step.get(index)
        nearer = (
            start_point
            if special is None or (u - special.point.u) * (start_point.u - special.point.u) > 0
            else end_point
        )
        count += nearer.stable
    return count


def passed_by(
    branches: Sequence[Branch], before: float, after: float, period: int, slack: float
) -> list[tuple[int, Special]]:
    """Find the special points near a jump at which a stable part of a branch ends.

    Parameters
    ----------
    branches : sequence of Branch
        Branches followed.
    before, after : float
        Values of the parameter on both sides of the jump, in its unit.
    period : int
        Number of mesh periods that the branch must have: that of the motion before the jump.
    slack : float
        Width by which the bracket is widened on both sides, in the parameter's unit.

    Returns
    -------
    list of tuple
        Number of the branch, and the special point: folds first, then the nearest to the bracket's middle.
    """
    low, high = sorted((before, after))
    middle = 0.5 * (low + high)
    hits = [
        (number, special)
        for number, branch in enumerate(branches)
        for special in branch.of(*ENDING)
        if branch.image_of is None
        and branch.period_map.period == period
        and low - slack <= special.point.value <= high + slack
        and _ends_stability(branch, special)
    ]
    return sorted(hits, key=lambda hit: (hit[1].kind is not Kind.FOLD, abs(hit[1].point.value - middle)))


def _ends_stability(branch: Branch, special: Special) -> bool:
    """Whether one of the two points beside a special point is stable and the other is not."""
    index = int(special.after)
    sides = branch.points[max(index, 0)], branch.points[min(index + 1, len(branch.points) - 1)]
    return sides[0].stable != sides[1].stable
