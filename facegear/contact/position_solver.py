"""The compiled solver for the contact of all pairs of teeth at a position, under all torques."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from facegear._kernels import contact as kernels
from facegear.arrays import Array, Integers, Mask
from facegear.contact.basis_functions import Cover, FacingPairs
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.lattice import Lattice
from facegear.contact.search_strip import SearchStrip
from facegear.contact.solver import NEWTON_STEPS, TOLERANCE


@dataclass(frozen=True, eq=False)
class PositionContact:
    """Contact at a position under torques (t,), the largest first.

    Attributes
    ----------
    teeth : (p,)
        Numbers of the pairs of teeth.
    rotation, slope, residual, steps : (t,)
        As in `ContactSolution`; steps 0 where there is no solution.
    candidates
        How many basis functions the limit of the rotation closes.
    forward
        How many of them can carry the torque.
    strip_size
        Among how many functions the solution is.
    overlap
        Rotation (rad) that would part the teeth where they stand in each other.
    pair, node, lever_arm, fillet : (m,)
        The basis functions that are loaded by any torque, as in `BasisFunctions`.
    force : (t, m)
        Forces on them, N.
    on_pinion, on_gear : (t, p, n)
        Forces (N) of the pairs on the nodes of both surfaces before refinement.
    """

    teeth: Integers
    rotation: Array
    slope: Array
    residual: Array
    steps: Integers
    candidates: int
    forward: int
    strip_size: int
    overlap: float
    pair: Integers
    node: Integers
    lever_arm: Array
    fillet: Mask
    force: Array
    on_pinion: Array
    on_gear: Array


class PositionSolver:
    """Solves the positions of a pair one after the other, in the same memory.

    Parameters
    ----------
    cover : Cover
        Basis functions of the pair.
    lattices, bodies : Sequence
        Contact surface and compliance of pinion and gear.
    is_coupled : bool
        Whether a loaded tooth moves its neighbours.
    """

    def __init__(
        self,
        cover: Cover,
        lattices: Sequence[Lattice],
        bodies: Sequence[FlankCompliance],
        is_coupled: bool = True,
    ) -> None:
        pinion, gear = map(_surface, lattices, bodies)
        self._kernel = kernels.PositionSolver(cover.kernel, pinion, gear, is_coupled, NEWTON_STEPS, TOLERANCE)

    def solve(
        self, facing_pairs: FacingPairs, torques: Array, limit: float, strip: SearchStrip
    ) -> PositionContact:
        """Solve for the contact of what a rotation of the pinion by `limit` closes.

        Parameters
        ----------
        facing_pairs : FacingPairs
            Points of the position that may touch.
        torques : Array
            Torques (t,) N m, the largest first.
        limit : float
            Rotation, rad. If the first torque turns the pinion further, only its rotation is of use.
        strip : SearchStrip
            Where contact is sought at first.

        Returns
        -------
        PositionContact
            Contact under these torques (t,), in SI units (N, m, rad).
        """
        answer = self._kernel.solve(facing_pairs.kernel, torques, limit, *strip)
        return PositionContact(teeth=facing_pairs.teeth, **answer)

    def influence(self, facing_pairs: FacingPairs, limit: float) -> Array:
        """Compute the influence matrix of all basis functions that a rotation of the pinion closes.

        Parameters
        ----------
        facing_pairs : FacingPairs
            Points of the position that may touch.
        limit : float
            Rotation, rad.

        Returns
        -------
        Array
            Approach (m, m) of each function by a unit force on each, m/N.
        """
        return np.asarray(self._kernel.influence(facing_pairs.kernel, limit))

    def approach(self, facing_pairs: FacingPairs, limit: float, forces: Array, cases: Integers) -> Array:
        """Compute the approach of basis functions by forces on them.

        Parameters
        ----------
        facing_pairs : FacingPairs
            Points of the position that may touch.
        limit : float
            Rotation (rad) of the pinion that closes the functions (m,).
        forces : Array
            Forces (t, m) on all of them, N.
        cases : Integers
            Number of load cases, from the first on, in which the approach of each function (m,) is wanted.

        Returns
        -------
        Array
            Approach (k, t), m, of the functions that are wanted in any case; 0 in the others.
        """
        return np.asarray(self._kernel.approach(facing_pairs.kernel, limit, forces, cases))


def _surface(lattice: Lattice, body: FlankCompliance) -> kernels.Surface:
    """Return the contact surface of a gear as the compiled kernels take it."""
    interpolation = lattice.interpolation_rows()
    on_tooth, on_neighbours = map(np.ascontiguousarray, (_by_rows(body.loaded_tooth), body.neighbour_blocks))
    return kernels.Surface(lattice.shape, lattice.steps, *interpolation, on_tooth, on_neighbours, body.scale)


def _by_rows(symmetric: Array) -> Array:
    """Return a symmetric matrix row by row, without a copy where it is stored column by column."""
    return symmetric.T if symmetric.flags.f_contiguous else symmetric
