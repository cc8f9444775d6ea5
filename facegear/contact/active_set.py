"""The active set of a contact problem, compiled: see `facegear.contact.solver` for the problem itself."""

from pathlib import Path

import numpy as np

from facegear.arrays import Array, Mask
from facegear.contact import bonded as bonded_points
from facegear.contact.bonded import Bonded, bonded, distances, put, refined
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import mark_table, marks, numbers

compiled = compiler(Path(bonded_points.__file__), *picked.SOURCES)
called = for_callers(forceinline=False)

Solution = tuple[int, Array, float, float, float, Array]
"""Steps, forces (n,) N, rotation, slope and violation, and how the forces change with the torque (n,),
N/(N m), while the same points touch. Steps are 0 where there is none."""


@compiled
def newton(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    start: Mask,
    limits: tuple[int, float],
) -> Solution:
    """Primal-dual active set from the points `start` (n,), in at most `limits` steps to a tolerance.

    Where the sets repeat themselves, steps are 0 and the forces those of the last set, with tension in them.
    """
    steps, tolerance = limits
    active, count = start.copy(), gap.size
    seen = mark_table(steps, count)
    force = numbers(count, 0.0)
    for step in range(1, steps + 1):
        touching = bonded(compliance, gap, lever_arm, torque, active)
        rotation = touching[5]
        for i in range(count):
            force[i] = 0.0
        put(touching[4], touching[0], force)
        distance = distances(compliance, gap, lever_arm, force, rotation)
        turned = nearest = 0.0
        for i in range(count):
            turned = max(turned, abs(rotation * lever_arm[i]))
            if active[i]:
                nearest = max(nearest, abs(gap[i]))
        edge = -tolerance * (turned + nearest)
        following, same, drives = seen[step - 1], True, False
        for i in range(count):
            following[i] = force[i] > 0.0 if active[i] else distance[i] < edge
            same &= following[i] == active[i]
            drives |= following[i] and lever_arm[i] > 0.0
        if same:
            force, rotation, residual = refined(compliance, gap, lever_arm, torque, touching)
            return step, force, rotation, touching[6], residual, _change(touching, count)
        repeated = False
        for earlier in range(step - 1):
            repeated |= _alike(seen[earlier], following)
        if repeated or not drives:
            break
        for i in range(count):
            active[i] = following[i]
    return 0, force, 0.0, 0.0, 0.0, force


@called
def _change(touching: Bonded, count: int) -> Array:
    """How the forces (n,) of touching points change with the torque, N/(N m)."""
    change = numbers(count, 0.0)
    index, turning, slope = touching[0], touching[3], touching[6]
    for i in range(index.size):
        change[index[i]] = slope * turning[i]
    return change


@called
def _alike(first: Mask, second: Mask) -> bool:
    alike = True
    for i in range(first.size):
        alike &= first[i] == second[i]
    return alike


@compiled
def solved(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    start: Mask,
    limits: tuple[int, float],
) -> Solution:
    """`newton` and, where that fails, an exchange of one point at a time; steps are 0 if both fail."""
    begin = start
    if not _drives(start, lever_arm):
        begin = _first_guess(gap, lever_arm)
    solution = newton(compliance, gap, lever_arm, torque, begin, limits)
    if solution[0]:
        return solution
    pressing = feasible(gap, lever_arm, torque, solution[1])
    return _exchanged(compliance, gap, lever_arm, torque, pressing, limits)


@called
def _drives(active: Mask, lever_arm: Array) -> bool:
    drives = False
    for i in range(active.size):
        drives |= active[i] and lever_arm[i] > 0.0
    return drives


@called
def _turns(gap: Array, lever_arm: Array) -> Array:
    """Turns (n,) that close the gaps, inf where none does."""
    turns = numbers(gap.size, np.inf)
    for i in range(gap.size):
        if lever_arm[i] > 0.0:
            turns[i] = gap[i] / lever_arm[i]
    return turns


@called
def _first_guess(gap: Array, lever_arm: Array) -> Mask:
    """The quarter of the points whose gaps close first."""
    turns = _turns(gap, lever_arm)
    guess = marks(turns.size, False)
    closed, some = 0, 0
    for i in range(turns.size):
        some += turns[i] < np.inf
    while closed <= max(some - 1, 0) // 4:
        reached = np.inf
        for i in range(turns.size):
            if not guess[i]:
                reached = min(reached, turns[i])
        for i in range(turns.size):
            if not guess[i] and turns[i] <= reached:
                guess[i] = True
                closed += 1
    return guess


@compiled
def feasible(gap: Array, lever_arm: Array, torque: float, force: Array) -> Array:
    """Forces without tension that carry the torque: those given, or one where the gap closes first."""
    pressing, carried = numbers(force.size, 0.0), 0.0
    for i in range(force.size):
        pressing[i] = max(force[i], 0.0)
        carried += lever_arm[i] * pressing[i]
    turns, first = _turns(gap, lever_arm), 0
    for i in range(force.size):
        pressing[i] = pressing[i] * (torque / carried) if carried > 0.0 else 0.0
        if turns[i] < turns[first]:
            first = i
    if not carried > 0.0:
        pressing[first] = torque / lever_arm[first]
    return pressing


@compiled
def _exchanged(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    start: Array,
    limits: tuple[int, float],
) -> Solution:
    """One point at a time from feasible forces, energy falling at every step, hence finite. As `newton`."""
    force, active = start.copy(), marks(start.size, False)
    for i in range(start.size):
        active[i] = start[i] > 0.0
    for step in range(exchanges(gap.size)):
        touching = bonded(compliance, gap, lever_arm, torque, active)
        index, rotation = touching[0], touching[5]
        target = numbers(gap.size, 0.0)
        put(touching[4], index, target)
        fraction = np.inf
        for i in index:
            if target[i] <= 0.0:
                fraction = min(fraction, force[i] / (force[i] - target[i]))
        if fraction < np.inf:
            largest = 0.0
            for i in range(force.size):
                force[i] += fraction * (target[i] - force[i])
                largest = max(largest, force[i])
            for i in index:
                if target[i] <= 0.0 and force[i] <= 1e-14 * largest:
                    active[i] = False
            continue
        force = target
        distance = distances(compliance, gap, lever_arm, force, rotation)
        turned = nearest = 0.0
        worst = -1
        for i in range(gap.size):
            turned = max(turned, abs(rotation * lever_arm[i]))
            if active[i]:
                nearest = max(nearest, abs(gap[i]))
            elif worst < 0 or distance[i] < distance[worst]:
                worst = i
        if worst < 0 or distance[worst] >= -limits[1] * (turned + nearest):
            force, rotation, residual = refined(compliance, gap, lever_arm, torque, touching)
            change = _change(touching, gap.size)
            return limits[0] + step, force, rotation, touching[6], residual, change
        active[worst] = True
    return 0, force, 0.0, 0.0, 0.0, force


@compiled
def exchanges(count: int) -> int:
    """Exchanges of single points after which many points count as not solved."""
    return 20 * count + 100
