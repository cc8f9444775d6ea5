"""The config of a machine to start from, with a choice and its reason for all that is not wishes."""

from copy import deepcopy
from functools import cached_property
from importlib.resources import files
from math import ceil, cos, pi, radians, sin, sqrt
from pathlib import Path
from string import Template
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from facegear.build.config import resolved_values
from facegear.build.load import config_of
from facegear.build.machine import MachineInputs
from facegear.build.plans import mesh_sizes
from facegear.contact.resolution import COARSEST, half_width
from facegear.errors import FacegearError
from facegear.harmonics import Harmonics
from facegear.machine.machine import Machine
from facegear.new_machine.bearings import STIFF, Bearings, round_stiffness
from facegear.new_machine.grades import cumulative_pitch_um, position_um
from facegear.new_machine.teeth import MORE_SHAPER_TEETH, choose_teeth, chosen_keys
from facegear.new_machine.wishes import RADIAL, TORQUE_MARGINS, MachineWishes, smallest_root
from facegear.number_format import count_noun
from facegear.schema.contact import Mesh
from facegear.schema.yaml_file import read_yaml
from facegear.sharing.closed_form import SplitMachine
from facegear.teeth.design import Material

STEEL = 7850.0
"""Density of steel, kg/m3."""
STIFFNESS = 1.4e10
"""Stiffness of a steel mesh per metre of face, N/m2: the 14 N/(mm um) of ISO 6336-1 for spur gears."""
DAMPING_RATIO = 0.05
"""Damping of a mesh over its critical damping: within the usual 0.03 to 0.1."""
RIM = 3.2
"""Thickness of the face gear's rim in modules."""
BORE = 0.65
"""Bore of a pinion over its root radius."""
LEFT_ABOVE_BORE = 0.8
"""Least thickness, in modules, between bore and root of a pinion."""
GOLDEN_DEG = 137.508
"""Angle between the directions of the errors of one pinion and the next, so that no two are alike."""
SPEEDS = (0.2, 1.5)
"""First and last speed of the sweep over the nominal one."""
TORQUES = 4
"""Torques of the contact analysis."""
PROFILE_CUTS = 3
"""Cuts across the profile where the lightest torque asks for no more: the default of contact.refinement."""
MOST_CUTS = 32
"""Largest number of cuts that contact.refinement takes."""
KIND_VALUES = {
    "helix_angle_deg": 0.0,
    "taper_angle_deg": 0.0,
    "shaft_angle_deg": 90.0,
    "offset_mm": 0.0,
}
"""Keys that a config has only where they differ from these values of spur teeth."""
MATERIAL = Material(206e9, 0.3)
"""Steel."""


class Draft:
    """The numbers of a machine whose bearings are still open."""

    def __init__(self, wishes: MachineWishes, more_shaper_teeth: int = MORE_SHAPER_TEETH[0]) -> None:
        self.wishes = wishes
        self.more_shaper_teeth = more_shaper_teeth
        self.teeth = choose_teeth(wishes.teeth, more_shaper_teeth)
        design, module = self.teeth.design, wishes.module_mm
        root = 1e3 * smallest_root(design)
        self.values = chosen_keys(self.teeth)
        self.values["rim_thickness_mm"] = round(RIM * module, 4)
        self.values["pinion_bore_radius_mm"] = round(min(BORE * root, root - LEFT_ABOVE_BORE * module), 4)
        self._take("rim_thickness_mm", "pinion_bore_radius_mm", "pinion_width_mm")
        self.inner, self.outer = self.values["inner_radius_mm"], self.values["outer_radius_mm"]
        radius = 1e3 * design.pinion_pitch_radius
        pinion = _ring(radius, self.values["pinion_bore_radius_mm"], self.values["pinion_width_mm"])
        gear = _ring(self.outer, self.inner, self.values["rim_thickness_mm"] + 2.25 * module)
        self.values |= {"pinion_mass_kg": _short(pinion[0]), "gear_mass_kg": _short(gear[0])}
        self._take("pinion_mass_kg", "gear_mass_kg")
        self.pinion_inertia = pinion[1] * self.values["pinion_mass_kg"] / pinion[0]
        self.gear_inertia = gear[1] * self.values["gear_mass_kg"] / gear[0]
        self.stiffness = STIFFNESS * 1e-3 * (self.outer - self.inner)
        self.values["mesh_damping_n_s_per_m"] = _short(self._damping())
        self._take("mesh_damping_n_s_per_m")

    def _take(self, *names: str) -> None:
        """Replace chosen values by the user's wishes of the same names, where they are given, in place."""
        wished = {name: getattr(self.wishes, name) for name in names}
        self.values |= {name: value for name, value in wished.items() if value is not None}

    def _damping(self) -> float:
        """Return the damping of a mesh, N s/m: DAMPING_RATIO times its critical damping.

        The mass is the effective one of pinion and gear along the line of action, the stiffness the
        estimated one.
        """
        base = self.teeth.design.normal_arm
        ratio = self.wishes.face_gear_teeth / self.wishes.pinion_teeth
        mass = 1.0 / (base**2 / self.pinion_inertia + (base * ratio) ** 2 / self.gear_inertia)
        return 2.0 * DAMPING_RATIO * sqrt(self.stiffness * mass)

    def closed_form(self) -> SplitMachine:
        """Return the numbers that load sharing without errors depends on.

        Returns
        -------
        SplitMachine
            Equal inputs and idlers, force of an input (N), estimated mesh stiffness (N/m) and backlash
            (m).
        """
        design = self.teeth.design
        return SplitMachine(
            inputs=self.wishes.pinions,
            idlers=self.wishes.idlers,
            input_force=self.wishes.torque_n_m / design.normal_arm,
            mesh_stiffness=self.stiffness,
            backlash=design.pinion.thinning,
            idler_push=2.0 * cos(design.pressure_angle) * cos(design.helix_angle),
        )

    def stiff_bearings(self) -> Bearings:
        """Return the bearings of a machine that splits no load: as given, else STIFF times as stiff as a
        mesh.

        Returns
        -------
        Bearings
            Radial stiffness, N/m.
        """
        stiff, wishes = round_stiffness(STIFF * self.stiffness), self.wishes
        bearing_wishes = (getattr(wishes, name) for name in RADIAL)
        return Bearings(*(stiff if stiffness is None else stiffness for stiffness in bearing_wishes))

    def machine(self, bearings: Bearings) -> Machine:
        """Build the lumped machine with these bearings and a constant, estimated mesh stiffness.

        Parameters
        ----------
        bearings : Bearings
            Radial stiffness of the bearings of inputs, idlers and gears, N/m.

        Returns
        -------
        Machine
            Machine with the draft's errors of bodies, without transmission error.
        """
        values = deepcopy(self.values_of_config)
        transmission = values["transmission"]
        transmission["pinion"]["bearing_stiffness_n_per_m"] |= self._spring_values(bearings.inputs)
        transmission["face_gear"]["bearing_stiffness_n_per_m"] |= dict.fromkeys("xyz", bearings.gears)
        for single in transmission["single_pinions"].values():
            if single["bearing_stiffness_n_per_m"] is not None:
                single["bearing_stiffness_n_per_m"] |= self._spring_values(bearings.idlers)
        return MachineInputs.of_config(values, Harmonics(np.zeros(1), np.array([self.stiffness]))).build()

    @cached_property
    def values_of_config(self) -> dict[str, Any]:
        """Plain values of the validated config with stiff bearings and no transmission error, for
        estimates.
        """
        torque = self.wishes.torque_n_m
        with TemporaryDirectory() as folder:
            path = Path(folder) / "draft.yaml"
            path.write_text(self.text(self.stiff_bearings(), (0.5 * torque, torque)), encoding="utf-8")
            values = read_yaml(path)
        # Conjugate flanks have no e(t) without load, and no contact analysis is made for an estimate.
        values["transmission"]["transmission_error"] = {"amplitude_um": 0}
        return resolved_values(config_of(values))

    def _spring_values(self, radial: float) -> dict[str, float]:
        """Return bearing stiffness along x, y and z, N/m: radial along x and y, along z the wish for it.

        Without a wish it is the same for spur teeth, and STIFF times that of a mesh for others, which push
        the pinion along its axis.
        """
        axial = self.wishes.axial_bearing_n_per_m
        if axial is None:
            axial = radial if self.teeth.design.is_spur else round_stiffness(STIFF * self.stiffness)
        return {"x": radial, "y": radial, "z": axial}

    def text(self, bearings: Bearings, loads: tuple[float, float]) -> str:
        """Return the config as YAML text, each choice with a comment that gives its reason.

        Parameters
        ----------
        bearings : Bearings
            Radial stiffness of the bearings of inputs, idlers and gears, N/m.
        loads : tuple of two floats
            Smallest and largest torque on a pinion by a mesh at rest, N m; the contact analysis covers
            both.

        Returns
        -------
        str
            Text of the config file.
        """
        wishes = self.wishes
        positions, harmonics, points, cycles = (8, 3, 12, 50) if wishes.coarse else (32, 8, 200, 200)
        low, high = TORQUE_MARGINS[0] * loads[0], TORQUE_MARGINS[1] * loads[1]
        torques = [float(f"{torque:.4g}") for torque in np.geomspace(low, high, TORQUES)]
        template = Template((files("facegear.new_machine") / "starting.yaml").read_text(encoding="utf-8"))
        return template.substitute(
            {name: f"{value:.10g}" for name, value in self.values.items()}
            | {f"why_{name}": reason for name, reason in self._reasons().items()},
            case=wishes.case,
            pinion_teeth=wishes.pinion_teeth,
            face_gear_teeth=wishes.face_gear_teeth,
            module_mm=f"{wishes.module_mm:.10g}",
            pressure_angle_deg=self._pressure_angles(),
            kind=self._kind(),
            middle=self._middle(),
            torques=", ".join(f"{torque:g}" for torque in torques),
            refinement=self._refinement(torques[0]),
            positions=positions,
            kept=harmonics,
            points=points,
            mesh_torque=f"{loads[1]:.4g}",
            duty_torque=f"{loads[1]:.4g}",
            pinions=_pinions(wishes),
            gears=", ".join(_gears(wishes)),
            pinion_inertia=_text(self.pinion_inertia),
            gear_inertia=_text(self.gear_inertia),
            input_bearing=self._bearing(bearings.inputs),
            gear_bearing="{" + ", ".join(f"{axis}: {bearings.gears:.3g}" for axis in "xyz") + "}",
            gear_runout=self._runout(2e3 * self._gear_pitch_radius(), 0.0),
            single_pinions=self._single_pinions(bearings),
            input_torque=f"{wishes.torque_n_m:.10g}",
            speed=f"{wishes.speed_rpm:.10g}",
            load_sharing=self._load_sharing(cycles, points),
            slow=f"{max(SPEEDS[0] * wishes.speed_rpm, 1.0):.6g}",
            fast=f"{SPEEDS[1] * wishes.speed_rpm:.6g}",
        )

    def _pressure_angles(self) -> str:
        """Return the pressure angles as text of the config: one number, or one for each flank."""
        drive, coast = self.wishes.pressure_angle_deg, self.wishes.coast_pressure_angle_deg
        if coast in (None, drive):
            return f"{drive:.10g}"
        return f"{{drive: {drive:.10g}, coast: {coast:.10g}}}"

    def _kind(self) -> str:
        """Return the keys that make teeth other than spur ones as text of the config, each on its line."""
        values = {name: getattr(self.wishes, name) for name in KIND_VALUES}
        return "".join(
            f"  {name}: {value:.10g}\n" for name, value in values.items() if value != KIND_VALUES[name]
        )

    def _middle(self) -> str:
        """Return the key of the pinion's middle as text of the config; empty for spur teeth."""
        middle = self.values.get("pinion_middle_mm")
        return (
            ""
            if middle is None
            else f"    middle_mm: {middle:.10g} # chosen: above the middle of the gear's face\n"
        )

    def _load_sharing(self, cycles: int, points: int) -> str:
        """Return section load_sharing as text of the config: empty for a machine of one pinion, which
        shares no load.

        `cycles` are mesh cycles of the hunting cycle, `points` speeds over the range of the sweep.
        """
        if self.wishes.pinions + self.wishes.idlers == 1:
            return ""
        slow, fast = (factor * self.wishes.speed_rpm for factor in SPEEDS)
        speeds = f"{{from_rpm: {max(slow, 1.0):.6g}, to_rpm: {fast:.6g}, points: {points}}}"
        return f"load_sharing: {{cycles: {cycles}, speed_range: {speeds}}}"

    def _refinement(self, torque: float) -> int:
        """Return how many cuts across the profile resolve the contact strip at a torque on the pinion, N
        m.

        There are at least PROFILE_CUTS. Raises FacegearError where more than MOST_CUTS would be needed,
        with the torque that is enough.
        """
        design = self.teeth.design
        strip = half_width(design, (MATERIAL, MATERIAL), 0.99 * torque)
        profile = mesh_sizes(Mesh(), design.module).profile
        cuts = max(PROFILE_CUTS, ceil(profile / (2.0 * COARSEST * strip)))
        if cuts > MOST_CUTS:
            least = self.wishes.torque_n_m * (cuts / MOST_CUTS) ** 2
            raise FacegearError(
                f"torque_n_m = {self.wishes.torque_n_m:g}: the contact analysis cannot resolve so light "
                f"a load; nearest: {least:.3g}"
            )
        return cuts

    def _gear_pitch_radius(self) -> float:
        """Return the pitch radius of the face gear, m."""
        return self.teeth.design.family.gear_pitch_radius

    def _bearing(self, radial: float) -> str:
        """Return a bearing with this radial stiffness, N/m, as text of the config."""
        springs = self._spring_values(radial)
        return "{" + ", ".join(f"{axis}: {stiffness:.3g}" for axis, stiffness in springs.items()) + "}"

    def _runout(self, diameter_mm: float, phase_deg: float) -> str:
        """Return the runout of a body as text of a further key of the config; empty for machines without
        idlers.

        Its eccentricity is half the cumulative pitch deviation of grade 5 at this pitch diameter.
        """
        if not self.wishes.idlers:
            return ""
        eccentricity = 0.5 * cumulative_pitch_um(diameter_mm, self.wishes.module_mm)
        return f", runout: {{eccentricity_um: {eccentricity:.3g}, phase_deg: {phase_deg:.4g}}}"

    def _single_pinions(self, bearings: Bearings) -> str:
        """Return section single_pinions as text of the config: bearings of idlers, positions, runouts.

        Directions of the errors turn by GOLDEN_DEG from pinion to pinion. The text is empty without
        idlers.
        """
        if not self.wishes.idlers:
            return ""
        away = position_um(self._gear_pitch_radius())
        lines = ["  single_pinions: # chosen: bores inside grade IT5, runouts of ISO 1328-1 grade 5\n"]
        diameter = 2e3 * self.teeth.design.pinion_pitch_radius
        for number, (name, role) in enumerate(_pinion_roles(self.wishes)):
            angle = GOLDEN_DEG * number % 360.0
            x, y = away * cos(radians(angle)), away * sin(radians(angle))
            bearing = (
                "" if role == "input" else f"bearing_stiffness_n_per_m: {self._bearing(bearings.idlers)}, "
            )
            lines.append(
                f"    {name}: {{{bearing}position_um: {{x: {x:.1f}, y: {y:.1f}}}"
                f"{self._runout(diameter, angle)}}}\n"
            )
        return "".join(lines)

    def _shaper_reason(self) -> str:
        """Return why the shaper has its number of teeth, in words."""
        if self.more_shaper_teeth == MORE_SHAPER_TEETH[0]:
            return "three more than the pinion, which localises the contact"
        count = count_noun(self.more_shaper_teeth, "tooth", "teeth")
        return f"{count} more than the pinion, which spreads the contact: pitting allows no more"

    def _reasons(self) -> dict[str, str]:
        """Return the reason of each chosen value of the config by its name; `given` for a user's wish."""
        low, high = (1e3 * radius for radius in self.teeth.face_limits)
        limits = "undercut and pointed tips" if self.teeth.design.is_spur else "the limits of both flanks"
        face = f"chosen within {low:.4g} to {high:.4g} mm, between {limits}"
        soft = "; soft bearings let the inputs share between both gears" if self.wishes.idlers else ""
        reasons = {
            "pinion_width_mm": "chosen: a module wider than the gear's face at either end",
            "pinion_addendum_modules": "chosen: the highest teeth that clear each other",
            "pinion_dedendum_modules": "chosen: clearance for the gear's tips",
            "rack_tip_radius_modules": "chosen: a round fillet",
            "profile_shift_modules": "chosen: the smallest without undercut",
            "thinning_um": "chosen: a backlash of 0.04 modules",
            "pinion_bore_radius_mm": "chosen: 0.65 of the root radius at most",
            "inner_radius_mm": face,
            "outer_radius_mm": face,
            "gear_addendum_modules": "chosen: tips that clear the pinion's fillet",
            "rim_thickness_mm": "chosen: 3.2 modules",
            "shaper_teeth": f"chosen: {self._shaper_reason()}",
            "shaper_addendum_modules": "chosen: root clearance of 0.25 modules",
            "shaper_tip_rounding_modules": "chosen: a fillet without a corner, which can be rated",
            "mesh_damping_n_s_per_m": f"chosen: {100 * DAMPING_RATIO:g} % of the critical damping of a mesh",
        }
        reasons |= {name: "given" for name in reasons if getattr(self.wishes, name, None) is not None}
        return {
            **reasons,
            "pinion": f"chosen: a steel ring{soft}",
            "gear": f"chosen: a steel rim, bearings {STIFF:g} times as stiff as a mesh",
        }


def _ring(outer_mm: float, inner_mm: float, width_mm: float) -> tuple[float, float]:
    """Return mass (kg) and moment of inertia about the axis (kg m2) of a steel ring with these radii and
    width.
    """
    outer, inner, width = 1e-3 * outer_mm, 1e-3 * inner_mm, 1e-3 * width_mm
    mass = STEEL * pi * (outer**2 - inner**2) * width
    return mass, 0.5 * mass * (outer**2 + inner**2)


def _short(value: float) -> float:
    """Round a number to four significant digits."""
    return float(f"{value:.4g}")


def _text(value: float) -> str:
    """Return a number as text with four significant digits."""
    return f"{value:.4g}"


def _gears(wishes: MachineWishes) -> tuple[str, ...]:
    """Return the sides of the face gears that the machine needs: lower and upper with idlers, else upper
    alone.
    """
    return ("lower", "upper") if wishes.idlers else ("upper",)


def _pinion_roles(wishes: MachineWishes) -> list[tuple[str, str]]:
    """Return name and role of each pinion in the order of their angles.

    Roles are `input` and `idler`, spread as evenly as their numbers allow; names number them, such as
    `idler 2`.
    """
    count = wishes.pinions + wishes.idlers
    roles, numbers = [], {"input": 0, "idler": 0}
    for number in range(count):
        drives = (number + 1) * wishes.pinions // count > number * wishes.pinions // count
        role = "input" if drives else "idler"
        numbers[role] += 1
        roles.append((f"{role} {numbers[role]}", role))
    return roles


def _pinions(wishes: MachineWishes) -> str:
    """Return the pinions as text of the config's list: name, role and angle, evenly around the gear.

    Between two gears they stand at whole halves of a pitch, where the teeth of both fit.
    """
    entries, count = [], wishes.pinions + wishes.idlers
    for number, (name, role) in enumerate(_pinion_roles(wishes)):
        if wishes.idlers:
            angle = f"angle_pitches: {round(2.0 * wishes.face_gear_teeth * number / count) / 2.0:g}"
        else:
            angle = f"angle_deg: {360.0 * number / count:.9g}"
        entries.append(f"{{name: {name}, role: {role}, {angle}}}")
    return ", ".join(entries)
