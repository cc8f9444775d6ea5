"""Refuses designs that cannot exist, naming the config key, its value and what is allowed."""

from dataclasses import replace
from functools import lru_cache
from math import cos, inf, pi, sin, sqrt, tan

import numpy as np
from scipy.optimize import brentq

from facegear.errors import GeometryError
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.design import PairDesign, as_cut
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.limits import ROUNDING, THINNEST_LAND, RadiusLimits, face_range, radius_limits
from facegear.teeth.modifications import flank_end

MAX_RELIEF = 0.05
"""Largest relief or crowning, in modules: some three times what the heaviest load asks for."""
NARROWEST = 0.5
"""Narrowest pinion over the gear's face."""


@lru_cache(maxsize=64)
def check(design: PairDesign) -> RadiusLimits:
    """Raise an error if the design cannot exist; return the limits of its face.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    RadiusLimits
        Limits of the gear's radii, m.

    Raises
    ------
    GeometryError
        With the key relative to the section tooth_pair.
    """
    _check_pinion(design)
    _check_relief(design)
    check_shaper(design)
    limits = _check_gear(as_cut(design))
    _check_gear_modifications(design)
    return limits


def _refuse(key: str, value: float, requirement: str) -> None:
    """Raise GeometryError for a value (in the key's unit) by its key in the section tooth_pair."""
    raise GeometryError(key, value if isinstance(value, int) else round(float(value), 6), requirement)


def _check_pinion(design: PairDesign) -> None:
    """Raise GeometryError if rack rounding, dedendum, profile shift, chamfer, tip land or bore are
    impossible.
    """
    part, m, angle = design.pinion, design.module, design.pressure_angle
    rho = part.rack_tip_radius
    half_thickness = pi * m / 4 + part.thinning / (2 * cos(angle))
    max_rounding = (
        (half_thickness - part.dedendum * tan(angle) - THINNEST_LAND * m / 2) * cos(angle) / (1 - sin(angle))
    )
    if rho > max_rounding:
        _refuse(
            "pinion.rack_tip_radius_modules",
            rho / m,
            f"at most {max(max_rounding, 0) / m:.4f}: the rack's tip is round",
        )
    if max_rounding < 0:
        deepest = (half_thickness - THINNEST_LAND * m / 2) / tan(angle)
        _refuse(
            "pinion.dedendum_modules", part.dedendum / m, f"at most {deepest / m:.4f}: the rack is pointed"
        )
    min_shift = part.dedendum - rho - (design.pinion_pitch_radius * sin(angle) - rho) * sin(angle)
    if part.profile_shift < min_shift:
        _refuse(
            "pinion.profile_shift_modules", part.profile_shift / m, f"at least {min_shift / m:.4f}: undercut"
        )
    if part.profile_shift >= part.dedendum - rho - 1e-3 * m:
        _refuse(
            "pinion.profile_shift_modules",
            part.profile_shift / m,
            f"less than {(part.dedendum - rho) / m:.4f}",
        )
    start = design.pinion_base_radius * np.hypot(1, pinion.junction_roll(design))
    if design.pinion_tip_radius - part.tip_chamfer <= start + 0.1 * m:
        available_length = design.pinion_tip_radius - start - 0.1 * m
        _refuse(
            "pinion.tip_chamfer_mm",
            1e3 * part.tip_chamfer,
            f"less than {1e3 * max(available_length, 0):.3f}: no flank left",
        )
    land = 2 * pinion.tip_half_angle(design) * design.pinion_tip_radius
    if land < THINNEST_LAND * m:
        key, value = (
            ("tip_chamfer_mm", 1e3 * part.tip_chamfer)
            if part.tip_chamfer
            else ("addendum_modules", part.addendum / m)
        )
        _refuse(f"pinion.{key}", value, f"less: the tip land would be {1e3 * land:.3f} mm wide")
    deepest = design.pinion_root_radius - 0.6 * m
    if part.bore_radius > deepest:
        _refuse("pinion.bore_radius_mm", 1e3 * part.bore_radius, f"at most {1e3 * deepest:.3f}")


def _check_relief(design: PairDesign) -> None:
    """Refuse reliefs and crowning of the pinion above MAX_RELIEF modules, or longer than its flank."""
    part = design.pinion
    flank = design.pinion_base_radius * (design.pinion_tip_roll - pinion.junction_roll(design))
    crowning, half = part.lead_crowning, 0.5 * (design.face_gear.outer_radius - design.face_gear.inner_radius)
    if crowning.amount > 0.0 and crowning.start >= half:
        requirement = (
            f"less than {1e3 * half:.3f}, half of the gear's face: the crowning would begin beyond it"
        )
        _refuse("pinion.lead_crowning.start_mm", 1e3 * crowning.start, requirement)
    for name, relief, available_length in (
        ("tip_relief", part.tip_relief, flank),
        ("root_relief", part.root_relief, flank),
        ("lead_crowning", part.lead_crowning, inf),
    ):
        _check_modification(
            f"pinion.{name}", relief, available_length, MAX_RELIEF * design.module, "roll length"
        )
    key_and_face = "pinion.lead_crowning", "the pinion's face"
    _check_crowning_at_end(part.lead_crowning, part.width / 2, MAX_RELIEF * design.module, *key_and_face)


def _check_gear_modifications(design: PairDesign) -> None:
    """Refuse modifications of the face gear above MAX_RELIEF modules, or longer than its flank."""
    gear, modifications, at_most = (
        design.face_gear,
        design.face_gear.modifications,
        MAX_RELIEF * design.module,
    )
    half = 0.5 * (gear.outer_radius - gear.inner_radius)
    depth = float(design.gear_tip_plane - flank_end(design, gear.inner_radius)[2])
    for name, relief, available_length, length_name in (
        ("tip_relief", modifications.tip_relief, depth, "depth at the inner end"),
        ("root_relief", modifications.root_relief, depth, "depth at the inner end"),
        ("end_relief", modifications.end_relief, half, "half-length along the face"),
        ("profile_crowning", modifications.profile_crowning, inf, ""),
        ("lead_crowning", modifications.lead_crowning, inf, ""),
    ):
        _check_modification(f"face_gear.modifications.{name}", relief, available_length, at_most, length_name)
    for name, crowning, reach in (
        ("lead_crowning", modifications.lead_crowning, half),
        ("profile_crowning", modifications.profile_crowning, gear.addendum),
    ):
        key_and_face = f"face_gear.modifications.{name}", "the gear's flank"
        _check_crowning_at_end(crowning, reach, at_most, *key_and_face)
    for name in ("lead_slope", "profile_slope", "bias"):
        amount = getattr(modifications, name)
        if abs(amount) > at_most:
            requirement = f"within {1e6 * at_most:.1f}, {MAX_RELIEF:g} modules"
            _refuse(f"face_gear.modifications.{name}_um", 1e6 * amount, requirement)


def _check_crowning_at_end(
    crowning: Relief, half_width: float, max_relief: float, key: str, face: str
) -> None:
    """Refuse a crowning whose parabola, which goes on beyond its length, is deeper than `max_relief` (m)
    at the ends of the face, `half_width` (m) from its middle.
    """
    beyond = half_width - crowning.start
    if crowning.amount == 0 or beyond <= 0:
        return
    at_end = crowning.amount * (beyond / crowning.length) ** 2
    if at_end > max_relief:
        min_length = beyond * sqrt(crowning.amount / max_relief)
        requirement = (
            f"at least {1e3 * min_length:.4g}: the parabola would take {1e6 * at_end:.0f} um off the ends "
            f"of {face}, and at most {1e6 * max_relief:.1f}, {MAX_RELIEF:g} modules, may come off"
        )
        _refuse(f"{key}.length_mm", 1e3 * crowning.length, requirement)


def _check_modification(
    key: str, relief: Relief, available_length: float, max_relief: float, length_name: str
) -> None:
    """Refuse a relief above `max_relief` (m), without length, or that reaches beyond `available_length`
    (m).
    """
    if relief.amount == 0:
        return
    if relief.amount > max_relief:
        requirement = f"at most {1e6 * max_relief:.1f}, {MAX_RELIEF:g} modules"
        _refuse(f"{key}.amount_um", 1e6 * relief.amount, requirement)
    if relief.length <= 0:
        _refuse(f"{key}.length_mm", 1e3 * relief.length, "greater than 0 where an amount is given")
    if relief.start + relief.length > available_length:
        end = 1e3 * (relief.start + relief.length)
        _refuse(
            f"{key}.length_mm",
            end,
            f"with start at most {1e3 * available_length:.3f}, the flank's {length_name}",
        )


def check_shaper(design: PairDesign) -> None:
    """Refuse a tool whose tooth number, addendum, tip land or tip rounding cannot be, or not for this pinion.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Raises
    ------
    GeometryError
        With the key relative to the section tooth_pair.
    """
    teeth, min_teeth = design.shaper.teeth, design.pinion.teeth
    if not min_teeth <= teeth <= min_teeth + 3:
        _refuse("shaper.teeth", teeth, f"from {min_teeth} (line contact) to {min_teeth + 3}")
    m = design.module
    if design.shaper.addendum < design.pinion.addendum:
        min_addendum = f"at least {design.pinion.addendum / m:.4f}, the pinion's addendum"
        _refuse("shaper.addendum_modules", design.shaper.addendum / m, min_addendum)
    sharp = _land_left(design, 0.0)
    if sharp < 0:
        land = 1e3 * (sharp + THINNEST_LAND * m)
        requirement = f"less: the shaper's tip land would be {land:.3f} mm wide"
        _refuse("shaper.addendum_modules", design.shaper.addendum / m, requirement)
    rounding = design.shaper.tip_rounding
    deepest = design.shaper_tip_radius - design.shaper_base_radius
    if rounding >= deepest or _land_left(design, rounding) < 0:
        max_rounding = deepest
        if _land_left(design, deepest) < 0:
            max_rounding = brentq(lambda radius: _land_left(design, radius), 0.0, deepest, xtol=ROUNDING)
        requirement = f"at most {max_rounding / m:.4f}: the shaper's tip is round"
        _refuse("shaper.tip_rounding_modules", rounding / m, requirement)


def _land_left(design: PairDesign, rounding: float) -> float:
    """Return the width (m) of the shaper's tip land with a tip rounding (m), less the thinnest allowed."""
    tool = replace(design, shaper=replace(design.shaper, tip_rounding=rounding))
    return 2 * face_gear_fillet.root_half_angle(tool) * tool.gear_pitch_radius - THINNEST_LAND * tool.module


@lru_cache(maxsize=16)
def _check_gear(design: PairDesign) -> RadiusLimits:
    """Refuse a face gear (of a pair by `as_cut`) that cannot exist, and return the limits of its radii."""
    gear, m = design.face_gear, design.module
    if gear.addendum >= design.pinion.dedendum:
        _refuse(
            "face_gear.addendum_modules",
            gear.addendum / m,
            f"less than the pinion's dedendum {design.pinion.dedendum / m:.4f}",
        )
    if gear.rim_thickness < 0.5 * m:
        _refuse("face_gear.rim_thickness_mm", 1e3 * gear.rim_thickness, f"at least {500 * m:.3f}")
    limits = radius_limits(design)
    face = face_range(design, limits)
    for key, value in (("inner_radius_mm", gear.inner_radius), ("outer_radius_mm", gear.outer_radius)):
        if not face.inner <= value <= face.outer:
            _refuse(f"face_gear.{key}", 1e3 * value, str(face))
    if gear.outer_radius - gear.inner_radius < 0.5 * m:
        min_radius = 1e3 * (gear.inner_radius + 0.5 * m)
        _refuse(
            "face_gear.outer_radius_mm",
            1e3 * gear.outer_radius,
            f"at least {min_radius:.3f}, half a module of face",
        )
    _check_width(design)
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 33)
    top = face_gear.flank_point(design, 0.0, face_gear.psi_at(design, radius, 0.0))[:, 2].min()
    if design.gear_tip_plane > top:
        max_addendum = top - design.pitch_plane
        _refuse(
            "face_gear.addendum_modules",
            gear.addendum / m,
            f"less than {max_addendum / m:.4f}: no involute generates it",
        )
    roll, _ = face_gear.roll_and_psi_at_height(design, radius, design.gear_tip_plane)
    if np.max(roll) >= design.shaper_tip_roll:
        _refuse("face_gear.addendum_modules", gear.addendum / m, "more: the flank has no height")
    return limits


def _check_width(design: PairDesign) -> None:
    """Refuse a pinion narrower than NARROWEST of the gear's face, or so wide that it reaches the gear's
    axis.
    """
    gear, width = design.face_gear, design.pinion.width
    min_width, max_width = NARROWEST * (gear.outer_radius - gear.inner_radius), 2 * design.mean_radius
    if width < min_width:
        requirement = f"at least {1e3 * min_width:.3f}, half the gear's face"
        _refuse("pinion.width_mm", 1e3 * width, requirement)
    if width >= max_width:
        _refuse(
            "pinion.width_mm", 1e3 * width, f"less than {1e3 * max_width:.3f}: it reaches the gear's axis"
        )
