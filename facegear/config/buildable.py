"""Whether the machine of a config can be put together, before anything is computed."""

import numpy as np
from numpy.typing import NDArray

from facegear.config.lumped_model import ToothNumbers, half_backlash, imperfections, layout
from facegear.config.transmission import Transmission
from facegear.errors import ConfigError
from facegear.transmission.assembly import Assembly, assembly, squeezed
from facegear.transmission.layout import Layout


def require_buildable(section: Transmission, teeth: ToothNumbers) -> None:
    """Raise ConfigError for pinions that do not mount, errors that jam them, pitch curves of other teeth."""
    shape = layout(section, teeth)
    for key, given, count in (
        ("single_pinions", section.single_pinions, teeth.pinion_teeth),
        ("single_gears", section.single_gears, teeth.gear_teeth),
    ):
        for name, one in given.items():
            told = len(one.cumulative_pitch_um)
            if told not in (0, count):
                where = f"transmission.{key}.{name}.cumulative_pitch_um"
                raise ConfigError(where, f"{told} values", f"one for each of the {count} teeth")
    flaws = imperfections(section, shape)
    half = np.full(len(shape.meshes), half_backlash(section))
    half = np.where(np.isnan(flaws.half_backlash), half, flaws.half_backlash)
    _require_assembly(section, shape, assembly(shape, half, flaws.clocking))
    _require_room(shape, assembly(shape, half, flaws.clocking, flaws), squeezed(shape, half, flaws))


def _require_assembly(section: Transmission, shape: Layout, found: Assembly) -> None:
    for i in np.flatnonzero(~found.fits):
        place = section.pinions[i]
        key, unit = (
            ("angle_deg", 360.0 / shape.gear_teeth) if place.angle_pitches is None else ("angle_pitches", 1.0)
        )
        value = place.angle_deg if place.angle_pitches is None else place.angle_pitches
        allowed = (
            f"where the teeth fit, such as {found.below[i] * unit:.6g} and {found.above[i] * unit:.6g} "
            f"(or clocking_deg): {1e6 * found.misfit[i]:.0f} um are left between this pinion's meshes and "
            f"their backlash takes up {1e6 * found.room[i]:.0f} um"
        )
        raise ConfigError(f"transmission.pinions[{i}].{key}", value, allowed)


def _require_room(shape: Layout, found: Assembly, squeeze: NDArray[np.float64]) -> None:
    for i in np.flatnonzero(~found.fits):
        allowed = f"errors of this pinion and its meshes within the {1e6 * found.room[i]:.0f} um they leave"
        told = f"{1e6 * found.misfit[i]:.0f} um between its two meshes"
        raise ConfigError(f"transmission.single_pinions.{shape.pinions[i].name}", told, allowed)
    for mesh in np.flatnonzero(squeeze > 0.0):
        pinion = shape.pinions[shape.meshes[mesh][0]].name
        told = f"{1e6 * squeeze[mesh]:.1f} um too deep in {shape.mesh_names[mesh]}"
        allowed = "within backlash and clearance, or the pinion jams"
        raise ConfigError(f"transmission.single_pinions.{pinion}.position_um.y", told, allowed)
