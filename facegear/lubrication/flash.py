"""Flash temperature: rise of the flanks' temperature by friction while they touch.

Both flanks run the same way through the contact, so above a Peclet number of some 5 the temperatures of both
match at every point, and each takes a share of the heat as its B sqrt(u) says (Blok 1937). Where one of them
is slow its half space answers as Jaeger's integral says, and the largest temperatures of both match.
"""

from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar
from scipy.special import kve

from facegear.arrays import Array
from facegear.lubrication.request import FlankMaterial

Numbers = float | Array

HERTZ = 1.1115483781
"""C for heat spread as Hertz's pressure over the width; hottest 0.65223 b behind its middle."""

POINTS = 120
"""Number of Gauss points on each part of Jaeger's integral."""
SLOWEST, FASTEST = 1e-3, 1e3
"""Peclet numbers between which `slow_factor` is interpolated; it is constant below and 1 above."""


def flash(
    friction: Numbers,
    line_load: Numbers,
    sliding: Numbers,
    speeds: tuple[Numbers, Numbers],
    half_width: Numbers,
    coefficients: tuple[Numbers, Numbers],
) -> tuple[Array, Array]:
    """Compute the largest temperature rise of the contact and the first flank's share of the heat (Blok
    1937).

    `C mu w |v_s| / ((B1 sqrt u1 + B2 sqrt u2) sqrt(2b))` with C = HERTZ, for flanks that are fast (Peclet
    number above some 5). The share is B1 sqrt u1 / (B1 sqrt u1 + B2 sqrt u2). All are numbers or arrays
    of one shape.

    Parameters
    ----------
    friction : Numbers
        Friction coefficient mu, dimensionless.
    line_load : Numbers
        Load over length w, N/m.
    sliding : Numbers
        Magnitude of the sliding velocity abs(v_s), m/s; it is not made positive here.
    speeds : tuple[Numbers, Numbers]
        Rolling velocities u1 and u2 of both flanks across the line, m/s; their sign does not count.
    half_width : Numbers
        Half width b of the contact, m.
    coefficients : tuple[Numbers, Numbers]
        Thermal contact coefficients B1 and B2, W s^0.5/(m2 K).

    Returns
    -------
    two (...) arrays
        Temperature rise, K, and share of the heat, a fraction.
    """
    first, second = (
        np.asarray(coefficient, float) * np.sqrt(np.abs(speed))
        for coefficient, speed in zip(coefficients, speeds, strict=True)
    )
    heat = np.asarray(friction, float) * line_load * sliding
    rise = HERTZ * heat / ((first + second) * np.sqrt(2 * np.asarray(half_width, float)))
    return rise, first / (first + second)


def flash_at_any_speed(
    friction: Numbers,
    line_load: Numbers,
    sliding: Numbers,
    speeds: tuple[Numbers, Numbers],
    half_width: Numbers,
    flanks: tuple[FlankMaterial, FlankMaterial],
) -> tuple[Array, Array]:
    """Compute the flash temperature of flanks that may be slow.

    It is `flash` with each B divided by `slow_factor` at the flank's Peclet number, which comes from
    Jaeger's integral for heat spread as Hertz's pressure. All arguments but the last are those of
    `flash`.

    Parameters
    ----------
    friction : Numbers
        Friction coefficient mu, dimensionless.
    line_load : Numbers
        Load over length w, N/m.
    sliding : Numbers
        Magnitude of the sliding velocity abs(v_s), m/s.
    speeds : tuple[Numbers, Numbers]
        Rolling velocities u1 and u2 of both flanks across the line, m/s.
    half_width : Numbers
        Half width b of the contact, m.
    flanks : tuple[FlankMaterial, FlankMaterial]
        Materials of both flanks.

    Returns
    -------
    two (...) arrays
        Temperature rise, K, and the first flank's share of the heat, a fraction.
    """
    first, second = (
        flank.contact_coefficient / slow_factor(peclet(speed, half_width, flank))
        for flank, speed in zip(flanks, speeds, strict=True)
    )
    return flash(friction, line_load, sliding, speeds, half_width, (first, second))


def peclet(speed: Numbers, half_width: Numbers, flank: FlankMaterial) -> Array:
    """Compute the Peclet number u b / (2 kappa).

    Parameters
    ----------
    speed : Numbers
        Rolling velocity u, m/s.
    half_width : Numbers
        Half width b of the contact, m.
    flank : FlankMaterial
        Material of the flank, with its diffusivity kappa.

    Returns
    -------
    (...) array
        Peclet number, dimensionless.
    """
    return np.abs(np.asarray(speed, float)) * half_width / (2 * flank.diffusivity)


def slow_factor(number: Numbers) -> Array:
    """Compute by which factor (below 1) a slow half space heats up less than the limit for high Peclet
    numbers.

    It is `moving_heat` over HERTZ pi/(4 sqrt(Pe)), by a spline through 49 Peclet numbers in logarithms.

    Parameters
    ----------
    number : Numbers
        Peclet number, dimensionless; below SLOWEST (0.001) the factor at SLOWEST is returned.

    Returns
    -------
    (...) array
        Ratio, exactly 1 from a Peclet number of FASTEST (1000) on.
    """
    number = np.asarray(number, float)
    log_number = np.log(np.clip(number, SLOWEST, FASTEST))
    return np.where(number >= FASTEST, 1.0, np.exp(_slow_spline()(log_number)))


@cache
def _slow_spline() -> CubicSpline:
    """Build the spline of ln(slow_factor) over ln(Peclet number) between SLOWEST and FASTEST, once per
    process.
    """
    numbers = np.geomspace(SLOWEST, FASTEST, 49)
    # of q0 b/k: w v mu = pi/2 q0 b, B sqrt(u) sqrt(2b) = 2 k sqrt(Pe)
    high = HERTZ * np.pi / (4 * np.sqrt(numbers))
    return CubicSpline(np.log(numbers), np.log([moving_heat(at) for at in numbers] / high))


def moving_heat(number: float) -> float:
    """Compute the largest temperature under a moving strip of heat spread as Hertz's pressure (Jaeger
    1942).

    It is the maximum of `moving_temperature` over the width of the strip.

    Parameters
    ----------
    number : float
        Peclet number u b/(2 kappa), dimensionless.

    Returns
    -------
    float
        Temperature rise over q0 b/k, dimensionless: q0 largest heat flux, b half width, k conductivity.
    """
    optimum = minimize_scalar(
        lambda at: -moving_temperature(at, number), bounds=(-1.0, 1.0), method="bounded"
    )
    return -float(optimum.fun)


def moving_temperature(at: float, number: float) -> float:
    """Compute the temperature at a point under a moving strip of heat spread as Hertz's pressure.

    1/pi times the integral over the strip, s = -1..1, of `sqrt(1 - s^2) e^(Pe (at - s)) K0(Pe |at - s|)`.

    Parameters
    ----------
    at : float
        Position over the half width b, -1..1, dimensionless; positive in the direction in which the
        material moves.
    number : float
        Peclet number Pe = u b/(2 kappa), dimensionless.

    Returns
    -------
    float
        Temperature rise over q0 b/k, dimensionless: q0 largest heat flux, b half width, k conductivity.
    """
    half, weights = _gauss()
    total = 0.0
    for end in (-1.0, 1.0):
        length = abs(end - at)
        # distance = length u^4 takes the logarithm out of the integrand, cos that of the flux's end
        distance = length * half**4
        position = at + np.sign(end - at) * distance
        flux = np.sqrt(np.clip(1 - position**2, 0.0, None))
        argument = number * distance
        rise = np.exp(number * (at - position) - argument) * kve(0, argument)
        total += float(np.sum(weights * 4 * length * half**3 * flux * rise))
    return total / np.pi


@cache
def _gauss() -> tuple[Array, Array]:
    """Return the POINTS nodes and weights of Gauss-Legendre quadrature on 0..1, both (POINTS,)."""
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    return 0.5 * (nodes + 1), 0.5 * weights
