"""Numbers of the tooth pair that a machine needs, in SI."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from facegear.machine.mesh_frames import ToothKind
from facegear.schema.changes import TEETH
from facegear.schema.tooth_pair import face_middle_mm, flank_angles_deg
from facegear.teeth.design import PairDesign
from facegear.teeth.tooth_family import Rack

SPUR = {"helix_angle_deg": 0.0, "taper_angle_deg": 0.0, "shaft_angle_deg": 90.0, "offset_mm": 0.0}
"""Values of spur teeth at right angles, by key of section `tooth_pair`."""


@dataclass(frozen=True)
class ToothNumbers:
    """Numbers of the tooth pair that the lumped model needs.

    pinion_arm: torque on the pinion over the force along the drive flank's normal, m, the base radius of spur
    teeth. pressure_angle: of the drive flank in the normal section, rad. kind: what else there is to know of
    teeth that are not spur teeth at right angles. middle: place of the middle of the face of spur pinions
    along their axes, m; None where it is not known, and with a kind, which knows it.
    """

    pinion_teeth: int
    gear_teeth: int
    pinion_arm: float
    pressure_angle: float
    kind: ToothKind | None = None
    middle: float | None = None

    @property
    def pitch_radius(self) -> float:
        """Pitch radius of the pinion, m."""
        if self.kind is not None:
            return self.kind.pitch_radius
        return self.pinion_arm / float(np.cos(self.pressure_angle))

    @classmethod
    def of_config(cls, values: Mapping[str, Any]) -> Self:
        """Return the tooth numbers from plain config values.

        Parameters
        ----------
        values : Mapping[str, Any]
            Section `tooth_pair`, or its keys TEETH with `middle_mm` of the pinion.

        Returns
        -------
        Self
            Tooth numbers in SI units.
        """
        sizes = {key: values[key] for key in ("pinion_teeth", "face_gear_teeth", "module_mm")}
        drive, coast = flank_angles_deg(values["pressure_angle_deg"])
        spur = cls.of_teeth(**sizes, pressure_angle_deg=drive)
        values_of_kind = {key: values.get(key, spur_value) for key, spur_value in SPUR.items()}
        if drive == coast and values_of_kind == SPUR:
            return replace(spur, middle=_middle(values))
        *degrees, offset_mm = values_of_kind.values()
        coast_angle, helix, taper, shaft = np.radians([coast, *degrees]).tolist()
        return spur.with_kind(
            ToothKind(
                spur.pinion_teeth,
                spur.gear_teeth,
                Rack(1e-3 * values["module_mm"], (spur.pressure_angle, coast_angle), helix, taper),
                shaft,
                1e-3 * offset_mm,
                _middle(values),
            )
        )

    @classmethod
    def of_design(cls, design: PairDesign) -> Self:
        """Return the tooth numbers of a pair.

        Parameters
        ----------
        design : PairDesign
            Pair of gears.

        Returns
        -------
        Self
            Tooth numbers in SI units.
        """
        teeth = design.pinion.teeth, design.face_gear.teeth
        numbers = cls(*teeth, design.normal_arm, design.pressure_angle)
        if design.is_spur:
            return replace(numbers, middle=design.middle)
        axes = design.shaft_angle, design.offset, design.middle
        return numbers.with_kind(ToothKind(*teeth, design.family.rack, *axes))

    def with_kind(self, kind: ToothKind) -> Self:
        """Return the numbers of teeth that are not spur teeth at right angles.

        Parameters
        ----------
        kind : ToothKind
            The teeth.

        Returns
        -------
        Self
            The same numbers with this kind and its arm.
        """
        return replace(self, kind=kind, pinion_arm=kind.normal_arms[0])

    @classmethod
    def of_teeth(
        cls, pinion_teeth: int, face_gear_teeth: int, module_mm: float, pressure_angle_deg: float
    ) -> Self:
        """Return the tooth numbers of spur teeth from the values of the keys TEETH.

        Parameters
        ----------
        pinion_teeth : int
            Number of teeth of each pinion.
        face_gear_teeth : int
            Number of teeth of each face gear.
        module_mm : float
            Module, mm.
        pressure_angle_deg : float
            Pressure angle, deg.

        Returns
        -------
        Self
            Tooth numbers, base radius of the pinion m N1 cos(alpha) / 2 (m) and pressure angle alpha
            (rad).
        """
        angle = float(np.radians(pressure_angle_deg))
        base_radius = 0.5e-3 * module_mm * pinion_teeth * float(np.cos(angle))
        return cls(pinion_teeth, face_gear_teeth, base_radius, angle)


def _middle(values: Mapping[str, Any]) -> float | None:
    """Return the place of the middle of the pinion's face along its axis, m, from section `tooth_pair`, or
    from `middle_mm` beside its keys TEETH; None where it is not known.
    """
    if "middle_mm" in values or "face_gear" not in values:
        middle = values.get("middle_mm")
    else:
        middle = face_middle_mm(values)
    return None if middle is None else 1e-3 * middle


def machine_teeth(tooth_pair: Mapping[str, Any]) -> dict[str, Any]:
    """Collect the values of the tooth pair that a machine depends on.

    Parameters
    ----------
    tooth_pair : Mapping[str, Any]
        Plain values of section `tooth_pair`.

    Returns
    -------
    dict[str, Any]
        Its keys TEETH, and `middle_mm` of the pinion.
    """
    return {**{key: tooth_pair[key] for key in TEETH}, "middle_mm": face_middle_mm(tooth_pair)}
