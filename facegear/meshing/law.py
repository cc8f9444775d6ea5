"""Interface of a contact's force for statics, dynamics, tangents and load sharing.

Laws of contacts at some phases of the mesh period, as statics takes them. The kernel's counterparts are in
`facegear/_kernels/src/statics/laws.hpp`.
"""

from typing import Any, NamedTuple, Protocol

import numpy as np

from facegear.arrays import Array, Integers


class LawAtPhases(Protocol):
    """Law of M contacts at K phases as the compiled statics takes it; classes other than `LinearHeld` and
    `LoadDependentHeld` only bound the slopes by `stiffness`, (K, M), N/m.
    """

    @property
    def stiffness(self) -> Array:
        """Bounds of the slopes (K, M), N/m."""


class MeshLaw(Protocol):
    """Elastic forces of M contacts.

    A force depends on the phase in the mesh period and on the compression of the contact beyond its edge;
    it is zero, and begins with slope zero or more, at the edge. Where the two flanks of a mesh share one line
    of action they are one contact, with a negative compression on its back flank: the law is odd
    there. The arguments of the methods:

    - cycles (K,): mesh periods since the start;
    - beyond (..., K, M): compression of each contact, m; forces in N, slopes in N/m.
    """

    @property
    def contacts(self) -> int:
        """The number M of contacts."""

    @property
    def breaks(self) -> Array:
        """Phases from 0 to 1, in mesh periods, at which the law is not smooth in the phase; (0,) where it
        is smooth throughout.
        """

    @property
    def levels(self) -> Array:
        """Compressions (L, M), m, at which the pieces of the law begin, rising. The first row is zero,
        the edge.
        """

    @property
    def straight(self) -> bool:
        """Whether the force of a compressed contact is linear in the compression."""

    @property
    def steepest(self) -> Array:
        """Upper bound (M,) of the derivative of the force by the compression, over phase and compression,
        N/m.
        """

    @property
    def harmonic_fractions(self) -> Array:
        """Fractions (H + 1,) of the slope's bound by the order of the phase, from the mean on: each is
        the order's amplitude over `steepest`, the largest of all contacts. A time step is chosen by them.
        """

    def force(self, cycles: Array, beyond: Array) -> Array:
        """Return the forces of the contacts.

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

    def slope(self, cycles: Array, beyond: Array) -> Array:
        """Return the derivatives of the forces by the compressions.

        Parameters
        ----------
        cycles : (K,) array
            Mesh periods since the start.
        beyond : (..., K, M) array
            Compression of the contacts, m.

        Returns
        -------
        (..., K, M) array
            N/m; zero where the compression is zero.
        """

    def mean(self) -> "MeshLaw":
        """Return the law averaged over the mesh period at fixed compressions.

        Returns
        -------
        MeshLaw
            A law that does not depend on the phase.
        """

    def at_phase(self, cycle: float) -> "MeshLaw":
        """Return the law at one phase, whatever the phase.

        Parameters
        ----------
        cycle : float
            Mesh periods since the start.

        Returns
        -------
        MeshLaw
            A law that does not depend on the phase.
        """

    def statics_law(self, cycles: Array) -> LawAtPhases:
        """Evaluate the law at some phases for statics.

        `LinearHeld` and `LoadDependentHeld` have a kernel. With any other result, statics evaluates the
        forces of the law itself, position by position.

        Parameters
        ----------
        cycles : Array
            Mesh periods since the start (K,), dimensionless.

        Returns
        -------
        LawAtPhases
            The law at these phases.
        """

    @property
    def numbers(self) -> dict[str, Any]:
        """Arrays and numbers of the law, by the argument names of its function in
        `facegear._kernels.motion` (`linear_law`, `load_dependent_law`, `power_law`).
        """

    @property
    def kernel_law(self) -> Any:
        """The law as an object for the integrator's kernels: one of `Law` in
        facegear/_kernels/src/motion/laws/all.hpp.
        """


def past_levels(law: MeshLaw, beyond: Array) -> Array:
    """Return the fraction of positions at which contacts are compressed past the last level of a law.

    Parameters
    ----------
    law : MeshLaw
        The law.
    beyond : (K, M) array
        Compression of the contacts, m.

    Returns
    -------
    (M,) array
        Fraction of the K rows, relative; 0 for a law that is straight.
    """
    if law.straight:
        return np.zeros(law.contacts)
    return np.asarray((np.abs(beyond) > law.levels[-1]).mean(axis=0))


def beyond_edges(deflections: Array, lower: Array, upper: Array) -> Array:
    """Return the compression of contacts: deflection above `upper`, or negative below `lower`, else 0.

    A contact with lower >= upper is never open; both directions count from `upper`.

    Parameters
    ----------
    deflections : (..., M) array
        Deflections, m.
    lower : (M,) array
        Lower edges, m; minus infinity for a contact that only pushes.
    upper : (M,) array
        Upper edges, m.

    Returns
    -------
    (..., M) array
        Compression, m.
    """
    lower = np.where(lower >= upper, upper, lower)
    inside = np.maximum(deflections, lower)
    np.minimum(inside, upper, out=inside)
    return np.subtract(deflections, inside, out=inside)


class LinearHeld(NamedTuple):
    """Linear law of M contacts at K phases: stiffness (K, M), N/m."""

    stiffness: Array


class LoadDependentHeld(NamedTuple):
    """Load-dependent law of M contacts at K phases, as the compiled statics takes it.

    Attributes
    ----------
    stiffness : (K, M)
        Upper bounds of the slopes, N/m.
    cosine, sine : (K, harmonics + 1)
        cos and sin of 2 pi times order times phase.
    table : (kinds, levels, harmonics + 1, 2, 4)
        Series of the cubics' coefficients, sine part first, by powers of the compression since the level,
        N and m.
    levels : (kinds, levels)
        Compressions at which the cubics begin, m.
    kind : (M,)
        Row of the table of each contact.
    """

    stiffness: Array
    cosine: Array
    sine: Array
    table: Array
    levels: Array
    kind: Integers
