"""Which motions exist at a speed: random starts, the share of them that ends on each, and what is new."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.continuation import Branch
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import Point, at_parameter
from facegear.dynamics.branches.segment import cubic
from facegear.dynamics.motion import Motion, Settings
from facegear.dynamics.steady_state.simulate import steady_state
from facegear.errors import NotConverged

NEAR = 1e-4
"""A run this close to a stable orbit, in length scales, that comes closer still, ends there."""
SAME = 1e-4
"""States of one orbit differ by less, in length scales."""
ALONG = 0.2
"""Greatest distance from a branch's chord at which Newton's method is tried from it."""
REAL = 1e-9
"""Rounding of the share of a chord."""
BLOCK = 8
PATIENCE = 40


@dataclass(frozen=True, eq=False)
class Found:
    """A motion that starts ended on. z (2 n,): a weighted state of it; point: the orbit if it is periodic.

    count of the starts, share and its standard error sqrt(p (1 - p) / N).
    """

    label: str
    period: int
    z: Array
    point: Point | None
    count: int
    share: float
    error: float


def explore(
    flow: PeriodMap,
    value: float,
    starts: Array,
    settings: Settings,
    step: Callable[[], None] = lambda: None,
) -> list[Found]:
    """The motions at a parameter on which starts (S, 2 n), weighted states, end; the most frequent first.

    Motions that are not periodic count by their class.
    """
    u = float(np.log(value))
    found: list[Found] = []
    for start in starts:
        z, index = _run(flow, u, start, found)
        if index is None:
            one = _settled(flow, u, z, settings)
            index = next((i for i, other in enumerate(found) if _same(flow, u, one, other)), len(found))
            if index == len(found):
                found.append(one)
        found[index] = replace(found[index], count=found[index].count + 1)
        step()
    found.sort(key=lambda one: -one.count)
    shares = [one.count / len(starts) for one in found]
    return [
        replace(one, share=p, error=float(np.sqrt(p * (1.0 - p) / len(starts))))
        for one, p in zip(found, shares, strict=True)
    ]


def box(flow: PeriodMap, value: float, centre: Array, half: Array, count: int, seed: int) -> Array:
    """Weighted states (count, 2 n) spread evenly over centre +- half, each (2 n,)."""
    size = flow.integrator(float(np.log(value))).size
    random = np.random.default_rng(seed)
    return centre + half * random.uniform(-1.0, 1.0, size=(count, 2 * size))


def _run(flow: PeriodMap, u: float, z: Array, found: list[Found]) -> tuple[Array, int | None]:
    """Run until a known stable orbit is reached, or patience ends."""
    block = flow.over(BLOCK)
    known = [
        (i, image)
        for i, one in enumerate(found)
        if one.point is not None and BLOCK % one.period == 0
        for image in flow.over(one.period).images(one.z, u)
    ]
    before = np.full(len(known), np.inf)
    for _ in range(PATIENCE if known else 1):
        z = z + block.gap(z, u)
        distance = np.array([np.abs(z - image).max() for _, image in known])
        close = np.flatnonzero((distance < NEAR) & (distance < before))
        if close.size:
            return z, known[close[0]][0]
        before = distance
    return z, None


def _settled(flow: PeriodMap, u: float, z: Array, settings: Settings) -> Found:
    system, frequency = flow.family.at(float(np.exp(u)))
    response = steady_state(system, frequency, settings, flow.state(z, u))
    there = flow.weighted(response.state, u)
    point = None
    if response.motion is Motion.PERIODIC:
        try:
            point = at_parameter(flow.over(response.period), there, u)
            there = point.z
        except NotConverged:
            point = None
    return Found(response.label, response.period, there, point, 0, 0.0, 0.0)


def _same(flow: PeriodMap, u: float, one: Found, other: Found) -> bool:
    if one.label != other.label:
        return False
    if one.point is None or other.point is None:
        return one.point is other.point
    loose = one.point.linear.afloat, other.point.linear.afloat
    return _apart(one.z, flow.over(other.period).images(other.z, u), loose) < SAME


def _apart(z: Array, images: Sequence[Array], loose: tuple[Array, Array]) -> float:
    """Largest difference of a state from the nearest image of another but for shifts of bodies afloat, of
    the orbit with more of them.
    """
    afloat = max(loose, key=lambda shifts: shifts.shape[1])
    apart = np.array(images) - z
    return float(np.abs(apart - apart @ afloat @ afloat.T).max(axis=1).min())


def crossings(branch: Branch, value: float) -> list[Point]:
    """The branch's orbits at a parameter, one for each passage."""
    u, found = float(np.log(value)), []
    for guess, reach, _ in _passages(branch, u):
        try:
            point = at_parameter(branch.flow, guess, u)
        except (NotConverged, np.linalg.LinAlgError):
            continue
        if np.linalg.norm(point.z - guess) < 0.5 * reach:
            found.append(point)
    return found


def lies_on(branch: Branch, orbit: Point, period: int) -> bool:
    """Whether an orbit of a period belongs to a branch."""
    return distance(branch, orbit, period) < SAME


def distance(branch: Branch, orbit: Point, period: int) -> float:
    """How far, in length scales, an orbit of a period lies from the nearest one of a branch at the same
    parameter; infinite if none is near. Where bodies float in either orbit, their place is free and not
    compared: along a branch such a body is left where it is until a mesh pushes it.
    """
    values, u = branch.values, orbit.u
    if branch.flow.period != period or not values.min() <= orbit.value <= values.max():
        return np.inf
    images, loose = branch.flow.images(orbit.z, u), orbit.linear.afloat
    nearest = np.inf
    for guess, reach, afloat in _passages(branch, u):
        if _apart(guess, images, (loose, afloat)) > ALONG * max(1.0, reach):
            continue
        try:
            point = at_parameter(branch.flow, guess, u)
        except (NotConverged, np.linalg.LinAlgError):
            continue
        nearest = min(nearest, _apart(point.z, images, (loose, point.linear.afloat)))
        if nearest < SAME:
            break
    return nearest


def _passages(branch: Branch, u: float) -> Iterator[tuple[Array, float, Array]]:
    """States at which a branch passes a parameter's logarithm, on the cubics between its points, with the
    lengths of their chords and the shifts of bodies afloat.
    """
    for here, there in pairwise(branch.points):
        turns = here.tangent[-1] * there.tangent[-1] < 0.0
        if not turns and not min(here.u, there.u) <= u <= max(here.u, there.u):
            continue
        coefficients = cubic(here, there)
        shares = np.polynomial.Polynomial(coefficients[:, -1] - [u, 0.0, 0.0, 0.0]).roots()
        reach = float(np.linalg.norm(there.x - here.x))
        for share in shares[np.abs(shares.imag) < REAL].real:
            # A point at which two cubics meet belongs to the first of them.
            if REAL < share <= 1.0 + REAL or (abs(share) <= REAL and here is branch.points[0]):
                yield (share ** np.arange(4) @ coefficients)[:-1], reach, here.linear.afloat
