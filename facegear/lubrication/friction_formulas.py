"""Formulas of the friction coefficient, each with its source."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Mask

Numbers = float | Array


LARGEST_SPEED = 50.0
"""Largest pitch line velocity, m/s, of the same gear tests."""


SMALLEST_SLIDE = 1e-3
"""Sliding over u1 + u2 below which Benedict and Kelley's logarithm, infinite on the pitch line, is cut."""

XU = (-8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305)
"""Coefficients b1..b9 of Xu's regression (Xu 2005), one 75W-90 oil."""


@dataclass(frozen=True, eq=False)
class Rubbing:
    """Conditions in which flanks rub, at m points; all (m,) unless stated.

    `line_load` N/m, relative `radius` of curvature across the line m, largest `pressure` Pa, rolling
    velocities `u1` and `u2` across the line and the whole `sliding` velocity m/s. `pitch_speed` m/s;
    viscosity (Pa s) of the oil as supplied, `oil_viscosity`, and at the flanks' bulk temperature,
    `bulk_viscosity`; `film_ratio` lambda. The last two may have further axes in front, one bulk temperature
    each. `ra` the mean of both flanks' arithmetic roughness, `rq` the root of the sum of the squares of their
    root mean square roughness, m.
    """

    line_load: Array
    radius: Array
    pressure: Array
    u1: Array
    u2: Array
    sliding: Array
    pitch_speed: float
    oil_viscosity: float
    bulk_viscosity: Numbers
    film_ratio: Array
    ra: float
    rq: float

    @property
    def sum_velocity(self) -> Array:
        """Magnitude of the sum of the rolling velocities, v_S = abs(u1 + u2), m/s: beside a gear's root the
        gear may run backwards and faster than the pinion runs.
        """
        return np.abs(self.u1 + self.u2)


def schlenk(
    line_load: Numbers,
    sum_velocity: Numbers,
    radius: Numbers,
    viscosity: Numbers,
    ra: float,
    factor: float = 1.0,
) -> Array:
    """Compute 0.048 (w/(v_S rho))^0.2 eta^-0.05 Ra^0.25 X_L.

    All but roughness and factor are numbers or arrays of one shape.

    Parameters
    ----------
    line_load : Numbers
        Load over length w, N/m.
    sum_velocity : Numbers
        v_S = u1 + u2, m/s.
    radius : Numbers
        Relative radius of curvature rho, m.
    viscosity : Numbers
        Dynamic viscosity eta of the oil as supplied, Pa s.
    ra : float
        Mean Ra of both flanks, m.
    factor : float
        Lubricant factor X_L, dimensionless.

    Returns
    -------
    (...) array
        Friction coefficient, dimensionless.
    """
    rough = (1e6 * ra) ** 0.25
    return 0.048 * _load_term(line_load, sum_velocity, radius) * _viscosity_term(viscosity) * rough * factor


def iso_6336_22(
    line_load: Numbers,
    sum_velocity: Numbers,
    radius: Numbers,
    viscosity: Numbers,
    ra: float,
    factor: float = 1.0,
) -> Array:
    """Compute 0.045 (w K/(v_S rho))^0.2 eta^-0.05 X_R X_L, X_R = 2.2 (Ra/rho)^0.25 with Ra in um and rho
    in mm.

    All but roughness and factor are numbers or arrays of one shape.

    Parameters
    ----------
    line_load : Numbers
        Load over length times the load factors K, w K, N/m.
    sum_velocity : Numbers
        v_S = u1 + u2, m/s.
    radius : Numbers
        Relative radius of curvature rho, m.
    viscosity : Numbers
        Dynamic viscosity eta of the oil as supplied, Pa s.
    ra : float
        Mean Ra of both flanks, m.
    factor : float
        Lubricant factor X_L, dimensionless.

    Returns
    -------
    (...) array
        Friction coefficient, dimensionless.
    """
    rough = 2.2 * (1e3 * ra / np.asarray(radius, float)) ** 0.25
    return 0.045 * _load_term(line_load, sum_velocity, radius) * _viscosity_term(viscosity) * rough * factor


def iso_6336_20(
    line_load: Numbers,
    sum_velocity: Numbers,
    radius: Numbers,
    viscosity: Numbers,
    ra: float,
    factor: float = 1.0,
) -> Array:
    """Compute 0.060 (w_Bt/(v_S rho))^0.2 X_L Ra^0.25 with X_L = factor eta^-0.05.

    All but roughness and factor are numbers or arrays of one shape.

    Parameters
    ----------
    line_load : Numbers
        Load over length w_Bt, N/m.
    sum_velocity : Numbers
        v_S = u1 + u2, m/s.
    radius : Numbers
        Relative radius of curvature rho, m.
    viscosity : Numbers
        Dynamic viscosity eta of the oil as supplied, Pa s.
    ra : float
        Mean Ra of both flanks, m.
    factor : float
        Lubricant factor without the power of the viscosity, dimensionless.

    Returns
    -------
    (...) array
        Friction coefficient, dimensionless.
    """
    rough = (1e6 * ra) ** 0.25
    return 0.060 * _load_term(line_load, sum_velocity, radius) * _viscosity_term(viscosity) * rough * factor


def benedict_kelley(
    line_load: Numbers, sum_velocity: Numbers, sliding: Numbers, viscosity: Numbers, ra: float
) -> Array:
    """Compute 0.0127 min(3, 1.13/(1.13 - Ra)) log10(29 660 w/(eta v_s v_S^2)), not below 0.

    All but the roughness are numbers or arrays of one shape.

    Parameters
    ----------
    line_load : Numbers
        Load over length w, N/m.
    sum_velocity : Numbers
        v_S = u1 + u2, m/s.
    sliding : Numbers
        Sliding velocity v_s, m/s; at least SMALLEST_SLIDE times v_S is taken.
    viscosity : Numbers
        Dynamic viscosity eta at the bulk temperature, Pa s.
    ra : float
        Mean Ra of both flanks, m.

    Returns
    -------
    (...) array
        Friction coefficient, dimensionless.
    """
    left = 1.13 - 1e6 * ra
    rough = min(3.0, 1.13 / left) if left > 0 else 3.0
    sum_velocity = np.asarray(sum_velocity, float)
    slid = np.maximum(np.asarray(sliding, float), SMALLEST_SLIDE * sum_velocity)
    inside = (
        29660
        * 1e-3
        * np.asarray(line_load, float)
        / (1e3 * np.asarray(viscosity, float) * slid * sum_velocity**2)
    )
    return np.maximum(0.0127 * rough * np.log10(inside), 0.0)


def xu(pressure: Numbers, radius: Numbers, u1: Numbers, u2: Numbers, viscosity: Numbers, rq: float) -> Array:
    """Compute `e^f p^b2 |SR|^b3 u_e^b6 eta^b7 R^b8` (Xu 2005).

    `f = b1 + b4 A + b5 e^-A + b9 e^S`, `A = |SR| p log10 eta`; p GPa, u_e = (u1 + u2)/2, SR = (u1 - u2)/u_e,
    R m, S um. All but the roughness are numbers or arrays of one shape.

    Parameters
    ----------
    pressure : Numbers
        Largest pressure p, Pa.
    radius : Numbers
        Relative radius of curvature R, m.
    u1 : Numbers
        Rolling velocity of the first flank, m/s.
    u2 : Numbers
        Rolling velocity of the second flank, m/s.
    viscosity : Numbers
        Dynamic viscosity eta at the bulk temperature, Pa s.
    rq : float
        Composite roughness S, m.

    Returns
    -------
    (...) array
        Friction coefficient, dimensionless.
    """
    p, speed, thick = (
        1e-9 * np.asarray(pressure, float),
        0.5 * np.abs(np.asarray(u1, float) + u2),
        1e3 * np.asarray(viscosity, float),
    )
    slide = np.abs(np.asarray(u1, float) - u2) / speed
    b1, b2, b3, b4, b5, b6, b7, b8, b9 = XU
    heat = slide * p * np.log10(thick)
    power = b1 + b4 * heat + b5 * np.exp(-heat) + b9 * np.exp(1e6 * rq)
    return np.exp(power) * p**b2 * slide**b3 * speed**b6 * thick**b7 * np.asarray(radius, float) ** b8


def _load_term(line_load: Numbers, sum_velocity: Numbers, radius: Numbers) -> Array:
    """Return (w/(v_S rho))^0.2 with w in N/mm, v_S in m/s and rho in mm, from arguments in N/m, m/s and
    m.
    """
    return (
        1e-6 * np.asarray(line_load, float) / (np.asarray(sum_velocity, float) * np.asarray(radius, float))
    ) ** 0.2


def _viscosity_term(viscosity: Numbers) -> Array:
    """Return eta^-0.05 with eta in mPa s, from an argument in Pa s."""
    return (1e3 * np.asarray(viscosity, float)) ** -0.05


def _within_test_speed(at: Rubbing) -> Mask:
    """Return (m,) booleans, all equal: whether the pitch line velocity is at most LARGEST_SPEED (50 m/s)."""
    return np.full(at.line_load.shape, at.pitch_speed <= LARGEST_SPEED)


FORMULAS = {"schlenk": schlenk, "iso_6336_22": iso_6336_22, "iso_6336_20": iso_6336_20}
"""Mean coefficients from gear tests."""
