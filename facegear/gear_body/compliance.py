"""Compliance of the body below the teeth, order by order, and between flanks."""

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicSpline

from facegear.arrays import Array
from facegear.gear_body.factor import Solve
from facegear.gear_body.matrices import BodyMatrices
from facegear.gear_body.modes import OrderModes


def mean_compliance(body: BodyMatrices, solve: Solve) -> Array:
    """Return the means <W>, <V>, <W / r> by unit loads on them, hub held.

    Parameters
    ----------
    body : BodyMatrices
        Matrices of the body.
    solve : Solve
        Function of `held_solver` for an order.

    Returns
    -------
    (3, 3) array
        m/N for <W> and <V>; each W / r divides by m.
    """
    means = np.stack(body.on_teeth)
    return np.asarray(means @ solve(means.T))


def slope_compliance(body: BodyMatrices, solve: Solve) -> Array:
    """Return <W>, <V>, <W / r> and the slope dW/dr by a unit moment on that slope, hub held.

    Parameters
    ----------
    body : BodyMatrices
        Matrices of the body.
    solve : Solve
        Function of `held_solver` for an order.

    Returns
    -------
    (1, 4) array
        1/N and rad/(N m).
    """
    slope = body.slope_on_teeth
    displacements = solve(slope)
    return np.array([[*(mean @ displacements for mean in body.on_teeth), slope @ displacements]])


def modal_compliance(modes: OrderModes) -> Array:
    """Return the part of `mean_compliance` that modes hold.

    Parameters
    ----------
    modes : OrderModes
        The modes of one order.

    Returns
    -------
    (3, 3) array
        m/N for <W> and <V>; each W / r divides by m.
    """
    return np.asarray((modes.teeth / (2.0 * np.pi * modes.frequencies) ** 2) @ modes.teeth.T)


def over_orders(computed_orders: Sequence[int], values: Array, last: int) -> Array:
    """Interpolate the compliances of all orders from those of some orders.

    They change smoothly with the order beyond the first few: cubic splines of n times the compliance.

    Parameters
    ----------
    computed_orders : Sequence of int
        The n orders, ascending from 0.
    values : (n, i, j) array
        Their compliances, m/N or any unit.
    last : int
        Last order.

    Returns
    -------
    (last + 1, i, j) array
        In the same unit.
    """
    orders = np.array(computed_orders)
    result = np.empty((last + 1, *values.shape[1:]))
    all_orders = np.arange(last + 1)
    scale = np.maximum(orders, 1)[:, None, None]
    smooth = CubicSpline(orders[1:], (scale * values)[1:])
    result[1:] = smooth(all_orders[1:]) / all_orders[1:, None, None]
    result[0] = values[0]
    return result


def flank_direction(pressure_angle: float, back: bool = False) -> Array:
    """Return axial and tangential part of a unit flank force on the upper gear.

    Parameters
    ----------
    pressure_angle : float
        Pressure angle, rad.
    back : bool
        Whether it acts on the back flank.

    Returns
    -------
    (2,) array
        N for 1 N.
    """
    tangential = np.cos(pressure_angle)
    return np.array([-np.sin(pressure_angle), -tangential if back else tangential])


def influence(compliances: Array, angle: float, first: Array, second: Array) -> float:
    """Return the motion against its own force at one flank by a unit force at another, hub held.

    A = sum_n Re[e^(-i n psi) a1* H_n a2], a = (P_axial, -i P_round).

    Parameters
    ----------
    compliances : (orders, 2, 2) array
        H_n from order 0, m/N.
    angle : float
        Angle of the first flank past the second, rad.
    first : (2,) array
        Axial and tangential part of a unit force on the first flank, dimensionless.
    second : (2,) array
        The parts of a unit force on the second flank, dimensionless.

    Returns
    -------
    float
        m/N.
    """
    orders = np.arange(len(compliances))
    a1, a2 = (np.array([axial, -1j * tangential]) for axial, tangential in (first, second))
    terms = np.einsum("i,nij,j->n", a1.conj(), compliances, a2)
    return float(np.real(np.exp(-1j * orders * angle) * terms).sum())
