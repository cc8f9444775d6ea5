"""Following a branch of periodic motions through folds until it ends."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.locate import locate
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import Point, at_parameter, solve_point
from facegear.dynamics.branches.segment import reversal
from facegear.dynamics.branches.special import Kind, Special
from facegear.dynamics.branches.stepping import next_length, step_along
from facegear.errors import NotConverged

JUNCTION = 1e-6
"""Logarithms of the parameter that differ by less belong to one junction of branches."""
NEAR_JUNCTION = 3.0
"""Fold and branch point of a junction lie within this many steps."""
PASSED = (Kind.GRAZE, Kind.AFLOAT)
"""Special points at which a motion neither ends nor changes its stability."""


class End(StrEnum):
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
class Run:
    """How a branch is followed: range of the parameter, steps in weighted states and logarithms.

    first, least, largest: step lengths. points: most points in each direction. bound: largest weighted state.
    to_first: end at the first special point that is no graze.
    """

    low: float
    high: float
    first: float = 0.02
    least: float = 1e-7
    largest: float = 0.3
    points: int = 4000
    bound: float = 1e4
    to_first: bool = False


@dataclass(frozen=True, eq=False)
class Branch:
    """Points in their order along the branch, what was met between them, and why it ends on both sides.

    specials are sorted by `after`, the index of the point before them plus their share of the way to the
    next.
    """

    flow: PeriodMap
    points: list[Point]
    specials: list[Special]
    ends: tuple[End, End]
    tried: str = ""

    @property
    def arc(self) -> Array:
        """Arc length of the points, from the first, shape (points,)."""
        steps = [np.linalg.norm(b.x - a.x) for a, b in zip(self.points, self.points[1:], strict=False)]
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def values(self) -> Array:
        """Parameter of the points, shape (points,)."""
        return np.array([point.value for point in self.points])

    def of(self, *kinds: str) -> list[Special]:
        """Special points of some kinds, in their order along the branch."""
        return [special for special in self.specials if special.kind in kinds]


@dataclass(eq=False)
class _Track:
    points: list[Point]
    specials: list[Special] = field(default_factory=list)
    end: End = End.POINTS
    tried: str = ""


def follow(
    flow: PeriodMap,
    start: Point,
    run: Run,
    both: bool = True,
    progress: Callable[[Point], None] = lambda point: None,
) -> Branch:
    """The branch through `start`, along its tangent and (with `both`) against it."""
    ahead = _track(flow, start, run, progress)
    if not both or ahead.end is End.CLOSED:
        first = End.CLOSED if ahead.end is End.CLOSED else End.START
        return Branch(flow, ahead.points, ahead.specials, (first, ahead.end), ahead.tried)
    behind = _track(flow, turned(start), run, progress)
    count = len(behind.points) - 1
    points = [turned(point) for point in behind.points[:0:-1]] + ahead.points
    specials = [replace(s, after=count - s.after) for s in behind.specials[::-1]]
    specials += [replace(s, after=count + s.after) for s in ahead.specials]
    tried = "; ".join(text for text in (behind.tried, ahead.tried) if text)
    return Branch(flow, points, specials, (behind.end, ahead.end), tried)


def turned(point: Point) -> Point:
    """The same point looking the other way."""
    return replace(point, tangent=-point.tangent, parity=-point.parity)


def _track(flow: PeriodMap, start: Point, run: Run, progress: Callable[[Point], None]) -> _Track:
    track, step, before = _Track([start]), run.first, None
    if any(abs(start.u - np.log(limit)) < JUNCTION for limit in (run.low, run.high)) and _outward(start, run):
        track.end = End.LIMIT
        return track
    images = _images(flow, start)
    while len(track.points) < run.points:
        here = track.points[-1]
        try:
            there, end = _next(flow, here, before, step, run, images if len(track.points) > 2 else [])
            found, last, junction = _between_points(flow, here, there)
        except (NotConverged, np.linalg.LinAlgError) as error:
            step *= 0.4
            if step < run.least:
                track.end, track.tried = End.STEP, f"{error}; steps down to {run.least:g}"
                return track
            continue
        base = len(track.points) - 1
        track.specials += [replace(one, after=base + one.after) for one in found]
        track.points += last or [there]
        progress(there)
        if _cut_at_junction(track):
            junction = End.SYMMETRY
        if junction is not None:
            end = junction
        if end is not None:
            track.end = end
            return track
        if run.to_first and any(one.kind not in PASSED for one in found):
            track.end = End.SPECIAL
            return track
        step = min(next_length(step, before, here, there), run.largest)
        before = here
    return track


def _outward(start: Point, run: Run) -> bool:
    """Whether a point at a limit of the parameter looks beyond it."""
    upper = abs(start.u - np.log(run.high)) < abs(start.u - np.log(run.low))
    return bool(start.tangent[-1] > 0.0) == upper


def _next(
    flow: PeriodMap, here: Point, before: Point | None, step: float, run: Run, images: list[Array]
) -> tuple[Point, End | None]:
    """The next point, and why the branch ends there if it does. Raises NotConverged if a step is refused."""
    there = step_along(flow, here, before, step)
    limits = np.log([run.low, run.high])
    end = None
    if not limits[0] <= there.u <= limits[1]:
        there, end = _onto_limit(flow, here, there, limits[int(there.u > here.u)]), End.LIMIT
    closing = _closing(flow, images, here, there)
    if closing is not None:
        return closing, End.CLOSED
    if np.abs(there.z).max() > run.bound:
        end = End.POLE
    return there, end


def _onto_limit(flow: PeriodMap, here: Point, there: Point, limit: float) -> Point:
    """The point at a limit of the parameter between two points."""
    share = (limit - here.u) / (there.u - here.u)
    guess = here.x + share * (there.x - here.x)
    guess[-1] = limit
    row = np.zeros(guess.size)
    row[-1] = 1.0
    return solve_point(flow, guess, row, here.tangent, here.linear)


def _images(flow: PeriodMap, start: Point) -> list[Array]:
    return [np.append(z, start.u) for z in flow.images(start.z, start.u)]


def _closing(flow: PeriodMap, images: list[Array], here: Point, there: Point) -> Point | None:
    """The point at which the branch comes back to where it began, at any of its mesh periods."""
    chord = there.x - here.x
    length = np.linalg.norm(chord)
    for image in images:
        share = (image - here.x) @ chord / length**2
        off = np.linalg.norm(image - here.x - share * chord)
        if not 0.0 < share <= 1.0 or off > 0.2 * length:
            continue
        try:
            point = solve_point(flow, here.x + share * chord, chord / length, here.tangent, here.linear)
        except (NotConverged, np.linalg.LinAlgError):
            continue
        row = chord / length
        target = solve_point(flow, image, row, here.tangent, here.linear)
        if np.linalg.norm(point.x - target.x) < 1e-6 + 1e-3 * off:
            return target
    return None


def _between_points(
    flow: PeriodMap, here: Point, there: Point
) -> tuple[list[Special], list[Point], End | None]:
    """Special points on the way; where the branch runs into its own image, its last points and that end."""
    meeting = reversal(flow, here, there)
    if meeting is not None:
        found = [one for one in locate(flow, here, meeting[0]) if not _at(one, meeting[1])]
        return found, list(meeting), End.DOUBLING
    return locate(flow, here, there), [], None


def _cut_at_junction(track: _Track) -> bool:
    """Whether the track has just met a branch point at which it turns round: it ends there, where the other
    branch goes through, and what follows is its own mirror image.
    """
    late = [one for one in track.specials if one.after > len(track.points) - 1 - NEAR_JUNCTION]
    for one in late:
        if one.kind is Kind.BRANCH and any(o.kind is Kind.FOLD and _at(o, one.point) for o in late):
            before = [o for o in track.specials if o.after < one.after and not _at(o, one.point)]
            track.specials = before
            track.points = [*track.points[: int(one.after) + 1], one.point]
            return True
    return False


def _at(special: Special, point: Point) -> bool:
    """Whether a fold or branch point is only how a branch that ends at `point` looks there."""
    return special.kind in (Kind.FOLD, Kind.BRANCH) and abs(special.point.u - point.u) < JUNCTION


def branch_at(flow: PeriodMap, z: Array, value: float, run: Run) -> Branch:
    """The whole branch through the orbit next to the weighted state z at a parameter."""
    return follow(flow, at_parameter(flow, z, float(np.log(value))), run)
