"""Checks of the tooth pair, which the config describes as that of an upper face gear, for a lower one."""

from collections.abc import Sequence

from facegear.build.tooth_pair import ToothPair, nominal_design
from facegear.errors import ConfigError, GeometryError, NotConverged
from facegear.schema.base import config_error
from facegear.schema.changes import PAIR
from facegear.teeth.placement import nominal_teeth, pair_at
from facegear.teeth.validate import check

SUMS = {
    "offset_mm": 0.0,
    "shaft_angle_deg": 180.0,
    "assembly.offset_um": 0.0,
    "assembly.shaft_angle_error_deg": 0.0,
}
"""Keys of section `tooth_pair` in which a lower gear differs from an upper one, with the sum of the values of
both.
"""
ALONE = "geometry and contact of a gear alone are those of an upper one"
"""Reason of a refusal: the machine has the forces and poses of the lower gear."""


def check_gear_alone(section: ToothPair, gears: Sequence[str], moved_keys: Sequence[str]) -> None:
    """Refuse a lower gear alone whose axes an upper one would not have.

    Teeth without bodies have no contact that could be of the wrong gear, and may stand on any axes.

    Parameters
    ----------
    section : ToothPair
        Section `tooth_pair` of the config.
    gears : Sequence[str]
        Face gears of the machine, of `upper` and `lower`.
    moved_keys : Sequence[str]
        Keys of the config that samples or designs change.

    Raises
    ------
    ConfigError
        Naming the values of the upper gear that the lower one is when it is turned over, or the key of the
        axes that samples or designs change.
    """
    if "upper" in gears or section.pinion is None:
        return
    errors = section.assembly
    values = (
        section.offset_mm,
        section.shaft_angle_deg,
        errors.offset_um,
        errors.shaft_angle_error_deg,
    )
    turned_over = [
        f"{PAIR}{key} = {pair_sum - value:.12g}"
        for (key, pair_sum), value in zip(SUMS.items(), values, strict=True)
        if value != pair_sum - value
    ]
    if turned_over:
        upper_gear = f"turned over, this gear is an upper one with {', '.join(turned_over)}"
        requirement = f"[upper] on such axes, as {ALONE}; {upper_gear} and angles, x and y of the other sign"
        raise ConfigError("transmission.face_gears", list(gears), requirement)
    for key in moved_keys:
        if key.removeprefix(PAIR) in SUMS:
            requirement = f"[upper] where samples or designs change {key}, as {ALONE}"
            raise ConfigError("transmission.face_gears", list(gears), requirement)


def check_lower_gear(section: ToothPair) -> None:
    """Refuse a pair that no lower gear can have, where offset or shaft angle make it another gear.

    Parameters
    ----------
    section : ToothPair
        Section `tooth_pair` of a config with a lower gear.

    Raises
    ------
    ConfigError
        For the first value that the lower gear cannot have.
    """
    if section.pinion is None:
        return
    upper = nominal_design(section)
    lower = pair_at(upper, "lower", "drive")
    if nominal_teeth(lower) == nominal_teeth(upper):
        return
    try:
        check(lower)
    except GeometryError as error:
        requirement = config_error(error).requirement
        raise ConfigError(
            f"tooth_pair.{error.quantity}", error.value, f"{requirement}; this is the lower gear's limit"
        ) from None
    except NotConverged as error:
        requirement = f"other teeth or radii for the lower gear: {error}"
        raise ConfigError("tooth_pair.face_gear_teeth", section.face_gear_teeth, requirement) from None
