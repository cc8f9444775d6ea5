"""Leave out exactly the motions that no mesh can excite or feel.

Degrees of freedom with the same bearing frequency (and so, with C = lambda M + beta K, the same damping) may
be combined freely; of each such group only the combinations that appear in a mesh deflection move together
with the others. The rest (pinion axial motions, the rigid rotation, one translation of each pinion) are
decoupled.
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Integers
from facegear.transmission.layout import DOF_PER_BODY, Layout
from facegear.transmission.machine import Damping, Machine
from facegear.transmission.matrices import (
    bearing_axes,
    bearing_diagonal,
    bearing_matrix,
    flank_directions,
    mass_diagonal,
    mesh_directions,
)
from facegear.transmission.mesh_friction import friction_rows

SAME_FREQUENCY = 1e-12
RANK = 1e-10


@dataclass(frozen=True, eq=False)
class Reduced:
    """The moving part in n mass-normalised coordinates y, displacements = basis y.

    basis (dof, n), mesh_jacobian (meshes, n), or (2 meshes, n) by flank where meshes are geometric, followed
    by x, y and a row of zeros of each pinion whose bearing has play: those bearings are not in omega_squared,
    omega_squared (n,) bearing frequencies squared in 1/s2,
    damping (n,) in 1/s, load (n,) from the torques, `free` the names of the DOF that nothing touches.
    """

    basis: Array
    mesh_jacobian: Array
    omega_squared: Array
    damping: Array
    load: Array
    free: tuple[str, ...]


def reduce(machine: Machine) -> Reduced:
    """Reduced coordinates of a machine; torques are in balance, so the rigid rotation stays at rest."""
    rings = np.flatnonzero(machine.imperfections.clearance > 0.0)
    layout = without_bearings(machine.layout, rings)
    mass = mass_diagonal(layout)
    mesh_jacobian = flank_directions(layout) if layout.is_geometric else mesh_directions(layout)
    mesh_jacobian = np.concatenate([mesh_jacobian, *(_ring_rows(layout, int(i)) for i in rings)])
    applied = machine.applied
    # What forces move belongs to the motion, though no mesh may feel it: bearings carry it.
    pushes = [_push_row(machine)] if machine.forces.any() else []
    if machine.friction is not None:
        pushes.append(friction_rows(layout).reshape(-1, layout.dof))
    felt = np.concatenate([mesh_jacobian, *pushes])
    bearing = bearing_diagonal(layout)
    if any(body.bearing_xy != 0.0 for body in layout.bodies):
        axes = bearing_axes(layout)
        principal = np.einsum("ij,ij->j", axes, bearing_matrix(layout) @ axes)
        basis, omega_squared = coupled_basis(felt @ axes, mass, principal)
        basis = axes @ basis
    else:
        basis, omega_squared = coupled_basis(felt, mass, bearing)
    touched = (mesh_jacobian != 0.0).any(axis=0) | (bearing != 0.0) | (applied != 0.0)
    names = np.array(layout.dof_names)
    return Reduced(
        basis=basis,
        mesh_jacobian=mesh_jacobian @ basis,
        omega_squared=omega_squared,
        damping=modal_damping(machine.damping, omega_squared),
        load=basis.T @ applied,
        free=tuple(names[~touched].tolist()),
    )


def without_bearings(layout: Layout, pinions: Integers) -> Layout:
    """The layout with some pinions free in x and y."""
    changed = list(layout.pinions)
    for i in pinions:
        body = changed[i].body
        changed[i] = replace(changed[i], body=replace(body, bearing=(0.0, 0.0, body.bearing[2])))
    return replace(layout, pinions=tuple(changed))


def _push_row(machine: Machine) -> Array:
    """Direction of the external forces without the torques, (1, dof)."""
    loads = machine.applied
    loads[machine.layout.spins] = 0.0
    return (loads / np.linalg.norm(loads))[None]


def _ring_rows(layout: Layout, pinion: int) -> Array:
    rows = np.zeros((3, layout.dof))
    rows[[0, 1], DOF_PER_BODY * pinion + np.arange(2)] = 1.0
    return rows


def modal_damping(damping: Damping, omega_squared: Array) -> Array:
    """lambda + beta omega^2 of each coordinate, equation (21), 1/s."""
    return damping.mass + damping.bearing * omega_squared


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
