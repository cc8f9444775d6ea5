"""Linear functions of a motion, and forces of meshes and bearings, at evenly spaced instants.

A periodic motion is the Fourier series through its samples, so that the instants may lie closer than the
samples. Any other motion has its samples alone.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy

from facegear._kernels import samples
from facegear.arrays import Array, ComplexArray, Integers
from facegear.machine.flanks import NO_LOAD, significant_forces
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.steady_state.mesh_samples import errors_of_period
from facegear.motion.steady_state.response import SteadyState


def add_ring_forces(
    displacement: Array,
    speed: Array,
    stiffness: Array,
    clearance: Array,
    lag: float,
    body: Integers,
    forces: Array,
) -> None:
    """Write the forces of bodies on R bearings whose springs act beyond a radial clearance.

    A body at r = (x, y), d from its centre, presses with F = k (1 - c / d) r, and with lag * dF/dt for
    the damping; inside the clearance both are zero. The components along x and y of the bodies with such
    a bearing are overwritten, everything else in `forces` stays as it is.

    Parameters
    ----------
    displacement, speed : (R, 2, K)
        Along x and y of the bearing's body at K instants, m and m/s.
    stiffness, clearance : (R,)
        Stiffness k beyond the clearance, N/m, and radial clearance c to each side, m.
    lag
        Damping over stiffness, s.
    body : (R,)
        Index of the body that each bearing holds; no body has two.
    forces : (bodies, 3, K)
        Forces along x, y, z, N; changed in place.
    """
    samples.write_ring_forces(displacement, speed, stiffness, clearance, lag, body, forces)


def press_in(deflections: Array, errors: Array, lower: Array, upper: Array) -> None:
    """Turn deflections of contacts into how far they are pressed in.

    Parameters
    ----------
    deflections : (M, B, K)
        Of M contacts over B mesh periods of K instants, m. Written: the amount above `upper`, or below
        `lower` as a negative amount.
    errors : (K, M)
        Errors of the period, which are left out, m.
    lower, upper : (M,)
        Edges, m. A contact with lower >= upper is never open: both directions count from `upper`.
    """
    samples.press_in(deflections, errors, lower, upper)


def split_loads(forces: Array, rounding: float, loads: Array) -> None:
    """Write the loads of the drive and back flank of each mesh into arrays, N.

    Parameters
    ----------
    forces : (M, K)
        Force that each mesh transmits, N; positive on the drive flank, negative on the back flank.
    rounding
        Part of the largest force up to which a force counts as none, dimensionless.
    loads : (2 M, K)
        Written: loads of the drive flanks, then of the back flanks, N.
    """
    samples.split_loads(forces, rounding, loads)


class Track(Protocol):
    """A motion of n coordinates y at K evenly spaced instants, from which linear functions of y and dy/dt
    are taken.
    """

    @property
    def count(self) -> int:
        """Number K of instants of the motion."""

    def along(self, displacement_weights: Array, velocity_weights: Array) -> Array:
        """Compute y displacement_weights + dy/dt velocity_weights at each instant.

        Parameters
        ----------
        displacement_weights, velocity_weights : (n, columns) array
            Weights of the coordinates and of their velocities, any unit.

        Returns
        -------
        (columns, K) array
            Values, in the unit of the weighted coordinates.
        """


@dataclass(frozen=True, eq=False)
class PeriodicTrack:
    """A periodic motion at K evenly spaced instants.

    Velocities are the slopes of the periodic cubic spline through the K instants. Its slopes m satisfy
    m[i-1] + 4 m[i] + m[i+1] = 3 (f[i+1] - f[i-1]) / step, which a Fourier series solves wave by wave.

    Attributes
    ----------
    waves : (n, W) array
        Discrete Fourier transform (np.fft.rfft) of the coordinates at the K instants.
    count : int
        Number K of instants.
    step : float
        Time between two instants, s.
    """

    waves: ComplexArray
    count: int
    step: float

    def along(self, displacement_weights: Array, velocity_weights: Array) -> Array:
        """Compute y displacement_weights + dy/dt velocity_weights at each instant.

        Parameters
        ----------
        displacement_weights, velocity_weights : (n, columns) array
            Weights of the coordinates and of their velocities, any unit.

        Returns
        -------
        (columns, K) array
            Values, in the unit of the weighted coordinates.
        """
        parts, angle = self.waves.view(np.float64), TAU * np.arange(self.waves.shape[1]) / self.count
        total = (displacement_weights.T @ parts).view(np.complex128)
        has_velocity = velocity_weights.any(axis=0)
        slope = 3.0j * np.sin(angle) / ((2.0 + np.cos(angle)) * self.step)
        total[has_velocity] += (velocity_weights.T[has_velocity] @ parts).view(np.complex128) * slope
        return np.asarray(np.fft.irfft(total, self.count, axis=1))


@dataclass(frozen=True, eq=False)
class SampledTrack:
    """Samples (K, n) of the coordinates, `step` (s) apart.

    Velocities are the slopes of the cubic spline through all samples.
    """

    samples: Array
    step: float

    @property
    def count(self) -> int:
        """The number K of samples."""
        return len(self.samples)

    @cached_property
    def rates(self) -> Array:
        """Velocities (K, n), in the coordinates' unit per second."""
        time = np.arange(self.count) * self.step
        return np.asarray(scipy.interpolate.CubicSpline(time, self.samples)(time, 1))

    def along(self, displacement_weights: Array, velocity_weights: Array) -> Array:
        """Compute y displacement_weights + dy/dt velocity_weights at each instant.

        Parameters
        ----------
        displacement_weights, velocity_weights : (n, columns) array
            Weights of the coordinates and of their velocities, any unit.

        Returns
        -------
        (columns, K) array
            Values, in the unit of the weighted coordinates.
        """
        total = displacement_weights.T @ self.samples.T
        has_velocity = velocity_weights.any(axis=0)
        if has_velocity.any():
            total[has_velocity] += velocity_weights.T[has_velocity] @ self.rates.T
        return total


def track(response: SteadyState, factor: int = 1) -> Track:
    """Make the track of a response: through its samples, by Fourier series if it is periodic.

    Parameters
    ----------
    response : SteadyState
        Response.
    factor : int
        Number of instants for each sample; above 1 only for a periodic response.

    Returns
    -------
    Track
        Motion at evenly spaced instants.
    """
    step = TAU / (response.frequency * response.per_period)
    if response.period == 0:
        return SampledTrack(response.coordinates, step)
    return periodic_track(response.coordinates, step, factor)


def periodic_track(samples: Array, step: float, factor: int = 1) -> PeriodicTrack:
    """Make the track through the samples of a periodic motion.

    Parameters
    ----------
    samples : (K, n) array
        Evenly spaced samples of a whole period, any unit.
    step : float
        Time between two samples, s.
    factor : int
        Number of instants for each sample.

    Returns
    -------
    PeriodicTrack
        Motion at `factor` K instants.
    """
    count = len(samples)
    waves = np.fft.rfft(np.ascontiguousarray(samples.T), axis=1)
    if factor > 1 and count % 2 == 0:
        waves[:, -1] *= 0.5  # half of the wave of largest order belongs to its negative frequency
    return PeriodicTrack(waves * factor, factor * count, step / factor)


@dataclass(frozen=True, eq=False)
class DenseMotion:
    """A response at K evenly spaced instants, `per_period` of them in each mesh period; quantities are
    computed on demand.
    """

    response: SteadyState
    per_period: int
    track: Track

    @cached_property
    def beyond(self) -> Array:
        """Compression of each mesh or flank (contacts, periods, per_period), m, negative on the lower
        side of a mesh, 0 when open.
        """
        system = self.response.system
        jacobian = system.mesh_jacobian[: system.contacts].T
        deflections = self.track.along(jacobian, np.zeros_like(jacobian))
        by_period = deflections.reshape(system.contacts, -1, self.per_period)
        edges = system.lower[: system.contacts], system.upper[: system.contacts]
        press_in(by_period, errors_of_period(system, self.per_period), *edges)
        return by_period

    @cached_property
    def deepest(self) -> Array:
        """Largest magnitude of the compression of each mesh or flank over all instants (contacts,), m."""
        return np.maximum(self.beyond.max(axis=(1, 2)), -self.beyond.min(axis=(1, 2)))

    @cached_property
    def forces(self) -> Array:
        """Elastic mesh forces (meshes, K), N, positive on the drive flank; with two flanks drive less
        back flank.
        """
        system, cycles = self.response.system, np.arange(self.per_period) / self.per_period
        phase_shifts = None
        if system.phase_shifts is not None:
            rows = np.ascontiguousarray(system.phase_shifts.T)
            shifts = self.track.along(rows, np.zeros_like(rows))
            phase_shifts = np.moveaxis(shifts.reshape(self.beyond.shape), 0, -1)
        contact_forces = system.contact_forces(cycles, np.moveaxis(self.beyond, 0, -1), phase_shifts)
        forces = np.moveaxis(contact_forces, -1, 0).reshape(system.contacts, -1)
        if not system.two_flanks:
            return forces
        drive, back = np.split(forces, 2)
        return drive - back

    @cached_property
    def loads(self) -> Array:
        """Elastic mesh forces (meshes, K), N, as `forces`, but 0 where they are rounding beside the
        largest.
        """
        return significant_forces(self.forces)

    @property
    def flank_loads(self) -> Array:
        """Magnitudes (2 meshes, K), N, of the elastic forces of the drive flanks, then of the back
        flanks; rounding is left out.
        """
        loads = np.empty((2 * len(self.forces), self.track.count))
        split_loads(self.forces, NO_LOAD, loads)
        return loads

    @property
    def past_law(self) -> Array:
        """Fraction of the instants (contacts,) at which a contact is compressed beyond the last level of
        its law's table.
        """
        law = self.response.system.law
        if law.straight:
            return np.zeros(law.contacts)
        last = law.levels[-1]
        if not (self.deepest > last).any():
            return np.zeros(law.contacts)
        past = np.abs(self.beyond) > last[:, None, None]
        return np.asarray(past.mean(axis=(1, 2)))
