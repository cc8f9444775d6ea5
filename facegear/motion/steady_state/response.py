"""Steady state of a machine, and the numbers that are derived from it."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from facegear.arrays import Array, ComplexArray
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.system import System
from facegear.motion.plan import Look, Motion, State
from facegear.motion.steady_state.averages import Averages, Moments
from facegear.motion.steady_state.mesh_samples import (
    by_mesh,
    each_deflection,
    largest_mesh_forces,
    mesh_forces,
    mesh_fractions,
    past_law,
)
from facegear.motion.steady_state.orbits import Orbit
from facegear.motion.steady_state.watch import WatchResult


@dataclass(frozen=True, eq=False)
class SteadyState:
    """The response over K = periods * per_period samples, evenly spaced.

    `displacements(machine)` gives all DOF.

    Attributes
    ----------
    system
        Equations of motion that were integrated.
    motion
        Class of motion.
    period
        In mesh periods where the motion is periodic, else 0.
    frequency
        Angular mesh frequency, rad/s.
    residual
        Change over the period, over the length scale.
    periods, per_period
        Mesh periods (the orbit's own period, else the window) and samples in each.
    coordinates : (K, n)
        Samples of the system's coordinates.
    averages
        Exact time averages over the whole response, with forces in N.
    contact_fractions : (3, contacts)
        Fraction of the time that each mesh or flank spends open, on its drive and on its back flank, as the
        steps count it.
    orbit
        The periodic orbit where it was refined on its own.
    exponent
        Largest Lyapunov exponent per mesh period with its 95 % half-width, for motions that are not periodic.
    periods_run
        For how many mesh periods the motion was watched in all before it was named so.
    looks
        Motions to which this start and another one came, where the two differ and the motion is called not
        settled for that reason alone; else None.
    state
        State at the end, by time.
    """

    system: System
    motion: Motion
    period: int
    frequency: float
    residual: float
    periods: int
    per_period: int
    coordinates: Array
    averages: Averages
    contact_fractions: Array
    orbit: Orbit | None
    exponent: tuple[float, float] | None
    periods_run: int
    looks: tuple[Look, Look] | None
    state: State

    @property
    def label(self) -> str:
        """Label of the motion: `period-n` with n mesh periods, or the class of a motion that is not
        periodic.
        """
        return f"period-{self.period}" if self.motion is Motion.PERIODIC else self.motion.value

    @property
    def multipliers(self) -> ComplexArray | None:
        """Floquet multipliers (2 n,) of the orbit, largest modulus first; None where no orbit was
        refined.
        """
        return None if self.orbit is None else self.orbit.multipliers

    @property
    def liouville(self) -> float | None:
        """Liouville check of the orbit, see Orbit."""
        return None if self.orbit is None else self.orbit.liouville

    @cached_property
    def deflections(self) -> Array:
        """Deflections (K, meshes) of the samples, m, less the error e(t); see by_mesh() for meshes with
        two flanks.
        """
        return by_mesh(self.system, self._contact_deflections)

    @cached_property
    def fractions(self) -> Array:
        """Fraction of the time (3, meshes) open, on the drive flank, on the back flank."""
        return mesh_fractions(self.system, self.contact_fractions, self._contact_deflections)

    @cached_property
    def forces(self) -> Array:
        """Elastic mesh forces (K, meshes) of the samples, N, by the mesh law; positive on the drive
        flank.
        """
        return mesh_forces(self.system, self._contact_deflections, self.per_period)

    @property
    def largest_forces(self) -> Array:
        """Largest magnitude (meshes,) of the elastic mesh forces, located between the samples, N."""
        return largest_mesh_forces(self.system, self._contact_deflections, self.per_period, self.period > 0)

    @cached_property
    def _contact_deflections(self) -> Array:
        """Deflections (K, contacts) of each mesh, or each flank where meshes have two, m, see
        each_deflection().
        """
        return each_deflection(self.system, self.coordinates, self.per_period)

    @property
    def past_law(self) -> Array:
        """Fraction of samples (meshes,) at which a mesh is compressed beyond the last level of its law's
        table.
        """
        if self.system.law.straight:
            return np.zeros(self.system.pairs or self.system.contacts)
        return past_law(self.system, self._contact_deflections)

    @property
    def moments(self) -> Moments:
        """Mean, RMS, extremes of the mesh deflections, m, each (meshes,); exact for the polynomials of
        the steps.
        """
        return self.averages.meshes(self.motion is Motion.PERIODIC)

    @property
    def mean_forces(self) -> Array:
        """Means of the elastic mesh forces, then of their magnitudes, (2, meshes), N."""
        return self.averages.force

    @property
    def phases(self) -> Array:
        """Time of each sample in mesh periods, shape (K,)."""
        return np.arange(self.periods * self.per_period) / self.per_period


def response_of(
    system: System, integrator: Integrator, watch_result: WatchResult, looks: tuple[Look, Look] | None
) -> SteadyState:
    """Make the response of a run that was watched.

    Parameters
    ----------
    system : System
        Equations of motion.
    integrator : Integrator
        Integrates the system at one mesh frequency.
    watch_result : WatchResult
        Result of watching the run.
    looks : tuple of Look or None
        Motions of this start and another, where they differ; see SteadyState.

    Returns
    -------
    SteadyState
        Response.
    """
    settling_result, window, exponent = (
        watch_result.settling_result,
        watch_result.window,
        watch_result.exponent,
    )
    averages, square = window.averages, integrator.frequency**2
    return SteadyState(
        system=system,
        motion=watch_result.motion,
        period=settling_result.period,
        frequency=integrator.frequency,
        residual=settling_result.residual,
        periods=window.periods,
        per_period=window.per_period,
        coordinates=window.samples,
        averages=replace(averages, force=averages.force * square, pull=averages.pull * square),
        contact_fractions=window.fractions[:, : system.contacts],
        orbit=settling_result.orbit,
        exponent=(exponent.value, exponent.half_width) if exponent else None,
        periods_run=watch_result.periods_run,
        looks=looks,
        state=integrator.by_time(window.ends[-1]),
    )
