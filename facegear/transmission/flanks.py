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
from facegear.harmonics.series import Harmonics
from facegear.mesh_law.force_table import ForceTable, lagging
from facegear.mesh_law.law import MeshLaw
from facegear.mesh_law.linear import linear_law
from facegear.mesh_law.load_dependent import LoadDependentLaw, load_dependent_law
from facegear.transmission.assembly import assembly
from facegear.transmission.layout import Layout, Side
from facegear.transmission.machine import FlankTables, Machine, OpenFlanks
from facegear.transmission.soft_tables import softened

NO_LOAD = 1e-9
"""Part of the largest force of all meshes below which a force is rounding and counts as none."""


def carried(forces: Array) -> Array:
    """Forces of meshes or flanks without those that are rounding beside the largest of all."""
    size = np.abs(forces)
    return np.where(size > NO_LOAD * size.max(initial=0.0), forces, 0.0)


def flank_gaps(machine: Machine) -> Array:
    """Half backlash b of every flank, shape (2 meshes,), m."""
    return np.tile(machine.half_backlash, 2)


@dataclass(frozen=True, eq=False)
class MeshContacts:
    """The contacts of all meshes, see Layout.contacts.

    law; error: e(t) of each over the mesh cycle, m; lower, upper (contacts,): edges of the deflection, m,
    where a flank that only pushes has no lower one; damping (contacts,), N s/m.
    """

    law: MeshLaw
    error: tuple[Harmonics, ...]
    lower: Array
    upper: Array
    damping: Array


def mesh_contacts(machine: Machine) -> MeshContacts:
    """Without errors that change from one mesh cycle to the next."""
    return _flank_contacts(machine) if machine.layout.kinematics.flanks_apart else _line_contacts(machine)


def _flank_contacts(machine: Machine) -> MeshContacts:
    """Return the contacts of all flanks; errors that never change stand in their edges."""
    upper = flank_gaps(machine) + constant_errors(machine)
    damping = flank_dampers(machine, np.ones(upper.size, dtype=bool))
    never = np.full(upper.size, -np.inf)
    return MeshContacts(flank_law(machine), error_series(machine), never, upper, damping)


def flank_dampers(machine: Machine, contact_mask: Mask) -> Array:
    """Return the dampers that act on the flanks.

    Parameters
    ----------
    machine
        A machine whose meshes have two flanks each.
    contact_mask : (2 meshes,)
        Which flanks are in contact, drive flanks first.

    Returns
    -------
    Array
        Damping of each flank, shape (2 meshes,), N s/m. Where it acts on open flanks, the two flanks of a
        mesh share it, so that the rotation alone meets the whole of it; or the drive flank has all of it.
    """
    meshes, damping = contact_mask.size // 2, machine.damping
    if damping.open_flanks is OpenFlanks.MESH_DEFLECTION:
        return np.repeat([damping.mesh, 0.0], meshes)
    if damping.open_flanks is OpenFlanks.ALWAYS:
        return np.full(contact_mask.size, 0.5 * damping.mesh)
    return np.where(contact_mask, damping.mesh, 0.0)


def _line_contacts(machine: Machine) -> MeshContacts:
    """Of meshes whose two flanks share one line of action."""
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
    """The law of all drive flanks, then all back flanks: the machine's own, or else its mesh stiffness."""
    return _flank_law(machine.alike)


@lru_cache(maxsize=16)
def _flank_law(machine: Machine) -> MeshLaw:
    if machine.law is not None:
        return machine.law
    if machine.tables is None:
        return _linear_law(machine.mesh_stiffness, machine.phases)
    gears, own = tuple(g for _, g in machine.layout.meshes), machine.imperfections.stiffness
    return _law_of_tables(machine.tables, gears, own, machine.own_softening, tuple(_lags(machine)))


def past_law(machine: Machine, cycles: Array, flank_forces: Array) -> Array:
    """Fraction of positions (2 meshes,) at which flanks (K, 2 meshes), N, are pressed by more than their law
    has at its last level; `cycles` (K,): mesh cycles from the start.
    """
    law = flank_law(machine)
    if law.straight:
        return np.zeros(law.contacts)
    places = np.asarray(np.round(np.mod(cycles, 1.0), 9), dtype=np.float64)
    phases, where = np.unique(places, return_inverse=True)
    last = law.force(phases, np.repeat(law.levels[-1:], phases.size, axis=0))
    return np.asarray((flank_forces > last[where]).mean(axis=0))


@kept_by_content(4)
def _linear_law(stiffness: tuple[Harmonics, ...], phases: Array) -> MeshLaw:
    return linear_law(_both(stiffness, phases))


@kept_by_content(4)
def _law_of_tables(
    tables: tuple[FlankTables, ...],
    gears: tuple[int, ...],
    factors: Array,
    softening: Array | None,
    lags: tuple[float, ...],
) -> LoadDependentLaw:
    """The tables of all flanks with their softening, each as its mesh passes through the cycle.

    gears (meshes,): the number of each mesh's gear; factors, softening (m/N), lags (mesh periods) of meshes.
    """
    mirrored_backs = [both.back.mirrored() for both in tables]
    drives, backs = [tables[g].drive for g in gears], [mirrored_backs[g] for g in gears]
    flanks = [
        table if factor == 1.0 else table.scaled(factor)
        for table, factor in zip([*drives, *backs], 2 * factors.tolist(), strict=True)
    ]
    if softening is not None:
        soft = 2 * softening.tolist()
        flanks = [softened(table, compliance) for table, compliance in zip(flanks, soft, strict=True)]
    return load_dependent_law(lagging(flanks, 2 * lags))


def _lags(machine: Machine) -> list[float]:
    """Lag of every mesh in the mesh cycle, in mesh periods."""
    return [float(lag) for lag in np.round(machine.phases, 12) % 1.0]


@lru_cache(maxsize=16)
def line_law(machine: Machine) -> MeshLaw:
    """The law of meshes whose two flanks share one line of action, as equation (13) is printed."""
    if machine.law is not None:
        return machine.law
    lags = tuple(_lags(machine))
    if machine.tables is None:
        return _line_linear_law(machine.stiffness, lags)
    return _line_law_of_tables(tuple(machine.tables[g].drive for _, g in machine.layout.meshes), lags)


@kept_by_content(4)
def _line_linear_law(stiffness: Harmonics, lags: tuple[float, ...]) -> MeshLaw:
    return linear_law([stiffness.shift(lag) for lag in lags])


@kept_by_content(4)
def _line_law_of_tables(drive: tuple[ForceTable, ...], lags: tuple[float, ...]) -> MeshLaw:
    return load_dependent_law(lagging(drive, lags))


def error_series(machine: Machine) -> tuple[Harmonics, ...]:
    """e(t) of every flank over the reference's mesh cycle, m, without what is constant or slow."""
    return _error_series(machine.alike)


@lru_cache(maxsize=16)
def _error_series(machine: Machine) -> tuple[Harmonics, ...]:
    own = machine.imperfections.series
    shapes = [own.get(mesh, machine.error) for mesh in range(len(machine.layout.meshes))]
    return _both(tuple(shapes), machine.error_phases)


@lru_cache(maxsize=16)
def constant_errors(machine: Machine) -> Array:
    """Error of every flank that never changes, (2 meshes,), m: teeth, pinions out of place, assembly; shared,
    only read.
    """
    layout, errors = machine.layout, machine.imperfections
    cosine, sine = np.cos(layout.pressure_angle), np.sin(layout.pressure_angle)
    misfit = assembly(layout, machine.half_backlash, errors.clocking).misfit
    side = np.array([[gear.sign] for gear in layout.gears])
    lower = np.array([[float(gear.side is Side.LOWER)] for gear in layout.gears])
    off = side * cosine * errors.position[:, 0] + lower * misfit
    separating = -side * sine * errors.position[:, 1]
    return _flanks(errors.error - off.ravel(), separating.ravel())


def slow_errors(machine: Machine, cycles: Array) -> Array:
    """Error of every flank from runouts, pitch deviations and single teeth, shape (K, 2 meshes), m.

    `cycles` (K,) counts mesh cycles of the reference from the start. A face gear's high point stands at its
    phase from the first pinion at the start and goes on as the gear turns, the lower one against the angles.
    Teeth whose centre lies towards the angle p stand ahead by the sine of p less the mesh's angle.
    """
    layout, errors = machine.layout, machine.imperfections
    tangential, separating = np.zeros((2, cycles.size, len(layout.meshes)))
    cosine, sine = np.cos(layout.pressure_angle), np.sin(layout.pressure_angle)
    from_first = 2.0 * np.pi * layout.pitches_from_first / layout.gear_teeth
    for mesh, (i, g) in enumerate(layout.meshes):
        side = layout.gears[g].sign
        runout = errors.pinion_runout[i]
        turn = 2.0 * np.pi * cycles / layout.pinion_teeth + runout.phase
        tangential[:, mesh] -= side * cosine * runout.amplitude * np.sin(turn)
        separating[:, mesh] -= side * sine * runout.amplitude * np.cos(turn)
        runout = errors.gear_runout[g]
        turn = 2.0 * np.pi * cycles / layout.gear_teeth + runout.phase - side * from_first[i]
        tangential[:, mesh] += cosine * runout.amplitude * np.sin(turn)
        on_pinion, on_gear = teeth_in_mesh(layout, mesh, cycles)
        tangential[:, mesh] -= cosine * _deviation(errors.pinion_pitch.get(i), on_pinion)
        tangential[:, mesh] += cosine * _deviation(errors.gear_pitch.get(g), on_gear)
    return _flanks(tangential, separating) - _early_teeth(machine, cycles)


def _early_teeth(machine: Machine, cycles: Array) -> Array:
    """By how much every flank comes early, (K, 2 meshes) m, as single teeth of its gears deviate.

    Both teeth are at that place of the mesh cycle at which the mesh is.
    """
    teeth, layout = machine.imperfections.teeth, machine.layout
    early = np.zeros((2, cycles.size, len(layout.meshes)))
    if teeth is None:
        return _beside(early)
    for mesh, lag in enumerate(_lags(machine)):
        both = []
        for counted in teeth_in_mesh(layout, mesh, cycles):
            apart = cycles - lag - counted
            both.append(counted + apart - np.round(apart))
        early[:, :, mesh] = teeth.early(layout, *both)
    return _beside(early)


def _beside(both: Array) -> Array:
    """Those (2, K, meshes) of drive and back flanks beside each other, (K, 2 meshes)."""
    return np.concatenate([both[0], both[1]], axis=-1)


def flank_places(phases: Array, cycles: Array) -> Array:
    """Place of every flank in the reference's mesh cycle, (K, 2 meshes) in [0, 1), drive flanks first.

    phases (meshes,): lag of each mesh; `cycles` (K,) counts mesh cycles from the start. A back flank goes
    through the reference's cycle the other way round.
    """
    drive = cycles[:, None] - phases
    return np.mod(np.concatenate([drive, -drive], axis=1), 1.0)


def teeth_in_mesh(layout: Layout, mesh: int, cycles: Array) -> tuple[Array, Array]:
    """Teeth of the pinion and of the face gear (K,) that a mesh has come to, counted on from turn to turn.

    `cycles` (K,) counts mesh cycles of the reference from the start; a fraction lies between two teeth. At
    the start the first tooth of each gear is at the first pinion.
    """
    i, g = layout.meshes[mesh]
    half_turn = 0.5 * layout.pinion_teeth if layout.half_turned(g) else 0.0
    return cycles - half_turn, cycles - layout.gears[g].sign * layout.pitches_from_first[i]


def mirrored(series: Harmonics) -> Harmonics:
    """The series of f(-t)."""
    return Harmonics(-series.sine, series.cosine)


@kept_by_content(8)
def _both(drive: tuple[Harmonics, ...], phases: Array) -> tuple[Harmonics, ...]:
    """Drive flanks and their mirror images, each as its mesh passes through the cycle."""
    flanks = [*drive, *(mirrored(own) for own in drive)]
    lags = [float(lag) for lag in np.round(np.tile(phases, 2), 12)]
    return tuple(own.shift(lag) for own, lag in zip(flanks, lags, strict=True))


def _flanks(tangential: Array, separating: Array) -> Array:
    return np.concatenate([separating + tangential, separating - tangential], axis=-1)


def _deviation(curve: Array | None, places: Array) -> Array:
    """Pitch deviation between the teeth, linear from tooth to tooth, (K,)."""
    if curve is None:
        return np.zeros(places.size)
    return np.interp(places, np.arange(curve.size), curve, period=curve.size)
