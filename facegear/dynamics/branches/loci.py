"""Curves of folds and period doublings in the plane of two parameters, with cusps and extrema."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.continuation import BranchEnd
from facegear.dynamics.branches.family import Plane
from facegear.dynamics.branches.locus_point import (
    LocusPoint,
    LocusProblem,
    borders_of,
    solve_on_locus,
    turned,
)
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.segment import zero
from facegear.dynamics.branches.special import Kind
from facegear.errors import NotConverged

STRAIGHT = 0.9


class Corner(StrEnum):
    """Special points of a locus."""

    CUSP = "cusp"
    TURN = "turn in the second parameter"


@dataclass(frozen=True)
class LocusRun:
    """Range of both parameters, steps in weighted states and logarithms, most points in each direction."""

    p_min: tuple[float, float]
    p_max: tuple[float, float]
    first: float = 0.02
    ds_min: float = 1e-5
    ds_max: float = 0.2
    max_points: int = 400


@dataclass(frozen=True, eq=False)
class Locus:
    """Points along a locus, its corners, and why it ends on both sides."""

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
    """The locus through a fold or period doubling found on `period_map` at the plane's second parameter.

    found (2 n + 1,): x of the special point. The locus is followed both ways. Raises NotConverged if the
    special point is not found again in the plane.
    """
    problem = LocusProblem(kind, plane, period_map)
    x = np.append(state, np.log(second))
    row = np.zeros(x.size)
    row[-1] = 1.0
    borders = borders_of(problem.matrix(problem.at(x[-1]).linear(x[:-2], x[-2])), None)
    start = solve_on_locus(problem, x, row, borders, None, row)
    sides = [_track(problem, side, run, progress) for side in (turned(start), start)]
    (behind, corners, end), (ahead, more, other) = sides
    points = [turned(point) for point in behind[:0:-1]] + ahead
    return Locus(kind, plane, points, corners[::-1] + more, (end, other))


def _track(
    problem: LocusProblem, start: LocusPoint, run: LocusRun, progress: Callable[[LocusPoint], None]
) -> tuple[list[LocusPoint], list[tuple[Corner, LocusPoint]], BranchEnd]:
    points, step = [start], run.first
    corners: list[tuple[Corner, LocusPoint]] = []
    limits = np.log([run.p_min, run.p_max])
    while len(points) < run.max_points:
        here = points[-1]
        try:
            there = _step(problem, here, step)
            met = _corners(problem, here, there)
        except (NotConverged, np.linalg.LinAlgError):
            step *= 0.4
            if step < run.ds_min:
                return points, corners, BranchEnd.STEP
            continue
        outside = (there.x[-2:] < limits[0]) | (there.x[-2:] > limits[1])
        if outside.any():
            which = int(np.argmax(outside))
            limit = limits[int(there.x[-2 + which] > here.x[-2 + which]), which]
            points.append(_onto_limit(problem, here, there, which, limit))
            return points, corners, BranchEnd.LIMIT
        corners += met
        points.append(there)
        progress(there)
        angle = np.arccos(np.clip(here.tangent @ there.tangent, -1.0, 1.0))
        step = min(step * float(np.clip(0.2 / max(float(angle), 1e-6), 0.5, 1.7)), run.ds_max)
    return points, corners, BranchEnd.POINTS


def _step(problem: LocusProblem, here: LocusPoint, step: float) -> LocusPoint:
    guess = here.x + step * here.tangent
    there = solve_on_locus(problem, guess, here.tangent, here.borders, here.gradient, here.tangent)
    straight = here.tangent @ there.tangent
    if straight < STRAIGHT or np.linalg.norm(there.x - guess) > 0.3 * step:
        raise NotConverged("branches", f"a {problem.kind} locus", "a step that turns too sharply")
    return there


def _onto_limit(
    problem: LocusProblem, here: LocusPoint, there: LocusPoint, which: int, limit: float
) -> LocusPoint:
    row = np.zeros(here.x.size)
    row[-2 + which] = 1.0
    fraction = (limit - here.x[-2 + which]) / (there.x[-2 + which] - here.x[-2 + which])
    guess = here.x + fraction * (there.x - here.x)
    return solve_on_locus(problem, guess, row, here.borders, here.gradient, here.tangent)


def _corners(problem: LocusProblem, here: LocusPoint, there: LocusPoint) -> list[tuple[Corner, LocusPoint]]:
    """Cusps and extrema in the second parameter between two points."""
    tests = {Corner.CUSP: lambda point: point.bend, Corner.TURN: lambda point: point.tangent[-1]}
    if problem.kind is Kind.DOUBLING or here.bend * there.bend > 0.0:
        del tests[Corner.CUSP]
    elif here.bend * there.bend <= 0.0:
        del tests[Corner.TURN]
    chord = there.x - here.x
    row = chord / np.linalg.norm(chord)

    def at(fraction: float) -> LocusPoint:
        if fraction in (0.0, 1.0):
            return here if fraction == 0.0 else there
        nearer = here if fraction < 0.5 else there
        guess = here.x + fraction * chord
        return solve_on_locus(problem, guess, row, nearer.borders, nearer.gradient, here.tangent, sharp=True)

    def located(test: Callable[[LocusPoint], float]) -> LocusPoint:
        return at(zero(lambda fraction: test(at(fraction)), 0.0, 1.0, 1e-9))

    return [(corner, located(test)) for corner, test in tests.items() if test(here) * test(there) < 0.0]
