"""A stable periodic orbit of a machine, followed from speed to speed until it is lost."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.system import System
from facegear.dynamics.motion import Settings, State
from facegear.dynamics.steady_state.orbits import UNIT_TOLERANCE, Orbit, shoot
from facegear.dynamics.steady_state.simulate import Model
from facegear.errors import NotConverged
from facegear.transmission.machine import mesh_frequency

FINE = 1e-8
"""Tolerance of a step, in length scales: special points are then exact to 1e-6 of the speed or better."""
PARTS = 8
"""A range of speeds is searched in at least so many steps, so that a short unstable part is not skipped."""
NEAR = 0.2
"""Largest change of an orbit's state in one step, in length scales; else the step is halved. Another orbit
that Newton's method may come to lies farther away, or the step is halved until it does."""


@dataclass(frozen=True, eq=False)
class HeldOrbit:
    """An orbit of `period` mesh periods at a speed (rpm), and its state."""

    speed: float
    period: int
    state: State


def machine_follower(model: Model, settings: Settings) -> "OrbitFollower":
    """Return what follows the orbits of a machine over the speed of its pinions, rpm."""
    return OrbitFollower(
        lambda speed: (model.system, TAU * mesh_frequency(model.machine.layout, speed)), settings
    )


@dataclass(frozen=True, eq=False)
class OrbitFollower:
    """Follows periodic orbits over a speed.

    Attributes
    ----------
    at
        The system at a speed, and its angular mesh frequency, rad/s.
    settings
        With which the motion is sought; steps are at least as fine as FINE.
    """

    at: Callable[[float], tuple[System, float]]
    settings: Settings

    def orbit(self, speed: float, state: State, period: int) -> HeldOrbit | None:
        """Return the stable orbit at a speed next to a state of a motion with a period; None if there is none
        or the period is 0.
        """
        return self._stable(speed, state, period) if period else None

    def until_lost(self, orbit: HeldOrbit, end: float, resolution: float) -> tuple[HeldOrbit, float | None]:
        """Return the last orbit that is found stable on the way to a speed, and the speed (rpm), at most
        `resolution` beyond it, at which it is not; None in place of it if it is stable up to the end.
        """
        step = (end - orbit.speed) / PARTS
        while orbit.speed != end:
            left = end - orbit.speed
            target = end if abs(left) <= 1.001 * abs(step) else orbit.speed + step
            stable = self._stable(target, orbit.state, orbit.period)
            if stable is not None:
                orbit = stable
            elif abs(target - orbit.speed) <= resolution:
                return orbit, target
            else:
                step *= 0.5
        return orbit, None

    def aside(self, last: HeldOrbit, speed: float, kick: float) -> State:
        """Return a start at a speed at which an orbit is lost.

        It lies beside the orbit, by a distance `kick` in length scales along its leading direction, where the
        orbit goes on unstable; else it is the last state of the orbit.
        """
        integrator, orbit = self._near(speed, last.state, last.period)
        if orbit is None:
            return last.state
        off = orbit.leaving(integrator, 0.0 * orbit.state)
        return integrator.by_time(orbit.state + kick * off)

    def _stable(self, speed: float, state: State, period: int) -> HeldOrbit | None:
        """The stable orbit of a period at a speed near a state."""
        integrator, orbit = self._near(speed, state, period)
        if orbit is None or abs(orbit.multipliers[0]) > 1.0 + UNIT_TOLERANCE:
            return None
        return HeldOrbit(speed, period, integrator.by_time(orbit.state))

    def _near(self, speed: float, state: State, period: int) -> tuple[Integrator, Orbit | None]:
        """The orbit of a period at a speed to which a state belongs, stable or not, with its integrator."""
        system, frequency = self.at(speed)
        integrator = Integrator(system, frequency, min(self.settings.tolerance, FINE))
        start = integrator.by_phase(state)
        try:
            orbit = shoot(integrator, start, period, self.settings.periodic_residual)
        except (NotConverged, np.linalg.LinAlgError):
            return integrator, None
        if orbit is None or orbit.period != period or orbit.distance(integrator, start) > NEAR:
            return integrator, None
        return integrator, orbit
