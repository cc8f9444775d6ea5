"""Limits of the face of a gear of any kind, from tooth numbers and proportions alone."""

from dataclasses import dataclass, fields, replace
from math import radians

import numpy as np

from facegear.errors import ConfigError
from facegear.teeth.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.limits import FaceRange, face_range, radius_limits
from facegear.teeth.pitch_line import path_middles
from facegear.teeth.validate import check_shaper

RANGES = {
    "pinion_teeth": (5, 500),
    "module_mm": (0.1, 100.0),
    "pressure_angle_deg": (10.0, 40.0),
    "coast_pressure_angle_deg": (10.0, 40.0),
    "helix_angle_deg": (-45.0, 45.0),
    "taper_angle_deg": (-20.0, 20.0),
    "shaft_angle_deg": (20.0, 160.0),
    "offset_mm": (-1e4, 1e4),
    "pinion_addendum_modules": (0.1, 2.0),
    "pinion_dedendum_modules": (0.1, 2.5),
    "profile_shift_modules": (-1.0, 1.0),
    "gear_addendum_modules": (0.1, 2.0),
    "shaper_addendum_modules": (0.1, 2.5),
    "shaper_tip_rounding_modules": (0.0, 0.6),
}
"""Smallest and largest value of each number of FaceNumbers, in its own unit."""


@dataclass(frozen=True)
class FaceNumbers:
    """Numbers that limit the face of a gear, under the names that the command line gives them.

    shaper_teeth: 0 for three more than the pinion. coast_pressure_angle_deg: 0 for that of the drive flank.
    """

    pinion_teeth: int
    face_gear_teeth: int
    module_mm: float
    pressure_angle_deg: float = 25.0
    coast_pressure_angle_deg: float = 0.0
    helix_angle_deg: float = 0.0
    taper_angle_deg: float = 0.0
    shaft_angle_deg: float = 90.0
    offset_mm: float = 0.0
    shaper_teeth: int = 0
    pinion_addendum_modules: float = 1.0
    pinion_dedendum_modules: float = 1.25
    profile_shift_modules: float = 0.0
    gear_addendum_modules: float = 1.0
    shaper_addendum_modules: float = 1.25
    shaper_tip_rounding_modules: float = 0.0


def limits_in_words(numbers: FaceNumbers) -> str:
    """Describe both limits of the face radii in one line.

    Parameters
    ----------
    numbers : FaceNumbers
        Numbers of the pair.

    Returns
    -------
    str
        One line with the number of the shaper's teeth, both radii (mm) and what limits them; of teeth that
        are not spur also the flank, the limit of the other flank and the keys that help.

    Raises
    ------
    ConfigError
        For numbers that no pair can have.
    GeometryError
        For teeth that have no face.
    """
    shaper = numbers.shaper_teeth or numbers.pinion_teeth + 3
    return f"face_gear radii in mm, with a shaper of {shaper} teeth: {face_limits(numbers)}"


def face_limits(numbers: FaceNumbers) -> FaceRange:
    """Compute the radii between which the face of a face gear may lie.

    The rack that cuts the pinion is taken with a sharp tip. The middle of the pinion's face, at which the
    profile shift of tapered teeth is given, is taken where the path of contact meets its pitch line.

    Parameters
    ----------
    numbers : FaceNumbers
        Numbers of the pair.

    Returns
    -------
    FaceRange
        Both radii (m) and what limits them.

    Raises
    ------
    ConfigError
        For numbers that no pair can have.
    GeometryError
        For teeth that have no face.
    """
    _require_ranges(numbers)
    design = _design(numbers)
    if not design.is_spur:
        middle = float(np.mean(path_middles(design.family)))
        design = replace(design, pinion=replace(design.pinion, middle=middle))
    check_shaper(design)
    return face_range(design, radius_limits(design))


def _require_ranges(numbers: FaceNumbers) -> None:
    """Raise ConfigError for the first number outside RANGES, or a gear with too few teeth."""
    for name in (field.name for field in fields(FaceNumbers)):
        value = getattr(numbers, name)
        if name == "face_gear_teeth" and not numbers.pinion_teeth < value <= 2000:
            requirement = f"more than the pinion's {numbers.pinion_teeth}, at most 2000"
            raise ConfigError(name, value, requirement)
        low, high = RANGES.get(name, (value, value))
        if name == "coast_pressure_angle_deg" and value == 0.0:
            continue
        if not low <= value <= high:
            raise ConfigError(name, value, f"from {low:g} to {high:g}")


def _design(numbers: FaceNumbers) -> PairDesign:
    """Return the pair with a sharp rack; radii and widths of its bodies are placeholders of one module."""
    m, coast = 1e-3 * numbers.module_mm, numbers.coast_pressure_angle_deg
    pinion = PinionGeometry(
        teeth=numbers.pinion_teeth,
        width=m,
        addendum=m * numbers.pinion_addendum_modules,
        dedendum=m * numbers.pinion_dedendum_modules,
        rack_tip_radius=0.0,
        bore_radius=m,
        profile_shift=m * numbers.profile_shift_modules,
    )
    gear = FaceGearGeometry(
        teeth=numbers.face_gear_teeth,
        inner_radius=m,
        outer_radius=m,
        addendum=m * numbers.gear_addendum_modules,
        rim_thickness=m,
    )
    shaper = Shaper(
        numbers.shaper_teeth or numbers.pinion_teeth + 3,
        m * numbers.shaper_addendum_modules,
        m * numbers.shaper_tip_rounding_modules,
    )
    return PairDesign(
        m,
        radians(numbers.pressure_angle_deg),
        pinion,
        gear,
        shaper,
        helix_angle=radians(numbers.helix_angle_deg),
        taper_angle=radians(numbers.taper_angle_deg),
        shaft_angle=radians(numbers.shaft_angle_deg),
        offset=1e-3 * numbers.offset_mm,
        coast_pressure_angle=None if coast in (0.0, numbers.pressure_angle_deg) else radians(coast),
    )
