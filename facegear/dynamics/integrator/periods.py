"""Run whole mesh periods: samples, fractions of time in contact, tangents."""

import math
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.integrator.advance import advance, after, move
from facegear.dynamics.integrator.compiled import TAU, Packed
from facegear.dynamics.integrator.contact_states import flank_of
from facegear.dynamics.integrator.dense import Extrema, Steps, add_extrema, keep_step
from facegear.dynamics.integrator.kernel import inlined, longest
from facegear.dynamics.integrator.parting import shearing_damping
from facegear.dynamics.integrator.rings import ring_slopes, ring_trace
from facegear.dynamics.integrator.sums import Sums, add_step, start_sums
from facegear.dynamics.integrator.tangents import move_tangents, switch_tangents, tangent_step
from facegear.dynamics.integrator.taylor import values
from facegear.dynamics.integrator.work import Work
from facegear.machine_code.records import Record
from facegear.mesh_law.terms import slope_terms

MAX_STEPS = 2_000_000
DONE, TOO_MANY_STEPS, NOT_FINITE = 0, 1, 2


@Record.register
class Log(NamedTuple):
    """What a run writes.

    samples (periods * per_period, n): y at equally spaced phases from the start of each period.
    ends (periods, 2, n): y and dy/ds at the end of each period. fractions (3, m): phase spent open, on the
    drive and on the back flank, rad, added up with samples, sums or tangents; where the two flanks of a mesh
    stand for themselves the third row holds, at its drive flank, how long both touch. divergence
    (1,): integral of the trace, added up with tangents. growth (periods,): logarithm of the first tangent's
    length in each period, brought back to one after it. steps (1,): added up. sums: integrals and extremes.
    kept: the first steps' polynomials.
    """

    samples: Array
    ends: Array
    fractions: Array
    divergence: Array
    growth: Array
    steps: Integers
    sums: Sums
    kept: Steps
    extrema: Extrema


@longest
def run_periods(
    packed: Packed,
    work: Work,
    displacement: Array,
    velocity: Array,
    tangents: Array,
    periods: int,
    per_period: int,
    tolerance: float,
    log: Log,
    longest: float,
    begin: float,
) -> int:
    """Move displacement and velocity (n,) and the tangents (columns, 2, n) over whole periods.

    Returns a status. The step is chosen for the motion alone where `longest` is infinite. Tangents need
    disturbance_step() there, since a motion at rest says nothing about what its disturbances need. The first
    period is entered at the phase `begin`, which must be 0 where samples are asked for.
    """
    n = packed.omega_squared.size
    sample, acting = work.sample, work.was_acting
    batches = log.sums.coordinates.shape[0]
    turns = log.extrema.values.shape[2]
    for period in range(periods):
        first = period == 0
        s = begin if first else 0.0
        taken = 0
        next_sample = 0
        while s < TAU:
            length = advance(packed, work, s, min(TAU, s + longest), displacement, velocity, tolerance)
            if longest < np.inf and turns == 0:
                slope_terms(packed.law, work.law, work.state, work.deflection, work.order)
                length = tangent_step(packed, work, length, tolerance)
            if tangents.shape[0] > 0:
                if not first:
                    switch_tangents(packed, work, acting, tangents)
                for m in range(acting.size):
                    acting[m] = shearing_damping(packed, work, m)
                for m in range(packed.contacts, packed.m):
                    acting[m] = work.active[m]
                ring_slopes(packed.rings, work.rings, work.order)
                move_tangents(packed, work, length, tangents, tolerance)
                of_rings = ring_trace(packed.rings, work.rings, packed, work, length)
                log.divergence[0] -= length * _trace(packed, work) + of_rings
            if batches > 0:
                if first:
                    start_sums(packed, work, log.sums)
                add_step(packed, work, length, log.sums, period * batches // periods)
            first = False
            if per_period > 0 or batches > 0 or tangents.shape[0] > 0:
                for m in range(packed.m):
                    log.fractions[flank_of(work.state[m]), m] += length
                for m in range(packed.pairs):
                    if work.state[m] > 0 and work.state[m + packed.pairs] > 0:
                        log.fractions[2, m] += length
            while next_sample < per_period and TAU * next_sample / per_period < s + length:
                ahead = TAU * next_sample / per_period - s
                values(work.y, work.order, ahead, sample)
                for k in range(n):
                    log.samples[period * per_period + next_sample, k] = sample[k]
                next_sample += 1
            if turns > 0:
                add_extrema(packed, work, length, log.extrema)
            if log.steps[0] + taken < log.kept.starts.size:
                keep_step(packed, work, s, length, log.kept, log.steps[0] + taken)
            move(work, length, displacement, velocity)
            s = after(s, length)
            taken += 1
            if taken > MAX_STEPS:
                return TOO_MANY_STEPS
        log.steps[0] += taken
        total = 0.0
        for k in range(n):
            log.ends[period, 0, k] = displacement[k]
            log.ends[period, 1, k] = velocity[k]
            total += displacement[k] + velocity[k]
        if log.growth.size > 0:
            log.growth[period] = np.log(_shorten(packed, tangents[0]))
        if not np.isfinite(total):
            return NOT_FINITE
    return DONE


def disturbance_step(fastest: float, order: int, tolerance: float) -> float:
    """Step at which the last Taylor term of the fastest disturbance is a hundred times the tolerance.

    The fastest are the most damped; one of half its frequency is then below the tolerance at any order used.
    """
    logarithm = math.log(min(100.0 * tolerance, 0.01))
    for i in range(2, order + 1):
        logarithm += math.log(i)
    return math.exp(logarithm / order) / fastest


@inlined
def _shorten(packed: Packed, tangent: Array) -> float:
    """Length of a tangent (2, n), which is divided by it."""
    total = 0.0
    for i in range(2):
        for k in range(packed.n):
            along = packed.weights[k] * tangent[i, k]
            total += along * along
    length = np.sqrt(total)
    for i in range(2):
        for k in range(packed.n):
            tangent[i, k] /= length
    return length


@inlined
def _trace(packed: Packed, work: Work) -> float:
    """Sum of all damping that acts, per rad: minus the divergence of the flow."""
    total = 0.0
    for k in range(packed.n):
        total += packed.damping[k]
    for m in range(packed.m):
        total += work.acting[m] * packed.leverage[m]
    return total
