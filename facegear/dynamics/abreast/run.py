"""Run whole mesh periods of many machines, as many at a time as there are lanes."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.abreast.contact_states import correct_states, find_states
from facegear.dynamics.abreast.functions import SMALLEST, exponential, logarithm
from facegear.dynamics.abreast.kernel import inlined, longest
from facegear.dynamics.abreast.lanes import Lanes
from facegear.dynamics.abreast.rows import SCALE, WEIGHTS, Structure
from facegear.dynamics.abreast.switches import until_switch
from facegear.dynamics.abreast.taylor import deflect, excitation, move, recurrence
from facegear.dynamics.abreast.wide import (
    WIDTH,
    divide,
    larger,
    load,
    magnitude,
    multiply,
    multiply_add,
    smaller,
    splat,
    store,
    subtract,
    where_positive,
)
from facegear.dynamics.integrator.advance import MAX_GUESSES, ROUNDING
from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.integrator.periods import DONE, MAX_STEPS, NOT_FINITE, TOO_MANY_STEPS

NONE = -1


class Queue(NamedTuple):
    """Machines that wait for a lane, and what they leave.

    rows (machines, P), starts (machines, 2, n) by phase; ends (machines, periods, 2, n), steps (machines,)
    and status (machines,) are written.
    """

    rows: Array
    starts: Array
    ends: Array
    steps: Integers
    status: Integers


@longest
def run_abreast(shape: Structure, lanes: Lanes, queue: Queue, tolerance: float) -> None:
    """Run every machine of a queue over its periods."""
    waiting = 0
    running = 0
    for lane in range(WIDTH):
        waiting, running = _refill(shape, lanes, queue, lane, waiting, running)
    if running == 0:
        return
    for lane in range(WIDTH):
        if lanes.number[lane] == NONE:
            _idle(shape, lanes, queue, lane)
    while running > 0:
        _advance(shape, lanes, tolerance)
        move(shape, lanes)
        for lane in range(WIDTH):
            if _at_end(shape, lanes, queue, lane):
                waiting, running = _refill(shape, lanes, queue, lane, waiting, running - 1)


@inlined
def _refill(
    shape: Structure, lanes: Lanes, queue: Queue, lane: int, waiting: int, running: int
) -> tuple[int, int]:
    """Give a lane the next machine; without any it goes on with what it has, and nothing is kept of it."""
    lanes.number[lane] = NONE
    if waiting == queue.rows.shape[0]:
        return waiting, running
    _enter(shape, lanes, queue, lane, waiting)
    lanes.number[lane] = waiting
    return waiting + 1, running + 1


@inlined
def _enter(shape: Structure, lanes: Lanes, queue: Queue, lane: int, number: int) -> None:
    """Put a machine at its start into a lane."""
    for i in range(queue.rows.shape[1]):
        lanes.values[i, lane] = queue.rows[number, i]
    for k in range(shape.n):
        lanes.y[0, k, lane] = queue.starts[number, 0, k]
        lanes.y[1, k, lane] = queue.starts[number, 1, k]
    lanes.phase[lane] = 0.0
    lanes.period[lane] = 0
    lanes.taken[lane] = 0


@inlined
def _idle(shape: Structure, lanes: Lanes, queue: Queue, lane: int) -> None:
    """A lane that never had a machine repeats the first one."""
    _enter(shape, lanes, queue, lane, 0)


@inlined
def _advance(shape: Structure, lanes: Lanes, tolerance: float) -> None:
    """Expand the motions and write the step of each lane into `length`."""
    excitation(shape, lanes, lanes.order + 1)
    deflect(shape, lanes, 0)
    deflect(shape, lanes, 1)
    find_states(shape, lanes)
    for _ in range(MAX_GUESSES):
        recurrence(shape, lanes)
        if not (shape.opens and correct_states(shape, lanes)):
            break
    _step_lengths(shape, lanes, tolerance)
    until_switch(shape, lanes)


@inlined
def _step_lengths(shape: Structure, lanes: Lanes, tolerance: float) -> None:
    """Steps at which each of the last two terms is below the tolerance (Jorba and Zou 2005), none of them
    past the end of the period.
    """
    target = multiply(splat(tolerance), load(lanes.values, shape.offsets[SCALE]))
    smallest = splat(1e300)
    for i in range(lanes.order - 1, lanes.order + 1):
        size = splat(SMALLEST)
        for k in range(shape.n):
            weight = load(lanes.values, shape.offsets[WEIGHTS] + k)
            size = multiply_add(weight, magnitude(load(lanes.y, i * shape.n + k)), size)
        power = multiply(logarithm(divide(target, size)), splat(1.0 / i))
        smallest = smaller(smallest, power)
    length = exponential(larger(smaller(smallest, splat(600.0)), splat(-600.0)))
    rest = subtract(splat(TAU), load(lanes.phase, 0))
    half = multiply(splat(0.5), rest)
    shared = where_positive(subtract(length, half), half, length)
    store(lanes.length, 0, where_positive(subtract(rest, length), shared, rest))


@inlined
def _at_end(shape: Structure, lanes: Lanes, queue: Queue, lane: int) -> bool:
    """Move the phase of a lane, write the state at the end of a period; True if its machine is done."""
    phase = lanes.phase[lane] + lanes.length[lane]
    lanes.taken[lane] += 1
    number = lanes.number[lane]
    stuck = number != NONE and lanes.taken[lane] > MAX_STEPS
    if TAU - phase >= ROUNDING and not stuck:
        lanes.phase[lane] = phase
        return False
    lanes.phase[lane] = 0.0
    if number == NONE:
        return False
    period, total = lanes.period[lane], 0.0
    for k in range(shape.n):
        queue.ends[number, period, 0, k] = lanes.y[0, k, lane]
        queue.ends[number, period, 1, k] = lanes.y[1, k, lane]
        total += lanes.y[0, k, lane] + lanes.y[1, k, lane]
    queue.steps[number] += lanes.taken[lane]
    lanes.taken[lane] = 0
    lanes.period[lane] = period + 1
    status = TOO_MANY_STEPS if stuck else DONE if np.isfinite(total) else NOT_FINITE
    queue.status[number] = status
    return status != DONE or period + 1 == queue.ends.shape[1]
