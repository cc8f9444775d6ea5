"""Contact of two half spaces on a grid fine in both directions: an independent answer for flank pressure.

Pressure is constant in each cell of a grid whose columns are planes across the pinion's axis. Displacements
are those of a half space under a loaded rectangle (Johnson, Contact Mechanics, 3.25), convolved by FFT. The
load of every plane is given and its approach is free: the contact that carries a known line load, with no
assumption about the strip. Solved by the conjugate gradients of Polonsky and Keer (1999), plane by plane.
"""

from dataclasses import dataclass

import numpy as np
from scipy.fft import irfft2, next_fast_len, rfft2

from facegear.arrays import Array, ComplexArray, Mask
from facegear.errors import NotConverged

STEPS = 3000
"""Largest number of conjugate gradient steps."""

TOLERANCE = 1e-8
"""Change of the pressures in a step, relative to all, at which they count as found."""


@dataclass(frozen=True, eq=False)
class HalfSpace:
    """Two bodies on a grid of `shape` cells; `kernel`: the influence of one cell, transformed on `fft_shape`
    cells.
    """

    shape: tuple[int, int]
    fft_shape: tuple[int, int]
    kernel: ComplexArray

    def displacement(self, pressure: Array) -> Array:
        """Return the displacement into both bodies together.

        Parameters
        ----------
        pressure : (n, m) array
            Pressures of the cells, Pa.

        Returns
        -------
        (n, m) array
            Displacement, m.
        """
        displacement = irfft2(rfft2(pressure, self.fft_shape) * self.kernel, self.fft_shape)
        return displacement[: self.shape[0], : self.shape[1]]


def half_space(shape: tuple[int, int], size: tuple[float, float], modulus: float) -> HalfSpace:
    """Transform the influence of a cell.

    Parameters
    ----------
    shape : tuple[int, int]
        Number of cells across the profile and along the axis.
    size : tuple[float, float]
        Size of a cell across the profile and along the axis, m.
    modulus : float
        E*, Pa.

    Returns
    -------
    HalfSpace
        Two bodies on the grid.
    """
    fft_shape = next_fast_len(2 * shape[0]), next_fast_len(2 * shape[1])
    ways = (np.fft.fftfreq(count, 1 / count) * step for count, step in zip(fft_shape, size, strict=True))
    x, y = np.meshgrid(*ways, indexing="ij")
    left, right = x - size[0] / 2, x + size[0] / 2
    low, high = y - size[1] / 2, y + size[1] / 2

    def part(coordinate: Array, first: Array, second: Array) -> Array:
        return coordinate * np.log(
            (first + np.hypot(first, coordinate)) / (second + np.hypot(second, coordinate))
        )

    influence = (
        part(right, high, low) + part(high, right, left) + part(left, low, high) + part(low, left, right)
    )
    return HalfSpace(shape, fft_shape, rfft2(influence / (np.pi * modulus)))


def pressures(bodies: HalfSpace, gap: Array, load: Array) -> Array:
    """Solve for the pressures that carry the load of each plane.

    Parameters
    ----------
    bodies : HalfSpace
        The bodies.
    gap : (n, m) array
        Gaps before loading, m.
    load : (m,) array
        Sum of the pressures of each plane, Pa.

    Returns
    -------
    (n, m) array
        Pressures, Pa.

    Raises
    ------
    NotConverged
        If STEPS are not enough.
    """
    is_loaded = np.where(gap <= np.quantile(gap, 0.1, axis=0), 1.0, 0.0)
    pressure = is_loaded * (load / is_loaded.sum(axis=0))
    way, last = np.zeros_like(gap), 1.0
    restart = True
    for _ in range(STEPS):
        rest = _from_mean(gap + bodies.displacement(pressure), pressure > 0)
        on = pressure > 0
        size = float(np.sum(rest[on] ** 2))
        way = np.where(on, rest + (0.0 if restart else size / last) * way, 0.0)
        response = _from_mean(bodies.displacement(way), on)
        step = float(np.sum(rest[on] * way[on]) / np.sum(response[on] * way[on]))
        before, last = pressure, size
        pressure = np.where(on, np.maximum(pressure - step * way, 0.0), 0.0)
        entering = ~(pressure > 0) & (rest < 0)
        restart = bool(entering.any())
        pressure = np.where(entering, pressure - step * rest, pressure)
        pressure = pressure * (load / pressure.sum(axis=0))
        if np.abs(pressure - before).sum() < TOLERANCE * load.sum():
            return pressure
    raise NotConverged("half spaces", f"{gap.shape} cells", f"{STEPS} conjugate gradient steps")


def _from_mean(values: Array, on: Mask) -> Array:
    """Less the mean of each plane's cells in contact: the approach of a plane is free."""
    return values - np.sum(np.where(on, values, 0.0), axis=0) / np.maximum(on.sum(axis=0), 1)
