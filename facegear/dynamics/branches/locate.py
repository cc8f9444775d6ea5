"""Special points between two neighbouring points of a branch, each bracketed along the arc."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.grazes import grazes, hidden_graze
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint
from facegear.dynamics.branches.segment import Segment, zero
from facegear.dynamics.branches.special import Kind, Special, evidence

LEVEL = 1e-7
"""A component of the tangent below this is zero: a motion that keeps contact may double at one speed."""
SHORTEST = 1e-10
"""Part of a step down to which points that lie together are distinguished."""
LOOKS = 2
"""How often a stretch is halved on the mere chance that a multiplier crosses the unit circle twice in it."""
CLOSE = 0.02
"""A multiplier this close to the unit circle at an end of a stretch may cross it inside."""
NEAR_CIRCLE = 0.4


@dataclass(frozen=True, eq=False)
class _Event:
    """test: of a Point, at a graze of its extrema."""

    kind: Kind
    test: Callable[..., float]
    meshes: tuple[int, ...] = ()
    edge: int = 0


def locate(period_map: PeriodMap, here: BranchPoint, there: BranchPoint) -> list[Special]:
    """All special points between two neighbours, in order; `after` is the fraction of the way."""
    segment = Segment(period_map, here, there)
    return sorted(_between(segment, 0.0, 1.0), key=lambda special: special.after)


def _between(
    segment: Segment, low: float, high: float, depth: int = 0, bend: float | None = None
) -> list[Special]:
    first, second = segment.at(low), segment.at(high)
    if first.linear.neutral.shape != second.linear.neutral.shape:
        return _loosening(segment, low, high)
    events, mixed = _events(segment.period_map, first, second)
    if (mixed and high - low > SHORTEST) or (depth < LOOKS and _may_hide(first, second, bend)):
        between: float | None = 0.5 * (low + high)
        bend = _bend(first, segment.at(0.5 * (low + high)), second)
    else:
        between, bend = hidden_graze(segment, low, high) if depth < LOOKS else None, None
    if between is None:
        return [_refined(segment, low, high, event) for event in events]
    left = _between(segment, low, between, depth + 1, bend)
    return left + _between(segment, between, high, depth + 1, bend)


def _may_hide(first: BranchPoint, second: BranchPoint, bend: float | None) -> bool:
    """Whether a multiplier may have left the unit circle and come back between two points.

    bend: see _bend(), over a stretch twice as long that holds them.
    """
    if first.outside != second.outside or first.multipliers.size != second.multipliers.size:
        return False
    first_size, two = np.abs(first.multipliers), np.abs(second.multipliers)
    closest = np.minimum(np.abs(first_size - 1.0), np.abs(two - 1.0))
    # A parabola rises above the nearer end of half its stretch by at most a 32nd of its second difference.
    reach = (
        np.clip(np.abs(first_size - two), CLOSE, 0.2)
        if bend is None
        else np.full(first_size.size, bend / 8.0)
    )
    return bool((closest < reach).any())


def _bend(first: BranchPoint, middle: BranchPoint, second: BranchPoint) -> float | None:
    """Largest second difference of moduli near the unit circle; None where they cannot be compared."""
    sizes = [np.abs(point.multipliers) for point in (first, middle, second)]
    if len({size.size for size in sizes}) > 1:
        return None
    near = np.abs(sizes[1] - 1.0) < NEAR_CIRCLE
    return float(np.abs(sizes[0] - 2.0 * sizes[1] + sizes[2])[near].max(initial=0.0))


def _events(period_map: PeriodMap, first: BranchPoint, second: BranchPoint) -> tuple[list[_Event], bool]:
    """Changes between two points; True if more than one of a kind is among them."""
    touched, mixed = grazes(period_map, first, second)
    events = [_Event(Kind.GRAZE, graze.test, graze.meshes, graze.edge) for graze in touched]
    ones, minus, pairs = np.subtract(second.outside, first.outside)
    folds = _turns(first, second)
    if folds:
        events.append(_Event(Kind.FOLD, lambda point: point.tangent[-1]))
    crossing = first.parity != second.parity
    mixed = mixed or (folds and crossing)
    collided = (abs(ones) == 2 or abs(minus) == 2) and 2 * pairs == -(ones + minus)
    if collided:
        return events, mixed
    if crossing or (not folds and ones != 0) or abs(ones) > 1:
        rank = min(first.outside[0], second.outside[0])
        if crossing and ones == 0:
            mixed = True
        events.append(_Event(Kind.BRANCH, lambda point: _ranked(point.real[::-1], rank) - 1.0))
    if minus != 0:
        rank = min(first.outside[1], second.outside[1])
        events.append(_Event(Kind.DOUBLING, lambda point: _ranked(-point.real, rank) - 1.0))
    if pairs != 0:
        rank = min(first.outside[2], second.outside[2])
        events.append(_Event(Kind.TORUS, lambda point: _ranked(np.abs(point.pairs), rank) - 1.0))
    mixed = mixed or abs(ones) > 1 or abs(minus) > 1 or abs(pairs) > 1 or (minus != 0 and pairs != 0)
    return events, bool(mixed)


def _ranked(values: Array, rank: int, missing: float = 0.0) -> float:
    return float(values[rank]) if rank < values.size else missing


def _turns(first: BranchPoint, second: BranchPoint) -> bool:
    a, b = first.tangent[-1], second.tangent[-1]
    return bool(a * b < 0.0 and max(abs(a), abs(b)) > LEVEL)


def _loosening(segment: Segment, low: float, high: float) -> list[Special]:
    """A body comes loose or is caught: halve until the parameter is known."""
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        if segment.at(middle).linear.neutral.shape == segment.at(low).linear.neutral.shape:
            low = middle
        else:
            high = middle
    loose = segment.at(high).linear.neutral.shape[1] - segment.at(low).linear.neutral.shape[1]
    proof = f"{abs(loose)} shift(s) {'begin' if loose > 0 else 'cease'} to touch no mesh in contact"
    return [Special(Kind.NEUTRAL, segment.at(high), 1.0 + 0.0j, proof, high)]


def _refined(segment: Segment, low: float, high: float, event: _Event) -> Special:
    def test(fraction: float) -> float:
        if event.kind is Kind.GRAZE:
            return event.test(segment.extrema(fraction))
        return event.test(segment.at(fraction))

    # At a fold the parameter stands still along the arc, so the position along the chord need not be as
    # sharp.
    tolerance = segment.period_map.step_tolerance
    goal = max(1e-3 * np.sqrt(tolerance), 1e-10) if event.kind is Kind.FOLD else max(0.1 * tolerance, 1e-13)
    # Changes that lie closer together than SHORTEST are not distinguished, nor is their order known.
    fraction = zero(test, low, high, goal) if high - low > SHORTEST else high
    point = segment.at(fraction)
    off = event.test(point.extrema) if event.kind is Kind.GRAZE else np.nan
    multiplier, proof = evidence(event.kind, off, segment.at(low), point, segment.at(high))
    return Special(event.kind, point, multiplier, proof, fraction, event.meshes, event.edge)
