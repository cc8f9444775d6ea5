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
    """Point x, y, z of the flank, and its derivatives with respect to roll and to psi."""
    turn = ratio * (psi - roll - space)
    ct, st, cp, sp = np.cos(turn), np.sin(turn), np.cos(psi), np.sin(psi)
    p, q = base * (sp - roll * cp), base / (ratio * cp)
    p_psi, q_psi = base * (cp + roll * sp), q * sp / cp
    x, y, z = p * ct - q * st, p * st + q * ct, lift - p_psi
    x_roll, y_roll, z_roll = ratio * y - base * ct * cp, -ratio * x - base * st * cp, -base * sp
    x_psi, y_psi = p_psi * ct - q_psi * st - ratio * y, p_psi * st + q_psi * ct + ratio * x
    return x, y, z, x_roll, y_roll, z_roll, x_psi, y_psi, p


def normal(turn: Numbers, psi: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Outward unit normal x, y, z of slope psi where the gear has turned by `turn` since it was generated."""
    return np.cos(psi) * np.cos(turn), np.cos(psi) * np.sin(turn), np.sin(psi)


def fillet_frame(
    centre: float, rounding: float, ratio: float, lift: float, edge_start: float, psi: Numbers, q: Numbers
) -> tuple[Numbers, ...]:
    """Point x, y, z of the fillet, and its derivatives with respect to psi and to q.

    centre: distance (m) of the centre of the shaper's tip rounding from its axis; edge_start: where that
    centre stands from the vertical at phi_s = 0; q: where it generates the point, along the pinion's axis.
    nan where no normal of slope psi through the centre meets the instant axis at q.
    """
    cp, sp = np.cos(psi), np.sin(psi)
    k = ratio * q / centre
    w = np.sqrt(1 - k * k * cp * cp)
    both, rest = w + k * sp, 1 - k * k
    s_chi, c_chi = -cp * rest / both, k * cp * cp + sp * w
    chi_psi, chi_q = rest / (both * w), ratio * cp / (centre * w)
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
    """Square of the flank's radius at roll and psi less that of `radius` (m2), and its slope by psi."""
    p, q = base * (np.sin(psi) - roll * np.cos(psi)), base / (ratio * np.cos(psi))
    slope = 2 * p * base * (np.cos(psi) + roll * np.sin(psi)) + 2 * q * q * np.tan(psi)
    return p * p + q * q - radius * radius, slope


def radius_at_height(
    base: float, ratio: float, radius: Numbers, height: Numbers, psi: Numbers
) -> tuple[Numbers, Numbers]:
    """The same at a height, taken from the lift downwards and over the base radius."""
    sine = np.sin(psi)
    p, q = base * (1 - height * np.cos(psi)) / sine, base / (ratio * np.cos(psi))
    p_psi = base * (height - np.cos(psi)) / (sine * sine)
    return p * p + q * q - radius * radius, 2 * p * p_psi + 2 * q * q * np.tan(psi)


def roll_at_height(height: Numbers, psi: Numbers) -> Numbers:
    """Roll angle where the flank has a height, taken as in `radius_at_height`."""
    return (height - np.cos(psi)) / np.sin(psi)
