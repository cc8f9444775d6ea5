"""Compute the face gear's surfaces in closed form, for single numbers as for arrays.

The kernels of rays hold the same formulas in C++: `facegear/_kernels/src/flanks/closed_forms.hpp`.
Symbols as in `face_gear`; base is the shaper's base radius (m), ratio its tooth number over the gear's, space
its half space angle (rad), lift the distance (m) of the axes' planes. Right side of tooth 0, m and rad.
"""

from typing import Any

import numpy as np

Numbers = Any
"""A single number, or an array of them."""


def flank_frame(
    base: float, ratio: float, space: float, lift: float, roll: Numbers, psi: Numbers
) -> tuple[Numbers, ...]:
    """Compute the point of the flank and its derivatives.

    Parameters
    ----------
    base : float
        Base radius of the shaper, m.
    ratio : float
        Ratio m2s, dimensionless.
    space : float
        Half space angle of the shaper, rad.
    lift : float
        Distance of the axes' planes, m.
    roll : Numbers
        Roll angle th, rad.
    psi : Numbers
        Slope of the normal, rad.

    Returns
    -------
    tuple
        x, y, z (m), and their derivatives with respect to roll and to psi (m/rad).
    """
    turn = ratio * (psi - roll - space)
    ct, st, cp, sp = np.cos(turn), np.sin(turn), np.cos(psi), np.sin(psi)
    p, q = base * (sp - roll * cp), base / (ratio * cp)
    p_psi, q_psi = base * (cp + roll * sp), q * sp / cp
    x, y, z = p * ct - q * st, p * st + q * ct, lift - p_psi
    x_roll, y_roll, z_roll = ratio * y - base * ct * cp, -ratio * x - base * st * cp, -base * sp
    x_psi, y_psi = p_psi * ct - q_psi * st - ratio * y, p_psi * st + q_psi * ct + ratio * x
    return x, y, z, x_roll, y_roll, z_roll, x_psi, y_psi, p


def normal(turn: Numbers, psi: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Compute the outward unit normal of the generated flank at a point, from its slope and the gear's
    rotation.

    Parameters
    ----------
    turn : Numbers
        Rotation of the gear since it generated the point, rad.
    psi : Numbers
        Slope of the normal, rad.

    Returns
    -------
    tuple
        x, y, z, dimensionless.
    """
    return np.cos(psi) * np.cos(turn), np.cos(psi) * np.sin(turn), np.sin(psi)


def fillet_frame(
    centre: float, rounding: float, ratio: float, lift: float, edge_start: float, psi: Numbers, q: Numbers
) -> tuple[Numbers, ...]:
    """Compute the point of the fillet and its derivatives.

    Parameters
    ----------
    centre : float
        Distance of the centre of the shaper's tip rounding from its axis, m.
    rounding : float
        Radius of the rounding, m.
    ratio : float
        Ratio m2s, dimensionless.
    lift : float
        Distance of the axes' planes, m.
    edge_start : float
        Angle of that centre from the vertical at phi_s = 0, rad.
    psi : Numbers
        Slope of the normal, rad.
    q : Numbers
        Position along the pinion's axis at which the shaper generates the point, m.

    Returns
    -------
    tuple
        x, y, z (m), and their derivatives with respect to psi (m/rad) and to q (dimensionless); nan where
        no normal of slope psi through the centre meets the instant axis at q.
    """
    cp, sp = np.cos(psi), np.sin(psi)
    k = ratio * q / centre
    w = np.sqrt(1 - k * k * cp * cp)
    root_sum, rest = w + k * sp, 1 - k * k
    s_chi, c_chi = -cp * rest / root_sum, k * cp * cp + sp * w
    chi_psi, chi_q = rest / (root_sum * w), ratio * cp / (centre * w)
    turn = ratio * (np.arctan2(s_chi, c_chi) - edge_start)
    ct, st = np.cos(turn), np.sin(turn)
    p, z = centre * s_chi - rounding * cp, lift - centre * c_chi - rounding * sp
    p_psi, z_psi = centre * c_chi * chi_psi + rounding * sp, centre * s_chi * chi_psi - rounding * cp
    p_q, z_q = centre * c_chi * chi_q, centre * s_chi * chi_q
    x, y = p * ct - q * st, p * st + q * ct
    x_psi, y_psi = p_psi * ct - ratio * chi_psi * y, p_psi * st + ratio * chi_psi * x
    x_q, y_q = p_q * ct - st - ratio * chi_q * y, p_q * st + ct + ratio * chi_q * x
    return x, y, z, x_psi, y_psi, z_psi, x_q, y_q, z_q


def radius_at_roll(
    base: float, ratio: float, radius: Numbers, roll: Numbers, psi: Numbers
) -> tuple[Numbers, Numbers]:
    """Compute the square of the flank's radius at roll and psi less that of `radius`.

    Parameters
    ----------
    base : float
        Base radius of the shaper, m.
    ratio : float
        Ratio m2s, dimensionless.
    radius : Numbers
        Gear radius, m.
    roll : Numbers
        Roll angle th, rad.
    psi : Numbers
        Slope of the normal, rad.

    Returns
    -------
    tuple
        Difference, m2, and its derivative by psi, m2/rad.
    """
    p, q = base * (np.sin(psi) - roll * np.cos(psi)), base / (ratio * np.cos(psi))
    slope = 2 * p * base * (np.cos(psi) + roll * np.sin(psi)) + 2 * q * q * np.tan(psi)
    return p * p + q * q - radius * radius, slope


def radius_at_height(
    base: float, ratio: float, radius: Numbers, height: Numbers, psi: Numbers
) -> tuple[Numbers, Numbers]:
    """Compute the square of the flank's radius at a height and psi less that of `radius`.

    Parameters
    ----------
    base : float
        Base radius of the shaper, m.
    ratio : float
        Ratio m2s, dimensionless.
    radius : Numbers
        Gear radius, m.
    height : Numbers
        Height from the lift downwards over the base radius, dimensionless.
    psi : Numbers
        Slope of the normal, rad.

    Returns
    -------
    tuple
        Difference, m2, and its derivative by psi, m2/rad.
    """
    sine = np.sin(psi)
    p, q = base * (1 - height * np.cos(psi)) / sine, base / (ratio * np.cos(psi))
    p_psi = base * (height - np.cos(psi)) / (sine * sine)
    return p * p + q * q - radius * radius, 2 * p * p_psi + 2 * q * q * np.tan(psi)


def roll_at_height(height: Numbers, psi: Numbers) -> Numbers:
    """Compute the roll angle where the flank has a height.

    Parameters
    ----------
    height : Numbers
        Height from the lift downwards over the base radius, dimensionless.
    psi : Numbers
        Slope of the normal, rad.

    Returns
    -------
    Numbers
        Roll angle, rad.
    """
    return (height - np.cos(psi)) / np.sin(psi)
