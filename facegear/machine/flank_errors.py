"""Errors of every flank over the mesh cycle: series, constant parts, slow ones, single teeth."""

from functools import lru_cache

import numpy as np

from facegear.arrays import Array
from facegear.by_content import kept_by_content
from facegear.harmonics import Harmonics
from facegear.machine.assembly import assembly
from facegear.machine.layout import Layout, Side
from facegear.machine.machine import Machine
from facegear.machine.mesh_phases import place_lags


def _lags(phases: Array) -> tuple[float, ...]:
    """Return phases (meshes,) as plain numbers within [0, 1), mesh periods, rounded to 12 digits so that
    equal lags compare as equal.
    """
    return tuple((np.round(phases, 12) % 1.0).tolist())


def flank_lags(machine: Machine, phases: Array) -> Array:
    """Return the lags of drive, then back flanks, from those of the meshes and the places of the pinions.

    Parameters
    ----------
    machine : Machine
        The machine.
    phases : (meshes,) array
        Lags of the meshes, mesh periods.

    Returns
    -------
    (2 meshes,) array
        Mesh periods.
    """
    return np.tile(phases, 2) + place_lags(machine.layout, machine.imperfections.outwards)


def error_series(machine: Machine) -> tuple[Harmonics, ...]:
    """Return e(t) of every flank over the reference's mesh cycle, without constant and slow errors.

    A mesh has its own series from `imperfections.series` if there is one, else `machine.error`, shifted
    by its error phase; a back flank has the mirrored series f(-t).

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    tuple of Harmonics
        One series for each flank, in m; drive flanks first. Positive keeps the flank from touching.
    """
    return _error_series(machine.without_errors)


@lru_cache(maxsize=16)
def _error_series(machine: Machine) -> tuple[Harmonics, ...]:
    """Return `error_series` of a machine without constant errors; cached by the machine's identity."""
    mesh_series = machine.imperfections.series
    shapes = [mesh_series.get(mesh, machine.error) for mesh in range(len(machine.layout.meshes))]
    return _flank_series(tuple(shapes), tuple(shapes), flank_lags(machine, machine.error_phases))


@lru_cache(maxsize=16)
def constant_errors(machine: Machine) -> Array:
    """Return the error of every flank that never changes: teeth, pinions out of place, assembly.

    The array is shared between calls and must not be written to.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.

    Returns
    -------
    (2 meshes,) array
        m; positive keeps the flank from touching.
    """
    layout, errors = machine.layout, machine.imperfections
    misfit = assembly(layout, machine.half_backlash, errors.clocking).misfit
    late, separating_error = np.zeros((2, 2, len(layout.meshes)))
    for mesh, (i, g) in enumerate(layout.meshes):
        lower = float(layout.gears[g].side is Side.LOWER)
        for flank, frame in enumerate(layout.flank_frames[g]):
            # along the tangent both flanks come late by opposite parts, as a turn of the pinion makes them
            x, y, z = frame.normal
            late[flank, mesh] = errors.error[mesh] - (
                x / frame.arm * errors.position[i, 0] + lower * misfit[i]
            )
            separating_error[flank, mesh] = -y * errors.position[i, 1] - z * errors.outwards[i]
    return _flanks(layout, late, separating_error)


def slow_errors(machine: Machine, cycles: Array) -> Array:
    """Return the error of every flank from runouts, pitch deviations and single teeth.

    A face gear's high point stands at its phase from the first pinion at the start and goes on as the gear
    turns, the lower one against the angles. Teeth whose centre lies towards the angle p stand ahead by the
    sine of p less the mesh's angle.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.
    cycles : (K,) array
        Mesh cycles of the reference from the start, periods.

    Returns
    -------
    (K, 2 meshes) array
        m.
    """
    layout, errors = machine.layout, machine.imperfections
    late, separating_error = np.zeros((2, 2, cycles.size, len(layout.meshes)))
    from_first = 2.0 * np.pi * layout.pitches_from_first / layout.gear_teeth
    for mesh, (i, g) in enumerate(layout.meshes):
        side = layout.gears[g].sign
        on_pinion, on_gear = teeth_in_mesh(layout, mesh, cycles)
        deviation = _deviation(errors.gear_pitch.get(g), on_gear)
        pinion_deviation = _deviation(errors.pinion_pitch.get(i), on_pinion)
        runout, gear_runout = errors.pinion_runout[i], errors.gear_runout[g]
        turn = 2.0 * np.pi * cycles / layout.pinion_teeth + runout.phase
        gear_turn = 2.0 * np.pi * cycles / layout.gear_teeth + gear_runout.phase - side * from_first[i]
        for flank, frame in enumerate(layout.flank_frames[g]):
            (x, y, _), (across, _, outwards) = frame.normal, frame.gear_normal
            late[flank, :, mesh] -= x / frame.arm * runout.amplitude * np.sin(turn)
            separating_error[flank, :, mesh] -= y * runout.amplitude * np.cos(turn)
            late[flank, :, mesh] += side * across / frame.arm * gear_runout.amplitude * np.sin(gear_turn)
            separating_error[flank, :, mesh] += outwards * gear_runout.amplitude * np.cos(gear_turn)
            late[flank, :, mesh] -= layout.pitch_slope * pinion_deviation
            late[flank, :, mesh] += layout.pitch_slope * deviation
    return _flanks(layout, late, separating_error) - _early_teeth(machine, cycles)


def _early_teeth(machine: Machine, cycles: Array) -> Array:
    """Return by how much every flank closes early (K, 2 meshes), m, as single teeth of its gears deviate.

    cycles (K,): mesh periods of the reference. Both teeth of a pair are taken at the place of the mesh
    cycle at which the mesh is; zeros without errors of single teeth.
    """
    teeth, layout = machine.imperfections.teeth, machine.layout
    early = np.zeros((2, cycles.size, len(layout.meshes)))
    if teeth is None:
        return _beside(early)
    for mesh, lag in enumerate(_lags(machine.phases)):
        positions = []
        for tooth in teeth_in_mesh(layout, mesh, cycles):
            apart = cycles - lag - tooth
            positions.append(tooth + apart - np.round(apart))
        early[:, :, mesh] = teeth.early(layout, *positions)
    return _beside(early)


def _beside(values: Array) -> Array:
    """Return values (2, K, meshes) of drive and back flanks as (K, 2 meshes), drive flanks first."""
    return np.concatenate([values[0], values[1]], axis=-1)


def teeth_in_mesh(layout: Layout, mesh: int, cycles: Array) -> tuple[Array, Array]:
    """Return the teeth of the pinion and of the face gear that a mesh has come to.

    They are counted on from turn to turn, so that they may exceed the number of teeth or be negative. At
    the start the first tooth of each gear is at the first pinion. A fraction lies between two teeth.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    mesh : int
        Index of the mesh.
    cycles : (K,) array
        Mesh cycles of the reference from the start, periods.

    Returns
    -------
    pair of (K,) arrays
        Tooth of the pinion and tooth of the face gear, as an index from 0.
    """
    i, g = layout.meshes[mesh]
    half_turn = 0.5 * layout.pinion_teeth if layout.half_turned(g) else 0.0
    return cycles - half_turn, cycles - layout.gears[g].sign * layout.pitches_from_first[i]


def mirror_series(series: Harmonics) -> Harmonics:
    """Return the series of f(-t).

    Parameters
    ----------
    series : Harmonics
        The series of f(t).

    Returns
    -------
    Harmonics
        In the unit of the given series.
    """
    return Harmonics(-series.sine, series.cosine)


@kept_by_content(8)
def _flank_series(
    drive: tuple[Harmonics, ...], back: tuple[Harmonics, ...], phases: Array
) -> tuple[Harmonics, ...]:
    """Return the series of all drive flanks, then of all back flanks, each shifted by its lag.

    drive, back: series of each mesh without lag, of which back flanks have the mirror image f(-t); phases (2
    meshes,): lags of the flanks, mesh periods.
    """
    flanks = [*drive, *(mirror_series(series) for series in back)]
    lags = [float(lag) for lag in np.round(phases, 12)]
    return tuple(series.shift(lag) for series, lag in zip(flanks, lags, strict=True))


def _flanks(layout: Layout, late: Array, separating_error: Array) -> Array:
    """Return errors (..., 2 meshes), drive flanks first: separating error plus the arm of the flank times
    what comes late, both (2, ..., meshes), m; the second along the drive flank's line of action.
    """
    drive, back = late
    flank_errors = separating_error[0] + drive, separating_error[1] - layout.back_arm * back
    return np.concatenate(flank_errors, axis=-1)


def _deviation(curve: Array | None, tooth_positions: Array) -> Array:
    """Return pitch deviations (K,), m, at positions (K,) counted in teeth: linear between the teeth of a
    periodic curve (teeth,), 0 without one.
    """
    if curve is None:
        return np.zeros(tooth_positions.size)
    return np.interp(tooth_positions, np.arange(curve.size), curve, period=curve.size)
