"""Special points between two neighbouring points of a branch, each bracketed along the arc."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import Point
from facegear.dynamics.branches.segment import Segment, zero
from facegear.dynamics.branches.special import Kind, Special, evidence

Array = NDArray[np.float64]
LEVEL = 1e-7
"""A component of the tangent below this is zero: a motion that keeps contact may double at one speed."""
SHORTEST = 1e-10
"""Part of a step down to which points that lie together are told apart."""
LOOKS = 2
"""How often a stretch is halved on the mere chance that a multiplier crosses the unit circle twice in it."""
CLOSE = 0.02
"""A multiplier this close to the unit circle at an end of a stretch may cross it inside."""


@dataclass(frozen=True, eq=False)
class _Event:
    """test: of a Point, at a graze of its turning points."""

    kind: Kind
    test: Callable[..., float]
    meshes: tuple[int, ...] = ()
    edge: int = 0


def locate(flow: PeriodMap, here: Point, there: Point) -> list[Special]:
    """All special points between two neighbours, in order; `after` is the share of the way."""
    segment = Segment(flow, here, there)
    return sorted(_between(segment, 0.0, 1.0), key=lambda special: special.after)


def _between(segment: Segment, low: float, high: float, depth: int = 0) -> list[Special]:
    first, second = segment.at(low), segment.at(high)
    if first.linear.afloat.shape != second.linear.afloat.shape:
        return _loosening(segment, low, high)
    events, mixed = _events(segment.flow, first, second)
    if (mixed and high - low > SHORTEST) or (depth < LOOKS and _may_hide(first, second)):
        middle = 0.5 * (low + high)
        segment.at(middle)
        return _between(segment, low, middle, depth + 1) + _between(segment, middle, high, depth + 1)
    return [_refined(segment, low, high, event) for event in events]


def _may_hide(first: Point, second: Point) -> bool:
    """Whether a multiplier may have left the unit circle and come back between two points."""
    if first.outside != second.outside or first.multipliers.size != second.multipliers.size:
        return False
    one, two = np.abs(first.multipliers), np.abs(second.multipliers)
    closest = np.minimum(np.abs(one - 1.0), np.abs(two - 1.0))
    return bool((closest < np.clip(np.abs(one - two), CLOSE, 0.2)).any())


def _events(flow: PeriodMap, first: Point, second: Point) -> tuple[list[_Event], bool]:
    """Changes between two points; True if more than one of a kind is among them."""
    events, mixed = _contact_events(flow, first, second)
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


def _turns(first: Point, second: Point) -> bool:
    a, b = first.tangent[-1], second.tangent[-1]
    return bool(a * b < 0.0 and max(abs(a), abs(b)) > LEVEL)


def _contact_events(flow: PeriodMap, first: Point, second: Point) -> tuple[list[_Event], bool]:
    """Extremes of the mesh deflections that have passed an edge; True if some cannot be told apart yet.

    Maxima less minima above an edge count its passages. A maximum and a minimum that are born together change
    none. Meshes that symmetry moves alike make one event.
    """
    events: dict[tuple, _Event] = {}
    mixed = False
    lower, upper = flow.edges(first.u)
    for mesh, (one, two) in enumerate(zip(first.turning, second.turning, strict=True)):
        for edge, level in ((-1, lower[mesh]), (1, upper[mesh])):
            counts = [[np.count_nonzero(values > level) for values in side] for side in (one, two)]
            changes = np.subtract(counts[1], counts[0])
            if not np.isfinite(level) or changes[0] == changes[1]:
                continue
            kind = int(changes[0] == 0)
            mixed = mixed or bool(changes.all()) or abs(changes[kind]) > 1
            rank = int(min(counts[0][kind], counts[1][kind]))
            test = _distance(flow, first.u, mesh, edge, kind, rank)
            alike = (edge, kind, *(round(test(turning), 7) for turning in (first.turning, second.turning)))
            meshes = (*events[alike].meshes, mesh) if alike in events else (mesh,)
            events[alike] = _Event(Kind.GRAZE, test, meshes, edge)
    return list(events.values()), mixed


def _distance(
    flow: PeriodMap, u: float, mesh: int, edge: int, kind: int, rank: int
) -> Callable[[list[tuple[Array, Array]]], float]:
    """How far the extreme of a rank, counted from the largest, lies above an edge."""
    level = float(flow.edges(u)[0 if edge < 0 else 1][mesh])

    def test(turning: list[tuple[Array, Array]]) -> float:
        values = np.sort(turning[mesh][kind])[::-1]
        return float(values[rank] - level) if rank < values.size else -1.0

    return test


def _loosening(segment: Segment, low: float, high: float) -> list[Special]:
    """A body comes loose or is caught: halve until the place is known."""
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        if segment.at(middle).linear.afloat.shape == segment.at(low).linear.afloat.shape:
            low = middle
        else:
            high = middle
    loose = segment.at(high).linear.afloat.shape[1] - segment.at(low).linear.afloat.shape[1]
    proof = f"{abs(loose)} shift(s) {'begin' if loose > 0 else 'cease'} to touch no mesh in contact"
    return [Special(Kind.AFLOAT, segment.at(high), 1.0 + 0.0j, proof, high)]


def _refined(segment: Segment, low: float, high: float, event: _Event) -> Special:
    def test(share: float) -> float:
        if event.kind is Kind.GRAZE:
            return event.test(segment.turning(share))
        return event.test(segment.at(share))

    # At a fold the parameter stands still along the arc, so its place need not be as sharp.
    tolerance = segment.flow.tolerance
    goal = max(1e-3 * np.sqrt(tolerance), 1e-10) if event.kind is Kind.FOLD else max(0.1 * tolerance, 1e-13)
    # Changes that lie closer together than SHORTEST are not told apart, nor is their order known.
    share = zero(test, low, high, goal) if high - low > SHORTEST else high
    point = segment.at(share)
    off = event.test(point.turning) if event.kind is Kind.GRAZE else np.nan
    multiplier, proof = evidence(event.kind, off, segment.at(low), point, segment.at(high))
    return Special(event.kind, point, multiplier, proof, share, event.meshes, event.edge)
