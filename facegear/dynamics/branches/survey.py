"""All motions over a range of one parameter: branches, what leaves them, what was found elsewhere."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial

from facegear.dynamics.branches.continuation import Branch, End, Run, follow
from facegear.dynamics.branches.explore import lies_on
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import Point
from facegear.dynamics.branches.special import Kind, Special
from facegear.dynamics.branches.switching import broken, doubled
from facegear.errors import NotConverged

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
    """branches in the order in which they were found, and the motions that were not followed."""

    branches: list[Branch]
    unfollowed: list[Unfollowed]


def survey(
    start: tuple[PeriodMap, Point],
    motions: Iterable[tuple[PeriodMap, Point, str]],
    run: Run,
    longest_period: int,
    most: int,
    progress: Callable[[str], None] = lambda text: None,
) -> Survey:
    """The branch through `start`, all that leave it, and those through motions found elsewhere.

    motions: each with its map and where it was found. What leaves a branch by period doubling or broken
    symmetry is followed up to longest_period. At most `most` branches.
    """
    search = _Search(run, longest_period, most, progress)
    search.follow(*start, "the first motion")
    for flow, point, origin in motions:
        search.follow(flow, point, origin)
    return Survey(search.branches, search.unfollowed)


@dataclass(eq=False)
class _Search:
    run: Run
    longest_period: int
    most: int
    progress: Callable[[str], None]
    branches: list[Branch] = field(default_factory=list)
    unfollowed: list[Unfollowed] = field(default_factory=list)
    met: list[tuple[int, float]] = field(default_factory=list)

    def follow(self, flow: PeriodMap, point: Point, origin: str) -> None:
        """Follow a motion that lies on no branch, and all that leaves its branch."""
        if self._is_known(flow.period, point):
            return
        branch = self._tried(partial(follow, flow, point, self.run), flow.period, point.value, origin)
        if branch is None:
            return
        todo = [branch]
        while todo:
            todo += self._children(todo.pop(0))

    def _children(self, parent: Branch) -> list[Branch]:
        """New branches that leave a branch; a special point that a branch begins or ends at is left once."""
        found = []
        for special in parent.of(Kind.DOUBLING, Kind.BRANCH):
            period = parent.flow.period * (2 if special.kind is Kind.DOUBLING else 1)
            if period > self.longest_period or self._was_met(period, special.point.u):
                continue
            self.met.append((period, special.point.u))
            child = self._tried(
                partial(_leave, parent.flow, special, self.run),
                period,
                special.point.value,
                f"{special.kind} of branch {self.branches.index(parent)}",
            )
            if child is not None:
                found.append(child)
        return found

    def _tried(self, attempt: Callable[[], Branch], period: int, value: float, origin: str) -> Branch | None:
        """A new branch, kept; None if it is known already, or with a note if it cannot be followed."""
        if len(self.branches) >= self.most:
            reason = f"{self.most} branches are followed already"
            self.unfollowed.append(Unfollowed(period, value, origin, reason))
            return None
        try:
            branch = attempt()
        except NotConverged as error:
            self.unfollowed.append(Unfollowed(period, value, origin, str(error)))
            return None
        self.met += [
            (period, branch.points[place].u)
            for place, end in zip((0, -1), branch.ends, strict=True)
            if end in (End.DOUBLING, End.SYMMETRY)
        ]
        if self._is_known(period, branch.points[len(branch.points) // 2]):
            return None
        self.branches.append(branch)
        self.progress(f"{len(branch.points)} points of period {period}, {len(branch.specials)} special")
        return branch

    def _is_known(self, period: int, point: Point) -> bool:
        return any(lies_on(branch, point, period) for branch in self.branches)

    def _was_met(self, period: int, u: float) -> bool:
        return any(other == period and abs(u - place) < MET for other, place in self.met)


def _leave(flow: PeriodMap, special: Special, run: Run) -> Branch:
    return doubled(flow, special, run) if special.kind is Kind.DOUBLING else broken(flow, special, run)
