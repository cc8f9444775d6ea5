"""Wishes of a user for a machine to start from: what is known of it, and what may be chosen."""

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class ToothWishes:
    """Wishes of a user for the teeth; None leaves a choice.

    Names with a unit are keys of `tooth_pair`, lengths in modules or mm as these say.
    """

    pinion_teeth: int
    face_gear_teeth: int
    module_mm: float
    pressure_angle_deg: float = 25.0
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
        """The wishes for the teeth alone."""
        return ToothWishes(**{part.name: getattr(self, part.name) for part in fields(ToothWishes)})
