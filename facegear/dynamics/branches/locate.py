"""Special points between two neighbouring points of a branch, each bracketed along the arc."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import Point, correct_state, solve_point

Array = NDArray[np.float64]
LEVEL = 1e-7
"""A component of the tangent below this is zero: a motion that keeps contact may double at one speed."""
SHORTEST = 1e-10
"""Part of a step down to which points that lie together are told apart."""
EXACT = 1e-13
LOOKS = 2
"""How often a stretch is halved on the mere chance that a multiplier crosses the unit circle twice in it."""
CLOSE = 0.02
"""A multiplier this close to the unit circle at an end of a stretch may cross it inside."""


class Kind(StrEnum):
    """What happens at a special point."""

    FOLD = "fold"
    DOUBLING = "period doubling"
    TORUS = "Neimark-Sacker"
    BRANCH = "branch point"
    GRAZE = "graze"
    AFLOAT = "body afloat"


@dataclass(frozen=True, eq=False)
class Special:
    """A special point. after: place along the branch. multiplier: the critical one (NaN at a graze).

    proof: what shows that it is one. meshes, edge: those that graze (+1 upper edge, -1 lower).
    """

    kind: Kind
    point: Point
    multiplier: complex
    proof: str
    after: float
    meshes: tuple[int, ...] = ()
    edge: int = 0


@dataclass(frozen=True, eq=False)
class _Event:
    """test: of a Point, at a graze of its turning points."""

    kind: Kind
    test: Callable[..., float]
    meshes: tuple[int, ...] = ()
    edge: int = 0


class _Segment:
    """Points between two neighbours, by their share of the chord."""

    def __init__(self, flow: PeriodMap, here: Point, there: Point) -> None:
        self.flow, self.here, self.there = flow, here, there
        self.chord = there.x - here.x
        self.length = float(np.linalg.norm(self.chord))
        self.known = {0.0: here, 1.0: there}

    def at(self, share: float) -> Point:
        """The point of the branch at a share of the chord."""
        if share not in self.known:
            row = self.chord / self.length
            linear = self._near(share).linear
            self.known[share] = solve_point(self.flow, self._guess(share), row, row, linear)
        return self.known[share]

    def turning(self, share: float) -> list[tuple[Array, Array]]:
        """Turning points of the deflections at a share, without the matrix of the map."""
        if share in self.known:
            return self.known[share].turning
        row = self.chord / self.length
        x = correct_state(self.flow, self._guess(share), row, self._near(share).linear)
        return self.flow.turning(x[:-1], x[-1])

    def _near(self, share: float) -> Point:
        return self.known[min(self.known, key=lambda other: abs(other - share))]

    def _guess(self, share: float) -> Array:
        """Cubic between the nearest known points, with their tangents."""
        low = max(other for other in self.known if other < share)
        high = min(other for other in self.known if other > share)
        a, b = self.known[low], self.known[high]
        width = (high - low) * self.length
        row = self.chord / self.length
        t = (share - low) / (high - low)
        first, second = (width * p.tangent / (row @ p.tangent) for p in (a, b))
        return (
            (1 + 2 * t) * (1 - t) ** 2 * a.x
            + t * (1 - t) ** 2 * first
            + t**2 * (3 - 2 * t) * b.x
            - t**2 * (1 - t) * second
        )


def locate(flow: PeriodMap, here: Point, there: Point) -> list[Special]:
    """All special points between two neighbours, in order; `after` is the share of the way."""
    segment = _Segment(flow, here, there)
    return sorted(_between(segment, 0.0, 1.0), key=lambda special: special.after)


def _between(segment: _Segment, low: float, high: float, depth: int = 0) -> list[Special]:
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


def _loosening(segment: _Segment, low: float, high: float) -> list[Special]:
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


def _refined(segment: _Segment, low: float, high: float, event: _Event) -> Special:
    def test(share: float) -> float:
        if event.kind is Kind.GRAZE:
            return event.test(segment.turning(share))
        return event.test(segment.at(share))

    # At a fold the parameter stands still along the arc, so its place need not be as sharp.
    tolerance = segment.flow.tolerance
    goal = max(1e-3 * np.sqrt(tolerance), 1e-10) if event.kind is Kind.FOLD else max(0.1 * tolerance, 1e-13)
    share = bracketed_root(test, low, high, goal)
    point = segment.at(share)
    multiplier, proof = _evidence(event, segment.at(low), point, segment.at(high))
    return Special(event.kind, point, multiplier, proof, share, event.meshes, event.edge)


def bracketed_root(test: Callable[[float], float], low: float, high: float, goal: float) -> float:
    """Bracketed root to `goal` in the test (Chandrupatla 1997); the last place evaluated is returned."""
    a, b = low, high
    at_a, at_b = test(a), test(b)
    if min(abs(at_a), abs(at_b)) <= goal:
        return a if abs(at_a) < abs(at_b) else b
    share = at_a / (at_a - at_b)
    place = a
    for _ in range(100):
        place = a + min(max(share, 1e-3), 1.0 - 1e-3) * (b - a)
        value = test(place)
        if abs(value) <= goal or abs(b - a) <= EXACT:
            break
        if (value > 0.0) == (at_a > 0.0):
            c, at_c = a, at_a
        else:
            c, at_c, b, at_b = b, at_b, a, at_a
        a, at_a = place, value
        along, across = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
        share = 0.5
        if across**2 < along and (1.0 - across) ** 2 < 1.0 - along:
            share = at_a / (at_b - at_a) * at_c / (at_b - at_c) + (c - a) / (b - a) * at_a / (
                at_c - at_a
            ) * at_b / (at_c - at_b)
    return place


def _evidence(event: _Event, before: Point, here: Point, after: Point) -> tuple[complex, str]:
    """The critical multiplier and what proves the point."""
    if event.kind is Kind.GRAZE:
        return complex(
            np.nan
        ), f"an extreme lies {abs(event.test(here.turning)):.1e} length scales from the edge"
    if event.kind is Kind.FOLD:
        mu = _nearest(here.multipliers, 1.0)
        return mu, (
            f"the speed component of the tangent goes from {before.tangent[-1]:+.1e} to "
            f"{after.tangent[-1]:+.1e}; multiplier {mu.real:.9f}"
        )
    if event.kind is Kind.DOUBLING:
        mu = _nearest(here.multipliers, -1.0)
        return mu, f"a real multiplier is {mu.real:.9f}, goes through -1"
    if event.kind is Kind.BRANCH:
        mu = _nearest(here.multipliers, 1.0)
        flipped = "changes" if before.parity != after.parity else "keeps"
        return mu, f"multiplier {mu.real:.9f} at a tangent with {here.tangent[-1]:+.1e}; parity {flipped}"
    pair = here.pairs[np.argmin(np.abs(np.abs(here.pairs) - 1.0))] if here.pairs.size else complex(np.nan)
    return complex(pair), f"modulus {abs(pair):.9f}, angle {np.degrees(np.angle(pair)):.6f} deg"


def _nearest(values: NDArray[np.complex128], goal: float) -> complex:
    return complex(values[np.argmin(np.abs(values - goal))])


def reversal(flow: PeriodMap, here: Point, there: Point) -> tuple[Point, Point] | None:
    """Where a branch of several periods runs into its own image, shifted by half of them: the point shortly
    before, and the orbit of half the period at which another branch doubles.
    """
    if flow.period % 2:
        return None
    half = flow.over(flow.period // 2)
    shift = half.gap(here.z, here.u)
    size = np.linalg.norm(shift)
    if shift @ half.gap(there.z, there.u) > -0.5 * size * np.linalg.norm(half.gap(there.z, there.u)):
        return None
    segment = _Segment(flow, here, there)

    def left(share: float) -> float:
        point = segment.at(share)
        return float((half.gap(point.z, point.u) @ shift) / size**2)

    share = bracketed_root(left, 0.0, 1.0, 1e-5)
    return segment.at(0.95 * share), segment.at(share)
