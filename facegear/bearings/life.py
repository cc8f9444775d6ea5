"""Life of rolling bearings: ISO 281 by equivalent loads, ISO/TS 16281 by the loads of all elements.

Formulas are those of radial bearings of one row. `BASIS` says which of them rest on a standard that was not
at hand when they were written.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy

from facegear.arrays import Array
from facegear.bearings.elements import AnyBearing, BallBearing
from facegear.bearings.equivalent_load import equivalent_load
from facegear.bearings.response import ElementLoads
from facegear.errors import InvalidInput

BASIS = {
    "basic": "ISO 281:2007 (tables as public programs and catalogues print them; standard not at hand)",
    "reference": "ISO/TS 16281:2008 by public programs (standard not at hand)",
    "modified": "ISO 281:2007, equations (31) to (36), by public programs (standard not at hand)",
}
"""Standard of each life, and what it was compared with."""
MILLION = 1e6
"""Turns in which standards count lives."""
BALL_RATING, ROLLER_RATING = 1.3, 1.1
"""Rating factor b_m of contemporary steel, dimensionless (ISO 281, table 1)."""
LARGE_BALL = 25.4
"""Diameter, mm, from which the load rating of balls grows more slowly (ISO 281)."""
BALL_SERIES, ROLLER_SERIES = 10.0 / 9.0, 9.0 / 8.0
"""Weibull slopes of lives, dimensionless, by which those of several bearings add up (ISO 281)."""
LARGEST_FACTOR = 50.0
"""Largest a_ISO, dimensionless (ISO 281)."""
RELIABILITY = {90.0: 1.0, 95.0: 0.64, 96.0: 0.55, 97.0: 0.47, 98.0: 0.37, 99.0: 0.25}
"""Factor a_1, dimensionless, by the reliability in percent (ISO 281:2007, table 12, as two public programs
have it)."""


def load_rating(bearing: AnyBearing) -> float:
    """Return the basic dynamic radial load rating C of ISO 281.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.

    Returns
    -------
    float
        C, N, computed from the dimensions (ISO 281, contemporary steel); a catalogue's may differ.
    """
    gamma, diameter = bearing.pitch_ratio, 1e3 * bearing.element_diameter
    cosine, count = float(np.cos(bearing.contact_angle)), bearing.elements
    slope = (1.0 - gamma) / (1.0 + gamma)
    if isinstance(bearing, BallBearing):
        inner = bearing.groove_ratio_inner
        osculation = 0.41 * 98.0665 * 0.95 * (2.0 * inner / (2.0 * inner - 1.0)) ** 0.41
        shares = (1.0 + (1.04 * slope**1.72 * _groove_term(bearing) ** 0.41) ** (10.0 / 3.0)) ** -0.3
        factor = osculation * gamma**0.3 * (1.0 - gamma) ** 1.39 / (1.0 + gamma) ** (1.0 / 3.0) * shares
        size = diameter**1.8 if diameter <= LARGE_BALL else 3.647 * diameter**1.4
        return float(BALL_RATING * factor * cosine**0.7 * count ** (2.0 / 3.0) * size)
    shares = (1.0 + (1.04 * slope ** (143.0 / 108.0)) ** 4.5) ** (-2.0 / 9.0)
    factor = 0.377 * 551.13373 * 0.83 * gamma ** (2.0 / 9.0) * (1.0 - gamma) ** (29.0 / 27.0)
    factor *= shares / (1.0 + gamma) ** 0.25
    length = (1e3 * bearing.effective_length * cosine) ** (7.0 / 9.0)
    return float(ROLLER_RATING * factor * length * count**0.75 * diameter ** (29.0 / 27.0))


def _groove_term(bearing: BallBearing) -> float:
    """Return r_i (2 r_e - D) / (r_e (2 r_i - D)) of the groove radii and the ball diameter, dimensionless."""
    inner, outer = bearing.groove_ratio_inner, bearing.groove_ratio_outer
    return inner * (2.0 * outer - 1.0) / (outer * (2.0 * inner - 1.0))


def _life_exponent(bearing: AnyBearing) -> float:
    """Return the exponent p of the load in L = (C / P)^p: 3 of balls, 10/3 of rollers (ISO 281)."""
    return 3.0 if isinstance(bearing, BallBearing) else 10.0 / 3.0


def basic_life(bearing: AnyBearing, load: Array, rating: float | None = None) -> Array:
    """Return the basic life L10 = (C / P)^p of ISO 281.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    load : (...) array
        Equivalent load P, N.
    rating : float, optional
        Load rating C, N; that of `load_rating` by default.

    Returns
    -------
    (...) array
        Life in units of 1e6 turns; infinite without load.
    """
    capacity = load_rating(bearing) if rating is None else rating
    with np.errstate(divide="ignore"):
        return np.asarray((capacity / np.asarray(load, float)) ** _life_exponent(bearing))


def reference_life(
    bearing: AnyBearing, loads: ElementLoads, rating: float | None = None, outer_turns: bool = False
) -> Array:
    """Return the basic reference life L10r of ISO/TS 16281.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    loads : ElementLoads
        Loads of the elements (slices) at K motions.
    rating : float, optional
        Load rating C, N; that of `load_rating` by default.
    outer_turns : bool
        If True, the outer ring turns against the load, and the inner one stands; else the reverse.

    Returns
    -------
    (K,) array
        Life in units of 1e6 turns; infinite without load.
    """
    capacity = load_rating(bearing) if rating is None else rating
    gamma, count = bearing.pitch_ratio, bearing.elements
    slope = (1.0 - gamma) / (1.0 + gamma)
    share = capacity / (count * np.cos(bearing.contact_angle))
    if isinstance(bearing, BallBearing):
        ratio, power, weibull = 1.044 * slope**1.72 * _groove_term(bearing) ** 0.41, 10.0 / 3.0, 0.9
        at_inner = share / 0.407 * (1.0 + ratio**power) ** 0.3
        at_outer = share / 0.389 * (1.0 + ratio**-power) ** 0.3
        inner, outer, turning = loads.inner, loads.outer, 3.0
    else:
        ratio, power, weibull = 1.038 * slope ** (143.0 / 108.0), 4.5, 8.0 / 9.0
        slices = bearing.slices ** (7.0 / 9.0)
        at_inner = share / (0.83 * 0.378 * slices) * (1.0 + ratio**power) ** (2.0 / 9.0)
        at_outer = share / (0.83 * 0.364 * slices) * (1.0 + ratio**-power) ** (2.0 / 9.0)
        edges = edge_factors(bearing.slices)
        inner, outer, turning = loads.inner * edges, loads.outer * edges, 4.0
    # The ring that turns against the load meets it with all of its circumference.
    exponents = (power, turning) if outer_turns else (turning, power)
    damage = 0.0
    for load, limit, exponent in zip((inner, outer), (at_inner, at_outer), exponents, strict=True):
        mean = np.mean((load / limit) ** exponent, axis=1) ** (1.0 / exponent)
        damage = damage + np.sum(mean**power, axis=-1)
    with np.errstate(divide="ignore"):
        return np.asarray(damage**-weibull)


def edge_factors(slices: int) -> Array:
    """Return the factors f_k of ISO/TS 16281 for edge stress, by which loads of slices are multiplied.

    Parameters
    ----------
    slices : int
        Number of slices n.

    Returns
    -------
    (n,) array
        Dimensionless; 1 in the middle.
    """
    number = np.arange(1, slices + 1)
    distance = 1.985 * np.abs(2 * number - slices - 1) / (2 * slices - 2)
    with np.errstate(divide="ignore"):
        return np.asarray(1.0 - 0.01 / np.log(distance))


def reference_load(bearing: AnyBearing, life: Array, rating: float | None = None) -> Array:
    """Return the equivalent reference load P_ref = C / L10r^(1/p), which gives the reference life by ISO 281.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    life : (...) array
        Reference life L10r, million turns.
    rating : float, optional
        Load rating C, N; that of `load_rating` by default.

    Returns
    -------
    (...) array
        N.
    """
    capacity = load_rating(bearing) if rating is None else rating
    return np.asarray(capacity / np.asarray(life, float) ** (1.0 / _life_exponent(bearing)))


@dataclass(frozen=True)
class Lubrication:
    """Conditions of the modified life.

    Attributes
    ----------
    contamination_factor
        e_C, from above 0 (dirty) to 1 (clean).
    viscosity_ratio
        kappa, viscosity over the one that the speed asks for; at least 0.1.
    fatigue_load_limit, reliability
        C_u of the bearing, N, and the reliability of the life in percent, a key of `RELIABILITY`.
    """

    contamination_factor: float
    viscosity_ratio: float
    fatigue_load_limit: float
    reliability: float = 90.0

    def __post_init__(self) -> None:
        """Raise InvalidInput for values outside the ranges of the attributes."""
        if not 0.0 < self.contamination_factor <= 1.0:
            raise InvalidInput("contamination factor", self.contamination_factor, "above 0, at most 1")
        if not 0.1 <= self.viscosity_ratio < np.inf:
            raise InvalidInput("viscosity ratio", self.viscosity_ratio, "at least 0.1 (ISO 281)")
        if not 0.0 < self.fatigue_load_limit < np.inf:
            raise InvalidInput("fatigue load limit", self.fatigue_load_limit, "above 0 N")
        if self.reliability not in RELIABILITY:
            choices = ", ".join(f"{percent:g}" for percent in RELIABILITY)
            raise InvalidInput("reliability of bearings", self.reliability, f"one of {choices} percent")


def life_factor(bearing: AnyBearing, load: Array, lubrication: Lubrication) -> Array:
    """Return a_1 a_ISO, by which lubrication, dirt and the fatigue limit change the life.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    load : (...) array
        Equivalent load P, N.
    lubrication : Lubrication
        Conditions.

    Returns
    -------
    (...) array
        Factor on the life, dimensionless, a_ISO being at most LARGEST_FACTOR.
    """
    ratio = min(lubrication.viscosity_ratio, 4.0)
    if isinstance(bearing, BallBearing):
        constant, low, high, bend, power, exponent = 2.5671, 2.2649, 1.9987, 0.83, 1.0 / 3.0, -9.3
    else:
        constant, low, high, bend, power, exponent = 1.5859, 1.3993, 1.2348, 1.0, 0.4, -9.185
    if ratio < 0.4:
        film = constant - low / ratio**0.054381
    elif ratio < 1.0:
        film = constant - high / ratio**0.19087
    else:
        film = constant - high / ratio**0.071739
    with np.errstate(divide="ignore"):
        limit = lubrication.contamination_factor * lubrication.fatigue_load_limit / np.asarray(load, float)
    left = 1.0 - film**bend * limit**power
    # Below the fatigue limit the factor would grow without bound.
    factor = 0.1 * np.maximum(left, 1e-9) ** exponent
    return np.asarray(RELIABILITY[lubrication.reliability] * np.minimum(factor, LARGEST_FACTOR))


class DutyLife(NamedTuple):
    """Lives of a bearing over a duty cycle of B bins.

    Attributes
    ----------
    rating
        Load rating C, N.
    equivalent_load, reference_load : (B,)
        P of ISO 281 and P_ref of ISO/TS 16281, N.
    basic, reference, modified_reference : (B,)
        L10, L10r and modified L10r of each bin, million turns; `modified_reference` is not a number without
        lubrication.
    basic_hours, reference_hours, modified_hours
        Of the whole cycle by Miner's rule, h.
    """

    rating: float
    equivalent_load: Array
    reference_load: Array
    basic: Array
    reference: Array
    modified_reference: Array
    basic_hours: float
    reference_hours: float
    modified_hours: float


def rate_duty(
    bearing: AnyBearing,
    force: Array,
    loads: ElementLoads,
    turns_per_hour: Array,
    hours: Array,
    rating: float | None = None,
    lubrication: Lubrication | None = None,
) -> DutyLife:
    """Return the lives of a bearing over a duty cycle.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.
    force : (B, 5) array
        Loads of the bearing in each bin, N and N m, as in `equivalent_load`.
    loads : ElementLoads
        Loads of its elements in each bin.
    turns_per_hour : (B,) array
        Turns of the inner ring in an hour, 1/h.
    hours : (B,) array
        Time in each bin, h; only the shares count.
    rating : float, optional
        Load rating C of a catalogue, N; that of `load_rating` by default.
    lubrication : Lubrication, optional
        Conditions of the modified life; without it this life is not a number.

    Returns
    -------
    DutyLife
        Lives of each bin in million turns, of the whole cycle in h.
    """
    capacity = load_rating(bearing) if rating is None else rating
    equivalent = equivalent_load(bearing, force)
    basic = basic_life(bearing, equivalent, capacity)
    reference = reference_life(bearing, loads, capacity)
    with np.errstate(divide="ignore"):
        at_reference = reference_load(bearing, reference, capacity)
    modified_life = np.full(reference.shape, np.nan)
    if lubrication is not None:
        modified_life = reference * life_factor(bearing, at_reference, lubrication)
    sums = [sum_damage(life, turns_per_hour, hours) for life in (basic, reference, modified_life)]
    return DutyLife(capacity, equivalent, at_reference, basic, reference, modified_life, *sums)


def sum_damage(life: Array, turns_per_hour: Array, hours: Array) -> float:
    """Return the life over a duty cycle by Miner's rule (Miner 1945).

    Parameters
    ----------
    life : (B,) array
        Life in each bin, in units of 1e6 turns.
    turns_per_hour : (B,) array
        1/h.
    hours : (B,) array
        Time in each bin, h; only the shares count.

    Returns
    -------
    float
        Life in units of 1 h; infinite where no bin does damage.
    """
    damage = float(np.sum(np.abs(turns_per_hour) * hours / (MILLION * life)))
    if np.isnan(damage):
        return float("nan")
    return float(np.sum(hours)) / damage if damage > 0.0 else float("inf")


def life_together(bearings: Sequence[AnyBearing], lives: Sequence[float]) -> float:
    """Return the life that a set of bearings survives with the probability that its single lives have.

    Parameters
    ----------
    bearings : sequence of BallBearing or RollerBearing
        The bearings.
    lives : sequence of float
        Life of each one, any unit; infinite where a bearing carries nothing, not a number where it is not
        known.

    Returns
    -------
    float
        Unit of the lives: L such that the sum of (L / L_i)^e_i is 1; not a number where one is not known.
    """
    finite = [
        (life, BALL_SERIES if isinstance(bearing, BallBearing) else ROLLER_SERIES)
        for bearing, life in zip(bearings, lives, strict=True)
        if life < np.inf
    ]
    if np.isnan(lives).any():
        return float("nan")
    if not finite:
        return float("inf")
    shortest = min(life for life, _ in finite)

    def excess(logarithm: float) -> float:
        """Return the sum of (L / L_i)^e_i less 1 at the logarithm of L over the shortest life."""
        return float(sum((shortest * np.exp(logarithm) / life) ** slope for life, slope in finite)) - 1.0

    lowest = -np.log(len(finite)) - 1.0
    return float(shortest * np.exp(scipy.optimize.brentq(excess, lowest, 0.0, xtol=1e-14)))
