"""The face gear's surfaces in closed form, for single numbers as for arrays.

Plain functions of numbers: `face_gear` takes them as they are on arrays, `rays` compiles them for rays.
Symbols as in `face_gear`; base is the shaper's base radius (m), ratio its tooth number over the gear's, space
its half space angle (rad), lift the distance (m) of the axes' planes. Right side of tooth 0, m and rad.
"""

import numpy as np


def flank_frame(base, ratio, space, lift, roll, psi):  # type: ignore[no-untyped-def]
    """Point x, y, z of the flank, and its derivatives with respect to roll and to psi."""
    turn = ratio * (psi - roll - space)
    ct, st, cp, sp = np.cos(turn), np.sin(turn), np.cos(psi), np.sin(psi)
    p, q = base * (sp - roll * cp), base / (ratio * cp)
    p_psi, q_psi = base * (cp + roll * sp), q * sp / cp
    x, y, z = p * ct - q * st, p * st + q * ct, lift - p_psi
    x_roll, y_roll, z_roll = ratio * y - base * ct * cp, -ratio * x - base * st * cp, -base * sp
    x_psi, y_psi = p_psi * ct - q_psi * st - ratio * y, p_psi * st + q_psi * ct + ratio * x
    return x, y, z, x_roll, y_roll, z_roll, x_psi, y_psi, p


def flank_normal(ratio, space, roll, psi):  # type: ignore[no-untyped-def]
    """Outward unit normal x, y, z of the flank."""
    turn = ratio * (psi - roll - space)
    return np.cos(psi) * np.cos(turn), np.cos(psi) * np.sin(turn), np.sin(psi)


def fillet_frame(tip_radius, ratio, lift, edge_start, chi, radius):  # type: ignore[no-untyped-def]
    """Point x, y, z of the fillet, and its derivatives with respect to chi and to the gear radius.

    The gear radius must exceed tip_radius sin chi.
    """
    edge = tip_radius * np.sin(chi)
    along = np.sqrt(radius * radius - edge * edge)
    beta = np.arctan2(edge, along) - ratio * (chi - edge_start)
    c, s = np.cos(beta), np.sin(beta)
    by_chi = radius * (tip_radius * np.cos(chi) / along - ratio)
    by_radius = -edge / along
    z = lift - tip_radius * np.cos(chi)
    x_chi, y_chi, x_radius, y_radius = c * by_chi, -s * by_chi, s + c * by_radius, c - s * by_radius
    return radius * s, radius * c, z, x_chi, y_chi, edge, x_radius, y_radius, 0.0 * edge


def radius_at_roll(base, ratio, radius, roll, psi):  # type: ignore[no-untyped-def]
    """Square of the flank's radius at roll and psi less that of `radius` (m2), and its slope by psi."""
    p, q = base * (np.sin(psi) - roll * np.cos(psi)), base / (ratio * np.cos(psi))
    slope = 2 * p * base * (np.cos(psi) + roll * np.sin(psi)) + 2 * q * q * np.tan(psi)
    return p * p + q * q - radius * radius, slope


def radius_at_height(base, ratio, radius, height, psi):  # type: ignore[no-untyped-def]
    """The same at a height, taken from the lift downwards and over the base radius."""
    p, q = base * (1 - height * np.cos(psi)) / np.sin(psi), base / (ratio * np.cos(psi))
    p_psi = base * (height - np.cos(psi)) / np.sin(psi) ** 2
    return p * p + q * q - radius * radius, 2 * p * p_psi + 2 * q * q * np.tan(psi)


def roll_at_height(height, psi):  # type: ignore[no-untyped-def]
    """Roll angle where the flank has a height, taken as in `radius_at_height`."""
    return (height - np.cos(psi)) / np.sin(psi)


def first_psi(base, ratio, radius):  # type: ignore[no-untyped-def]
    """psi where the contact path's pressure angle belongs to a gear radius: a start for Newton's method."""
    return np.arccos(base / (ratio * radius))
