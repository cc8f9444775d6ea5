"""Find which motions exist at a speed: random starts, the fraction of them that ends on each, and what
is new.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.motion.branches.continuation import Branch
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint, at_parameter
from facegear.motion.branches.segment import cubic
from facegear.motion.plan import Motion, Settings
from facegear.motion.steady_state.simulate import steady_state

NEAR = 1e-4
"""A run this close to a stable orbit, in length scales, that comes closer still, ends there."""
SAME_ORBIT = 1e-4
"""States of one orbit differ by less, in length scales."""
ALONG = 0.2
"""Greatest distance from a branch's chord at which Newton's method is tried from it."""
REAL = 1e-9
"""Rounding of the fraction of a chord."""
BLOCK = 8
"""Number of mesh periods after which a run is compared with the known orbits."""
PATIENCE = 40
"""Number of blocks in which a run may come to a known orbit."""
ROUND = 4
"""Number of blocks after which runs that have come to an orbit are taken out."""


@dataclass(frozen=True, eq=False)
class SettledMotion:
    """A motion on which starts have ended.

    Attributes
    ----------
    label, period : str, int
        Class of motion, and its mesh periods.
    z : (2 n,) array
        A weighted state on it, see PeriodMap.
    point : BranchPoint or None
        The orbit if it is periodic.
    count, fraction : int, float
        Number and fraction of the starts that end on it.
    error : float
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
    """Run starts at one value of the parameter and return the motions on which they end.

    Motions that are not periodic are told apart by their class alone.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    value : float
        The parameter, in its unit.
    starts : (S, 2 n) array
        Weighted states, dimensionless.
    settings : Settings
        Settings of the run.
    step : callable
        Called without arguments after each start.

    Returns
    -------
    list of SettledMotion
        Motions, the most frequent first.
    """
    runs = _Runs(period_map, float(np.log(value)), settings)
    paths = [[start] for start in starts]
    while paths:
        runs.go_on(paths)
        unfinished_paths = []
        for path in paths:
            index = runs.nearby_motion(path)
            if index is None:
                unfinished_paths.append(path)
            else:
                runs.add(index)
                step()
        paths = unfinished_paths
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
    """Runs at one value of the parameter, and the motions to which they have come.

    A path holds the weighted states (2 n,) of a run at the ends of blocks of periods, the start first. `u` is
    the parameter's logarithm. `images` are states of stable orbits, each with the number of its motion.
    """

    period_map: PeriodMap
    u: float
    settings: Settings
    motions: list[SettledMotion] = field(default_factory=list)
    images: list[tuple[int, Array]] = field(default_factory=list)

    @property
    def patience(self) -> int:
        """Number of blocks of periods that a run is given to come to a known orbit; 1 while none is
        known.
        """
        return PATIENCE if self.images else 1

    def go_on(self, paths: list[list[Array]]) -> None:
        """Run all paths some blocks further, side by side, and append their states; no path gets longer
        than patience allows.
        """
        blocks = min(ROUND, self.patience + 1 - min(len(path) for path in paths))
        running = [path for path in paths if len(path) + blocks <= self.patience + 1]
        if blocks < 1 or not running:
            return
        states = np.array([path[-1] for path in running])
        for path, ends in zip(running, self.period_map.ends(states, self.u, BLOCK * blocks), strict=True):
            path.extend(ends[BLOCK - 1 :: BLOCK])

    def nearby_motion(self, path: list[Array]) -> int | None:
        """Return the index of the motion whose orbit a path has come within NEAR of, and closer than a
        block before, or None.
        """
        if not self.images:
            return None
        apart = np.array([[np.abs(z - image).max() for _, image in self.images] for z in path[1:]])
        before = np.vstack([np.full(len(self.images), np.inf), apart[:-1]])
        close = np.argwhere((apart < NEAR) & (apart < before))
        return self.images[close[0, 1]][0] if len(close) else None

    def settle(self, z: Array) -> int:
        """Run a weighted state (2 n,) until it settles by itself; return the index of its motion, which
        is added if it is new.
        """
        motion = _run_until_settled(self.period_map, self.u, z, self.settings)
        for number, earlier_motion in enumerate(self.motions):
            if _is_same_motion(self.period_map, self.u, motion, earlier_motion):
                return number
        self.motions.append(motion)
        number = len(self.motions) - 1
        if motion.point is not None and BLOCK % motion.period == 0:
            images = self.period_map.over(motion.period).images(motion.z, self.u)
            self.images += [(number, image) for image in images]
        return number

    def add(self, number: int) -> None:
        """Count one more start that ends on the motion with this number."""
        self.motions[number] = replace(self.motions[number], count=self.motions[number].count + 1)


def _run_until_settled(period_map: PeriodMap, u: float, z: Array, settings: Settings) -> SettledMotion:
    """Run from a weighted state z (2 n,) until it settles; locate the orbit by Newton's method if it is
    periodic.

    The motion's count, fraction and error are 0 still.
    """
    system, frequency = period_map.family.at(float(np.exp(u)))
    response = steady_state(system, frequency, settings, period_map.state(z, u))
    end_state = period_map.to_weighted(response.state, u)
    point = None
    if response.motion is Motion.PERIODIC:
        try:
            point = at_parameter(period_map.over(response.period), end_state, u)
            end_state = point.z
        except NotConverged:
            point = None
    return SettledMotion(response.label, response.period, end_state, point, 0, 0.0, 0.0)


def _is_same_motion(
    period_map: PeriodMap, u: float, motion: SettledMotion, other_motion: SettledMotion
) -> bool:
    """Whether two motions have the same label and, if both have an orbit, orbits that differ by less than
    SAME_ORBIT.
    """
    if motion.label != other_motion.label:
        return False
    if motion.point is None or other_motion.point is None:
        return motion.point is other_motion.point
    loose = motion.point.linear.neutral, other_motion.point.linear.neutral
    return (
        _apart(motion.z, period_map.over(other_motion.period).images(other_motion.z, u), loose) < SAME_ORBIT
    )


def _apart(z: Array, images: Sequence[Array], loose: tuple[Array, Array]) -> float:
    """Return the largest component of the difference of a weighted state (2 n,) from the nearest of
    several images.

    Shifts along neutral directions (2 n, k) do not count; `loose` has those of both orbits, of which the
    more are taken.
    """
    neutral = max(loose, key=lambda shifts: shifts.shape[1])
    apart = np.array(images) - z
    return float(np.abs(apart - apart @ neutral @ neutral.T).max(axis=1).min())


def crossings(branch: Branch, value: float) -> list[BranchPoint]:
    """Return the orbits of a branch at a value of the parameter, one for each passage.

    Parameters
    ----------
    branch : Branch
        Branch to search.
    value : float
        The parameter, in its unit.

    Returns
    -------
    list of BranchPoint
        Orbits in order along the branch.
    """
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
    """Whether an orbit belongs to a branch.

    Parameters
    ----------
    branch : Branch
        Branch to search.
    orbit : BranchPoint
        The orbit.
    period : int
        Its number of mesh periods.

    Returns
    -------
    bool
        Whether its distance() from the branch is less than SAME_ORBIT.
    """
    return distance(branch, orbit, period) < SAME_ORBIT


def distance(branch: Branch, orbit: BranchPoint, period: int) -> float:
    """Distance of an orbit from the nearest one of a branch at the same parameter.

    Where bodies float in either orbit, their position is free and not compared: along a branch such a body
    stays where it is until a mesh pushes it.

    Parameters
    ----------
    branch : Branch
        Branch to search.
    orbit : BranchPoint
        The orbit.
    period : int
        Its number of mesh periods.

    Returns
    -------
    float
        Distance in length scales, dimensionless; infinite if no orbit of the branch is near.
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
        if nearest < SAME_ORBIT:
            break
    return nearest


def _passages(branch: Branch, u: float) -> Iterator[tuple[Array, float, Array]]:
    """Yield a guess for each orbit at which a branch passes a parameter's logarithm `u`.

    Each is a weighted state (2 n,) on the cubic between two points of the branch, the length of the chord
    between them, and the neutral directions (2 n, k) of the first.
    """
    for start_point, end_point in pairwise(branch.points):
        turns = start_point.tangent[-1] * end_point.tangent[-1] < 0.0
        if not turns and not min(start_point.u, end_point.u) <= u <= max(start_point.u, end_point.u):
            continue
        coefficients = cubic(start_point, end_point)
        roots = np.polynomial.Polynomial(coefficients[:, -1] - [u, 0.0, 0.0, 0.0]).roots()
        reach = float(np.linalg.norm(end_point.x - start_point.x))
        for fraction in roots[np.abs(roots.imag) < REAL].real:
            # A point at which two cubics meet belongs to the first of them.
            if REAL < fraction <= 1.0 + REAL or (abs(fraction) <= REAL and start_point is branch.points[0]):
                yield (fraction ** np.arange(4) @ coefficients)[:-1], reach, start_point.linear.neutral
