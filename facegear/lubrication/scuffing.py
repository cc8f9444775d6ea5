"""Scuffing: temperature of the contact against the temperature that a test of the oil allows."""

import numpy as np

from facegear.arrays import Array

Numbers = float | Array

MEAN_WEIGHT = 1.5
"""C2 of the integral temperature (ISO/TS 6336-21)."""


def allowed_flash_temperature(fzg_stage: float, structure_factor: float, lubricant_factor: float) -> float:
    """80 + (0.85 + 1.4 X_W) X_L S_FZG^2, degrees C (ISO/TS 6336-20): of the contact temperature.

    lubricant_factor: X_L of `facegear.lubrication.friction.iso_6336_20`, the power of the viscosity in it.
    """
    return 80.0 + (0.85 + 1.4 * structure_factor) * lubricant_factor * fzg_stage**2


def allowed_integral_temperature(
    fzg_stage: float, structure_factor: float, lubricant_factor: float, viscosity_at_40: float
) -> float:
    """80 + 0.23 q X_L + 0.3 X_W q (100/nu40)^0.02 X_L, q = 3.726 S_FZG^2, degrees C (ISO/TS 6336-21).

    viscosity_at_40: kinematic, m2/s.
    """
    heat = 3.726 * fzg_stage**2 * lubricant_factor
    return 80.0 + 0.23 * heat + 0.3 * structure_factor * heat * (1e-4 / viscosity_at_40) ** 0.02


def integral_temperature(bulk: Numbers, mean_flash: Numbers) -> Array:
    """theta_M + 1.5 times the mean flash along the path, degrees C."""
    return np.asarray(bulk, float) + MEAN_WEIGHT * np.asarray(mean_flash, float)


def temperature_safety(allowed: float, oil: float, numbers: Numbers) -> Array:
    """(allowed - oil) / (found - oil), temperatures in degrees C; infinite where nothing is heated."""
    rise = np.asarray(numbers, float) - oil
    return np.where(rise > 0, (allowed - oil) / np.where(rise > 0, rise, 1.0), np.inf)
