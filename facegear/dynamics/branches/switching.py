"""From one branch onto another: doubled periods, broken symmetry, any motion that was found.

The new branch is sought beside the special point, along the null vector of M + I or M - I (Doedel et al.
1991), M the matrix of the period map.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.continuation import Branch, BranchEnd, ContinuationSettings, follow
from facegear.dynamics.branches.locate import locate, locate_grazes
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint, at_parameter, solve_point
from facegear.dynamics.branches.segment import Segment
from facegear.dynamics.branches.special import Special
from facegear.dynamics.motion import State
from facegear.errors import NotConverged

ASIDE = (0.02, 0.005, 0.06, 0.15, 0.4, 1e-3)
"""Distances from a special point, in length scales, at which another branch is sought."""
NEAR_ROOT = 0.1
"""Part of the way to that orbit from which special points are looked for by multipliers: at the special point
itself one of them lies on the unit circle."""
LEFT = 0.3
"""Smallest fraction of the distance that must remain along the new direction."""


def doubled(period_map: PeriodMap, special: Special, run: ContinuationSettings) -> Branch:
    """The branch of twice the period that leaves a period doubling, followed until it meets itself shifted.

    Raises NotConverged where none is found near the point.
    """
    twice = period_map.over(2 * period_map.period)
    direction = _direction(special.point.linear.matrix, -1.0)

    def is_doubled(point: BranchPoint) -> bool:
        """Whether the motion differs from itself a period later, other than the branch that doubles."""
        changed = np.linalg.norm(period_map.gap(point.z, point.u))
        return bool(changed > LEFT * np.linalg.norm(point.x - special.point.x))

    start = _aside(twice, special, direction, is_doubled)
    return _from(twice, special, start, run, BranchEnd.DOUBLING)


def broken(period_map: PeriodMap, special: Special, run: ContinuationSettings) -> Branch:
    """The branch that leaves a branch point across the one on which it was found."""
    direction = _direction(special.point.linear.matrix, 1.0)
    across = np.append(direction, 0.0)
    across -= special.point.tangent * (special.point.tangent @ across)
    start = _aside(period_map, special, across[:-1] / np.linalg.norm(across[:-1]))
    return _from(period_map, special, start, run, BranchEnd.SYMMETRY)


def _from(
    period_map: PeriodMap, special: Special, start: BranchPoint, run: ContinuationSettings, end: BranchEnd
) -> Branch:
    """The branch through `start`, away from the special point, which becomes its first point."""
    child = follow(period_map, start, run, both=False)
    origin = special.point
    away = start.x - origin.x
    linear = period_map.linear(origin.z, origin.u)
    extrema = period_map.extrema(origin.z, origin.u)
    root = replace(origin, tangent=away / np.linalg.norm(away), linear=linear, extrema=extrema)
    try:
        first, located = _first_stretch(period_map, root, start)
    except (NotConverged, np.linalg.LinAlgError) as error:
        tried = f"grazes before {start.value:.9g} were not looked for: {error}"
        first, located, child = (
            [root],
            [],
            replace(child, tried="; ".join(filter(None, [tried, child.tried]))),
        )
    behind = [replace(later, after=later.after + len(first)) for later in child.specials]
    points = [*first, *child.points]
    return replace(child, points=points, specials=[*located, *behind], ends=(end, child.ends[1]))


def _first_stretch(
    period_map: PeriodMap, root: BranchPoint, start: BranchPoint
) -> tuple[list[BranchPoint], list[Special]]:
    """Points from a special point up to the orbit beside it, without that one, and what lies on the way."""
    near = Segment(period_map, replace(root, linear=start.linear), start).at(NEAR_ROOT)
    located = locate(period_map, near, start)
    behind = [replace(special, after=special.after + 1.0) for special in located.specials]
    return [root, near, *located.inner], [*locate_grazes(period_map, root, near, near.linear), *behind]


def through(period_map: PeriodMap, state: State, value: float, run: ContinuationSettings) -> Branch:
    """The branch through the orbit next to a state (displacement, velocity by time) at a parameter.

    Raises NotConverged if Newton's method finds none. The map's period must be the orbit's own.
    """
    u = float(np.log(value))
    return follow(period_map, at_parameter(period_map, period_map.weighted(state, u), u), run)


def _direction(matrix: Array, goal: float) -> Array:
    """Real unit eigenvector of the multiplier nearest to a real goal."""
    values, vectors = np.linalg.eig(matrix)
    vector = vectors[:, np.argmin(np.abs(values - goal))].real
    return vector / np.linalg.norm(vector)


def _aside(
    period_map: PeriodMap,
    special: Special,
    direction: Array,
    is_new: Callable[[BranchPoint], bool] = lambda point: True,
) -> BranchPoint:
    """An orbit at some distance along a direction, the parameter free, looking away from the point.

    is_new: whether an orbit lies on another branch than the special point.
    """
    row = np.append(direction, 0.0)
    origin = special.point.x
    for distance in ASIDE:
        try:
            point = solve_point(period_map, origin + distance * row, row, row)
        except (NotConverged, np.linalg.LinAlgError):
            continue
        away = point.x - origin
        near = np.linalg.norm(away) < 4.0 * distance
        if near and row @ away > LEFT * np.linalg.norm(away) and is_new(point):
            return point
    raise NotConverged(
        "branches",
        f"{special.kind} at {period_map.family.name} = {special.point.value:.9g}",
        f"another branch at distances {', '.join(f'{d:g}' for d in ASIDE)}",
    )
