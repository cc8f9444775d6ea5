"""Gap, force law and error of every flank: all drive flanks, then all back flanks.

    drive: d = t + s - e_t - e_s,   back: d = -t + s + e_t - e_s,   force law(phase, max(d - b, 0))

A pinion or tooth out of place moves both flanks by the same tangential and separating parts as a motion
would. A tooth's own error and stiffness are the drive flank's mirror image on the back flank: f_back(p) =
f_drive(-p), p the place of the pinion's tooth past the pitch line.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from facegear.arrays import Array, Mask
from facegear.by_content import kept_by_content
from facegear.harmonics import Harmonics
from facegear.machine.flank_errors import (
    _flank_series,
    _lags,
    constant_errors,
    error_series,
    flank_lags,
)
from facegear.machine.machine import Damping, FlankTables, Machine, OpenFlanks
from facegear.meshing.force_table import ForceTable, shift_tables
from facegear.meshing.law import MeshLaw
from facegear.meshing.linear import linear_law
from facegear.meshing.load_dependent import LoadDependentLaw, load_dependent_law, soften_table

NO_LOAD = 1e-9
"""Part of the largest force of all meshes below which a force is rounding and counts as none."""


def significant_forces(forces: Array) -> Array:
    """Return forces with 0 in place of those of at most NO_LOAD (1e-9) times the largest size of all
    entries.

    Parameters
    ----------
    forces : array of any shape (...)
        Forces of meshes or flanks, of either sign, N.

    Returns
    -------
    array of the same shape (...)
        N.
    """
    size = np.abs(forces)
    return np.where(size > NO_LOAD * size.max(initial=0.0), forces, 0.0)


def flank_edges(machine: Machine) -> Array:
    """Return the deflection at which each flank touches: half the backlash plus its constant error.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.

    Returns
    -------
    (2 meshes,) array
        Value of rows q, m, above which the flank is compressed, without e(t); drive flanks first.
    """
    return np.tile(machine.half_backlash, 2) + constant_errors(machine)


@dataclass(frozen=True, eq=False)
class MeshContacts:
    """The contacts of all meshes, ordered as `Layout.contacts` says.

    - law: force (N) by mesh position and compression (m)
    - error: series e(t) of each contact over the mesh cycle, m, with its lag; deflection = rows q - e
    - lower, upper (contacts,): edges of the dead zone of the deflection, m; a flank that only pushes has
      lower = -inf, and is compressed by deflection - upper
    - damping (contacts,): N s/m
    """

    law: MeshLaw
    error: tuple[Harmonics, ...]
    lower: Array
    upper: Array
    damping: Array


def mesh_contacts(machine: Machine) -> MeshContacts:
    """Return the contacts of all meshes, without errors that change from one mesh cycle to the next.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    MeshContacts
        One contact for each flank, or one for each mesh where both flanks share a line of action; m and N
        s/m.
    """
    return _flank_contacts(machine) if machine.layout.kinematics.flanks_apart else _line_contacts(machine)


def _flank_contacts(machine: Machine) -> MeshContacts:
    """Return one contact for each flank, drive flanks first.

    Constant errors are part of its upper edge; its error is e(t) alone; the damping is that of closed
    flanks.
    """
    upper = flank_edges(machine)
    damping = flank_dampers(machine.damping, np.ones(upper.size, dtype=bool))
    never = np.full(upper.size, -np.inf)
    return MeshContacts(flank_law(machine), error_series(machine), never, upper, damping)


def flank_dampers(damping: Damping, contact_mask: Mask) -> Array:
    """Return the dampers that act on the flanks.

    Parameters
    ----------
    damping : Damping
        Damping of a machine whose meshes have two flanks each.
    contact_mask : (2 meshes,)
        Which flanks are in contact, drive flanks first.

    Returns
    -------
    Array
        Damping of each flank, shape (2 meshes,), N s/m. Where it acts on open flanks, the two flanks of a
        mesh share it, so that the rotation alone meets the whole of it; or the drive flank has all of it.
    """
    if damping.open_flanks is OpenFlanks.MESH_DEFLECTION:
        return np.repeat([damping.mesh, 0.0], contact_mask.size // 2)
    if damping.open_flanks is OpenFlanks.ALWAYS:
        return np.full(contact_mask.size, 0.5 * damping.mesh)
    return np.where(contact_mask, damping.mesh, 0.0)


def _line_contacts(machine: Machine) -> MeshContacts:
    """Return one contact for each mesh of printed kinematics: both flanks share one line of action, with
    a dead zone from minus to plus half the backlash, the whole mesh damping, and the error with the
    mesh's lag.
    """
    phases = np.round(machine.error_phases, 12) % 1.0
    half = machine.half_backlash
    return MeshContacts(
        law=line_law(machine),
        error=tuple(machine.error.shift(float(phase)) for phase in phases),
        lower=-half,
        upper=half,
        damping=np.full(phases.size, machine.damping.mesh),
    )


def flank_law(machine: Machine) -> MeshLaw:
    """Return the force law of all drive flanks, then all back flanks, each with its own lag.

    `machine.law` wins where it is given; else the law is made from `machine.tables`; else it is linear
    with `machine.stiffness_by_flank`. A back flank has the mirrored series.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.

    Returns
    -------
    MeshLaw
        Force (N) of each flank by mesh position and compression (m); shared by machines that differ in
        backlash and constant errors alone.
    """
    return _flank_law(machine.without_errors)


@lru_cache(maxsize=16)
def _flank_law(machine: Machine) -> MeshLaw:
    """Return the force law of all flanks of a machine without errors; cached by the machine's identity."""
    if machine.law is not None:
        return machine.law
    phases = flank_lags(machine, machine.phases)
    if machine.tables is None:
        return _linear_law(*machine.stiffness_by_flank, phases)
    gears, factors = tuple(g for _, g in machine.layout.meshes), machine.imperfections.stiffness
    return _law_of_tables(machine.tables, gears, factors, machine.own_softening, _lags(phases))


def past_law(machine: Machine, cycles: Array, flank_forces: Array) -> Array:
    """Return the fraction of positions at which each flank's force is above that of its law's last level.

    There the law is extrapolated.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.
    cycles : (K,) array
        Mesh cycles from the start, periods.
    flank_forces : (K, 2 meshes) array
        Forces of the flanks at these positions, N, drive flanks first.

    Returns
    -------
    (2 meshes,) array
        Fraction of the K positions; 0 for a law that is linear in the compression.
    """
    law = flank_law(machine)
    if law.straight:
        return np.zeros(law.contacts)
    positions = np.asarray(np.round(np.mod(cycles, 1.0), 9), dtype=np.float64)
    phases, phase_index = np.unique(positions, return_inverse=True)
    last = law.force(phases, np.repeat(law.levels[-1:], phases.size, axis=0))
    return np.asarray((flank_forces > last[phase_index]).mean(axis=0))


@kept_by_content(4)
def _linear_law(drive: tuple[Harmonics, ...], back: tuple[Harmonics, ...], phases: Array) -> MeshLaw:
    """Return the linear law of all drive flanks, then all back flanks.

    drive, back: series of each mesh over the reference's cycle, N/m, of back flanks before they are
    mirrored; phases (2 meshes,): lags of the flanks, mesh periods.
    """
    return linear_law(_flank_series(drive, back, phases))


@kept_by_content(4)
def _law_of_tables(
    tables: tuple[FlankTables, ...],
    gears: tuple[int, ...],
    factors: Array,
    softening: Array | None,
    lags: tuple[float, ...],
) -> LoadDependentLaw:
    """Return the load-dependent law of all drive flanks, then all back flanks, each with its lag.

    tables: one `FlankTables` for each gear; gears (meshes,): number of each mesh's gear; factors
    (meshes,) on the forces; softening (meshes,): compliance in series with both flanks, m/N, or None;
    lags (2 meshes,) of the flanks, mesh periods.
    """
    mirrored_backs = [gear_tables.back.mirror() for gear_tables in tables]
    drives, backs = [tables[g].drive for g in gears], [mirrored_backs[g] for g in gears]
    flanks = [
        table if factor == 1.0 else table.scale(factor)
        for table, factor in zip([*drives, *backs], 2 * factors.tolist(), strict=True)
    ]
    if softening is not None:
        soft = 2 * softening.tolist()
        flanks = [soften_table(table, compliance) for table, compliance in zip(flanks, soft, strict=True)]
    return load_dependent_law(shift_tables(flanks, lags))


@lru_cache(maxsize=16)
def line_law(machine: Machine) -> MeshLaw:
    """Return the law of meshes whose two flanks share one line of action, as equation (13) is printed.

    Parameters
    ----------
    machine : Machine
        A machine with the printed kinematics.

    Returns
    -------
    MeshLaw
        Force (N) of each mesh by mesh position and compression (m).
    """
    if machine.law is not None:
        return machine.law
    lags = _lags(machine.phases)
    if machine.tables is None:
        return _line_linear_law(machine.stiffness, lags)
    return _line_law_of_tables(tuple(machine.tables[g].drive for _, g in machine.layout.meshes), lags)


@kept_by_content(4)
def _line_linear_law(stiffness: Harmonics, lags: tuple[float, ...]) -> MeshLaw:
    """Return the linear law of meshes with one common stiffness series (N/m), each shifted by its lag
    (mesh periods).
    """
    return linear_law([stiffness.shift(lag) for lag in lags])


@kept_by_content(4)
def _line_law_of_tables(drive: tuple[ForceTable, ...], lags: tuple[float, ...]) -> MeshLaw:
    """Return the load-dependent law of meshes from one drive-flank table for each, shifted by its lag
    (mesh periods).
    """
    return load_dependent_law(shift_tables(drive, lags))


def flank_places(lags: Array, cycles: Array) -> Array:
    """Return the position of every flank in the reference's mesh cycle: cycles - lag, its negative for a back
    flank, which goes through the reference's cycle the other way round.

    Parameters
    ----------
    lags : (2 meshes,) array
        Lag of each flank as `flank_lags` returns it, mesh periods, drive flanks first.
    cycles : (K,) array
        Mesh cycles from the start, periods.

    Returns
    -------
    (K, 2 meshes) array
        Mesh periods in [0, 1), drive flanks first.
    """
    positions = cycles[:, None] - lags
    positions[:, lags.size // 2 :] *= -1.0
    return np.mod(positions, 1.0)
