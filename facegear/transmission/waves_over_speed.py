"""Damped modes of a machine whose face gears bend, over speed: a coupled Campbell diagram.

Modes at neighbouring speeds are the same line where their shapes are alike by the modal assurance criterion
(MAC), the square of `a^H M b` by the product of `a^H M a` and `b^H M b`, with the mass matrix M as weight.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pandas as pd
from scipy.optimize import linear_sum_assignment

from facegear.arrays import Array, ComplexArray, Integers
from facegear.gear_body.excitation import HARMONICS, phase_factors
from facegear.transmission.layout import Layout
from facegear.transmission.linear_model import LinearModel
from facegear.transmission.turning_modes import TurningModes, wave_parts

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

    Parameters
    ----------
    linear : LinearModel
        Linear model of the machine.
    shapes : sequence of (n, m) complex arrays
        Mode shapes at each speed.

    Returns
    -------
    list of (m,) arrays of int
        Index of each line, from 1, at each speed.
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
