"""Static equilibrium under torque, with every force and moment in balance.

Whether a static result is one: every force and moment on every body in balance, counted anew. The solvers
keep an account of their own unknowns. This one goes back to the whole matrices, all degrees of freedom
included, so that nothing that a solver leaves out can hide.

Static equilibrium: who carries load when the machine stands still under torque. Every flank is a one-sided
contact, every bearing a spring, with clearance or without: one convex problem at each position, solved to the
accuracy of its numbers. Each result is held against the balance of all forces and moments on every body.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.harmonics import stack_series, stacked_values
from facegear.machine.block_statics import StaticBlocks, has_kernel, settle_all, static_blocks
from facegear.machine.dense_positions import solve_one_by_one, solve_together
from facegear.machine.dense_statics import RESIDUAL, Contacts, dense_equilibrium
from facegear.machine.flank_errors import constant_errors, error_series, slow_errors
from facegear.machine.flanks import flank_law, line_law
from facegear.machine.linear_model import LinearModel
from facegear.machine.machine import Machine
from facegear.machine.rolling_equilibria import ShaftLoads, rolling_equilibria
from facegear.machine.supports import has_rolling_bearings
from facegear.meshing.law import LawAtPhases, MeshLaw

EPSILON = float(np.finfo(float).eps)
"""Rounding unit of double precision."""
ROUNDING_FACTOR = 32.0
"""Roundings of the largest terms of a sum that its result may be off by."""


@dataclass(frozen=True, eq=False)
class Balance:
    """Force out of balance on the bodies at K positions, moments divided by their arms.

    Attributes
    ----------
    residual : (K,) array
        The largest, over the largest applied or mesh force.
    rounding : (K,) array
        The part that rounding explains by the size of the numbers that cancel, over the same force.
    """

    residual: Array
    rounding: Array

    def require(self, limit: float, names: list[str]) -> None:
        """Raise NotConverged for the worst position whose residual is above the limit plus its rounding.

        Parameters
        ----------
        limit : float
            Largest residual, relative to the largest applied or mesh force.
        names : list of str
            Name of each of the K positions for the message.

        Raises
        ------
        NotConverged
            If the residual of a position is above the limit plus its rounding, or is not a number.
        """
        over = self.residual - limit - self.rounding
        if (over <= 0.0).all():
            return
        worst = int(np.argmax(np.where(np.isnan(over), np.inf, over)))
        limit_with_rounding = limit + self.rounding[worst]
        problem = (
            f"forces and moments out of balance by {self.residual[worst]:.2e} over {limit_with_rounding:.0e}"
        )
        raise NotConverged("static equilibrium", names[worst], problem)


def balance(
    linear: LinearModel,
    displacements: Array,
    forces: Array,
    stiffness: Array,
    gaps: Array,
    on_shafts: Array | None = None,
) -> Balance:
    """Compute the force and moment out of balance on every body: bearings + rows^T forces - loads.

    It uses the whole matrices of the model, not the unknowns of a solver. Contacts are both flanks of
    every mesh, or every mesh as one with a force of either sign.

    Parameters
    ----------
    linear : LinearModel
        Bearings, loads and directions of the contacts of the machine.
    displacements : (K, dof) array
        Displacements from the unloaded position, m and rad.
    forces : (K, F) array
        Contact forces, N, positive as they resist positive motion along their rows; F first rows are
        used.
    stiffness : (K, F) array
        Stiffness of the contacts, N/m; only used to estimate the rounding of the forces.
    gaps : (K, F) array
        Gaps of the contacts, m; only used for that estimate.
    on_shafts : (K, dof) array or None
        Loads of the bodies on shafts with rolling bearings, which `linear` leaves out, N and N m.

    Returns
    -------
    Balance
        Residual and rounding (K,), relative to the largest applied or contact force of each position.
    """
    rows, arms, loads = linear.rows[: forces.shape[1]], linear.lengths, linear.loads
    left_over = bearing_loads(linear, displacements, on_shafts) + forces @ rows - loads
    size = np.maximum(np.abs(loads / arms).max(), np.abs(forces).max(axis=1))
    size = np.where(size > 0.0, size, 1.0)
    motion_sizes = np.abs(displacements)
    force_sizes = stiffness * (motion_sizes @ np.abs(rows).T + np.abs(gaps))
    terms = motion_sizes @ np.abs(linear.stiffness) + force_sizes @ np.abs(rows)
    return Balance(
        residual=np.abs(left_over / arms).max(axis=1) / size,
        rounding=ROUNDING_FACTOR * EPSILON * (terms / arms).max(axis=1) / size,
    )


def bearing_loads(linear: LinearModel, displacements: Array, on_shafts: Array | None = None) -> Array:
    """Return the force or moment of every degree of freedom on its bearing: stiffness times displacement.

    A bearing with radial clearance c presses with k (1 - c / distance) times its displacement (x, y)
    where the distance is above c, else not at all.

    Parameters
    ----------
    linear : LinearModel
        Bearings of the machine.
    displacements : (K, dof) array
        m and rad.
    on_shafts : (K, dof) array or None
        Loads of the bodies on shafts with rolling bearings, which `linear` leaves out, N and N m.

    Returns
    -------
    (K, dof) array
        N and N m, positive along the displacement (force of the body on its bearing).
    """
    loads = displacements @ linear.stiffness_without_rings
    rings, at = linear.rings, linear.ring_coordinates
    ring_displacements = displacements[:, at]
    distance = np.maximum(np.hypot(ring_displacements[..., 0], ring_displacements[..., 1]), rings.clearance)
    beyond = np.maximum(1.0 - rings.clearance / distance, 0.0)
    loads[:, at] += ring_displacements * beyond[..., None] * rings.stiffness[:, None]
    return np.asarray(loads if on_shafts is None else loads + on_shafts)


TOLERANCE = 1e-13
"""Largest force out of balance, over the largest force, at which the compiled solver ends; dimensionless."""
RESIDUAL_LIMIT = 1e-12
"""Largest force out of balance, over the largest force, that a result of `settle` may have beyond rounding.
"""


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """Static equilibrium at one position.

    - displacements (dof,): m and rad
    - deflections (meshes,): tangential part: half of (drive less back deflection, each less its error);
      of printed meshes the deflection along their one line of action, m
    - forces (meshes,): elastic force, drive flank less back flank, N
    - residual: largest force or moment (at its arm) out of balance on a body, over the largest applied or
      mesh force
    """

    displacements: Array
    deflections: Array
    forces: Array
    residual: float


@dataclass(frozen=True, eq=False)
class Equilibria:
    """Static equilibria at K positions.

    - displacements (K, dof): m and rad
    - deflections (K, meshes): tangential part, as in `Equilibrium`, m
    - flank_forces (K, 2 meshes): compressive forces, drive flanks first, N
    - residual (K,): as in `Equilibrium`
    - shafts: shafts on rolling bearings by the numbers of their pinions
    - on_shafts (K, dof): loads of the bodies on these shafts, N and N m; None without them
    """

    displacements: Array
    deflections: Array
    flank_forces: Array
    residual: Array
    shafts: Mapping[int, ShaftLoads] = field(default_factory=dict)
    on_shafts: Array | None = None

    @property
    def forces(self) -> Array:
        """Force that each mesh transmits, drive flank less back flank, (K, meshes), N."""
        drive, back = np.split(self.flank_forces, 2, axis=1)
        return drive - back


def static_equilibrium(machine: Machine, cycles: float | None = None) -> Equilibrium:
    """Compute the static equilibrium at one position of the mesh cycle, or with mean stiffness and no
    e(t).

    A body that is free inside its backlash is left at one of its possible positions. Either kinematics is
    accepted.

    Parameters
    ----------
    machine : Machine
        The machine.
    cycles : float or None
        Mesh cycles from the start, periods; None for the mean stiffness with constant errors and without
        e(t).

    Returns
    -------
    Equilibrium
        m, rad and N.

    Raises
    ------
    NotConverged
        If forces and moments stay out of balance.
    """
    if machine.layout.kinematics.flanks_apart:
        at_rest = mean_equilibrium(machine) if cycles is None else equilibria(machine, np.array([cycles]))
        return Equilibrium(
            at_rest.displacements[0], at_rest.deflections[0], at_rest.forces[0], float(at_rest.residual[0])
        )
    return _line_equilibrium(machine, cycles)


def _line_equilibrium(machine: Machine, cycles: float | None) -> Equilibrium:
    """Return the equilibrium of printed meshes, whose flanks share one line of action, by
    `dense_equilibrium`.

    cycles: mesh periods, None for the mean stiffness without e(t).
    """
    law = line_law(machine)
    law = law.mean() if cycles is None else law.at_phase(cycles)
    error = np.zeros(law.contacts) if cycles is None else machine.error(cycles - machine.error_phases)
    half = machine.half_backlash
    # Rotations are scaled by the pinion radius so that all unknowns are lengths of one order.
    lengths = np.ones(machine.linear.size)
    lengths[machine.layout.spins] = machine.layout.pinion_radius
    contacts = Contacts(law, error, -half, half)
    displacements, deflections, forces = dense_equilibrium(machine.linear, contacts, lengths)
    gaps = machine.half_backlash + np.abs(deflections)
    force_balance = balance(machine.linear, displacements[None], forces[None], law.steepest[None], gaps[None])
    force_balance.require(RESIDUAL, ["mean stiffness" if cycles is None else f"mesh position {cycles:.4f}"])
    return Equilibrium(displacements, deflections, forces, float(force_balance.residual[0]))


def equilibria(machine: Machine, cycles: Array) -> Equilibria:
    """Compute the static equilibrium at given mesh positions, with constant, periodic and slow errors.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.
    cycles : (K,) array
        Mesh cycles from the start, periods, counted on over turns as slow errors need it.

    Returns
    -------
    Equilibria
        One entry for each position, in m, rad and N.

    Raises
    ------
    NotConverged
        If forces and moments stay out of balance at a position.
    """
    errors = constant_errors(machine) + stacked_values(stack_series(error_series(machine)), cycles)
    if machine.imperfections.any_slow:
        errors += slow_errors(machine, cycles)
    return settle(machine, flank_law(machine), cycles, errors, [f"mesh position {at:.4f}" for at in cycles])


def mean_equilibrium(machine: Machine) -> Equilibria:
    """Compute the static equilibrium with the mean law and constant errors alone.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.

    Returns
    -------
    Equilibria
        One position, in m, rad and N.

    Raises
    ------
    NotConverged
        If forces and moments stay out of balance.
    """
    law, errors = flank_law(machine).mean(), constant_errors(machine)[None]
    return settle(machine, law, np.zeros(1), errors, ["mean stiffness"])


def settle(machine: Machine, law: MeshLaw, cycles: Array, errors: Array, names: list[str]) -> Equilibria:
    """Compute static equilibria with given laws and errors of the flanks.

    Where every pinion has a bearing of its own and the law has a kernel, the compiled solver takes all
    positions together; else dense algebra solves one after the other. Rolling bearings have a solver of
    their own. Every result is checked by `balance`.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.
    law : MeshLaw
        Law of the 2 meshes flanks, in place of the machine's own.
    cycles : (K,) array
        Positions at which the law is taken, mesh periods.
    errors : (K, 2 meshes) array
        Errors of the flanks, m; positive opens the flank. Half the backlash is added here.
    names : list of str
        Name of each position for messages.

    Returns
    -------
    Equilibria
        m, rad and N.

    Raises
    ------
    NotConverged
        If forces and moments stay out of balance at a position.
    """
    law_at_positions, gaps = law.statics_law(cycles), errors + np.tile(machine.half_backlash, 2)
    in_motion = machine.casing is not None and machine.casing.frequency_limit is not None
    if has_rolling_bearings(machine.drive_line) and not in_motion:
        return _settle_shafts(machine, law, cycles, gaps, law_at_positions.stiffness, names)
    blocks = static_blocks(machine.static_machine)
    if blocks is not None and has_kernel(law_at_positions):
        displacements, forces = _by_blocks(blocks, law_at_positions, gaps)
        if machine.drive_line is not None and machine.static_machine is not machine:
            displacements = machine.drive_line.extend_displacements(machine.lumped_model, displacements)
    else:
        line = machine.drive_line
        is_coupled = machine.layout.kind is not None or (line is not None and line.is_tilted_by_meshes)
        solve = solve_together if is_coupled else solve_one_by_one
        displacements, forces = solve(machine.linear, law, cycles, gaps)
    force_balance = balance(machine.linear, displacements, forces, law_at_positions.stiffness, gaps)
    force_balance.require(RESIDUAL_LIMIT, names)
    drive, back = np.split(displacements @ machine.linear.rows.T - errors, 2, axis=1)
    return Equilibria(displacements, 0.5 * (drive - back), forces, force_balance.residual)


def _settle_shafts(
    machine: Machine, law: MeshLaw, cycles: Array, gaps: Array, stiffness: Array, names: list[str]
) -> Equilibria:
    """Return the equilibria of a machine with rolling bearings, as `settle`; `gaps` and `stiffness`, (K,
    flanks), in m and N/m.
    """
    linear, solution = machine.linear_without_rolling, rolling_equilibria(machine, law, cycles, gaps)
    forces = solution.flanks
    force_balance = balance(linear, solution.displacements, forces, stiffness, gaps, solution.loads)
    size = np.maximum(np.abs(linear.loads / linear.lengths).max(), np.abs(forces).max(axis=1))
    size = np.where(size > 0.0, size, 1.0)
    whole = Balance(
        residual=np.maximum(force_balance.residual, solution.imbalance / size),
        rounding=force_balance.rounding + solution.rounding / size,
    )
    whole.require(RESIDUAL_LIMIT, names)
    drive, back = np.split(solution.displacements @ linear.rows.T - gaps, 2, axis=1)
    return Equilibria(
        solution.displacements, 0.5 * (drive - back), forces, whole.residual, solution.shafts, solution.loads
    )


def _by_blocks(blocks: StaticBlocks, law: LawAtPhases, gaps: Array) -> tuple[Array, Array]:
    """Return displacements (K, dof), m and rad, and flank forces (K, flanks), N, by the compiled solver.

    law: at the K positions; gaps (K, flanks): deflections at which flanks touch, m.
    """
    start = np.zeros(blocks.coordinates.size)
    solution, forces, _ = settle_all(blocks.springs, law, gaps, TOLERANCE, start)
    return blocks.displacements(solution), forces


def static_bearing_forces(machine: Machine) -> Array:
    """Return the force of every body on its bearing at rest under the mean torques.

    Mean stiffness and constant errors, with either kinematics.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    (bodies, 3) array
        Along x, y, z, N.

    Raises
    ------
    NotConverged
        If no equilibrium is solution.
    """
    if machine.layout.kinematics.flanks_apart:
        return bearing_forces(machine, mean_equilibrium(machine))[0]
    forces = bearing_loads(machine.linear, static_equilibrium(machine).displacements[None])
    return forces[0, machine.linear.translations]


def bearing_forces(machine: Machine, at_rest: Equilibria) -> Array:
    """Return the force of every body on its bearing at K equilibria.

    Parameters
    ----------
    machine : Machine
        The machine.
    at_rest : Equilibria
        Its equilibria.

    Returns
    -------
    (K, bodies, 3) array
        Along x, y, z, N.
    """
    linear = machine.linear_without_rolling
    return bearing_loads(linear, at_rest.displacements, at_rest.on_shafts)[:, linear.translations]
