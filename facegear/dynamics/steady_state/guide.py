"""From a start to its orbit by the orbit of a like system, without disturbances of its own.

Machines of one series differ by micrometres, so that their motions over a mesh period differ little in how
they answer a disturbance. The matrix of one of them serves Newton's method for all (a chord method, Kelley
1995, section 5.4), and says how the run from each start must come to the orbit.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array, ComplexArray
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.system import System
from facegear.dynamics.steady_state.orbits import ROUNDING, Orbit, change
from facegear.dynamics.steady_state.settle import Settled
from facegear.errors import NotConverged

BLOCKS = (8, 8, 16)
"""Mesh periods after which a run is compared with the orbit that the guide leads to."""
STEPS = 12
"""Steps that the chord method may take; each must gain a factor of two."""
RETURNS = 5
"""Returns in succession that must follow the guide's multipliers."""
HOLDING = 0.99
"""Multipliers of a guide lie below: what it draws in slowly is better watched."""


@dataclass(frozen=True, eq=False)
class Guide:
    """A stable orbit (2, n) of one mesh period, and the integrator of the system that it belongs to, whose
    scratch space those that it leads may use.
    """

    integrator: Integrator
    orbit: Orbit

    def serves(self, system: System) -> bool:
        """Whether the coordinates of another system are the same."""
        own = self.integrator.system
        return np.array_equal(own.mesh_jacobian, system.mesh_jacobian) and np.array_equal(
            own.omega_squared, system.omega_squared
        )

    @cached_property
    def inverse(self) -> ComplexArray:
        """Components (2 n, 2 n) along the orbit's own directions of states off the orbit."""
        return np.asarray(np.linalg.inv(self.orbit.vectors))

    @cached_property
    def chord(self) -> Array:
        """The matrix (2 n, 2 n) of step()."""
        return np.asarray(((self.orbit.vectors / (1.0 - self.orbit.multipliers)) @ self.inverse).real)

    def step(self, change: Array) -> Array:
        """Newton's step (2, n) for a change (2, n) over the period."""
        return (self.chord @ change.ravel()).reshape(2, -1)


def guide_of(integrator: Integrator, orbit: Orbit | None) -> Guide | None:
    """The guide that an orbit makes; None where it has more than one mesh period, or holds too loosely."""
    fit = orbit is not None and orbit.period == 1 and abs(orbit.multipliers[0]) < HOLDING
    return Guide(integrator, orbit) if orbit is not None and fit else None


def guided(integrator: Integrator, state: Array, guide: Guide) -> Settled | None:
    """Where a run from a state (2, n) settles, if that is an orbit near the guide's; None if not, or unsure.

    The orbit counts only once the run itself is seen to be drawn in by it: each of the last returns must be
    what the guide's multipliers make of the one before, but for less than half of what they take away.
    """
    try:
        return _guided(integrator, state, guide)
    except NotConverged:  # a step of the chord method led away
        return None


def _guided(integrator: Integrator, state: Array, guide: Guide) -> Settled | None:
    ends = state[None]
    for block in BLOCKS:
        run = integrator.run(ends[-1], block)
        ends = np.concatenate([ends, run.ends])
        nearest = _orbit_near(integrator, ends[-2:], guide)
        if nearest is None:
            return None
        orbit, residual = nearest
        if drawn_in(ends[-1 - RETURNS :] - orbit, guide):
            return Settled(orbit, 1, residual, None, len(ends) - 1, ends[1:])
    return None


def _orbit_near(integrator: Integrator, states: Array, guide: Guide) -> tuple[Array, float] | None:
    """The orbit (2, n) that the chord method comes to from the last two states (2, 2, n) of a run, a period
    apart, and the change over its period.

    The last step is not run: it gains at least what the least of those before it has gained.
    """
    here, end = states
    best, ratio = change(integrator, here, end), 0.0
    for _ in range(STEPS):
        here = here + guide.step(end - here)
        end = integrator.returned(here)
        residual = change(integrator, here, end)
        if residual <= ROUNDING:
            return here, residual
        if not residual < 0.5 * best:
            return None
        best, ratio = residual, max(ratio, residual / best)
        if ratio * residual <= ROUNDING:
            return here + guide.step(end - here), ratio * residual
    return None


def drawn_in(off: Array, guide: Guide) -> bool:
    """Whether states (RETURNS + 1, 2, n) off the orbit come nearer as the guide's multipliers have it."""
    multipliers = guide.orbit.multipliers
    parts = off.reshape(len(off), -1) @ guide.inverse.T
    missed = np.linalg.norm(parts[1:] - multipliers * parts[:-1], axis=1)
    taken = (1.0 - abs(multipliers[0])) * np.linalg.norm(parts[:-1], axis=1)
    return bool((missed < 0.5 * taken).all())
