"""Influence factors of ISO 6336-2:2006 and ISO 6336-3:2006 that a spur gear's rating needs."""

from math import pi, sqrt

STRESS_CORRECTION_REFERENCE = 2.0
"""Y_ST: stress correction of the reference gear for which the bending limits hold."""
REFERENCE_NOTCH = 2.5
"""q_sT of the reference gear."""
GRADIENT = 0.2
"""chi*_p (1/mm): relative stress gradient of a smooth, unnotched specimen."""


def elasticity_factor(first: tuple[float, float], second: tuple[float, float]) -> float:
    """Z_E in sqrt(Pa), from (Young's modulus in Pa, Poisson's ratio) of both bodies."""
    soft = sum((1.0 - nu**2) / young for young, nu in (first, second))
    return sqrt(1.0 / (pi * soft))


def contact_ratio_factor(contact_ratio: float) -> float:
    """Z_epsilon of spur gears."""
    return sqrt((4.0 - contact_ratio) / 3.0)


def relative_notch_sensitivity(slip_layer: float, notch_parameter: float) -> float:
    """Y_delta rel T from the slip layer's thickness (m) and q_s, for the endurance limit."""
    thickness = 1e3 * slip_layer
    own, reference = (
        1.0 + sqrt(thickness * GRADIENT * (1.0 + 2.0 * q)) for q in (notch_parameter, REFERENCE_NOTCH)
    )
    return own / reference


def relative_surface_factor(roughness: float) -> float:
    """Y_R rel T of through-hardened and case-carburised steel, from the roughness Rz (m)."""
    rz = 1e6 * roughness
    return 1.12 if rz < 1.0 else 1.674 - 0.529 * (rz + 1.0) ** 0.1


def size_factor(module: float) -> float:
    """Y_X of case-carburised steel for the bending limit, from the normal module (m)."""
    return min(1.0, max(0.8, 1.05 - 10.0 * module))


def mean_stress_factor(ratio: float, mean_stress: float) -> float:
    """Y_M: what the endurance limit falls to where the stress swings down to `ratio` times its maximum.

    `mean_stress` is the mean stress ratio M of the material; ratio 0 gives 1 (ISO 6336-3, annex B).
    """
    slope = (1.0 - mean_stress) / (1.0 + mean_stress)
    return 1.0 / (1.0 - ratio * slope)
