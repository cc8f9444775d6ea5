"""Run whole mesh periods of many machines, as many at a time as there are lanes.

Each lane has its own phase and step, so that it switches contacts where its own machine does; the next
machine enters as soon as one is done.
"""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.abreast.contact_states import correct_states, find_states
from facegear.dynamics.abreast.functions import SMALLEST, exponential, logarithm
from facegear.dynamics.abreast.kernel import called, inlined, longest
from facegear.dynamics.abreast.lanes import NONE, Lanes
from facegear.dynamics.abreast.rows import SCALE, TOLERANCE, WEIGHTS, Structure
from facegear.dynamics.abreast.sums import ManySums, add_step, clear, keep_batch, keep_whole
from facegear.dynamics.abreast.switches import until_switch
from facegear.dynamics.abreast.tangents import move_tangents, shorten
from facegear.dynamics.abreast.taylor import deflect, excitation, move, recurrence, values
from facegear.dynamics.abreast.wide import WIDTH, divide, load, splat, store, subtract, where_positive
from facegear.dynamics.integrator.advance import MAX_GUESSES, ROUNDING
from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.integrator.periods import DONE, MAX_STEPS, NOT_FINITE, TOO_MANY_STEPS
from facegear.machine_code.records import Record
from facegear.machine_code.vectors import larger, magnitude, multiply, multiply_add, smaller


@Record.register
class Queue(NamedTuple):
    """Machines that wait for a lane, and what they leave.

    rows (machines, P), starts (machines, 2, n) by phase, periods (machines,) of each. tangents (machines, 2,
    n), or none: disturbances, moved along; longest (machines,): step, rad. Written are the states at the ends
    of the last periods, ends (machines, kept, 2, n), coordinates at evenly spaced phases from the start of
    each period, samples (machines, periods * per_period, n), logarithms of the growth of the disturbance in
    each period, growth (machines, periods), which is brought back to length one after it, or none, sums over
    batches of the periods, steps (machines,) and status (machines,).
    """

    rows: Array
    starts: Array
    periods: Integers
    tangents: Array
    longest: Array
    per_period: int
    batches: int
    ends: Array
    samples: Array
    growth: Array
    sums: ManySums
    steps: Integers
    status: Integers


@longest
def run_abreast(shape: Structure, lanes: Lanes, queue: Queue) -> None:
    """Run every machine of a queue over its periods."""
    waiting, running = 0, 0
    for lane in range(WIDTH):
        waiting, running = _refill(shape, lanes, queue, lane, waiting, running)
    while running > 0:
        _advance(shape, lanes)
        if queue.tangents.shape[0] > 0:
            move_tangents(shape, lanes)
        if queue.batches > 0:
            add_step(shape, lanes)
        if queue.per_period > 0:
            _sample(shape, lanes, queue)
        move(shape, lanes, lanes.y)
        store(lanes.fresh, 0, splat(0.0))
        for lane in range(WIDTH):
            if _at_end(shape, lanes, queue, lane):
                waiting, running = _refill(shape, lanes, queue, lane, waiting, running - 1)


@inlined
def _refill(
    shape: Structure, lanes: Lanes, queue: Queue, lane: int, waiting: int, running: int
) -> tuple[int, int]:
    """Give a lane the next machine. Without any it starts again with the first, and nothing is kept of it."""
    lanes.number[lane] = NONE
    if waiting == queue.rows.shape[0]:
        _enter(shape, lanes, queue, lane, 0)
        return waiting, running
    _enter(shape, lanes, queue, lane, waiting)
    lanes.number[lane] = waiting
    return waiting + 1, running + 1


@called
def _enter(shape: Structure, lanes: Lanes, queue: Queue, lane: int, number: int) -> None:
    """Put a machine at its start into a lane."""
    for i in range(queue.rows.shape[1]):
        lanes.values[i, lane] = queue.rows[number, i]
    for k in range(shape.n):
        lanes.y[0, k, lane] = queue.starts[number, 0, k]
        lanes.y[1, k, lane] = queue.starts[number, 1, k]
    if queue.tangents.shape[0] > 0:
        for k in range(shape.n):
            lanes.turn[0, k, lane] = queue.tangents[number, 0, k]
            lanes.turn[1, k, lane] = queue.tangents[number, 1, k]
    if queue.batches > 0:
        clear(shape, lanes, lane)
    lanes.longest[lane] = queue.longest[number]
    lanes.fresh[lane] = 1.0
    lanes.phase[lane] = 0.0
    lanes.period[lane] = 0
    lanes.taken[lane] = 0
    lanes.sampled[lane] = 0


@inlined
def _advance(shape: Structure, lanes: Lanes) -> None:
    """Expand the motions and write the step of each lane into `length`."""
    excitation(shape, lanes, lanes.order + 1)
    for row in range(2):
        deflect(shape, lanes, lanes.y, lanes.deflection, row, False)
    find_states(shape, lanes)
    for _ in range(MAX_GUESSES):
        recurrence(shape, lanes, lanes.y, lanes.deflection, False)
        if not (shape.opens and correct_states(shape, lanes)):
            break
    _step_lengths(shape, lanes)
    until_switch(shape, lanes)


@inlined
def _step_lengths(shape: Structure, lanes: Lanes) -> None:
    """Steps at which each of the last two terms is below the tolerance (Jorba and Zou 2005), none of them
    past the end of the period, or longer than it may be.
    """
    tolerance = load(lanes.values, shape.offsets[TOLERANCE])
    target = multiply(tolerance, load(lanes.values, shape.offsets[SCALE]))
    smallest = splat(1e300)
    for i in range(lanes.order - 1, lanes.order + 1):
        size = splat(SMALLEST)
        for k in range(shape.n):
            weight = load(lanes.values, shape.offsets[WEIGHTS] + k)
            size = multiply_add(weight, magnitude(load(lanes.y, i * shape.n + k)), size)
        power = multiply(logarithm(divide(target, size)), splat(1.0 / i))
        smallest = smaller(smallest, power)
    length = exponential(larger(smaller(smallest, splat(600.0)), splat(-600.0)))
    rest = smaller(subtract(splat(TAU), load(lanes.phase, 0)), load(lanes.longest, 0))
    half = multiply(splat(0.5), rest)
    shared = where_positive(subtract(length, half), half, length)
    store(lanes.length, 0, where_positive(subtract(rest, length), shared, rest))


@called
def _sample(shape: Structure, lanes: Lanes, queue: Queue) -> None:
    """Write the coordinates at all samples that lie within the steps, one of each lane at a time."""
    while True:
        pending = 0
        for lane in range(WIDTH):
            ahead = TAU * lanes.sampled[lane] / queue.per_period - lanes.phase[lane]
            inside = lanes.sampled[lane] < queue.per_period and ahead < lanes.length[lane]
            due = inside and lanes.number[lane] != NONE
            lanes.ahead[lane] = ahead if due else -1.0
            pending += due
        if pending == 0:
            return
        values(shape, lanes)
        for lane in range(WIDTH):
            if lanes.ahead[lane] == -1.0:
                continue
            row = lanes.period[lane] * queue.per_period + lanes.sampled[lane]
            for k in range(shape.n):
                queue.samples[lanes.number[lane], row, k] = lanes.sample[k, lane]
            lanes.sampled[lane] += 1


@called
def _at_end(shape: Structure, lanes: Lanes, queue: Queue, lane: int) -> bool:
    """Move the phase of a lane; at the end of a period write its state. True if its machine is done."""
    phase = lanes.phase[lane] + lanes.length[lane]
    lanes.taken[lane] += 1
    number = lanes.number[lane]
    stuck = number != NONE and lanes.taken[lane] > MAX_STEPS
    if TAU - phase >= ROUNDING and not stuck:
        lanes.phase[lane] = phase
        return False
    lanes.phase[lane] = 0.0
    grown = shorten(shape, lanes, lane) if queue.growth.shape[0] > 0 else 1.0
    if number == NONE:
        return False
    if queue.growth.shape[0] > 0:
        queue.growth[number, lanes.period[lane]] = np.log(grown)
    finite = _keep_end(shape, lanes, queue, lane)
    queue.steps[number] += lanes.taken[lane]
    lanes.period[lane] += 1
    lanes.taken[lane], lanes.sampled[lane] = 0, 0
    status = TOO_MANY_STEPS if stuck else DONE if finite else NOT_FINITE
    queue.status[number] = status
    done = lanes.period[lane] == queue.periods[number]
    if queue.batches > 0:
        _keep_sums(shape, lanes, queue, lane, done)
    if done and queue.tangents.shape[0] > 0:
        for k in range(shape.n):
            queue.tangents[number, 0, k] = lanes.turn[0, k, lane]
            queue.tangents[number, 1, k] = lanes.turn[1, k, lane]
    return status != DONE or done


@inlined
def _keep_sums(shape: Structure, lanes: Lanes, queue: Queue, lane: int, done: bool) -> None:
    """Write what a lane has added up where a batch of periods, or the last of them, is over."""
    run, periods = lanes.period[lane], queue.periods[lanes.number[lane]]
    batch = (run - 1) * queue.batches // periods
    if run * queue.batches // periods > batch:
        keep_batch(shape, lanes, queue.sums, lane, batch)
    if done:
        keep_whole(shape, lanes, queue.sums, lane)


@inlined
def _keep_end(shape: Structure, lanes: Lanes, queue: Queue, lane: int) -> bool:
    """Write the state at the end of a period if it is one of the last; False if it is not finite."""
    number, kept = lanes.number[lane], queue.ends.shape[1]
    row = lanes.period[lane] - max(queue.periods[number] - kept, 0)
    total = 0.0
    for k in range(shape.n):
        displacement, velocity = lanes.y[0, k, lane], lanes.y[1, k, lane]
        total += displacement + velocity
        if row >= 0:
            queue.ends[number, row, 0, k] = displacement
            queue.ends[number, row, 1, k] = velocity
    return bool(np.isfinite(total))
