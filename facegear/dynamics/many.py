"""Runs of many machines over whole mesh periods, side by side where they share a structure."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace
from heapq import heapreplace

import numpy as np

from facegear._kernels import motion
from facegear.arrays import Array
from facegear.dynamics.integrator.compiled import make_runner, packed_system
from facegear.dynamics.integrator.integrator import Integrator, RunResult, result_of, run_machines
from facegear.dynamics.stretch import Stretch
from facegear.errors import NotConverged

WIDTH: int = motion.ABREAST
"""Machines that run side by side."""
FEWEST = 5
"""Machines of one structure that pay for lanes: all lanes together take as long as three to five runs."""


def run_many(
    integrators: Sequence[Integrator],
    starts: Sequence[Array],
    periods: int,
    kept: int | None = None,
    samples: int = 0,
    fewest: int = FEWEST,
) -> list[RunResult]:
    """Run machines from starts (2, n) by phase, with the steps and to the errors of `Integrator.run`.

    kept: states at the ends of how many of the last periods are kept, None for all. Raises NotConverged if
    any of the runs fails. fewest: as in run_stretches().
    """
    stretches = [
        Stretch(integrator, start, periods, samples=samples)
        for integrator, start in zip(integrators, starts, strict=True)
    ]
    runs = []
    for run in run_stretches(stretches, kept, fewest):
        if isinstance(run, NotConverged):
            raise run
        runs.append(run)
    return runs


def run_stretches(
    stretches: Sequence[Stretch], kept: int | None = None, fewest: int = FEWEST
) -> list[RunResult | NotConverged]:
    """Run stretches of many machines; what one fails with stands in the place of its result.

    Machines of one structure that are asked for the same run side by side; those of which there are fewer
    than `fewest` run one after the other. kept: as in run_many().
    """
    runs: dict[int, RunResult | NotConverged] = {}
    for alike in _groups(stretches) if len(stretches) >= fewest else ():
        if numbers := _in_lanes({number: stretches[number].periods for number in alike}, fewest):
            group = [stretches[number] for number in numbers]
            runs |= zip(numbers, _side_by_side(group, kept), strict=True)
    return [
        runs[number] if number in runs else _alone(stretch, kept) for number, stretch in enumerate(stretches)
    ]


def _groups(stretches: Sequence[Stretch]) -> list[list[int]]:
    """Numbers of the stretches that may run side by side."""
    structures: list[motion.System] = []
    known: dict[motion.System, int] = {}
    groups: dict[tuple[object, ...], list[int]] = defaultdict(list)
    for number, stretch in enumerate(stretches):
        system = packed_system(stretch.integrator.system)
        if system not in known:
            fitting = (place for place, other in enumerate(structures) if other.fits(system))
            known[system] = next(fitting, len(structures))
            if known[system] == len(structures):
                structures.append(system)
        groups[(known[system], stretch.integrator.order, *stretch.asks)].append(number)
    return list(groups.values())


def _in_lanes(periods: Mapping[int, int], fewest: int) -> list[int]:
    """Those of machines that are alike, with their mesh periods by number, which run in lanes, longest first.

    Lanes take as long for one machine as for all: time is counted as if each period of theirs cost as much as
    `fewest` of a single run. The longest run singly where the other lanes would wait for them.
    """
    order = sorted(periods, key=lambda number: -periods[number])
    lengths = [periods[number] for number in order]
    singly = [*range(min(WIDTH, len(order))), len(order)]
    costs = [sum(lengths[:count]) + fewest * _busy(lengths[count:], WIDTH) for count in singly]
    return order[singly[costs.index(min(costs))] :]


def _busy(lengths: Sequence[int], lanes: int) -> int:
    """How long lanes are busy with runs of these lengths, each of which takes the lane that is free first."""
    ends = [0] * lanes
    for length in lengths:
        heapreplace(ends, ends[0] + length)
    return max(ends)


def _alone(stretch: Stretch, kept: int | None) -> RunResult | NotConverged:
    try:
        run = stretch.run()
    except NotConverged as failure:
        return failure
    return run if kept is None else replace(run, ends=run.ends[max(stretch.periods - kept, 0) :])


def _side_by_side(stretches: Sequence[Stretch], kept: int | None) -> list[RunResult | NotConverged]:
    """Runs of machines of one structure that are asked for the same."""
    first, periods = stretches[0], [stretch.periods for stretch in stretches]
    integrators = [stretch.integrator for stretch in stretches]
    log = run_machines(
        make_runner(first.integrator.system, first.integrator.order, many=True),
        integrators,
        [stretch.state for stretch in stretches],
        periods,
        kept=max(periods) if kept is None else kept,
        tangents=np.array([stretch.disturbances for stretch in stretches]),
        samples=first.samples,
        batches=first.batches,
        growth=first.growth,
        fine=first.tangents is not None,
    )
    return [_result(log, number, stretch) for number, stretch in enumerate(stretches)]


def _result(log: motion.Log, number: int, stretch: Stretch) -> RunResult | NotConverged:
    """What a machine of a run has left."""
    try:
        return result_of(log, number, stretch.integrator, stretch.periods)
    except NotConverged as failure:
        return failure
