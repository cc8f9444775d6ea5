"""Thickness of the lubricant film between the flanks; E_r = 2 E* and viscosity at the bulk temperature."""

import numpy as np

from facegear.arrays import Array

Numbers = float | Array


def line_film(
    radius: Numbers,
    entrained: Numbers,
    line_load: Numbers,
    viscosity: Numbers,
    pressure_coefficient: Numbers,
    reduced_modulus: float,
) -> Array:
    """Smallest film (m) of a line contact: Dowson and Higginson 1966, 2.65 R U^0.7 G^0.54 W^-0.13.

    radius m, entrained (u1 + u2)/2 across the line m/s, line_load N/m, viscosity Pa s, coefficient 1/Pa,
    reduced_modulus E_r Pa.
    """
    radius = np.asarray(radius, float)
    speed = np.asarray(viscosity, float) * entrained / (reduced_modulus * radius)
    stiff = np.asarray(pressure_coefficient, float) * reduced_modulus
    load = np.asarray(line_load, float) / (reduced_modulus * radius)
    return 2.65 * radius * speed**0.7 * stiff**0.54 * load**-0.13


def elliptic_film(
    radius: Numbers,
    entrained: Numbers,
    force: Numbers,
    ellipticity: Numbers,
    viscosity: Numbers,
    pressure_coefficient: Numbers,
    reduced_modulus: float,
) -> Array:
    """Smallest film (m) of an elliptic contact rolled across its longer axis.

    Hamrock and Dowson 1977: 3.63 R U^0.68 G^0.49 W^-0.073 (1 - e^-0.68k). force N, ellipticity k: the axis
    along the line over that across it.
    """
    radius, k = np.asarray(radius, float), np.asarray(ellipticity, float)
    speed = np.asarray(viscosity, float) * entrained / (reduced_modulus * radius)
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
    """What heating by shear in the inlet leaves of the film (Gupta et al. 1992).

    `(1 - 13.2 p/E_r L^0.42)/(1 + 0.213 (1 + 2.23 |SR|^0.83) L^0.64)` with L = eta beta u_e^2/k; p the largest
    pressure Pa, beta = -d ln nu/dT 1/K, k of the oil W/(m K).
    """
    speed = 0.5 * (np.asarray(u1, float) + u2)
    slide = np.abs(np.asarray(u1, float) - u2) / speed
    loading = np.asarray(viscosity, float) * thinning * speed**2 / conductivity
    kept = 1 - 13.2 * np.asarray(pressure, float) / reduced_modulus * loading**0.42
    return kept / (1 + 0.213 * (1 + 2.23 * slide**0.83) * loading**0.64)
