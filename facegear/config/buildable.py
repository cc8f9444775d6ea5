"""Whether the machine of a config can be put together, before anything is computed."""

from collections.abc import Iterator

import numpy as np

from facegear.config.bodies import SingleGear, SinglePinion
from facegear.config.lumped_model import LumpedParts, lumped_parts
from facegear.config.machine_errors import half_backlash
from facegear.config.machine_layout import ToothNumbers
from facegear.config.transmission import Transmission
from facegear.errors import ConfigError
from facegear.transmission.assembly import Assembly, assembly, interference_depths
from facegear.transmission.layout import Layout


def require_buildable(section: Transmission, teeth: ToothNumbers, model: LumpedParts | None = None) -> None:
    """Refuse a machine that cannot be put together.

    Errors that press a machine together at rest are allowed, as its bearings give; `preloads` lists them.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.
    model : LumpedParts or None
        Result of `lumped_parts(section, teeth)`, computed here if None.

    Raises
    ------
    ConfigError
        If teeth do not fit, a pitch curve belongs to other tooth numbers, or no bearing holds a force.
    """
    shape, flaws = model or lumped_parts(section, teeth)
    for key, single_parts, count in (
        ("single_pinions", section.single_pinions, teeth.pinion_teeth),
        ("single_gears", section.single_gears, teeth.gear_teeth),
    ):
        for name, single_part in single_parts.items():
            given_count = len(single_part.cumulative_pitch_um)
            if given_count not in (0, count):
                pitch_key = f"transmission.{key}.{name}.cumulative_pitch_um"
                raise ConfigError(pitch_key, f"{given_count} values", f"one for each of the {count} teeth")
    bodies: dict[str, SinglePinion | SingleGear] = {**section.single_pinions, **section.single_gears}
    for name, body in bodies.items():
        _require_hold(shape, name, body)
    _require_assembly(section, shape, assembly(shape, half_backlash(section, shape), flaws.clocking))


def require_room(section: Transmission, teeth: ToothNumbers, model: LumpedParts | None = None) -> None:
    """Refuse a machine that is pressed together at rest: it jams where it should turn.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.
    model : LumpedParts or None
        Result of `lumped_parts(section, teeth)`, computed here if None.

    Raises
    ------
    ConfigError
        For the first pinion or mesh that is pressed together.
    """
    for key, amount, requirement in _find_preloads(section, model or lumped_parts(section, teeth)):
        raise ConfigError(key, amount, requirement)


def preloads(section: Transmission, teeth: ToothNumbers) -> list[str]:
    """List the pinions and meshes that are pressed together at rest.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.

    Returns
    -------
    list[str]
        One line each, with key and amount.
    """
    return [f"{key}: {amount}" for key, amount, _ in _find_preloads(section, lumped_parts(section, teeth))]


def _require_hold(shape: Layout, name: str, single_part: SinglePinion | SingleGear) -> None:
    """Raise ConfigError for an external force along an axis of a body whose bearing gives way to it."""
    key = "single_pinions" if isinstance(single_part, SinglePinion) else "single_gears"
    names = [pinion.name for pinion in shape.pinions] + [gear.side.value for gear in shape.gears]
    bearing = shape.bodies[names.index(name)].bearing
    for axis, force in single_part.force_n:
        if force != 0.0 and bearing["xyz".index(axis)] == 0.0:
            requirement = f"0, as the bearing has no stiffness along {axis}"
            raise ConfigError(f"transmission.{key}.{name}.force_n.{axis}", force, requirement)


def _require_assembly(section: Transmission, shape: Layout, fit: Assembly) -> None:
    for i in np.flatnonzero(~fit.fits):
        pinion = section.pinions[i]
        key, unit = (
            ("angle_deg", 360.0 / shape.gear_teeth)
            if pinion.angle_pitches is None
            else ("angle_pitches", 1.0)
        )
        value = pinion.angle_deg if pinion.angle_pitches is None else pinion.angle_pitches
        requirement = (
            f"where the teeth fit, such as {fit.below[i] * unit:.6g} and {fit.above[i] * unit:.6g} "
            f"(or clocking_deg): {1e6 * fit.misfit[i]:.0f} um are left between this pinion's meshes and "
            f"their backlash takes up {1e6 * fit.clearance[i]:.0f} um"
        )
        raise ConfigError(f"transmission.pinions[{i}].{key}", value, requirement)


def _find_preloads(section: Transmission, model: LumpedParts) -> Iterator[tuple[str, str, str]]:
    """Yield key, amount and requirement of everything that is pressed together at rest."""
    shape, flaws = model
    half = half_backlash(section, shape)
    fit = assembly(shape, half, flaws.clocking, flaws)
    for i in np.flatnonzero(~fit.fits):
        requirement = (
            f"errors of this pinion and its meshes within the {1e6 * fit.clearance[i]:.0f} um they leave"
        )
        amount = f"{1e6 * fit.misfit[i]:.0f} um between its two meshes"
        yield f"transmission.single_pinions.{shape.pinions[i].name}", amount, requirement
    squeeze = interference_depths(shape, half, flaws)
    for mesh in np.flatnonzero(squeeze > 0.0):
        pinion = shape.pinions[shape.meshes[mesh][0]].name
        amount = f"{1e6 * squeeze[mesh]:.1f} um too deep in {shape.mesh_names[mesh]}"
        requirement = "within backlash and clearance, or the pinion jams"
        yield f"transmission.single_pinions.{pinion}.position_um.y", amount, requirement
