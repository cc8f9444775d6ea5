"""Thickness of the lubricant film between the flanks; E_r = 2 E* and viscosity at the bulk temperature."""

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

    All but the modulus are numbers or arrays of one shape.

    Parameters
    ----------
    radius : Numbers
        Relative radius of curvature R, m.
    entrainment_speed : Numbers
        (u1 + u2)/2 across the line, m/s.
    line_load : Numbers
        Load over length, N/m.
    viscosity : Numbers
        Dynamic viscosity at the bulk temperature, Pa s.
    pressure_coefficient : Numbers
        Pressure coefficient of the viscosity, 1/Pa.
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

    Hamrock and Dowson 1977: 3.63 R U^0.68 G^0.49 W^-0.073 (1 - e^-0.68k). All but the modulus are numbers or
    arrays of one shape.

    Parameters
    ----------
    radius : Numbers
        Relative radius of curvature R, m.
    entrainment_speed : Numbers
        (u1 + u2)/2 across the line, m/s.
    force : Numbers
        Force of the contact, N.
    ellipticity : Numbers
        Axis along the line over that across it, k, dimensionless.
    viscosity : Numbers
        Dynamic viscosity at the bulk temperature, Pa s.
    pressure_coefficient : Numbers
        Pressure coefficient of the viscosity, 1/Pa.
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
    speed = 0.5 * (np.asarray(u1, float) + u2)
    slide = np.abs(np.asarray(u1, float) - u2) / speed
    loading = np.asarray(viscosity, float) * thinning * speed**2 / conductivity
    numerator = 1 - 13.2 * np.asarray(pressure, float) / reduced_modulus * loading**0.42
    return numerator / (1 + 0.213 * (1 + 2.23 * slide**0.83) * loading**0.64)
