"""Wishes of a user for a machine to start from, and their limits."""

from dataclasses import dataclass, fields
from math import atan, degrees, floor, pi

from facegear.build.checks import STEEL, STRAIN_REASON, tooth_limit
from facegear.build.tooth_pair import ToothPair
from facegear.errors import ConfigError
from facegear.schema.base import Section
from facegear.schema.bodies import BearingStiffness, GearBody, PinionBody
from facegear.schema.tooth_pair import FaceGearSection, FlankAngles, PinionSection, ShaperSection
from facegear.schema.transmission import MAX_PINIONS, DampingSection
from facegear.teeth.design import PairDesign


@dataclass(frozen=True)
class ToothWishes:
    """Wishes of a user for the teeth; None leaves a choice.

    Names with a unit are keys of `tooth_pair`, lengths in modules or mm as these say.
    """

    pinion_teeth: int
    face_gear_teeth: int
    module_mm: float
    pressure_angle_deg: float = 25.0
    coast_pressure_angle_deg: float | None = None
    helix_angle_deg: float = 0.0
    taper_angle_deg: float = 0.0
    shaft_angle_deg: float = 90.0
    offset_mm: float = 0.0
    profile_shift_modules: float | None = None
    pinion_addendum_modules: float | None = None
    pinion_dedendum_modules: float | None = None
    rack_tip_radius_modules: float | None = None
    gear_addendum_modules: float | None = None
    shaper_teeth: int | None = None
    shaper_addendum_modules: float | None = None
    shaper_tip_rounding_modules: float | None = None
    thinning_um: float | None = None
    inner_radius_mm: float | None = None
    outer_radius_mm: float | None = None


@dataclass(frozen=True, kw_only=True)
class MachineWishes(ToothWishes):
    """Wishes of a user for a machine: teeth, equal driving pinions, one face gear or two with idlers.

    Parameters
    ----------
    case : str
        Name of the config.
    torque_n_m : float
        Torque of each driving pinion.
    speed_rpm : float
        Speed of the pinions.
    pinions, idlers : int
        Driving pinions; pinions that lead the power of a lower face gear to the upper one (0: no lower gear).
    coarse : bool
        Few positions, harmonics and speeds, for a first answer soon.

    Every other value is a number of the config; None leaves the choice.
    """

    case: str
    torque_n_m: float
    speed_rpm: float
    pinions: int = 1
    idlers: int = 0
    rim_thickness_mm: float | None = None
    pinion_width_mm: float | None = None
    pinion_bore_radius_mm: float | None = None
    pinion_mass_kg: float | None = None
    gear_mass_kg: float | None = None
    input_bearing_n_per_m: float | None = None
    idler_bearing_n_per_m: float | None = None
    gear_bearing_n_per_m: float | None = None
    axial_bearing_n_per_m: float | None = None
    mesh_damping_n_s_per_m: float | None = None
    coarse: bool = False

    @property
    def teeth(self) -> ToothWishes:
        """Wishes for the teeth alone, by which chosen teeth are cached."""
        return ToothWishes(**{part.name: getattr(self, part.name) for part in fields(ToothWishes)})


BOUNDS = {"torque_n_m": (1e-5, 1e6), "speed_rpm": (1.0, 1e5), "pinions": (1, MAX_PINIONS)}
"""Smallest and largest values; the config has loads and speeds beyond them."""
TORQUE_MARGINS = (0.7, 1.5)
"""Smallest and largest torque of the contact analysis over those of the meshes at rest."""
LEAST_SPRING = 1.0
"""Smallest radial stiffness, N/m, of a bearing: one without stiffness holds no body."""
SPRING = (BearingStiffness, "x")
"""Key of every bearing stiffness; the other axes have the same limits."""
FIELDS: dict[str, tuple[type[Section], str]] = {
    "helix_angle_deg": (ToothPair, "helix_angle_deg"),
    "taper_angle_deg": (ToothPair, "taper_angle_deg"),
    "shaft_angle_deg": (ToothPair, "shaft_angle_deg"),
    "offset_mm": (ToothPair, "offset_mm"),
    "coast_pressure_angle_deg": (FlankAngles, "coast"),
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
"""Section and key of the config whose limits each optional wish has."""


RADIAL = ("input_bearing_n_per_m", "idler_bearing_n_per_m", "gear_bearing_n_per_m")
"""Wishes for bearings that hold a body in the plane."""


def require_wishes(wishes: MachineWishes) -> None:
    """Check each wished number by itself against the limits of the config key that it becomes.

    Parameters
    ----------
    wishes : MachineWishes
        Values that a user gave; None leaves a choice.

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
    """Check that all pinions fit round the gear, the bore into the pinion, and that the teeth bear the
    torque.

    Parameters
    ----------
    wishes : MachineWishes
        Values that a user gave; None leaves a choice.
    design : PairDesign
        The teeth that were chosen for these wishes.

    Raises
    ------
    ConfigError
        For a number of pinions, a bore or a torque that is too large, with the largest one possible.
    """
    largest = tooth_limit(design, STEEL) / TORQUE_MARGINS[1]
    if wishes.torque_n_m > largest:
        raise ConfigError(
            "torque_n_m", wishes.torque_n_m, f"at most {largest:.4g} for these teeth: {STRAIN_REASON}"
        )
    bore, root = wishes.pinion_bore_radius_mm, 1e3 * smallest_root(design)
    if bore is not None and bore >= root:
        raise ConfigError("pinion_bore_radius_mm", bore, f"less than the root radius, {root:.4g}")
    width = design.pinion.width if wishes.pinion_width_mm is None else 1e-3 * wishes.pinion_width_mm
    inner_end = design.middle - 0.5 * width
    pinion_angle = 2.0 * atan(design.pinion_tip_radius / inner_end) if inner_end > 0.0 else pi
    count, largest_count = wishes.pinions + wishes.idlers, max(floor(2.0 * pi / pinion_angle), 1)
    if count > largest_count:
        key, value = ("pinions", wishes.pinions) if not wishes.idlers else ("pinions and idlers", count)
        pinion_text = f"each of which takes {degrees(pinion_angle):.4g} deg"
        raise ConfigError(key, value, f"at most {largest_count} round this gear, {pinion_text}")


def smallest_root(design: PairDesign) -> float:
    """Return the root radius of the pinion where it is smallest: of a tapered one at an end of its face.

    Parameters
    ----------
    design : PairDesign
        The pair.

    Returns
    -------
    float
        m.
    """
    return design.pinion_root_radius - 0.5 * design.pinion.width * abs(design.family.taper)


def _limits(section: type[Section], key: str) -> tuple[float, float]:
    """Return the smallest and the largest value that a key of a config section allows, in the key's unit."""
    metadata = section.model_fields[key].metadata
    low = next(limit.ge for limit in metadata if hasattr(limit, "ge"))
    high = next(limit.le for limit in metadata if hasattr(limit, "le"))
    return float(low), float(high)
