"""Checks of the tooth pair, which the config describes as that of an upper face gear, for a lower one."""

from collections.abc import Sequence
from math import degrees

from facegear.build.tooth_pair import ToothPair, nominal_design
from facegear.errors import ConfigError, GeometryError, NotConverged
from facegear.schema.base import config_error
from facegear.schema.changes import PAIR
from facegear.teeth.design import PairDesign
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


def other_lower_gear(design: PairDesign) -> PairDesign | None:
    """Return the pair of the lower gear's drive flank where it has other teeth than the upper gear.

    Parameters
    ----------
    design : PairDesign
        Pair of the upper gear.

    Returns
    -------
    PairDesign or None
        None where both gears have the same teeth.
    """
    lower = pair_at(design, "lower", "drive")
    return None if nominal_teeth(lower) == nominal_teeth(design) else lower


def check_lower_gear(section: ToothPair, gears: Sequence[str]) -> None:
    """Require teeth of the lower face gear where an offset or the shaft angle makes it another one.

    Parameters
    ----------
    section : ToothPair
        Section `tooth_pair` of the config.
    gears : Sequence[str]
        Face gears of the machine, of `upper` and `lower`.

    Raises
    ------
    ConfigError
        For the first value that the lower gear cannot have.
    """
    if "lower" not in gears or section.pinion is None:
        return
    lower = other_lower_gear(nominal_design(section))
    if lower is None:
        return
    axes = (
        f"for the lower gear, which the pinions meet at offset_mm = {1e3 * lower.offset + 0.0:g} and "
        f"shaft_angle_deg = {degrees(lower.shaft_angle):g}"
    )
    try:
        check(lower)
    except GeometryError as error:
        requirement = f"{config_error(error).requirement}; {axes}"
        raise ConfigError(f"{PAIR}{error.quantity}", error.value, requirement) from None
    except NotConverged as error:
        requirement = f"other teeth or radii {axes}: {error}"
        raise ConfigError(f"{PAIR}face_gear_teeth", section.face_gear_teeth, requirement) from None
