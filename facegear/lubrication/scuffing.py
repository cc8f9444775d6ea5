"""Scuffing: temperature of the contact against the temperature that a test of the oil allows."""

import numpy as np

from facegear.arrays import Array

Numbers = float | Array

MEAN_WEIGHT = 1.5
"""C2 of the integral temperature (ISO/TS 6336-21)."""


def allowed_flash_temperature(fzg_stage: float, structure_factor: float, lubricant_factor: float) -> float:
    """Compute the allowed contact temperature 80 + (0.85 + 1.4 X_W) X_L S_FZG^2 (ISO/TS 6336-20).

    Parameters
    ----------
    fzg_stage : float
        FZG failure load stage S_FZG, dimensionless.
    structure_factor : float
        Factor X_W of the steel, dimensionless.
    lubricant_factor : float
        Factor X_L of `facegear.lubrication.friction.iso_6336_20`, the power of the viscosity in it,
        dimensionless.

    Returns
    -------
    float
        Temperature, degrees C.
    """
    return 80.0 + (0.85 + 1.4 * structure_factor) * lubricant_factor * fzg_stage**2


def allowed_integral_temperature(
    fzg_stage: float, structure_factor: float, lubricant_factor: float, viscosity_at_40: float
) -> float:
    """Compute the allowed integral temperature (ISO/TS 6336-21).

    80 + 0.23 q X_L + 0.3 X_W q (100/nu40)^0.02 X_L, q = 3.726 S_FZG^2.

    Parameters
    ----------
    fzg_stage : float
        FZG failure load stage S_FZG, dimensionless.
    structure_factor : float
        Factor X_W of the steel, dimensionless.
    lubricant_factor : float
        Factor X_L of the oil, dimensionless.
    viscosity_at_40 : float
        Kinematic viscosity at 40 C, m2/s.

    Returns
    -------
    float
        Temperature, degrees C.
    """
    heat = 3.726 * fzg_stage**2 * lubricant_factor
    return 80.0 + 0.23 * heat + 0.3 * structure_factor * heat * (1e-4 / viscosity_at_40) ** 0.02


def integral_temperature(bulk: Numbers, mean_flash: Numbers) -> Array:
    """Compute theta_M + 1.5 times the mean flash along the path.

    Parameters
    ----------
    bulk : Numbers
        Bulk temperature theta_M, degrees C.
    mean_flash : Numbers
        Mean flash temperature along the path, K.

    Returns
    -------
    (...) array
        Temperature, degrees C.
    """
    return np.asarray(bulk, float) + MEAN_WEIGHT * np.asarray(mean_flash, float)


def temperature_safety(limit: float, oil: float, numbers: Numbers) -> Array:
    """Compute the safety (limit - oil) / (temperature - oil).

    Parameters
    ----------
    limit : float
        Allowed temperature, degrees C.
    oil : float
        Temperature of the oil, degrees C.
    numbers : Numbers
        Temperatures of any shape, degrees C.

    Returns
    -------
    (...) array
        Safety, a ratio; infinite where nothing is heated.
    """
    rise = np.asarray(numbers, float) - oil
    return np.where(rise > 0, (limit - oil) / np.where(rise > 0, rise, 1.0), np.inf)
