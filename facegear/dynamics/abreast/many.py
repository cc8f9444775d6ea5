"""Runs of many machines over whole mesh periods, side by side where the lanes have their physics."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace
from heapq import heapreplace
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.abreast.rows import Row, may_run_abreast, row_of
from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.integrator.integrator import Integrator, RunResult, require
from facegear.dynamics.integrator.sums import Sums, make_sums
from facegear.dynamics.stretch import Stretch
from facegear.errors import NotConverged
from facegear.machine_code.versions import NUMBA_IS_KNOWN

if TYPE_CHECKING:
    from facegear.dynamics.abreast.run import Queue

FEWEST = 5
"""Machines of one structure that pay for lanes: all lanes together take as long as three to five runs."""

_ROWS: WeakKeyDictionary[Integrator, Row | None] = WeakKeyDictionary()
"""Rows of the integrators in use, which run stretch by stretch."""


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

    Machines of one structure that are asked for the same run side by side; those that have, or are asked for,
    what the lanes have not, and those of which there are fewer than `fewest`, run one after the other. kept:
    as in run_many().
    """
    if len(stretches) < fewest:
        return [_alone(stretch, kept) for stretch in stretches]
    runs: dict[int, RunResult | NotConverged] = {}
    groups: dict[tuple[object, ...], list[int]] = defaultdict(list)
    rows = {id(each): _row_of(each) for each in {stretch.integrator for stretch in stretches}}
    for number, stretch in enumerate(stretches):
        row = rows[id(stretch.integrator)]
        if row is not None and (stretch.tangents is None or len(stretch.tangents) == 1):
            groups[(stretch.integrator.order, *row.key, *stretch.asks)].append(number)
    for alike in groups.values():
        if numbers := _in_lanes({number: stretches[number].periods for number in alike}, fewest):
            group = [stretches[number] for number in numbers]
            of_group = [row for stretch in group if (row := rows[id(stretch.integrator)])]
            runs |= zip(numbers, _side_by_side(of_group, group, kept), strict=True)
    return [
        runs[number] if number in runs else _alone(stretch, kept) for number, stretch in enumerate(stretches)
    ]


def _in_lanes(periods: Mapping[int, int], fewest: int) -> list[int]:
    """Those of machines that are alike, with their mesh periods by number, which run in lanes, longest first.

    Lanes take as long for one machine as for all: time is counted as if each period of theirs cost as much as
    `fewest` of a single run. The longest run singly where the other lanes would wait for them.
    """
    # The lanes are compiled only where they are asked for.
    from facegear.dynamics.abreast.wide import WIDTH

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


def _row_of(integrator: Integrator) -> Row | None:
    """The row of a machine, None where the lanes have not its physics."""
    if integrator not in _ROWS:
        fit = NUMBA_IS_KNOWN and may_run_abreast(integrator.packed)
        _ROWS[integrator] = row_of(integrator.packed, integrator.tolerance) if fit else None
    return _ROWS[integrator]


def _alone(stretch: Stretch, kept: int | None) -> RunResult | NotConverged:
    try:
        run = stretch.run()
    except NotConverged as failure:
        return failure
    return run if kept is None else replace(run, ends=run.ends[max(stretch.periods - kept, 0) :])


def _side_by_side(
    rows: list[Row], stretches: list[Stretch], kept: int | None
) -> list[RunResult | NotConverged]:
    """Runs of machines of one structure that are asked for the same."""
    from facegear.dynamics.abreast.lanes import make_lanes
    from facegear.dynamics.abreast.run import Queue, run_abreast
    from facegear.dynamics.abreast.sums import many_sums

    shape, count, first = rows[0].structure, len(rows), stretches[0]
    n, m, disturbed = shape.n, shape.m, first.tangents is not None
    periods = np.array([stretch.periods for stretch in stretches])
    longest = int(periods.max())
    queue = Queue(
        rows=np.array([row.values for row in rows]),
        starts=np.array([stretch.state for stretch in stretches]),
        periods=periods,
        tangents=np.array([part for stretch in stretches for part in stretch.disturbances]).reshape(-1, 2, n),
        longest=np.array([_longest_step(stretch) for stretch in stretches]),
        per_period=first.samples,
        batches=first.batches,
        ends=np.empty((count, longest if kept is None else min(kept, longest), 2, n)),
        samples=np.empty((count, longest * first.samples, n)),
        growth=np.empty((count if disturbed and first.growth else 0, longest)),
        sums=many_sums(count, n, m, first.batches),
        steps=np.zeros(count, dtype=np.int64),
        status=np.zeros(count, dtype=np.int64),
    )
    run_abreast(shape, make_lanes(shape, first.integrator.order, first.integrator.work.nodes), queue)
    return [_result(queue, number, stretch) for number, stretch in enumerate(stretches)]


def _longest_step(stretch: Stretch) -> float:
    """The longest step, rad, that a run may take."""
    return np.inf if stretch.tangents is None else stretch.integrator.longest_step


def _result(queue: "Queue", number: int, stretch: Stretch) -> RunResult | NotConverged:
    """What a machine of a queue has left."""
    try:
        require(int(queue.status[number]))
    except NotConverged as failure:
        return failure
    integrator, periods = stretch.integrator, stretch.periods
    ends = queue.ends[number, :periods]
    summed = stretch.batches > 0
    turned = queue.tangents[number, None] if len(queue.tangents) else np.zeros((0, 2, integrator.size))
    fractions = queue.sums.fractions[number] if summed else np.zeros((3, integrator.rows))
    return RunResult(
        state=ends[-1],
        ends=ends,
        tangents=turned,
        samples=queue.samples[number, : periods * queue.per_period],
        fractions=fractions / (TAU * periods),
        divergence=np.nan,
        growth=queue.growth[number, :periods] if len(queue.growth) else np.zeros(0),
        steps=int(queue.steps[number]),
        sums=_sums(queue, number) if summed else make_sums(integrator.packed, 0),
    )


def _sums(queue: "Queue", number: int) -> Sums:
    return Sums(**{name: getattr(queue.sums, name)[number] for name in Sums._fields})
