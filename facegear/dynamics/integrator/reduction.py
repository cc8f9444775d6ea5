"""Leave out exactly the motions that no mesh can excite or feel.

Degrees of freedom with the same bearing frequency (and so, with C = lambda M + beta K, the same damping) may
be combined freely; of each such group only the combinations that appear in a mesh deflection move together
with the others. The rest (pinion axial motions, the rigid rotation, one translation of each pinion) are
decoupled. Further dampers and what turning bodies add couple coordinates too: what they couple to a motion
that is kept is kept with it.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from scipy.sparse.csgraph import connected_components

from facegear.arrays import Array, Integers
from facegear.dynamics.integrator.coupling import Coupling
from facegear.transmission.linear_model import LinearModel

LANES = 4
"""Coordinates in a vector of the kernels."""
SAME_FREQUENCY = 1e-12
RANK = 1e-10
RIGID = 1e-13
"""Part of the stiffest motion's omega^2, among coordinates that masses couple, that is rounding."""


@dataclass(frozen=True, eq=False)
class Reduced:
    """The moving part in n mass-normalised coordinates y, displacements = basis y.

    Attributes
    ----------
    basis : (dof, n)
        Displacements of unit coordinates.
    mesh_jacobian : (contacts, n)
        Followed by x, y and a row of zeros of each bearing with clearance: those bearings are not in
        omega_squared.
    omega_squared : (n,)
        Bearing frequencies squared, 1/s2.
    damping : (n,)
        1/s.
    load : (n,)
        From torques and forces.
    free
        The names of the coordinates that nothing touches.
    coupling
        What couples the n beside the meshes, for a speed of the pinions of 1 rad/s; or None.
    """

    basis: Array
    mesh_jacobian: Array
    omega_squared: Array
    damping: Array
    load: Array
    free: tuple[str, ...]
    coupling: Coupling | None


def reduce(linear: LinearModel, contacts: int, pushes: Array) -> Reduced:
    """Reduced coordinates with the first `contacts` rows of the linear model, see Layout.contacts.

    pushes (rows, dof): directions of other forces. Torques are in balance, so the rigid rotation stays at
    rest.
    """
    stiffness = linear.stiffness_without_rings
    mesh_jacobian = np.concatenate([linear.rows[:contacts], *_ring_rows(linear)])
    whole = _coupling(linear)
    # What forces move belongs to the motion, though no mesh may feel it: bearings carry it.
    basis, omega_squared = _basis(linear, stiffness, np.concatenate([mesh_jacobian, pushes]), whole)
    touched = (mesh_jacobian != 0.0).any(axis=0) | (stiffness.diagonal() != 0.0) | (linear.loads != 0.0)
    if whole is not None:
        order = together(mesh_jacobian @ basis, whole.among(basis))
        basis, omega_squared = basis[:, order], omega_squared[order]
    own, coupling = (np.zeros_like(omega_squared), None) if whole is None else whole.among(basis).split()
    return Reduced(
        basis=basis,
        mesh_jacobian=mesh_jacobian @ basis,
        omega_squared=omega_squared,
        damping=modal_damping(linear, omega_squared) + own,
        load=basis.T @ linear.loads,
        free=tuple(np.array(linear.labels)[~touched].tolist()),
        coupling=coupling,
    )


def together(mesh_jacobian: Array, coupling: Coupling) -> Integers:
    """An order (n,) of coupled coordinates in which those that the same meshes feel stand side by side, the
    most first, and among them those that are coupled, first those that fill whole vectors of the kernels.
    """
    felt = np.abs(mesh_jacobian) > RIGID * np.abs(mesh_jacobian).max(initial=0.0)
    _, alike, number = np.unique(felt.T, axis=0, return_inverse=True, return_counts=True)
    _, group = connected_components(coupling.linked(RIGID), directed=False)
    size = np.bincount(group)[group]
    return np.lexsort((group, -size, size % LANES, alike, -number[alike]))


def modal_damping(linear: LinearModel, omega_squared: Array) -> Array:
    """lambda + beta omega^2 of each coordinate, equation (21), 1/s."""
    return linear.mass_damping + linear.bearing_damping * omega_squared


def coupled_basis(mesh_jacobian: Array, mass: Array, bearing: Array) -> tuple[Array, Array]:
    """Basis (DOF, n) with unit modal mass of all motions that meshes couple, and their bearing omega^2
    (n,).
    """
    omega_squared = bearing / mass
    scaled = mesh_jacobian / np.sqrt(mass)
    size = np.linalg.norm(scaled)
    columns, kept = [], []
    remaining = np.ones(mass.size, dtype=bool)
    while remaining.any():
        value = omega_squared[remaining].min()
        group = np.flatnonzero(remaining & (omega_squared <= value * (1.0 + SAME_FREQUENCY)))
        remaining[group] = False
        _, sizes, rows = np.linalg.svd(scaled[:, group], full_matrices=False)
        for row in rows[sizes > RANK * size]:
            column = np.zeros(mass.size)
            column[group] = row / np.sqrt(mass[group])
            columns.append(column)
            kept.append(value)
    return np.array(columns).T.reshape(mass.size, len(columns)), np.array(kept)


def _basis(
    linear: LinearModel, stiffness: Array, felt: Array, coupling: Coupling | None
) -> tuple[Array, Array]:
    """Basis and omega^2 of the motions that the directions `felt` (rows, dof) excite, and of those to which
    the coupling hands them on.
    """
    axes, mass, principal = _principal_axes(linear, stiffness)
    while True:
        basis, omega_squared = coupled_basis(felt if axes is None else felt @ axes, mass, principal)
        basis = basis if axes is None else axes @ basis
        if coupling is None:
            return basis, omega_squared
        handed_on = coupling.directions(basis)
        missing = handed_on - handed_on @ basis @ linear.momentum(basis).T
        if np.abs(missing).max(initial=0.0) <= RANK * np.abs(handed_on).max(initial=0.0):
            return basis, omega_squared
        size = np.linalg.norm(felt) / np.linalg.norm(handed_on)
        felt = np.concatenate([felt, size * handed_on])


def _principal_axes(linear: LinearModel, stiffness: Array) -> tuple[Array | None, Array, Array]:
    """Columns (dof, dof) along which masses and bearings act by themselves, or None for the coordinates as
    they are; masses and stiffnesses (dof,) along them.
    """
    joined = (linear.mass != 0.0) | (stiffness != 0.0)
    count, group = connected_components(joined, directed=False)
    if count == linear.size:
        return None, linear.mass.diagonal(), stiffness.diagonal()
    axes, mass = np.eye(linear.size), linear.mass.diagonal().copy()
    rigid = np.zeros(linear.size, dtype=bool)
    for number in np.flatnonzero(np.bincount(group) > 1):
        own = np.flatnonzero(group == number)
        at = np.ix_(own, own)
        if (linear.mass[at] == linear.mass[own[0], own[0]] * np.eye(own.size)).all():
            axes[at] = np.linalg.eigh(stiffness[at])[1]
        else:
            values, axes[at] = scipy.linalg.eigh(stiffness[at], linear.mass[at])
            rigid[own], mass[own] = np.abs(values) <= RIGID * np.abs(values).max(), 1.0
    return axes, mass, np.where(rigid, 0.0, np.einsum("ij,ij->j", axes, stiffness @ axes))


def _coupling(linear: LinearModel) -> Coupling | None:
    """Of all coordinates, for a speed of the pinions of 1 rad/s."""
    spin, none = linear.spin, np.zeros_like(linear.dampers)
    turning = (none, none, none) if spin is None else (spin.gyroscopic, spin.circulatory, spin.centrifugal)
    coupling = Coupling(linear.dampers, *turning)
    return coupling if coupling.any else None


def _ring_rows(linear: LinearModel) -> list[Array]:
    rows = np.zeros((len(linear.ring_coordinates), 3, linear.size))
    for row, places in zip(rows, linear.ring_coordinates, strict=True):
        row[[0, 1], places] = 1.0
    return list(rows)
