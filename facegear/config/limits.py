"""The radii between which a gear's face may lie, from tooth numbers alone."""

from math import radians
from typing import Any

from facegear.errors import ConfigError
from facegear.geometry.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.geometry.limits import FaceRange, face_range, radius_limits
from facegear.geometry.validate import check_shaper


def limits_in_words(shaper_teeth: int, pinion_teeth: int, **pair_numbers: Any) -> str:
    """Describe both limits of the face radii in one line.

    Parameters
    ----------
    shaper_teeth : int
        Number of teeth of the shaper; 0: three more than the pinion.
    pinion_teeth : int
        Number of teeth of the pinion.
    **pair_numbers : Any
        The other arguments of `face_limits`.

    Returns
    -------
    str
        Both radii (mm) and what limits them.

    Raises
    ------
    ConfigError
        For numbers that no pair can have.
    """
    shaper = shaper_teeth or pinion_teeth + 3
    radii = face_limits(shaper_teeth=shaper, pinion_teeth=pinion_teeth, **pair_numbers)
    return f"face_gear radii in mm, with a shaper of {shaper} teeth: {radii}"


def face_limits(
    pinion_teeth: int,
    face_gear_teeth: int,
    module_mm: float,
    pressure_angle_deg: float,
    shaper_teeth: int,
    pinion_addendum_modules: float = 1.0,
    pinion_dedendum_modules: float = 1.25,
    profile_shift_modules: float = 0.0,
    gear_addendum_modules: float = 1.0,
    shaper_addendum_modules: float = 1.25,
    shaper_tip_rounding_modules: float = 0.0,
) -> FaceRange:
    """Compute the radii between which the face of a face gear may lie.

    Parameters
    ----------
    pinion_teeth : int
        Number of teeth of the pinion, 5 to 500.
    face_gear_teeth : int
        Number of teeth of the face gear, more than the pinion's, at most 2000.
    module_mm : float
        Module, 0.1 to 100 mm.
    pressure_angle_deg : float
        Pressure angle, 10 to 40 deg.
    shaper_teeth : int
        Number of teeth of the shaper.
    pinion_addendum_modules : float
        Addendum of the pinion in modules (unit 1).
    pinion_dedendum_modules : float
        Dedendum of the pinion in modules (unit 1).
    profile_shift_modules : float
        Profile shift of the pinion in modules (unit 1).
    gear_addendum_modules : float
        Addendum of the face gear in modules (unit 1).
    shaper_addendum_modules : float
        Addendum of the shaper in modules (unit 1).
    shaper_tip_rounding_modules : float
        Tip rounding of the shaper in modules (unit 1).

    Returns
    -------
    FaceRange
        Both radii (m) and what limits them.

    Raises
    ------
    ConfigError
        For numbers that no pair can have.
    """
    if not 5 <= pinion_teeth <= 500:
        raise ConfigError("pinion_teeth", pinion_teeth, "from 5 to 500")
    if not pinion_teeth < face_gear_teeth <= 2000:
        requirement = f"more than the pinion's {pinion_teeth}, at most 2000"
        raise ConfigError("face_gear_teeth", face_gear_teeth, requirement)
    if not 0.1 <= module_mm <= 100.0:
        raise ConfigError("module_mm", module_mm, "from 0.1 to 100")
    if not 10.0 <= pressure_angle_deg <= 40.0:
        raise ConfigError("pressure_angle_deg", pressure_angle_deg, "from 10 to 40")
    for name, value, low, high in (
        ("pinion_addendum_modules", pinion_addendum_modules, 0.1, 2.0),
        ("pinion_dedendum_modules", pinion_dedendum_modules, 0.1, 2.5),
        ("profile_shift_modules", profile_shift_modules, -1.0, 1.0),
        ("gear_addendum_modules", gear_addendum_modules, 0.1, 2.0),
        ("shaper_addendum_modules", shaper_addendum_modules, 0.1, 2.5),
        ("shaper_tip_rounding_modules", shaper_tip_rounding_modules, 0.0, 0.6),
    ):
        if not low <= value <= high:
            raise ConfigError(name, value, f"from {low:g} to {high:g}")
    m = 1e-3 * module_mm
    pinion = PinionGeometry(
        teeth=pinion_teeth,
        width=m,
        addendum=m * pinion_addendum_modules,
        dedendum=m * pinion_dedendum_modules,
        rack_tip_radius=0.0,
        bore_radius=m,
        profile_shift=m * profile_shift_modules,
    )
    gear = FaceGearGeometry(
        teeth=face_gear_teeth,
        inner_radius=m,
        outer_radius=m,
        addendum=m * gear_addendum_modules,
        rim_thickness=m,
    )
    tool = Shaper(shaper_teeth, m * shaper_addendum_modules, m * shaper_tip_rounding_modules)
    design = PairDesign(m, radians(pressure_angle_deg), pinion, gear, tool)
    check_shaper(design)
    return face_range(design, radius_limits(design))
