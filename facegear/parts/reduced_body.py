"""Gear body reduced to its modes, as a machine uses it."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Self

import numpy as np

from facegear.arrays import AnyArray, Array, Integers


@dataclass(frozen=True, eq=False)
class ReducedBody:
    """m modes of all orders with unit modal mass and the hub held; SI units, in the body's own frame.

    Attributes
    ----------
    order, frequency : (m,)
        Nodal diameters; Hz at rest.
    coriolis, stiffening : (m, m)
        g and S - P, between modes of one order.
    mesh : (2, m)
        W_p and V_p: motion of the pitch point along the axis and round it.
    hub : (2, m)
        Coupling of masses Q with motions of the hub: along and round the axis in order 0, sideways (and tilt)
        in order 1.
    hub_spin : (m,)
        Coupling g of the hub's rotation with modes of order 0, and of its tilt with those of order 1.
    round : (m,)
        1 for modes of order 0 that move round the axis, 0 for all others.
    static : (orders, 2, 2)
        Compliance H_n below a mesh of W_p and V_p with all modes there are, m/N, from order 0.
    damping_ratio : ()
        Part of the critical damping that every mode has, in the steel.
    stiffness_damping : ()
        Factor beta of the stiffness in the damping D = beta K of the steel, s, beside the former.
    pitch_height : ()
        Height of the pitch plane over height 0, m.
    slope : (m,)
        Slope dW/dr of the rim below the teeth, 1/m; of a body without this none.
    leaning : (orders, 3)
        W_p, V_p (1/N) and slope (rad/(N m)) by a unit moment on the slope, with all modes there are.
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
        """Return the static compliance of W_p, V_p and `length` times the slope, by unit loads on these
        three.

        Parameters
        ----------
        length : float
            Factor on the slope, m, so that all entries have one unit.

        Returns
        -------
        (orders, 3, 3) array
            m/N, symmetric.
        """
        whole = np.zeros((len(self.static), 3, 3))
        whole[:, :2, :2] = self.static
        leaning = np.broadcast_to(self.leaning, (len(self.static), 3)) * np.array([1.0, 1.0, length])
        whole[:, 2], whole[:, :2, 2] = length * leaning, length * leaning[:, :2]
        return whole

    @property
    def modal(self) -> Array:
        """The part of `static` that the modes hold, (orders, 2, 2), m/N: sum over the modes of mesh
        mesh^T / w^2.
        """
        compliances = np.zeros((max(len(self.static), 1 + self.order.max(initial=0)), 2, 2))
        scaled_motions = self.mesh / (2.0 * np.pi * self.frequency)
        np.add.at(compliances, self.order, np.einsum("im,jm->mij", scaled_motions, scaled_motions))
        return compliances[: len(self.static)]

    @property
    def residual(self) -> Array:
        """Residual compliance: the static compliance below a mesh beyond the modes, (orders, 2, 2), m/N."""
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

    def residual_of_flanks(self, directions: Array) -> Array:
        """Return the compliance between flanks of one mesh that the modes leave out, summed over all
        orders.

        Motions along the axis and round it are a quarter wave apart, so that they do not mix.

        Parameters
        ----------
        directions : (f, 2) array
            Axial and tangential part of a unit force on each flank, dimensionless.

        Returns
        -------
        (f, f) array
            Motion of the first flank along its own direction by a unit force on the second, m/N.
        """
        return np.asarray((directions * np.diagonal(self.residual.sum(axis=0))) @ directions.T)
