"""Mirror images of a periodic motion under the symmetries of its system, and the choice among them.

Where a motion loses its symmetry, rounding decides to which of its images a run comes. Therefore a rule
chooses the image, independently of threads, chunks, processor and the speeds of a sweep.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.motion.integrator.system import System
from facegear.motion.plan import State
from facegear.motion.requests import RunPlan
from facegear.motion.steady_state.averages import Moments
from facegear.motion.steady_state.orbits import Orbit
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.steady_state.watch import FirstWatch, begin
from facegear.motion.symmetries import Symmetry, symmetries

SAME_MOTION = 1e-4
"""Motions that differ by less, in length scales, are the same one. Orbits are known to 1e-6 or better."""
EQUAL = 1e-5
"""Relative difference of the numbers by which images are ordered below which they are equal."""


@dataclass(frozen=True, eq=False)
class Cycle:
    """Samples of a periodic motion over its period, to compare it with its images under symmetries.

    Attributes
    ----------
    system : System
        Equations of motion.
    samples : (K, n) array
        Samples of the coordinates over the period.
    per_period : int
        Number of samples in each mesh period.
    orbit : Orbit or None
        Its orbit, if known: differences along its neutral directions do not count.
    """

    system: System
    samples: Array
    per_period: int
    orbit: Orbit | None

    def image(self, symmetry: Symmetry) -> Array:
        """Return the samples of the image of the motion under a symmetry, at the same instants.

        Parameters
        ----------
        symmetry : Symmetry
            Symmetry of the system.

        Returns
        -------
        (K, n) array
            Samples of the coordinates, m.
        """
        return self._advanced(symmetry.shift) @ symmetry.matrix.T

    def image_state(self, symmetry: Symmetry, state: Array) -> Array:
        """Return the image's state at the instant at which the samples begin.

        Parameters
        ----------
        symmetry : Symmetry
            Symmetry of the system.
        state : (2, n) array
            The motion's own state by phase at that instant, used if the symmetry has no shift; m and
            m/rad.

        Returns
        -------
        (2, n) array
            State of the image at the same instant, m and m/rad.
        """
        if symmetry.shift == 0.0:
            return state @ symmetry.matrix.T
        shifted_state = [self._advanced(symmetry.shift)[0], self._advanced(symmetry.shift, slope=True)[0]]
        return np.array(shifted_state) @ symmetry.matrix.T

    def holds(self, symmetry: Symmetry) -> bool:
        """Whether a symmetry maps the motion to itself, begun in any of its mesh periods.

        Parameters
        ----------
        symmetry : Symmetry
            Symmetry of the system.

        Returns
        -------
        bool
            True if image and motion differ by less than SAME_MOTION.
        """
        image, neutral = self.image(symmetry), self._neutral
        weights = np.abs(self.system.mesh_jacobian).max(axis=0) / self.system.scale
        for first in range(0, len(image), self.per_period):
            apart = np.roll(image, first, axis=0) - self.samples
            apart -= apart @ neutral @ neutral.T
            if np.abs(apart * weights).max() <= SAME_MOTION:
                return True
        return False

    def broken_symmetries(self) -> list[Symmetry]:
        """Return the symmetries of the system that map the motion to another one.

        Returns
        -------
        list of Symmetry
            Symmetries that the motion does not have.
        """
        return [symmetry for symmetry in symmetries(self.system) if not self.holds(symmetry)]

    @property
    def _neutral(self) -> Array:
        """Orthonormal directions (n, k) of the coordinates along which the orbit is neutral, as bodies
        are free there.
        """
        size = self.system.size
        if self.orbit is None or self.orbit.is_off_circle.all():
            return np.zeros((size, 0))
        directions = self.orbit.vectors[:size, ~self.orbit.is_off_circle]
        axes, sizes, _ = np.linalg.svd(np.column_stack([directions.real, directions.imag]))
        return np.asarray(axes[:, : np.count_nonzero(sizes > SAME_MOTION)])

    def _advanced(self, shift: float, slope: bool = False) -> Array:
        """Return the samples (K, n), or their derivatives by phase (1/rad), a shift (in mesh periods)
        later.

        They are exact for waves that the samples resolve.
        """
        steps = shift * self.per_period
        if not slope and abs(steps - round(steps)) < 1e-9 * self.per_period:
            return np.roll(self.samples, -round(steps), axis=0)
        order = np.fft.rfftfreq(len(self.samples), 1.0 / self.per_period)[:, None]
        turn = np.exp(2j * np.pi * order * shift) * ((1j * order) if slope else 1.0)
        return np.fft.irfft(np.fft.rfft(self.samples, axis=0) * turn, len(self.samples), axis=0)


def symmetry_broken(response: SteadyState) -> bool:
    """Whether a response is periodic and has mirror images that are other motions.

    Parameters
    ----------
    response : SteadyState
        Response.

    Returns
    -------
    bool
        False for motions that are not periodic.
    """
    return bool(response.period and _cycle_of(response).broken_symmetries())


def held_symmetries(response: SteadyState) -> tuple[Symmetry, ...]:
    """Return the symmetries that map a response to itself.

    Parameters
    ----------
    response : SteadyState
        Response.

    Returns
    -------
    tuple of Symmetry
        All symmetries of the system where the response is not periodic.
    """
    every = symmetries(response.system)
    return tuple(filter(_cycle_of(response).holds, every)) if response.period else every


def symmetries_of_start(system: System, start: State) -> tuple[Symmetry, ...]:
    """Return the symmetries that map a start to itself; those with a shift in time only if it is at rest.

    Parameters
    ----------
    system : System
        Equations of motion.
    start : State
        Displacement and velocity at the start.

    Returns
    -------
    tuple of Symmetry
        Symmetries of the start.
    """
    weights, is_at_rest = np.abs(system.mesh_jacobian).max(axis=0) / system.scale, not start.velocity.any()

    def leaves(symmetry: Symmetry) -> bool:
        apart = symmetry.matrix @ start.displacement - start.displacement
        rate = symmetry.matrix @ start.velocity - start.velocity
        fastest = max(float(np.abs(start.velocity).max()), 1e-300)
        still = np.abs(rate).max() <= SAME_MOTION * fastest
        return bool(
            (is_at_rest or symmetry.shift == 0.0) and still and np.abs(apart * weights).max() <= SAME_MOTION
        )

    return tuple(filter(leaves, symmetries(system)))


def held_after(first_watch: FirstWatch, system: System) -> tuple[Symmetry, ...]:
    """Return the symmetries that map the motion of a first watch to itself.

    Parameters
    ----------
    first_watch : FirstWatch
        First watch of a run.
    system : System
        Equations of motion.

    Returns
    -------
    tuple of Symmetry
        All symmetries of the system where the run has not settled.
    """
    cycle = _cycle_of_first_watch(first_watch, system)
    every = symmetries(system)
    return every if cycle is None else tuple(filter(cycle.holds, every))


def with_chosen_image(
    first_watch: FirstWatch, system: System, start_symmetries: Sequence[Symmetry]
) -> RunPlan[FirstWatch]:
    """Take the image of a first watch's motion that the rule prefers, where the run has broken a symmetry.

    Parameters
    ----------
    first_watch : FirstWatch
        First watch of a run.
    system : System
        Equations of motion.
    start_symmetries : sequence of Symmetry
        Symmetries of the start. Only they could have led to an image as well.

    Returns
    -------
    RunPlan of FirstWatch
        The same first watch if the motion is not periodic or keeps these symmetries. Else that of a run which
        settles on the image with the largest AC RMS in the first mesh in which images differ, or the largest
        mean.
    """
    cycle = _cycle_of_first_watch(first_watch, system)
    if cycle is None or first_watch.watch_result is None:
        return first_watch
    symmetry = _preferred(cycle, first_watch.watch_result.window.averages.meshes(True), start_symmetries)
    if symmetry is None:
        return first_watch
    settling_result = first_watch.settling_result
    again = yield from begin(
        first_watch.integrator, cycle.image_state(symmetry, settling_result.state), first_watch.settings
    )
    if again.watch_result is None or again.settling_result.period != settling_result.period:
        return first_watch
    ends, run = (
        settling_result.ends @ symmetry.matrix.T,
        settling_result.periods_run + again.settling_result.periods_run,
    )
    image = replace(again.settling_result, ends=ends, periods_run=run)
    watch_result = replace(again.watch_result, settling_result=image, periods_run=run)
    return replace(
        first_watch,
        start=first_watch.start @ symmetry.matrix.T,
        settling_result=image,
        watch_result=watch_result,
    )


def start_on_image(response: SteadyState, start_symmetries: Sequence[Symmetry]) -> State | None:
    """Return a state of the image that with_chosen_image() would take of a response.

    Parameters
    ----------
    response : SteadyState
        Response.
    start_symmetries : sequence of Symmetry
        Symmetries of the start; only images under these are considered.

    Returns
    -------
    State or None
        State of the image; None if the response itself is preferred.
    """
    symmetry = (
        _preferred(_cycle_of(response), response.moments, start_symmetries) if response.period else None
    )
    if symmetry is None:
        return None
    state = np.array([response.state.displacement, response.state.velocity / response.frequency])
    displacement, rate = _cycle_of(response).image_state(symmetry, state)
    return State(displacement, rate * response.frequency)


def _preferred(cycle: Cycle, moments: Moments, start_symmetries: Sequence[Symmetry]) -> Symmetry | None:
    """Return the symmetry, of those of the start, that leads to the preferred image; None where that is
    the motion itself.

    The preferred one has the largest AC RMS in the first mesh in which images differ, else the largest
    mean.
    """
    if all(map(cycle.holds, start_symmetries)):
        return None
    best, best_numbers = None, np.concatenate([moments.ac_rms, moments.mean])
    for symmetry in start_symmetries:
        mean = symmetry.mesh_signs * moments.mean[symmetry.meshes]
        numbers = np.concatenate([moments.ac_rms[symmetry.meshes], mean])
        if _comes_first(numbers, best_numbers):
            best, best_numbers = symmetry, numbers
    return best


def _comes_first(numbers: Array, reference: Array) -> bool:
    """Whether the first of the numbers (k,) that differs from the reference's is larger than it."""
    apart = np.flatnonzero(np.abs(numbers - reference) > EQUAL * np.abs(reference).max(initial=0.0))
    return bool(apart.size and numbers[apart[0]] > reference[apart[0]])


def _cycle_of(response: SteadyState) -> Cycle:
    """Return the samples of a periodic response as a cycle."""
    return Cycle(response.system, response.coordinates, response.per_period, response.orbit)


def _cycle_of_first_watch(first_watch: FirstWatch, system: System) -> Cycle | None:
    """Return the cycle of a motion after its first watch; None if it has not settled or no window was
    run.
    """
    if first_watch.watch_result is None:
        return None
    window = first_watch.watch_result.window
    return Cycle(system, window.samples, window.per_period, first_watch.settling_result.orbit)
