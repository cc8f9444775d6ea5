"""The compiled solver for the contact of all pairs of teeth at a position, under all torques."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from facegear._kernels import contact as kernels
from facegear.arrays import Array, Integers, Mask
from facegear.contact.basis_functions import Cover, Facing
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
    sought
        Among how many the solution is.
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
    sought: int
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
    coupled : bool
        Whether a loaded tooth moves its neighbours.
    """

    def __init__(
        self,
        cover: Cover,
        lattices: Sequence[Lattice],
        bodies: Sequence[FlankCompliance],
        coupled: bool = True,
    ) -> None:
        pinion, gear = (_surface(*each) for each in zip(lattices, bodies, strict=True))
        self._kernel = kernels.PositionSolver(cover.kernel, pinion, gear, coupled, NEWTON_STEPS, TOLERANCE)

    def solve(self, facing: Facing, torques: Array, limit: float, strip: SearchStrip) -> PositionContact:
        """Solve for the contact of what a rotation of the pinion by `limit` closes.

        Parameters
        ----------
        facing : Facing
            Points of the position that may touch.
        torques : Array
            Torques (t,) N m, the largest first.
        limit : float
            Rotation, rad. If the first torque turns the pinion further, only its rotation is of use.
        strip : SearchStrip
            Where contact is sought at first.
        """
        found = self._kernel.solve(facing.kernel, torques, limit, *strip)
        return PositionContact(teeth=facing.teeth, **found)

    def influence(self, facing: Facing, limit: float) -> Array:
        """Return the influence matrix (m, m), m/N, of the basis functions that `limit` (rad) closes."""
        return self._kernel.influence(facing.kernel, limit)

    def approach(self, facing: Facing, limit: float, forces: Array, cases: Integers) -> Array:
        """Return the approach (k, t), m, of the basis functions that `limit` (rad) closes, by forces on them.

        Parameters
        ----------
        facing, limit
            As in `influence`.
        forces : Array
            Forces (t, m) on all of these functions, N.
        cases : Integers
            How many of the load cases each function (m,) is asked for, from the first on; the approach is 0
            in others, and functions that are asked for in none are left out.
        """
        return self._kernel.approach(facing.kernel, limit, forces, cases)


def _surface(lattice: Lattice, body: FlankCompliance) -> kernels.Surface:
    """Return the contact surface of a gear as the compiled kernels take it."""
    own, others = (np.ascontiguousarray(array) for array in (_by_rows(body.own), body.others))
    return kernels.Surface(lattice.shape, lattice.steps, *lattice.interpolated(), own, others, body.scale)


def _by_rows(symmetric: Array) -> Array:
    """Return a symmetric matrix row by row, without a copy where it is stored column by column."""
    return symmetric.T if symmetric.flags.f_contiguous else symmetric
