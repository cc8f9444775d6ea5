"""Rolling bearings of a config where they stand in the machine, and loads that they cannot carry."""

from collections.abc import Sequence
from math import degrees, radians

import numpy as np

from facegear.bearings.elements import BallBearing
from facegear.bearings.response import BALL_LIMIT, ROLLER_LIMIT
from facegear.build.rolling import rolling_shaft
from facegear.errors import ConfigError
from facegear.machine.placed_bearings import PlacedBearing
from facegear.machine.statics import Equilibria
from facegear.schema.transmission import Transmission


def placed_bearings(section: Transmission) -> list[PlacedBearing]:
    """Return the rolling bearings of a machine, by its pinions.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.

    Returns
    -------
    list of PlacedBearing
        Bearings with the ratings that their sections give; empty where there are none.
    """
    bearings = []
    for pinion, pinion_place in enumerate(section.pinions):
        shaft = section.shaft_of(pinion_place)
        if shaft is None or not shaft.is_rolling:
            continue
        key = pinion_place.name if pinion_place.name in section.shafts else pinion_place.role
        for number, (support, part) in enumerate(
            zip(rolling_shaft(shaft).supports, shaft.bearings, strict=True)
        ):
            if part.rolling is None or isinstance(support.bearing, np.ndarray):
                continue
            shoulder = part.rolling.shoulder_angle_deg
            bearings.append(
                PlacedBearing(
                    key=f"transmission.shafts.{key}.bearings[{number}].rolling",
                    pinion=pinion,
                    number=number,
                    name=pinion_place.name,
                    bearing=support.bearing,
                    load_rating=part.rolling.load_rating_n,
                    fatigue_load_limit=part.rolling.fatigue_load_limit_n,
                    shoulder=None if shoulder is None else radians(shoulder),
                )
            )
    return bearings


def require_loads(bearings: Sequence[PlacedBearing], at_rest: Equilibria, torque: float) -> None:
    """Refuse bearings that are overloaded, or whose balls leave their shoulders.

    Parameters
    ----------
    bearings : sequence of PlacedBearing
        The bearings of a machine.
    at_rest : Equilibria
        An equilibrium of the machine.
    torque : float
        On an input pinion by each of its meshes, N m, for the message.

    Raises
    ------
    ConfigError
        For a pressure above the reference of ISO 76, a contact angle beyond the shoulder, and an angular
        contact ball bearing whose balls press on the side without shoulder.
    """
    for bearing in bearings:
        state, at_torque = bearing.state(at_rest), f"{bearing.name} at {torque:.4g} N m"
        limit = BALL_LIMIT if isinstance(bearing.bearing, BallBearing) else ROLLER_LIMIT
        pressure = float(state.pressures.max())
        if pressure > limit:
            requirement = f"loaded up to {1e-6 * limit:.0f} MPa, the reference of ISO 76"
            raise ConfigError(bearing.key, f"{1e-6 * pressure:.0f} MPa on {at_torque}", requirement)
        least, largest = state.contact_angles
        angle = max(abs(least), abs(largest))
        if bearing.shoulder is not None and angle > bearing.shoulder:
            requirement = f"loaded up to shoulder_angle_deg = {degrees(bearing.shoulder):g}"
            raise ConfigError(bearing.key, f"contact at {degrees(angle):.4g} deg on {at_torque}", requirement)
        if state.is_on_wrong_side:
            requirement = "pressed together by thrust or preload: its balls press where it has no shoulder"
            raise ConfigError(bearing.key, f"contact at {degrees(least):.4g} deg on {at_torque}", requirement)
