"""All motions over a range of one parameter: branches, what leaves them, what was found elsewhere."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from facegear.dynamics.branches.continuation import Branch, BranchEnd, ContinuationSettings, follow
from facegear.dynamics.branches.explore import SAME, lies_on
from facegear.dynamics.branches.mirror_images import image_branch, image_point, image_state
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint
from facegear.dynamics.branches.special import Kind, Special
from facegear.dynamics.branches.switching import broken, doubled
from facegear.dynamics.symmetries import symmetries
from facegear.errors import NotConverged
from facegear.number_format import count_noun

MET = 1e-6
"""Logarithms of the parameter that differ by less belong to one special point."""


@dataclass(frozen=True)
class Unfollowed:
    """A motion that was not followed: its period, its parameter, where it was met, and why not."""

    period: int
    value: float
    origin: str
    reason: str


@dataclass(frozen=True, eq=False)
class Survey:
    """branches in the order in which they were found, images behind their original, and the motions that were
    not followed.
    """

    branches: list[Branch]
    unfollowed: list[Unfollowed]


def survey(
    start: tuple[PeriodMap, BranchPoint],
    motions: Iterable[tuple[PeriodMap, BranchPoint, str]],
    run: ContinuationSettings,
    longest_period: int,
    max_branches: int,
    progress: Callable[[str], None] = lambda text: None,
) -> Survey:
    """The branch through `start`, all that leave it, and those through motions found elsewhere.

    Every branch that a symmetry of the system does not map to itself has its images behind it, which are not
    followed but mapped. These are all periodic motions that hang together with a motion of the start or of
    `motions` by branches of up to longest_period mesh periods, with these bounds. Motions that no branch
    leads to and no start has found are missing, also where a branch of `motions` ends on such a branch.
    Where several multipliers pass one together, as at equal pinions all around, one of the branches that
    leave the point is followed with its images. What leaves a Neimark-Sacker point is not periodic.

    Parameters
    ----------
    start
        Map and point of the first branch.
    motions
        Motions found elsewhere, each with its map and where it was found.
    run
        Range and steps of all branches.
    longest_period
        Longest period, in mesh periods, to which what leaves a branch by period doubling or broken symmetry
        is followed.
    max_branches
        Largest number of branches that are followed, without their images.
    progress
        Called with a line about each branch.
    """
    search = _Search(run, longest_period, max_branches, progress)
    search.follow(*start, "the first motion")
    for period_map, point, origin in motions:
        search.follow(period_map, point, origin)
    return Survey(search.branches, search.unfollowed)


@dataclass(eq=False)
class _Search:
    run: ContinuationSettings
    longest_period: int
    max_branches: int
    progress: Callable[[str], None]
    branches: list[Branch] = field(default_factory=list)
    unfollowed: list[Unfollowed] = field(default_factory=list)
    met: list[tuple[int, float]] = field(default_factory=list)

    def follow(self, period_map: PeriodMap, point: BranchPoint, origin: str) -> None:
        """Follow a motion that lies on no branch, and all that leaves its branch."""
        if self._is_known(period_map.period, point):
            return
        branch = self._tried(
            partial(follow, period_map, point, self.run), period_map.period, point.value, origin
        )
        if branch is None:
            return
        todo = [branch]
        while todo:
            todo += self._children(todo.pop(0))

    def _children(self, parent: Branch) -> list[Branch]:
        """New branches that leave a branch; a special point that a branch begins or ends at is left once."""
        children = []
        for special in parent.of(Kind.DOUBLING, Kind.BRANCH):
            period = parent.period_map.period * (2 if special.kind is Kind.DOUBLING else 1)
            if period > self.longest_period or self._was_met(period, special.point.u):
                continue
            self.met.append((period, special.point.u))
            child = self._tried(
                partial(_leave, parent.period_map, special, self.run),
                period,
                special.point.value,
                f"{special.kind} of branch {self.branches.index(parent)}",
            )
            if child is not None:
                children.append(child)
        return children

    def _tried(self, attempt: Callable[[], Branch], period: int, value: float, origin: str) -> Branch | None:
        """A new branch, kept; None if it is known already, or with a note if it cannot be followed."""
        if sum(branch.image_of is None for branch in self.branches) >= self.max_branches:
            reason = f"{self.max_branches} branches are followed already"
            self.unfollowed.append(Unfollowed(period, value, origin, reason))
            return None
        try:
            branch = attempt()
        except NotConverged as error:
            self.unfollowed.append(Unfollowed(period, value, origin, str(error)))
            return None
        self.met += [
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
        """Keep the images of a branch that are not known already; a symmetric branch is its own image."""
        number, period_map = len(self.branches) - 1, branch.period_map
        probe = branch.points[len(branch.points) // 2]
        own = period_map.images(probe.z, probe.u)
        for symmetry in symmetries(period_map.family.at(probe.value)[0]):
            z = image_state(period_map, probe.z, probe.u, symmetry)
            if min(np.abs(z - state).max() for state in own) < SAME:
                continue
            try:
                image = image_point(period_map, probe, symmetry)
                if self._is_known(period_map.period, image):
                    continue
                self.branches.append(replace(image_branch(branch, symmetry), image_of=number))
            except NotConverged as error:
                origin = f"image of branch {number}"
                self.unfollowed.append(Unfollowed(period_map.period, probe.value, origin, str(error)))

    def _is_known(self, period: int, point: BranchPoint) -> bool:
        return any(lies_on(branch, point, period) for branch in self.branches)

    def _was_met(self, period: int, u: float) -> bool:
        return any(other == period and abs(u - ended_at) < MET for other, ended_at in self.met)


def _leave(period_map: PeriodMap, special: Special, run: ContinuationSettings) -> Branch:
    return (
        doubled(period_map, special, run)
        if special.kind is Kind.DOUBLING
        else broken(period_map, special, run)
    )
