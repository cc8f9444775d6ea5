"""Micropitting: the specific film of ISO/TS 6336-22, method A, with local values."""

from math import pi

import numpy as np

from facegear.arrays import Array

Numbers = float | Array


def local_film(
    radius: Numbers,
    sum_velocity: Numbers,
    pressure: Numbers,
    viscosity: Numbers,
    pressure_coefficient: Numbers,
    sliding_factor: Numbers,
    reduced_modulus: float,
) -> Array:
    """Compute h (m) = 1600 rho G^0.6 U^0.7 W^-0.13 S_GF^0.22 with rho in mm and h in um.

    G = alpha E_r, U = eta v_S/(2 E_r rho), W = 2 pi p^2/E_r^2, E_r = 2 E*. All but the modulus are numbers or
    arrays of one shape.

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
