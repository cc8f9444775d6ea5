"""Following a branch of periodic motions through folds until it ends.

Pseudo-arclength continuation (Keller 1977): the parameter is an unknown like the state, a step goes along the
tangent of the branch, and Newton's method comes back to the branch across it (points.py).
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.locate import Located, locate, locate_grazes
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint, solve_point
from facegear.dynamics.branches.segment import reversal
from facegear.dynamics.branches.special import Kind, Special
from facegear.dynamics.branches.stepping import next_length, step_along
from facegear.errors import NotConverged

JUNCTION = 1e-6
"""Logarithms of the parameter that differ by less belong to one junction of branches."""
NEAR_JUNCTION = 3.0
"""Fold and branch point of a junction lie within this many steps."""
PASSED = (Kind.GRAZE, Kind.NEUTRAL)
"""Special points at which a motion neither ends nor changes its stability."""


class BranchEnd(StrEnum):
    """Why a branch ends."""

    LIMIT = "limit of the parameter"
    CLOSED = "closed"
    START = "where it was begun"
    DOUBLING = "period doubling of another branch"
    SYMMETRY = "branch point"
    POLE = "amplitude without bound"
    POINTS = "number of points"
    STEP = "step too short"
    SPECIAL = "first special point"


@dataclass(frozen=True)
class ContinuationSettings:
    """How a branch is followed; steps are lengths in weighted states and logarithms.

    Attributes
    ----------
    p_min, p_max
        Range of the parameter.
    first, ds_min, ds_max
        Step lengths.
    max_points
        Maximum number of points in each direction.
    bound
        Largest weighted state.
    to_first
        End at the first special point that is no graze.
    """

    p_min: float
    p_max: float
    first: float = 0.02
    ds_min: float = 1e-7
    ds_max: float = 0.3
    max_points: int = 4000
    bound: float = 1e4
    to_first: bool = False


@dataclass(frozen=True, eq=False)
class Branch:
    """Points in their order along the branch, what was met between them, and why it ends on both sides.

    Attributes
    ----------
    period_map
        The map whose fixed points they are.
    points
        Neighbours a step apart.
    specials
        Sorted by `after`, the index of the point before them plus their fraction of the way to the next.
    ends
        Why it ends before the first and behind the last point.
    tried
        What was tried where steps became too short.
    image_of
        Number of the branch, in the list that holds both, of which this one is the image under a symmetry of
        the system; None of a branch that was followed.
    """

    period_map: PeriodMap
    points: list[BranchPoint]
    specials: list[Special]
    ends: tuple[BranchEnd, BranchEnd]
    tried: str = ""
    image_of: int | None = None

    @property
    def arc(self) -> Array:
        """Arc length of the points, from the first, shape (points,)."""
        steps = [np.linalg.norm(b.x - a.x) for a, b in zip(self.points, self.points[1:], strict=False)]
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def values(self) -> Array:
        """Parameter of the points, shape (points,)."""
        return np.array([point.value for point in self.points])

    def of(self, *chosen: str) -> list[Special]:
        """Special points of some kinds, in their order along the branch."""
        return [special for special in self.specials if special.kind in chosen]


@dataclass(eq=False)
class _Track:
    points: list[BranchPoint]
    specials: list[Special] = field(default_factory=list)
    end: BranchEnd = BranchEnd.POINTS
    tried: str = ""


def follow(
    period_map: PeriodMap,
    start: BranchPoint,
    run: ContinuationSettings,
    both: bool = True,
    progress: Callable[[BranchPoint], None] = lambda point: None,
) -> Branch:
    """The branch through `start`, along its tangent and (with `both`) against it."""
    ahead = _track(period_map, start, run, progress)
    if not both or ahead.end is BranchEnd.CLOSED:
        first = BranchEnd.CLOSED if ahead.end is BranchEnd.CLOSED else BranchEnd.START
        return Branch(period_map, ahead.points, ahead.specials, (first, ahead.end), ahead.tried)
    behind = _track(period_map, turned(start), run, progress)
    count = len(behind.points) - 1
    points = [turned(point) for point in behind.points[:0:-1]] + ahead.points
    specials = [replace(s, after=count - s.after) for s in behind.specials[::-1]]
    specials += [replace(s, after=count + s.after) for s in ahead.specials]
    tried = "; ".join(text for text in (behind.tried, ahead.tried) if text)
    return Branch(period_map, points, specials, (behind.end, ahead.end), tried)


def turned(point: BranchPoint) -> BranchPoint:
    """The same point looking the other way."""
    return replace(point, tangent=-point.tangent, parity=-point.parity)


def _track(
    period_map: PeriodMap,
    start: BranchPoint,
    run: ContinuationSettings,
    progress: Callable[[BranchPoint], None],
) -> _Track:
    track, step, before = _Track([start]), run.first, None
    if any(abs(start.u - np.log(limit)) < JUNCTION for limit in (run.p_min, run.p_max)) and _outward(
        start, run
    ):
        track.end = BranchEnd.LIMIT
        return track
    images = _images(period_map, start)
    while len(track.points) < run.max_points:
        here = track.points[-1]
        try:
            there, end = _next(period_map, here, before, step, run, images if len(track.points) > 2 else [])
            located, last, junction = _between_points(period_map, here, there)
        except (NotConverged, np.linalg.LinAlgError) as error:
            step *= 0.4
            if step < run.ds_min:
                track.end, track.tried = BranchEnd.STEP, f"{error}; steps down to {run.ds_min:g}"
                return track
            continue
        base = len(track.points) - 1
        track.specials += [replace(special, after=base + special.after) for special in located.specials]
        track.points += [*located.inner, *last]
        progress(there)
        if _cut_at_junction(track, base):
            junction = BranchEnd.SYMMETRY
        if junction is not None:
            end = junction
        if end is not None:
            track.end = end
            return track
        if run.to_first and any(special.kind not in PASSED for special in located.specials):
            track.end = BranchEnd.SPECIAL
            return track
        step = min(next_length(step, before, here, there), run.ds_max)
        before = here
    return track


def _outward(start: BranchPoint, run: ContinuationSettings) -> bool:
    """Whether a point at a limit of the parameter looks beyond it."""
    upper = abs(start.u - np.log(run.p_max)) < abs(start.u - np.log(run.p_min))
    return bool(start.tangent[-1] > 0.0) == upper


def _next(
    period_map: PeriodMap,
    here: BranchPoint,
    before: BranchPoint | None,
    step: float,
    run: ContinuationSettings,
    images: list[Array],
) -> tuple[BranchPoint, BranchEnd | None]:
    """The next point, and why the branch ends there if it does. Raises NotConverged if a step is refused."""
    there = step_along(period_map, here, before, step)
    limits = np.log([run.p_min, run.p_max])
    end = None
    if not limits[0] <= there.u <= limits[1]:
        there, end = _onto_limit(period_map, here, there, limits[int(there.u > here.u)]), BranchEnd.LIMIT
    closing = _closing(period_map, images, here, there)
    if closing is not None:
        return closing, BranchEnd.CLOSED
    if np.abs(there.z).max() > run.bound:
        end = BranchEnd.POLE
    return there, end


def _onto_limit(period_map: PeriodMap, here: BranchPoint, there: BranchPoint, limit: float) -> BranchPoint:
    """The point at a limit of the parameter between two points."""
    fraction = (limit - here.u) / (there.u - here.u)
    guess = here.x + fraction * (there.x - here.x)
    guess[-1] = limit
    row = np.zeros(guess.size)
    row[-1] = 1.0
    return solve_point(period_map, guess, row, here.tangent, here.linear)


def _images(period_map: PeriodMap, start: BranchPoint) -> list[Array]:
    return [np.append(z, start.u) for z in period_map.images(start.z, start.u)]


def _closing(
    period_map: PeriodMap, images: list[Array], here: BranchPoint, there: BranchPoint
) -> BranchPoint | None:
    """The point at which the branch comes back to where it began, at any of its mesh periods."""
    chord = there.x - here.x
    length = np.linalg.norm(chord)
    for image in images:
        fraction = (image - here.x) @ chord / length**2
        off = np.linalg.norm(image - here.x - fraction * chord)
        if not 0.0 < fraction <= 1.0 or off > 0.2 * length:
            continue
        try:
            point = solve_point(
                period_map, here.x + fraction * chord, chord / length, here.tangent, here.linear
            )
        except (NotConverged, np.linalg.LinAlgError):
            continue
        row = chord / length
        target = solve_point(period_map, image, row, here.tangent, here.linear)
        if np.linalg.norm(point.x - target.x) < 1e-6 + 1e-3 * off:
            return target
    return None


def _between_points(
    period_map: PeriodMap, here: BranchPoint, there: BranchPoint
) -> tuple[Located, list[BranchPoint], BranchEnd | None]:
    """Special points on the way and the points after them; where the branch runs into its own image, its last
    points and that end.
    """
    meeting = reversal(period_map, here, there)
    if meeting is None:
        return locate(period_map, here, there), [there], None
    located = locate(period_map, here, meeting[0])
    count = len(located.inner) + 1
    specials = [special for special in located.specials if not _at(special, meeting[1])]
    grazes = locate_grazes(period_map, *meeting, meeting[0].linear)
    specials += [replace(special, after=count + special.after) for special in grazes]
    return Located(specials, located.inner), list(meeting), BranchEnd.DOUBLING


def _cut_at_junction(track: _Track, begin: int) -> bool:
    """Whether the track has just met a branch point at which it turns round: it ends there, where the other
    branch goes through, and what follows is its own mirror image. `begin`: number of the point from which the
    last step went; points that were put inside it do not count as steps.
    """
    late = [special for special in track.specials if special.after > begin + 1 - NEAR_JUNCTION]
    for special in late:
        if special.kind is Kind.BRANCH and any(o.kind is Kind.FOLD and _at(o, special.point) for o in late):
            before = [o for o in track.specials if o.after < special.after and not _at(o, special.point)]
            track.specials = before
            track.points = [*track.points[: int(special.after) + 1], special.point]
            return True
    return False


def _at(special: Special, point: BranchPoint) -> bool:
    """Whether a fold or branch point is only how a branch that ends at `point` looks there."""
    return special.kind in (Kind.FOLD, Kind.BRANCH) and abs(special.point.u - point.u) < JUNCTION
