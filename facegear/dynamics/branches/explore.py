"""Which motions exist at a speed: random starts, the fraction of them that ends on each, and what is new."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.continuation import Branch
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint, at_parameter
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
"""Rounding of the fraction of a chord."""
BLOCK = 8
"""Mesh periods after which a run is held against the known orbits."""
PATIENCE = 40
"""Blocks for which it may come to one of them."""
ROUND = 4
"""Blocks after which runs that have come to one make room."""


@dataclass(frozen=True, eq=False)
class SettledMotion:
    """A motion that starts ended on.

    Attributes
    ----------
    label, period
        Class of motion, and its mesh periods.
    z : (2 n,)
        A weighted state of it.
    point
        The orbit if it is periodic.
    count, fraction
        Of the starts.
    error
        Standard error sqrt(p (1 - p) / N) of the fraction.
    """

    label: str
    period: int
    z: Array
    point: BranchPoint | None
    count: int
    fraction: float
    error: float


def explore(
    period_map: PeriodMap,
    value: float,
    starts: Array,
    settings: Settings,
    step: Callable[[], None] = lambda: None,
) -> list[SettledMotion]:
    """The motions at a parameter on which starts (S, 2 n), weighted states, end; the most frequent first.

    Motions that are not periodic count by their class.
    """
    runs = _Runs(period_map, float(np.log(value)), settings)
    paths = [[start] for start in starts]
    while paths:
        runs.go_on(paths)
        waiting = []
        for path in paths:
            index = runs.reached(path)
            if index is None:
                waiting.append(path)
            else:
                runs.add(index)
                step()
        paths = waiting
        if paths and len(paths[0]) > runs.patience:
            runs.add(runs.settle(paths.pop(0)[-1]))
            step()
    motions = runs.motions
    motions.sort(key=lambda motion: -motion.count)
    fractions = [motion.count / len(starts) for motion in motions]
    return [
        replace(motion, fraction=p, error=float(np.sqrt(p * (1.0 - p) / len(starts))))
        for motion, p in zip(motions, fractions, strict=True)
    ]


@dataclass(eq=False)
class _Runs:
    """Runs at one parameter's logarithm u, and the motions that they have come to.

    A path holds the weighted states (2 n,) of a run at the ends of blocks of periods, the start first.
    images: states of stable orbits, each with the number of its motion.
    """

    period_map: PeriodMap
    u: float
    settings: Settings
    motions: list[SettledMotion] = field(default_factory=list)
    images: list[tuple[int, Array]] = field(default_factory=list)

    @property
    def patience(self) -> int:
        """Blocks for which a run may come to a known orbit."""
        return PATIENCE if self.images else 1

    def go_on(self, paths: list[list[Array]]) -> None:
        """Run all paths, side by side, some blocks further, but no longer than patience allows."""
        blocks = min(ROUND, self.patience + 1 - min(len(path) for path in paths))
        running = [path for path in paths if len(path) + blocks <= self.patience + 1]
        if blocks < 1 or not running:
            return
        states = np.array([path[-1] for path in running])
        for path, ends in zip(running, self.period_map.ends(states, self.u, BLOCK * blocks), strict=True):
            path.extend(ends[BLOCK - 1 :: BLOCK])

    def reached(self, path: list[Array]) -> int | None:
        """The motion whose orbit a path comes near to, and nearer still."""
        if not self.images:
            return None
        apart = np.array([[np.abs(z - image).max() for _, image in self.images] for z in path[1:]])
        before = np.vstack([np.full(len(self.images), np.inf), apart[:-1]])
        close = np.argwhere((apart < NEAR) & (apart < before))
        return self.images[close[0, 1]][0] if len(close) else None

    def settle(self, z: Array) -> int:
        """The motion that a run comes to by itself."""
        motion = _settled(self.period_map, self.u, z, self.settings)
        for number, other in enumerate(self.motions):
            if _same(self.period_map, self.u, motion, other):
                return number
        self.motions.append(motion)
        number = len(self.motions) - 1
        if motion.point is not None and BLOCK % motion.period == 0:
            images = self.period_map.over(motion.period).images(motion.z, self.u)
            self.images += [(number, image) for image in images]
        return number

    def add(self, number: int) -> None:
        """Count one more start that ends on a motion."""
        self.motions[number] = replace(self.motions[number], count=self.motions[number].count + 1)


def _settled(period_map: PeriodMap, u: float, z: Array, settings: Settings) -> SettledMotion:
    system, frequency = period_map.family.at(float(np.exp(u)))
    response = steady_state(system, frequency, settings, period_map.state(z, u))
    there = period_map.weighted(response.state, u)
    point = None
    if response.motion is Motion.PERIODIC:
        try:
            point = at_parameter(period_map.over(response.period), there, u)
            there = point.z
        except NotConverged:
            point = None
    return SettledMotion(response.label, response.period, there, point, 0, 0.0, 0.0)


def _same(period_map: PeriodMap, u: float, motion: SettledMotion, other: SettledMotion) -> bool:
    if motion.label != other.label:
        return False
    if motion.point is None or other.point is None:
        return motion.point is other.point
    loose = motion.point.linear.neutral, other.point.linear.neutral
    return _apart(motion.z, period_map.over(other.period).images(other.z, u), loose) < SAME


def _apart(z: Array, images: Sequence[Array], loose: tuple[Array, Array]) -> float:
    """Largest difference of a state from the nearest image of another but for shifts along neutral
    directions, in the orbit with more of them.
    """
    neutral = max(loose, key=lambda shifts: shifts.shape[1])
    apart = np.array(images) - z
    return float(np.abs(apart - apart @ neutral @ neutral.T).max(axis=1).min())


def crossings(branch: Branch, value: float) -> list[BranchPoint]:
    """The branch's orbits at a parameter, one for each passage."""
    u, points = float(np.log(value)), []
    for guess, reach, _ in _passages(branch, u):
        try:
            point = at_parameter(branch.period_map, guess, u)
        except (NotConverged, np.linalg.LinAlgError):
            continue
        if np.linalg.norm(point.z - guess) < 0.5 * reach:
            points.append(point)
    return points


def lies_on(branch: Branch, orbit: BranchPoint, period: int) -> bool:
    """Whether an orbit of a period belongs to a branch."""
    return distance(branch, orbit, period) < SAME


def distance(branch: Branch, orbit: BranchPoint, period: int) -> float:
    """How far, in length scales, an orbit of a period lies from the nearest one of a branch at the same
    parameter; infinite if none is near. Where bodies float in either orbit, their place is free and not
    compared: along a branch such a body is left where it is until a mesh pushes it.
    """
    values, u = branch.values, orbit.u
    if branch.period_map.period != period or not values.min() <= orbit.value <= values.max():
        return np.inf
    images, loose = branch.period_map.images(orbit.z, u), orbit.linear.neutral
    nearest = np.inf
    for guess, reach, neutral in _passages(branch, u):
        if _apart(guess, images, (loose, neutral)) > ALONG * max(1.0, reach):
            continue
        try:
            point = at_parameter(branch.period_map, guess, u)
        except (NotConverged, np.linalg.LinAlgError):
            continue
        nearest = min(nearest, _apart(point.z, images, (loose, point.linear.neutral)))
        if nearest < SAME:
            break
    return nearest


def _passages(branch: Branch, u: float) -> Iterator[tuple[Array, float, Array]]:
    """States at which a branch passes a parameter's logarithm, on the cubics between its points, with the
    lengths of their chords and shifts along neutral directions.
    """
    for here, there in pairwise(branch.points):
        turns = here.tangent[-1] * there.tangent[-1] < 0.0
        if not turns and not min(here.u, there.u) <= u <= max(here.u, there.u):
            continue
        coefficients = cubic(here, there)
        roots = np.polynomial.Polynomial(coefficients[:, -1] - [u, 0.0, 0.0, 0.0]).roots()
        reach = float(np.linalg.norm(there.x - here.x))
        for fraction in roots[np.abs(roots.imag) < REAL].real:
            # A point at which two cubics meet belongs to the first of them.
            if REAL < fraction <= 1.0 + REAL or (abs(fraction) <= REAL and here is branch.points[0]):
                yield (fraction ** np.arange(4) @ coefficients)[:-1], reach, here.linear.neutral
