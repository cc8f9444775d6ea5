"""The compiled solver for the contact of all pairs of teeth at a position, under all torques.

Frictionless unilateral contact of two condensed bodies turned against each other by a torque. Find forces f
>= 0 and the rotation r with gap + C f - r a >= 0, f . (gap + C f - r a) = 0, a . f = torque, a the lever
arms: the optimality conditions of a convex quadratic programme, hence one solution for a positive definite C.
A primal-dual active set (semismooth Newton; Hintermueller et al. 2003) finishes in a few steps; should it
cycle, a single-exchange active set, which lowers the energy at each step, finishes the work.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from facegear._kernels import contact as kernels
from facegear.arrays import Array, Integers, Mask
from facegear.contact.basis_functions import Cover, FacingPairs, Lattice
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.errors import NotConverged

GAP, WIDTH = 0.8, 0.23
"""Where contact is sought: the least gap of a column of functions as a part of the rigid approach (the bodies
give way by the rest), and by how much the gap of others in it exceeds that, as a part of what it is below.
Found by trial. No result depends on them: functions that are missed join the strip."""

WIDER = 1.6
"""Factor on the second part where contact is missed beside the strip."""

KNOWN_WIDTH = 0.08
"""In place of WIDTH where the contact of a pair that differs little is known: its functions are in the strip,
too."""

START_GAP, START_WIDTH = 0.6, 0.14
"""GAP and WIDTH of the first guess of what touches."""


class SearchStrip(NamedTuple):
    """Width of the strip of functions in which contact is sought.

    The rotation t = gap / lever arm closes a function; c is the least t of its pair in its column of the
    lattice. The function is in the strip if t - c < width (gap * limit - c), with `gap` and `width` of
    this tuple.

    Attributes
    ----------
    gap, width, wider
        GAP, WIDTH and WIDER, or values in their place.
    begin, begin_width
        Where the search starts: START_GAP of the rotation that is expected under the first torque, as a
        part of the limit, and START_WIDTH.
    near : (p, n)
        Nodes of the lattice of each pair whose functions belong to the strip in any case; (0, 0) if none
        is known to.
    """

    gap: float
    width: float
    wider: float
    begin: float
    begin_width: float
    near: Mask


NEWTON_STEPS = 40
"""Steps after which Newton's method gives way to the exchange of single points; it takes some three."""
TOLERANCE = 1e-11
"""Penetration that counts as rounding, over the displacement by the rotation and the widest gap closed."""


@dataclass(frozen=True, eq=False)
class ContactSolution:
    """A contact loaded by a torque.

    Attributes
    ----------
    torque
        N m.
    force : (n,)
        N.
    rotation
        rad (the approach in m where lever arms are 1).
    slope
        d rotation / d torque with the contact area following the load, rad/(N m).
    residual
        Largest relative violation of the conditions.
    steps
        Of the active set.
    """

    torque: float
    force: Array
    rotation: float
    slope: float
    residual: float
    steps: int

    @property
    def active(self) -> Mask:
        """Mask of the points in contact (n,), those with a force."""
        return self.force > 0.0


def solve_contact(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    start: Mask | None = None,
    place_text: str = "this position",
) -> ContactSolution:
    """Solve for the contact under a torque.

    The result does not depend on the guess `start` beyond rounding.

    Parameters
    ----------
    compliance : (n, n) array
        m/N.
    gap : (n,) array
        m.
    lever_arm : (n,) array
        m.
    torque : float
        N m, above 0.
    start : (n,) array of bool, optional
        Guess of the points in contact.
    place_text : str
        Names the position in errors.

    Returns
    -------
    ContactSolution
        Forces and rotation, in SI units.

    Raises
    ------
    NotConverged
        Names `place_text`.
    ValueError
        Where the torque is not positive.
    """
    if not torque > 0.0:
        raise ValueError(f"torque = {torque}: must be positive")
    if not (lever_arm > 0.0).any():
        raise NotConverged("contact", place_text, "no candidate point can carry the torque")
    matrix, gaps, arms = (np.ascontiguousarray(array, float) for array in (compliance, gap, lever_arm))
    begin = np.zeros(gap.size, bool) if start is None else np.ascontiguousarray(start)
    answer = kernels.solve_active_set(matrix, gaps, arms, torque, begin, NEWTON_STEPS, TOLERANCE)
    check_solved(answer["steps"], answer["residual"], gap.size, place_text)
    del answer["force_change"]
    return ContactSolution(torque=torque, **answer)


def check_solved(steps: int, residual: float, points: int, place_text: str) -> None:
    """Raise NotConverged if no solution was found, or its residual is not below 10 TOLERANCE.

    Parameters
    ----------
    steps : int
        Steps of the solver, 0 without a solution.
    residual : float
        Largest relative violation of the conditions, dimensionless.
    points : int
        Number of points that may touch.
    place_text : str
        Names the position in the error.

    Raises
    ------
    NotConverged
        Names `place_text`.
    """
    if not steps:
        attempts = f"{NEWTON_STEPS} Newton and {kernels.exchange_steps(points)} exchange steps"
        raise NotConverged("contact", place_text, attempts)
    if not residual < TOLERANCE * 10:
        raise NotConverged("contact", place_text, f"KKT residual {residual:.1e} after {steps} steps")


def kkt_residual(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    force: Array,
    rotation: float,
) -> float:
    """Compute the largest relative violation of balance, no tension, no penetration and complementarity.

    With d = gap + C f - r a it is the largest of abs(a . f - torque) / torque, -min f / max f, -min d / s,
    and abs(d) / s at points with a force; s is the largest abs(r a) plus the largest abs(gap) at points with
    a force.

    Parameters
    ----------
    compliance : (n, n) array
        C, m/N.
    gap : (n,) array
        m.
    lever_arm : (n,) array
        a, m.
    torque : float
        N m.
    force : (n,) array
        f, N.
    rotation : float
        r, rad.

    Returns
    -------
    float
        Violation, dimensionless.
    """
    distance = gap + compliance @ force - rotation * lever_arm
    is_pressed = force != 0.0
    scale = np.abs(rotation * lever_arm).max() + np.abs(gap[is_pressed]).max(initial=0.0)
    return float(
        max(
            abs(lever_arm @ force - torque) / torque,
            -force.min() / force.max(),
            -distance.min() / scale,
            np.abs(distance[is_pressed]).max(initial=0.0) / scale,
        )
    )


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
        """Hand surfaces and compliances of pinion and gear to the compiled solver.

        Parameters
        ----------
        cover : Cover
            Basis functions of the pair.
        lattices, bodies : Sequence
            Contact surface and compliance of pinion and gear, in this order.
        is_coupled : bool
            Whether a loaded tooth moves its neighbours.
        """
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
        """Compute the influence matrix of all basis functions whose gap a rotation of the pinion would
        close.

        Parameters
        ----------
        facing_pairs : FacingPairs
            Points of the position that may touch.
        limit : float
            Rotation, rad.

        Returns
        -------
        Array
            Approach (m, m) of each function, of both bodies together, by a unit force on each, m/N.
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
    """Return lattice, interpolation and compliance arrays of a gear as the object that the compiled
    solver takes.
    """
    interpolation = lattice.interpolation_rows()
    on_tooth, on_neighbours = map(np.ascontiguousarray, (_by_rows(body.loaded_tooth), body.neighbour_blocks))
    return kernels.Surface(lattice.shape, lattice.steps, *interpolation, on_tooth, on_neighbours, body.scale)


def _by_rows(symmetric: Array) -> Array:
    """Return a symmetric matrix (n, n) in row order: its transpose, without a copy, if it is stored by
    columns.
    """
    return symmetric.T if symmetric.flags.f_contiguous else symmetric
