"""Follow a branch of periodic motions through folds until it ends.

Pseudo-arclength continuation (Keller 1977): the parameter is an unknown like the state. A step goes along the
tangent of the branch, and Newton's method returns to the branch in the plane across the tangent (points.py).
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.motion.branches.locate import DividedStep, locate, locate_grazes
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint, solve_point
from facegear.motion.branches.segment import next_length, reversal, step_along
from facegear.motion.branches.special import Kind, Special

JUNCTION = 1e-6
"""Logarithms of the parameter that differ by less belong to one junction of branches."""
NEAR_JUNCTION = 3.0
"""Fold and branch point of a junction lie within this many steps."""
SHORTENING_FACTOR = 0.4
"""Factor on the length of a step that was refused: a free choice, which decides how many steps are tried."""
NEAR_CHORD = 0.2
"""Distance from the chord of a step, over its length, up to which the start of the branch is looked for: a
step with a larger correction is refused (CORRECTION of segment.py), so that the branch lies no farther off.
"""
SAME_POINT, SAME_POINT_SLOPE = 1e-6, 1e-3
"""Distance up to which two solved points are one, in length scales, and its growth with the distance of the
start from the chord: the planes through both are then not quite the same.
"""
NON_LIMITING_KINDS = (Kind.GRAZE, Kind.NEUTRAL)
"""Special points at which a motion neither ends nor changes its stability."""


class BranchEnd(StrEnum):
    """Reason why a branch ends."""

    LIMIT = "limit of the parameter"
    CLOSED_LOOP = "closed"
    START = "where it was begun"
    DOUBLING = "period doubling of another branch"
    SYMMETRY = "branch point"
    POLE = "amplitude without bound"
    POINTS = "number of points"
    STEP = "step too short"
    SPECIAL = "first special point"


@dataclass(frozen=True)
class ContinuationSettings:
    """Settings of the continuation; step lengths are measured in weighted states and logarithms of the
    parameter.

    Attributes
    ----------
    p_min, p_max : float
        Range of the parameter, in its unit.
    first, ds_min, ds_max : float
        First, smallest and largest step length.
    max_points : int
        Maximum number of points in each direction.
    bound : float
        Largest component of a weighted state; beyond it the branch ends as a pole.
    to_first : bool
        Whether to end at the first special point at which stability may change (not a graze or a neutral
        body).
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
    """A branch of periodic motions: its points in order, the special points between them, and why it ends.

    Attributes
    ----------
    period_map : PeriodMap
        The map whose fixed points the points are.
    points : list of BranchPoint
        Points along the branch, neighbours one step apart.
    specials : list of Special
        Special points sorted by `after`: index of the point before plus the fraction of the way to the next.
    ends : tuple of BranchEnd
        Why the branch ends before the first and behind the last point.
    failed_attempts : str
        What was tried where steps became too short; empty elsewhere.
    image_of : int or None
        Number of the branch, in the list that holds both, of which this one is the image under a symmetry of
        the system. None for a branch that was followed.
    """

    period_map: PeriodMap
    points: list[BranchPoint]
    specials: list[Special]
    ends: tuple[BranchEnd, BranchEnd]
    failed_attempts: str = ""
    image_of: int | None = None

    @property
    def arc(self) -> Array:
        """Arc length of the points from the first, shape (points,): sums of chord lengths in x, see
        BranchPoint, dimensionless.
        """
        steps = [np.linalg.norm(b.x - a.x) for a, b in zip(self.points, self.points[1:], strict=False)]
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def values(self) -> Array:
        """Parameter of the points in its own unit, not its logarithm, shape (points,)."""
        return np.array([point.value for point in self.points])

    def of(self, *kinds: str) -> list[Special]:
        """Return the special points of given kinds, in their order along the branch.

        Parameters
        ----------
        *kinds : str
            Values of Kind.

        Returns
        -------
        list of Special
            Special points.
        """
        return [special for special in self.specials if special.kind in kinds]


@dataclass(eq=False)
class _Track:
    """One side of a branch while it is followed from its start: points, special points, reason of its
    end.

    `specials` have their `after` counted from the start; `failed_attempts` is as in Branch.
    """

    points: list[BranchPoint]
    specials: list[Special] = field(default_factory=list)
    end: BranchEnd = BranchEnd.POINTS
    failed_attempts: str = ""


def follow(
    period_map: PeriodMap,
    start: BranchPoint,
    run: ContinuationSettings,
    both_ways: bool = True,
    progress: Callable[[BranchPoint], None] = lambda point: None,
) -> Branch:
    """Follow the branch through a point by pseudo-arclength continuation, and locate its special points.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    start : BranchPoint
        First point; its tangent gives the direction.
    run : ContinuationSettings
        Range of the parameter and step lengths.
    both_ways : bool
        Whether the branch is followed against the tangent, too.
    progress : callable
        Called with each new point.

    Returns
    -------
    Branch
        Points and special points in order along the tangent.
    """
    ahead = _track(period_map, start, run, progress)
    if not both_ways or ahead.end is BranchEnd.CLOSED_LOOP:
        first = BranchEnd.CLOSED_LOOP if ahead.end is BranchEnd.CLOSED_LOOP else BranchEnd.START
        return Branch(period_map, ahead.points, ahead.specials, (first, ahead.end), ahead.failed_attempts)
    behind = _track(period_map, reverse_tangent(start), run, progress)
    count = len(behind.points) - 1
    points = [reverse_tangent(point) for point in behind.points[:0:-1]] + ahead.points
    specials = [replace(s, after=count - s.after) for s in behind.specials[::-1]]
    specials += [replace(s, after=count + s.after) for s in ahead.specials]
    failed_attempts = "; ".join(text for text in (behind.failed_attempts, ahead.failed_attempts) if text)
    return Branch(period_map, points, specials, (behind.end, ahead.end), failed_attempts)


def reverse_tangent(point: BranchPoint) -> BranchPoint:
    """Return the same point with the opposite tangent and parity.

    Parameters
    ----------
    point : BranchPoint
        Point of a branch.

    Returns
    -------
    BranchPoint
        Point whose tangent has the other sign.
    """
    return replace(point, tangent=-point.tangent, parity=-point.parity)


def _track(
    period_map: PeriodMap,
    start: BranchPoint,
    run: ContinuationSettings,
    progress: Callable[[BranchPoint], None],
) -> _Track:
    """Continue a branch from a start along its tangent until it closes, ends or reaches a limit.

    Steps that are refused are shortened by SHORTENING_FACTOR. `progress` is called with each new point.
    """
    track, step, before = _Track([start]), run.first, None
    if any(abs(start.u - np.log(limit)) < JUNCTION for limit in (run.p_min, run.p_max)) and _outward(
        start, run
    ):
        track.end = BranchEnd.LIMIT
        return track
    images = _images(period_map, start)
    while len(track.points) < run.max_points:
        current_point = track.points[-1]
        try:
            next_point, end = _next(
                period_map, current_point, before, step, run, images if len(track.points) > 2 else []
            )
            division, last, junction = _between_points(period_map, current_point, next_point)
        except (NotConverged, np.linalg.LinAlgError) as error:
            step *= SHORTENING_FACTOR
            if step < run.ds_min:
                track.end, track.failed_attempts = BranchEnd.STEP, f"{error}; steps down to {run.ds_min:g}"
                return track
            continue
        base = len(track.points) - 1
        track.specials += [replace(special, after=base + special.after) for special in division.specials]
        track.points += [*division.inner, *last]
        progress(next_point)
        if _cut_at_junction(track, base):
            junction = BranchEnd.SYMMETRY
        if junction is not None:
            end = junction
        if end is not None:
            track.end = end
            return track
        if run.to_first and any(special.kind not in NON_LIMITING_KINDS for special in division.specials):
            track.end = BranchEnd.SPECIAL
            return track
        step = min(next_length(step, before, current_point, next_point), run.ds_max)
        before = current_point
    return track


def _outward(start: BranchPoint, run: ContinuationSettings) -> bool:
    """Whether the tangent at a point that lies at a limit of the parameter leads beyond this limit."""
    upper = abs(start.u - np.log(run.p_max)) < abs(start.u - np.log(run.p_min))
    return bool(start.tangent[-1] > 0.0) == upper


def _next(
    period_map: PeriodMap,
    current_point: BranchPoint,
    before: BranchPoint | None,
    step: float,
    run: ContinuationSettings,
    images: list[Array],
) -> tuple[BranchPoint, BranchEnd | None]:
    """Return the next point, one step along the tangent, and why the branch ends there, or None if it
    goes on.

    `before` is the point before the current one, `images` the start's images, to see whether the branch
    closes. Raises NotConverged if the step is refused.
    """
    next_point = step_along(period_map, current_point, before, step)
    limits = np.log([run.p_min, run.p_max])
    end = None
    if not limits[0] <= next_point.u <= limits[1]:
        next_point, end = (
            _onto_limit(period_map, current_point, next_point, limits[int(next_point.u > current_point.u)]),
            BranchEnd.LIMIT,
        )
    closing_point = _closing_point(period_map, images, current_point, next_point)
    if closing_point is not None:
        return closing_point, BranchEnd.CLOSED_LOOP
    if np.abs(next_point.z).max() > run.bound:
        end = BranchEnd.POLE
    return next_point, end


def _onto_limit(
    period_map: PeriodMap, current_point: BranchPoint, next_point: BranchPoint, limit: float
) -> BranchPoint:
    """Return the orbit at which a branch passes a limit of the parameter (its logarithm) between two
    points.
    """
    fraction = (limit - current_point.u) / (next_point.u - current_point.u)
    guess = current_point.x + fraction * (next_point.x - current_point.x)
    guess[-1] = limit
    row = np.zeros(guess.size)
    row[-1] = 1.0
    return solve_point(period_map, guess, row, current_point.tangent, current_point.linear)


def _images(period_map: PeriodMap, start: BranchPoint) -> list[Array]:
    """Return the start's weighted states at each of its mesh periods, with the parameter's logarithm
    appended, (2 n + 1,).
    """
    return [np.append(z, start.u) for z in period_map.images(start.z, start.u)]


def _closing_point(
    period_map: PeriodMap, images: list[Array], current_point: BranchPoint, next_point: BranchPoint
) -> BranchPoint | None:
    """Return the start as a point of the branch if the branch comes back to it in this step, else None.

    `images` are the start's states at each of its mesh periods, see _images(): a branch may return to any
    of them.
    """
    chord = next_point.x - current_point.x
    length = np.linalg.norm(chord)
    for image in images:
        fraction = (image - current_point.x) @ chord / length**2
        off = np.linalg.norm(image - current_point.x - fraction * chord)
        if not 0.0 < fraction <= 1.0 or off > NEAR_CHORD * length:
            continue
        # Another leg may pass beside the start. The branch is closed only if its own point in the plane
        # through the start is the start.
        try:
            point = solve_point(
                period_map,
                current_point.x + fraction * chord,
                chord / length,
                current_point.tangent,
                current_point.linear,
            )
        except (NotConverged, np.linalg.LinAlgError):
            continue
        row = chord / length
        target = solve_point(period_map, image, row, current_point.tangent, current_point.linear)
        if np.linalg.norm(point.x - target.x) < SAME_POINT + SAME_POINT_SLOPE * off:
            return target
    return None


def _between_points(
    period_map: PeriodMap, current_point: BranchPoint, next_point: BranchPoint
) -> tuple[DividedStep, list[BranchPoint], BranchEnd | None]:
    """Return the special points of a step, the points that follow the current one, and why the branch
    ends, or None.

    Where the branch runs into its own image, shifted by half its period, the points lead up to that
    place. The end is then DOUBLING.
    """
    meeting = reversal(period_map, current_point, next_point)
    if meeting is None:
        return locate(period_map, current_point, next_point), [next_point], None
    division = locate(period_map, current_point, meeting[0])
    count = len(division.inner) + 1
    specials = [special for special in division.specials if not _at(special, meeting[1])]
    grazes = locate_grazes(period_map, *meeting, meeting[0].linear)
    specials += [replace(special, after=count + special.after) for special in grazes]
    return DividedStep(specials, division.inner), list(meeting), BranchEnd.DOUBLING


def _cut_at_junction(track: _Track, begin: int) -> bool:
    """Cut the track at a branch point at which it turns round, and return whether there was one.

    Branch point and fold lie together where the branch meets the branch it left from; what follows is its
    own mirror image. `begin` is the index of the point from which the last step went. Points that were
    put inside that step do not count as steps.
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
    """Whether a special point is a fold or branch point at the same parameter as the `point` at which a
    branch ends.

    It is then only how the end of the branch looks and no special point of its own.
    """
    return special.kind in (Kind.FOLD, Kind.BRANCH) and abs(special.point.u - point.u) < JUNCTION
