"""Refuses designs that cannot exist, naming the config key, its value and what is allowed."""

from dataclasses import replace
from functools import lru_cache
from math import cos, inf, sin, sqrt, tan

import numpy as np
from scipy.optimize import brentq

from facegear.errors import GeometryError
from facegear.teeth import face_gear, pinion
from facegear.teeth.conjugate import PairNumbers
from facegear.teeth.design import PairDesign, as_cut
from facegear.teeth.family_range import THINNEST_ROOT
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.helicoid import pinion_fillet, shaper_land
from facegear.teeth.limits import ROUNDING, THINNEST_LAND, RadiusLimits, face_range, radius_limits
from facegear.teeth.modifications import depth_below_tip, flank_end
from facegear.teeth.placement import mirror_teeth

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


def _sides(design: PairDesign) -> tuple[PairDesign, ...]:
    """Return the design, and where its coast flanks are others than its drive flanks its `mirror_teeth`."""
    return (design,) if design.is_symmetric else (design, mirror_teeth(design))


def _section_places(design: PairDesign) -> list[float]:
    """Return the places y (m) of sections that have to be possible: the middle, or both ends of tapered
    teeth.
    """
    half = design.pinion.width / 2 if design.taper_angle else 0.0
    return sorted({design.middle - half, design.middle + half})


def _check_pinion(design: PairDesign) -> None:
    """Raise GeometryError if rack rounding, dedendum, profile shift, chamfer, tip land or bore are
    impossible.
    """
    _check_rack(design)
    for side in _sides(design):
        for y in _section_places(design):
            _check_section(side, y)
    part, m = design.pinion, design.module
    for y in _section_places(design):
        halves = [pinion.tip_half_angle(side, y) for side in _sides(design)]
        land = float((halves[0] + halves[-1]) * pinion.tip_radius(design, y))
        if land < THINNEST_LAND * m:
            key, value = (
                ("tip_chamfer_mm", 1e3 * part.tip_chamfer)
                if part.tip_chamfer
                else ("addendum_modules", part.addendum / m)
            )
            requirement = f"less: the tip land would be {1e3 * land:.3f} mm wide{_end_in_words(design, y)}"
            _refuse(f"pinion.{key}", value, requirement)
    deepest = min(float(pinion.root_radius(design, y)) for y in _section_places(design)) - 0.6 * m
    if part.bore_radius > deepest:
        _refuse("pinion.bore_radius_mm", 1e3 * part.bore_radius, f"at most {1e3 * deepest:.3f}")


def _end_in_words(design: PairDesign, y: float) -> str:
    """Return at which end of a tapered face a place (m) is, in words; nothing for the middle."""
    if y == design.middle:
        return ""
    return f" at the {'inner' if y < design.middle else 'outer'} end; a taper_angle_deg nearer to 0 helps"


def _check_rack(design: PairDesign) -> None:
    """Raise GeometryError if the tip of the pinion's rack has no land."""
    part, m = design.pinion, design.module

    def half_land(rounding: float, dedendum: float) -> float:
        """Return half the land (m) that a tip rounding and a dedendum (m) leave, on the normal rack."""
        family = replace(design.family, rack_tip_radius=rounding, pinion_dedendum=dedendum)
        return sum(pinion_fillet(family, side).lateral for side in (1, -1)) / 2 * cos(design.helix_angle)

    rho, least = part.rack_tip_radius, THINNEST_LAND * m / 2
    sharp = half_land(0.0, part.dedendum)
    # the land falls in proportion to the rounding, and to the dedendum
    max_rounding = (sharp - least) * m / (sharp - half_land(m, part.dedendum))
    if rho > max_rounding:
        _refuse(
            "pinion.rack_tip_radius_modules",
            rho / m,
            f"at most {max(max_rounding, 0) / m:.4f}: the rack's tip is round",
        )
    if max_rounding < 0:
        deepest = part.dedendum + (sharp - least) * m / (half_land(0.0, part.dedendum - m) - sharp)
        _refuse(
            "pinion.dedendum_modules", part.dedendum / m, f"at most {deepest / m:.4f}: the rack is pointed"
        )


def _check_section(design: PairDesign, y: float) -> None:
    """Raise GeometryError for a profile shift or chamfer that no drive side has in a section at y (m)."""
    part, m, angle = design.pinion, design.module, design.transverse_pressure_angle
    rho = part.rack_tip_radius * (1 - sin(design.pressure_angle)) / cos(design.taper_angle)
    end = _end_in_words(design, y)
    growth = (y - design.middle) * tan(design.taper_angle)
    min_shift = part.dedendum - rho - design.pinion_pitch_radius * sin(angle) ** 2 - growth
    if part.profile_shift < min_shift:
        _refuse(
            "pinion.profile_shift_modules",
            part.profile_shift / m,
            f"at least {min_shift / m:.4f}: undercut{end}",
        )
    largest = part.dedendum - part.rack_tip_radius / cos(design.taper_angle) - growth
    if part.profile_shift >= largest - 1e-3 * m:
        _refuse(
            "pinion.profile_shift_modules",
            part.profile_shift / m,
            f"less than {largest / m:.4f}: the rack's tip does not reach below the pitch circle{end}",
        )
    start = float(design.pinion_base_radius * np.hypot(1, pinion.junction_roll(design, y)))
    tip = float(pinion.tip_radius(design, y))
    if tip - part.tip_chamfer <= start + 0.1 * m:
        available_length = tip - start - 0.1 * m
        _refuse(
            "pinion.tip_chamfer_mm",
            1e3 * part.tip_chamfer,
            f"less than {1e3 * max(available_length, 0):.3f}: no flank left{end}",
        )


def _check_relief(design: PairDesign) -> None:
    """Refuse reliefs and crowning of the pinion above MAX_RELIEF modules, or longer than its flank."""
    part = design.pinion
    flank = min(
        side.pinion_base_radius * float(pinion.tip_roll(side, y) - pinion.junction_roll(side, y))
        for side in _sides(design)
        for y in _section_places(design)
    )
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
    depth = min(float(depth_below_tip(side, flank_end(side, gear.inner_radius))) for side in _sides(design))
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
        ("profile_crowning", modifications.profile_crowning, face_gear.pitch_depth(design)),
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
    ends = [
        design.shaper_tip_radius + (y - design.middle) * tan(design.taper_angle)
        for y in _section_places(design)
    ]
    deepest = min(ends) - max(side.shaper_base_radius for side in _sides(design))
    if rounding >= deepest or _land_left(design, rounding) < 0:
        max_rounding = deepest
        if _land_left(design, deepest) < 0:
            max_rounding = brentq(lambda radius: _land_left(design, radius), 0.0, deepest, xtol=ROUNDING)
        requirement = f"at most {max_rounding / m:.4f}: the shaper's tip is round"
        _refuse("shaper.tip_rounding_modules", rounding / m, requirement)


def _land_left(design: PairDesign, rounding: float) -> float:
    """Return the width (m) of the shaper's tip land with a tip rounding (m), less the thinnest allowed, on
    its rolling cylinder and at the end of the face where it is thinnest.
    """
    family = replace(design.family, shaper_tip_rounding=rounding)
    section_y = np.array(_section_places(design))
    radius = family.rounding_centre + (section_y - family.middle) * family.taper
    land = shaper_land(family, section_y) / radius * family.shaper_pitch_radius
    thinnest = THINNEST_LAND if design.is_spur else THINNEST_ROOT
    return float(np.min(np.where(np.isnan(land), -inf, land))) - thinnest * design.module


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
    if abs(design.offset) >= gear.inner_radius:
        requirement = f"within {1e3 * gear.inner_radius:.3f}, the gear's inner radius"
        _refuse("offset_mm", 1e3 * design.offset, requirement)
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
    for side in _sides(design):
        _check_flank(side)
    return limits


def _check_flank(design: PairDesign) -> None:
    """Refuse a gear whose drive flank is not generated up to the tip, or has no height, somewhere on the
    face.
    """
    gear, m = design.face_gear, design.module
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 33)
    roll, _ = face_gear.tip_parameters(design, radius)
    if np.min(roll) < 0.0:
        start = face_gear.flank_point(design, 0.0, face_gear.psi_at(design, radius, 0.0))[:, 2]
        above_datum = 1.0 - (face_gear.tip_height(design, radius) - start) / face_gear.pitch_depth(design)
        max_addendum = above_datum.min() * gear.addendum
        _refuse(
            "face_gear.addendum_modules",
            gear.addendum / m,
            f"less than {max_addendum / m:.4f}: no involute generates it",
        )
    end, _ = face_gear.end_parameters(design, radius)
    if np.any(roll >= end):
        _refuse("face_gear.addendum_modules", gear.addendum / m, "more: the flank has no height")


def _check_width(design: PairDesign) -> None:
    """Refuse a pinion narrower than NARROWEST of the gear's face, or so wide that it reaches the gear's
    axis.
    """
    gear, width = design.face_gear, design.pinion.width
    min_width, max_width = NARROWEST * (gear.outer_radius - gear.inner_radius), 2 * design.middle
    if width < min_width:
        requirement = f"at least {1e3 * min_width:.3f}, half the gear's face"
        _refuse("pinion.width_mm", 1e3 * width, requirement)
    if max_width <= min_width:
        requirement = f"more than {1e3 * width / 2:.3f}: the pinion reaches the gear's axis"
        _refuse("pinion.middle_mm", 1e3 * design.middle, requirement)
    if width >= max_width:
        _refuse(
            "pinion.width_mm", 1e3 * width, f"less than {1e3 * max_width:.3f}: it reaches the gear's axis"
        )
    numbers = PairNumbers.of_design(design)
    if numbers.last_end - numbers.first_end < min_width * (1.0 - 1e-9):
        whole = PairNumbers.of_design(replace(design, pinion=replace(design.pinion, width=2 * design.middle)))
        low, high = whole.first_end + min_width - width / 2, whole.last_end - min_width + width / 2
        requirement = f"from {1e3 * low:.3f} to {1e3 * high:.3f}, to cover half of the gear's face"
        _refuse("pinion.middle_mm", 1e3 * design.middle, requirement)
