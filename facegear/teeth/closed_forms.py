"""Compute the face gear's fillet in closed form, for single numbers as for arrays.

The kernels of rays hold the same formulas in C++: `facegear/_kernels/src/flanks/closed_forms.hpp`.
Symbols as in `face_gear`; base is the shaper's base radius (m), ratio its tooth number over the gear's, space
its half space angle (rad), lift the distance (m) of the axes' planes. Right side of tooth 0, m and rad.
"""

from typing import Any

import numpy as np

Numbers = Any
"""A single number, or an array of them."""


def normal(turn: Numbers, psi: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Compute the outward unit normal.

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
