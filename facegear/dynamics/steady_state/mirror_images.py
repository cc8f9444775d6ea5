"""Mirror images of a periodic motion under the symmetries of its system, and which of them is taken.

Where a motion loses its symmetry, rounding decides which of its images a run comes to. So the image is chosen
by a rule instead, and does not depend on threads, chunks, processor or the speeds of a sweep.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.courses import Course
from facegear.dynamics.integrator.system import System
from facegear.dynamics.motion import State
from facegear.dynamics.steady_state.averages import Moments
from facegear.dynamics.steady_state.orbits import Orbit
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.steady_state.watching import Begun, begin
from facegear.dynamics.symmetries import Symmetry, symmetries

SAME = 1e-4
"""Motions that differ by less, in length scales, are the same one. Orbits are known to 1e-6 or better."""
EQUAL = 1e-5
"""Relative difference of the numbers by which images are ordered that counts as none."""


@dataclass(frozen=True, eq=False)
class Cycle:
    """A periodic motion: samples (K, n) of its coordinates, so many in each mesh period, and its orbit, whose
    neutral directions are not compared.
    """

    system: System
    samples: Array
    per_period: int
    orbit: Orbit | None

    def image(self, symmetry: Symmetry) -> Array:
        """Samples (K, n) of the image."""
        return self._advanced(symmetry.shift) @ symmetry.matrix.T

    def image_state(self, symmetry: Symmetry, state: Array) -> Array:
        """The image of the state (2, n) by phase with which the samples begin."""
        if symmetry.shift == 0.0:
            return state @ symmetry.matrix.T
        moved = [self._advanced(symmetry.shift)[0], self._advanced(symmetry.shift, slope=True)[0]]
        return np.array(moved) @ symmetry.matrix.T

    def holds(self, symmetry: Symmetry) -> bool:
        """Whether a symmetry maps the motion to itself, begun in whichever of its mesh periods."""
        image, neutral = self.image(symmetry), self._neutral
        weights = np.abs(self.system.mesh_jacobian).max(axis=0) / self.system.scale
        for first in range(0, len(image), self.per_period):
            apart = np.roll(image, first, axis=0) - self.samples
            apart -= apart @ neutral @ neutral.T
            if np.abs(apart * weights).max() <= SAME:
                return True
        return False

    def broken(self) -> list[Symmetry]:
        """The symmetries of the system that map the motion to another one."""
        return [symmetry for symmetry in symmetries(self.system) if not self.holds(symmetry)]

    @property
    def _neutral(self) -> Array:
        """Orthonormal directions (n, k) in which bodies are free."""
        size = self.system.size
        if self.orbit is None or self.orbit.moving.all():
            return np.zeros((size, 0))
        directions = self.orbit.vectors[:size, ~self.orbit.moving]
        axes, sizes, _ = np.linalg.svd(np.column_stack([directions.real, directions.imag]))
        return np.asarray(axes[:, : np.count_nonzero(sizes > SAME)])

    def _advanced(self, shift: float, slope: bool = False) -> Array:
        """Samples, or their derivatives by the phase, a shift (mesh periods) later; exact for waves that the
        samples show.
        """
        steps = shift * self.per_period
        if not slope and abs(steps - round(steps)) < 1e-9 * self.per_period:
            return np.roll(self.samples, -round(steps), axis=0)
        order = np.fft.rfftfreq(len(self.samples), 1.0 / self.per_period)[:, None]
        turn = np.exp(2j * np.pi * order * shift) * ((1j * order) if slope else 1.0)
        return np.fft.irfft(np.fft.rfft(self.samples, axis=0) * turn, len(self.samples), axis=0)


def symmetry_broken(response: SteadyState) -> bool:
    """Whether a response is periodic and has mirror images that are other motions."""
    return bool(response.period and _cycle_of(response).broken())


def held_symmetries(response: SteadyState) -> tuple[Symmetry, ...]:
    """Return the symmetries that map a response to itself; all where it is not periodic."""
    every = symmetries(response.system)
    return tuple(filter(_cycle_of(response).holds, every)) if response.period else every


def symmetries_of_start(system: System, start: State) -> tuple[Symmetry, ...]:
    """Return the symmetries that leave a start as it is: those without a shift, and at rest all."""
    weights, resting = np.abs(system.mesh_jacobian).max(axis=0) / system.scale, not start.velocity.any()

    def leaves(symmetry: Symmetry) -> bool:
        apart = symmetry.matrix @ start.displacement - start.displacement
        rate = symmetry.matrix @ start.velocity - start.velocity
        fastest = max(float(np.abs(start.velocity).max()), 1e-300)
        still = np.abs(rate).max() <= SAME * fastest
        return bool((resting or symmetry.shift == 0.0) and still and np.abs(apart * weights).max() <= SAME)

    return tuple(filter(leaves, symmetries(system)))


def held_after(begun: Begun, system: System) -> tuple[Symmetry, ...]:
    """Return the symmetries that map the motion of a first watch to itself; all where it has not settled."""
    cycle = _cycle_of_first_watch(begun, system)
    every = symmetries(system)
    return every if cycle is None else tuple(filter(cycle.holds, every))


def with_chosen_image(begun: Begun, system: System, held: Sequence[Symmetry]) -> Course[Begun]:
    """Take the image of a first watch's motion that the rule prefers, where the run has broken a symmetry.

    Parameters
    ----------
    begun
        The first watch.
    system
        What was run.
    held
        The symmetries of what the run started from. Only they could have led to an image as well.

    Returns
    -------
    Begun
        The same if the motion is not periodic or keeps these symmetries. Else that of a run which settles on
        the image with the largest AC RMS in the first mesh in which images differ, or the largest mean.
    """
    cycle = _cycle_of_first_watch(begun, system)
    if cycle is None or begun.seen is None:
        return begun
    symmetry = _preferred(cycle, begun.seen.window.averages.meshes(True), held)
    if symmetry is None:
        return begun
    settled = begun.settled
    again = yield from begin(begun.integrator, cycle.image_state(symmetry, settled.state), begun.settings)
    if again.seen is None or again.settled.period != settled.period:
        return begun
    ends, run = settled.ends @ symmetry.matrix.T, settled.periods_run + again.settled.periods_run
    image = replace(again.settled, ends=ends, periods_run=run)
    seen = replace(again.seen, settled=image, periods_run=run)
    return replace(begun, start=begun.start @ symmetry.matrix.T, settled=image, seen=seen)


def start_on_image(response: SteadyState, held: Sequence[Symmetry]) -> State | None:
    """Return a state of the image that with_chosen_image() would take of a response; None for the same."""
    symmetry = _preferred(_cycle_of(response), response.moments, held) if response.period else None
    if symmetry is None:
        return None
    here = np.array([response.state.displacement, response.state.velocity / response.frequency])
    displacement, rate = _cycle_of(response).image_state(symmetry, here)
    return State(displacement, rate * response.frequency)


def _preferred(cycle: Cycle, moments: Moments, held: Sequence[Symmetry]) -> Symmetry | None:
    """The symmetry that leads to the image which the rule prefers; None where that is the motion itself."""
    if all(map(cycle.holds, held)):
        return None
    best, best_numbers = None, np.concatenate([moments.ac_rms, moments.mean])
    for symmetry in held:
        mean = symmetry.mesh_signs * moments.mean[symmetry.meshes]
        numbers = np.concatenate([moments.ac_rms[symmetry.meshes], mean])
        if _comes_first(numbers, best_numbers):
            best, best_numbers = symmetry, numbers
    return best


def _comes_first(numbers: Array, others: Array) -> bool:
    """Whether the first of some numbers that differs from another's is the larger one."""
    apart = np.flatnonzero(np.abs(numbers - others) > EQUAL * np.abs(others).max(initial=0.0))
    return bool(apart.size and numbers[apart[0]] > others[apart[0]])


def _cycle_of(response: SteadyState) -> Cycle:
    return Cycle(response.system, response.coordinates, response.per_period, response.orbit)


def _cycle_of_first_watch(begun: Begun, system: System) -> Cycle | None:
    if begun.seen is None:
        return None
    window = begun.seen.window
    return Cycle(system, window.samples, window.per_period, begun.settled.orbit)
