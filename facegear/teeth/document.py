"""Results of the geometry stage as a record and as arrays, with separation contours of the flanks."""

from dataclasses import asdict, dataclass
from math import isfinite, pi
from typing import Any

import numpy as np

from facegear.arrays import AnyArray, Array, Mask
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.analysis import PairAnalysis, path_curvatures
from facegear.teeth.clearance import Gap, pinion_outline
from facegear.teeth.conjugate import PairNumbers
from facegear.teeth.design import PairDesign
from facegear.teeth.flank_numbers import blank_numbers, flank_numbers
from facegear.teeth.placement import conjugate_angle, mirror_teeth
from facegear.teeth.rays import FLANK
from facegear.teeth.separation import separation
from facegear.teeth.surfaces import flank_points
from facegear.teeth.unloaded_contact import UnloadedContact


@dataclass(frozen=True)
class EaseOff:
    """Separation of the flanks on a grid of points of the pinion's flank.

    Attributes
    ----------
    roll, y : (n_profile, n_width) arrays
        Roll angle, rad, and position along the pinion's axis, m, of each point.
    gap : (n_profile, n_width) array
        Smallest distance, m, from the gear's flank while the tooth passes through the mesh; 0 where the point
        does not meet the flank.
    is_facing : (n_profile, n_width) mask
        Whether the point meets the gear's flank at all.
    radius, height : (n_profile, n_width) arrays
        Radius and z on the gear where the gap is smallest, m; 0 where the point does not meet the flank.
    """

    roll: Array
    y: Array
    gap: Array
    is_facing: Mask
    radius: Array
    height: Array


def ease_off(design: PairDesign, transmission_error: float, shape: tuple[int, int] = (25, 25)) -> EaseOff:
    """Compute the ease-off of the drive side.

    The separation is sampled over three pitches and its smallest value taken from the parabola through the
    three samples around it.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    transmission_error : float
        Mean unloaded transmission error, m, which turns the gear on until the flanks touch.
    shape : tuple[int, int]
        Number of points along profile and width.

    Returns
    -------
    EaseOff
        Grid of gaps, m.
    """
    numbers = PairNumbers.of_design(design)
    ys = np.linspace(numbers.first_end, numbers.last_end, shape[1])
    roll, y = np.linspace(*pinion.roll_ends(design, ys), num=shape[0]), np.broadcast_to(ys, shape)
    phi1 = np.linspace(-1.5, 1.5, 61) * 2 * pi / design.pinion.teeth
    phi2 = conjugate_angle(design, phi1) + transmission_error / design.gear_normal_arm
    separations = separation(design, flank_points(design, roll, y).flat(), phi1, phi2)
    gap = np.where(separations.part == FLANK, separations.gap, np.inf)
    best = np.clip(np.argmin(gap, axis=0), 1, len(phi1) - 2)
    points = np.arange(gap.shape[1])
    before, middle, after = (gap[best + step, points] for step in (-1, 0, 1))
    is_facing = np.isfinite(before) & np.isfinite(middle) & np.isfinite(after)
    with np.errstate(invalid="ignore", divide="ignore"):
        min_gap = middle - (after - before) ** 2 / (8 * (before - 2 * middle + after))
    hit = face_gear.flank_point(design, separations.u[best, points], separations.v[best, points])
    radius = np.hypot(hit[:, 0], hit[:, 1])

    def facing_values(values: Array) -> Array:
        """Return values (n,) as the grid, 0 where a point does not meet the flank."""
        return np.where(is_facing, values, 0.0).reshape(shape)

    return EaseOff(
        roll=roll,
        y=y,
        gap=facing_values(min_gap),
        is_facing=is_facing.reshape(shape),
        radius=facing_values(radius),
        height=facing_values(hit[:, 2]),
    )


def pair_record(design: PairDesign, analysis: PairAnalysis) -> dict[str, Any]:
    """Return the content of `geometry/pair.json`: numbers of blanks and flanks, radii, limits, contact ratio
    and path, backlash, smallest gaps.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    analysis : PairAnalysis
        Its geometry.

    Returns
    -------
    dict[str, Any]
        Values by key, units in the keys; in `design_si` all are in SI units.
    """
    limits = analysis.limits
    roll, large, small, slope = path_curvatures(design)
    return {
        "design_si": asdict(design),
        "blanks": blank_numbers(design),
        "flanks": flank_numbers(design),
        "radii_mm": {
            "pinion_base": 1e3 * design.pinion_base_radius,
            "pinion_pitch": 1e3 * design.pinion_pitch_radius,
            "pinion_tip": 1e3 * design.pinion_tip_radius,
            "pinion_root": 1e3 * design.pinion_root_radius,
            "pinion_fillet_start": 1e3
            * float(pinion.trochoid_point(design, design.transverse_pressure_angle, design.middle)[0]),
            "gear_base": 1e3 * design.gear_base_radius,
            "gear_contact_path_nominal": 1e3 * design.gear_pitch_radius,
            "gear_inner": 1e3 * design.face_gear.inner_radius,
            "gear_outer": 1e3 * design.face_gear.outer_radius,
        },
        "limits_mm": {
            "inner_undercut": 1e3 * limits.inner,
            "outer_pointing": 1e3 * limits.outer if isfinite(limits.outer) else None,
            "outer_pointing_planar": None if limits.outer_planar is None else 1e3 * limits.outer_planar,
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
    """Return the entry `unloaded` of `pair_record` for one side: angles, transmission error and contact
    path.
    """
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
    """Return the entry of `pair_record` for a gap: its size, and where on both bodies."""
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
    """Return point grids of the pinion's right flank and fillet and the gear's left ones, in the body frames.

    The gear's are in a mirror x -> -x, see `face_gear`. Coast flanks that are no mirror images follow under
    names that begin with `coast_`: those of the mirrored teeth.

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
        Points, m: `pinion_flank`, `pinion_fillet`, `gear_flank`, `gear_fillet`, and `pinion_section` (n,
        2), the outline of half a tooth in (x, -z), in the middle of the pinion's face.
    """
    drive = _drive_arrays(design, profile, width)
    if design.is_symmetric:
        return drive
    coast = _drive_arrays(mirror_teeth(design), profile, width)
    return drive | {f"coast_{name}": array for name, array in coast.items()}


def _drive_arrays(design: PairDesign, profile: int, width: int) -> dict[str, Array]:
    """Return the grids of the drive flanks of `flank_arrays`."""
    half = design.pinion.width / 2
    y = np.linspace(design.middle - half, design.middle + half, width)
    roll = np.linspace(*pinion.roll_ends(design, y)[::-1], num=profile)
    gamma = np.linspace(design.transverse_pressure_angle, np.pi / 2, profile)[:, None]
    radius = np.linspace(design.face_gear.inner_radius, design.face_gear.outer_radius, width)[None, :]
    top, _ = face_gear.tip_parameters(design, radius)
    end, _ = face_gear.end_parameters(design, radius)
    gear_roll = top + np.linspace(0, 1, profile)[:, None] * (end - top)
    slopes = face_gear_fillet.fillet_slopes(design, radius, np.linspace(0, 1, profile)[:, None])
    return {
        "pinion_flank": pinion.cartesian(*pinion.involute_point(design, roll, y), y),
        "pinion_fillet": pinion.cartesian(*pinion.trochoid_point(design, gamma, y), y),
        "gear_flank": face_gear.flank_point(design, gear_roll, face_gear.psi_at(design, radius, gear_roll)),
        "gear_fillet": face_gear.cylindrical(
            radius, *face_gear_fillet.fillet_section(design, radius, slopes)
        ),
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
        Arrays by name, in SI units: fields of the ease-off as `contour_...`, contact path sorted by roll,
        phi1, conjugate phi2, transmission error and backlash.
    """
    roll, y = analysis.drive.path
    order = np.argsort(roll)
    record = {f"contour_{name.removeprefix('is_')}": value for name, value in asdict(contours).items()}
    return {
        **record,
        "path_roll": roll[order],
        "path_y": y[order],
        "phi1": analysis.drive.phi1,
        "phi2_conjugate": conjugate_angle(design, analysis.drive.phi1),
        "transmission_error": analysis.drive.transmission_error,
        "backlash": analysis.backlash,
    }
