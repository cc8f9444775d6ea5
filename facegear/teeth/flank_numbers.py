"""Numbers of both flanks of teeth of any kind, as a drawing and the design of bearings need them.

All are those of the nominal assembly and of flanks as generated. Source: Litvin and Fuentes 2004, chapters 10
and 18.
"""

from math import asin, cos, degrees, hypot, pi, sin, tan
from typing import Any

import numpy as np

from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.design import PairDesign, involute
from facegear.teeth.family_contact import contact_line
from facegear.teeth.family_limits import family_limits
from facegear.teeth.family_range import FLANK_NAMES
from facegear.teeth.generated_fillet import gear_fillet
from facegear.teeth.helicoid import pinion_start
from facegear.teeth.tooth_family import SIDES, ToothFamily


def flank_numbers(design: PairDesign) -> dict[str, dict[str, Any]]:
    """Compute the numbers of both flanks.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    dict[str, dict[str, Any]]
        For `drive` and `coast`, with units in the names of the keys:

        - pressure_angle_deg, transverse_pressure_angle_deg: of pinion and shaper
        - base_helix_deg: signed; base_radius_mm: of the pinion
        - form_radii_mm: where the pinion's involute begins, at the inner end, the middle and the outer end
        - inner_limit_mm, inner_cause: smallest gear radius of the flank, and what limits it
        - path_mm: first and last contact in the mesh frame, x, y, z each, and path_edges that end it there
        - contact_ratio
        - sliding_mm_per_rad: speed of sliding per speed of the pinion, at the first, middle and last contact
        - force_per_torque_per_m: of the pinion on the gear along the normal, over the pinion's torque
        - axial_force_per_torque_per_m, separating_force_per_torque_per_m: on the pinion, outwards along its
          axis and away from the gear, over the torque that this flank carries
        - phase_deg_per_mm: of the mesh, by which a pinion that moves outwards shifts it
    """
    starts = family_limits(design.family).starts
    return {
        FLANK_NAMES[side]: {
            **_helicoid_numbers(design.family, side),
            "inner_limit_mm": 1e3 * start.limit[0],
            "inner_cause": start.limit[1],
            **_path_numbers(design.family, side),
        }
        for side, start in zip(SIDES, starts, strict=True)
    }


def blank_numbers(design: PairDesign) -> dict[str, Any]:
    """Compute the numbers of blanks and assembly that both flanks share.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    dict[str, Any]
        Numbers with units in the names of the keys:

        - transverse_module_mm; pitch_radii_mm: of pinion and gear
        - tooth_thickness_mm: arc of the pinion's tooth on its pitch circle, in the middle of its face
        - span: number of teeth and normal span (mm) of the pinion; None for tapered teeth and unlike flanks,
          which no two parallel anvils touch
        - middle_mm: place of the middle of the pinion's face along its axis
        - pinion_tip_radii_mm: at the inner end, the middle and the outer end of its face
        - tip_cone_deg: half angle of the gear's tip surface, 90 for a plane
        - tip_heights_mm, root_heights_mm: of the gear in the mesh frame, at the inner, mean and outer radius
        - backlash_um_per_mm: `backlash_slope`
    """
    family, gear = design.family, design.face_gear
    radii = np.array([gear.inner_radius, design.mean_radius, gear.outer_radius])
    fillet = gear_fillet(family, 1)
    steps = family.width * np.array([-0.5, 0.0, 0.5])
    return {
        "transverse_module_mm": 1e3 * family.rack.transverse_module,
        "pitch_radii_mm": [1e3 * family.pinion_pitch_radius, 1e3 * family.gear_pitch_radius],
        "tooth_thickness_mm": 1e3 * _pitch_thickness(family),
        "span": _span(family),
        "middle_mm": 1e3 * family.middle,
        "pinion_tip_radii_mm": (1e3 * (family.pinion_tip_radius + family.taper * steps)).tolist(),
        "tip_cone_deg": degrees(family.shaft_angle - family.rack.taper_angle),
        "tip_heights_mm": (1e3 * family.gear_tip.height(radii)).tolist(),
        "root_heights_mm": (1e3 * fillet.point(fillet.y_at(radii, 1.0), 1.0)[:, 2]).tolist(),
        "backlash_um_per_mm": 1e3 * backlash_slope(family),
    }


def _pitch_thickness(family: ToothFamily) -> float:
    """Return the arc of the pinion's tooth on its pitch circle, in the middle of its face, m."""
    angles = [
        helicoid.half_base_angle - involute(helicoid.pressure_angle) for helicoid in family.pinion_flanks
    ]
    return family.pinion_pitch_radius * sum(angles)


def _span(family: ToothFamily) -> tuple[int, float] | None:
    """Return the number of teeth for which anvils touch nearest to the shifted pitch circle, and the span
    (mm); None where the flanks are no mirror images of one helicoid.
    """
    drive, coast = family.pinion_flanks
    if family.taper != 0.0 or drive.base_radius != coast.base_radius:
        return None
    target = family.pinion_pitch_radius + family.profile_shift
    pitch, tooth = 2.0 * pi / family.pinion_teeth, 2.0 * drive.half_base_angle
    counts = range(2, max(family.pinion_teeth // 2, 2) + 1)
    rolls = {count: drive.base_radius * ((count - 1) * pitch + tooth) for count in counts}
    best = min(
        counts, key=lambda count: abs(hypot(drive.base_radius, drive.cosine**2 * rolls[count] / 2.0) - target)
    )
    return best, 1e3 * drive.cosine * rolls[best]


def backlash_slope(family: ToothFamily) -> float:
    """Compute by how much backlash grows where the pinion moves outwards.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.

    Returns
    -------
    float
        Arc of the gear at its pitch radius per way of the pinion, m/m; 0 without taper.
    """
    rack = family.rack
    slopes = sum(tan(angle) for angle in rack.pressure_angles)
    return sin(rack.taper_angle) * slopes / cos(rack.helix_angle)


def _helicoid_numbers(family: ToothFamily, side: int) -> dict[str, Any]:
    """Return the numbers of a flank that follow from the pinion's helicoid alone."""
    helicoid, rack = family.pinion_flanks[0 if side > 0 else 1], family.rack
    ends = family.middle + family.width * np.array([-0.5, 0.0, 0.5])
    forms = np.hypot(helicoid.base_radius, np.maximum(pinion_start(family, side, ends), 0.0))
    arm = helicoid.base_radius * helicoid.cosine
    return {
        "pressure_angle_deg": degrees(rack.pressure_angle(side)),
        "transverse_pressure_angle_deg": degrees(helicoid.pressure_angle),
        "base_helix_deg": degrees(asin(helicoid.sine)),
        "base_radius_mm": 1e3 * helicoid.base_radius,
        "form_radii_mm": (1e3 * forms).tolist(),
        "force_per_torque_per_m": 1.0 / arm,
        "axial_force_per_torque_per_m": -helicoid.sine / arm,
        "separating_force_per_torque_per_m": helicoid.cosine * sin(helicoid.pressure_angle) / arm,
        "phase_deg_per_mm": 1e-3 * degrees(family.pinion_teeth * helicoid.sine / arm),
    }


def _path_numbers(family: ToothFamily, side: int) -> dict[str, Any]:
    """Return the numbers of the path of contact of a flank; none of a flank that has no path."""
    line = contact_line(family, side)
    if line is None:
        return {}
    path = contact_path(family, line)
    if not path.first < path.last:
        return {}
    s = np.array([path.first, path.middle, path.last])
    return {
        "path_mm": (1e3 * line.point(s[[0, 2]])).tolist(),
        "path_edges": [path.first_edge, path.last_edge],
        "contact_ratio": path.contact_ratio,
        "sliding_mm_per_rad": (1e3 * line.sliding(s)).tolist(),
    }
