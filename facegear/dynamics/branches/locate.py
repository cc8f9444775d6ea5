"""Special points between two neighbouring points of a branch, each bracketed along the arc."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import Point, solve_point
from facegear.errors import NotConverged

Array = NDArray[np.float64]
LEVEL = 1e-7
"""A component of the tangent below this is zero: a motion that keeps contact may double at one speed."""
SHORTEST = 1e-10
"""Part of a step down to which points that lie together are told apart."""
EXACT = 1e-13


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


Test = Callable[[Point], float]


@dataclass(frozen=True, eq=False)
class _Event:
    kind: Kind
    test: Test
    mesh: int = -1
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
            near = self.known[min(self.known, key=lambda other: abs(other - share))]
            row = self.chord / self.length
            self.known[share] = solve_point(self.flow, self._guess(share), row, row, near.linear)
        return self.known[share]

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
    return sorted(_together(_between(segment, 0.0, 1.0)), key=lambda special: special.after)


def _between(segment: _Segment, low: float, high: float) -> list[Special]:
    first, second = segment.at(low), segment.at(high)
    if first.linear.afloat.shape != second.linear.afloat.shape:
        return _loosening(segment, low, high)
    events, mixed = _events(segment.flow, first, second)
    if mixed and high - low > SHORTEST:
        middle = 0.5 * (low + high)
        segment.at(middle)
        return _between(segment, low, middle) + _between(segment, middle, high)
    return [_refined(segment, low, high, event) for event in events]


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
    none.
    """
    events, mixed = [], False
    lower, upper = flow.edges(first.u)
    for mesh, (one, two) in enumerate(zip(first.turning, second.turning, strict=True)):
        for edge, level in ((-1, lower[mesh]), (1, upper[mesh])):
            counts = [[np.count_nonzero(values > level) for values in side] for side in (one, two)]
            changes = np.subtract(counts[1], counts[0])
            if not np.isfinite(level) or changes[0] == changes[1]:
                continue
            kind = int(changes[0] == 0)
            mixed = mixed or bool(changes.all()) or abs(changes[kind]) > 1
            rank = min(counts[0][kind], counts[1][kind])
            events.append(_Event(Kind.GRAZE, _distance(flow, mesh, edge, kind, rank), mesh, edge))
    return events, mixed


def _distance(flow: PeriodMap, mesh: int, edge: int, kind: int, rank: int) -> Test:
    """How far the extreme of a rank, counted from the largest, lies above an edge."""

    def test(point: Point) -> float:
        level = flow.edges(point.u)[0 if edge < 0 else 1][mesh]
        values = np.sort(point.turning[mesh][kind])[::-1]
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
    share = _root(lambda t: event.test(segment.at(t)), low, high)
    point = segment.at(share)
    multiplier, proof = _evidence(event, segment.at(low), point, segment.at(high))
    meshes = () if event.mesh < 0 else (event.mesh,)
    return Special(event.kind, point, multiplier, proof, share, meshes, event.edge)


def _root(test: Test | Callable[[float], float], low: float, high: float, goal: float = 1e-13) -> float:
    """Bracketed root, by interpolation that falls back to halving; the last point evaluated is returned."""
    at_low, at_high = test(low), test(high)
    if at_low == 0.0 or at_high == 0.0:
        return low if at_low == 0.0 else high
    share, side, best = low, 0, np.inf
    for count in range(80):
        if high - low <= EXACT:
            break
        share = high - at_high * (high - low) / (at_high - at_low)
        if count % 4 == 3 or not low < share < high:
            share = 0.5 * (low + high)
        if not low < share < high:
            break
        value = test(share)
        if abs(value) < goal:
            return share
        best = min(best, abs(value))
        if (value > 0.0) == (at_high > 0.0):
            high, at_high = share, value
            at_low = 0.5 * at_low if side == 1 else at_low
            side = 1
        else:
            low, at_low = share, value
            at_high = 0.5 * at_high if side == -1 else at_high
            side = -1
    return share


def _evidence(event: _Event, before: Point, here: Point, after: Point) -> tuple[complex, str]:
    """The critical multiplier and what proves the point."""
    if event.kind is Kind.GRAZE:
        return complex(np.nan), f"an extreme lies {abs(event.test(here)):.1e} length scales from the edge"
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


def _together(specials: list[Special]) -> list[Special]:
    """Grazes of several meshes at one place, as symmetry makes them, are one."""
    kept: list[Special] = []
    for special in specials:
        same = [
            i
            for i, other in enumerate(kept)
            if special.kind is other.kind is Kind.GRAZE and abs(other.after - special.after) < 1e-6
        ]
        if not same:
            kept.append(special)
            continue
        other = kept[same[0]]
        meshes = tuple(sorted({*other.meshes, *special.meshes}))
        kept[same[0]] = Special(other.kind, other.point, other.multiplier, other.proof, other.after, meshes,
                                other.edge)
    return kept


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
        return float(half.gap(point.z, point.u) @ shift) / size**2

    share = _root(left, 0.0, 1.0, 1e-5)
    return segment.at(0.95 * share), segment.at(share)
