"""What couples coordinates beside the meshes: further dampers, and what turning bodies add."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Mask


@dataclass(frozen=True, eq=False)
class Coupling:
    """Forces (D + W G) y' + (W N + W^2 P) y at an angular speed W (rad/s).

    dampers D, gyroscopic G, circulatory N, centrifugal P: each (n, n).
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
        """Along what the motions of a basis (dof, n) push, (4 n, dof), each matrix of size one."""
        rows = [(matrix @ basis).T for matrix in self._matrices]
        sizes = [np.linalg.norm(matrix) for matrix in self._matrices]
        return np.concatenate([row / size for row, size in zip(rows, sizes, strict=True) if size > 0.0])

    def among(self, basis: Array) -> "Coupling":
        """The same in the coordinates of a basis (dof, n)."""
        return Coupling(*(basis.T @ matrix @ basis for matrix in self._matrices))

    def linked(self, part: float) -> Mask:
        """Which coordinates some matrix couples by more than a part of its largest entry, (n, n)."""
        sizes = [np.abs(matrix) for matrix in self._matrices]
        return np.asarray(np.any([size > part * size.max(initial=0.0) for size in sizes], axis=0))

    def split(self) -> tuple[Array, "Coupling | None"]:
        """The dampers' diagonal (n,), and what is left; None for nothing."""
        own = self.dampers.diagonal().copy()
        left = replace(self, dampers=self.dampers - np.diag(own))
        return own, left if left.any else None

    def per_speed(self, ratio: float) -> "Coupling":
        """The same for another angular speed, which is `ratio` times the one before."""
        gyroscopic, circulatory = self.gyroscopic / ratio, self.circulatory / ratio
        return Coupling(self.dampers, gyroscopic, circulatory, self.centrifugal / ratio**2)

    def velocity_terms(self, speed: float) -> Array:
        """D + W G over W: what acts on derivatives by the phase W t, (n, n)."""
        return self.dampers / speed + self.gyroscopic

    def displacement_terms(self, speed: float) -> Array:
        """W N + W^2 P over W^2, (n, n)."""
        return self.circulatory / speed + self.centrifugal

    def fastest(self, speed: float) -> float:
        """Bound of the angular frequency that the coupling brings by itself, over the speed."""
        dampers, gyroscopic, circulatory, centrifugal = (
            np.linalg.norm(matrix, 2) for matrix in self._matrices
        )
        return float(dampers / speed + gyroscopic + np.sqrt(circulatory / speed + centrifugal))

    @property
    def _matrices(self) -> tuple[Array, Array, Array, Array]:
        return self.dampers, self.gyroscopic, self.circulatory, self.centrifugal
