"""Requests to run a motion: many of them are integrated side by side where they share a structure.

Run plans: computations made of runs, each of which depends on what the last one has shown. A run plan
requests a run by yielding it and receives its result. The same code watches one machine alone and many whose
runs are integrated side by side.
"""

from collections import defaultdict
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from heapq import heapreplace
from typing import TypeAlias, TypeVar

import numpy as np

from facegear._kernels import motion
from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.motion.integrator.integrator import Integrator, result_of, run_machines
from facegear.motion.integrator.kernel_system import make_runner, packed_system
from facegear.motion.integrator.records import RunResult


@dataclass(frozen=True, eq=False)
class RunRequest:
    """Request to run whole mesh periods from a state (2, n) by phase, with the options of
    `Integrator.run`.

    Without batches, samples or tangents there are no fractions of time in contact.
    """

    integrator: Integrator
    state: Array
    periods: int
    tangents: Array | None = None
    samples: int = 0
    batches: int = 0
    growth: bool = False

    def run(self) -> RunResult:
        """Run the request by itself.

        Returns
        -------
        RunResult
            Result of the run.

        Raises
        ------
        NotConverged
            If a step fails.
        """
        return self.integrator.run(
            self.state,
            self.periods,
            self.tangents,
            samples=self.samples,
            batches=self.batches,
            growth=self.growth,
        )

    @property
    def disturbances(self) -> Array:
        """Tangents (columns, 2, n); there may be none."""
        return np.zeros((0, *self.state.shape)) if self.tangents is None else self.tangents

    @property
    def kind(self) -> tuple[object, ...]:
        """Options that must be equal for requests that run side by side: numbers of tangents, samples and
        batches, and growth.
        """
        return len(self.disturbances), self.samples, self.batches, self.growth


WIDTH: int = motion.ABREAST
"""Machines that run side by side."""
FEWEST = 5
"""Machines of one structure that pay for lanes: all lanes together take as long as three to five runs."""


def run_many(
    integrators: Sequence[Integrator],
    starts: Sequence[Array],
    periods: int,
    last_periods: int | None = None,
    samples: int = 0,
    fewest: int = FEWEST,
) -> list[RunResult]:
    """Run machines with the steps and to the errors of `Integrator.run`.

    Raises NotConverged if any of the runs fails.

    Parameters
    ----------
    integrators : sequence of Integrator
        The machines, in any order and of any structures.
    starts : sequence of Array
        Start of each machine: coordinates and their derivatives by phase, (2, n), m and m/rad.
    periods : int
        Number of mesh periods.
    last_periods : int, optional
        Number of last periods whose end states are returned; all if None.
    samples : int
        Number of samples of the coordinates in each period.
    fewest : int
        Number of machines of one structure from which they run side by side.

    Returns
    -------
    list of RunResult
        Result of each machine.
    """
    stretches = [
        RunRequest(integrator, start, periods, samples=samples)
        for integrator, start in zip(integrators, starts, strict=True)
    ]
    runs = []
    for run in run_stretches(stretches, last_periods, fewest):
        if isinstance(run, NotConverged):
            raise run
        runs.append(run)
    return runs


def run_stretches(
    stretches: Sequence[RunRequest], last_periods: int | None = None, fewest: int = FEWEST
) -> list[RunResult | NotConverged]:
    """Run many requests, called stretches, side by side where they share a structure of system and a kind
    of request.

    Parameters
    ----------
    stretches : sequence of RunRequest
        The requests, in any order.
    last_periods : int, optional
        Number of last periods whose end states are returned; all if None.
    fewest : int
        Number of stretches of one structure and request from which they run side by side; fewer run one
        after the other.

    Returns
    -------
    list of RunResult or NotConverged
        Result of each stretch, or the error that it failed with.
    """
    runs: dict[int, RunResult | NotConverged] = {}
    for group in _groups(stretches) if len(stretches) >= fewest else ():
        if numbers := _in_lanes({number: stretches[number].periods for number in group}, fewest):
            group_runs = _side_by_side([stretches[number] for number in numbers], last_periods)
            runs |= zip(numbers, group_runs, strict=True)
    return [
        runs[number] if number in runs else _alone(stretch, last_periods)
        for number, stretch in enumerate(stretches)
    ]


def _groups(stretches: Sequence[RunRequest]) -> list[list[int]]:
    """Return groups of requests, by index, that may be integrated side by side: of equal structure, order
    and kind.
    """
    structures: list[motion.System] = []
    structure_of: dict[motion.System, int] = {}
    groups: dict[tuple[object, ...], list[int]] = defaultdict(list)
    for number, stretch in enumerate(stretches):
        system = packed_system(stretch.integrator.system)
        if system not in structure_of:
            fitting = (index for index, structure in enumerate(structures) if structure.fits(system))
            structure_of[system] = next(fitting, len(structures))
            if structure_of[system] == len(structures):
                structures.append(system)
        groups[(structure_of[system], stretch.integrator.order, *stretch.kind)].append(number)
    return list(groups.values())


def _in_lanes(periods: Mapping[int, int], fewest: int) -> list[int]:
    """Choose which machines of one structure run side by side in lanes; return their keys, longest run
    first.

    `periods` are the mesh periods of each machine by key. Lanes take as long for one machine as for all:
    each period of theirs counts as `fewest` periods of a single run. The longest run singly where the
    other lanes would wait for them.
    """
    order = sorted(periods, key=lambda number: -periods[number])
    lengths = [periods[number] for number in order]
    singly = [*range(min(WIDTH, len(order))), len(order)]
    costs = [sum(lengths[:count]) + fewest * _busy(lengths[count:], WIDTH) for count in singly]
    return order[singly[costs.index(min(costs))] :]


def _busy(lengths: Sequence[int], lanes: int) -> int:
    """Return how long parallel lanes are busy with runs of these lengths, each taken by the first lane that
    is free.
    """
    ends = [0] * lanes
    for length in lengths:
        heapreplace(ends, ends[0] + length)
    return max(ends)


def _alone(stretch: RunRequest, last_periods: int | None) -> RunResult | NotConverged:
    """Run one request by itself, and return its result with the last end states only, or the error with
    which it failed.
    """
    try:
        run = stretch.run()
    except NotConverged as failure:
        return failure
    if last_periods is None:
        return run
    return replace(run, ends=run.ends[max(stretch.periods - last_periods, 0) :])


def _side_by_side(
    stretches: Sequence[RunRequest], last_periods: int | None
) -> list[RunResult | NotConverged]:
    """Run requests of one structure and kind in lanes; return the result of each, or the error with which
    it failed.
    """
    first, periods = stretches[0], [stretch.periods for stretch in stretches]
    integrators = [stretch.integrator for stretch in stretches]
    log = run_machines(
        make_runner(first.integrator.system, first.integrator.order, in_lanes=True),
        integrators,
        [stretch.state for stretch in stretches],
        periods,
        last_periods=max(periods) if last_periods is None else last_periods,
        tangents=np.array([stretch.disturbances for stretch in stretches]),
        samples=first.samples,
        batches=first.batches,
        growth=first.growth,
        fine=first.tangents is not None,
    )
    return [_result(log, number, stretch) for number, stretch in enumerate(stretches)]


def _result(log: motion.Log, number: int, stretch: RunRequest) -> RunResult | NotConverged:
    """Return the result of the machine with index `number` in a run, or the error that it failed with."""
    try:
        return result_of(log, number, stretch.integrator, stretch.periods)
    except NotConverged as failure:
        return failure


T = TypeVar("T")


RunPlan: TypeAlias = Generator[RunRequest, RunResult, T]
"""Computation that yields RunRequests, receives their results, and returns a value.

A NotConverged of a run is raised where it was requested.
"""


def alone(plan: RunPlan[T]) -> T:
    """Run a single plan to completion: integrate each run that it requests and send it the result.

    Parameters
    ----------
    plan : RunPlan
        Generator that yields RunRequests, receives their results, and returns a value.

    Returns
    -------
    T
        Value that the plan returns.

    Raises
    ------
    NotConverged
        If the plan raises it.
    """
    return side_by_side([plan])[0]


def side_by_side(plans: Sequence[RunPlan[T]]) -> list[T]:
    """Run many plans to completion; requests of one kind are integrated together, whatever their lengths.

    The kind that most plans request at a time is run, while the others wait for more of their own. So lanes
    are as full as they can be.

    Parameters
    ----------
    plans : sequence of RunPlan
        Generators that yield RunRequests, receive their results, and return a value.

    Returns
    -------
    list of T
        Value that each plan returns.

    Raises
    ------
    NotConverged
        If any of the plans raises it.
    """
    results: dict[int, T] = {}
    requests: dict[int, RunRequest] = {}
    answers: dict[int, RunResult | NotConverged | None] = dict.fromkeys(range(len(plans)))
    while answers:
        for number, answer in answers.items():
            try:
                requests[number] = _next_of(plans[number], answer)
            except StopIteration as end:
                results[number] = end.value
        group = _largest_group(requests)
        answers = dict(zip(group, run_stretches([requests.pop(number) for number in group]), strict=True))
    return [results[number] for number in range(len(plans))]


def _largest_group(requests: Mapping[int, RunRequest]) -> list[int]:
    """Return the keys of the run plans whose pending requests are of the most frequent kind, see
    RunRequest.kind.
    """
    groups: dict[tuple[object, ...], list[int]] = defaultdict(list)
    for number, stretch in requests.items():
        groups[stretch.kind].append(number)
    return max(groups.values(), key=len, default=[])


def _next_of(plan: RunPlan[T], answer: RunResult | NotConverged | None) -> RunRequest:
    """Send a plan the answer to its last request (None: start it) and return the next request.

    An error as answer is raised inside the plan. Raises StopIteration with the plan's value at its end.
    """
    if isinstance(answer, NotConverged):
        return plan.throw(answer)
    return next(plan) if answer is None else plan.send(answer)
