"""A load-dependent law with a spring in series: a force F(x) stands at x + c F(x), at every phase."""

import numpy as np

from facegear.arrays import Array
from facegear.mesh_law.force_table import LOOKS, ForceTable
from facegear.mesh_law.load_dependent import load_dependent_law

PARTS = 2
"""Pieces that one piece becomes behind a spring: cubics are no longer exact, and finer ones are nearer."""
HALVINGS, NEWTON = 12, 5
"""Steps towards a root, by halving an interval and by Newton's method."""


def soften_table(table: ForceTable, compliance: float) -> ForceTable:
    """Return a force table with a spring in series.

    Levels are those of the mean force, each piece divided in PARTS, and the last level is that of the largest
    force, so that all of the table is inside. Forces and slopes there hold at every phase, but for harmonics
    above the table's own.

    Parameters
    ----------
    table : ForceTable
        Force table.
    compliance : float
        Compliance of the spring, m/N.

    Returns
    -------
    ForceTable
        The same table for a compliance of 0; levels in m, forces in N.
    """
    if compliance == 0.0:
        return table
    law, orders = load_dependent_law([table]), table.forces.shape[2]
    phases = np.arange(LOOKS * orders) / (LOOKS * orders)
    spacing = np.diff(table.levels)[:, None] / PARTS
    level_compressions = np.append(
        (table.levels[:-1, None] + spacing * np.arange(PARTS)).ravel(), table.levels[-1]
    )
    mean = law.mean().force(np.zeros(1), level_compressions[:, None, None])[:, 0, 0]
    levels = level_compressions + compliance * mean
    levels[-1] = (
        level_compressions[-1]
        + compliance * law.force(phases, np.full((phases.size, 1), level_compressions[-1])).max()
    )
    low = np.zeros((levels.size, phases.size))
    high = np.repeat(levels[:, None], phases.size, axis=1)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        short = middle + compliance * law.force(phases, middle[..., None])[..., 0] < levels[:, None]
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    compression = 0.5 * (low + high)
    for _ in range(NEWTON):
        residual = (
            levels[:, None] - compression - compliance * law.force(phases, compression[..., None])[..., 0]
        )
        slope = law.slope(phases, compression[..., None])[..., 0]
        compression = np.clip(compression + residual / (1.0 + compliance * np.maximum(slope, 0.0)), low, high)
    compression[0] = 0.0
    forces = law.force(phases, compression[..., None])[..., 0]
    # At the edge itself, where nothing is pressed in, a law counts no slope.
    slopes = law.slope(phases, np.maximum(compression, np.finfo(float).tiny)[..., None])[..., 0]
    return ForceTable(levels, _series(forces, orders), _series(slopes / (1.0 + compliance * slopes), orders))


def _series(values: Array, orders: int) -> Array:
    """Fourier series (A, 2, orders), sine part first, of values (A, K) at evenly spaced phases."""
    spectrum = np.fft.rfft(values, axis=1)[:, :orders] / values.shape[1]
    spectrum[:, 1:] *= 2.0
    return np.stack([-spectrum.imag, spectrum.real], axis=1)
