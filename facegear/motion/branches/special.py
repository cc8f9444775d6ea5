"""Special points of a branch: their kinds and the evidence for each.

Folds and doublings: Seydel 2010; grazing: di Bernardo et al. 2008.

Find where the stability of a branch may change and change back between two neighbouring points. Two
multipliers that meet on the unit circle may leave it and come back within one step. The more they turn in the
step, the narrower is such a band. The matrix of the map itself changes smoothly along a branch, also where
multipliers meet. It is interpolated by cubics through the matrices and their slopes at both ends, on
stretches over which no multiplier near the circle turns far. Where the multipliers of the interpolated
matrices suggest a change, the branch itself is then examined.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import Array, ComplexArray, Integers
from facegear.motion.branches.points import REAL_PAIR, BranchPoint, without_neutral
from facegear.motion.branches.segment import Segment


class Kind(StrEnum):
    """Kinds of special points of a branch.

    FOLD: the parameter turns back. DOUBLING: a multiplier passes -1. TORUS: a complex pair passes the
    unit circle. BRANCH: another branch crosses, a multiplier is 1. GRAZE: an extremum of a deflection
    touches an edge of the backlash. NEUTRAL: a body loses its last contact or gets one, and the number of
    neutral directions changes.
    """

    FOLD = "fold"
    DOUBLING = "period doubling"
    TORUS = "Neimark-Sacker"
    BRANCH = "branch point"
    GRAZE = "graze"
    NEUTRAL = "neutral body"


@dataclass(frozen=True, eq=False)
class Special:
    """A special point of a branch.

    Attributes
    ----------
    kind : Kind
        Its kind.
    point : BranchPoint
        The motion at it.
    multiplier : complex
        The Floquet multiplier that passes the unit circle there (NaN at a graze).
    proof : str
        Evidence that it is a special point, as text with numbers.
    after : float
        Position along the branch: index of the point before plus the fraction of the way to the next.
    meshes : tuple of int
        Meshes that graze.
    edge : int
        Edge that they graze: 1 upper, -1 lower.
    """

    kind: Kind
    point: BranchPoint
    multiplier: complex
    proof: str
    after: float
    meshes: tuple[int, ...] = ()
    edge: int = 0


def evidence(
    kind: Kind, off: float, before: BranchPoint, point: BranchPoint, after: BranchPoint
) -> tuple[complex, str]:
    """Return the critical multiplier of a point between two neighbours, and the evidence for its kind.

    Parameters
    ----------
    kind : Kind
        Kind of the point.
    off : float
        Distance of a graze's extremum from the edge over the length scale, dimensionless.
    before, point, after : BranchPoint
        The point and its neighbours.

    Returns
    -------
    complex
        Floquet multiplier, dimensionless.
    str
        Evidence as one line of text with the numbers that prove the kind.
    """
    if kind is Kind.GRAZE:
        return complex(np.nan), f"an extreme lies {abs(off):.1e} length scales from the edge"
    if kind is Kind.FOLD:
        mu = _nearest(point.multipliers, 1.0)
        return mu, (
            f"the speed component of the tangent goes from {before.tangent[-1]:+.1e} to "
            f"{after.tangent[-1]:+.1e}; multiplier {mu.real:.9f}"
        )
    if kind is Kind.DOUBLING:
        mu = _nearest(point.multipliers, -1.0)
        return mu, f"a real multiplier is {mu.real:.9f}, goes through -1"
    if kind is Kind.BRANCH:
        mu = _nearest(point.multipliers, 1.0)
        parity_change = "changes" if before.parity != after.parity else "keeps"
        return (
            mu,
            f"multiplier {mu.real:.9f} at a tangent with {point.tangent[-1]:+.1e}; parity {parity_change}",
        )
    pair = point.pairs[np.argmin(np.abs(np.abs(point.pairs) - 1.0))] if point.pairs.size else complex(np.nan)
    return complex(pair), f"modulus {abs(pair):.9f}, angle {np.degrees(np.angle(pair)):.6f} deg"


def _nearest(values: ComplexArray, goal: float) -> complex:
    """Return the one of complex values (m,) that is nearest to a real goal."""
    return complex(values[np.argmin(np.abs(values - goal))])


LEAST_DISTANCE = 1e-3
"""Distance of multipliers from the unit circle that counts as the least: it bounds the number of looks."""
NEAR_CIRCLE = 0.4
"""Multipliers farther from the unit circle at both ends of a stretch are left out."""
WIDEST_TURN, NARROWEST_TURN = 0.6, 0.1
"""Angles in rad over which the matrix is interpolated: a cubic errs there by 3e-4 and 3e-7."""
UNDAMPED = 1e-6
"""Multipliers nearer to the circle lie on it, as far as they are known: without damping all of them do, and
closer looks tell no more."""
CUBIC_ERROR = 1.0 / 384.0
"""Error of a Hermite cubic over a stretch, in the fourth power of the angle that a multiplier turns."""
MIN_LOOKS, MAX_LOOKS = 4, 32
"""Smallest and largest number of matrices that are interpolated in a stretch."""
SHORTEST_LENGTH = 1e-3
"""Shorter stretches, in length scales, are not examined: ten times the step of the slopes."""
TRUSTED = 0.25
"""Fraction of a multiplier's approach to the circle, beyond that at the ends, that may be an error."""
STEEP = 3.0
"""Ratio of a matrix slope to the chord and the other end's slope above which it belongs to a graze and
is left out.
"""


def may_change(segment: Segment, low: float, high: float) -> bool:
    """Whether a stretch is long enough, and a multiplier at its ends near enough, to pass the unit circle.

    Parameters
    ----------
    segment : Segment
        Stretch of a branch between two points.
    low, high : float
        Ends of the stretch, as fractions of the chord.

    Returns
    -------
    bool
        False if the stretch need not be examined.
    """
    closest = min(_distance(segment.at(fraction)) for fraction in (low, high))
    return segment.length * (high - low) >= SHORTEST_LENGTH and closest <= NEAR_CIRCLE


def is_damped(segment: Segment, low: float, high: float) -> bool:
    """Whether an end of a stretch has no multiplier on the unit circle; undamped motions have all of them
    there.

    Parameters
    ----------
    segment : Segment
        Stretch of a branch between two points.
    low, high : float
        Ends of the stretch, as fractions of the chord.

    Returns
    -------
    bool
        True if the largest distance from the circle is above UNDAMPED.
    """
    return max(_distance(segment.at(fraction)) for fraction in (low, high)) > UNDAMPED


def _distance(point: BranchPoint) -> float:
    """Return the distance from the unit circle, abs(abs(multiplier) - 1), of the multiplier nearest to it."""
    return float(np.abs(np.abs(point.multipliers) - 1.0).min(initial=np.inf))


def hidden_change(segment: Segment, low: float, high: float) -> float | None:
    """Find where stability may change and change back in a stretch, which its ends do not show.

    Matrices are interpolated between the ends by cubics, and their multipliers examined. Where the
    multipliers turn too far for a cubic, the answer is the middle of the stretch.

    Parameters
    ----------
    segment : Segment
        Stretch of a branch between two points.
    low, high : float
        Ends of the stretch, as fractions of the chord.

    Returns
    -------
    float or None
        Position, as a fraction of the chord, to examine, or None.
    """
    if not may_change(segment, low, high):
        return None
    ends, stretch = (segment.at(low), segment.at(high)), high - low
    neutral = ends[0].linear.neutral.shape[1]
    distances = [_distance(point) for point in ends]
    # Multipliers may leave the circle and return within one step, where the counts at both ends are equal. A
    # cubic through the matrices and their slopes shows it without a further orbit, if it is short enough.
    start, end = (segment.matrix_slope(fraction, stretch) for fraction in (low, high))
    turn = min(_turn(point, rate, neutral) for point, rate in zip(ends, (start, end), strict=True))
    if turn > _widest_turn(max(distances)):
        return 0.5 * (low + high)
    # A band in which multipliers reach the circle is at least as wide, in their angle, as they were off it.
    count = int(np.clip(np.ceil(turn / max(max(distances), LEAST_DISTANCE)), MIN_LOOKS, MAX_LOOKS))
    looks = np.arange(1, count + 1) / (count + 1.0)
    matrices = _interpolate([point.linear.matrix for point in ends], [start, end], looks)
    values = without_neutral(np.linalg.eigvals(matrices), neutral)
    error = CUBIC_ERROR * turn**4
    outside = [np.array([point.outside]) for point in ends]
    surely, perhaps = (
        np.concatenate([outside[0], _outside(values, margin), outside[1]]) for margin in (error, -error)
    )
    # First what is certain, whatever the error of the cubic; then what only may be.
    look = _returning(surely, perhaps)
    if look is None:
        look = _approaching(values, distances, looks, error)
    return None if look is None else float(low + looks[look] * stretch)


def _widest_turn(distance: float) -> float:
    """Return the largest angle, rad, that multipliers may turn in a stretch that is interpolated.

    There a cubic errs by half the `distance` of the multipliers from the unit circle; it is kept from
    NARROWEST_TURN to WIDEST_TURN.
    """
    if distance < UNDAMPED:
        return WIDEST_TURN
    return float(np.clip((distance / (2.0 * CUBIC_ERROR)) ** 0.25, NARROWEST_TURN, WIDEST_TURN))


def _turn(point: BranchPoint, change: Array, neutral: int) -> float:
    """Return the largest change of a multiplier near the unit circle by a small change (2 n, 2 n) of the
    matrix.

    By first-order perturbation; `neutral` multipliers nearest to 1 are left out. It is an angle in rad
    for one on the circle.
    """
    values, vectors = np.linalg.eig(point.linear.matrix)
    try:
        multiplier_changes = np.abs(np.einsum("ij,jk,ki->i", np.linalg.inv(vectors), change, vectors))
    except np.linalg.LinAlgError:
        return np.inf
    off = np.abs(values - 1.0)
    indices = np.argsort(off)[neutral:]
    near = indices[np.abs(np.abs(values[indices]) - 1.0) <= NEAR_CIRCLE]
    return float(multiplier_changes[near].max(initial=0.0))


def _interpolate(matrices: list[Array], changes: list[Array], looks: Array) -> Array:
    """Return matrices (K, 2 n, 2 n) at fractions `looks` (K,) of a stretch, by a Hermite cubic.

    `matrices` are those at both ends, `changes` their derivatives by the fraction there.
    """
    step = matrices[1] - matrices[0]
    start, end = changes
    # At a graze the slope of the matrix is infinite on one side (a power of 3/2 in the map). A slope out of
    # proportion is replaced by that of the parabola through the other three numbers.
    sizes = [float(np.linalg.norm(slope)) for slope in (start, end, step)]
    if sizes[0] > STEEP * max(sizes[1:]):
        start = 2.0 * step - end
    elif sizes[1] > STEEP * max(sizes[0], sizes[2]):
        end = 2.0 * step - start
    t = looks[:, None, None]
    return matrices[0] + t * (start + t * (3.0 * step - 2.0 * start - end + t * (start + end - 2.0 * step)))


def _outside(values: ComplexArray, margin: float) -> Integers:
    """Count the multipliers (K, m) beyond 1 + margin at K positions, by three kinds as
    BranchPoint.outside, (K, 3).
    """
    size = np.abs(values)
    beyond, real = size > 1.0 + margin, np.abs(values.imag) <= REAL_PAIR
    classes = (real & (values.real > 0.0), real & (values.real < 0.0), ~real & (values.imag > 0.0))
    return np.stack([(beyond & kind).sum(axis=1) for kind in classes], axis=1)


def _returning(surely: Integers, perhaps: Integers) -> int | None:
    """Return the index of the first of K looks at which a count goes against the change from end to end,
    or None.

    `surely` and `perhaps` are counts (K + 2, 3) as of _outside(), ends included: of multipliers outside
    the circle by more than the error of the matrices, and of those that may be outside within it.
    """
    for sure, possible in zip(surely.T, perhaps.T, strict=True):
        lower, upper = sorted((sure[0], sure[-1]))
        beyond = np.flatnonzero((sure > upper) | (possible < lower))
        if beyond.size:
            return int(beyond[0]) - 1
        inner, possible = sure[1:-1], possible[1:-1]
        if sure[-1] > sure[0]:
            against = np.flatnonzero(np.maximum.accumulate(inner)[:-1] > possible[1:])
        else:
            against = np.flatnonzero(np.minimum.accumulate(possible)[:-1] < inner[1:])
        if against.size:
            return int(against[0])
    return None


def _approaching(values: ComplexArray, ends: list[float], looks: Array, error: float) -> int | None:
    """Return the index of the look at which multipliers come so near the unit circle that they may pass
    it, or None.

    `values` are multipliers (K, m) at fractions `looks` (K,), `ends` the distances from the circle at
    both ends, and `error` is that of the interpolated multipliers. The approach counts beyond a straight
    line between the ends.
    """
    nearest = np.abs(np.abs(values) - 1.0).min(axis=1)
    before = ends[0] + looks * (ends[1] - ends[0])
    gain = before - nearest
    doubtful = (gain > error) & (nearest < np.maximum(error, TRUSTED * gain))
    return int(np.argmin(np.where(doubtful, nearest, np.inf))) if doubtful.any() else None
