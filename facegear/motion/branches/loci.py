"""Follow curves of folds and period doublings in the plane of two parameters, with cusps and extrema."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.motion.branches.continuation import BranchEnd
from facegear.motion.branches.family import Plane
from facegear.motion.branches.locus_point import (
    LocusPoint,
    LocusProblem,
    borders_of,
    reverse_tangent,
    solve_on_locus,
)
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.segment import zero
from facegear.motion.branches.special import Kind

SHORTER = 0.4
"""Factor on the length of a step that failed; a free choice."""
LOCUS_TURN = 0.2
"""Turn of the tangent (rad) at which a step keeps its length; shorter turns lengthen the next step."""
SHORTEN_TO, LENGTHEN_TO = 0.5, 1.7
"""Limits of the factor between one step and the next; free choices."""
LEAST_TURN = 1e-6
"""Turn (rad) below which a locus counts as straight, so that no step is divided by zero."""
LOCUS_CORRECTION = 0.3
"""Largest way from the guess to the point found, over the length of the step; beyond, another locus."""
CORNER_WIDTH = 1e-9
"""Part of a step to which a corner is located."""
STRAIGHT = 0.9
"""Least cosine between the tangents at both ends of a step."""


class Corner(StrEnum):
    """Special points of a locus: a cusp, where two folds meet, or an extremum of the second parameter
    along it.
    """

    CUSP = "cusp"
    TURN = "turn in the second parameter"


@dataclass(frozen=True)
class LocusRun:
    """Settings of the continuation of a locus; steps are measured in weighted states and logarithms.

    Attributes
    ----------
    p_min, p_max : tuple of float
        Range of both parameters.
    first, ds_min, ds_max : float
        First, smallest and largest step.
    max_points : int
        Maximum number of points in each direction.
    """

    p_min: tuple[float, float]
    p_max: tuple[float, float]
    first: float = 0.02
    ds_min: float = 1e-5
    ds_max: float = 0.2
    max_points: int = 400


@dataclass(frozen=True, eq=False)
class Locus:
    """A locus of folds or period doublings.

    Attributes
    ----------
    kind : Kind
        Fold or period doubling.
    plane : Plane
        Systems, by two parameters.
    points : list of LocusPoint
        Points along the locus.
    corners : list of tuple
        Cusps and turns (extrema of the second parameter along the locus), each with its point.
    ends : tuple of BranchEnd
        Why the locus ends on both sides.
    """

    kind: Kind
    plane: Plane
    points: list[LocusPoint]
    corners: list[tuple[Corner, LocusPoint]]
    ends: tuple[BranchEnd, BranchEnd]


def follow_locus(
    plane: Plane,
    second: float,
    kind: Kind,
    state: Array,
    period_map: PeriodMap,
    run: LocusRun,
    progress: Callable[[LocusPoint], None] = lambda point: None,
) -> Locus:
    """Follow the locus through a fold or period doubling both ways.

    Parameters
    ----------
    plane : Plane
        Systems, by two parameters.
    second : float
        Value of the second parameter at which the special point was found, in its unit.
    kind : Kind
        Fold or period doubling.
    state : (2 n + 1,) array
        x of the special point: weighted state and logarithm of the first parameter, dimensionless.
    period_map : PeriodMap
        Map over whole mesh periods.
    run : LocusRun
        Range of both parameters and steps.
    progress : callable
        Called with each new point.

    Returns
    -------
    Locus
        Points in order along the locus.

    Raises
    ------
    NotConverged
        If the special point is not found again in the plane.
    """
    problem = LocusProblem(kind, plane, period_map)
    x = np.append(state, np.log(second))
    row = np.zeros(x.size)
    row[-1] = 1.0
    borders = borders_of(problem.matrix(problem.at(x[-1]).linear(x[:-2], x[-2])), None)
    start = solve_on_locus(problem, x, row, borders, None, row)
    sides = [_track(problem, side, run, progress) for side in (reverse_tangent(start), start)]
    (behind, corners, end), (ahead, corners_ahead, end_ahead) = sides
    points = [reverse_tangent(point) for point in behind[:0:-1]] + ahead
    return Locus(kind, plane, points, corners[::-1] + corners_ahead, (end, end_ahead))


def _track(
    problem: LocusProblem, start: LocusPoint, run: LocusRun, progress: Callable[[LocusPoint], None]
) -> tuple[list[LocusPoint], list[tuple[Corner, LocusPoint]], BranchEnd]:
    """Continue a locus from a start along its tangent; return its points, its corners, and why it ends.

    It ends at a limit of a parameter, after max_points points, or where steps become too short.
    """
    points, step = [start], run.first
    corners: list[tuple[Corner, LocusPoint]] = []
    limits = np.log([run.p_min, run.p_max])
    while len(points) < run.max_points:
        current_point = points[-1]
        try:
            next_point = _step(problem, current_point, step)
            new_corners = _corners(problem, current_point, next_point)
        except (NotConverged, np.linalg.LinAlgError):
            step *= SHORTER
            if step < run.ds_min:
                return points, corners, BranchEnd.STEP
            continue
        outside = (next_point.x[-2:] < limits[0]) | (next_point.x[-2:] > limits[1])
        if outside.any():
            axis = int(np.argmax(outside))
            limit = limits[int(next_point.x[-2 + axis] > current_point.x[-2 + axis]), axis]
            points.append(_onto_limit(problem, current_point, next_point, axis, limit))
            return points, corners, BranchEnd.LIMIT
        corners += new_corners
        points.append(next_point)
        progress(next_point)
        angle = np.arccos(np.clip(current_point.tangent @ next_point.tangent, -1.0, 1.0))
        step = min(
            step * float(np.clip(LOCUS_TURN / max(float(angle), LEAST_TURN), SHORTEN_TO, LENGTHEN_TO)),
            run.ds_max,
        )
    return points, corners, BranchEnd.POINTS


def _step(problem: LocusProblem, current_point: LocusPoint, step: float) -> LocusPoint:
    """Return the next point of a locus, one step along its tangent. Raises NotConverged if it turns too
    sharply.
    """
    guess = current_point.x + step * current_point.tangent
    next_point = solve_on_locus(
        problem,
        guess,
        current_point.tangent,
        current_point.borders,
        current_point.gradient,
        current_point.tangent,
    )
    straight = current_point.tangent @ next_point.tangent
    if straight < STRAIGHT or np.linalg.norm(next_point.x - guess) > LOCUS_CORRECTION * step:
        raise NotConverged("branches", f"a {problem.kind} locus", "a step that turns too sharply")
    return next_point


def _onto_limit(
    problem: LocusProblem, current_point: LocusPoint, next_point: LocusPoint, axis: int, limit: float
) -> LocusPoint:
    """Return the point at which a locus crosses a limit (a logarithm) of the parameter `axis`: 0 the
    first, 1 the second.
    """
    row = np.zeros(current_point.x.size)
    row[-2 + axis] = 1.0
    fraction = (limit - current_point.x[-2 + axis]) / (next_point.x[-2 + axis] - current_point.x[-2 + axis])
    guess = current_point.x + fraction * (next_point.x - current_point.x)
    return solve_on_locus(
        problem, guess, row, current_point.borders, current_point.gradient, current_point.tangent
    )


def _corners(
    problem: LocusProblem, start_point: LocusPoint, end_point: LocusPoint
) -> list[tuple[Corner, LocusPoint]]:
    """Return the cusps (zeros of `bend`) and turns in the second parameter between two points, with their
    kinds.
    """
    tests = {Corner.CUSP: lambda point: point.bend, Corner.TURN: lambda point: point.tangent[-1]}
    if problem.kind is Kind.DOUBLING or start_point.bend * end_point.bend > 0.0:
        del tests[Corner.CUSP]
    elif start_point.bend * end_point.bend <= 0.0:
        del tests[Corner.TURN]
    chord = end_point.x - start_point.x
    row = chord / np.linalg.norm(chord)

    def at(fraction: float) -> LocusPoint:
        if fraction in (0.0, 1.0):
            return start_point if fraction == 0.0 else end_point
        nearer = start_point if fraction < 0.5 else end_point
        guess = start_point.x + fraction * chord
        return solve_on_locus(
            problem, guess, row, nearer.borders, nearer.gradient, start_point.tangent, sharp=True
        )

    def locate_corner(test: Callable[[LocusPoint], float]) -> LocusPoint:
        return at(zero(lambda fraction: test(at(fraction)), 0.0, 1.0, CORNER_WIDTH))

    return [
        (corner, locate_corner(test))
        for corner, test in tests.items()
        if test(start_point) * test(end_point) < 0.0
    ]
