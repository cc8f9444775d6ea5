"""A stable orbit to which a run may come again: then the run ends at once."""

from dataclasses import dataclass

from facegear.arrays import Array
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.steady_state.orbits import Orbit, drawn_in, largest, near_for_ever

NEAR = 0.02
"""Whether an orbit draws a run in is asked within this distance of it alone, over the length scale."""


@dataclass(frozen=True, eq=False)
class KnownOrbit:
    """A stable orbit, and the states (period, 2, n) at the ends of its periods."""

    orbit: Orbit
    states: Array

    def attracting_state(self, integrator: Integrator, ends: Array) -> tuple[Array, float] | None:
        """Return the orbit's state next to the end of a run, if nothing can lead the run away from the orbit
        again.

        Parameters
        ----------
        integrator : Integrator
            Integrates the system at one mesh frequency.
        ends : (periods, 2, n) array
            States of the run at the ends of successive mesh periods, m and m/rad.

        Returns
        -------
        tuple or None
            State (2, n) of the orbit, m and m/rad, and the distance over the length scale; None if the run
            may leave.
        """
        distances = largest(integrator, self.states - ends[-1])
        nearest = int(distances.argmin())
        distance = float(distances[nearest])
        is_attracted = near_for_ever(integrator, self.orbit, distance)
        if not is_attracted and distance < NEAR:
            is_attracted = drawn_in(integrator, self.orbit, ends, (nearest + 1) % self.orbit.period)
        return (self.states[nearest], distance) if is_attracted else None


def known_orbit(integrator: Integrator, orbit: Orbit | None) -> KnownOrbit | None:
    """Make a known orbit, to which other runs of its system may come.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    orbit : Orbit or None
        Orbit of the integrator's system.

    Returns
    -------
    KnownOrbit or None
        None where there is no orbit or it is not stable.

    Raises
    ------
    NotConverged
        If a step fails.
    """
    if orbit is None or abs(orbit.multipliers[0]) >= 1.0:
        return None
    return KnownOrbit(orbit, integrator.run(orbit.state, orbit.period).ends)
