"""The geometry stage's results as a record with units in its keys, and as arrays."""

from dataclasses import asdict
from typing import Any

import numpy as np

from facegear.arrays import AnyArray, Array
from facegear.geometry import face_gear, pinion
from facegear.geometry.analysis import PairAnalysis, path_curvatures
from facegear.geometry.clearance import Gap
from facegear.geometry.design import PairDesign
from facegear.geometry.easeoff import EaseOff
from facegear.geometry.outline import pinion_outline
from facegear.geometry.placement import conjugate_angle
from facegear.geometry.unloaded import UnloadedContact


def pair_record(design: PairDesign, analysis: PairAnalysis) -> dict[str, Any]:
    """Return the content of `geometry/pair.json`: radii, limits, contact ratio and path, backlash, smallest
    gaps.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    analysis : PairAnalysis
        Its geometry.

    Returns
    -------
    dict[str, Any]
        Values by key, units in the keys.
    """
    limits = analysis.limits
    roll, large, small, slope = path_curvatures(design)
    return {
        "design_si": asdict(design),
        "radii_mm": {
            "pinion_base": 1e3 * design.pinion_base_radius,
            "pinion_pitch": 1e3 * design.pinion_pitch_radius,
            "pinion_tip": 1e3 * design.pinion_tip_radius,
            "pinion_root": 1e3 * design.pinion_root_radius,
            "pinion_fillet_start": 1e3 * float(pinion.trochoid_point(design, design.pressure_angle)[0]),
            "gear_base": 1e3 * design.gear_base_radius,
            "gear_contact_path_nominal": 1e3 * design.gear_pitch_radius,
            "gear_inner": 1e3 * design.face_gear.inner_radius,
            "gear_outer": 1e3 * design.face_gear.outer_radius,
        },
        "limits_mm": {
            "inner_undercut": 1e3 * limits.inner,
            "outer_pointing": 1e3 * limits.outer,
            "outer_pointing_planar": 1e3 * limits.outer_planar,
        },
        "contact_ratio": analysis.contact_ratio,
        "backlash_um": {"smallest": 1e6 * analysis.backlash.min(), "largest": 1e6 * analysis.backlash.max()},
        "unloaded": {"drive": _contact(analysis.drive), "back": _contact(analysis.back)},
        "path_curvature": {
            "pinion_roll_rad": roll,
            "larger_per_m": large,
            "smaller_per_m": small,
            "line_slope_deg": np.degrees(slope),
        },
        "smallest_gap": _gap(analysis.smallest),
        "interference": None if analysis.interference is None else _gap(analysis.interference),
        "gaps": [_gap(gap) for gap in analysis.gaps.values()],
    }


def _contact(contact: UnloadedContact) -> dict[str, Any]:
    roll, y = contact.path
    error = 1e6 * contact.transmission_error
    return {
        "phi1_rad": contact.phi1,
        "transmission_error_um": error,
        "transmission_error_peak_to_peak_um": float(np.ptp(error)),
        "path_pinion_roll_rad": roll,
        "path_pinion_y_mm": 1e3 * y,
        "touching_pair": contact.tooth,
    }


def _gap(gap: Gap) -> dict[str, Any]:
    return {
        "gap_um": 1e6 * gap.gap,
        "along_line_of_action_um": 1e6 * gap.approach if np.isfinite(gap.approach) else None,
        "pinion_part": gap.pinion_part,
        "gear_part": gap.gear_part,
        "gear_radius_mm": 1e3 * gap.radius,
        "phi1_rad": gap.phi1,
        "side": gap.side,
    }


def flank_arrays(design: PairDesign, profile: int = 33, width: int = 41) -> dict[str, Array]:
    """Return point grids of the right flanks and fillets, in the body frames.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    profile : int
        Number of points along the profile.
    width : int
        Number of points along the width.

    Returns
    -------
    dict of (profile, width, 3) arrays
        Points, m, and `pinion_section` (n, 2), m.
    """
    half = design.pinion.width / 2
    y = np.linspace(design.mean_radius - half, design.mean_radius + half, width)[None, :]
    roll = np.linspace(design.pinion_tip_roll, pinion.junction_roll(design), profile)[:, None]
    gamma = np.linspace(design.pressure_angle, np.pi / 2, profile)[:, None]
    radius = np.linspace(design.face_gear.inner_radius, design.face_gear.outer_radius, width)[None, :]
    top, _ = face_gear.roll_and_psi_at_height(design, radius, design.gear_tip_plane)
    gear_roll = top + np.linspace(0, 1, profile)[:, None] * (design.shaper_tip_roll - top)
    slopes = face_gear.fillet_slopes(design, radius, np.linspace(0, 1, profile)[:, None])
    return {
        "pinion_flank": pinion.cartesian(*pinion.involute_point(design, roll), y),
        "pinion_fillet": pinion.cartesian(*pinion.trochoid_point(design, gamma), y),
        "gear_flank": face_gear.flank_point(design, gear_roll, face_gear.psi_at(design, radius, gear_roll)),
        "gear_fillet": face_gear.cylindrical(radius, *face_gear.fillet_section(design, radius, slopes)),
        "pinion_section": pinion_outline(design, 200).points,
    }


def contact_arrays(design: PairDesign, analysis: PairAnalysis, contours: EaseOff) -> dict[str, AnyArray]:
    """Return the arrays that the pictures need: the drive side's contact path and the separation contours
    (SI).

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    analysis : PairAnalysis
        Its geometry.
    contours : EaseOff
        Ease-off of the drive side.

    Returns
    -------
    dict of (...) arrays
        Arrays by name, in SI units.
    """
    roll, y = analysis.drive.path
    order = np.argsort(roll)
    record = {f"contour_{name}": value for name, value in asdict(contours).items()}
    return {
        **record,
        "path_roll": roll[order],
        "path_y": y[order],
        "phi1": analysis.drive.phi1,
        "phi2_conjugate": conjugate_angle(design, analysis.drive.phi1),
        "transmission_error": analysis.drive.transmission_error,
        "backlash": analysis.backlash,
    }
