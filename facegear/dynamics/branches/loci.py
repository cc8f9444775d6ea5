"""Curves of folds and period doublings in the plane of two parameters, with cusps and turning points."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.branches.continuation import End
from facegear.dynamics.branches.family import Plane
from facegear.dynamics.branches.locate import Kind, bracketed_root
from facegear.dynamics.branches.period_map import Linear, PeriodMap
from facegear.dynamics.branches.points import SINGULAR
from facegear.errors import NotConverged

Array = NDArray[np.float64]
DIFFERENCE = 1e-5
"""Step of the differences that tell how the test changes along the family of orbits."""
SHARP = 2e-5
"""Step of the central differences at a corner."""
NEWTON_STEPS = 8
STRAIGHT = 0.9


class Corner(StrEnum):
    """Special points of a locus."""

    CUSP = "cusp"
    TURN = "turn in the second parameter"


@dataclass(frozen=True)
class LocusRun:
    """Range of both parameters, steps in weighted states and logarithms, most points in each direction."""

    low: tuple[float, float]
    high: tuple[float, float]
    first: float = 0.02
    least: float = 1e-5
    largest: float = 0.2
    points: int = 400


@dataclass(frozen=True, eq=False)
class LocusPoint:
    """x (2 n + 2,): weighted state, logarithms of both parameters. tangent (2 n + 2,) of the locus.

    bend: how the test changes along the orbits' own null direction, which vanishes at a cusp. gradient (2 n +
    2,): the same along the surface of orbits.
    """

    x: Array
    tangent: Array
    bend: float
    borders: "_Borders"
    gradient: Array

    @property
    def values(self) -> tuple[float, float]:
        """Both parameters."""
        return float(np.exp(self.x[-2])), float(np.exp(self.x[-1]))


@dataclass(frozen=True, eq=False)
class Locus:
    """Points along a locus, its corners, and why it ends on both sides."""

    kind: Kind
    plane: Plane
    points: list[LocusPoint]
    corners: list[tuple[Corner, LocusPoint]]
    ends: tuple[End, End]


@dataclass(frozen=True, eq=False)
class _Problem:
    """The map in the plane at one tolerance, and whether folds or doublings are followed."""

    kind: Kind
    plane: Plane
    flow: PeriodMap

    def at(self, v: float) -> PeriodMap:
        """The map at a logarithm of the second parameter."""
        return replace(self.flow, family=self.plane.line(float(np.exp(v))))

    def matrix(self, linear: Linear) -> Array:
        """What is singular on the locus: M + I, or M - I without the shifts of bodies afloat."""
        size = len(linear.matrix)
        if self.kind is Kind.DOUBLING:
            return linear.matrix + np.eye(size)
        loose = linear.afloat.shape[1]
        matrix = np.zeros((size + loose, size + loose))
        matrix[:size, :size] = linear.matrix - np.eye(size)
        matrix[:size, size:], matrix[size:, :size] = linear.afloat, linear.afloat.T
        return matrix


@dataclass(frozen=True, eq=False)
class _Borders:
    left: Array
    right: Array

    def test(self, matrix: Array) -> float:
        """Zero where the matrix is singular: g of [matrix, left; right^T, 0] [w; g] = [0; 1]."""
        size = len(matrix)
        if self.left.size != size:
            raise NotConverged("branches", "a locus", "a body comes loose or is caught")
        whole = np.zeros((size + 1, size + 1))
        whole[:size, :size], whole[:size, size], whole[size, :size] = matrix, self.left, self.right
        right = np.zeros(size + 1)
        right[size] = 1.0
        return float(np.linalg.solve(whole, right)[size])


def follow_locus(
    plane: Plane,
    second: float,
    kind: Kind,
    found: Array,
    flow: PeriodMap,
    run: LocusRun,
    progress: Callable[[LocusPoint], None] = lambda point: None,
) -> Locus:
    """The locus through a fold or period doubling found on `flow` at the plane's second parameter.

    found (2 n + 1,): x of the special point. The locus is followed both ways. Raises NotConverged if the
    special point is not found again in the plane.
    """
    problem = _Problem(kind, plane, flow)
    x = np.append(found, np.log(second))
    row = np.zeros(x.size)
    row[-1] = 1.0
    borders = _borders(problem.matrix(problem.at(x[-1]).linear(x[:-2], x[-2])), None)
    start = _solve(problem, x, row, borders, None, row)
    sides = [_track(problem, side, run, progress) for side in (_turned(start), start)]
    (behind, corners, end), (ahead, more, other) = sides
    points = [_turned(point) for point in behind[:0:-1]] + ahead
    return Locus(kind, plane, points, corners[::-1] + more, (end, other))


def _turned(point: LocusPoint) -> LocusPoint:
    return replace(point, tangent=-point.tangent)


def _borders(matrix: Array, before: _Borders | None) -> _Borders:
    """Singular vectors of the smallest singular value, with the signs of those before."""
    left, _, right = np.linalg.svd(matrix)
    one, two = left[:, -1], right[-1]
    if before is not None and before.left.shape == one.shape:
        one = one * np.sign(one @ before.left)
        two = two * np.sign(two @ before.right)
    return _Borders(one, two)


def _solve(
    problem: _Problem,
    guess: Array,
    row: Array,
    borders: _Borders,
    gradient: Array | None,
    forward: Array,
    sharp: bool = False,
) -> LocusPoint:
    """The point of the locus next to `guess` with row . (x - guess) = 0.

    The change of the test along the orbits comes from differences of the matrix, once for each point.
    """
    x, goal = guess.copy(), max(0.1 * problem.flow.tolerance, 2e-13)
    before = np.inf
    for count in range(NEWTON_STEPS):
        linear, surface, normal = _surface(problem, x)
        test = borders.test(problem.matrix(linear))
        if gradient is None or (count > 0 and abs(test) > 0.2 * before):
            gradient = _gradient(problem, x, surface, borders, test, sharp)
        before = abs(test)
        system = np.array([gradient @ surface, row @ surface])
        right = np.array([-test, -row @ (x - guess) - row @ normal])
        step = normal + surface @ np.linalg.solve(system, right)
        if not np.abs(step).max() < 1.0:
            break
        x = x + step
        if np.abs(step).max() <= max(1e3 * goal, 1e-10):
            return _point(problem, x, borders, forward, sharp)
    where = " and ".join(
        f"{n} = {np.exp(value):.6g}" for n, value in zip(problem.plane.names, guess[-2:], strict=True)
    )
    raise NotConverged("branches", where, f"Newton's method on the locus of a {problem.kind}")


def _surface(problem: _Problem, x: Array) -> tuple[Linear, Array, Array]:
    """The map at x, the two directions (2 n + 2, 2) along which orbits go on, the step onto the orbits."""
    z, u, v = x[:-2], x[-2], x[-1]
    linear = problem.at(v).linear(z, u)
    ahead, back = (problem.at(v + sign * DIFFERENCE).gap(z, u) for sign in (1.0, -1.0))
    slope = (ahead - back) / (2.0 * DIFFERENCE)
    size, loose = linear.afloat.shape
    matrix = np.zeros((size + loose, size + 2))
    matrix[:size] = np.column_stack([linear.matrix - np.eye(size), linear.slope, slope])
    matrix[size:, :size] = linear.afloat.T
    left, sizes, right = np.linalg.svd(matrix)
    kept = np.count_nonzero(sizes > SINGULAR * sizes[0])
    gap = np.concatenate([-linear.gap, np.zeros(loose)])
    normal = right[:kept].T @ ((left.T @ gap)[:kept] / sizes[:kept])
    return linear, right[-2:].T, normal


def _gradient(
    problem: _Problem, x: Array, surface: Array, borders: _Borders, test: float, sharp: bool
) -> Array:
    """How the test changes along the orbits, as a vector (2 n + 2,) in their surface."""

    def moved(along: Array, step: float) -> float:
        there = x + step * along
        return borders.test(problem.matrix(problem.at(there[-1]).linear(there[:-2], there[-2])))

    if sharp:
        step = SHARP
        rates = [(moved(along, step) - moved(along, -step)) / (2.0 * step) for along in surface.T]
    else:
        rates = [(moved(along, DIFFERENCE) - test) / DIFFERENCE for along in surface.T]
    return surface @ np.array(rates)


def _point(problem: _Problem, x: Array, borders: _Borders, forward: Array, sharp: bool) -> LocusPoint:
    linear, surface, _ = _surface(problem, x)
    matrix = problem.matrix(linear)
    fresh = _borders(matrix, borders)
    gradient = _gradient(problem, x, surface, fresh, fresh.test(matrix), sharp)
    rates = gradient @ surface
    tangent = surface @ np.array([-rates[1], rates[0]])
    tangent *= np.sign(tangent @ forward) / np.linalg.norm(tangent)
    size = x.size - 2
    bend = float(gradient[:size] @ fresh.right[:size])
    return LocusPoint(x, tangent, bend, fresh, gradient)


def _track(
    problem: _Problem, start: LocusPoint, run: LocusRun, progress: Callable[[LocusPoint], None]
) -> tuple[list[LocusPoint], list[tuple[Corner, LocusPoint]], End]:
    points, step = [start], run.first
    corners: list[tuple[Corner, LocusPoint]] = []
    limits = np.log([run.low, run.high])
    while len(points) < run.points:
        here = points[-1]
        try:
            there = _step(problem, here, step)
            found = _corners(problem, here, there)
        except (NotConverged, np.linalg.LinAlgError):
            step *= 0.4
            if step < run.least:
                return points, corners, End.STEP
            continue
        outside = (there.x[-2:] < limits[0]) | (there.x[-2:] > limits[1])
        if outside.any():
            which = int(np.argmax(outside))
            limit = limits[int(there.x[-2 + which] > here.x[-2 + which]), which]
            points.append(_onto_limit(problem, here, there, which, limit))
            return points, corners, End.LIMIT
        corners += found
        points.append(there)
        progress(there)
        angle = np.arccos(np.clip(here.tangent @ there.tangent, -1.0, 1.0))
        step = min(step * float(np.clip(0.2 / max(float(angle), 1e-6), 0.5, 1.7)), run.largest)
    return points, corners, End.POINTS


def _step(problem: _Problem, here: LocusPoint, step: float) -> LocusPoint:
    guess = here.x + step * here.tangent
    there = _solve(problem, guess, here.tangent, here.borders, here.gradient, here.tangent)
    straight = here.tangent @ there.tangent
    if straight < STRAIGHT or np.linalg.norm(there.x - guess) > 0.3 * step:
        raise NotConverged("branches", f"a {problem.kind} locus", "a step that turns too sharply")
    return there


def _onto_limit(
    problem: _Problem, here: LocusPoint, there: LocusPoint, which: int, limit: float
) -> LocusPoint:
    row = np.zeros(here.x.size)
    row[-2 + which] = 1.0
    share = (limit - here.x[-2 + which]) / (there.x[-2 + which] - here.x[-2 + which])
    guess = here.x + share * (there.x - here.x)
    return _solve(problem, guess, row, here.borders, here.gradient, here.tangent)


def _corners(problem: _Problem, here: LocusPoint, there: LocusPoint) -> list[tuple[Corner, LocusPoint]]:
    """Cusps and turning points in the second parameter between two points."""
    tests = {Corner.CUSP: lambda point: point.bend, Corner.TURN: lambda point: point.tangent[-1]}
    if problem.kind is Kind.DOUBLING or here.bend * there.bend > 0.0:
        del tests[Corner.CUSP]
    elif here.bend * there.bend <= 0.0:
        del tests[Corner.TURN]
    chord = there.x - here.x
    row = chord / np.linalg.norm(chord)

    def at(share: float) -> LocusPoint:
        if share in (0.0, 1.0):
            return here if share == 0.0 else there
        nearer = here if share < 0.5 else there
        guess = here.x + share * chord
        return _solve(problem, guess, row, nearer.borders, nearer.gradient, here.tangent, sharp=True)

    def zero(test: Callable[[LocusPoint], float]) -> LocusPoint:
        return at(bracketed_root(lambda share: test(at(share)), 0.0, 1.0, 1e-9))

    return [(corner, zero(test)) for corner, test in tests.items() if test(here) * test(there) < 0.0]
