"""Exact reduction to the motions that meshes excite or feel, and coupling beside the meshes.

Reduce the coordinates: leave out exactly the motions that no mesh can excite or feel. Degrees of freedom with
the same bearing frequency (and so, with C = lambda M + beta K, the same damping) may be combined freely. Of
each such group, only the combinations that appear in a mesh deflection move together with the others. The
rest (pinion axial motions, the rigid rotation, one translation of each pinion) are decoupled. Further dampers
and turning bodies couple coordinates, too. Coordinates that they couple to a motion in the basis are in the
basis as well.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy
from scipy.sparse.csgraph import connected_components

from facegear.arrays import Array, Integers, Mask
from facegear.machine.linear_model import LinearModel


@dataclass(frozen=True, eq=False)
class Coupling:
    """Forces (D + W G) y' + (W N + W^2 P) y, on the left side of the equations of motion, at an angular
    speed W.

    W is the speed of the pinions or the mesh frequency, rad/s, see per_speed().

    The matrices are dampers D, gyroscopic G, circulatory N, and centrifugal P, each (n, n).
    """

    dampers: Array
    gyroscopic: Array
    circulatory: Array
    centrifugal: Array

    @property
    def any(self) -> bool:
        """Whether at least one of the four matrices has an entry that is not zero."""
        return any(matrix.any() for matrix in self._matrices)

    def directions(self, basis: Array) -> Array:
        """Return the directions of the forces that unit coordinates of a basis make through each matrix.

        Each matrix is divided by its Frobenius norm; matrices of zeros are left out.

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
        """Transform the coupling to the coordinates of a basis B: B^T matrix B for each of the four
        matrices.

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
        """Return the pairs of coordinates that some matrix couples by more than a part of its largest entry.

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
        """Split off the diagonal of the dampers, which the integrator counts as damping of the single
        coordinates.

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
        """Express the coupling by another angular speed, without changing its forces.

        G and N are divided by `ratio`, P by its square; D stays.

        Parameters
        ----------
        ratio : float
            The new speed over the speed before, such as the mesh frequency over that of the pinions:
            their teeth.

        Returns
        -------
        Coupling
            Matrices for the other speed, in the same units.
        """
        gyroscopic, circulatory = self.gyroscopic / ratio, self.circulatory / ratio
        return Coupling(self.dampers, gyroscopic, circulatory, self.centrifugal / ratio**2)

    def velocity_terms(self, speed: float) -> Array:
        """Return the matrix D / W + G that acts on derivatives by the phase W t, in the equations by
        phase.

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
        """Return the matrix N / W + P that acts on displacements, in the equations by the phase W t.

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
        """Return a bound of the angular frequency that the coupling brings by itself, from spectral
        norms.

        It is abs(D) / W + abs(G) + sqrt(abs(N) / W + abs(P)).

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
        """Matrices of dampers, gyroscopic, circulatory and centrifugal terms."""
        return self.dampers, self.gyroscopic, self.circulatory, self.centrifugal


LANES = 4
"""Coordinates in a vector of the kernels."""
SAME_FREQUENCY = 1e-12
"""Relative difference of squared bearing frequencies up to which they are equal."""
RANK = 1e-10
"""Relative size up to which a direction is rounding."""
RIGID = 1e-13
"""Part of the stiffest motion's omega^2, among coordinates that masses couple, that is rounding."""


@dataclass(frozen=True, eq=False)
class Reduction:
    """The moving part of a machine in n mass-normalised coordinates y: displacements (dof,) = basis y.

    With the mass matrix M it is basis^T M basis = I, hence y = basis^T M displacements, in m kg^0.5.

    Attributes
    ----------
    basis : (dof, n) array
        Displacements of unit coordinates, in columns: 1/kg^0.5, for rotations 1/(kg^0.5 m).
    mesh_jacobian : (contacts, n) array
        Mesh deflections of unit coordinates, followed by x, y and a row of zeros of each bearing with
        clearance. These bearings are not in omega_squared.
    omega_squared : (n,) array
        Bearing frequencies squared, 1/s2.
    damping : (n,) array
        Damping, 1/s.
    load : (n,) array
        Constant generalised load from torques and forces.
    free : tuple of str
        Names of the coordinates that nothing touches.
    coupling : Coupling or None
        Coupling beside the meshes, for a speed of the pinions of 1 rad/s.
    """

    basis: Array
    mesh_jacobian: Array
    omega_squared: Array
    damping: Array
    load: Array
    free: tuple[str, ...]
    coupling: Coupling | None


def reduce(linear: LinearModel, contacts: int, pushes: Array) -> Reduction:
    """Reduce the coordinates of a linear model exactly: leave out what no force excites and no mesh feels.

    Nothing is truncated. The basis keeps all motions that the contacts, the bearings with clearance, `pushes`
    or a coupling excite or feel. Among the others is the rigid rotation, which stays at rest as the torques
    are in balance.

    Parameters
    ----------
    linear : LinearModel
        Masses, bearings, loads and mesh rows of all degrees of freedom.
    contacts : int
        Number of contacts, see Layout.contacts: the first rows of `linear.rows` are theirs.
    pushes : (rows, dof) array
        Generalised directions of all forces beside those of the contacts, such as external forces and
        friction; any unit.

    Returns
    -------
    Reduction
        Basis, and mesh Jacobian, squared frequencies, damping, load and coupling in its mass-normalised
        coordinates.
    """
    stiffness = linear.stiffness_without_rings
    mesh_jacobian = np.concatenate([linear.rows[:contacts], *_ring_rows(linear)])
    whole = _coupling(linear)
    # What forces move belongs to the motion, though no mesh may feel it: bearings carry it.
    basis, omega_squared = _basis(linear, stiffness, np.concatenate([mesh_jacobian, pushes]), whole)
    is_touched = (mesh_jacobian != 0.0).any(axis=0) | (stiffness.diagonal() != 0.0) | (linear.loads != 0.0)
    if whole is not None:
        order = together(mesh_jacobian @ basis, whole.among(basis))
        basis, omega_squared = basis[:, order], omega_squared[order]
    extra_damping, coupling = (
        (np.zeros_like(omega_squared), None) if whole is None else whole.among(basis).split()
    )
    return Reduction(
        basis=basis,
        mesh_jacobian=mesh_jacobian @ basis,
        omega_squared=omega_squared,
        damping=modal_damping(linear, omega_squared) + extra_damping,
        load=basis.T @ linear.loads,
        free=tuple(np.array(linear.labels)[~is_touched].tolist()),
        coupling=coupling,
    )


def together(mesh_jacobian: Array, coupling: Coupling) -> Integers:
    """Order coupled coordinates so that the compiled kernels use their vectors of LANES coordinates well.

    Coordinates that the same meshes feel are side by side, the most first. Among them, those that are coupled
    are side by side, first those that fill whole vectors of the kernels.

    Parameters
    ----------
    mesh_jacobian : (m, n) array
        Mesh deflections of unit coordinates, any unit.
    coupling : Coupling
        Coupling of the n coordinates.

    Returns
    -------
    (n,) array
        Indices of the coordinates.
    """
    is_felt = np.abs(mesh_jacobian) > RIGID * np.abs(mesh_jacobian).max(initial=0.0)
    _, pattern, number = np.unique(is_felt.T, axis=0, return_inverse=True, return_counts=True)
    _, group = connected_components(coupling.linked(RIGID), directed=False)
    size = np.bincount(group)[group]
    return np.lexsort((group, -size, size % LANES, pattern, -number[pattern]))


def modal_damping(linear: LinearModel, omega_squared: Array) -> Array:
    """Compute the damping lambda + beta omega^2 of each coordinate, the factor of y' by equation (21).

    Parameters
    ----------
    linear : LinearModel
        Damping coefficients lambda and beta.
    omega_squared : (n,) array
        Bearing frequencies squared, 1/s^2.

    Returns
    -------
    (n,) array
        Damping, 1/s.
    """
    return linear.mass_damping + linear.bearing_damping * omega_squared


def coupled_basis(mesh_jacobian: Array, mass: Array, bearing: Array) -> tuple[Array, Array]:
    """Compute a basis of all motions that meshes couple, with unit modal mass, for diagonal mass and
    bearings.

    Coordinates of equal bearing frequency form groups. In each group the right singular vectors of the
    mass-scaled Jacobian with singular values above RANK span the motions that meshes feel.

    Parameters
    ----------
    mesh_jacobian : (m, dof) array
        Mesh deflections of unit displacements, any unit.
    mass : (dof,) array
        Masses, kg or kg m^2.
    bearing : (dof,) array
        Bearing stiffnesses, N/m or N m/rad.

    Returns
    -------
    (dof, n) array
        Displacements of unit coordinates: 1/kg^0.5, for rotations 1/(kg^0.5 m).
    (n,) array
        Bearing frequencies squared, 1/s^2.
    """
    omega_squared = bearing / mass
    scaled_jacobian = mesh_jacobian / np.sqrt(mass)
    size = np.linalg.norm(scaled_jacobian)
    columns, squared_frequencies = [], []
    is_unassigned = np.ones(mass.size, dtype=bool)
    while is_unassigned.any():
        value = omega_squared[is_unassigned].min()
        group = np.flatnonzero(is_unassigned & (omega_squared <= value * (1.0 + SAME_FREQUENCY)))
        is_unassigned[group] = False
        _, sizes, rows = np.linalg.svd(scaled_jacobian[:, group], full_matrices=False)
        for row in rows[sizes > RANK * size]:
            column = np.zeros(mass.size)
            column[group] = row / np.sqrt(mass[group])
            columns.append(column)
            squared_frequencies.append(value)
    return np.array(columns).T.reshape(mass.size, len(columns)), np.array(squared_frequencies)


def _basis(
    linear: LinearModel, stiffness: Array, directions: Array, coupling: Coupling | None
) -> tuple[Array, Array]:
    """Return the basis (dof, n) and omega^2 (n,), 1/s^2, of all motions that directions (rows, dof)
    excite.

    Directions that the coupling hands on from the basis are added until the basis contains them all.
    """
    axes, mass, principal = _principal_axes(linear, stiffness)
    while True:
        basis, omega_squared = coupled_basis(
            directions if axes is None else directions @ axes, mass, principal
        )
        basis = basis if axes is None else axes @ basis
        if coupling is None:
            return basis, omega_squared
        handed_on = coupling.directions(basis)
        remainder = handed_on - handed_on @ basis @ linear.momentum(basis).T
        if np.abs(remainder).max(initial=0.0) <= RANK * np.abs(handed_on).max(initial=0.0):
            return basis, omega_squared
        size = np.linalg.norm(directions) / np.linalg.norm(handed_on)
        directions = np.concatenate([directions, size * handed_on])


def _principal_axes(linear: LinearModel, stiffness: Array) -> tuple[Array | None, Array, Array]:
    """Return axes (dof, dof), in columns, along which masses and bearings are decoupled, and both along
    them, (dof,).

    The axes are None where mass and stiffness matrices are diagonal already. Coordinates that are coupled
    have generalised eigenvectors of unit mass; stiffness that is only rounding, of rigid motions, is set
    to 0.
    """
    is_coupled = (linear.mass != 0.0) | (stiffness != 0.0)
    count, group = connected_components(is_coupled, directed=False)
    if count == linear.size:
        return None, linear.mass.diagonal(), stiffness.diagonal()
    axes, mass = np.eye(linear.size), linear.mass.diagonal().copy()
    rigid = np.zeros(linear.size, dtype=bool)
    for number in np.flatnonzero(np.bincount(group) > 1):
        indices = np.flatnonzero(group == number)
        at = np.ix_(indices, indices)
        if (linear.mass[at] == linear.mass[indices[0], indices[0]] * np.eye(indices.size)).all():
            axes[at] = np.linalg.eigh(stiffness[at])[1]
        else:
            values, axes[at] = scipy.linalg.eigh(stiffness[at], linear.mass[at])
            rigid[indices], mass[indices] = np.abs(values) <= RIGID * np.abs(values).max(), 1.0
    return axes, mass, np.where(rigid, 0.0, np.einsum("ij,ij->j", axes, stiffness @ axes))


def _coupling(linear: LinearModel) -> Coupling | None:
    """Return the coupling among all coordinates (dof), for a speed of the pinions of 1 rad/s; None if
    there is none.
    """
    spin, zeros = linear.spin, np.zeros_like(linear.dampers)
    turning = (zeros, zeros, zeros) if spin is None else (spin.gyroscopic, spin.circulatory, spin.centrifugal)
    coupling = Coupling(linear.dampers, *turning)
    return coupling if coupling.any else None


def _ring_rows(linear: LinearModel) -> list[Array]:
    """Return a matrix (3, dof) for each bearing with clearance: rows that pick x and y of its body, and a
    row of zeros.
    """
    rows = np.zeros((len(linear.ring_coordinates), 3, linear.size))
    for row, coordinates in zip(rows, linear.ring_coordinates, strict=True):
        row[[0, 1], coordinates] = 1.0
    return list(rows)
