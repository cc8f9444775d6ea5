"""Find the orbit of a start by the orbit of a similar system, without disturbances of its own.

Machines of one series differ by micrometres, so that their motions over a mesh period respond similarly to a
disturbance. The matrix of one of them serves Newton's method for all (a chord method, Kelley 1995,
section 5.4). It also says how the run from each start must come to the orbit.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array, ComplexArray
from facegear.errors import NotConverged
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.system import System
from facegear.motion.steady_state.orbits import ROUNDING, Orbit, change
from facegear.motion.steady_state.settle import SettlingResult

BLOCKS = (8, 8, 16)
"""Mesh periods after which a run is compared with the orbit that the guide leads to."""
STEPS = 12
"""Maximum number of steps of the chord method; each must gain a factor of two."""
RETURNS = 5
"""Number of successive returns that must follow the guide's multipliers."""
MAX_MULTIPLIER = 0.99
"""Upper limit of a guide's multipliers: runs that it attracts slowly are better watched."""


@dataclass(frozen=True, eq=False)
class Guide:
    """A stable orbit of one mesh period, and the integrator of its system, to lead runs of similar
    systems.

    Systems that the guide leads may use the integrator's scratch space.
    """

    integrator: Integrator
    orbit: Orbit

    def serves(self, system: System) -> bool:
        """Whether another system has the same mesh Jacobian and bearing frequencies, so that states can
        be compared.

        Parameters
        ----------
        system : System
            Equations of motion.

        Returns
        -------
        bool
            True if the guide may be used for the system.
        """
        guide_system = self.integrator.system
        return np.array_equal(guide_system.mesh_jacobian, system.mesh_jacobian) and np.array_equal(
            guide_system.omega_squared, system.omega_squared
        )

    @cached_property
    def inverse(self) -> ComplexArray:
        """Inverse (2 n, 2 n) of the eigenvectors: it turns states off the orbit (2 n,) into components
        along them.
        """
        return np.asarray(np.linalg.inv(self.orbit.vectors))

    @cached_property
    def chord(self) -> Array:
        """Matrix (2 n, 2 n) of Newton's step, (I - M)^-1 with the monodromy matrix M of the guide's orbit
        (chord method).
        """
        return np.asarray(((self.orbit.vectors / (1.0 - self.orbit.multipliers)) @ self.inverse).real)

    def step(self, change: Array) -> Array:
        """Return Newton's step for a change over the period, with the matrix of the guide's orbit.

        Parameters
        ----------
        change : (2, n) array
            End less start, by phase, m and m/rad.

        Returns
        -------
        (2, n) array
            Correction of the start, m and m/rad.
        """
        return (self.chord @ change.ravel()).reshape(2, -1)


def guide_of(integrator: Integrator, orbit: Orbit | None) -> Guide | None:
    """Make a guide of an orbit.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    orbit : Orbit or None
        Orbit of its system.

    Returns
    -------
    Guide or None
        None where there is no orbit, it has more than one mesh period, or its largest multiplier is
        MAX_MULTIPLIER or more.
    """
    fit = orbit is not None and orbit.period == 1 and abs(orbit.multipliers[0]) < MAX_MULTIPLIER
    return Guide(integrator, orbit) if orbit is not None and fit else None


def settle_by_guide(integrator: Integrator, state: Array, guide: Guide) -> SettlingResult | None:
    """Find where a run settles, if that is an orbit near the guide's.

    The orbit counts only once it is seen to attract the run: each of the last returns must be what the
    guide's multipliers make of the one before, but for less than half of what they take away.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    guide : Guide
        Orbit of a similar system.

    Returns
    -------
    SettlingResult or None
        Where the run settles, without an Orbit and its multipliers. None if the run does not settle near
        the guide, or this is uncertain.
    """
    try:
        return _follow_guide(integrator, state, guide)
    except NotConverged:  # a step of the chord method led away
        return None


def _follow_guide(integrator: Integrator, state: Array, guide: Guide) -> SettlingResult | None:
    """Run from a state (2, n) in blocks of periods, and solve for an orbit near the guide's after each.

    Return it once it is seen to attract the run, else None. Raises NotConverged.
    """
    ends = state[None]
    for block in BLOCKS:
        run = integrator.run(ends[-1], block)
        ends = np.concatenate([ends, run.ends])
        nearest = _orbit_near(integrator, ends[-2:], guide)
        if nearest is None:
            return None
        orbit, residual = nearest
        if drawn_in(ends[-1 - RETURNS :] - orbit, guide):
            return SettlingResult(orbit, 1, residual, None, len(ends) - 1, ends[1:])
    return None


def _orbit_near(integrator: Integrator, states: Array, guide: Guide) -> tuple[Array, float] | None:
    """Return the orbit (2, n) to which the chord method comes, and the change over its period; None where
    it fails.

    It starts from the last two states (2, 2, n) of a run, a period apart. The change is over the length
    scale. It is an estimate where the last step is not run: a step gains at least what the least of those
    before it has gained.
    """
    state, end = states
    best, ratio = change(integrator, state, end), 0.0
    for _ in range(STEPS):
        state = state + guide.step(end - state)
        end = integrator.advance_period(state)
        residual = change(integrator, state, end)
        if residual <= ROUNDING:
            return state, residual
        if not residual < 0.5 * best:
            return None
        best, ratio = residual, max(ratio, residual / best)
        if ratio * residual <= ROUNDING:
            return state + guide.step(end - state), ratio * residual
    return None


def drawn_in(off: Array, guide: Guide) -> bool:
    """Whether a run comes nearer to the orbit in each period as the guide's multipliers predict.

    Parameters
    ----------
    off : (RETURNS + 1, 2, n) array
        States of the run off the orbit, one period apart, m and m/rad.
    guide : Guide
        Orbit of a similar system.

    Returns
    -------
    bool
        True if the orbit attracts the run.
    """
    multipliers = guide.orbit.multipliers
    parts = off.reshape(len(off), -1) @ guide.inverse.T
    deviations = np.linalg.norm(parts[1:] - multipliers * parts[:-1], axis=1)
    contraction = (1.0 - abs(multipliers[0])) * np.linalg.norm(parts[:-1], axis=1)
    return bool((deviations < 0.5 * contraction).all())
