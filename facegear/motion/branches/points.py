"""Find a periodic motion on a branch by Newton's method bordered by one condition.

The bordered matrix stays regular at folds (Keller 1977). Floquet multipliers give the stability (Seydel
2010).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import AnyArray, Array, ComplexArray
from facegear.errors import NotConverged
from facegear.motion.between_samples import by_modulus
from facegear.motion.branches.period_map import Linear, PeriodMap

CHORD_STEPS = 10
"""Maximum number of quasi-Newton steps with one matrix."""
GAIN = 0.5
"""A step with an old matrix must reduce the gap at least to this fraction."""
FARTHEST = 0.5
"""Largest step in the parameter's logarithm."""
DIVERGED = 1e6
"""Change over the period, in length scales, beyond which Newton's method is given up."""
LAST_STEP = 1e3
"""Longest Newton step, in goals, that may follow a gap below the goal. A nearly singular matrix makes a long
step of a small gap; then the orbit is not found yet.
"""
GAP_DOUBT = 1e-3
"""Length of a Newton step over the square root of the goal below which the next gap is expected to meet the
goal, as the method is quadratic. The gap itself is then computed and decides.
"""
GOAL_OF_TOLERANCE, MIN_GOAL = 0.1, 2e-13
"""Goal of the change over a period: this fraction of the tolerance of the steps, but not less than
some 1000 rounding units of a double, in length scales.
"""
NEWTON_STEPS = 6
"""Maximum number of Newton steps, each with a new matrix."""
REAL_PAIR = 1e-6
"""Multipliers this close to the real axis are on it: symmetry makes them double, rounding splits them."""


STALL_FACTOR = 300.0
"""Change over the period, in goals, that is accepted where Newton's method gains no more."""
ON_CIRCLE = 1e-9
"""Distance from the unit circle up to which a complex pair counts as on it: rounding of a period map."""
SINGULAR = 1e-7
"""A direction in which the bordered matrix moves things less than this, relatively, is left alone."""


@dataclass(frozen=True, eq=False)
class BranchPoint:
    """A periodic motion at one value of the parameter.

    Attributes
    ----------
    x : (2 n + 1,) array
        Weighted state z, see PeriodMap, then the natural logarithm u of the parameter.
    tangent : (2 n + 1,) array
        Unit tangent of the branch at x, pointing in the direction in which the branch is followed.
    parity : float
        Sign (1 or -1) of the determinant of bordered_matrix(); along a branch it changes at a branch
        point only.
    linear : Linear
        Linearised period map at the state.
    extrema : (m, 2, most) array
        Extrema of the mesh deflections, see PeriodMap.extrema().
    """

    x: Array
    tangent: Array
    parity: float
    linear: Linear
    extrema: Array

    @property
    def z(self) -> Array:
        """Weighted state (2 n,) at the start of the period, dimensionless, see PeriodMap."""
        return self.x[:-1]

    @property
    def u(self) -> float:
        """Natural logarithm of the parameter at the point."""
        return float(self.x[-1])

    @property
    def value(self) -> float:
        """Parameter at the point, in its unit."""
        return float(np.exp(self.x[-1]))

    @cached_property
    def multipliers(self) -> ComplexArray:
        """Floquet multipliers (2 n - k,), largest modulus first, without those of k neutral directions."""
        values = without_neutral(np.linalg.eigvals(self.linear.matrix), self.linear.neutral.shape[1])
        return values[by_modulus(values)]

    @cached_property
    def real(self) -> Array:
        """Real multipliers in rising order, with those that REAL_PAIR takes for real."""
        values = self.multipliers
        return np.sort(values[np.abs(values.imag) <= REAL_PAIR * (np.abs(values) > 0.5)].real)

    @cached_property
    def pairs(self) -> ComplexArray:
        """Complex multipliers with positive imaginary part, largest modulus first."""
        values = self.multipliers
        values = values[values.imag > REAL_PAIR * (np.abs(values) > 0.5)]
        return values[by_modulus(values)]

    @cached_property
    def outside(self) -> tuple[int, int, int]:
        """Number of real multipliers above 1, of real ones below -1, and of complex pairs outside the unit
        circle.

        A pair outside by no more than ON_CIRCLE is on the circle: without damping all pairs are, and rounding
        alone would move them across it.
        """
        return (
            int((self.real > 1.0).sum()),
            int((self.real < -1.0).sum()),
            int((np.abs(self.pairs) > 1.0 + ON_CIRCLE).sum()),
        )

    @property
    def stable(self) -> bool:
        """Whether no multiplier is outside the unit circle, see `outside`; neutral directions are left
        out.
        """
        return self.outside == (0, 0, 0)


def without_neutral(values: AnyArray, neutral: int) -> ComplexArray:
    """Remove the multipliers of neutral directions: those nearest to one.

    Parameters
    ----------
    values : (..., 2 n) array
        Multipliers, dimensionless.
    neutral : int
        Number of neutral directions.

    Returns
    -------
    (..., 2 n - neutral) array
        Remaining multipliers, dimensionless.
    """
    nearest = np.argsort(np.abs(values - 1.0), axis=-1)
    return np.take_along_axis(values, nearest[..., neutral:], axis=-1).astype(complex)


def bordered_matrix(linear: Linear, row: Array) -> Array:
    """Assemble the matrix [M - I, P_u, V; row, 0; V^T, 0, 0] of Newton's method for an orbit.

    M is the derivative of the map P by the state, P_u that by the parameter's logarithm. The row stands
    for the condition that selects an orbit of the branch; the columns V for shifts along neutral
    directions.

    Parameters
    ----------
    linear : Linear
        Linearised map with the matrix M, the slope P_u and k neutral directions V.
    row : (2 n + 1,) array
        Left side of the condition, as in correct(), dimensionless.

    Returns
    -------
    (2 n + 1 + k, 2 n + 1 + k) array
        Bordered matrix, dimensionless.
    """
    size, loose = linear.neutral.shape
    matrix = np.zeros((size + 1 + loose, size + 1 + loose))
    matrix[:size, :size] = linear.matrix - np.eye(size)
    matrix[:size, size] = linear.slope
    matrix[:size, size + 1 :] = linear.neutral
    matrix[size, : size + 1] = row
    matrix[size + 1 :, :size] = linear.neutral.T
    return matrix


def correct(
    period_map: PeriodMap, guess: Array, row: Array, linear: Linear | None = None, farthest: float = np.inf
) -> tuple[Array, Linear]:
    """Find the orbit next to a guess with row . (x - guess) = 0, by Newton's method.

    Quasi-Newton steps with the matrix of `linear` come first, while each gains enough. Newton steps with
    a new matrix follow, at most NEWTON_STEPS of them, until the change over the period is at most the
    goal of _goal().

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    guess : (2 n + 1,) array
        Weighted state and logarithm of the parameter, dimensionless.
    row : (2 n + 1,) array
        Normal of the plane row . (x - guess) = 0 in which the orbit is sought, dimensionless.
    linear : Linear, optional
        Linearised map near the guess.
    farthest : float
        Largest accepted distance from the guess, dimensionless.

    Returns
    -------
    x : (2 n + 1,) array
        The orbit, dimensionless.
    linear : Linear
        Linearised map at it.

    Raises
    ------
    NotConverged
        If Newton's method does not converge, or the orbit lies beyond `farthest`.
    """
    x, goal, chord, before = guess.copy(), _goal(period_map), linear, np.inf
    for _ in range(NEWTON_STEPS):
        if chord is not None:
            x, _ = _by_chord(period_map, x, guess, row, chord, goal)
        if np.linalg.norm(x - guess) > farthest:
            raise NotConverged("branches", _describe_location(period_map, guess), "correction above the step")
        chord = period_map.linear(x[:-1], x[-1])
        size = float(np.abs(chord.gap).max())
        if not np.isfinite(size) or size > DIVERGED:
            break
        step = _newton_step(chord, chord.gap, row, x - guess)
        if abs(step[-1]) > FARTHEST:
            break
        if size <= goal and np.abs(step).max() <= LAST_STEP * goal:
            return x + step, chord
        # Where one list of steps gives way to another the map itself jumps by their errors.
        if 0.5 * before < size <= STALL_FACTOR * goal:
            return x, chord
        x, before = x + step, size
        is_short = np.abs(step).max() <= GAP_DOUBT * np.sqrt(goal)
        if is_short and np.abs(period_map.gap(x[:-1], x[-1])).max() <= goal:
            return x, chord
    raise NotConverged("branches", _describe_location(period_map, guess), "bordered Newton")


def _describe_location(period_map: PeriodMap, x: Array) -> str:
    """Return name and value of the parameter at x (2 n + 1,) for messages: `speed_rpm = 1234.5`."""
    return f"{period_map.family.name} = {np.exp(x[-1]):.9g}"


def correct_state(period_map: PeriodMap, guess: Array, row: Array, linear: Linear) -> Array:
    """Find the orbit next to a guess without a new matrix where that suffices, otherwise by `correct`.

    Quasi-Newton steps start with the matrix of `linear`. Their best point is returned if its change over the
    period is at most STALL_FACTOR times the goal; otherwise `correct` starts from the guess.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    guess : (2 n + 1,) array
        State as of PeriodMap, followed by the logarithm of the family's parameter, dimensionless.
    row : (2 n + 1,) array
        Condition row . (x - guess) = 0 that selects the orbit x, dimensionless.
    linear : Linear
        Linearised map near the guess.

    Returns
    -------
    (2 n + 1,) array
        The orbit in the order of the guess, dimensionless.

    Raises
    ------
    NotConverged
        If neither method converges.
    """
    x, size = _by_chord(period_map, guess.copy(), guess, row, linear, _goal(period_map))
    if size > STALL_FACTOR * _goal(period_map):
        x, _ = correct(period_map, guess, row, linear)
    return x


def _goal(period_map: PeriodMap) -> float:
    """Return the largest component of the change over a period, dimensionless, at which an orbit is
    found.
    """
    return max(GOAL_OF_TOLERANCE * period_map.step_tolerance, MIN_GOAL)


def _by_chord(
    period_map: PeriodMap, x: Array, guess: Array, row: Array, linear: Linear, goal: float
) -> tuple[Array, float]:
    """Take Broyden's quasi-Newton steps from `x` with the bordered inverse of `linear` while each reduces
    the change.

    The condition is row . (x - guess) = 0. Return the best point (2 n + 1,) and the largest component of
    its change over the period, dimensionless; it need not have reached `goal`.
    """
    inverse = _bordered_inverse(linear, row)
    right, step = np.zeros(len(inverse)), np.zeros(len(inverse))
    best, nearest, before = np.inf, x, np.zeros(len(inverse))
    for count in range(CHORD_STEPS):
        gap = period_map.gap(x[:-1], x[-1])
        size = float(np.abs(gap).max())
        if not size < GAIN * best:
            return (x, size) if size < best else (nearest, best)
        best, nearest = size, x
        if size <= goal:
            break
        right[: gap.size], right[gap.size] = gap, row @ (x - guess)
        right[gap.size + 1 :] = linear.neutral.T @ (x - guess)[:-1]
        if count > 0:
            along = step @ inverse
            predicted_step = inverse @ (right - before)
            inverse = inverse + np.outer(step - predicted_step, along) / (along @ (right - before))
        before = right.copy()
        step = -inverse @ right
        if abs(step[x.size - 1]) > FARTHEST:
            break
        x = x + step[: x.size]
    return nearest, best


def _newton_step(linear: Linear, gap: Array, row: Array, displacement: Array) -> Array:
    """Return the Newton step (2 n + 1,) of the bordered system for a gap (2 n,) and the displacement x -
    guess.

    After the step row . (x - guess) = 0; it has no component along neutral directions.
    """
    right = np.zeros(gap.size + 1 + linear.neutral.shape[1])
    right[: gap.size], right[gap.size] = -gap, -row @ displacement
    right[gap.size + 1 :] = -linear.neutral.T @ displacement[:-1]
    return (_bordered_inverse(linear, row) @ right)[: gap.size + 1]


def _bordered_inverse(linear: Linear, row: Array) -> Array:
    """Return the inverse (2 n + 1 + k, 2 n + 1 + k) of bordered_matrix(); `linear` stores that of the
    last row.
    """
    key = row.tobytes()
    if key not in linear.inverses:
        linear.inverses.clear()
        linear.inverses[key] = _inverse(bordered_matrix(linear, row))
    return linear.inverses[key]


def _inverse(matrix: Array) -> Array:
    """Return the inverse of a matrix; the pseudoinverse where it is singular, as bordered matrices are at
    branch points.
    """
    try:
        inverse = np.asarray(np.linalg.inv(matrix), float)
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.pinv(matrix, rcond=SINGULAR), float)
    # The product of the norms is at least the ratio of the largest to the smallest singular value.
    if np.linalg.norm(matrix) * np.linalg.norm(inverse) < 1.0 / SINGULAR:
        return inverse
    return np.asarray(np.linalg.pinv(matrix, rcond=SINGULAR), float)


def make_point(period_map: PeriodMap, x: Array, linear: Linear, forward: Array) -> BranchPoint:
    """Make a point of a branch from an orbit, with its tangent, parity and extrema.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    x : (2 n + 1,) array
        Weighted state and logarithm of the parameter, dimensionless.
    linear : Linear
        Linearised map at x.
    forward : (2 n + 1,) array
        Direction with which the tangent makes an angle below 90 degrees, dimensionless.

    Returns
    -------
    BranchPoint
        Point of the branch.
    """
    matrix = bordered_matrix(linear, forward)
    tangent = _bordered_inverse(linear, forward)[: x.size, x.size - 1].copy()
    tangent /= np.linalg.norm(tangent)
    return BranchPoint(
        x=x,
        tangent=tangent,
        parity=float(np.linalg.slogdet(matrix)[0]),
        linear=linear,
        extrema=period_map.extrema(x[:-1], x[-1]),
    )


def solve_point(
    period_map: PeriodMap,
    guess: Array,
    row: Array,
    forward: Array,
    linear: Linear | None = None,
    farthest: float = np.inf,
) -> BranchPoint:
    """Find the orbit next to a guess and make it a point of a branch: correct(), then make_point().

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    guess : (2 n + 1,) array
        Weighted state and logarithm of the parameter, dimensionless.
    row : (2 n + 1,) array
        Normal of the plane row . (x - guess) = 0 in which the orbit is sought, dimensionless.
    forward : (2 n + 1,) array
        Direction along which the tangent points, dimensionless.
    linear : Linear, optional
        Linearised map near the guess.
    farthest : float
        Largest accepted distance from the guess, dimensionless.

    Returns
    -------
    BranchPoint
        Point of the branch.

    Raises
    ------
    NotConverged
        See correct().
    """
    x, solution = correct(period_map, guess, row, linear, farthest)
    return make_point(period_map, x, solution, forward)


def at_parameter(period_map: PeriodMap, z: Array, u: float) -> BranchPoint:
    """Find the orbit next to a state at a fixed parameter, with a tangent towards larger parameters.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    z : (2 n,) array
        Weighted state, dimensionless.
    u : float
        Logarithm of the parameter, dimensionless.

    Returns
    -------
    BranchPoint
        Point of the branch.

    Raises
    ------
    NotConverged
        See correct().
    """
    upward = np.zeros(z.size + 1)
    upward[-1] = 1.0
    return solve_point(period_map, np.append(z, u), upward, upward)
