"""A stable periodic orbit of a machine, followed from speed to speed until it is lost."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers
from facegear.errors import NotConverged
from facegear.machine.machine import mesh_frequency
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.integrator.system import System
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.mesh_samples import by_mesh, each_deflection
from facegear.motion.steady_state.orbits import UNIT_TOLERANCE, Orbit, shoot
from facegear.motion.steady_state.simulate import Model

FLOOR = 1e-3
"""Fraction of the largest AC RMS below which no AC RMS is compared."""
MIN_CHANGE = 0.1
"""Relative change of a mesh's AC RMS that may be a jump."""
SAME_ORBIT = 5e-3
"""Relative difference of the AC RMS of periodic motions that counts as the same orbit."""


def distance(first: Array, second: Array) -> float:
    """Return the largest ratio between two sets of AC RMS over all meshes, as the magnitude of its
    natural logarithm.

    Values below FLOOR times the largest of both sets count as this floor.

    Parameters
    ----------
    first, second : (meshes,) array
        AC RMS of each mesh, m.

    Returns
    -------
    float
        Logarithm of the ratio, dimensionless.
    """
    floor = FLOOR * max(first.max(), second.max(), 1e-300)
    return float(np.abs(np.log(np.maximum(first, floor) / np.maximum(second, floor))).max())


def image_distance(first: Array, second: Array, images: Integers) -> float:
    """Return the smallest distance() of one set of AC RMS from the mirror images of another.

    Parameters
    ----------
    first, second : (meshes,) array
        AC RMS of each mesh, m.
    images : (images, meshes) array
        Permutations of the meshes by symmetry, as indices.

    Returns
    -------
    float
        Logarithm of the ratio, dimensionless.
    """
    return min(distance(first, second[image]) for image in images)


FINE = 1e-8
"""Tolerance of a step, in length scales: special points are then exact to 1e-6 of the speed or better."""
PARTS = 2
"""Least number of steps in which a range of speeds is searched, so that a short unstable part is not
skipped.
"""
NEAR = 0.2
"""Largest change of an orbit's state in one step, in length scales; else the step is halved."""
SMOOTH = 0.95 * MIN_CHANGE
"""Largest relative change of a mesh's AC RMS in one step; else the step is halved.

If it changes by more within the resolution, Newton's method came to another orbit across a fold.
"""
SAMPLES = 256
"""Number of samples in a mesh period for the AC RMS, which errs by less than 1e-3."""


@dataclass(frozen=True, eq=False)
class HeldOrbit:
    """A stable orbit at one speed.

    Attributes
    ----------
    speed : float
        Pinion speed, rpm.
    period : int
        Number of mesh periods.
    state : State
        State on the orbit at the start of a mesh period.
    ac_rms : (meshes,) array
        AC RMS of the mesh deflections, m.
    multiplier : float
        Magnitude of the leading multiplier.
    """

    speed: float
    period: int
    state: State
    ac_rms: Array
    multiplier: float


def machine_follower(model: Model, settings: Settings) -> "OrbitFollower":
    """Return a follower of the orbits of a machine over the speed of its pinions, rpm.

    Parameters
    ----------
    model : Model
        Reduced machine.
    settings : Settings
        Settings of the run.

    Returns
    -------
    OrbitFollower
        Follower of the model.
    """
    return OrbitFollower(
        lambda speed: (model.system, TAU * mesh_frequency(model.machine.layout, speed)), settings
    )


@dataclass(frozen=True, eq=False)
class OrbitFollower:
    """Follows stable periodic orbits from speed to speed; the speed may be any parameter of a system.

    Attributes
    ----------
    at : callable
        Returns the system at a speed, and its angular mesh frequency, rad/s.
    settings : Settings
        Settings with which the motion is sought; steps are at least as fine as FINE.
    """

    at: Callable[[float], tuple[System, float]]
    settings: Settings

    def orbit(self, speed: float, state: State, period: int) -> HeldOrbit | None:
        """Find the stable orbit at a speed next to a state.

        Parameters
        ----------
        speed : float
            Pinion speed, rpm.
        state : State
            State of a motion.
        period : int
            Mesh periods of the motion; 0 if it is not periodic.

        Returns
        -------
        HeldOrbit or None
            None if there is no stable orbit with this period near the state.
        """
        return self._stable(speed, state, period) if period else None

    def until_lost(self, orbit: HeldOrbit, end: float, resolution: float) -> tuple[HeldOrbit, float | None]:
        """Follow an orbit to a speed, or until it ends, loses its stability or jumps to another orbit.

        Parameters
        ----------
        orbit : HeldOrbit
            Orbit at the first speed.
        end : float
            Last speed, rpm.
        resolution : float
            Largest distance between the two speeds of the result, rpm.

        Returns
        -------
        HeldOrbit
            Last orbit that is found stable.
        float or None
            Speed at which it is not, rpm; None if it is stable up to the end.
        """
        whole = abs(end - orbit.speed)
        onward, step, again = 1.0 if end > orbit.speed else -1.0, whole / PARTS, False
        while orbit.speed != end:
            left = abs(end - orbit.speed)
            target = end if left <= 1.001 * step else orbit.speed + onward * step
            stable = self._stable(target, orbit.state, orbit.period)
            if stable is not None and distance(stable.ac_rms, orbit.ac_rms) <= SMOOTH:
                step = min(2.0 * step, whole / PARTS) if again else step
                orbit, again = stable, True
            elif abs(target - orbit.speed) <= resolution:
                return orbit, target
            else:
                step, again = 0.5 * min(step, left), False
        return orbit, None

    def aside(self, last: HeldOrbit, speed: float, kick: float) -> State:
        """Return a start at a speed at which an orbit is lost.

        It lies beside the orbit along its leading direction, where the orbit continues unstable. Else it is
        the last state of the orbit.

        Parameters
        ----------
        last : HeldOrbit
            Last stable orbit.
        speed : float
            Speed at which it is lost, rpm.
        kick : float
            Distance from the orbit in length scales, dimensionless.

        Returns
        -------
        State
            Start.
        """
        integrator, orbit = self._near(speed, last.state, last.period)
        if orbit is None:
            return last.state
        off = orbit.leading_disturbance(integrator, 0.0 * orbit.state)
        return integrator.by_time(orbit.state + kick * off)

    def _stable(self, speed: float, state: State, period: int) -> HeldOrbit | None:
        """Return the stable orbit of `period` mesh periods at a speed (rpm) near a state; None if there
        is none.
        """
        integrator, orbit = self._near(speed, state, period)
        if orbit is None or abs(orbit.multipliers[0]) > 1.0 + UNIT_TOLERANCE:
            return None
        samples = integrator.run(orbit.state, period, samples=SAMPLES).samples
        system = integrator.system
        deflections = by_mesh(system, each_deflection(system, samples, SAMPLES))
        return HeldOrbit(
            speed,
            period,
            integrator.by_time(orbit.state),
            deflections.std(axis=0),
            float(abs(orbit.multipliers[0])),
        )

    def _near(self, speed: float, state: State, period: int) -> tuple[Integrator, Orbit | None]:
        """Return the integrator at a speed (rpm), and the orbit of `period` mesh periods near a state,
        stable or not.

        The orbit is None if Newton's method finds none, one of a shorter period, or one farther than NEAR
        away.
        """
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
