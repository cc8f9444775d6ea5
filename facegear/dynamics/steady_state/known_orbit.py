"""A stable orbit that a run may come to once more: then the run is over at once."""

from dataclasses import dataclass

from facegear.arrays import Array
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.steady_state.orbits import Orbit, drawn_in, largest, near_for_ever

NEAR = 0.02
"""Whether an orbit draws a run in is asked within this distance of it alone, over the length scale."""


@dataclass(frozen=True, eq=False)
class KnownOrbit:
    """The orbit, and the states (period, 2, n) at the end of its periods."""

    orbit: Orbit
    states: Array

    def reached(self, integrator: Integrator, ends: Array) -> tuple[Array, float] | None:
        """The orbit's state that the last of some states (periods, 2, n) of a run, period by period, is next
        to, and how far off, if nothing can lead the run away from the orbit again; else None.
        """
        distances = largest(integrator, self.states - ends[-1])
        nearest = int(distances.argmin())
        distance = float(distances[nearest])
        there = near_for_ever(integrator, self.orbit, distance)
        if not there and distance < NEAR:
            there = drawn_in(integrator, self.orbit, ends, (nearest + 1) % self.orbit.period)
        return (self.states[nearest], distance) if there else None


def known_orbit(integrator: Integrator, orbit: Orbit | None) -> KnownOrbit | None:
    """What other runs of a system may come to, where an orbit of it is known and holds them. Raises
    NotConverged.
    """
    if orbit is None or abs(orbit.multipliers[0]) >= 1.0:
        return None
    return KnownOrbit(orbit, integrator.run(orbit.state, orbit.period).ends)
