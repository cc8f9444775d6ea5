"""Thickness of the lubricant film, and the risk of micropitting and scuffing that follows."""

from math import pi

import numpy as np

from facegear.arrays import Array

Numbers = float | Array


def line_film(
    radius: Numbers,
    entrainment_speed: Numbers,
    line_load: Numbers,
    viscosity: Numbers,
    pressure_coefficient: Numbers,
    reduced_modulus: float,
) -> Array:
    """Compute the smallest film of a line contact: Dowson and Higginson 1966, 2.65 R U^0.7 G^0.54 W^-0.13.

    U = eta u/(E_r R), G = alpha E_r and W = w/(E_r R). All but the modulus are numbers or arrays of one
    shape.

    Parameters
    ----------
    radius : Numbers
        Relative radius of curvature R, m.
    entrainment_speed : Numbers
        u = (u1 + u2)/2 across the line, m/s.
    line_load : Numbers
        Load over length w, N/m.
    viscosity : Numbers
        Dynamic viscosity eta at the bulk temperature, Pa s.
    pressure_coefficient : Numbers
        Pressure coefficient alpha of the viscosity, 1/Pa.
    reduced_modulus : float
        E_r = 2 E*, Pa.

    Returns
    -------
    (...) array
        Film thickness, m.
    """
    radius = np.asarray(radius, float)
    speed = np.asarray(viscosity, float) * entrainment_speed / (reduced_modulus * radius)
    stiff = np.asarray(pressure_coefficient, float) * reduced_modulus
    load = np.asarray(line_load, float) / (reduced_modulus * radius)
    return 2.65 * radius * speed**0.7 * stiff**0.54 * load**-0.13


def elliptic_film(
    radius: Numbers,
    entrainment_speed: Numbers,
    force: Numbers,
    ellipticity: Numbers,
    viscosity: Numbers,
    pressure_coefficient: Numbers,
    reduced_modulus: float,
) -> Array:
    """Compute the smallest film of an elliptic contact rolled across its longer axis.

    Hamrock and Dowson 1977: 3.63 R U^0.68 G^0.49 W^-0.073 (1 - e^-0.68k) with U = eta u/(E_r R), G =
    alpha E_r and W = F/(E_r R^2). All but the modulus are numbers or arrays of one shape.

    Parameters
    ----------
    radius : Numbers
        Relative radius of curvature R, m.
    entrainment_speed : Numbers
        u = (u1 + u2)/2 across the line, m/s.
    force : Numbers
        Force F of the contact, N.
    ellipticity : Numbers
        Axis along the line over that across it, k, dimensionless.
    viscosity : Numbers
        Dynamic viscosity eta at the bulk temperature, Pa s.
    pressure_coefficient : Numbers
        Pressure coefficient alpha of the viscosity, 1/Pa.
    reduced_modulus : float
        E_r = 2 E*, Pa.

    Returns
    -------
    (...) array
        Film thickness, m.
    """
    radius, k = np.asarray(radius, float), np.asarray(ellipticity, float)
    speed = np.asarray(viscosity, float) * entrainment_speed / (reduced_modulus * radius)
    stiff = np.asarray(pressure_coefficient, float) * reduced_modulus
    load = np.asarray(force, float) / (reduced_modulus * radius**2)
    return 3.63 * radius * speed**0.68 * stiff**0.49 * load**-0.073 * (1 - np.exp(-0.68 * k))


def shear_heating(
    pressure: Numbers,
    u1: Numbers,
    u2: Numbers,
    viscosity: Numbers,
    thinning: Numbers,
    conductivity: Numbers,
    reduced_modulus: float,
) -> Array:
    """Compute the factor by which heating by shear in the inlet reduces the film (Gupta et al. 1992).

    `(1 - 13.2 p/E_r L^0.42)/(1 + 0.213 (1 + 2.23 |SR|^0.83) L^0.64)` with L = eta beta u_e^2/k. All but the
    modulus are numbers or arrays of one shape.

    Parameters
    ----------
    pressure : Numbers
        Largest pressure p, Pa.
    u1 : Numbers
        Rolling velocity of the first flank, m/s.
    u2 : Numbers
        Rolling velocity of the second flank, m/s.
    viscosity : Numbers
        Dynamic viscosity eta at the bulk temperature, Pa s.
    thinning : Numbers
        beta = -d ln nu/dT, 1/K.
    conductivity : Numbers
        Thermal conductivity k of the oil in W/m/K.
    reduced_modulus : float
        E_r = 2 E*, Pa.

    Returns
    -------
    (...) array
        Factor on the film thickness, dimensionless.
    """
    speed = 0.5 * np.abs(np.asarray(u1, float) + u2)
    slide = np.abs(np.asarray(u1, float) - u2) / speed
    loading = np.asarray(viscosity, float) * thinning * speed**2 / conductivity
    numerator = 1 - 13.2 * np.asarray(pressure, float) / reduced_modulus * loading**0.42
    return numerator / (1 + 0.213 * (1 + 2.23 * slide**0.83) * loading**0.64)


def local_film(
    radius: Numbers,
    sum_velocity: Numbers,
    pressure: Numbers,
    viscosity: Numbers,
    pressure_coefficient: Numbers,
    sliding_factor: Numbers,
    reduced_modulus: float,
) -> Array:
    """Compute the local film h of the micropitting rating (ISO/TS 6336-22).

    h = 1600 rho G^0.6 U^0.7 W^-0.13 S_GF^0.22 with rho in mm and h in um, G = alpha E_r, U = eta v_S/(2
    E_r rho), W = 2 pi p^2/E_r^2, E_r = 2 E*. All but the modulus are numbers or arrays of one shape. Its
    ratio to the mean Ra is the specific film lambda_GF.

    Parameters
    ----------
    radius : Numbers
        Relative radius of curvature rho, m.
    sum_velocity : Numbers
        v_S = u1 + u2, m/s.
    pressure : Numbers
        Largest pressure p, Pa.
    viscosity : Numbers
        Dynamic viscosity eta at the bulk temperature, Pa s.
    pressure_coefficient : Numbers
        Pressure coefficient alpha at the bulk temperature, 1/Pa.
    sliding_factor : Numbers
        S_GF of `sliding_factor`, dimensionless.
    reduced_modulus : float
        E_r = 2 E*, Pa.

    Returns
    -------
    (...) array
        Film thickness h, m.
    """
    radius = np.asarray(radius, float)
    stiff = np.asarray(pressure_coefficient, float) * reduced_modulus
    speed = np.asarray(viscosity, float) * sum_velocity / (2 * reduced_modulus * radius)
    load = 2 * pi * (np.asarray(pressure, float) / reduced_modulus) ** 2
    return (
        1600e-3 * radius * stiff**0.6 * speed**0.7 * load**-0.13 * np.asarray(sliding_factor, float) ** 0.22
    )


def sliding_factor(contact: tuple[Numbers, Numbers], bulk: tuple[Numbers, Numbers]) -> Array:
    """Compute S_GF: alpha eta at the contact temperature over alpha eta at the bulk temperature.

    Parameters
    ----------
    contact : tuple[Numbers, Numbers]
        Viscosity eta, Pa s, and pressure coefficient alpha, 1/Pa, at the contact temperature.
    bulk : tuple[Numbers, Numbers]
        Viscosity eta, Pa s, and pressure coefficient alpha, 1/Pa, at the bulk temperature.

    Returns
    -------
    (...) array
        S_GF, dimensionless.
    """
    return np.asarray(contact[0], float) * contact[1] / (np.asarray(bulk[0], float) * bulk[1])


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
        Factor X_L of `facegear.lubrication.friction_formulas.iso_6336_20`, the power of the viscosity in it,
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
    """Compute the integral temperature (ISO/TS 6336-21): theta_M + MEAN_WEIGHT (1.5) times the mean flash.

    Parameters
    ----------
    bulk : Numbers
        Bulk temperature theta_M, degrees C.
    mean_flash : Numbers
        Mean flash temperature along the path of contact, K.

    Returns
    -------
    (...) array
        Temperature, degrees C.
    """
    return np.asarray(bulk, float) + MEAN_WEIGHT * np.asarray(mean_flash, float)


def temperature_safety(limit: float, oil: float, numbers: Numbers) -> Array:
    """Compute the safety against scuffing, (limit - oil) / (temperature - oil), above 1 if the limit is
    met.

    Parameters
    ----------
    limit : float
        Allowed temperature, degrees C.
    oil : float
        Temperature of the oil as supplied, degrees C.
    numbers : Numbers
        Contact or integral temperatures of any shape, degrees C.

    Returns
    -------
    (...) array
        Safety, a ratio; infinite where a temperature is not above the oil's, nan if the limit is.
    """
    rise = np.asarray(numbers, float) - oil
    return np.where(rise > 0, (limit - oil) / np.where(rise > 0, rise, 1.0), np.inf)
