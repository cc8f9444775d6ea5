"""Elastic forces of the meshes at instants closer than the samples of a response."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.steady_state.mesh_samples import errors_of_period
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.track import Track
from facegear.mesh_law.law import beyond_edges
from facegear.transmission.flanks import carried


@dataclass(frozen=True, eq=False)
class DenseMotion:
    """A response at K evenly spaced instants, per_period of them in each mesh period."""

    response: SteadyState
    per_period: int
    track: Track

    @cached_property
    def beyond(self) -> Array:
        """How far each mesh or flank is pressed in (contacts, periods, per_period), m."""
        system = self.response.system
        jacobian = system.mesh_jacobian[: system.contacts].T
        deflections = self.track.along(jacobian, np.zeros_like(jacobian))
        by_period = deflections.reshape(system.contacts, -1, self.per_period)
        by_period -= errors_of_period(system, self.per_period).T[:, None]
        edges = (system.lower, system.upper)
        lower, upper = (edge[: system.contacts, None, None] for edge in edges)
        return beyond_edges(by_period, lower, upper)

    @cached_property
    def forces(self) -> Array:
        """Elastic mesh forces (meshes, K), N; with two flanks what both transmit."""
        system, cycles = self.response.system, np.arange(self.per_period) / self.per_period
        each = system.law.force(cycles, np.moveaxis(self.beyond, 0, -1))
        forces = np.moveaxis(each, -1, 0).reshape(system.contacts, -1)
        if not system.two_flanks:
            return forces
        drive, back = np.split(forces, 2)
        return drive - back

    @cached_property
    def loads(self) -> Array:
        """The same without those that are rounding beside the largest."""
        return carried(self.forces)

    @property
    def past_law(self) -> Array:
        """Fraction of the instants (contacts,) at which a contact is pressed in past the last level of its
        law.
        """
        law = self.response.system.law
        if law.straight:
            return np.zeros(law.contacts)
        past = np.abs(self.beyond) > law.levels[-1][:, None, None]
        return np.asarray(past.mean(axis=(1, 2)))
