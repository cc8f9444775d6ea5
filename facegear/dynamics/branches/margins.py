"""How far stable motions are from their ends, and where several of them exist."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from facegear.dynamics.branches.continuation import PASSED, Branch, ContinuationSettings, follow, turned
from facegear.dynamics.branches.explore import crossings
from facegear.dynamics.branches.family import Family
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint, at_parameter
from facegear.dynamics.branches.special import Kind, Special

ENDING = (Kind.FOLD, Kind.DOUBLING, Kind.TORUS, Kind.BRANCH)
"""Special points at which a motion may end or change its stability."""


@dataclass(frozen=True, eq=False)
class StabilityLimit:
    """Where a stable motion first loses its stability or its existence when one parameter changes.

    Attributes
    ----------
    branch, period
        Of the motion.
    parameter, start
        Its name and value there.
    direction
        Of the parameter.
    special
        None if nothing is met within the range.
    reached
        Value of the parameter at the end.
    """

    branch: int
    period: int
    parameter: str
    start: float
    direction: str
    special: Special | None
    reached: float


def stable_at(branches: Sequence[Branch], value: float) -> list[tuple[int, BranchPoint]]:
    """Stable orbits at a parameter, each with the number of its branch."""
    return [
        (number, point)
        for number, branch in enumerate(branches)
        for point in crossings(branch, value)
        if point.stable
    ]


def stability_limits(
    branches: Sequence[Branch], families: Sequence[tuple[Family, float, ContinuationSettings]], value: float
) -> list[StabilityLimit]:
    """For every stable motion at a parameter of the branches, the first special point in each family. Images
    have the limits of their original.

    families: with the value at which they pass through the motion, and the range to look through.
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
    here = at_parameter(period_map, point.z, float(np.log(start)))
    run = replace(run, to_first=True)
    sides = []
    for direction in ("up", "down"):
        sign = 1.0 if direction == "up" else -1.0
        looking = here if here.tangent[-1] * sign > 0.0 else turned(here)
        branch = follow(period_map, looking, run, both=False)
        special = next(
            (special_point for special_point in branch.specials if special_point.kind not in PASSED), None
        )
        reached = branch.points[-1].value if special is None else special.point.value
        sides.append(
            StabilityLimit(
                number, period_map.period, period_map.family.name, start, direction, special, float(reached)
            )
        )
    return sides


def several(branches: Sequence[Branch]) -> list[tuple[float, float, tuple[int, ...]]]:
    """Ranges of the parameter between special points in which several stable motions exist.

    Each with its ends and the numbers of the branches, one for each motion.
    """
    edges = sorted(
        {special.point.value for b in branches for special in b.specials if special.kind not in PASSED}
        | {float(b.values[i]) for b in branches for i in (0, -1)}
    )
    ranges: list[tuple[float, float, tuple[int, ...]]] = []
    for low, high in pairwise(edges):
        if high - low < 1e-9 * high:
            continue
        middle = float(np.log(0.5 * (low + high)))
        numbers = tuple(
            number for number, branch in enumerate(branches) for _ in range(_stable_passages(branch, middle))
        )
        if ranges and ranges[-1][2] == numbers and abs(ranges[-1][1] - low) < 1e-9 * low:
            ranges[-1] = (ranges[-1][0], high, numbers)
        else:
            ranges.append((low, high, numbers))
    return [limits for limits in ranges if len(limits[2]) > 1]


def _stable_passages(branch: Branch, u: float) -> int:
    """How often a stable part of a branch passes a parameter's logarithm, away from special points."""
    count, places = 0, {int(special.after): special for special in branch.of(*ENDING)}
    for index, (here, there) in enumerate(pairwise(branch.points)):
        if not min(here.u, there.u) <= u < max(here.u, there.u):
            continue
        special = places.get(index)
        nearer = here if special is None or (u - special.point.u) * (here.u - special.point.u) > 0 else there
        count += nearer.stable
    return count


def passed_by(
    branches: Sequence[Branch], before: float, after: float, period: int, slack: float
) -> list[tuple[int, Special]]:
    """Special points within a jump's bracket (widened by `slack`) at which a stable part of a branch of some
    period ends; folds first, then the nearest to the bracket's middle.
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
    index = int(special.after)
    sides = branch.points[max(index, 0)], branch.points[min(index + 1, len(branch.points) - 1)]
    return sides[0].stable != sides[1].stable
