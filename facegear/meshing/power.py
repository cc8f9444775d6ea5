"""The power law: a factor of the phase times c x^n, as Hertz's law of a sphere has it with n = 1.5.

x^n has no Taylor series at zero. Below a small level the law is therefore the cubic with slope zero at zero
that has value and slope of x^n at the level (Hermite); above it, it is x^n itself.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from facegear._kernels import motion
from facegear.arrays import Array


class PowerHeld(NamedTuple):
    """Bounds of the slopes (K, M), N/m, at K phases; it has no kernel, so statics evaluates the law
    itself.
    """

    stiffness: Array


@dataclass(frozen=True, eq=False)
class PowerLaw:
    """(1 + depth cos phase) size x^exponent of every contact.

    Attributes
    ----------
    size
        Force at x = 1 m, N.
    exponent
        Above 1.
    level
        Amount below which the law is a cubic, m.
    depth
        Part by which the force changes over the mesh period, from 0 to below 1.
    contacts
        Their number M.
    largest
        Amount up to which the slope is bounded, m.
    """

    size: float = 1.0
    exponent: float = 1.5
    level: float = 1e-3
    depth: float = 0.0
    contacts: int = 1
    largest: float = 4.0

    @property
    def breaks(self) -> Array:
        """Phases at which the law is not smooth: none."""
        return np.zeros(0)

    @property
    def straight(self) -> bool:
        """Whether the force is linear in the deflection beyond the edge: it is a power."""
        return False

    @property
    def levels(self) -> Array:
        """Deflections (2, M) at which the law's pieces begin: the edge, and where the power begins, m."""
        return np.repeat([[0.0], [self.level]], self.contacts, axis=1)

    @property
    def steepest(self) -> Array:
        """Slope (M,) at the largest deflection and phase factor, N/m."""
        return np.full(self.contacts, (1.0 + self.depth) * self._slope(np.array(self.largest)))

    @property
    def harmonic_fractions(self) -> Array:
        """Fractions (2,) of the slope's bound by the mean and by the first harmonic: 1 and depth, over 1
        + depth.
        """
        return np.array([1.0, self.depth]) / (1.0 + self.depth)

    def force(self, cycles: Array, beyond: Array) -> Array:
        """Return the forces of the contacts.

        Parameters
        ----------
        cycles : Array
            Mesh periods since the start (K,), dimensionless.
        beyond : Array
            Compressions of the contacts (..., K, M), m; negative on a back flank.

        Returns
        -------
        Array
            Forces (..., K, M), N.
        """
        return np.asarray(self._factor(cycles)[:, None] * np.sign(beyond) * self._shape(np.abs(beyond)))

    def slope(self, cycles: Array, beyond: Array) -> Array:
        """Return the derivatives of the forces by the compressions.

        Parameters
        ----------
        cycles : Array
            Mesh periods since the start (K,), dimensionless.
        beyond : Array
            Compressions of the contacts (..., K, M), m; negative on a back flank.

        Returns
        -------
        Array
            Slopes (..., K, M), N/m.
        """
        return np.asarray(self._factor(cycles)[:, None] * self._slope(np.abs(beyond)))

    def mean(self) -> "PowerLaw":
        """Return the law without its change over the mesh period.

        Returns
        -------
        PowerLaw
            The mean law.
        """
        return replace(self, depth=0.0)

    def at_phase(self, cycle: float) -> "PowerLaw":
        """Return the law at one phase.

        Parameters
        ----------
        cycle : float
            Mesh periods since the start, dimensionless.

        Returns
        -------
        PowerLaw
            The law, which no longer depends on the phase.
        """
        return replace(self, depth=0.0, size=self.size * float(self._factor(np.array(cycle))))

    def statics_law(self, cycles: Array) -> PowerHeld:
        """Return the bounds of the slopes for statics.

        Parameters
        ----------
        cycles : Array
            Mesh periods since the start (K,), dimensionless.

        Returns
        -------
        PowerHeld
            Bounds (K, M), N/m.
        """
        return PowerHeld(np.full((cycles.size, self.contacts), self.steepest[0]))

    @property
    def numbers(self) -> dict[str, Any]:
        """Arguments of motion.power_law: factor (1, 2, 2), the series 1 + depth cos, sine part first;
        size, exponent, level and number of contacts.
        """
        return {
            "factor": np.array([[[0.0, 0.0], [1.0, self.depth]]]),
            "size": self.size,
            "exponent": self.exponent,
            "level": self.level,
            "contacts": self.contacts,
        }

    @cached_property
    def kernel_law(self) -> motion.PowerLaw:
        """The law as the integrator's kernels take it."""
        return motion.power_law(**self.numbers)

    @property
    def _start(self) -> tuple[float, float]:
        """Coefficients of x^2 and x^3 of the cubic below the level, for a size of 1, with x in m."""
        n, x = self.exponent, self.level
        return (3.0 - n) * x ** (n - 2.0), (n - 2.0) * x ** (n - 3.0)

    def _factor(self, cycles: Array) -> Array:
        """Return the factor 1 + depth cos(2 pi cycles) on the force at mesh periods `cycles`, of the same
        shape.
        """
        return np.asarray(1.0 + self.depth * np.cos(2.0 * np.pi * cycles))

    def _shape(self, x: Array) -> Array:
        """Return the mean force, N, at compressions `x` >= 0, m, of any shape: a power law, cubic below
        `level`.
        """
        a, b = self._start
        return self.size * np.where(x < self.level, x**2 * (a + b * x), x**self.exponent)

    def _slope(self, x: Array) -> Array:
        """Return the derivative of the mean force by the compression, N/m, at compressions `x` >= 0, m,
        of any shape.
        """
        a, b = self._start
        high = self.exponent * np.maximum(x, self.level) ** (self.exponent - 1.0)
        return self.size * np.where(x < self.level, x * (2.0 * a + 3.0 * b * x), high)
