"""Limits of what may be wished of a machine to start from, which are those of the config's keys."""

from math import atan, degrees, floor, pi

from facegear.config.base import Section
from facegear.config.bodies import BearingStiffness, GearBody, PinionBody
from facegear.config.checks import STEEL, STRAIN_REASON, tooth_limit
from facegear.config.tooth_pair import FaceGearSection, PinionSection, ShaperSection
from facegear.config.transmission import MAX_PINIONS, DampingSection
from facegear.errors import ConfigError
from facegear.geometry.design import PairDesign
from facegear.variants.starting_wishes import MachineWishes

BOUNDS = {"torque_n_m": (1e-5, 1e6), "speed_rpm": (1.0, 1e5), "pinions": (1, MAX_PINIONS)}
"""Smallest and largest values; the config has loads and speeds beyond them."""
TORQUE_MARGINS = (0.7, 1.5)
"""Smallest and largest torque of the contact analysis over those of the meshes at rest."""
LEAST_SPRING = 1.0
"""Smallest radial stiffness, N/m, of a bearing: one without stiffness holds no body."""
SPRING = (BearingStiffness, "x")
"""Key of every bearing stiffness; the other axes have the same limits."""
FIELDS: dict[str, tuple[type[Section], str]] = {
    "profile_shift_modules": (PinionSection, "profile_shift_modules"),
    "pinion_addendum_modules": (PinionSection, "addendum_modules"),
    "pinion_dedendum_modules": (PinionSection, "dedendum_modules"),
    "rack_tip_radius_modules": (PinionSection, "rack_tip_radius_modules"),
    "gear_addendum_modules": (FaceGearSection, "addendum_modules"),
    "shaper_teeth": (ShaperSection, "teeth"),
    "shaper_addendum_modules": (ShaperSection, "addendum_modules"),
    "shaper_tip_rounding_modules": (ShaperSection, "tip_rounding_modules"),
    "thinning_um": (PinionSection, "thinning_um"),
    "inner_radius_mm": (FaceGearSection, "inner_radius_mm"),
    "outer_radius_mm": (FaceGearSection, "outer_radius_mm"),
    "rim_thickness_mm": (FaceGearSection, "rim_thickness_mm"),
    "pinion_width_mm": (PinionSection, "width_mm"),
    "pinion_bore_radius_mm": (PinionSection, "bore_radius_mm"),
    "pinion_mass_kg": (PinionBody, "mass_kg"),
    "gear_mass_kg": (GearBody, "mass_kg"),
    "input_bearing_n_per_m": SPRING,
    "idler_bearing_n_per_m": SPRING,
    "gear_bearing_n_per_m": SPRING,
    "axial_bearing_n_per_m": SPRING,
    "mesh_damping_n_s_per_m": (DampingSection, "mesh_n_s_per_m"),
}
"""Section and key of the config that each optional wish becomes."""


RADIAL = ("input_bearing_n_per_m", "idler_bearing_n_per_m", "gear_bearing_n_per_m")
"""Wishes for bearings that hold a body in the plane."""


def require_wishes(wishes: MachineWishes) -> None:
    """Check each number that is wished by itself.

    Parameters
    ----------
    wishes : MachineWishes
        What a user gave.

    Raises
    ------
    ConfigError
        For the first number outside its limits, and for a wish without effect.
    """
    limits = {name: _limits(*field) for name, field in FIELDS.items()} | BOUNDS
    for name, (low, high) in limits.items():
        if name in RADIAL:
            low = LEAST_SPRING
        value = getattr(wishes, name)
        if value is not None and not low <= value <= high:
            raise ConfigError(name, value, f"from {low:g} to {high:g}")
    if wishes.idlers < 0:
        raise ConfigError("idlers", wishes.idlers, "0 or more")
    if wishes.pinions + wishes.idlers > MAX_PINIONS:
        largest_count = MAX_PINIONS - wishes.idlers
        raise ConfigError(
            "pinions", wishes.pinions, f"at most {largest_count}, with {wishes.idlers} idlers beside them"
        )
    if wishes.idler_bearing_n_per_m is not None and not wishes.idlers:
        raise ConfigError("idler_bearing_n_per_m", wishes.idler_bearing_n_per_m, "left out without idlers")


def require_room(wishes: MachineWishes, design: PairDesign) -> None:
    """Check that the pinions fit round the gear, the bore into the pinion, and the torque to the teeth.

    Parameters
    ----------
    wishes : MachineWishes
        What a user gave.
    design : PairDesign
        The teeth chosen for it.

    Raises
    ------
    ConfigError
        With the largest number that fits, or the largest torque.
    """
    largest = tooth_limit(design, STEEL) / TORQUE_MARGINS[1]
    if wishes.torque_n_m > largest:
        raise ConfigError(
            "torque_n_m", wishes.torque_n_m, f"at most {largest:.4g} for these teeth: {STRAIN_REASON}"
        )
    bore, root = wishes.pinion_bore_radius_mm, 1e3 * design.pinion_root_radius
    if bore is not None and bore >= root:
        raise ConfigError("pinion_bore_radius_mm", bore, f"less than the root radius, {root:.4g}")
    width = design.pinion.width if wishes.pinion_width_mm is None else 1e-3 * wishes.pinion_width_mm
    inner_end = design.mean_radius - 0.5 * width
    pinion_angle = 2.0 * atan(design.pinion_tip_radius / inner_end) if inner_end > 0.0 else pi
    count, largest_count = wishes.pinions + wishes.idlers, max(floor(2.0 * pi / pinion_angle), 1)
    if count > largest_count:
        key, value = ("pinions", wishes.pinions) if not wishes.idlers else ("pinions and idlers", count)
        pinion_text = f"each of which takes {degrees(pinion_angle):.4g} deg"
        raise ConfigError(key, value, f"at most {largest_count} round this gear, {pinion_text}")


def _limits(section: type[Section], key: str) -> tuple[float, float]:
    """Smallest and largest value that a key of the config allows."""
    metadata = section.model_fields[key].metadata
    low = next(limit.ge for limit in metadata if hasattr(limit, "ge"))
    high = next(limit.le for limit in metadata if hasattr(limit, "le"))
    return float(low), float(high)
