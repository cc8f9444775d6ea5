"""Modes of a machine that turns, with all its damping: frequencies, decay, and the waves in its face gears.

    (l^2 M + l (C + W G) + K + W N + W^2 P) q = 0

with W the speed of the pinions. Damping that turns with a body (N) may feed energy from its rotation into a
motion that lags behind it: a mode whose l has a positive real part grows.

Damped modes of a machine whose face gears bend, over speed: a coupled Campbell diagram. Modes at neighbouring
speeds are the same line where their shapes are alike by the modal assurance criterion (MAC), the square of
`a^H M b` by the product of `a^H M a` and `b^H M b`, with the mass matrix M as weight.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pandas as pd
import scipy.linalg
from scipy.optimize import linear_sum_assignment

from facegear.arrays import Array, ComplexArray, Integers
from facegear.machine.flanks import flank_dampers
from facegear.machine.layout import Layout
from facegear.machine.linear_model import LinearModel
from facegear.machine.loaded_modes import pressed_springs
from facegear.machine.machine import Machine
from facegear.parts.modes import HARMONICS, phase_factors

RIGID = 1e-6
"""Part of the largest l below which an imaginary part is a rigid motion's or rounding."""
GROWS = 1e-9
"""Negative damping ratio that is not rounding."""
LISTED_ENERGY = 0.01
"""Part of a mode's energy below which a gear's waves of one order are left out of the table."""


@dataclass(frozen=True, eq=False)
class TurningModes:
    """m damped modes that vibrate.

    - exponents (m,): eigenvalues l, 1/s, with positive imaginary part, ascending by it
    - shapes (n, m): displacement part of the eigenvectors, of arbitrary scale
    """

    exponents: ComplexArray
    shapes: ComplexArray

    @property
    def frequencies(self) -> Array:
        """Damped natural frequencies (m,): imaginary part of l over 2 pi, Hz."""
        return np.asarray(self.exponents.imag / (2.0 * np.pi))

    @property
    def damping_ratios(self) -> Array:
        """Damping ratios (m,), -Re l / abs(l): part of critical damping, negative for a mode that grows."""
        return np.asarray(-self.exponents.real / np.abs(self.exponents))


def turning_modes(linear: LinearModel, springs: Array, dampers: Array, speed: float) -> TurningModes:
    """Compute the damped modes at a pinion speed, from the eigenvalues of the state matrix.

    Parameters
    ----------
    linear : LinearModel
        Bodies and bearings.
    springs : (2 meshes, 2 meshes) array
        Stiffness of the flanks, N/m.
    dampers : (2 meshes,) array
        Damping of the flanks, N s/m.
    speed : float
        Speed of the pinions, rad/s.

    Returns
    -------
    TurningModes
        Modes that vibrate, ascending by frequency; exponents in 1/s. Overdamped and rigid motions are
        left out.
    """
    rows, size = linear.rows, linear.size
    stiffness = linear.stiffness + rows.T @ springs @ rows
    damping = linear.damping + (dampers * rows.T) @ rows
    if linear.spin is not None:
        stiffness = stiffness + speed * linear.spin.circulatory + speed**2 * linear.spin.centrifugal
        damping = damping + speed * linear.spin.gyroscopic
    accelerations = scipy.linalg.solve(linear.mass, np.hstack([stiffness, damping]), assume_a="pos")
    system = np.block(
        [[np.zeros((size, size)), np.eye(size)], [-accelerations[:, :size], -accelerations[:, size:]]]
    )
    exponents, states = scipy.linalg.eig(system)
    oscillating = np.flatnonzero(exponents.imag > RIGID * np.abs(exponents).max())
    order = oscillating[np.argsort(exponents[oscillating].imag)]
    return TurningModes(exponents[order], states[:size, order])


def machine_at_speeds(machine: Machine, speeds_rpm: Sequence[float]) -> list[TurningModes]:
    """Compute the damped modes of geometric meshes about their static load at every pinion speed.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.
    speeds_rpm : Sequence of float
        Speeds of the pinions, rpm.

    Returns
    -------
    list of TurningModes
        One entry for each speed, 1/s.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    linear, springs = pressed_springs(machine)
    dampers = flank_dampers(machine.damping, np.diagonal(springs) > 0.0)
    return [turning_modes(linear, springs, dampers, speed * np.pi / 30.0) for speed in speeds_rpm]


def wave_table(layout: Layout, linear: LinearModel, modes: TurningModes) -> pd.DataFrame:
    """Return the waves that hold LISTED_ENERGY of the kinetic energy of each mode.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    linear : LinearModel
        Linear model of the machine.
    modes : TurningModes
        Its modes.

    Returns
    -------
    pd.DataFrame
        One row for each mode, gear and number of nodal diameters. Columns order, frequency_hz, damping_ratio,
        gear, nodal_diameters, energy_fraction, forward_fraction: part of the wave's amplitude squared that
        travels as the gear turns, half of it for no nodal diameters.
    """
    rows = []
    for gear, diameters, energy, forward in wave_parts(layout, linear, modes.shapes):
        for mode in np.flatnonzero(energy > LISTED_ENERGY):
            parts = (modes.frequencies[mode], modes.damping_ratios[mode])
            rows.append((mode + 1, *parts, gear, diameters, energy[mode], forward[mode]))
    columns = ["order", "frequency_hz", "damping_ratio", "gear", "nodal_diameters"]
    table = pd.DataFrame(rows, columns=[*columns, "energy_fraction", "forward_fraction"])
    return table.sort_values(["order", "gear", "nodal_diameters"], ignore_index=True)


def wave_parts(
    layout: Layout, linear: LinearModel, shapes: ComplexArray
) -> list[tuple[str, int, Array, Array]]:
    """Return the kinetic energy in the waves of every gear that bends, by number of nodal diameters.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    linear : LinearModel
        Linear model of the machine.
    shapes : (n, m) complex array
        Mode shapes.

    Returns
    -------
    list of tuple
        Side of the gear, number of nodal diameters, fraction (m,) of the kinetic energy of every mode in
        these waves, and fraction (m,) of the waves that travels forward.
    """
    energy = np.real(shapes.conj() * linear.momentum(shapes))
    energy = energy / energy.sum(axis=0)
    return [
        (
            gear.side.value,
            diameters,
            energy[members].sum(axis=0),
            _forward(linear, shapes, members, gear.sign),
        )
        for gear in layout.gears
        for diameters, members in _members(linear, gear.name).items()
    ]


def _members(linear: LinearModel, gear: str) -> dict[int, list[int]]:
    """Return the indices of a gear's elastic coordinates in the model by number of nodal diameters;
    `gear` is the gear's name in labels such as `upper face gear:n2 1c`.
    """
    members: dict[int, list[int]] = {}
    for number, label in enumerate(linear.labels):
        owner, _, letter = label.rpartition(":")
        if owner == gear and " " in letter:
            members.setdefault(int(letter.split()[0][1:]), []).append(number)
    return members


def _forward(linear: LinearModel, shapes: ComplexArray, members: list[int], sign: float) -> Array:
    """Return the fraction (m,) of each shape's squared amplitude that lies in the wave turning with the
    gear.

    shapes (n, m); members: coordinates of one gear with one number of nodal diameters; sign: sense in
    which the gear turns, 1 towards growing angles. With q_c = Re[a e^(i w t)] and q_s = Re[b e^(i w t)]
    the wave towards growing angles has abs(a + i b) / 2, the other abs(a - i b) / 2. It is 0.5 for no nodal
    diameters.
    """
    cosine = [number for number in members if linear.labels[number].endswith("c")]
    sine = [number for number in members if linear.labels[number].endswith("s")]
    if not cosine:
        return np.full(shapes.shape[1], 0.5)
    onwards = (np.abs(shapes[cosine] + 1j * shapes[sine]) ** 2).sum(axis=0)
    back = (np.abs(shapes[cosine] - 1j * shapes[sine]) ** 2).sum(axis=0)
    forward = onwards if sign > 0.0 else back
    return np.asarray(forward / np.maximum(onwards + back, np.finfo(float).tiny))


MIN_MAC = 0.2
"""MAC below which two modes are not joined. A standing wave at rest has 0.5 of either travelling wave, and
0.25 where two equal gears share it."""


def campbell_table(
    layout: Layout, linear: LinearModel, speeds_rpm: Sequence[float], modes: Sequence[TurningModes]
) -> pd.DataFrame:
    """Return frequency, damping and main waves of each mode at each speed.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    linear : LinearModel
        Linear model of the machine.
    speeds_rpm : Sequence of float
        Pinion speeds, rpm.
    modes : Sequence of TurningModes
        Modes at each speed.

    Returns
    -------
    pd.DataFrame
        One row for each speed and mode, with the waves that hold the largest part of its kinetic energy.
        Columns speed_rpm, line (the same number at all speeds for modes that are joined by their shapes, from
        1), frequency_hz, damping_ratio, gear, nodal_diameters, energy_fraction, forward_fraction.
    """
    numbers = join_lines(linear, [speed_modes.shapes for speed_modes in modes])
    tables = []
    for speed, speed_modes, lines in zip(speeds_rpm, modes, numbers, strict=True):
        parts = wave_parts(layout, linear, speed_modes.shapes)
        energy, forward = (np.array([part[column] for part in parts]) for column in (2, 3))
        largest, every = energy.argmax(axis=0), np.arange(lines.size)
        tables.append(
            pd.DataFrame(
                {
                    "speed_rpm": speed,
                    "line": lines,
                    "frequency_hz": speed_modes.frequencies,
                    "damping_ratio": speed_modes.damping_ratios,
                    "gear": [parts[number][0] for number in largest],
                    "nodal_diameters": [parts[number][1] for number in largest],
                    "energy_fraction": energy[largest, every],
                    "forward_fraction": forward[largest, every],
                }
            )
        )
    return pd.concat(tables, ignore_index=True)


def join_lines(linear: LinearModel, shapes: Sequence[ComplexArray]) -> list[Integers]:
    """Return the numbers of the lines that the modes of every speed belong to.

    Modes at neighbouring speeds are assigned to each other with the largest sum of MAC; pairs below
    MIN_MAC are not joined, and an unjoined mode begins a new line.

    Parameters
    ----------
    linear : LinearModel
        Linear model of the machine.
    shapes : sequence of (n, m) complex arrays
        Mode shapes at each speed, in the order of the speeds.

    Returns
    -------
    list of (m,) arrays of int
        For each speed the line of each mode, as an index from 1.
    """
    lines = [np.arange(1, shapes[0].shape[1] + 1)]
    last = int(lines[0].size)
    for before, after in pairwise(shapes):
        likeness = assurance(linear, before, after)
        first, second = linear_sum_assignment(-likeness)
        is_joined = likeness[first, second] >= MIN_MAC
        numbers = np.zeros(after.shape[1], np.int64)
        numbers[second[is_joined]] = lines[-1][first[is_joined]]
        new = numbers == 0
        numbers[new] = last + np.arange(1, new.sum() + 1)
        last = max(last, int(numbers.max(initial=0)))
        lines.append(numbers)
    return lines


def assurance(linear: LinearModel, first: ComplexArray, second: ComplexArray) -> Array:
    """Return the modal assurance criterion between the columns of two sets of shapes.

    Parameters
    ----------
    linear : LinearModel
        Linear model of the machine.
    first : (n, m) complex array
        Mode shapes, any unit.
    second : (n, k) complex array
        Mode shapes, any unit.

    Returns
    -------
    (m, k) array
        MAC from 0 to 1, dimensionless.
    """
    norms = [np.real((shapes.conj() * linear.momentum(shapes)).sum(axis=0)) for shapes in (first, second)]
    cross_products = first.conj().T @ linear.momentum(second)
    return np.asarray(np.abs(cross_products) ** 2 / np.outer(*norms))


def campbell_crossings(table: pd.DataFrame, teeth: tuple[int, int], angles: Array) -> pd.DataFrame:
    """Return the crossings of mesh harmonics with the lines of campbell_table(), linear between speeds.

    Parameters
    ----------
    table : pd.DataFrame
        Table of campbell_table().
    teeth : tuple[int, int]
        Number of teeth of pinion and face gear.
    angles : (n,) array
        Angles of the pinions, rad.

    Returns
    -------
    pd.DataFrame
        One row for each crossing. Columns of the table, taken from the nearer speed, with harmonic, wave
        (standing, forward or backward, by the larger part) and phase_factor: how many times the force of one
        mesh drives that wave.
    """
    rows = []
    for _, line in table.groupby("line"):
        speed, frequency = line["speed_rpm"].to_numpy(), line["frequency_hz"].to_numpy()
        for harmonic in HARMONICS:
            over = harmonic * teeth[0] * speed / 60.0 - frequency
            for at in np.flatnonzero((over[:-1] < 0.0) != (over[1:] < 0.0)):
                part = over[at] / (over[at] - over[at + 1])
                row = line.iloc[at + (part > 0.5)].to_dict()
                order = int(row["nodal_diameters"])
                forward = row["forward_fraction"] >= 0.5
                factors = phase_factors(order, harmonic, teeth[1], angles)
                row["speed_rpm"] = speed[at] + part * (speed[at + 1] - speed[at])
                row["frequency_hz"] = frequency[at] + part * (frequency[at + 1] - frequency[at])
                row["harmonic"] = harmonic
                row["wave"] = ("forward" if forward else "backward") if order else "standing"
                row["phase_factor"] = factors[0 if forward else 1]
                rows.append(row)
    columns = [*table.columns, "harmonic", "wave", "phase_factor"]
    return pd.DataFrame(rows, columns=columns).sort_values(["speed_rpm", "line"], ignore_index=True)
