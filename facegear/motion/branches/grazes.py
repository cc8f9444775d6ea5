"""Find grazes between two neighbouring points of a branch: extrema of mesh deflections that pass an edge."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint
from facegear.motion.branches.segment import Segment

EDGES = (-1, 1)
"""Number of each backlash edge: -1 lower, 1 upper."""
LOOKED_AT = np.linspace(0.0, 1.0, 33)[1:-1]
"""Fractions of a stretch at which a cubic is evaluated."""
SYMMETRY_TOLERANCE = 1e-7
"""Distance of extremes, in length scales, up to which symmetry moves their meshes alike; they differ by
rounding, while grazes that lie together by chance differ by more (free choice, as orbits are known to 1e-9).
"""
ALMOST = 0.1
"""A cubic is examined where it comes this near to an edge, as a fraction of the lesser distance at the
ends.
"""


@dataclass(frozen=True, eq=False)
class Graze:
    """An extremum that passes an edge.

    Attributes
    ----------
    test : callable
        Function of an array of PeriodMap.extrema() that returns the height of the extremum above the
        edge, in length scales; its zero is the graze.
    meshes : tuple of int
        Meshes that symmetry moves in the same way.
    edge : int
        Edge: -1 lower, 1 upper.
    """

    test: Callable[[Array], float]
    meshes: tuple[int, ...]
    edge: int


def grazes(period_map: PeriodMap, first: BranchPoint, second: BranchPoint) -> tuple[list[Graze], bool]:
    """Find the extrema that have passed an edge between two points.

    The number of maxima less that of minima above an edge gives its passages. A maximum and a minimum that
    are born together change neither. Meshes that symmetry moves in the same way make one graze.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    first, second : BranchPoint
        Points of a branch.

    Returns
    -------
    list of Graze
        Grazes between the points.
    bool
        Whether some of them cannot be told apart yet.
    """
    graze_ends: list[tuple[Array, Graze]] = []
    is_ambiguous = False
    levels = _levels(period_map, first.u)
    before, after = (_above(point.extrema, levels) for point in (first, second))
    for side, mesh in np.argwhere(np.isfinite(levels) & (np.diff(after - before)[..., 0] != 0)):
        changes = (after - before)[side, mesh]
        kind = int(changes[0] == 0)
        is_ambiguous = is_ambiguous or bool(changes.all()) or abs(changes[kind]) > 1
        rank = int(min(before[side, mesh, kind], after[side, mesh, kind]))
        test = _distance(float(levels[side, mesh]), int(mesh), kind, rank)
        ends = np.array([side, kind, *(test(point.extrema) for point in (first, second))])
        index = next(
            (
                i
                for i, (known_ends, _) in enumerate(graze_ends)
                if np.abs(ends - known_ends).max() < SYMMETRY_TOLERANCE
            ),
            None,
        )
        if index is None:
            graze_ends.append((ends, Graze(test, (int(mesh),), EDGES[side])))
        else:
            graze = graze_ends[index][1]
            graze_ends[index] = ends, Graze(test, (*graze.meshes, int(mesh)), graze.edge)
    return [graze for _, graze in graze_ends], is_ambiguous


def _levels(period_map: PeriodMap, u: float) -> Array:
    """Return the lower and upper edges (2, m) of all meshes, in length scales; NaN where a mesh never
    opens.
    """
    levels = np.array(period_map.edges(u))
    return np.where(np.isfinite(levels), levels, np.nan)


def _above(extrema: Array, levels: Array) -> Integers:
    """Count the extrema (m, 2, most) that lie above each level (2, m): numbers (2, m, 2) of maxima and of
    minima.

    The axes are edges (lower, upper), meshes, and kinds of extrema.
    """
    return (extrema > levels[:, :, None, None]).sum(axis=-1)


def _distance(level: float, mesh: int, kind: int, rank: int) -> Callable[[Array], float]:
    """Return the test function of a graze, for Graze.test: height of an extremum above an edge, in length
    scales.

    It takes an array of PeriodMap.extrema(). `kind` is 0 for maxima, 1 for minima; `rank` counts from the
    largest. Where the extremum does not exist the function returns -1.
    """

    def test(extrema: Array) -> float:
        value = extrema[mesh, kind, rank] if rank < extrema.shape[2] else -np.inf
        return float(value - level) if np.isfinite(value) else -1.0

    return test


def hidden_graze(segment: Segment, low: float, high: float) -> float | None:
    """Find where the passages of an edge go against their change from end to end of a stretch.

    Cubics through the extrema with their slopes along the branch show where to look: where they come close to
    an edge, or come back over one that they pass.

    Parameters
    ----------
    segment : Segment
        Stretch of a branch between two points.
    low, high : float
        Ends of the stretch, as fractions of the chord.

    Returns
    -------
    float or None
        Position as a fraction of the chord at which to divide the stretch, or None.
    """
    # An extremum may come over an edge and go back within one step, or two of them may be born beyond it:
    # both ends then have the same contacts, and only the extrema between them tell.
    points = segment.at(low), segment.at(high)
    reach = float(np.linalg.norm(points[1].x - points[0].x))
    levels = _levels(segment.period_map, points[0].u)
    maxima = min(point.extrema.shape[2] for point in points)
    extrema = [point.extrema[:, :, :maxima] for point in points]
    near = [_near(extrema[0], extrema[1], level, reach) for level in levels]
    counts = [_above(point.extrema, levels) for point in points]
    born = np.argwhere((counts[0] != counts[1]).all(axis=-1) & np.isfinite(levels))
    if not len(born) and not any(number.any() for number in near):
        return None
    whole = [segment.extremum_slope(fraction, high - low) for fraction in (low, high)]
    slopes = [slope[:, :, :maxima] for slope in whole]
    looks_of = [*_dips(extrema, slopes, levels, near)]
    looks_of += _ripples([point.extrema for point in points], whole, levels, counts, born)
    before, after = (_passages(point.extrema, levels) for point in points)
    # The cubics only propose places. Passages that rise and fall on the way through them are the proof.
    for looks in dict.fromkeys(looks_of):
        fractions = [low + look * (high - low) for look in looks]
        passages = [before, *(_passages(segment.extrema(fraction), levels) for fraction in fractions), after]
        steps = np.diff(passages, axis=0)
        if ((steps > 0).any(axis=0) & (steps < 0).any(axis=0)).any():
            return fractions[0]
    return None


def _passages(extrema: Array, levels: Array) -> Integers:
    """Return minima less maxima above each edge, (2, m): minus the number of times the deflection rises
    above it.

    The number counts for one period and is 0 for edges that are not finite.
    """
    return np.where(np.isfinite(levels), np.diff(_above(extrema, levels))[..., 0], 0)


def _near(first: Array, second: Array, level: Array, reach: float) -> Mask:
    """Return which extrema (m, 2, most) lie within `reach` of an edge, at `level` (m,), at either end of
    a stretch.
    """
    first_gap, second_gap = first - level[:, None, None], second - level[:, None, None]
    finite = np.isfinite(first_gap) & np.isfinite(second_gap)
    return finite & (np.minimum(abs(first_gap), abs(second_gap)) < reach)


def _dips(
    extrema: list[Array], slopes: list[Array], levels: Array, near: list[Mask]
) -> Iterator[tuple[float, ...]]:
    """Yield fractions of a stretch at which extrema may pass an edge and come back, by cubics through
    them.

    Where both ends of a cubic lie on one side of the edge, it is where the cubic comes closest. Where
    they lie on both sides, it is a pair before and after it comes back. `extrema` and `slopes` (m, 2,
    most) are those at both ends, `levels` (2, m) the edges, `near` the extrema to examine at each edge.
    """
    t = LOOKED_AT
    for level, few in zip(levels, near, strict=True):
        indices = np.nonzero(few)
        first_height, second_height = (values[indices] - level[indices[0]] for values in extrema)
        sign = np.sign(first_height)
        first, last = (slope[indices] for slope in slopes)
        bend = np.array(
            [
                first_height,
                first,
                3 * (second_height - first_height) - 2 * first - last,
                first + last - 2 * (second_height - first_height),
            ]
        )
        heights = sign[:, None] * (bend.T @ t ** np.arange(4)[:, None])
        passing = first_height * second_height <= 0.0
        almost = ALMOST * np.minimum(abs(first_height), abs(second_height))
        dipping = ~passing & (heights.min(axis=1, initial=np.inf) < almost)
        for row in np.flatnonzero(dipping):
            yield (float(t[heights[row].argmin()]),)
        for row in np.flatnonzero(passing):
            returning = np.flatnonzero((heights[row, :-1] < 0.0) & (heights[row, 1:] > 0.0))
            if returning.size:
                yield float(t[returning[0]]), float(t[returning[0] + 1])


def _ripples(
    extrema: list[Array], slopes: list[Array], levels: Array, counts: list[Integers], born: Integers
) -> Iterator[tuple[float]]:
    """Yield fractions of a stretch at which only one of a maximum and a minimum that are born in it may
    be above an edge.

    `born` lists edge and mesh where both counts of _above() differ between the ends. The fraction is the
    mean of the zeros of straight lines through the heights of both extrema at the end at which they
    exist.
    """
    for side, mesh in born:
        ranks = np.minimum(counts[0][side, mesh], counts[1][side, mesh])
        end = int((counts[1] > counts[0])[side, mesh, 0])
        zeros = []
        for kind, rank in enumerate(ranks):
            height = extrema[end][mesh, kind, rank] - levels[side, mesh]
            slope = slopes[end][mesh, kind, rank]
            zeros.append(end - height / slope if slope != 0.0 else np.nan)
        look = float(np.mean(zeros))
        if 0.0 < look < 1.0:
            yield (look,)
