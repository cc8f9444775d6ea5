"""Law of contacts whose place in the mesh cycle moves with their pinions."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from facegear._kernels import motion
from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.meshing.law import LawAtPhases, MeshLaw
from facegear.meshing.linear import LinearLaw
from facegear.meshing.load_dependent import LoadDependentLaw

PERIOD = 2.0 * np.pi
"""A mesh period, rad."""
POWERS = 5
"""Powers of the compression in the energy of a contact, from 0 to 4, as forces are cubics."""


@dataclass(frozen=True, eq=False)
class MovingLaw:
    """A law that derives from an energy of the compression and of the place in the mesh cycle.

    The place of a contact, rad, is how far its flank has moved on beside the even rotation. The force is the
    energy's derivative by the compression, the reaction that by the place. At the place 0, which methods of
    every law take, it is `steady`.

    Attributes
    ----------
    steady : LinearLaw or LoadDependentLaw
        The law of contacts that stay at their places; a linear law without pieces between breaks.
    first_place : int
        Row of the kernels' deflections that holds the place of the first contact.
    """

    steady: LinearLaw | LoadDependentLaw
    first_place: int

    @property
    def contacts(self) -> int:
        """The number M of contacts."""
        return self.steady.contacts

    @property
    def breaks(self) -> Array:
        """Phases at which the law is not smooth: none."""
        return self.steady.breaks

    @property
    def levels(self) -> Array:
        """Compressions (L, M), m, at which the pieces of the law begin."""
        return self.steady.levels

    @property
    def straight(self) -> bool:
        """Whether the force is linear in the compression at a fixed place."""
        return self.steady.straight

    @property
    def steepest(self) -> Array:
        """Upper bound (M,) of the derivative of the force by the compression, N/m."""
        return self.steady.steepest

    @property
    def harmonic_fractions(self) -> Array:
        """Fractions (H + 1,) of the slope's bound by the order of the phase, dimensionless."""
        return self.steady.harmonic_fractions

    def force(self, cycles: Array, beyond: Array) -> Array:
        """Return the forces of contacts that stay at their places.

        Parameters
        ----------
        cycles : (K,) array
            Mesh periods since the start.
        beyond : (..., K, M) array
            Compression of the contacts, m.

        Returns
        -------
        (..., K, M) array
            N.
        """
        return self.steady.force(cycles, beyond)

    def slope(self, cycles: Array, beyond: Array) -> Array:
        """Return the derivatives of the forces by the compressions at the places 0.

        Parameters
        ----------
        cycles : (K,) array
            Mesh periods since the start.
        beyond : (..., K, M) array
            Compression of the contacts, m.

        Returns
        -------
        (..., K, M) array
            N/m.
        """
        return self.steady.slope(cycles, beyond)

    def mean(self) -> LinearLaw | LoadDependentLaw:
        """Return the law averaged over the mesh period, in which places have no effect.

        Returns
        -------
        LinearLaw or LoadDependentLaw
            A law that does not depend on the phase.
        """
        return self.steady.mean()

    def at_phase(self, cycle: float) -> LinearLaw | LoadDependentLaw:
        """Return the law at one phase and the places 0.

        Parameters
        ----------
        cycle : float
            Mesh periods since the start.

        Returns
        -------
        LinearLaw or LoadDependentLaw
            A law that does not depend on the phase.
        """
        return self.steady.at_phase(cycle)

    def statics_law(self, cycles: Array) -> LawAtPhases:
        """Evaluate the law at some phases and the places 0.

        Parameters
        ----------
        cycles : Array
            Mesh periods since the start (K,), dimensionless.

        Returns
        -------
        LawAtPhases
            The law at these phases.
        """
        return self.steady.statics_law(cycles)

    def energy(self, cycles: Array, beyond: Array, phase_shifts: Array, orders: tuple[int, int]) -> Array:
        """Return a derivative of the energies of the contacts.

        Parameters
        ----------
        cycles : (K,) array
            Mesh periods since the start.
        beyond : (..., K, M) array
            Compression of the contacts, m; none is negative.
        phase_shifts : (..., K, M) array
            Places of the contacts, rad.
        orders : tuple of int
            How often the energy is derived by the compression and by the place: (1, 0) is the force, N, and
            (0, 1) the reaction, N m.

        Returns
        -------
        (..., K, M) array
            N m over m and rad to these orders; 0 where nothing is compressed.
        """
        by_amount, by_place = orders
        angle = PERIOD * np.asarray(cycles)[:, None] + phase_shifts
        result = np.zeros(np.broadcast_shapes(angle.shape, beyond.shape))
        number = np.arange(self.table.shape[2])
        for contact, kind in enumerate(self.kinds):
            amount = np.broadcast_to(beyond[..., contact], result.shape[:-1])
            piece = np.searchsorted(self.kind_levels[kind], amount, side="right") - 1
            piece = np.maximum(piece, 0)
            rest = amount - self.kind_levels[kind][piece]
            angles = number * angle[..., contact, None] + 0.5 * np.pi * by_place
            waves = np.stack([np.sin(angles), np.cos(angles)], axis=-1) * (number**by_place)[:, None]
            factors = np.einsum("...hp,...hpk->...k", waves, self.table[kind][piece])
            value = np.zeros(result.shape[:-1])
            for power in range(by_amount, POWERS):
                weight = np.prod(np.arange(power - by_amount + 1, power + 1))
                value += weight * factors[..., power] * rest ** (power - by_amount)
            result[..., contact] = np.where(amount > 0.0, value, 0.0)
        return result

    @cached_property
    def kinds(self) -> list[int]:
        """Row of `table` of each contact."""
        return [int(kind) for kind in self.steady.kind]

    @cached_property
    def kind_levels(self) -> Array:
        """Compressions (kinds, L), m, at which the pieces of each kind begin."""
        if isinstance(self.steady, LinearLaw):
            return np.zeros((len(self.steady.fourier), 1))
        return np.ascontiguousarray(self.steady.numbers["levels"])

    @cached_property
    def table(self) -> Array:
        """Series (kinds, L, harmonics + 1, 2, POWERS) of the energy's factors by powers of the compression
        since a piece began, sine part first, N m over m to the power.
        """
        if isinstance(self.steady, LinearLaw):
            cubics = np.zeros((*self.kind_levels.shape, self.steady.fourier.shape[2], 2, 4))
            cubics[:, 0, :, :, 1] = np.moveaxis(self.steady.fourier, 1, 2)
        else:
            cubics = self.steady.numbers["table"]
        table = np.zeros((*cubics.shape[:-1], POWERS))
        table[..., 1:] = cubics / np.arange(1, POWERS)
        widths = np.diff(self.kind_levels, axis=1)
        for piece in range(1, table.shape[1]):
            powers = widths[:, piece - 1, None] ** np.arange(POWERS)
            table[:, piece, :, :, 0] = np.einsum("khpq,kq->khp", table[:, piece - 1], powers)
        return table

    @property
    def numbers(self) -> dict[str, Any]:
        """Arguments of motion.moving_law: table, levels (m), kind and first_place."""
        kind = np.ascontiguousarray(self.kinds, np.int64)
        return {
            "table": self.table,
            "levels": self.kind_levels,
            "kind": kind,
            "first_place": self.first_place,
        }

    @cached_property
    def kernel_law(self) -> motion.MovingLaw:
        """The law as the integrator's kernels take it, made once."""
        return motion.moving_law(**self.numbers)


def moving_law(steady: MeshLaw, first_place: int) -> MovingLaw:
    """Return the law of contacts that move in the mesh cycle from that of contacts that do not.

    Parameters
    ----------
    steady : MeshLaw
        Law of contacts that stay at their places.
    first_place : int
        Row of the kernels' deflections that holds the place of the first contact.

    Returns
    -------
    MovingLaw
        N, m and rad.

    Raises
    ------
    InvalidInput
        If the law has breaks in the mesh cycle or powers of the compression that are no whole numbers.
    """
    if not isinstance(steady, LinearLaw | LoadDependentLaw) or steady.breaks.size:
        raise InvalidInput("places of meshes", "moving", "fixed, where the stiffness jumps in the mesh cycle")
    return MovingLaw(steady, first_place)
