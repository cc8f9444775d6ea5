"""From one branch onto another: doubled periods, broken symmetry, any motion that was found."""

from dataclasses import replace

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.continuation import Branch, End, Run, follow
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import Point, at_parameter, solve_point
from facegear.dynamics.branches.special import Special
from facegear.dynamics.motion import State
from facegear.errors import NotConverged

ASIDE = (0.02, 0.005, 0.06, 0.15, 0.4, 1e-3)
"""Distances from a special point, in length scales, at which another branch is sought."""
LEFT = 0.3
"""Least share of the distance that must remain along the new direction."""


def doubled(flow: PeriodMap, special: Special, run: Run) -> Branch:
    """The branch of twice the period that leaves a period doubling, followed until it meets itself shifted.

    Raises NotConverged where none is found near the point.
    """
    twice = flow.over(2 * flow.period)
    direction = _direction(special.point.linear.matrix, -1.0)
    start = _aside(twice, special, direction)
    return _from(twice, special, start, run, End.DOUBLING)


def broken(flow: PeriodMap, special: Special, run: Run) -> Branch:
    """The branch that leaves a branch point across the one on which it was found."""
    direction = _direction(special.point.linear.matrix, 1.0)
    across = np.append(direction, 0.0)
    across -= special.point.tangent * (special.point.tangent @ across)
    start = _aside(flow, special, across[:-1] / np.linalg.norm(across[:-1]))
    return _from(flow, special, start, run, End.SYMMETRY)


def _from(flow: PeriodMap, special: Special, start: Point, run: Run, end: End) -> Branch:
    """The branch through `start`, away from the special point, which becomes its first point."""
    child = follow(flow, start, run, both=False)
    origin = special.point
    away = start.x - origin.x
    linear = flow.linear(origin.z, origin.u)
    root = replace(origin, tangent=away / np.linalg.norm(away), linear=linear)
    specials = [replace(one, after=one.after + 1.0) for one in child.specials]
    return replace(child, points=[root, *child.points], specials=specials, ends=(end, child.ends[1]))


def through(flow: PeriodMap, state: State, value: float, run: Run) -> Branch:
    """The branch through the orbit next to a state (displacement, velocity by time) at a parameter.

    Raises NotConverged if Newton's method finds none. flow.period must be the orbit's own.
    """
    u = float(np.log(value))
    return follow(flow, at_parameter(flow, flow.weighted(state, u), u), run)


def _direction(matrix: Array, goal: float) -> Array:
    """Real unit eigenvector of the multiplier nearest to a real goal."""
    values, vectors = np.linalg.eig(matrix)
    vector = vectors[:, np.argmin(np.abs(values - goal))].real
    return vector / np.linalg.norm(vector)


def _aside(flow: PeriodMap, special: Special, direction: Array) -> Point:
    """An orbit at some distance along a direction, the parameter free, looking away from the point."""
    row = np.append(direction, 0.0)
    origin = special.point.x
    for distance in ASIDE:
        try:
            point = solve_point(flow, origin + distance * row, row, row)
        except (NotConverged, np.linalg.LinAlgError):
            continue
        away = point.x - origin
        near = np.linalg.norm(away) < 4.0 * distance
        if near and row @ away > LEFT * np.linalg.norm(away):
            return point
    raise NotConverged(
        "branches",
        f"{special.kind} at {flow.family.name} = {special.point.value:.9g}",
        f"another branch at distances {', '.join(f'{d:g}' for d in ASIDE)}",
    )
