"""How the body below the teeth gives way: its compliance order by order, and between flanks."""

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicSpline

from facegear.arrays import Array
from facegear.gear_body.factor import Solve
from facegear.gear_body.matrices import BodyMatrices
from facegear.gear_body.modes import OrderModes


def mean_compliance(body: BodyMatrices, solve: Solve) -> Array:
    """Means <W>, <V>, <W / r> by unit loads on them, (3, 3), hub held; `solve` is that of `held_solver`
    for an order.
    """
    means = np.stack(body.on_teeth)
    return np.asarray(means @ solve(means.T))


def slope_compliance(body: BodyMatrices, solve: Solve) -> Array:
    """<W>, <V>, <W / r> and the slope dW/dr by a unit moment on that slope, (1, 4), hub held."""
    slope = body.slope_on_teeth
    displacements = solve(slope)
    return np.array([[*(mean @ displacements for mean in body.on_teeth), slope @ displacements]])


def modal_compliance(modes: OrderModes) -> Array:
    """The part (3, 3) of `mean_compliance` that modes hold."""
    return np.asarray((modes.teeth / (2.0 * np.pi * modes.frequencies) ** 2) @ modes.teeth.T)


def over_orders(computed_orders: Sequence[int], values: Array, last: int) -> Array:
    """Compliances (orders, i, j) of all orders from 0 to `last` from those (n, i, j) computed of some.

    They change smoothly with the order beyond the first few: cubic splines of n times the compliance.
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
    """Axial and tangential part (2,) of a unit flank force on the upper gear."""
    tangential = np.cos(pressure_angle)
    return np.array([-np.sin(pressure_angle), -tangential if back else tangential])


def influence(compliances: Array, angle: float, first: Array, second: Array) -> float:
    """Motion (m/N) against its own force at one flank by a unit force at another, hub held.

    compliances (orders, 2, 2) from order 0; angle: of the first flank past the second, rad; first, second:
    directions of their forces. A = sum_n Re[e^(-i n psi) a1* H_n a2], a = (P_axial, -i P_round).
    """
    orders = np.arange(len(compliances))
    a1, a2 = (np.array([axial, -1j * tangential]) for axial, tangential in (first, second))
    terms = np.einsum("i,nij,j->n", a1.conj(), compliances, a2)
    return float(np.real(np.exp(-1j * orders * angle) * terms).sum())
