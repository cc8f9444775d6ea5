"""Find a point of a locus of folds or period doublings in the plane of two parameters, by Newton's method.

The test function that vanishes on the locus is the last unknown of a bordered system (Govaerts 2000).
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.motion.branches.family import Plane
from facegear.motion.branches.period_map import Linear, PeriodMap
from facegear.motion.branches.points import GOAL_OF_TOLERANCE, MIN_GOAL, SINGULAR
from facegear.motion.branches.special import Kind

DIFFERENCE = 1e-5
"""Step of the differences that give the change of the test function along the family of orbits."""
SHARP = 2e-5
"""Step of the central differences at a corner of the locus."""
STALE = 0.2
"""Part of the test before a step that may be left after it; where more is left, the gradient is renewed."""
LOOSER, LOOSEST = 1e3, 1e-10
"""Factor on the goal, and smallest bound, of the step that ends Newton's method: the gradient is a
difference, and what it misses makes the last steps shrink by a factor instead of squaring."""
NEWTON_STEPS = 8
"""Maximum number of Newton steps."""


@dataclass(frozen=True, eq=False)
class LocusProblem:
    """Problem whose solutions are the points of a locus.

    Attributes
    ----------
    kind : Kind
        Fold or period doubling.
    plane : Plane
        Systems, by two parameters.
    period_map : PeriodMap
        Map with the tolerance and the number of mesh periods; its family is replaced by lines of the
        plane.
    """

    kind: Kind
    plane: Plane
    period_map: PeriodMap

    def at(self, v: float) -> PeriodMap:
        """Return the period map at a value of the second parameter.

        Parameters
        ----------
        v : float
            Logarithm of the second parameter, dimensionless.

        Returns
        -------
        PeriodMap
            Map whose parameter u is the logarithm of the plane's first parameter.
        """
        return replace(self.period_map, family=self.plane.line(float(np.exp(v))))

    def matrix(self, linear: Linear) -> Array:
        """Return the matrix that is singular on the locus.

        It is M + I for period doublings, and for folds M - I bordered by the neutral directions.

        Parameters
        ----------
        linear : Linear
            Linearised map with the matrix M and k neutral directions.

        Returns
        -------
        (2 n + k, 2 n + k) array
            The matrix, without the border for period doublings; dimensionless.
        """
        size = len(linear.matrix)
        if self.kind is Kind.DOUBLING:
            return linear.matrix + np.eye(size)
        loose = linear.neutral.shape[1]
        matrix = np.zeros((size + loose, size + loose))
        matrix[:size, :size] = linear.matrix - np.eye(size)
        matrix[:size, size:], matrix[size:, :size] = linear.neutral, linear.neutral.T
        return matrix


@dataclass(frozen=True, eq=False)
class Borders:
    """Column `left` and row `right`, each (size,), that border a singular matrix so that it becomes
    regular.

    They are near the left and right singular vectors of its smallest singular value, see borders_of().
    """

    left: Array
    right: Array

    def test(self, matrix: Array) -> float:
        """Compute the test function that is zero where the matrix is singular.

        It is g of [matrix, left; right^T, 0] [w; g] = [0; 1].

        Parameters
        ----------
        matrix : (size, size) array
            Matrix of LocusProblem.matrix(), dimensionless.

        Returns
        -------
        float
            Test function, dimensionless.

        Raises
        ------
        NotConverged
            If the matrix has another size than the borders, because a body comes loose or is caught.
        """
        size = len(matrix)
        if self.left.size != size:
            raise NotConverged("branches", "a locus", "a body comes loose or is caught")
        whole = np.zeros((size + 1, size + 1))
        whole[:size, :size], whole[:size, size], whole[size, :size] = matrix, self.left, self.right
        right = np.zeros(size + 1)
        right[size] = 1.0
        return float(np.linalg.solve(whole, right)[size])


@dataclass(frozen=True, eq=False)
class LocusPoint:
    """Point of a locus.

    Attributes
    ----------
    x : (2 n + 2,) array
        Weighted state, see PeriodMap, then the natural logarithms of the first and second parameter.
    tangent : (2 n + 2,) array
        Unit tangent of the locus.
    bend : float
        Change of the test function along the null direction of the orbits, which vanishes at a cusp.
    borders : Borders
        Borders of the singular matrix.
    gradient : (2 n + 2,) array
        Change of the test function along the surface of orbits.
    """

    x: Array
    tangent: Array
    bend: float
    borders: Borders
    gradient: Array

    @property
    def values(self) -> tuple[float, float]:
        """Both parameters at the point, in their units."""
        return float(np.exp(self.x[-2])), float(np.exp(self.x[-1]))


def reverse_tangent(point: LocusPoint) -> LocusPoint:
    """Return the same point with the opposite tangent.

    Parameters
    ----------
    point : LocusPoint
        Point of a locus.

    Returns
    -------
    LocusPoint
        Point whose tangent has the other sign, to follow the locus the other way.
    """
    return replace(point, tangent=-point.tangent)


def borders_of(matrix: Array, before: Borders | None) -> Borders:
    """Return the singular vectors of the smallest singular value as borders, with the signs of the
    previous ones.

    Parameters
    ----------
    matrix : (size, size) array
        Matrix to border, dimensionless.
    before : Borders or None
        Previous borders along the locus.

    Returns
    -------
    Borders
        Left and right singular vector (size,).
    """
    left, _, right = np.linalg.svd(matrix)
    left_border, two = left[:, -1], right[-1]
    if before is not None and before.left.shape == left_border.shape:
        left_border = left_border * np.sign(left_border @ before.left)
        two = two * np.sign(two @ before.right)
    return Borders(left_border, two)


def solve_on_locus(
    problem: LocusProblem,
    guess: Array,
    row: Array,
    borders: Borders,
    gradient: Array | None,
    forward: Array,
    sharp: bool = False,
) -> LocusPoint:
    """Find the point of the locus next to a guess with row . (x - guess) = 0, by Newton's method on
    Borders.test().

    The change of the test function along the orbits comes from differences of the matrix. It is computed once
    for each point, and again where the test does not fall.

    Parameters
    ----------
    problem : LocusProblem
        The locus.
    guess : (2 n + 2,) array
        Weighted state and logarithms of both parameters, dimensionless.
    row : (2 n + 2,) array
        Normal of the plane row . (x - guess) = 0 in which the point is sought, dimensionless.
    borders : Borders
        Borders of a point nearby; they fix the test function.
    gradient : (2 n + 2,) array or None
        LocusPoint.gradient of a point nearby, with which Newton's method begins; None: computed at the
        guess.
    forward : (2 n + 2,) array
        Direction along which the tangent points, dimensionless.
    sharp : bool
        Whether to use central differences of the step SHARP, as at corners.

    Returns
    -------
    LocusPoint
        Point of the locus.

    Raises
    ------
    NotConverged
        If Newton's method fails; the message names both parameters.
    """
    x, goal = guess.copy(), max(GOAL_OF_TOLERANCE * problem.period_map.step_tolerance, MIN_GOAL)
    before = np.inf
    for count in range(NEWTON_STEPS):
        linear, surface, normal = _surface(problem, x)
        test = borders.test(problem.matrix(linear))
        if gradient is None or (count > 0 and abs(test) > STALE * before):
            gradient = _gradient(problem, x, surface, borders, test, sharp)
        before = abs(test)
        system = np.array([gradient @ surface, row @ surface])
        right = np.array([-test, -row @ (x - guess) - row @ normal])
        step = normal + surface @ np.linalg.solve(system, right)
        if not np.abs(step).max() < 1.0:
            break
        x = x + step
        if np.abs(step).max() <= max(LOOSER * goal, LOOSEST):
            return _point(problem, x, borders, forward, sharp)
    location = " and ".join(
        f"{n} = {np.exp(value):.6g}" for n, value in zip(problem.plane.names, guess[-2:], strict=True)
    )
    raise NotConverged("branches", location, f"Newton's method on the locus of a {problem.kind}")


def _surface(problem: LocusProblem, x: Array) -> tuple[Linear, Array, Array]:
    """Return the linearised map at x, the surface of orbits there, and the Newton step (2 n + 2,) onto
    the surface.

    The surface is given by two orthonormal directions (2 n + 2, 2) along which state and both parameters
    stay on orbits.
    """
    z, u, v = x[:-2], x[-2], x[-1]
    linear = problem.at(v).linear(z, u)
    ahead, back = (problem.at(v + sign * DIFFERENCE).gap(z, u) for sign in (1.0, -1.0))
    slope = (ahead - back) / (2.0 * DIFFERENCE)
    size, loose = linear.neutral.shape
    matrix = np.zeros((size + loose, size + 2))
    matrix[:size] = np.column_stack([linear.matrix - np.eye(size), linear.slope, slope])
    matrix[size:, :size] = linear.neutral.T
    left, sizes, right = np.linalg.svd(matrix)
    rank = np.count_nonzero(sizes > SINGULAR * sizes[0])
    gap = np.concatenate([-linear.gap, np.zeros(loose)])
    normal = right[:rank].T @ ((left.T @ gap)[:rank] / sizes[:rank])
    return linear, right[-2:].T, normal


def _gradient(
    problem: LocusProblem, x: Array, surface: Array, borders: Borders, test: float, sharp: bool
) -> Array:
    """Return the change of the test function along the surface of orbits, as a vector (2 n + 2,) in the
    surface.

    Its two components are differences: forward ones over DIFFERENCE from the value `test` at x, or
    central ones over SHARP.
    """

    def test_at(along: Array, step: float) -> float:
        position = x + step * along
        return borders.test(problem.matrix(problem.at(position[-1]).linear(position[:-2], position[-2])))

    if sharp:
        step = SHARP
        rates = [(test_at(along, step) - test_at(along, -step)) / (2.0 * step) for along in surface.T]
    else:
        rates = [(test_at(along, DIFFERENCE) - test) / DIFFERENCE for along in surface.T]
    return surface @ np.array(rates)


def _point(problem: LocusProblem, x: Array, borders: Borders, forward: Array, sharp: bool) -> LocusPoint:
    """Return the solution x as a point of the locus: with new borders, gradient, and the tangent nearest
    to `forward`.
    """
    linear, surface, _ = _surface(problem, x)
    matrix = problem.matrix(linear)
    fresh = borders_of(matrix, borders)
    gradient = _gradient(problem, x, surface, fresh, fresh.test(matrix), sharp)
    rates = gradient @ surface
    tangent = surface @ np.array([-rates[1], rates[0]])
    tangent *= np.sign(tangent @ forward) / np.linalg.norm(tangent)
    size = x.size - 2
    bend = float(gradient[:size] @ fresh.right[:size])
    return LocusPoint(x, tangent, bend, fresh, gradient)
