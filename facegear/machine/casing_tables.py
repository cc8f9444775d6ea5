"""Tables of a machine on a casing: motions of its seats, loads of its feet, forces of the meshes, modes."""

from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.casing.mounted import LETTERS, MountedCasing
from facegear.machine.casing import body_axes
from facegear.machine.casing_coordinates import CASING, CASING_MODE, casing_motion
from facegear.machine.linear_model import LinearModel
from facegear.machine.machine import Machine
from facegear.machine.modes import Modes
from facegear.machine.shaft_tables import (
    bearing_names,
    ring_strains,
    shaft_bearing_loads,
    tilting_moments,
)
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import Equilibria, bearing_forces, mean_equilibrium

FORCES = ("x_n", "y_n", "z_n", "tilt_x_n_m", "tilt_y_n_m", "tilt_z_n_m")
"""Columns of forces along and moments about the casing's axes."""
MOTIONS = ("x_um", "y_um", "z_um", "tilt_x_urad", "tilt_y_urad", "tilt_z_urad")
"""Columns of the motions of a seat."""


def seat_motion_table(machine: Machine, equilibrium: Equilibria) -> pd.DataFrame:
    """Return the motion of every seat under the mean torques.

    Parameters
    ----------
    machine : Machine
        A machine on a casing.
    equilibrium : Equilibria
        Its equilibrium, of which the first position counts.

    Returns
    -------
    pd.DataFrame
        A row a seat: seat, then MOTIONS along and about X (to a pinion at angle 0), Y and Z.
    """
    assert machine.casing is not None
    mounted = machine.casing.mounted
    motion = 1e6 * casing_motion(machine.linear, equilibrium.displacements[0])
    rows = [(name, *motion[at]) for name, at in mounted.seats.items()]
    return pd.DataFrame(rows, columns=["seat", *MOTIONS])


def foot_table(machine: Machine, equilibrium: Equilibria) -> pd.DataFrame:
    """Return the loads of the casing on its feet, their sum, and the loads that act on the machine.

    Parameters
    ----------
    machine : Machine
        A machine on a casing.
    equilibrium : Equilibria
        Its equilibrium, of which the first position counts.

    Returns
    -------
    pd.DataFrame
        A row a foot, about the foot; then rows `all feet`, `ground` (bearings that stand on no seat),
        `applied` and `out of balance`, about the point where the pinions' axes meet the gears' axis. Columns
        foot and FORCES.
    """
    assert machine.casing is not None
    mounted = machine.casing.mounted
    loads = (mounted.foot_loads @ casing_motion(machine.linear, equilibrium.displacements[0])).reshape(-1, 6)
    rows = list(zip(mounted.foot_names.tolist(), loads, strict=True))
    total = np.zeros(6)
    for position, load in zip(mounted.foot_positions, loads, strict=True):
        total += about_origin(position, load)
    applied_load, ground_load = applied_loads(machine), ground_loads(machine, equilibrium)
    sums = (
        ("all feet", total),
        ("ground", ground_load),
        ("applied", applied_load),
        ("out of balance", applied_load - total - ground_load),
    )
    return pd.DataFrame([(name, *load) for name, load in (*rows, *sums)], columns=["foot", *FORCES])


def about_origin(position: Array, load: Array) -> Array:
    """Return a load at a point as one at the origin.

    Parameters
    ----------
    position : (3,) array
        The point, m.
    load : (6,) array
        Force and moment about the point, N and N m.

    Returns
    -------
    (6,) array
        Force and moment about the origin, N and N m.
    """
    return np.append(load[:3], load[3:] + np.cross(position, load[:3]))


def applied_loads(machine: Machine) -> Array:
    """Return the sum of the torques and forces on all bodies, about the point where the pinions' axes meet.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    (6,) array
        Force and moment in the axes of the casing, N and N m.
    """
    total, pinions = np.zeros(6), len(machine.layout.pinions)
    for body, (torque, force) in enumerate(zip(machine.torques, machine.forces, strict=True)):
        axes, point = body_axes(machine.layout, body)
        # Pinions turn against their z, gears about it, as both drive.
        moment = (-torque if body < pinions else torque) * axes[2]
        total += about_origin(point, np.append(axes.T @ force, moment))
    return total


def ground_loads(machine: Machine, equilibrium: Equilibria) -> Array:
    """Return the loads on the ground of bodies and bearings that stand on no seat of the casing.

    Parameters
    ----------
    machine : Machine
        A machine on a casing.
    equilibrium : Equilibria
        Its equilibrium, of which the first position counts.

    Returns
    -------
    (6,) array
        Force and moment about the origin in the axes of the casing, N and N m; a gear without tilts also
        holds moments, which are not in it.
    """
    assert machine.casing is not None
    total, forces = np.zeros(6), bearing_forces(machine, equilibrium)
    seats, line = machine.casing.bearing_seats, machine.drive_line
    for body, force in enumerate(forces[0]):
        if body not in seats:
            axes, point = body_axes(machine.layout, body)
            total += about_origin(point, np.append(axes.T @ force, np.zeros(3)))
    total[3:] += _moments_on_ground(machine, equilibrium)
    if line is None:
        return total
    loads = shaft_bearing_loads(
        line,
        forces,
        tilting_moments(machine, equilibrium),
        equilibrium.shafts,
        ring_strains(machine, equilibrium.displacements),
    )[0]
    numbers: dict[int, int] = {}
    for (body, _), load in zip(bearing_names(line), loads, strict=True):
        number = numbers[body] = numbers.get(body, -1) + 1
        if body in seats and not seats[body][number]:
            distance = float(machine.casing.bearing_places[body][number])
            axes, point = body_axes(machine.layout, body, distance)
            total += about_origin(point, np.append(axes.T @ load[:3], axes[:2].T @ load[3:]))
    return total


def _moments_on_ground(machine: Machine, equilibrium: Equilibria) -> Array:
    """Return the moments (3,), N m, by which meshes would tilt the pinions that the ground holds upright."""
    assert machine.casing is not None
    layout, line, moments = machine.layout, machine.drive_line, np.zeros(3)
    if not layout.meshes_tilt_pinions:
        return moments
    forces = equilibrium.flank_forces[0].reshape(2, -1)
    for mesh, (pinion, gear) in enumerate(layout.meshes):
        if pinion in machine.casing.bearing_seats or (line is not None and pinion in line.tilting):
            continue
        tilting = np.array([frame.moment[:2] for frame in layout.flank_frames[gear]])
        moments -= body_axes(layout, pinion)[0][:2].T @ (forces[:, mesh] @ tilting)
    return moments


def sharing_table(machine: Machine, equilibrium: Equilibria) -> pd.DataFrame:
    """Return the mesh forces with the casing, and with seats that stand still, side by side.

    Parameters
    ----------
    machine : Machine
        A machine on a casing.
    equilibrium : Equilibria
        Its equilibrium, of which the first position counts.

    Returns
    -------
    pd.DataFrame
        A row a mesh: mesh, force_n, force_on_fixed_seats_n, change_percent of the latter.
    """
    fixed_forces = mean_equilibrium(at_rest(replace(machine, casing=None))).forces[0]
    forces = equilibrium.forces[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        change = 100.0 * np.where(fixed_forces != 0.0, (forces - fixed_forces) / fixed_forces, np.nan)
    columns = ("mesh", "force_n", "force_on_fixed_seats_n", "change_percent")
    rows = zip(machine.layout.mesh_names, forces, fixed_forces, change, strict=True)
    return pd.DataFrame(list(rows), columns=list(columns))


def casing_energy_fractions(linear: LinearModel, modes: Modes) -> Array:
    """Return the part of the kinetic energy of each mode that is in the casing.

    Parameters
    ----------
    linear : LinearModel
        Linear model of the machine.
    modes : Modes
        Its modes.

    Returns
    -------
    (modes,) array
        0 to 1, dimensionless; 0 for a machine without casing.
    """
    energy = np.real(modes.shapes.conj() * linear.momentum(modes.shapes))
    is_casing = np.array([label.startswith(f"{CASING}:") for label in linear.labels])
    fractions = np.asarray(energy[is_casing].sum(axis=0) / energy.sum(axis=0))
    for start, stop in modes.groups:  # shapes of equal frequencies are one basis of many
        fractions[start:stop] = fractions[start:stop].mean()
    return fractions


def mode_table(machine: Machine, modes: Modes) -> pd.DataFrame:
    """Return the modes of the machine with those of the casing marked.

    Parameters
    ----------
    machine : Machine
        A machine on a casing.
    modes : Modes
        Its modes.

    Returns
    -------
    pd.DataFrame
        A row a mode: order, frequency_hz, casing_energy_fraction, is_casing_mode, and is_valid, whether the
        modes that were kept of the casing reach as far (`MountedCasing.valid_up_to`).
    """
    assert machine.casing is not None
    fractions = casing_energy_fractions(machine.linear, modes)
    return pd.DataFrame(
        {
            "order": np.arange(1, modes.frequencies.size + 1),
            "frequency_hz": modes.frequencies,
            "casing_energy_fraction": fractions,
            "is_casing_mode": fractions >= CASING_MODE,
            "is_valid": modes.frequencies <= machine.casing.mounted.valid_up_to,
        }
    )


def seat_table(mounted: MountedCasing) -> pd.DataFrame:
    """Return place and stiffness of every seat of a casing alone.

    Parameters
    ----------
    mounted : MountedCasing
        The casing on its feet.

    Returns
    -------
    pd.DataFrame
        A row a seat: seat, x_mm, y_mm, z_mm, then its stiffness against each of its six motions with all
        other seats free: x_n_per_m to z_n_per_m, tilt_x_n_m_per_rad to tilt_z_n_m_per_rad.
    """
    compliance = np.diagonal(np.linalg.inv(mounted.stiffness))
    units = [f"{letter}_{'n_m_per_rad' if 'tilt' in letter else 'n_per_m'}" for letter in LETTERS]
    rows = [
        (name, *(1e3 * position), *(1.0 / compliance[at]))
        for (name, at), position in zip(mounted.seats.items(), mounted.seat_positions, strict=True)
    ]
    return pd.DataFrame(rows, columns=["seat", "x_mm", "y_mm", "z_mm", *units])


def frequency_table(mounted: MountedCasing) -> pd.DataFrame:
    """Return the natural frequencies of a casing alone.

    Parameters
    ----------
    mounted : MountedCasing
        The casing on its feet.

    Returns
    -------
    pd.DataFrame
        Columns held (what stands still: `feet`, or `feet and seats`), mode, frequency_hz.
    """
    parts = (("feet", mounted.own_frequencies), ("feet and seats", mounted.frequencies))
    rows = [
        (supports, number, frequency)
        for supports, frequencies in parts
        for number, frequency in enumerate(frequencies.tolist(), start=1)
    ]
    return pd.DataFrame(rows, columns=["held", "mode", "frequency_hz"])
