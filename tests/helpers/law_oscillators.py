"""One body on a law of contact: its free motion against a closed form, and its periodic orbits."""

from dataclasses import replace

import numpy as np
from oscillators import one_degree

from facegear.motion.branches.family import Family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import at_parameter
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import State


def oscillator(law, damping=0.0, amplitude=0.0, mean=1.0, lower=-np.inf, upper=0.0):
    """x'' + 2 z x' + F(phase, x) = mean + Fa cos W t."""
    load = ((0.0, 0.0), (mean, amplitude))
    return replace(one_degree(2.0 * damping, load=load, lower=lower, upper=upper), law=law)


def closing_error(law, start, period, least):
    """Larger error of free motion from rest at `start`: of its state after a period or its lowest point."""
    integrator = Integrator(oscillator(law), 2.0 * np.pi / period, 1e-14)
    state = np.array([[start], [0.0]])
    run = integrator.run(state, 1, batches=1)
    return max(np.abs(run.state - state).max(), abs(run.sums.minimum[0] - least))


def law_period_map(law, damping, amplitude=0.0, tolerance=1e-12, mean=1.0):
    system = oscillator(law, damping, amplitude, mean)
    return PeriodMap(Family("W", lambda speed: (system, speed)), 1, tolerance)


def orbit(period_map, speed, place, rate):
    u = float(np.log(speed))
    return at_parameter(period_map, period_map.to_weighted(State(np.array([place]), np.array([rate])), u), u)
