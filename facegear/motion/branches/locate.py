"""Locate the special points between two neighbouring points of a branch, each bracketed along the arc."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from facegear.arrays import Array
from facegear.motion.branches.grazes import grazes, hidden_graze
from facegear.motion.branches.period_map import Linear, PeriodMap
from facegear.motion.branches.points import BranchPoint
from facegear.motion.branches.segment import Segment, zero
from facegear.motion.branches.special import Kind, Special, evidence, hidden_change, is_damped, may_change

AWAY_FROM_ENDS = 0.1
"""Part of a stretch beside either end in which no solved point divides it: halves may not differ too much."""
LEVEL = 1e-7
"""A component of the tangent below this is zero: a motion that keeps contact may double at one speed."""
SHORTEST = 1e-10
"""Part of a step down to which points that lie together are distinguished."""
DEEPEST = 7
"""Maximum number of halvings of a stretch on the mere chance that stability or contact changes twice in
it.
"""
DEEPEST_UNDAMPED = 2
"""Maximum number of halvings where all multipliers lie on the unit circle: there, closer looks see
rounding only.
"""
APART = 1e-6
"""Special points that lie closer on a step share the stretch between two points of the branch."""
ASIDE = 1e-6
"""Part of a stretch by which a graze has to lie off its ends to divide it."""
TOUCH_DISTANCE = 1e-4
"""An extreme this near an edge, in length scales, may touch it there; grazes are located to far less."""
LOOSE_BRACKET = 1e-9
"""Part of a step to which the place where a body comes loose is halved: a count changes there, which gives no
zero to be interpolated.
"""
FOLD_GOAL, MIN_FOLD_GOAL = 1e-3, 1e-10
"""Accuracy of the place of a fold, as a part of the step: factor on the square root of the tolerance of the
steps, and least value. An error of this size moves the parameter by its square.
"""
PLACE_GOAL, MIN_PLACE_GOAL = 0.1, 1e-13
"""Accuracy of the place of other special points, as a part of the step: factor on the tolerance of the steps,
and least value, some 500 rounding units of a double.
"""
STABILITY = (Kind.FOLD, Kind.DOUBLING, Kind.TORUS, Kind.BRANCH)
"""Special points at which multipliers pass the unit circle."""


@dataclass(frozen=True, eq=False)
class _Event:
    """Kind of change between two points, and the function whose zero locates it.

    `test` takes a BranchPoint, for a graze the array of its extrema instead. `meshes` and `edge` are
    those of a graze, see Special.
    """

    kind: Kind
    test: Callable[..., float]
    meshes: tuple[int, ...] = ()
    edge: int = 0


@dataclass(frozen=True, eq=False)
class DividedStep:
    """Special points on a step, and the inner points that divide the step between them.

    Attributes
    ----------
    specials : list of Special
        Special points in order. `after` counts the stretches between the divided step's points, from its
        first.
    inner : list of BranchPoint
        Points of the branch between neighbouring special points at which stability changes, so that each
        stretch contains at most one of those.
    """

    specials: list[Special]
    inner: list[BranchPoint]


def locate(period_map: PeriodMap, start_point: BranchPoint, end_point: BranchPoint) -> DividedStep:
    """Find all special points of a step of the continuation, and points of the branch that separate them.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    start_point, end_point : BranchPoint
        Neighbours on the branch.

    Returns
    -------
    DividedStep
        Special points, and inner points of the branch.
    """
    segment = Segment(period_map, start_point, end_point)
    specials = sorted(_between(segment, 0.0, 1.0), key=lambda special: special.after)
    changes = [special.after for special in specials if special.kind in STABILITY]
    cuts = [_cut(segment, *pair) for pair in pairwise(changes) if pair[1] - pair[0] > APART]
    marks = np.array([0.0, *cuts, 1.0])
    steps = np.arange(marks.size, dtype=float)
    special_points = [
        replace(special, after=float(np.interp(special.after, marks, steps))) for special in specials
    ]
    return DividedStep(special_points, [segment.at(cut) for cut in cuts])


def locate_grazes(
    period_map: PeriodMap, start_point: BranchPoint, end_point: BranchPoint, linear: Linear
) -> list[Special]:
    """Find the grazes between two neighbours one of which is a junction, where multipliers lie on the unit
    circle.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    start_point, end_point : BranchPoint
        Neighbours on the branch.
    linear : Linear
        Linearised map at the neighbour that is no junction. Orbits are corrected with it, because the matrix
        at a junction is singular.

    Returns
    -------
    list of Special
        Grazes in order along the branch.
    """
    segment = Segment(period_map, replace(start_point, linear=linear), replace(end_point, linear=linear))
    return sorted(_grazes_between(segment, 0.0, 1.0), key=lambda special: special.after)


def _cut(segment: Segment, low: float, high: float) -> float:
    """Return the fraction at which a step is divided between two special points: that of a solved point,
    else the middle.
    """
    middle = 0.5 * (low + high)
    inside = [fraction for fraction in segment.points_by_fraction if low < fraction < high]
    margin = AWAY_FROM_ENDS * (high - low)
    inside = [fraction for fraction in inside if low + margin < fraction < high - margin]
    return min(inside, key=lambda fraction: abs(fraction - middle), default=middle)


def _between(segment: Segment, low: float, high: float, depth: int = 0) -> list[Special]:
    """Return the special points between two fractions of a segment, `after` being the fraction of the
    segment.

    The stretch is halved while several events in it cannot be told apart or some may be hidden; `depth`
    counts the halvings.
    """
    first, second = segment.at(low), segment.at(high)
    if first.linear.neutral.shape != second.linear.neutral.shape:
        return _loosening(segment, low, high, depth)
    events, is_ambiguous = _events(segment.period_map, first, second)
    between = None
    may_halve = depth < (DEEPEST if is_damped(segment, low, high) else DEEPEST_UNDAMPED)
    if is_ambiguous and high - low > SHORTEST:
        between = 0.5 * (low + high)
    elif may_halve:
        between = _hidden(segment, low, high)
    if between is None:
        specials = [_refine(segment, low, high, event) for event in events]
        if may_halve:
            between = _leap(segment.period_map, specials, low, high)
            if between is None and may_change(segment, low, high):
                between = _kink(specials, low, high)
    if between is None:
        return specials
    halves = (_between(segment, *ends, depth + 1) for ends in ((low, between), (between, high)))
    return _join(*halves)


def _join(first: list[Special], second: list[Special]) -> list[Special]:
    """Return the special points of both halves of a stretch, with a graze that both contain as one.

    Where a stretch is divided at a graze, rounding decides in which half each of its meshes is found.
    """
    specials = [*first]
    for special in second:
        index = next((i for i, graze in enumerate(specials) if _same_graze(special, graze)), None)
        if index is None:
            specials.append(special)
        else:
            meshes = tuple(sorted({*specials[index].meshes, *special.meshes}))
            specials[index] = replace(specials[index], meshes=meshes)
    return specials


def _same_graze(first: Special, second: Special) -> bool:
    """Whether two special points are one graze: both are grazes of the same edge at the same place."""
    kinds = {first.kind, second.kind}
    return kinds == {Kind.GRAZE} and first.edge == second.edge and abs(first.after - second.after) < SHORTEST


def _kink(specials: list[Special], low: float, high: float) -> float | None:
    """Return the fraction of a graze strictly inside a stretch, or None.

    Multipliers bend sharply there, so each side is searched alone.
    """
    margin = ASIDE * (high - low)
    inside = (special.after for special in specials if special.kind is Kind.GRAZE)
    return next((fraction for fraction in inside if low + margin < fraction < high - margin), None)


def _leap(period_map: PeriodMap, specials: list[Special], low: float, high: float) -> float | None:
    """Return the fraction at which to divide a stretch with a graze that has no extremum at the edge, or
    None.

    There one of the extrema that are counted is born or vanishes, and the graze itself lies elsewhere.
    """
    for special in specials:
        if special.kind is not Kind.GRAZE or high - low <= SHORTEST:
            continue
        levels = np.array(period_map.edges(special.point.u))[:, special.meshes[0]]
        level = levels[int(special.edge > 0)]
        off = np.abs(special.point.extrema[special.meshes[0]] - level).min()
        if off > TOUCH_DISTANCE:
            inside = low < special.after < high
            return special.after if inside else 0.5 * (low + high)
    return None


def _hidden(segment: Segment, low: float, high: float) -> float | None:
    """Return the fraction at which a stretch must be divided to see events that cancel out between its
    ends, or None.
    """
    look = hidden_change(segment, low, high)
    if look is None:
        look = hidden_graze(segment, low, high)
    return look


def _grazes_between(segment: Segment, low: float, high: float, depth: int = 0) -> list[Special]:
    """Return the grazes between two fractions of a segment; `depth` counts halvings, as in _between()."""
    events, is_ambiguous = _grazing(segment.period_map, segment.at(low), segment.at(high))
    between = None
    if is_ambiguous and high - low > SHORTEST:
        between = 0.5 * (low + high)
    elif depth < DEEPEST:
        between = hidden_graze(segment, low, high)
    if between is None:
        specials = [_refine(segment, low, high, event) for event in events]
        if depth < DEEPEST:
            between = _leap(segment.period_map, specials, low, high)
    if between is None:
        return specials
    halves = (_grazes_between(segment, *ends, depth + 1) for ends in ((low, between), (between, high)))
    return _join(*halves)


def _grazing(period_map: PeriodMap, first: BranchPoint, second: BranchPoint) -> tuple[list[_Event], bool]:
    """Return the grazes between two points as events, and whether some cannot be told apart, see
    grazes().
    """
    graze_list, is_ambiguous = grazes(period_map, first, second)
    return [_Event(Kind.GRAZE, graze.test, graze.meshes, graze.edge) for graze in graze_list], is_ambiguous


def _events(period_map: PeriodMap, first: BranchPoint, second: BranchPoint) -> tuple[list[_Event], bool]:
    """Return the events between two points, and whether they are ambiguous, so that the stretch must be
    halved.

    A fold is a change of sign of the tangent's parameter component. Doublings, tori and branch points are
    changes in the counts of multipliers outside the unit circle or of the parity.
    """
    events, is_ambiguous = _grazing(period_map, first, second)
    plus_ones, minus, pairs = np.subtract(second.outside, first.outside)
    folds = _turns(first, second)
    if folds:
        events.append(_Event(Kind.FOLD, lambda point: point.tangent[-1]))
    crossing = first.parity != second.parity
    is_ambiguous = is_ambiguous or (folds and crossing)
    # A pair that meets on the real axis outside the circle becomes two real multipliers: the counts change,
    # but no multiplier passes the circle.
    collided = (abs(plus_ones) == 2 or abs(minus) == 2) and 2 * pairs == -(plus_ones + minus)
    if collided:
        return events, is_ambiguous
    if crossing or (not folds and plus_ones != 0) or abs(plus_ones) > 1:
        rank = min(first.outside[0], second.outside[0])
        if crossing and plus_ones == 0:
            is_ambiguous = True
        events.append(_Event(Kind.BRANCH, lambda point: _value_at_rank(point.real[::-1], rank) - 1.0))
    if minus != 0:
        rank = min(first.outside[1], second.outside[1])
        events.append(_Event(Kind.DOUBLING, lambda point: _value_at_rank(-point.real, rank) - 1.0))
    if pairs != 0:
        rank = min(first.outside[2], second.outside[2])
        events.append(_Event(Kind.TORUS, lambda point: _value_at_rank(np.abs(point.pairs), rank) - 1.0))
    is_ambiguous = (
        is_ambiguous or abs(plus_ones) > 1 or abs(minus) > 1 or abs(pairs) > 1 or (minus != 0 and pairs != 0)
    )
    return events, bool(is_ambiguous)


def _value_at_rank(values: Array, rank: int, default: float = 0.0) -> float:
    """Return the value at an index of values (m,), or a default where there are fewer."""
    return float(values[rank]) if rank < values.size else default


def _turns(first: BranchPoint, second: BranchPoint) -> bool:
    """Whether the tangent's parameter component changes its sign between two points: the branch has a
    fold there.
    """
    a, b = first.tangent[-1], second.tangent[-1]
    return bool(a * b < 0.0 and max(abs(a), abs(b)) > LEVEL)


def _loosening(segment: Segment, low: float, high: float, depth: int) -> list[Special]:
    """Return where a body comes loose or is caught between two fractions, by halving, and the events on
    both sides.

    There the number of neutral directions changes.
    """
    start, end = low, high
    while high - low > LOOSE_BRACKET:
        middle = 0.5 * (low + high)
        if segment.at(middle).linear.neutral.shape == segment.at(low).linear.neutral.shape:
            low = middle
        else:
            high = middle
    loose = segment.at(high).linear.neutral.shape[1] - segment.at(low).linear.neutral.shape[1]
    proof = f"{abs(loose)} shift(s) {'begin' if loose > 0 else 'cease'} to touch no mesh in contact"
    special = Special(Kind.NEUTRAL, segment.at(high), 1.0 + 0.0j, proof, high)
    beside = _between(segment, start, low, depth) + _between(segment, high, end, depth)
    # The last contact that a body loses is a graze of the same place.
    return [special, *(candidate for candidate in beside if abs(candidate.after - high) > APART)]


def _refine(segment: Segment, low: float, high: float, event: _Event) -> Special:
    """Locate an event between two fractions of a segment by Brent's method, and return it as a special
    point.
    """

    def test(fraction: float) -> float:
        if event.kind is Kind.GRAZE:
            return event.test(segment.extrema(fraction))
        return event.test(segment.at(fraction))

    # At a fold the parameter stands still along the arc, so the position along the chord need not be as
    # sharp.
    tolerance = segment.period_map.step_tolerance
    if event.kind is Kind.FOLD:
        goal = max(FOLD_GOAL * np.sqrt(tolerance), MIN_FOLD_GOAL)
    else:
        goal = max(PLACE_GOAL * tolerance, MIN_PLACE_GOAL)
    # Changes that lie closer together than SHORTEST are not distinguished, nor is their order known.
    fraction = zero(test, low, high, goal) if high - low > SHORTEST else high
    point = segment.at(fraction)
    off = event.test(point.extrema) if event.kind is Kind.GRAZE else np.nan
    multiplier, proof = evidence(event.kind, off, segment.at(low), point, segment.at(high))
    return Special(event.kind, point, multiplier, proof, fraction, event.meshes, event.edge)
