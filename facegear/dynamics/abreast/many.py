"""Runs of many machines over whole mesh periods, side by side where the lanes have their physics."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.abreast.rows import Row, may_run_abreast, row_of
from facegear.dynamics.integrator.integrator import Integrator, require
from facegear.machine_code.versions import NUMBA_IS_KNOWN

FEWEST = 3
"""Machines of one structure that pay for lanes: all lanes together take as long as two or three runs."""


@dataclass(frozen=True, eq=False)
class ManyRun:
    """What a run has left: states (kept, 2, n) at the ends of its last periods, coordinates
    (periods * samples, n) at evenly spaced phases from the start of each period, and the number of steps.
    """

    ends: Array
    samples: Array
    steps: int


def run_many(
    integrators: Sequence[Integrator],
    starts: Sequence[Array],
    periods: int,
    kept: int | None = None,
    samples: int = 0,
    fewest: int = FEWEST,
) -> list[ManyRun]:
    """Run machines from starts (2, n) by phase, with the steps and to the errors of `Integrator.run`.

    Machines of one structure run side by side; those that have what the lanes have not, and those of which
    there are fewer than `fewest`, run one after the other. kept: states of how many of the last periods are
    kept, None for all. Raises NotConverged if any of the runs fails.
    """
    kept = periods if kept is None else min(kept, periods)
    runs: dict[int, ManyRun] = {}
    groups: dict[tuple[object, ...], list[int]] = defaultdict(list)
    rows = {id(each): _row_of(each) for each in set(integrators)}
    for number, integrator in enumerate(integrators):
        row = rows[id(integrator)]
        if row is not None:
            groups[(integrator.order, *row.key)].append(number)
    for numbers in groups.values():
        if len(numbers) >= fewest:
            order = integrators[numbers[0]].order
            of_group = [row for number in numbers if (row := rows[id(integrators[number])])]
            from_starts = [starts[number] for number in numbers]
            done = _side_by_side(of_group, from_starts, order, periods, kept, samples)
            runs |= zip(numbers, done, strict=True)
    for number, integrator in enumerate(integrators):
        if number not in runs:
            run = integrator.run(starts[number], periods, samples=samples)
            runs[number] = ManyRun(run.ends[periods - kept :], run.samples, run.steps)
    return [runs[number] for number in range(len(integrators))]


def _row_of(integrator: Integrator) -> Row | None:
    """The row of a machine, None where the lanes have not its physics."""
    if not (NUMBA_IS_KNOWN and may_run_abreast(integrator.packed)):
        return None
    return row_of(integrator.packed, integrator.tolerance)


def _side_by_side(
    rows: list[Row], starts: list[Array], order: int, periods: int, kept: int, samples: int
) -> list[ManyRun]:
    """Runs of machines of one structure."""
    # The lanes are compiled only where they are asked for.
    from facegear.dynamics.abreast.lanes import make_lanes
    from facegear.dynamics.abreast.run import Queue, run_abreast

    shape, count = rows[0].structure, len(rows)
    queue = Queue(
        rows=np.array([row.values for row in rows]),
        starts=np.array(starts),
        periods=periods,
        per_period=samples,
        ends=np.empty((count, kept, 2, shape.n)),
        samples=np.empty((count, periods * samples, shape.n)),
        steps=np.zeros(count, dtype=np.int64),
        status=np.zeros(count, dtype=np.int64),
    )
    run_abreast(shape, make_lanes(shape, order), queue)
    for status in queue.status:
        require(int(status))
    return [
        ManyRun(ends, coordinates, int(steps))
        for ends, coordinates, steps in zip(queue.ends, queue.samples, queue.steps, strict=True)
    ]
