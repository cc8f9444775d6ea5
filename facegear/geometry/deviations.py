"""Deviations of a flank between the places of a grid: bicubic, the value at the edge outside it."""

from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.geometry.design import DeviationGrid

CUBIC = 3


def deviation(grid: DeviationGrid | None, face: ArrayLike, profile: ArrayLike) -> Array:
    """Compute the material added along the normal.

    The interpolation is of fourth order in the distance of the grid's places; fewer than four of them take
    a lower order.

    Parameters
    ----------
    grid : DeviationGrid, optional
        Deviations; None gives 0.
    face : (...) array_like
        Distance along the face, m, as in `DeviationGrid`.
    profile : (...) array_like
        Distance along the profile, m.

    Returns
    -------
    (...) array
        m.
    """
    along, across = np.broadcast_arrays(np.asarray(face, float), np.asarray(profile, float))
    if grid is None:
        return np.zeros(along.shape)
    inside = (np.clip(part, *_ends(line)) for part, line in ((along, grid.face), (across, grid.profile)))
    values: Array = _spline(grid).ev(*inside)
    return values


def derivative(
    grid: DeviationGrid | None, face: ArrayLike, profile: ArrayLike, orders: tuple[int, int]
) -> Array:
    """Compute a derivative of `deviation`; 0 beyond an edge, where the value is constant.

    Parameters
    ----------
    grid : DeviationGrid, optional
        Deviations; None gives 0.
    face : (...) array_like
        Distance along the face, m, as in `DeviationGrid`.
    profile : (...) array_like
        Distance along the profile, m.
    orders : tuple[int, int]
        Orders of the derivative along face and profile.

    Returns
    -------
    (...) array
        m over m to the sum of the orders.
    """
    along, across = np.broadcast_arrays(np.asarray(face, float), np.asarray(profile, float))
    if grid is None:
        return np.zeros(along.shape)
    values: Array = np.zeros(along.shape)
    coordinates = (along, grid.face, orders[0]), (across, grid.profile, orders[1])
    on = np.ones(along.shape, bool)
    for at, line, order in coordinates:
        first, last = _ends(line)
        on &= (at >= first) & (at <= last) | (order == 0)
    inside = (np.clip(at[on], *_ends(line)) for at, line, _ in coordinates)
    values[on] = _spline(grid).ev(*inside, dx=orders[0], dy=orders[1])
    return values


def mean_crowning(grid: DeviationGrid | None) -> float:
    """Compute the curvature along the face of the parabola nearest to a grid's mean.

    Parameters
    ----------
    grid : DeviationGrid, optional
        Deviations; None gives 0.

    Returns
    -------
    float
        1/m; 0 where the flank is hollow.
    """
    if grid is None or len(grid.face) <= 2:
        return 0.0
    middle = np.array(grid.face) - np.mean(grid.face)
    curvature: float = np.polynomial.polynomial.polyfit(middle, np.mean(grid.deviation, axis=1), 2)[2]
    return max(-2.0 * curvature, 0.0)


def _ends(line: tuple[float, ...]) -> tuple[float, float]:
    return line[0], line[-1]


@lru_cache(maxsize=512)
def _spline(grid: DeviationGrid) -> "scipy.interpolate.RectBivariateSpline":
    lines = [np.array(line) for line in (grid.face, grid.profile)]
    orders = [min(CUBIC, line.size - 1) for line in lines]
    values = np.array(grid.deviation)
    if min(orders) < CUBIC:
        # the polynomial through two or three places, at as many as a cubic takes
        few = [np.linspace(line[0], line[-1], CUBIC + 1) for line in lines]
        dense_lines = [line if line.size > CUBIC else even for line, even in zip(lines, few, strict=True)]
        values = scipy.interpolate.RectBivariateSpline(*lines, values, kx=orders[0], ky=orders[1])(
            *dense_lines
        )
        lines = dense_lines
    return scipy.interpolate.RectBivariateSpline(*lines, values)
