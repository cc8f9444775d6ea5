"""Plausibility of a config: values that module, teeth, face width and steel do not suggest.

A value counts as implausible where it lies a factor of 30 outside the expected range. It is no mistake, but
most often a wrong unit, and the note names the unit that would fit.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import cos, log, pi, radians, sqrt
from typing import Any

FAR = 30.0
"""Factor beyond the expected range from which a value is noted: units differ by 1000 or more."""
LARGEST = 1e100
"""Largest number that is looked at: no unit of a config comes near it."""
RIGID = 1e12
"""Stiffness, N/m, from which a spring stands for a rigid support: 1000 times a stiff tooth mesh."""
STEEL = 7850.0
"""Density of steel, kg/m3."""
MESH_STIFFNESS = 1.4e10
"""Stiffness of a steel mesh per metre of face, N/m2: the 14 N/(mm um) of ISO 6336-1 for spur gears."""
BEARINGS = (0.1, 10.0)
"""Usual stiffness of a bearing over that of a mesh; quill shafts and rigid supports stay within FAR of it."""
UNIT_LOAD = 50e6
"""Usual unit load F_t/(b m) of a mesh, Pa."""
USUAL_FACE_MODULES, RIM_MODULES, BACKLASH_MODULES, BORE = 6.5, 3.2, 0.04, 0.65
"""Usual face width, rim thickness and normal backlash in modules; bore radius over pitch radius."""
DAMPING_RATIO = 0.05
"""Usual damping of a mesh over its critical damping."""
ROUGHNESS_UM = 0.4
"""Usual roughness Ra of a ground flank."""

HALF_TURN = 180.0
"""Angle, deg, beyond which no number of a key in degrees was meant in rad."""
OTHER_UNITS: Mapping[str, Sequence[tuple[str, float]]] = {
    "_n_s_per_m": (("kN s/m", 1e3), ("N s/mm", 1e3)),
    "_n_m_per_rad": (("kN m/rad", 1e3),),
    "_n_per_m": (("N/mm", 1e3), ("N/um", 1e6)),
    "_n_m": (("kN m", 1e3), ("N mm", 1e-3)),
    "_kg_m2": (("kg cm2", 1e-4), ("kg mm2", 1e-6), ("g mm2", 1e-9)),
    "_kg": (("g", 1e-3), ("t", 1e3)),
    "_mm": (("m", 1e3), ("um", 1e-3)),
    "_um": (("mm", 1e3), ("m", 1e6), ("nm", 1e-3)),
    "_gpa": (("MPa", 1e-3), ("Pa", 1e-9)),
    "_mpa": (("GPa", 1e3), ("Pa", 1e-6)),
    "_deg": (("rad", 180.0 / pi),),
    "_rpm": (("Hz", 60.0), ("rad/s", 30.0 / pi)),
}
"""By the unit at the end of a key other units, and the factor from a number in them to the key's unit."""
UNITS = {
    "_n_s_per_m": "N s/m",
    "_n_per_m": "N/m",
    "_n_m": "N m",
    "_kg_m2": "kg m2",
    "_kg": "kg",
    "_mm": "mm",
    "_um": "um",
}
"""Units in words by the end of a key with an expected size."""


@dataclass(frozen=True)
class ExpectedSize:
    """Smallest and largest usual value of a dotted key, in the unit of the key."""

    key: str
    value: float
    low: float
    high: float


def plausibility_notes(values: Mapping[str, Any]) -> list[str]:
    """Return one line for every value that lies beyond FAR times its usual size, likely in a wrong unit.

    Parameters
    ----------
    values : mapping
        Plain values of a config; it may lack sections, or hold values that are refused elsewhere.

    Returns
    -------
    list of str
        Key, value, expected size with its unit, and the unit that was likely meant.
    """
    return [_note(size) for size in expected_sizes(values) if _is_far(size)]


def expected_sizes(values: Mapping[str, Any]) -> list[ExpectedSize]:
    """List the values of a config that have a usual size by its teeth, zeros left out.

    Parameters
    ----------
    values : mapping
        Plain values of a config, as of `plausibility_notes`.

    Returns
    -------
    list of ExpectedSize
        Key, value, and lower and upper usual size in the key's unit; empty without tooth numbers and
        module.
    """
    teeth = _Teeth.of_values(values)
    if teeth is None:
        return []
    sizes = [*_pair_sizes(values, teeth), *_contact_sizes(values, teeth), *_machine_sizes(values, teeth)]
    return [size for size in sizes if size.value != 0.0]


def unit_suggestion(key: str, value: float, low: float | None, high: float | None) -> str:
    """Suggest the unit in which a number, refused by its bounds, would lie between them.

    Parameters
    ----------
    key : str
        Dotted key that ends with its unit; what follows the unit, such as ``.x`` or ``[0]``, does not
        count.
    value : float
        The number, in the unit of the key.
    low, high : float or None
        Bounds, in the unit of the key; None for no bound.

    Returns
    -------
    str
        Text such as ``; is it in m?``, empty if no other unit fits.
    """
    suffix = _suffix(key, OTHER_UNITS)
    if suffix == "_deg" and high is None:
        high = HALF_TURN
    fitting = [
        (value * factor, unit)
        for unit, factor in OTHER_UNITS.get(suffix, ())
        if value > 0.0 and (low is None or value * factor >= low) and (high is None or value * factor <= high)
    ]
    if not fitting:
        return ""
    if low and high:  # the unit that comes nearest to the middle
        fitting.sort(key=lambda option: abs(log(option[0] / sqrt(low * high))))
    return f"; is it in {fitting[0][1]}?"


def _is_far(size: ExpectedSize) -> bool:
    """Whether a value lies beyond FAR times its usual range; stiffness from RIGID on counts as meant."""
    is_rigid = _suffix(size.key, UNITS) == "_n_per_m" and size.value >= RIGID
    return not is_rigid and not size.low / FAR <= abs(size.value) <= size.high * FAR


def _note(size: ExpectedSize) -> str:
    """Return a line with key, value, usual size and, if one fits, the unit that was likely meant."""
    unit = UNITS[_suffix(size.key, UNITS)]
    low, high = (f"{float(f'{bound:.2g}'):g}" for bound in (size.low, size.high))
    usual = low if low == high else f"{low} to {high}"
    likely = unit_suggestion(size.key, abs(size.value), size.low / FAR, size.high * FAR)
    return f"{size.key} = {size.value:g}: about {usual} {unit} would be usual for teeth of this size{likely}"


def _suffix(key: str, endings: Mapping[str, Any]) -> str:
    """Return which of the endings, such as `_mm`, one of the last two parts of a dotted key has; empty if
    none.
    """
    names = [part.partition("[")[0] for part in key.split(".")]
    for name in reversed(names[-2:]):
        for ending in endings:
            if name.endswith(ending):
                return ending
    return ""


@dataclass(frozen=True)
class _Teeth:
    """Sizes in SI units that all others are estimated from."""

    module: float
    pinion_radius: float
    gear_radius: float
    face: float
    cosine: float

    @classmethod
    def of_values(cls, values: Mapping[str, Any]) -> "_Teeth | None":
        """Return the teeth of a config in SI units; None where tooth numbers or module are missing or
        absurd.

        A face width far from USUAL_FACE_MODULES modules is replaced by that, a missing pressure angle by
        25 deg.
        """
        numbers = {
            key: _number(values, f"tooth_pair.{key}") or 0.0
            for key in ("module_mm", "pinion_teeth", "face_gear_teeth", "pressure_angle_deg")
        }
        module, pinion, gear, angle = numbers.values()
        if not (0.1 <= module <= 100.0 and 1.0 <= pinion <= 1e4 and 1.0 <= gear <= 1e4):
            return None
        module, angle = 1e-3 * module, angle if 0.0 < angle < 90.0 else 25.0
        ends = [
            1e-3 * (_number(values, f"tooth_pair.face_gear.{key}") or 0.0)
            for key in ("inner_radius_mm", "outer_radius_mm")
        ]
        usual, width = USUAL_FACE_MODULES * module, ends[1] - ends[0]
        face = width if usual / FAR <= width <= usual * FAR else usual
        return cls(module, 0.5 * module * pinion, 0.5 * module * gear, face, cos(radians(angle)))

    @property
    def mesh_stiffness(self) -> float:
        """Usual mesh stiffness of such teeth, N/m."""
        return MESH_STIFFNESS * self.face

    @property
    def mesh_torque(self) -> float:
        """Torque on the pinion, N m, that gives one mesh the usual unit load."""
        return UNIT_LOAD * self.face * self.module * self.pinion_radius

    @property
    def pinion(self) -> tuple[float, float]:
        """Mass (kg) and moment of inertia about the axis (kg m2) of a steel pinion without bore."""
        mass = STEEL * pi * self.pinion_radius**2 * (self.face + 2.0 * self.module)
        return mass, 0.5 * mass * self.pinion_radius**2

    @property
    def gear(self) -> tuple[float, float]:
        """Mass (kg) and moment of inertia about the axis (kg m2) of the toothed steel ring of a face
        gear.
        """
        height = (RIM_MODULES + 2.25) * self.module
        mass = STEEL * 2.0 * pi * self.gear_radius * self.face * height
        return mass, mass * self.gear_radius**2

    @property
    def damping(self) -> float:
        """Usual damping of a mesh, N s/m: DAMPING_RATIO of the critical one of pinion and gear on the
        mesh stiffness.
        """
        bodies = ((self.pinion, self.pinion_radius), (self.gear, self.gear_radius))
        mass = 1.0 / sum((self.cosine * radius) ** 2 / inertia for (_, inertia), radius in bodies)
        return 2.0 * DAMPING_RATIO * sqrt(self.mesh_stiffness * mass)


def _pair_sizes(values: Mapping[str, Any], teeth: _Teeth) -> Iterator[ExpectedSize]:
    """Yield values of sections tooth_pair and lubrication with their usual sizes, in the units of their
    keys.
    """
    module, radius = 1e3 * teeth.module, 1e3 * teeth.gear_radius
    yield from _sizes(
        values,
        {
            "tooth_pair.pinion.width_mm": USUAL_FACE_MODULES * module,
            "tooth_pair.pinion.bore_radius_mm": BORE * 1e3 * teeth.pinion_radius,
            "tooth_pair.pinion.thinning_um": 1e3 * BACKLASH_MODULES * module,
            "tooth_pair.face_gear.inner_radius_mm": radius,
            "tooth_pair.face_gear.outer_radius_mm": radius,
            "tooth_pair.face_gear.rim_thickness_mm": RIM_MODULES * module,
            "lubrication.pinion.ra_um": ROUGHNESS_UM,
            "lubrication.face_gear.ra_um": ROUGHNESS_UM,
        },
    )


def _contact_sizes(values: Mapping[str, Any], teeth: _Teeth) -> Iterator[ExpectedSize]:
    """Yield torques (N m) and stiffness (N/m) of one mesh with usual sizes; of a list the largest torque
    counts.
    """
    usual = {
        "mesh_stiffness.torque_n_m": teeth.mesh_torque,
        "mesh_stiffness.mean_n_per_m": teeth.mesh_stiffness,
    }
    yield from _sizes(values, usual)
    for row, harmonic in enumerate(_items(values, "mesh_stiffness.table")):
        mean = _number(harmonic, "cos_n_per_m")
        if harmonic.get("order") == 0 and mean is not None:
            key = f"mesh_stiffness.table[{row}].cos_n_per_m"
            yield ExpectedSize(key, mean, teeth.mesh_stiffness, teeth.mesh_stiffness)
    torques = _at(values, "contact.torques_n_m")
    if isinstance(torques, list | tuple) and torques and all(_is_number(torque) for torque in torques):
        key = f"contact.torques_n_m[{len(torques) - 1}]"
        yield ExpectedSize(key, float(torques[-1]), teeth.mesh_torque, teeth.mesh_torque)
    loads = [_number(load, "torque_n_m") or 0.0 for load in _items(values, "strength.duty")]
    if loads:
        key = f"strength.duty[{loads.index(max(loads))}].torque_n_m"
        yield ExpectedSize(key, max(loads), teeth.mesh_torque, teeth.mesh_torque)


def _machine_sizes(values: Mapping[str, Any], teeth: _Teeth) -> Iterator[ExpectedSize]:
    """Yield values of section transmission with their usual sizes, in the units of their keys."""
    machine = values.get("transmission")
    if not isinstance(machine, Mapping):
        return
    backlash = 1e6 * BACKLASH_MODULES * teeth.module
    yield from _sizes(
        values,
        {
            "transmission.backlash_um": backlash,
            "transmission.damping.mesh_n_s_per_m": teeth.damping,
            "transmission.torque.per_input_n_m": 2.0 * teeth.mesh_torque,
        },
    )
    for name in _names(machine, "single_meshes"):
        yield from _size(values, "transmission.single_meshes", (name, "backlash_um"), backlash)
    for number, pinion in enumerate(_items(values, "transmission.pinions")):
        torque = _number(pinion, "torque_n_m")
        if torque is not None:
            usual = 2.0 * teeth.mesh_torque
            yield ExpectedSize(f"transmission.pinions[{number}].torque_n_m", torque, usual, usual)
    bodies: list[tuple[tuple[str, ...], tuple[float, float]]]
    bodies = [(("pinion",), teeth.pinion), (("face_gear",), teeth.gear)]
    bodies += [(("single_pinions", name), teeth.pinion) for name in _names(machine, "single_pinions")]
    bodies += [(("single_gears", name), teeth.gear) for name in _names(machine, "single_gears")]
    for parts, (mass, inertia) in bodies:
        yield from _size(values, "transmission", (*parts, "mass_kg"), mass)
        yield from _size(values, "transmission", (*parts, "inertia_kg_m2"), inertia)
        for axis in "xyz":
            key = (*parts, "bearing_stiffness_n_per_m", axis)
            yield from _size(values, "transmission", key, *_spring(teeth))
    yield from _shaft_sizes(machine, teeth)


def _shaft_sizes(machine: Mapping[str, Any], teeth: _Teeth) -> Iterator[ExpectedSize]:
    """Yield radial and axial stiffness (N/m) of the bearings of shafts with its usual range."""
    for name in _names(machine, "shafts"):
        shaft = machine["shafts"][name]
        for number, bearing in enumerate(_items(shaft, "bearings") if isinstance(shaft, Mapping) else ()):
            for key in ("radial_n_per_m", "axial_n_per_m"):
                stiffness = _number(bearing, key)
                if stiffness is not None:
                    dotted = f"transmission.shafts.{name}.bearings[{number}].{key}"
                    yield ExpectedSize(dotted, stiffness, *_spring(teeth))


def _spring(teeth: _Teeth) -> tuple[float, float]:
    """Return the usual range of a bearing's stiffness, N/m: BEARINGS times the mesh stiffness."""
    soft, stiff = BEARINGS
    return soft * teeth.mesh_stiffness, stiff * teeth.mesh_stiffness


def _sizes(values: Mapping[str, Any], usual: Mapping[str, float]) -> Iterator[ExpectedSize]:
    """Yield the number at each dotted key of `usual` that the config gives, with its usual size."""
    for key, size in usual.items():
        value = _number(values, key)
        if value is not None:
            yield ExpectedSize(key, value, size, size)


def _size(
    values: Mapping[str, Any], section: str, parts: tuple[str, ...], low: float, high: float | None = None
) -> Iterator[ExpectedSize]:
    """Yield the number at a key below a section, if there is one, with its usual range from `low` to
    `high`.

    The parts of the key are separate, as names of pinions may hold dots. Without `high` the usual size is
    `low`.
    """
    inside: Any = _at(values, section)
    for part in parts:
        inside = inside.get(part) if isinstance(inside, Mapping) else None
    if _is_number(inside):
        yield ExpectedSize(".".join((section, *parts)), float(inside), low, low if high is None else high)


def _at(values: Mapping[str, Any], key: str) -> Any:
    """Return the value at a dotted key, None where it is absent."""
    inside: Any = values
    for part in key.split("."):
        inside = inside.get(part) if isinstance(inside, Mapping) else None
    return inside


def _number(values: Mapping[str, Any], key: str) -> float | None:
    """Return the number at a dotted key, None where there is none."""
    value = _at(values, key)
    return float(value) if _is_number(value) else None


def _is_number(value: Any) -> bool:
    """Whether a value is a plain number that is not absurdly large."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST


def _items(values: Mapping[str, Any], key: str) -> list[Mapping[str, Any]]:
    """Return the mappings in the list at a dotted key; an empty list where there is none."""
    items = _at(values, key)
    return [item for item in items if isinstance(item, Mapping)] if isinstance(items, list | tuple) else []


def _names(machine: Mapping[str, Any], key: str) -> list[str]:
    """Return the keys of the mapping at one key of a section, such as names of pinions; empty without
    one.
    """
    section = machine.get(key)
    return list(section) if isinstance(section, Mapping) else []
