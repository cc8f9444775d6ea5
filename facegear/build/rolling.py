"""Rolling bearings in SI units, and shafts on them, from their sections of the config."""

from functools import lru_cache
from math import pi, radians
from string import ascii_uppercase

import numpy as np
import scipy

from facegear.arrays import Array
from facegear.bearings.elements import AnyBearing, BallBearing, RollerBearing
from facegear.bearings.shaft import RollingShaft, ShaftState, Support, find_shaft_equilibrium, follow_pinion
from facegear.errors import ConfigError, NotConverged
from facegear.parts.shafts import Elasticity, Segment
from facegear.rigid_body import MOTIONS
from facegear.schema.rolling import BALLS, RollingSection
from facegear.schema.shafts import PreloadSection, ShaftSection
from facegear.schema.transmission import Transmission

GROOVE_RATIO = 0.52
"""Radius of a groove over the ball's diameter, dimensionless, where none is given: the value for which
ISO 281 prints its load ratings."""


SLICES = 41
"""Slices of a roller where none are given: life of tilted rollers with logarithmic profile is then 6 % below
that of 161, and displacements are off by less than 0.2 %."""


BALL_PLACES, ROLLER_PLACES = 8, 6
"""Places of the cage over which a bearing is averaged, dimensionless. Under radial loads of 0.01 to 0.15 C on
6210 and NU 210, stiffness across the load is within 1 % of that of 512 places, and motion within 3e-5; time
grows with them."""


def rolling_bearing(section: RollingSection) -> AnyBearing:
    """Return the rolling bearing that a section describes, with ball or line contact by its type.

    Groove ratios and slices that the section leaves open are GROOVE_RATIO and SLICES. Elements feel
    centrifugal force where `centrifugal` is true and `speed_rpm` is filled in.

    Parameters
    ----------
    section : RollingSection
        Section of a rolling bearing, validated.

    Returns
    -------
    BallBearing or RollerBearing
        The bearing in SI units, angles in rad; `direction` is -1 where it is loaded along -z, else 1.
    """
    common = {
        "element_diameter": 1e-3 * section.element_diameter_mm,
        "pitch_diameter": 1e-3 * section.pitch_diameter_mm,
        "contact_angle": radians(section.contact_angle_deg or 0.0),
        "clearance": 1e-6 * section.clearance_diametral_um,
        "first_element": radians(section.first_element_deg or 0.0),
        "speed": (section.speed_rpm or 0.0) * pi / 30.0 if section.centrifugal else 0.0,
    }
    direction = -1 if section.loaded_by == "-z" else 1
    if section.type in BALLS:
        return BallBearing(
            section.elements,
            direction=direction,
            cage_places=BALL_PLACES if section.is_averaged else 1,
            groove_ratio_inner=section.groove_ratio_inner or GROOVE_RATIO,
            groove_ratio_outer=section.groove_ratio_outer or GROOVE_RATIO,
            **common,
        )
    assert section.effective_length_mm is not None
    return RollerBearing(
        section.elements,
        direction=direction,
        cage_places=ROLLER_PLACES if section.is_averaged else 1,
        effective_length=1e-3 * section.effective_length_mm,
        slices=section.slices or SLICES,
        has_profile=section.profile != "straight",
        **common,
    )


PARTS = (1.0, 0.1, 0.01, 0.0)
"""Parts of an estimated load that are tried one after the other, dimensionless."""


LARGEST_PRELOAD = 0.05
"""Motion of a preloaded pair's inner rings over the smaller element diameter, dimensionless, within which its
thrust is looked for."""


def check_preloads(section: Transmission) -> None:
    """Refuse preloads that no distance of the inner rings gives.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.

    Raises
    ------
    ConfigError
        For the first of them, by its whole key.
    """
    for name, shaft in section.shafts.items():
        if not shaft.is_rolling:
            continue
        try:
            rolling_shaft(shaft)
        except ConfigError as error:
            key = f"transmission.shafts.{name}.{error.key}"
            raise ConfigError(key, error.value, error.requirement) from None


def rolling_shaft(section: ShaftSection) -> RollingShaft:
    """Return a shaft with rolling bearings; equal sections share one object.

    Parameters
    ----------
    section : ShaftSection
        The section, validated, with a rolling bearing.

    Returns
    -------
    RollingShaft
        In SI units, with its preload as offsets of the supports.

    Raises
    ------
    ConfigError
        If no preload gives the thrust that is asked for.
    """
    return _rolling_shaft(section)


@lru_cache(maxsize=64)
def _rolling_shaft(section: ShaftSection) -> RollingShaft:
    """Return `rolling_shaft` of a section."""
    preload = section.preload
    if preload is None or preload.axial_um is not None:
        return _preloaded(section, 0.0 if preload is None else 1e-6 * (preload.axial_um or 0.0))
    thrust = preload.axial_n
    assert thrust is not None
    number = ascii_uppercase.index(preload.bearings[0])
    towards = np.sign(_offsets(section, preload, 1.0)[number, 2])

    mounted = section.at_speed(0.0)  # preload is set at rest

    def excess(distance: float) -> float:
        """Return the thrust in the pair, unloaded, less the one asked for, N, at a preload in m."""
        state = find_shaft_equilibrium(_preloaded(mounted, distance), np.zeros(MOTIONS))
        return float(towards * state.forces[number, 2]) - thrust

    sections = [section.bearings[ascii_uppercase.index(letter)].rolling for letter in preload.bearings]
    diameters = [rolling.element_diameter_mm for rolling in sections if rolling is not None]
    largest = LARGEST_PRELOAD * 1e-3 * min(diameters)
    if excess(largest) < 0.0:
        raise ConfigError("preload.axial_n", thrust, f"less than {thrust + excess(largest):.4g} N")
    return _preloaded(
        section, float(scipy.optimize.brentq(excess, -largest, largest, xtol=1e-15, rtol=1e-13))
    )


def _preloaded(section: ShaftSection, distance: float) -> RollingShaft:
    """Return the shaft of a section with a preload of its pair, m."""
    offsets = _offsets(section, section.preload, distance)
    supports = []
    for bearing, offset in zip(section.bearings, offsets, strict=True):
        rolling = bearing.rolling
        support = bearing.stiffness() if rolling is None else rolling_bearing(rolling)
        supports.append(Support(1e-3 * bearing.at_mm, support, offset))
    segments = tuple(
        Segment(1e-3 * part.length_mm, 1e-3 * part.diameter_mm, 1e-3 * part.bore_mm)
        for part in section.segments
    )
    material = Elasticity(1e9 * section.material.young_modulus_gpa, section.material.poisson_ratio)
    return RollingShaft(segments, material, tuple(supports), 1e-3 * section.pinion_mm)


def _offsets(section: ShaftSection, preload: PreloadSection | None, distance: float) -> Array:
    """Return the motions of the inner rings (bearings, 5), m and rad, that positions of the bores and a
    preload (m) make.

    Each of the pair moves by half of it, as the thrust that loads the bearing. Rings of bearings that take
    thrust both ways move towards each other.
    """
    offsets = np.zeros((len(section.bearings), MOTIONS))
    for number, bearing in enumerate(section.bearings):
        bore = bearing.position_um
        offsets[number, :3] = -1e-6 * np.array([bore.x, bore.y, bore.z])
    if preload is None:
        return offsets
    pair = [ascii_uppercase.index(letter) for letter in preload.bearings]
    stations = [section.bearings[number].at_mm for number in pair]
    towards = [1.0, -1.0] if stations[0] <= stations[1] else [-1.0, 1.0]
    ways = [section.bearings[number].rolling.loaded_by for number in pair]  # type: ignore[union-attr]
    for index, way in enumerate(ways):
        if way is not None:
            towards[index] = 1.0 if way == "+z" else -1.0
            towards[1 - index] = -towards[index]
    for number, sign in zip(pair, towards, strict=True):
        offsets[number, 2] = 0.5 * distance * sign
    return offsets


def nominal_state(section: ShaftSection, force: float) -> ShaftState:
    """Return the state of a shaft with rolling bearings under an estimated load, where a machine's search
    for its own begins; equal arguments share one object.

    Parameters
    ----------
    section : ShaftSection
        The section, validated, with a rolling bearing.
    force : float
        Force on the pinion across the shaft, N.

    Returns
    -------
    ShaftState
        Under `force` along x and half of it along y, or as much of it as bearings that are far too small
        hold: PARTS.
    """
    return _nominal_state(section, force)


@lru_cache(maxsize=64)
def _nominal_state(section: ShaftSection, force: float) -> ShaftState:
    """Return `nominal_state` of a section."""
    shaft, load = rolling_shaft(section), force * np.array([1.0, 0.5, 0.0, 0.0, 0.0])
    for part in PARTS:
        try:
            return find_shaft_equilibrium(shaft, part * load)
        except NotConverged:
            continue
    return follow_pinion(shaft, np.zeros(MOTIONS), np.zeros((len(shaft.supports), MOTIONS)))
