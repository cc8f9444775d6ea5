"""Limits and checks of helical, tapered, offset and asymmetric pairs: reasons, helpful keys, one line each.

The numbers of the limits are those of `family_limits`, which `test_public_flanks` holds to the public ones.
"""

from contextlib import suppress
from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
from family_pairs import pair_of, public_pair
from public_teeth import MM, NAMES, public_numbers
from random_families import SEED, random_family, with_possible_face
from spur_values import shipped_designs

from facegear.errors import GeometryError
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.analysis import path_curvatures, section_contact_ratio
from facegear.teeth.conjugate import PairNumbers, contact_at
from facegear.teeth.curvature import relative_curvatures
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.family_range import HELP, design_limits, radii_with_lands
from facegear.teeth.limits import THINNEST_LAND, face_range, radius_limits
from facegear.teeth.opposite import fillet_curve, tip_edge_feet
from facegear.teeth.placement import mirror_teeth
from facegear.teeth.surfaces import fillet_points, flank_points
from facegear.teeth.unloaded_contact import gear_backlash, normal_backlash
from facegear.teeth.validate import check

STEPS = (1e-8, 1e-6, 1e-4)


@pytest.mark.parametrize("name", NAMES)
def test_limits_of_a_pair_are_the_public_ones_and_name_the_flank(name):
    design, numbers = public_pair(name), public_numbers(name)
    limits = check(design)
    assert limits == radius_limits(design)
    inner = {side: numbers[f"{side} inner limit mm"] for side in ("drive", "coast")}
    side = max(inner, key=lambda flank: inner[flank][0])
    other = "coast" if side == "drive" else "drive"
    assert limits.inner == pytest.approx(inner[side][0] * MM, abs=1e-12)
    assert limits.inner_reason.startswith(f"{inner[side][1]} of the {side} flank, ")
    assert limits.inner_reason.endswith(f"{inner[other][1]} of the {other} flank at {inner[other][0]:.3f}")
    pointing = numbers["pointing radius mm"]
    assert limits.outer == (np.inf if isinstance(pointing, str) else pytest.approx(pointing * MM, abs=1e-12))


@pytest.mark.parametrize("name", NAMES)
def test_the_range_of_a_face_is_where_it_is_accepted(name):
    design = public_pair(name)
    face = face_range(design, radius_limits(design))
    assert face.inner < design.face_gear.inner_radius < design.face_gear.outer_radius < face.outer
    for key, value in (("inner_radius", face.inner - 1e-6), ("outer_radius", face.outer + 1e-6)):
        with pytest.raises(GeometryError) as refused:
            check(replace(design, face_gear=replace(design.face_gear, **{key: value})))
        assert refused.value.quantity == f"face_gear.{key}_mm"
        assert str(face) in str(refused.value)
        assert "\n" not in str(refused.value)


def test_vanishing_root_land_decides_where_tapered_teeth_are_not_pointed():
    design = public_pair("P2")
    _, outer, _, reason = radii_with_lands(design, design_limits(design), THINNEST_LAND * design.module)
    assert reason == "root land vanishes, a smaller shaper.addendum_modules helps"
    less = replace(design, shaper=replace(design.shaper, addendum=0.97 * design.shaper.addendum))
    assert radii_with_lands(less, design_limits(less), THINNEST_LAND * design.module)[1] > outer


LIMITED = {
    # design, the gear's addendum mm, and the flank that the reason limits
    "undercut": ("P1", 3.5, 0),
    "no height": ("P1", 3.5, 1),
    "start of the involute": ("P2", 3.75, 0),
}


def random_faces(count):
    """Yield random families with the part of their face that the limits leave, if they leave one."""
    rng = np.random.default_rng(SEED)
    for _ in range(count):
        family = random_family(rng)
        with suppress(GeometryError):
            family = with_possible_face(family)
        yield family


@pytest.mark.parametrize("reason", LIMITED)
def test_the_key_that_is_said_to_help_moves_the_flanks_limit_inwards(reason):
    name, addendum, number = LIMITED[reason]
    design = public_pair(name)
    design = replace(design, face_gear=replace(design.face_gear, addendum=addendum * MM))
    radius, found = design_limits(design).starts[number].limit
    assert found == reason
    word, key = HELP[reason].removeprefix("a ").split()
    part, field = key.removesuffix("_modules").split(".")
    factor = {"smaller": 0.99, "larger": 1.01}[word]
    section = getattr(design, part)
    helped = replace(design, **{part: replace(section, **{field: factor * getattr(section, field)})})
    assert design_limits(helped).starts[number].limit[0] < radius


REFUSED = [
    ("P1", {"offset": 0.3}, "offset_mm"),
    ("P1", {"helix_angle": radians(40)}, None),
    ("P2", {"taper_angle": radians(12)}, None),
    ("P3", {"shaft_angle": radians(40)}, None),
    ("P1", {"pinion": {"middle": 0.3}}, "pinion.middle_mm"),
    ("P2", {"pinion": {"width": 0.06}}, None),
    ("P2", {"pinion": {"addendum": 9 * MM}}, None),
    ("P3", {"pinion": {"profile_shift": -4 * MM}}, "pinion.profile_shift_modules"),
    ("P4", {"pinion": {"rack_tip_radius": 3 * MM}}, "pinion.rack_tip_radius_modules"),
    ("P1", {"pinion": {"dedendum": 7 * MM}}, None),
    ("P4", {"shaper": {"addendum": 8 * MM}}, "shaper.addendum_modules"),
    ("P3", {"shaper": {"tip_rounding": 2 * MM}}, "shaper.tip_rounding_modules"),
    ("P4", {"face_gear": {"addendum": 5 * MM}}, "face_gear.addendum_modules"),
    ("P1", {"face_gear": {"inner_radius": 0.21}}, "face_gear.inner_radius_mm"),
]


@pytest.mark.parametrize(("name", "change", "key"), REFUSED)
def test_teeth_that_cannot_be_are_refused_in_one_line_with_a_key(name, change, key):
    design = public_pair(name)
    parts = {
        part: replace(getattr(design, part), **new) if isinstance(new, dict) else new
        for part, new in change.items()
    }
    with pytest.raises(GeometryError) as refused:
        check(replace(design, **parts))
    first = refused.value.quantity.split(".")[0]
    assert refused.value.quantity == (key or refused.value.quantity)
    assert first in ("pinion", "face_gear", "shaper", "offset_mm")
    line = str(refused.value)
    assert "\n" not in line and "nan" not in line and " = " in line and "must be" in line


def test_random_pairs_are_valid_or_refused_by_a_key():
    valid, refused = 0, set()
    for family in random_faces(25):
        design = pair_of(replace(family, shaper_teeth=min(family.shaper_teeth, family.pinion_teeth + 3)))
        design = replace(design, pinion=replace(design.pinion, bore_radius=0.2 * design.pinion_root_radius))
        try:
            limits = check(design)
        except GeometryError as error:
            refused.add(error.quantity.split(".")[0])
            continue
        gear = design.face_gear
        assert limits.inner <= gear.inner_radius < gear.outer_radius <= limits.outer
        radius = np.linspace(gear.inner_radius, gear.outer_radius, 7)
        for pair in (design, mirror_teeth(design)):
            roll, _ = face_gear.tip_parameters(pair, radius)
            assert (roll >= 0.0).all() and (face_gear.end_parameters(pair, radius)[0] > roll).all()
            assert (face_gear_fillet.root_half_angle(pair, radius) > 0.0).all()
        valid += 1
    assert valid > 7
    assert refused <= {"pinion", "face_gear", "shaper"}


def changed(design, key, step):
    """Return a pair with a small helix, taper, offset (5 mm at 1 rad), shaft angle or asymmetry."""
    values = {
        "helix_angle": step,
        "taper_angle": step,
        "offset": 0.005 * step,
        "shaft_angle": pi / 2 + step,
        "coast_pressure_angle": design.pressure_angle + step,
    }
    return replace(design, **{key: values[key]})


def pair_measures(design):
    """Return numbers of a pair that a small departure from spur teeth may move only in proportion, and gaps
    (m) of feet.
    """
    gear, numbers, gaps = design.face_gear, [], []
    radius = np.array([0.3, 0.8]) @ np.array([gear.inner_radius, gear.outer_radius]) / 1.1
    y, errors = design.middle + 0.3 * design.pinion.width, AssemblyErrors(-8e-5, 5e-4, 3e-5, 2e-5)
    for pair in (design, mirror_teeth(design)):
        ends = face_gear.tip_parameters(pair, radius), face_gear.end_parameters(pair, radius)
        numbers += [*np.ravel(ends), *face_gear.flank_point(pair, *ends[1])]
        slope = face_gear_fillet.fillet_slopes(pair, radius, 0.5)
        numbers += [*face_gear_fillet.fillet_section(pair, radius, slope)]
        numbers += [*face_gear_fillet.fillet_normal(pair, radius, slope)]
        numbers += [face_gear_fillet.root_half_angle(pair, radius), face_gear.tip_height(pair, radius)]
        numbers += [face_gear_fillet.root_height(pair, radius), *pinion.roll_ends(pair, y)]
        numbers += [*flank_points(pair, 0.5, y).position, *flank_points(pair, 0.5, y).normal]
        numbers += [*fillet_points(pair, 1.1, y).position, pinion.tip_half_angle(pair, y)]
        numbers += [*np.ravel(relative_curvatures(pair, 0.5, pair.pressure_angle))[:2]]
        contact = contact_at(PairNumbers.of_design(pair), errors)
        numbers += [contact.psi, contact.turn, contact.transmission_error, contact.y, contact.normal_roll]
        edge = face_gear.tip_edge(pair, np.array([gear.inner_radius])) * [-1.0, 1.0, 1.0]
        phi1 = np.array([-0.12, -0.06, 0.0])
        placement = phi1, phi1 * pair.pinion.teeth / gear.teeth, np.zeros(3)
        curve = fillet_curve(pair, pair.transverse_pressure_angle, pi / 2)
        gap = tip_edge_feet(pair, edge, placement, curve, pair.module).gap
        gaps += [*np.where(np.isfinite(gap), gap, 0.0).ravel()]
    numbers += [normal_backlash(design), gear_backlash(design.family, errors)]
    numbers += [radius_limits(design).inner, radius_limits(design).outer]
    return np.array(numbers, float), np.array(gaps)


@pytest.mark.parametrize(
    "key", ["helix_angle", "taper_angle", "offset", "shaft_angle", "coast_pressure_angle"]
)
def test_functions_of_a_pair_move_in_proportion_to_a_small_departure_from_spur(key):
    design = shipped_designs()["strength_only"]
    spur, spur_gaps = pair_measures(design)
    moved = [pair_measures(changed(design, key, step)) for step in STEPS]
    slopes = [(numbers - spur) / step for (numbers, _), step in zip(moved, STEPS, strict=True)]
    size = np.maximum(np.abs(slopes[1]), np.abs(spur))
    assert np.all(np.abs(slopes[0] - slopes[1]) < 3e-6 * size + 1e-6)
    assert np.all(np.abs(slopes[2] - slopes[1]) < 2e-2 * size + 1e-6)
    assert np.abs(slopes[1]).max() > 1e-3
    # feet on a spur fillet are the nearest of 2000 points, which leaves 3e-10 m
    assert np.abs(spur_gaps).max() > 1e-5
    for (_, gaps), step in zip(moved, STEPS, strict=True):
        assert np.abs(gaps - spur_gaps).max() < 0.3 * step + 3e-10


@pytest.mark.parametrize(
    "key", ["helix_angle", "taper_angle", "offset", "shaft_angle", "coast_pressure_angle"]
)
def test_contact_ratio_and_curvatures_of_the_path_go_over_into_those_of_spur(key):
    design = shipped_designs()["strength_only"]
    nearly = changed(design, key, 1e-8)
    assert section_contact_ratio(nearly) == pytest.approx(section_contact_ratio(design), abs=1e-6)
    for found, expected in zip(path_curvatures(nearly), path_curvatures(design), strict=True):
        assert found == pytest.approx(expected, rel=2e-6, abs=2e-6)
