"""Places on the pinion's pitch line nearest to the gear, and where the paths of contact meet it."""

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.tooth_family import SIDES, ToothFamily


def pitch_line_y(family: ToothFamily, radius: ArrayLike) -> Array:
    """Compute where the pinion's pitch line, nearest to the gear, passes a gear radius.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (...) array
        Place y along the pinion's axis, m; nan for a radius below the offset.
    """
    motion, radius = family.motion, np.asarray(radius, float)
    with np.errstate(invalid="ignore"):
        level = np.sqrt((radius - family.offset) * (radius + family.offset))
    return (level + family.pinion_pitch_radius * motion.cosine) / motion.sine


def pitch_line_radius(family: ToothFamily, y: ArrayLike) -> Array:
    """Compute the gear radius at a place of the pinion's pitch line: the inverse of `pitch_line_y`.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    y : (...) array_like
        Place y along the pinion's axis, m.

    Returns
    -------
    (...) array
        Gear radius, m.
    """
    motion = family.motion
    level = np.asarray(y, float) * motion.sine - family.pinion_pitch_radius * motion.cosine
    return np.hypot(family.offset, level)


def path_middles(family: ToothFamily) -> tuple[float, float]:
    """Compute where the paths of contact of both flanks meet the pinion's pitch line, without errors.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears; the place of its face does not matter.

    Returns
    -------
    tuple of float
        Places y along the pinion's axis of drive and coast flank, m.
    """
    motion, middles = family.motion, []
    for side in SIDES:
        helicoid = gear_flank(family, side).shaper
        slope = helicoid.pressure_angle
        normal_x = side * helicoid.cosine * np.cos(slope)
        normal_y = helicoid.sine * motion.sine - helicoid.cosine * np.sin(slope) * motion.cosine
        level = family.gear_pitch_radius + family.offset * normal_y / normal_x
        middles.append(float((level + family.pinion_pitch_radius * motion.cosine) / motion.sine))
    return middles[0], middles[1]
