"""The section tooth_pair: teeth, blanks, tools, material and assembly of one pinion and face gear."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field

from facegear.schema.base import Section
from facegear.schema.flanks import FlanksSection
from facegear.schema.gear_body import MaterialSection

PressureAngle = Annotated[float, Field(ge=10, le=40)]
"""Normal pressure angle of a flank, deg."""


class FlankAngles(Section):
    """Normal pressure angles of two unlike flanks."""

    drive: PressureAngle = Field(description="of the pinion's right flank, which drives towards +x")
    coast: PressureAngle = Field(description="of the pinion's left flank")


def flank_angles_deg(angles: "float | FlankAngles | Mapping[str, float]") -> tuple[float, float]:
    """Return the pressure angles of both flanks from any form in which the key gives them.

    Parameters
    ----------
    angles : float, FlankAngles or mapping
        Value of `tooth_pair.pressure_angle_deg`, deg: one number for both flanks, or one for each, as a
        section or as plain values.

    Returns
    -------
    tuple of float
        Angles of drive and coast flank, deg.
    """
    if isinstance(angles, FlankAngles):
        return angles.drive, angles.coast
    if isinstance(angles, Mapping):
        return angles["drive"], angles["coast"]
    return angles, angles


def face_middle_mm(tooth_pair: Mapping[str, Any]) -> float | None:
    """Return the place of the middle of the pinion's face along its axis.

    Parameters
    ----------
    tooth_pair : mapping
        Plain values of section `tooth_pair`.

    Returns
    -------
    float or None
        Key `pinion.middle_mm`, else the mean radius of the gear's face, mm; None for a pair without bodies.
    """
    pinion, gear = tooth_pair["pinion"], tooth_pair["face_gear"]
    if pinion is not None and pinion["middle_mm"] is not None:
        return float(pinion["middle_mm"])
    return None if gear is None else float(0.5 * (gear["inner_radius_mm"] + gear["outer_radius_mm"]))


class ReliefSection(Section):
    """A modification of a flank, removed along the normal."""

    amount_um: float = Field(default=0.0, ge=0, le=500, description="depth taken off, largest at its end")
    start_mm: float = Field(
        default=0.0,
        ge=0,
        le=1e4,
        description="tip, root, end: length from the end with the full amount; crowning: plain half width",
    )
    length_mm: float = Field(
        default=0.0, ge=0, le=1e4, description="over which it grows from nothing to the amount"
    )


class PinionSection(Section):
    """Pinion cut by a rack; heights are radial, in transverse sections, and count in normal modules."""

    width_mm: float = Field(ge=0.01, le=2000, description="face width, along the pinion's axis")
    middle_mm: float | None = Field(
        default=None,
        ge=-1e4,
        le=1e4,
        description="place of the middle of its face along its axis, from the common perpendicular of both "
        "axes; null: the mean radius of the gear's face",
    )
    addendum_modules: float = Field(
        default=1.0, ge=0.01, le=2, description="from the pitch circle to the tip circle, without shift"
    )
    dedendum_modules: float = Field(
        default=1.25, ge=0.01, le=2.5, description="from the pitch circle to the root circle, without shift"
    )
    rack_tip_radius_modules: float = Field(
        default=0.1, ge=0, le=0.6, description="rounding of the rack's tip, which cuts the fillet"
    )
    profile_shift_modules: float = Field(
        default=0.0, ge=-1, le=1, description="shift of the rack; positive: away from the pinion's axis"
    )
    thinning_um: float = Field(
        default=0.0, ge=0, le=1e5, description="off both flanks together: nominal normal backlash"
    )
    tip_chamfer_mm: float = Field(
        default=0.0, ge=0, le=1000, description="radial height of a 45 degree chamfer"
    )
    bore_radius_mm: float = Field(ge=1e-3, le=1e4, description="of the bore, which contact analysis holds")
    tip_relief: ReliefSection = Field(ReliefSection(), description="taken off towards the tip")
    root_relief: ReliefSection = Field(ReliefSection(), description="taken off towards the root")
    lead_crowning: ReliefSection = Field(
        ReliefSection(), description="taken off towards both ends of the face"
    )
    flanks: FlanksSection = Field(FlanksSection(), description="deviations of the flanks as measured")
    material: MaterialSection | None = Field(default=None, description="if not the pair's")


class GearModificationsSection(Section):
    """Material taken off both flanks of the face gear along the normal (docs/explanation/geometry.md)."""

    tip_relief: ReliefSection = Field(ReliefSection(), description="taken off towards the tip")
    root_relief: ReliefSection = Field(ReliefSection(), description="taken off towards the root")
    end_relief: ReliefSection = Field(ReliefSection(), description="taken off towards both ends of the face")
    profile_crowning: ReliefSection = Field(
        ReliefSection(), description="taken off towards tip and root alike"
    )
    lead_crowning: ReliefSection = Field(
        ReliefSection(), description="taken off towards both ends of the face, from its middle on"
    )
    lead_slope_um: float = Field(
        default=0.0, ge=-500, le=500, description="off the outer end, onto the inner"
    )
    profile_slope_um: float = Field(
        default=0.0, ge=-500, le=500, description="off the tip, onto as far below the pitch plane"
    )
    bias_um: float = Field(
        default=0.0, ge=-500, le=500, description="off the outer tip and inner root, onto the other two"
    )


class FaceGearSection(Section):
    """Face gear blank."""

    inner_radius_mm: float = Field(ge=0.01, le=10000, description="at which the face begins")
    outer_radius_mm: float = Field(ge=0.01, le=10000, description="at which the face ends")
    addendum_modules: float = Field(
        default=1.0, ge=0.01, le=2, description="height of the teeth above the pitch plane"
    )
    rim_thickness_mm: float = Field(
        ge=0.01, le=10000, description="from the root land to the back, which is clamped"
    )
    modifications: GearModificationsSection = Field(
        GearModificationsSection(), description="reliefs, crowning and slopes of both flanks"
    )
    flanks: FlanksSection = Field(FlanksSection(), description="deviations of the flanks as measured")
    material: MaterialSection | None = Field(default=None, description="if not the pair's")


class ShaperSection(Section):
    """The tool that generates the face gear."""

    teeth: int = Field(ge=5, le=500, description="from the pinion's number (line contact) to three more")
    addendum_modules: float = Field(
        default=1.25, ge=0.01, le=2.5, description="height of its teeth above its pitch circle"
    )
    tip_rounding_modules: float = Field(
        default=0.0, ge=0, le=0.6, description="radius between flank and tip land; 0: a sharp edge"
    )


class AssemblySection(Section):
    """Assembly errors; signs as in docs/explanation/geometry.md."""

    offset_um: float = Field(default=0.0, ge=-5000, le=5000, description="dE: offset of the axes")
    shaft_angle_error_deg: float = Field(
        default=0.0, ge=-2, le=2, description="dgamma: error of the angle between the axes"
    )
    gear_axial_um: float = Field(
        default=0.0,
        ge=-5000,
        le=5000,
        description="dq: axial setting of the gear, positive away from the pinion",
    )
    pinion_axial_um: float = Field(
        default=0.0,
        ge=-5000,
        le=5000,
        description="w: axial setting of the pinion, positive outwards; opens the backlash where "
        "taper_angle_deg is positive",
    )
