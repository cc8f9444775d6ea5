"""A disturbance of each motion that runs side by side, moved over the steps with the slopes of the forces."""

import numpy as np

from facegear.dynamics.abreast.kernel import called, inlined
from facegear.dynamics.abreast.lanes import Lanes
from facegear.dynamics.abreast.rows import JACOBIAN, WEIGHTS, Structure
from facegear.dynamics.abreast.taylor import deflect, move, recurrence
from facegear.dynamics.abreast.wide import load, splat, store, subtract, where_positive
from facegear.machine_code.lanes import take
from facegear.machine_code.vectors import multiply, multiply_add


@called
def move_tangents(shape: Structure, lanes: Lanes) -> None:
    """Move the disturbances to the ends of the steps whose coefficients the lanes hold."""
    if not shape.damping_when_open:
        _switch(shape, lanes)
    for row in range(2):
        deflect(shape, lanes, lanes.turn, lanes.turned, row, True)
    recurrence(shape, lanes, lanes.turn, lanes.turned, True)
    move(shape, lanes, lanes.turn)


@inlined
def _switch(shape: Structure, lanes: Lanes) -> None:
    """Saltation, as in the single integrator: where mesh damping starts or stops the velocities shear."""
    at = shape.offsets[JACOBIAN]
    for m in range(shape.m):
        acting = load(lanes.acting, m)
        jump = where_positive(load(lanes.fresh, 0), splat(0.0), subtract(load(lanes.was_acting, m), acting))
        store(lanes.was_acting, m, acting)
        along = splat(0.0)
        for e in range(take(shape.starts, m), take(shape.starts, m + 1)):
            along = multiply_add(load(lanes.values, at + e), load(lanes.turn, take(shape.columns, e)), along)
        along = multiply(jump, along)
        for e in range(take(shape.starts, m), take(shape.starts, m + 1)):
            row = shape.n + take(shape.columns, e)
            store(lanes.turn, row, multiply_add(load(lanes.values, at + e), along, load(lanes.turn, row)))


@inlined
def shorten(shape: Structure, lanes: Lanes, lane: int) -> float:
    """Length of the disturbance in a lane, which is divided by it."""
    total = 0.0
    for k in range(shape.n):
        weight = lanes.values[shape.offsets[WEIGHTS] + k, lane]
        displacement, velocity = weight * lanes.turn[0, k, lane], weight * lanes.turn[1, k, lane]
        total += displacement * displacement + velocity * velocity
    length = np.sqrt(total)
    for k in range(shape.n):
        lanes.turn[0, k, lane] /= length
        lanes.turn[1, k, lane] /= length
    return float(length)
