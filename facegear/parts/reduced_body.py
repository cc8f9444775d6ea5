"""Gear body reduced to its modes, as a machine uses it."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Self

import numpy as np

from facegear.arrays import AnyArray, Array, Integers


@dataclass(frozen=True, eq=False)
class RimForces:
    """Unit forces of the two flanks of a mesh on the rim of a gear, drive flank first.

    Attributes
    ----------
    directions : (2, 3)
        Their parts along the axis towards the teeth, round the axis as angles grow, and outwards.
    turns : (2,)
        Angles past that of the pinion at which they press, rad.
    radii : (2,)
        Distances from the axis at which they press, m.
    middle : float
        Angle past that of the pinion at which the middle of its face stands, rad.
    """

    directions: Array
    turns: Array
    radii: Array
    middle: float = 0.0

    @property
    def push_outwards(self) -> bool:
        """Whether a flank pushes the rim along the radius, as those of spur teeth never do."""
        return bool(self.directions[:, 2].any())


@dataclass(frozen=True, eq=False)
class ReducedBody:
    """m modes of all orders with unit modal mass and the hub held; SI units, in the body's own frame.

    Attributes
    ----------
    order, frequency : (m,)
        Nodal diameters; Hz at rest.
    coriolis, stiffening : (m, m)
        g and S - P, between modes of one order.
    mesh : (3, m)
        W_p, V_p and U_p: motion of the pitch point along the axis, round it and along the radius.
    hub : (2, m)
        Coupling of masses Q with motions of the hub: along and round the axis in order 0, sideways (and tilt)
        in order 1.
    hub_spin : (m,)
        Coupling g of the hub's rotation with modes of order 0, and of its tilt with those of order 1.
    round : (m,)
        1 for modes of order 0 that move round the axis, 0 for all others.
    static : (orders, 3, 3)
        Compliance H_n below a mesh of W_p, V_p and U_p with all modes there are, m/N, from order 0.
    damping_ratio : ()
        Part of the critical damping that every mode has, in the steel.
    stiffness_damping : ()
        Factor beta of the stiffness in the damping D = beta K of the steel, s, beside the former.
    pitch_height : ()
        Height of the pitch plane over height 0, m.
    slope : (m,)
        Slope dW/dr of the rim below the teeth, 1/m; of a body without this none.
    leaning : (orders, 4)
        W_p, V_p, U_p (1/N) and slope (rad/(N m)) by a unit moment on the slope, with all modes there are.
    mass, moment : ()
        Mass of the section, kg, and mass times the height of its centre, kg m.
    """

    order: Integers
    frequency: Array
    coriolis: Array
    stiffening: Array
    mesh: Array
    hub: Array
    hub_spin: Array
    round: Array
    static: Array
    damping_ratio: Array
    pitch_height: Array = field(default_factory=lambda: np.zeros(()))
    slope: Array = field(default_factory=lambda: np.zeros(()))
    leaning: Array = field(default_factory=lambda: np.zeros(()))
    mass: Array = field(default_factory=lambda: np.zeros(()))
    moment: Array = field(default_factory=lambda: np.zeros(()))
    stiffness_damping: Array = field(default_factory=lambda: np.zeros(()))

    @property
    def damping(self) -> Array:
        """Damping of every mode for unit modal mass, 2 zeta w + beta w^2, (m,), 1/s."""
        w = 2.0 * np.pi * self.frequency
        return np.asarray(2.0 * self.damping_ratio * w + self.stiffness_damping * w**2)

    @property
    def slopes(self) -> Array:
        """Slope dW/dr of every mode, (m,), 1/m: `slope`, or zeros of that shape for a body without
        slopes.
        """
        return np.broadcast_to(self.slope, self.order.shape)

    def compliance_with_slope(self, length: float) -> Array:
        """Return the static compliance of W_p, V_p, U_p and `length` times the slope, by unit loads on these
        four.

        Parameters
        ----------
        length : float
            Factor on the slope, m, so that all entries have one unit.

        Returns
        -------
        (orders, 4, 4) array
            m/N, symmetric.
        """
        whole = np.zeros((len(self.static), 4, 4))
        whole[:, :3, :3] = self.static
        leaning = np.broadcast_to(self.leaning, (len(self.static), 4)) * np.array([1.0, 1.0, 1.0, length])
        whole[:, 3], whole[:, :3, 3] = length * leaning, length * leaning[:, :3]
        return whole

    @property
    def modal(self) -> Array:
        """The part of `static` that the modes hold, (orders, 3, 3), m/N: sum over the modes of mesh
        mesh^T / w^2.
        """
        compliances = np.zeros((max(len(self.static), 1 + self.order.max(initial=0)), 3, 3))
        scaled_motions = self.mesh / (2.0 * np.pi * self.frequency)
        np.add.at(compliances, self.order, np.einsum("im,jm->mij", scaled_motions, scaled_motions))
        return compliances[: len(self.static)]

    @property
    def residual(self) -> Array:
        """Residual compliance: the static compliance below a mesh beyond the modes, (orders, 3, 3), m/N."""
        return self.static - self.modal

    @classmethod
    def of_arrays(cls, arrays: Mapping[str, AnyArray], gear: str) -> Self:
        """Read the body of a gear from the arrays that the method `arrays` returned.

        Parameters
        ----------
        arrays : Mapping[str, AnyArray]
            Arrays (...) by the names gear_field, such as upper_frequency, SI units.
        gear : str
            Name of the gear, with which the names of the arrays begin.

        Returns
        -------
        Self
            SI units.
        """
        return cls(**{entry.name: arrays[f"{gear}_{entry.name}"] for entry in fields(cls)})

    def arrays(self, gear: str) -> dict[str, AnyArray]:
        """Return all fields as arrays to be stored.

        Parameters
        ----------
        gear : str
            Name of the gear, with which the names of the arrays begin.

        Returns
        -------
        dict of str to array of any shape (...)
            By the names gear_field, SI units.
        """
        return {f"{gear}_{entry.name}": getattr(self, entry.name) for entry in fields(self)}

    def residual_of_flanks(self, forces: RimForces) -> Array:
        """Return the compliance between flanks of one mesh that the modes leave out, summed over all
        orders.

        Parameters
        ----------
        forces : RimForces
            Unit forces of both flanks.

        Returns
        -------
        (2, 2) array
            Motion of the first flank along its own direction by a unit force on the second, m/N.
        """
        return flank_influence(self.residual, forces.directions, forces.turns)


def flank_influence(compliances: Array, directions: Array, angles: Array) -> Array:
    """Return the motions of flanks against their own forces by unit forces on them.

    A_ij = sum_n Re[e^(-i n (psi_i - psi_j)) a_i* H_n a_j], a = (P_axial, -i P_round, P_radial): a wave's
    motion round the axis is a quarter of a period from the other two.

    Parameters
    ----------
    compliances : (orders, 3, 3) array
        H_n from order 0, m/N.
    directions : (f, 3) array
        Axial, tangential and radial part of a unit force on each flank, dimensionless.
    angles : (f,) array
        Angles of the flanks, rad.

    Returns
    -------
    (f, f) array
        m/N.
    """
    loads = directions * np.array([1.0, -1j, 1.0])
    phases = np.exp(-1j * np.arange(len(compliances))[:, None, None] * (angles[:, None] - angles))
    return np.asarray(np.real(phases * (loads.conj() @ compliances @ loads.T)).sum(axis=0))
