"""Influence factors of ISO 6336-2:2006 and ISO 6336-3:2006 that a spur gear's rating needs."""

from math import pi, sqrt

STRESS_CORRECTION_REFERENCE = 2.0
"""Y_ST: stress correction of the reference gear for which the bending limits hold."""
REFERENCE_NOTCH = 2.5
"""q_sT of the reference gear."""
GRADIENT = 0.2
"""chi*_p (1/mm): relative stress gradient of a smooth, unnotched specimen."""


def elasticity_factor(first: tuple[float, float], second: tuple[float, float]) -> float:
    """Return Z_E of two bodies.

    Parameters
    ----------
    first, second : tuple of float
        Young's modulus, Pa, and Poisson's ratio of each body.

    Returns
    -------
    float
        Z_E, Pa^0.5.
    """
    soft = sum((1.0 - nu**2) / young for young, nu in (first, second))
    return sqrt(1.0 / (pi * soft))


def contact_ratio_factor(contact_ratio: float) -> float:
    """Return Z_epsilon of spur gears.

    Parameters
    ----------
    contact_ratio : float
        Transverse contact ratio, dimensionless.

    Returns
    -------
    float
        Z_epsilon, dimensionless.
    """
    return sqrt((4.0 - contact_ratio) / 3.0)


def relative_notch_sensitivity(slip_layer: float, notch_parameter: float) -> float:
    """Return Y_delta rel T for the endurance limit.

    Parameters
    ----------
    slip_layer : float
        Thickness of the slip layer, m.
    notch_parameter : float
        Notch parameter q_s, dimensionless.

    Returns
    -------
    float
        Y_delta rel T, dimensionless.
    """
    thickness = 1e3 * slip_layer
    notch, reference = (
        1.0 + sqrt(thickness * GRADIENT * (1.0 + 2.0 * q)) for q in (notch_parameter, REFERENCE_NOTCH)
    )
    return notch / reference


def relative_surface_factor(roughness: float) -> float:
    """Return Y_R rel T of through-hardened and case-carburised steel.

    Parameters
    ----------
    roughness : float
        Roughness Rz, m.

    Returns
    -------
    float
        Y_R rel T, dimensionless.
    """
    rz = 1e6 * roughness
    return 1.12 if rz < 1.0 else 1.674 - 0.529 * (rz + 1.0) ** 0.1


def size_factor(module: float) -> float:
    """Return Y_X of case-carburised steel for the bending limit.

    Parameters
    ----------
    module : float
        Normal module, m.

    Returns
    -------
    float
        Y_X, dimensionless.
    """
    return min(1.0, max(0.8, 1.05 - 10.0 * module))


def mean_stress_factor(ratio: float, mean_stress: float) -> float:
    """Return Y_M, the factor on the endurance limit where the stress swings (ISO 6336-3, annex B).

    Parameters
    ----------
    ratio : float
        Smallest over largest stress of a turn, dimensionless; 0 gives 1.
    mean_stress : float
        Mean stress ratio M of the material, dimensionless.

    Returns
    -------
    float
        Y_M, dimensionless.
    """
    slope = (1.0 - mean_stress) / (1.0 + mean_stress)
    return 1.0 / (1.0 - ratio * slope)
