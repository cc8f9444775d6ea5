"""Grazes between two neighbouring points of a branch: extremes of mesh deflections that pass an edge."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import Point
from facegear.dynamics.branches.segment import Segment

EDGES = (-1, 1)
LOOKED_AT = np.linspace(0.0, 1.0, 33)[1:-1]
"""Shares of a stretch at which a cubic is looked at."""
ALMOST = 0.1
"""Part of the lesser distance at the ends to which a cubic that comes as near is looked at."""


@dataclass(frozen=True, eq=False)
class Graze:
    """test: how far an extreme of `meshes`, which symmetry moves alike, lies above an edge (-1 or +1)."""

    test: Callable[[Array], float]
    meshes: tuple[int, ...]
    edge: int


def grazes(flow: PeriodMap, first: Point, second: Point) -> tuple[list[Graze], bool]:
    """Extremes that have passed an edge; True if some cannot be told apart yet.

    Maxima less minima above an edge count its passages. A maximum and a minimum that are born together change
    none. Meshes that symmetry moves alike make one graze.
    """
    found: dict[tuple, Graze] = {}
    mixed = False
    levels = _levels(flow, first.u)
    one, two = (_above(point.turning, levels) for point in (first, second))
    for side, mesh in np.argwhere(np.isfinite(levels) & (np.diff(two - one)[..., 0] != 0)):
        changes = (two - one)[side, mesh]
        kind = int(changes[0] == 0)
        mixed = mixed or bool(changes.all()) or abs(changes[kind]) > 1
        rank = int(min(one[side, mesh, kind], two[side, mesh, kind]))
        test = _distance(float(levels[side, mesh]), int(mesh), kind, rank)
        alike = (side, kind, *(round(test(point.turning), 7) for point in (first, second)))
        meshes = (*found[alike].meshes, int(mesh)) if alike in found else (int(mesh),)
        found[alike] = Graze(test, meshes, EDGES[side])
    return list(found.values()), mixed


def _levels(flow: PeriodMap, u: float) -> Array:
    """Edges of all meshes, shape (2, m); NaN where a mesh never opens."""
    levels = np.array(flow.edges(u))
    return np.where(np.isfinite(levels), levels, np.nan)


def _above(turning: Array, levels: Array) -> Integers:
    """How many maxima and minima lie above each edge, shape (2, m, 2)."""
    return (turning > levels[:, :, None, None]).sum(axis=-1)


def _distance(level: float, mesh: int, kind: int, rank: int) -> Callable[[Array], float]:
    """How far the extreme of a rank, counted from the largest, lies above a level."""

    def test(turning: Array) -> float:
        value = turning[mesh, kind, rank] if rank < turning.shape[2] else -np.inf
        return float(value - level) if np.isfinite(value) else -1.0

    return test


def hidden_graze(segment: Segment, low: float, high: float) -> float | None:
    """Share of a stretch at which an extreme lies beyond an edge that it is short of at both ends.

    Looked for where cubics through the extremes with their slopes along the branch come close to an edge.
    """
    points = segment.at(low), segment.at(high)
    reach = float(np.linalg.norm(points[1].x - points[0].x))
    levels = _levels(segment.flow, points[0].u)
    most = min(point.turning.shape[2] for point in points)
    turning = [point.turning[:, :, :most] for point in points]
    near = [_near(turning[0], turning[1], level, reach) for level in levels]
    if not any(one.any() for one in near):
        return None
    slopes = [segment.turning_slope(share, high - low)[:, :, :most] for share in (low, high)]
    passed = _passages(points[0].turning, levels)
    for look in dict.fromkeys(_dips(turning, slopes, levels, near)):
        share = low + look * (high - low)
        if (_passages(segment.turning(share), levels) != passed).any():
            return share
    return None


def _passages(turning: Array, levels: Array) -> Integers:
    """Pairs of passages of each finite edge, shape (2, m)."""
    return np.where(np.isfinite(levels), np.diff(_above(turning, levels))[..., 0], 0)


def _near(first: Array, second: Array, level: Array, reach: float) -> Mask:
    """Extremes on one side of an edge at both ends, at one of them no farther from it than `reach`."""
    one, two = first - level[:, None, None], second - level[:, None, None]
    return np.isfinite(one) & np.isfinite(two) & (one * two > 0.0) & (np.minimum(abs(one), abs(two)) < reach)


def _dips(turning: list[Array], slopes: list[Array], levels: Array, near: list[Mask]) -> Iterator[float]:
    """Where cubics through the extremes come closest to an edge or beyond it."""
    t = LOOKED_AT
    for level, few in zip(levels, near, strict=True):
        where = np.nonzero(few)
        one, two = (values[where] - level[where[0]] for values in turning)
        sign = np.sign(one)
        first, last = (slope[where] for slope in slopes)
        bend = np.array([one, first, 3 * (two - one) - 2 * first - last, first + last - 2 * (two - one)])
        heights = sign[:, None] * (bend.T @ t ** np.arange(4)[:, None])
        least = heights.min(axis=1, initial=np.inf)
        for row in np.flatnonzero(least < ALMOST * np.minimum(abs(one), abs(two))):
            yield float(t[heights[row].argmin()])
