"""A config to start from: what a user knows of a gearbox, and rules of thumb for all that is left open."""

from dataclasses import dataclass
from importlib.resources import files
from math import cos, pi, radians
from string import Template

from facegear.config.limits import face_limits
from facegear.config.transmission import MAX_PINIONS
from facegear.errors import ConfigError

STEEL = 7850.0
"""Density, kg/m3."""
STIFFNESS = 1.4e10
"""Stiffness of a steel mesh per metre of face, N/m2: the 14 N/(mm um) of ISO 6336-1 for spur gears."""
DAMPING_RATIO = 0.05
"""Damping of a mesh over its critical damping."""
BEARING = 5.0
"""Stiffness of a bearing over that of a mesh."""
WIDEST = 8.0
"""Widest face that is chosen, in modules."""
BOUNDS = {"torque_n_m": (1e-5, 1e6), "speed_rpm": (1.0, 1e5), "pinions": (1, MAX_PINIONS)}
"""Smallest and largest values; the config has loads and speeds beyond them."""
WITHIN = 0.1
"""Part of the range of the face that is left free at either end."""


@dataclass(frozen=True)
class Known:
    """What is known of a machine: the equal pinions that drive it, and one face gear or two with idlers.

    - module_mm, pressure_angle_deg: of both gears
    - torque_n_m: of each driving pinion
    - speed_rpm: of the pinions
    - idlers: pinions that lead the power of a lower face gear to the upper one; 0: there is no lower gear
    - pinion_width_mm, pinion_bore_radius_mm, pinion_mass_kg, bearing_radial_n_per_m: of every pinion; None
      takes a rule of thumb
    - coarse: few positions, harmonics and speeds, for a first answer soon
    """

    case: str
    pinion_teeth: int
    face_gear_teeth: int
    module_mm: float
    torque_n_m: float
    speed_rpm: float
    pinions: int = 1
    pressure_angle_deg: float = 25.0
    idlers: int = 0
    pinion_width_mm: float | None = None
    pinion_bore_radius_mm: float | None = None
    pinion_mass_kg: float | None = None
    bearing_radial_n_per_m: float | None = None
    coarse: bool = False


def starting_config(known: Known) -> str:
    """The config as YAML text. Raises ConfigError for teeth that no pair can have, and for no load."""
    for key, (low, high) in BOUNDS.items():
        if not low <= getattr(known, key) <= high:
            raise ConfigError(key, getattr(known, key), f"from {low:g} to {high:g}")
    if known.idlers < 0:
        raise ConfigError("idlers", known.idlers, "0 or more")
    if known.pinions + known.idlers > MAX_PINIONS:
        allowed = f"at most {MAX_PINIONS} together with the {known.idlers} idlers"
        raise ConfigError("pinions", known.pinions, allowed)
    inner, outer, allowed = _face(known)
    module, speed = known.module_mm, known.speed_rpm
    torque = known.torque_n_m / len(_gears(known))
    width, rim = known.pinion_width_mm or outer - inner + 2.0 * module, 3.2 * module
    bore = known.pinion_bore_radius_mm or 0.65 * module * (0.5 * known.pinion_teeth - 1.25)
    pinion = _ring(0.5 * module * known.pinion_teeth, bore, width)
    if known.pinion_mass_kg is not None:
        pinion = (known.pinion_mass_kg, pinion[1] * known.pinion_mass_kg / pinion[0])
    gear = _ring(outer, inner, rim + 2.25 * module)
    stiffness = STIFFNESS * 1e-3 * (outer - inner)
    positions, kept, points, cycles = (8, 3, 12, 50) if known.coarse else (32, 8, 200, 200)
    template = Template((files("facegear.config") / "starting.yaml").read_text(encoding="utf-8"))
    return template.substitute(
        **{name: f"{value:.10g}" for name, value in vars(known).items() if isinstance(value, int | float)}
        | {"case": known.case, "pinions": _pinions(known), "gears": ", ".join(_gears(known))},
        inner=f"{inner:.6g}",
        outer=f"{outer:.6g}",
        allowed=allowed,
        rim=f"{rim:.4g}",
        width=f"{width:.4g}",
        bore=f"{bore:.4g}",
        shaper=known.pinion_teeth + 3,
        pinion_body=_body(pinion),
        gear_body=_body(gear),
        percent=f"{100 * DAMPING_RATIO:g}",
        bearing=_bearing(BEARING * stiffness),
        pinion_bearing=_bearing(known.bearing_radial_n_per_m or BEARING * stiffness),
        damping=f"{_damping(known, stiffness, pinion[1], gear[1]):.4g}",
        input_torque=f"{known.torque_n_m:.10g}",
        torque=f"{torque:.10g}",
        torques=", ".join(f"{factor * torque:.10g}" for factor in (1.0, 1.5, 2.0)),
        speed=f"{speed:.10g}",
        slow=f"{max(0.2 * speed, 1.0):.6g}",
        fast=f"{1.5 * speed:.6g}",
        positions=positions,
        kept=kept,
        points=points,
        cycles=cycles,
    )


def _face(known: Known) -> tuple[float, float, str]:
    """Inner and outer radius of the face (mm), and between which radii it may lie in words."""
    limits = face_limits(
        pinion_teeth=known.pinion_teeth,
        face_gear_teeth=known.face_gear_teeth,
        module_mm=known.module_mm,
        pressure_angle_deg=known.pressure_angle_deg,
        shaper_teeth=known.pinion_teeth + 3,
    )
    smallest, largest = 1e3 * limits.inner, 1e3 * limits.outer
    free = WITHIN * (largest - smallest)
    width = min(largest - smallest - 2.0 * free, WIDEST * known.module_mm)
    centre = 0.5 * known.module_mm * known.face_gear_teeth
    inner = min(max(centre - 0.5 * width, smallest + free), largest - free - width)
    return inner, inner + width, f"{smallest:.4g} to {largest:.4g}"


def _ring(outer_mm: float, inner_mm: float, width_mm: float) -> tuple[float, float]:
    """Mass (kg) and inertia (kg m2) of a steel ring."""
    outer, inner, width = 1e-3 * outer_mm, 1e-3 * inner_mm, 1e-3 * width_mm
    mass = STEEL * pi * (outer**2 - inner**2) * width
    return mass, 0.5 * mass * (outer**2 + inner**2)


def _body(ring: tuple[float, float]) -> str:
    return f"mass_kg: {ring[0]:.4g}, inertia_kg_m2: {ring[1]:.4g}"


def _damping(known: Known, stiffness: float, pinion: float, gear: float) -> float:
    """Damping of a mesh, N s/m, from the inertias that it couples (kg m2)."""
    base = 0.5e-3 * known.module_mm * known.pinion_teeth * cos(radians(known.pressure_angle_deg))
    ratio = known.face_gear_teeth / known.pinion_teeth
    mass = 1.0 / (base**2 / pinion + (base * ratio) ** 2 / gear)
    return float(2.0 * DAMPING_RATIO * (stiffness * mass) ** 0.5)


def _bearing(stiffness: float) -> str:
    return "{" + ", ".join(f"{axis}: {stiffness:.3g}" for axis in "xyz") + "}"


def _gears(known: Known) -> tuple[str, ...]:
    """Face gears; idlers need two."""
    return ("lower", "upper") if known.idlers else ("upper",)


def _pinions(known: Known) -> str:
    """The pinions, evenly around the gear and the roles among each other.

    Between two gears they stand at whole halves of a pitch, where the teeth of both fit.
    """
    count = known.pinions + known.idlers
    listed, numbers = [], {"input": 0, "idler": 0}
    for number in range(count):
        drives = (number + 1) * known.pinions // count > number * known.pinions // count
        role = "input" if drives else "idler"
        numbers[role] += 1
        if known.idlers:
            where = f"angle_pitches: {round(2.0 * known.face_gear_teeth * number / count) / 2.0:g}"
        else:
            where = f"angle_deg: {360.0 * number / count:.9g}"
        listed.append(f"{{name: {role} {numbers[role]}, role: {role}, {where}}}")
    return ", ".join(listed)
