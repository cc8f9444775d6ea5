"""Static equilibrium: who carries load when the machine stands still under torque.

Every flank is a one-sided contact, every bearing a spring, with a ring of play or without: one convex problem
at each position, solved to the accuracy of its numbers. Each result is held against the balance of all forces
and moments on every body.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers
from facegear.harmonics.series import stacked, stacked_values
from facegear.mesh_law.law import Held
from facegear.transmission.balance import balance, bearing_loads
from facegear.transmission.contact_energy import Springs
from facegear.transmission.contact_kernel import settle_all
from facegear.transmission.flanks import (
    constant_errors,
    error_series,
    flank_gaps,
    flank_law,
    slow_errors,
)
from facegear.transmission.layout import DOF_PER_BODY, Layout
from facegear.transmission.machine import Machine
from facegear.transmission.matrices import bearing_diagonal, bearing_matrix, flank_directions
from facegear.transmission.printed_statics import RESIDUAL, printed_equilibrium

TOLERANCE = 1e-13
ACCEPTED = 1e-12


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """Displacements (dof,), mesh deflections (meshes,) in m and rad, elastic mesh forces (meshes,) in N.

    A mesh's force is that of its drive flank less that of its back flank, its deflection the tangential
    part. `residual` is the largest force or moment (at its arm) on a body out of balance, over the largest
    applied or mesh force.
    """

    displacements: Array
    deflections: Array
    forces: Array
    residual: float


@dataclass(frozen=True, eq=False)
class Equilibria:
    """K positions: displacements (K, dof) in m and rad, flank_forces (K, 2 meshes) in N, drive flanks first.

    deflections (K, meshes): tangential, m. residual (K,): as in Equilibrium.
    """

    displacements: Array
    deflections: Array
    flank_forces: Array
    residual: Array

    @property
    def forces(self) -> Array:
        """What each mesh transmits, drive flank less back flank, (K, meshes), N."""
        drive, back = np.split(self.flank_forces, 2, axis=1)
        return drive - back


def static_equilibrium(machine: Machine, cycles: float | None = None) -> Equilibrium:
    """Equilibrium at a position of the mesh cycle, or (None) with mean stiffness and no e(t).

    A body that is free inside its backlash is left at one of its possible positions. Raises NotConverged.
    """
    if machine.layout.is_geometric:
        found = mean_equilibrium(machine) if cycles is None else equilibria(machine, np.array([cycles]))
        return Equilibrium(
            found.displacements[0], found.deflections[0], found.forces[0], float(found.residual[0])
        )
    displacements, deflections, forces, stiffness = printed_equilibrium(machine, cycles)
    gaps = machine.half_backlash + np.abs(deflections)
    checked = balance(machine, displacements[None], forces[None], stiffness[None], gaps[None])
    checked.require(RESIDUAL, ["mean stiffness" if cycles is None else f"mesh position {cycles:.4f}"])
    return Equilibrium(displacements, deflections, forces, float(checked.residual[0]))


def equilibria(machine: Machine, cycles: Array) -> Equilibria:
    """Equilibrium at `cycles` (K,), mesh cycles from the start, all errors in. Raises NotConverged."""
    errors = constant_errors(machine) + stacked_values(stacked(error_series(machine)), cycles)
    if machine.imperfections.any_slow:
        errors += slow_errors(machine, cycles)
    held = flank_law(machine).held(cycles)
    return settle(machine, held, errors, [f"mesh position {at:.4f}" for at in cycles])


def mean_equilibrium(machine: Machine) -> Equilibria:
    """Equilibrium with the mean law and constant errors alone. Raises NotConverged."""
    held = flank_law(machine).mean().held(np.zeros(1))
    return settle(machine, held, constant_errors(machine)[None], ["mean stiffness"])


def settle(machine: Machine, held: Held, errors: Array, names: list[str]) -> Equilibria:
    """Equilibrium for the law of the flanks held at K phases, see facegear.mesh_law.law.MeshLaw.held, and
    errors (K, 2 meshes) of theirs. Raises NotConverged.
    """
    springs, kept, scale = static_springs(machine)
    gaps = errors + flank_gaps(machine)
    start = np.zeros(kept.size)
    places, forces, _ = settle_all(springs, held, np.ascontiguousarray(gaps), TOLERANCE, start)
    displacements = np.zeros((len(gaps), machine.layout.dof))
    np.add.at(displacements.T, kept, (places * scale).T)
    checked = balance(machine, displacements, forces, held.stiffness, gaps)
    checked.require(ACCEPTED, names)
    drive, back = np.split(displacements @ flank_directions(machine.layout).T - errors, 2, axis=1)
    return Equilibria(displacements, 0.5 * (drive - back), forces, checked.residual)


def static_springs(machine: Machine) -> tuple[Springs, Integers, Array]:
    """The compiled problem, which degrees of freedom it keeps (n,), and the m or rad of its unknowns (n,).

    Left out is the pinions' motion along their own axes, which no mesh feels.
    """
    layout = machine.layout
    kept, scale = _unknowns(layout)
    bearing = bearing_matrix(layout)
    pinions = len(layout.pinions)
    first = 3 * pinions
    wide = (kept.size - first) // len(layout.gears)
    x = DOF_PER_BODY * np.arange(pinions)
    touched = np.array(layout.meshes * 2) * [3, wide] + [0, first]
    columns = np.concatenate([touched[:, :1] + np.arange(3), touched[:, 1:] + np.arange(wide)], axis=1)
    directions = flank_directions(layout)[:, kept] * scale
    return (
        Springs(
            jacobian=np.take_along_axis(directions, columns, axis=1),
            pinion=touched[:, 0].copy(),
            gear=touched[:, 1].copy(),
            pinion_bearing=np.stack([bearing[x, x], bearing[x, x + 1], bearing[x + 1, x + 1]], axis=1),
            clearance=machine.imperfections.clearance,
            gear_bearing=bearing_diagonal(layout)[kept[first:]] * scale[first:] ** 2,
            gear_coupling=np.array([gear.body.bearing_xy for gear in layout.gears]),
            applied=machine.applied[kept] * scale,
        ),
        kept,
        scale,
    )


def static_bearing_forces(machine: Machine) -> Array:
    """Force of every body on its bearing along x, y, z at rest under the mean torques, (bodies, 3), N.

    Mean stiffness, constant errors, either kinematics. Raises NotConverged.
    """
    if machine.layout.is_geometric:
        return bearing_forces(machine, mean_equilibrium(machine))[0]
    forces = bearing_matrix(machine.layout) @ static_equilibrium(machine).displacements
    return forces.reshape(-1, DOF_PER_BODY)[:, :3]


def bearing_forces(machine: Machine, found: Equilibria) -> Array:
    """Force of every body on its bearing along x, y, z, shape (K, bodies, 3), N."""
    bodies = DOF_PER_BODY * len(machine.layout.bodies)
    forces = bearing_loads(machine, found.displacements)
    return forces[:, :bodies].reshape(len(forces), -1, DOF_PER_BODY)[..., :3]


def _unknowns(layout: Layout) -> tuple[Integers, Array]:
    """Kept degrees of freedom and their lengths: turns at the mesh, tilts at the mesh radius.

    If one gear may rock, another that may not is given tilts of no length.
    """
    kept: list[int] = []
    scale: list[float] = []
    pinions, bodies = len(layout.pinions), len(layout.bodies)
    for body in range(bodies):
        letters = (0, 1, 3) if body < pinions else (0, 1, 2, 3)
        arm = layout.pinion_arm if body < pinions else layout.gear_arm
        kept += [DOF_PER_BODY * body + letter for letter in letters]
        scale += [1.0 / arm if letter == 3 else 1.0 for letter in letters]
        if body >= pinions and layout.tilting:
            rocks = body - pinions in layout.tilting
            at = DOF_PER_BODY * bodies + 2 * (layout.tilting.index(body - pinions) if rocks else 0)
            kept += [at, at + 1]
            scale += 2 * [1.0 / layout.mesh_radius if rocks else 0.0]
    return np.array(kept), np.array(scale)
