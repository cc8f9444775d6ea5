"""Elastic forces of the meshes at instants closer than the samples of a response."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.at_instants import press_in, split_loads
from facegear.dynamics.steady_state.mesh_samples import errors_of_period
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.track import Track
from facegear.transmission.flanks import NO_LOAD, significant_forces


@dataclass(frozen=True, eq=False)
class DenseMotion:
    """A response at K evenly spaced instants, `per_period` of them in each mesh period."""

    response: SteadyState
    per_period: int
    track: Track

    @cached_property
    def beyond(self) -> Array:
        """Compression of each mesh or flank (contacts, periods, per_period), m."""
        system = self.response.system
        jacobian = system.mesh_jacobian[: system.contacts].T
        deflections = self.track.along(jacobian, np.zeros_like(jacobian))
        by_period = deflections.reshape(system.contacts, -1, self.per_period)
        edges = system.lower[: system.contacts], system.upper[: system.contacts]
        press_in(by_period, errors_of_period(system, self.per_period), *edges)
        return by_period

    @cached_property
    def deepest(self) -> Array:
        """Largest compression of each mesh or flank (contacts,), m."""
        return np.maximum(self.beyond.max(axis=(1, 2)), -self.beyond.min(axis=(1, 2)))

    @cached_property
    def forces(self) -> Array:
        """Elastic mesh forces (meshes, K), N; with two flanks the difference of both."""
        system, cycles = self.response.system, np.arange(self.per_period) / self.per_period
        contact_forces = system.law.force(cycles, np.moveaxis(self.beyond, 0, -1))
        forces = np.moveaxis(contact_forces, -1, 0).reshape(system.contacts, -1)
        if not system.two_flanks:
            return forces
        drive, back = np.split(forces, 2)
        return drive - back

    @cached_property
    def loads(self) -> Array:
        """Elastic mesh forces (meshes, K), N, without those that are rounding beside the largest."""
        return significant_forces(self.forces)

    @property
    def flank_loads(self) -> Array:
        """Elastic forces (2 meshes, K), N, of the drive flanks, then of the back flanks, none negative."""
        loads = np.empty((2 * len(self.forces), self.track.count))
        split_loads(self.forces, NO_LOAD, loads)
        return loads

    @property
    def past_law(self) -> Array:
        """Fraction of the instants (contacts,) at which a contact is compressed beyond the last level of
        its law.
        """
        law = self.response.system.law
        if law.straight:
            return np.zeros(law.contacts)
        last = law.levels[-1]
        if not (self.deepest > last).any():
            return np.zeros(law.contacts)
        past = np.abs(self.beyond) > last[:, None, None]
        return np.asarray(past.mean(axis=(1, 2)))
