"""Coupling of coordinates beside the meshes: further dampers, and the effects of turning bodies."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Mask


@dataclass(frozen=True, eq=False)
class Coupling:
    """Forces (D + W G) y' + (W N + W^2 P) y at an angular speed W (rad/s).

    The matrices are dampers D, gyroscopic G, circulatory N, and centrifugal P, each (n, n).
    """

    dampers: Array
    gyroscopic: Array
    circulatory: Array
    centrifugal: Array

    @property
    def any(self) -> bool:
        """Whether some matrix has an entry."""
        return any(matrix.any() for matrix in self._matrices)

    def directions(self, basis: Array) -> Array:
        """Directions along which the motions of a basis push, each matrix scaled to size one.

        Parameters
        ----------
        basis : (dof, n) array
            Motions, any unit.

        Returns
        -------
        (up to 4 n, dof) array
            Directions in rows, in the unit of the basis.
        """
        rows = [(matrix @ basis).T for matrix in self._matrices]
        sizes = [np.linalg.norm(matrix) for matrix in self._matrices]
        return np.concatenate([row / size for row, size in zip(rows, sizes, strict=True) if size > 0.0])

    def among(self, basis: Array) -> "Coupling":
        """Coupling in the coordinates of a basis.

        Parameters
        ----------
        basis : (dof, n) array
            Displacements of unit coordinates, any unit.

        Returns
        -------
        Coupling
            Matrices (n, n).
        """
        return Coupling(*(basis.T @ matrix @ basis for matrix in self._matrices))

    def linked(self, part: float) -> Mask:
        """Which coordinates some matrix couples by more than a part of its largest entry.

        Parameters
        ----------
        part : float
            Part of the largest entry, a fraction.

        Returns
        -------
        (n, n) array
            True where two coordinates are coupled.
        """
        sizes = [np.abs(matrix) for matrix in self._matrices]
        return np.asarray(np.any([size > part * size.max(initial=0.0) for size in sizes], axis=0))

    def split(self) -> tuple[Array, "Coupling | None"]:
        """Split off the diagonal of the dampers.

        Returns
        -------
        (n,) array
            Diagonal, 1/s.
        Coupling or None
            The rest; None if it is zero.
        """
        diagonal = self.dampers.diagonal().copy()
        left = replace(self, dampers=self.dampers - np.diag(diagonal))
        return diagonal, left if left.any else None

    def per_speed(self, ratio: float) -> "Coupling":
        """Express the coupling by another angular speed.

        Parameters
        ----------
        ratio : float
            The ratio of the other speed to the one before.

        Returns
        -------
        Coupling
            Matrices for the other speed, in the same units.
        """
        gyroscopic, circulatory = self.gyroscopic / ratio, self.circulatory / ratio
        return Coupling(self.dampers, gyroscopic, circulatory, self.centrifugal / ratio**2)

    def velocity_terms(self, speed: float) -> Array:
        """Matrix D / W + G that acts on derivatives by the phase W t.

        Parameters
        ----------
        speed : float
            Angular speed W, rad/s.

        Returns
        -------
        (n, n) array
            Matrix for unit masses, 1/rad.
        """
        return self.dampers / speed + self.gyroscopic

    def displacement_terms(self, speed: float) -> Array:
        """Matrix N / W + P that acts on displacements over the phase W t.

        Parameters
        ----------
        speed : float
            Angular speed W, rad/s.

        Returns
        -------
        (n, n) array
            Matrix for unit masses, 1/rad^2.
        """
        return self.circulatory / speed + self.centrifugal

    def fastest(self, speed: float) -> float:
        """Bound of the angular frequency that the coupling brings by itself.

        Parameters
        ----------
        speed : float
            Angular speed W, rad/s.

        Returns
        -------
        float
            Bound over the speed, dimensionless.
        """
        dampers, gyroscopic, circulatory, centrifugal = (
            np.linalg.norm(matrix, 2) for matrix in self._matrices
        )
        return float(dampers / speed + gyroscopic + np.sqrt(circulatory / speed + centrifugal))

    @property
    def _matrices(self) -> tuple[Array, Array, Array, Array]:
        return self.dampers, self.gyroscopic, self.circulatory, self.centrifugal
