"""Whether the machine of a config can be put together, before anything is computed."""

from collections.abc import Iterator

import numpy as np

from facegear.config.bodies import SingleGear, SinglePinion
from facegear.config.lumped_model import Described, described
from facegear.config.machine_errors import half_backlash
from facegear.config.machine_layout import ToothNumbers
from facegear.config.transmission import Transmission
from facegear.errors import ConfigError
from facegear.transmission.assembly import Assembly, assembly, interference_depths
from facegear.transmission.layout import Layout


def require_buildable(section: Transmission, teeth: ToothNumbers, made: Described | None = None) -> None:
    """Raise ConfigError for teeth that do not fit, pitch curves of other teeth, forces that nothing holds.

    Errors that press a machine together at rest are no hindrance, as its bearings give: preloads().
    made: described(section, teeth), where the caller has it.
    """
    shape, flaws = made or described(section, teeth)
    for key, given, count in (
        ("single_pinions", section.single_pinions, teeth.pinion_teeth),
        ("single_gears", section.single_gears, teeth.gear_teeth),
    ):
        for name, own in given.items():
            given_count = len(own.cumulative_pitch_um)
            if given_count not in (0, count):
                where = f"transmission.{key}.{name}.cumulative_pitch_um"
                raise ConfigError(where, f"{given_count} values", f"one for each of the {count} teeth")
    bodies: dict[str, SinglePinion | SingleGear] = {**section.single_pinions, **section.single_gears}
    for name, body in bodies.items():
        _require_hold(shape, name, body)
    _require_assembly(section, shape, assembly(shape, half_backlash(section, shape), flaws.clocking))


def require_room(section: Transmission, teeth: ToothNumbers, made: Described | None = None) -> None:
    """Raise ConfigError for a machine that is pressed together at rest: it jams where it should turn."""
    for key, amount, allowed in _pressed(section, made or described(section, teeth)):
        raise ConfigError(key, amount, allowed)


def preloads(section: Transmission, teeth: ToothNumbers) -> list[str]:
    """A line for each pinion and mesh that is pressed together at rest, with key and amount."""
    return [f"{key}: {amount}" for key, amount, _ in _pressed(section, described(section, teeth))]


def _require_hold(shape: Layout, name: str, own: SinglePinion | SingleGear) -> None:
    """Raise ConfigError for an external force along an axis of a body whose bearing gives way to it."""
    key = "single_pinions" if isinstance(own, SinglePinion) else "single_gears"
    names = [pinion.name for pinion in shape.pinions] + [gear.side.value for gear in shape.gears]
    bearing = shape.bodies[names.index(name)].bearing
    for axis, force in own.force_n:
        if force != 0.0 and bearing["xyz".index(axis)] == 0.0:
            allowed = f"0, as the bearing has no stiffness along {axis}"
            raise ConfigError(f"transmission.{key}.{name}.force_n.{axis}", force, allowed)


def _require_assembly(section: Transmission, shape: Layout, built: Assembly) -> None:
    for i in np.flatnonzero(~built.fits):
        pinion = section.pinions[i]
        key, unit = (
            ("angle_deg", 360.0 / shape.gear_teeth)
            if pinion.angle_pitches is None
            else ("angle_pitches", 1.0)
        )
        value = pinion.angle_deg if pinion.angle_pitches is None else pinion.angle_pitches
        allowed = (
            f"where the teeth fit, such as {built.below[i] * unit:.6g} and {built.above[i] * unit:.6g} "
            f"(or clocking_deg): {1e6 * built.misfit[i]:.0f} um are left between this pinion's meshes and "
            f"their backlash takes up {1e6 * built.clearance[i]:.0f} um"
        )
        raise ConfigError(f"transmission.pinions[{i}].{key}", value, allowed)


def _pressed(section: Transmission, made: Described) -> Iterator[tuple[str, str, str]]:
    """Key, amount and what is allowed of everything that is pressed together at rest."""
    shape, flaws = made
    half = half_backlash(section, shape)
    built = assembly(shape, half, flaws.clocking, flaws)
    for i in np.flatnonzero(~built.fits):
        allowed = (
            f"errors of this pinion and its meshes within the {1e6 * built.clearance[i]:.0f} um they leave"
        )
        amount = f"{1e6 * built.misfit[i]:.0f} um between its two meshes"
        yield f"transmission.single_pinions.{shape.pinions[i].name}", amount, allowed
    squeeze = interference_depths(shape, half, flaws)
    for mesh in np.flatnonzero(squeeze > 0.0):
        pinion = shape.pinions[shape.meshes[mesh][0]].name
        amount = f"{1e6 * squeeze[mesh]:.1f} um too deep in {shape.mesh_names[mesh]}"
        allowed = "within backlash and clearance, or the pinion jams"
        yield f"transmission.single_pinions.{pinion}.position_um.y", amount, allowed
