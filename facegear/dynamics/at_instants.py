"""Compiled: what contacts and bearings do at the instants of a motion, in one pass over arrays of them."""

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine_code.compiler import FAST, compiler

OPTIONS = {**FAST, "error_model": "numpy"}


@compiler(**OPTIONS)
def add_ring_forces(
    displacement: Array,
    speed: Array,
    stiffness: Array,
    clearance: Array,
    lag: float,
    body: Integers,
    forces: Array,
) -> None:
    """Write forces (bodies, 3, K) along x and y of R bearings with clearance, whose springs act beyond it.

    displacement, speed (R, 2, K); stiffness, clearance, body (R,); lag: damping over stiffness, s.
    """
    for r in range(body.size):
        own, rim, b = stiffness[r], clearance[r], body[r]
        for k in range(displacement.shape[2]):
            x, y = displacement[r, 0, k], displacement[r, 1, k]
            dx, dy = speed[r, 0, k], speed[r, 1, k]
            distance = max(np.sqrt(x * x + y * y), rim)
            damped = lag if distance > rim else 0.0
            free = rim / distance
            turned = free * (x * dx + y * dy) / (distance * distance) * damped
            along, across = own * (1.0 - free + turned), own * (1.0 - free) * damped
            forces[b, 0, k] = along * x + across * dx
            forces[b, 1, k] = along * y + across * dy


@compiler(**OPTIONS)
def press_in(deflections: Array, errors: Array, lower: Array, upper: Array) -> None:
    """Turn deflections (M, B, K) of contacts over B mesh periods into how far they are pressed in: without
    the errors (K, M) of the period, above `upper`, or below `lower` as a negative amount.

    lower, upper (M,): a contact with lower >= upper is never open, both directions count from `upper`.
    """
    for m in range(deflections.shape[0]):
        above, below = upper[m], min(lower[m], upper[m])
        for b in range(deflections.shape[1]):
            for k in range(deflections.shape[2]):
                deflection = deflections[m, b, k] - errors[k, m]
                deflections[m, b, k] = deflection - min(max(deflection, below), above)


@compiler(**OPTIONS)
def split_loads(forces: Array, rounding: float, loads: Array) -> None:
    """Write loads (2 M, K) of drive flanks, then back flanks, of forces (M, K) that meshes transmit: nothing
    where a force is at most the part `rounding` of the largest of all.
    """
    meshes, count = forces.shape
    largest = 0.0
    for m in range(meshes):
        for k in range(count):
            largest = max(largest, abs(forces[m, k]))
    counted = rounding * largest
    for m in range(meshes):
        for k in range(count):
            force = forces[m, k]
            loads[m, k] = force if force > counted else 0.0
            loads[m + meshes, k] = -force if -force > counted else 0.0
