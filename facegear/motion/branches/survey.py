"""Find all motions over a range of one parameter: branches, what leaves them, and motions found elsewhere."""

import sys
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
import pandas as pd

from facegear.errors import NotConverged
from facegear.motion.branches.continuation import Branch, BranchEnd, ContinuationSettings, follow
from facegear.motion.branches.explore import SAME_ORBIT, lies_on
from facegear.motion.branches.loci import Locus
from facegear.motion.branches.margins import StabilityLimit
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint
from facegear.motion.branches.special import Kind, Special
from facegear.motion.branches.switching import (
    doubled_branch,
    image_branch,
    image_point,
    image_state,
    symmetry_broken_branch,
)
from facegear.motion.symmetries import symmetries
from facegear.number_format import count_noun

SAME_POINT = 1e-6
"""Logarithms of the parameter that differ by less belong to one special point."""


@dataclass(frozen=True)
class UnfollowedMotion:
    """A motion that was not followed.

    Attributes
    ----------
    period : int
        Number of mesh periods.
    value : float
        Parameter at it, in its unit.
    origin : str
        Where it was met.
    reason : str
        Why it was not followed.
    """

    period: int
    value: float
    origin: str
    reason: str


@dataclass(frozen=True, eq=False)
class Survey:
    """Result of survey().

    Attributes
    ----------
    branches : list of Branch
        Branches in the order in which they were found, images behind their original.
    unfollowed_motions : list of UnfollowedMotion
        Motions that were not followed.
    """

    branches: list[Branch]
    unfollowed_motions: list[UnfollowedMotion]


def survey(
    start: tuple[PeriodMap, BranchPoint],
    motions: Iterable[tuple[PeriodMap, BranchPoint, str]],
    run: ContinuationSettings,
    longest_period: int,
    max_branches: int,
    progress: Callable[[str], None] = lambda text: None,
) -> Survey:
    """Follow the branch through `start`, all that leave it, and those through motions found elsewhere.

    Every branch that a symmetry of the system does not map to itself is followed by its images in the list.
    The images are mapped, not followed. The result contains all periodic motions that are connected with a
    motion of `start` or `motions` by branches of up to longest_period mesh periods, within these bounds.
    Motions to which no branch leads and which no start has found are missing, also where a branch of
    `motions` ends on such a branch. Where several multipliers pass one together, as with equal pinions all
    around, one of the branches that leave the point is followed, with its images. Motions that leave a
    Neimark-Sacker point are not periodic.

    Parameters
    ----------
    start : tuple
        Map and point of the first branch.
    motions : iterable of tuple
        Motions found elsewhere: map, point, and where each was found.
    run : ContinuationSettings
        Range and steps of all branches.
    longest_period : int
        Longest period, in mesh periods, to which branches that leave by period doubling or broken symmetry
        are followed.
    max_branches : int
        Largest number of branches that are followed, without their images.
    progress : callable
        Called with one line of text about each branch.

    Returns
    -------
    Survey
        Branches, and motions that were not followed.
    """
    search = _Search(run, longest_period, max_branches, progress)
    search.follow(*start, "the first motion")
    for period_map, point, origin in motions:
        search.follow(period_map, point, origin)
    return Survey(search.branches, search.unfollowed_motions)


@dataclass(eq=False)
class _Search:
    """Branches found so far by survey(), and the motions that were not followed.

    `visited_points` are special points at which branches begin or end: mesh periods of the branch that
    leaves there, and logarithm of the parameter. The other fields are arguments of survey().
    """

    run: ContinuationSettings
    longest_period: int
    max_branches: int
    progress: Callable[[str], None]
    branches: list[Branch] = field(default_factory=list)
    unfollowed_motions: list[UnfollowedMotion] = field(default_factory=list)
    visited_points: list[tuple[int, float]] = field(default_factory=list)

    def follow(self, period_map: PeriodMap, point: BranchPoint, origin: str) -> None:
        """Follow the branch of a motion, unless it lies on a known one, and all branches that leave it,
        and so on.

        `origin` says where the motion was found.
        """
        if self._is_known(period_map.period, point):
            return
        branch = self._try_branch(
            partial(follow, period_map, point, self.run), period_map.period, point.value, origin
        )
        if branch is None:
            return
        todo = [branch]
        while todo:
            todo += self._children(todo.pop(0))

    def _children(self, parent: Branch) -> list[Branch]:
        """Return the new branches that leave a branch at its period doublings and branch points.

        A special point at which a branch begins or ends is left once.
        """
        children = []
        for special in parent.of(Kind.DOUBLING, Kind.BRANCH):
            period = parent.period_map.period * (2 if special.kind is Kind.DOUBLING else 1)
            if period > self.longest_period or self._was_met(period, special.point.u):
                continue
            self.visited_points.append((period, special.point.u))
            child = self._try_branch(
                partial(_leave, parent.period_map, special, self.run),
                period,
                special.point.value,
                f"{special.kind} of branch {self.branches.index(parent)}",
            )
            if child is not None:
                children.append(child)
        return children

    def _try_branch(
        self, attempt: Callable[[], Branch], period: int, value: float, origin: str
    ) -> Branch | None:
        """Call `attempt` to follow a new branch, and store the branch with its images.

        Return None if the branch is known already, or, with a note of `value` and `origin`, if it cannot
        be followed.
        """
        if sum(branch.image_of is None for branch in self.branches) >= self.max_branches:
            reason = f"{self.max_branches} branches are followed already"
            self.unfollowed_motions.append(UnfollowedMotion(period, value, origin, reason))
            return None
        try:
            branch = attempt()
        except NotConverged as error:
            self.unfollowed_motions.append(UnfollowedMotion(period, value, origin, str(error)))
            return None
        self.visited_points += [
            (period, branch.points[index].u)
            for index, end in zip((0, -1), branch.ends, strict=True)
            if end in (BranchEnd.DOUBLING, BranchEnd.SYMMETRY)
        ]
        if self._is_known(period, branch.points[len(branch.points) // 2]):
            return None
        self.branches.append(branch)
        self.progress(
            f"{count_noun(len(branch.points), 'point')} of period {period}, {len(branch.specials)} special"
        )
        self._add_images(branch)
        return branch

    def _add_images(self, branch: Branch) -> None:
        """Store the images under all symmetries of a branch just stored, but those known already; a
        symmetric branch has none.
        """
        number, period_map = len(self.branches) - 1, branch.period_map
        probe = branch.points[len(branch.points) // 2]
        branch_images = period_map.images(probe.z, probe.u)
        for symmetry in symmetries(period_map.family.at(probe.value)[0]):
            z = image_state(period_map, probe.z, probe.u, symmetry)
            if min(np.abs(z - state).max() for state in branch_images) < SAME_ORBIT:
                continue
            try:
                image = image_point(period_map, probe, symmetry)
                if self._is_known(period_map.period, image):
                    continue
                self.branches.append(replace(image_branch(branch, symmetry), image_of=number))
            except NotConverged as error:
                origin = f"image of branch {number}"
                self.unfollowed_motions.append(
                    UnfollowedMotion(period_map.period, probe.value, origin, str(error))
                )

    def _is_known(self, period: int, point: BranchPoint) -> bool:
        """Whether a point lies on a branch of this many mesh periods that was followed already."""
        return any(lies_on(branch, point, period) for branch in self.branches)

    def _was_met(self, period: int, u: float) -> bool:
        """Whether a special point of a branch of `period` at the parameter's logarithm `u` was visited
        before.
        """
        return any(
            visited_period == period and abs(u - ended_at) < SAME_POINT
            for visited_period, ended_at in self.visited_points
        )


def _leave(period_map: PeriodMap, special: Special, run: ContinuationSettings) -> Branch:
    """Follow the branch that leaves at a period doubling or, else, at a branch point where symmetry is
    lost.
    """
    return (
        doubled_branch(period_map, special, run)
        if special.kind is Kind.DOUBLING
        else symmetry_broken_branch(period_map, special, run)
    )


def tell(text: str) -> None:
    """Print a line of progress to standard error, which a stage copies to its log.

    Parameters
    ----------
    text : str
        Line without its prefix.
    """
    print(f"branches: {text}", file=sys.stderr, flush=True)


def survey_summary(
    survey: Survey,
    ranges: Sequence[tuple[float, float, tuple[int, ...]]],
    stability_limits: Sequence[StabilityLimit],
    sweep_motions: pd.DataFrame,
    jumps: pd.DataFrame,
) -> str:
    """Summarise branches, special points, coexistence, motions of the sweep, named jumps and margins.

    Parameters
    ----------
    survey : Survey
        Branches, and motions that were not followed.
    ranges : sequence of tuple
        Ranges of coexistence_ranges(), in rpm.
    stability_limits : sequence of StabilityLimit
        Limits of stability_limits().
    sweep_motions : DataFrame
        Table of swept_table().
    jumps : DataFrame
        Table of jump_table().

    Returns
    -------
    str
        One line.
    """
    originals = [branch for branch in survey.branches if branch.image_of is None]
    counts = Counter(s.kind.value for branch in originals for s in branch.specials)
    points, images = sum(len(branch.points) for branch in originals), len(survey.branches) - len(originals)
    motions = count_noun(len(sweep_motions), "periodic motion")
    parts = [
        f"{count_noun(len(originals), 'branch', 'branches')} of {count_noun(points, 'point')}"
        + (f" and {count_noun(images, 'image')}" if images else ""),
        ", ".join(f"{count} {kind}" for kind, count in counts.most_common()),
        f"{count_noun(len(ranges), 'speed range')} with several stable motions",
        f"{count_noun(len(survey.unfollowed_motions), 'motion')} not followed"
        if survey.unfollowed_motions
        else "",
        f"{(sweep_motions['branch'] != '').sum()} of {motions} of the sweep on a branch",
        f"{(jumps['kind'] != '').sum()} of {count_noun(len(jumps), 'jump')} named",
    ]
    parts += [_margin(loss) for loss in stability_limits]
    return "; ".join(part for part in parts if part)


def _margin(loss: StabilityLimit) -> str:
    """Return a line on the first loss of stability of a branch in one direction, or up to where there is
    none.
    """
    if loss.special is None:
        return f"branch {loss.branch}: no loss up to {loss.parameter} = {loss.end_value:.6g}"
    kind = loss.special.kind.value
    return f"branch {loss.branch}: {kind} at {loss.parameter} = {loss.end_value:.6g}, from {loss.start:.6g}"


def loci_summary(loci: Sequence[Locus], failures: Sequence[str]) -> str:
    """Summarise loci, their points and corners, and the loci that could not be followed.

    Parameters
    ----------
    loci : sequence of Locus
        Loci found.
    failures : sequence of str
        One line for each locus that could not be followed.

    Returns
    -------
    str
        One line.
    """
    corners = Counter(corner.value for locus in loci for corner, _ in locus.corners)
    points = count_noun(sum(len(locus.points) for locus in loci), "point")
    text = ", ".join(f"{count} {corner}" for corner, count in corners.items())
    failure_text = f"; not followed: {'; '.join(failures)}" if failures else ""
    return f"{count_noun(len(loci), 'locus', 'loci')} of {points}; {text or 'no corners'}{failure_text}"
