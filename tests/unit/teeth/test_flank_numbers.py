"""Numbers of both flanks against the public designs, which were computed outside the package."""

import numpy as np
import pytest
from kinds_of_teeth import public_section
from public_teeth import NAMES, public_numbers

from facegear.build.tooth_pair import ToothPair, pair_design
from facegear.schema.base import parse
from facegear.teeth.flank_numbers import backlash_slope, blank_numbers, flank_numbers

TORQUE = 500.0
"""Torque of the public forces, N m."""


def design_of(name):
    """Return a public design as its config gives it."""
    return pair_design(parse(ToothPair, public_section(name)))


@pytest.fixture(scope="module", params=NAMES)
def design(request):
    return request.param, design_of(request.param)


def test_paths_and_sliding_are_the_public_ones(design):
    name, pair = design
    numbers, public = flank_numbers(pair), public_numbers(name)
    for flank in ("drive", "coast"):
        part = numbers[flank]
        for end, place in zip(("first", "last"), range(2), strict=True):
            *point, edge = public[f"{flank} path {end} xyz mm"]
            assert part["path_mm"][place] == pytest.approx(point, abs=1e-8)
            assert part["path_edges"][place] == edge
        sliding = public[f"{flank} sliding first, middle, last mm per rad of pinion"]
        assert part["sliding_mm_per_rad"] == pytest.approx(sliding, abs=1e-8)
        assert part["contact_ratio"] == pytest.approx(public[f"{flank} contact ratio"], rel=1e-10)


def test_forces_on_the_pinion_are_the_public_ones(design):
    name, pair = design
    numbers, public = flank_numbers(pair), public_numbers(name)
    for flank in ("drive", "coast"):
        part = numbers[flank]
        along, up = public[f"{flank} force on pinion along its axis, along u N"]
        assert TORQUE * part["axial_force_per_torque_per_m"] == pytest.approx(along, rel=1e-12, abs=1e-9)
        assert TORQUE * part["separating_force_per_torque_per_m"] == pytest.approx(up, rel=1e-12)
        force = np.linalg.norm(public[f"{flank} force on gear at 500 N m, x y z N"])
        assert TORQUE * part["force_per_torque_per_m"] == pytest.approx(force, rel=1e-12)


def test_the_involute_begins_at_the_public_radius(design):
    name, pair = design
    numbers, public = flank_numbers(pair), public_numbers(name)
    for flank in ("drive", "coast"):
        inner, middle, outer = numbers[flank]["form_radii_mm"]
        assert middle == pytest.approx(public[f"{flank} pinion form radius at ym mm"], abs=1e-9)
        assert (outer > middle > inner) == (pair.taper_angle > 0.0)


def test_backlash_grows_with_the_axial_setting_as_the_public_one(design):
    name, pair = design
    slope = backlash_slope(pair.family)
    assert 1e3 * slope == pytest.approx(public_numbers(name)["its change by 1 mm outwards um"], abs=1e-8)


@pytest.mark.parametrize(("name", "helix", "module"), [("P1", 15, 3.5), ("P4", -10, 4), ("P3", 0, 3)])
def test_a_helix_shifts_the_phase_as_the_rack_moves_along_its_teeth(name, helix, module):
    """Moved by w along the axis, a rack has moved w tan(helix) across; its pitch is pi m / cos(helix)."""
    numbers = flank_numbers(design_of(name))
    shift = np.degrees(2 * np.sin(np.radians(helix)) / module)
    assert numbers["drive"]["phase_deg_per_mm"] == pytest.approx(shift, abs=1e-12)
    assert numbers["coast"]["phase_deg_per_mm"] == pytest.approx(-shift, abs=1e-12)


def test_an_axial_pitch_of_a_helical_pinion_is_a_whole_turn_of_phase():
    pair = design_of("P1")
    helicoid = pair.family.pinion_flanks[0]
    pitch = 2 * np.pi * helicoid.base_radius * helicoid.cosine / (pair.pinion.teeth * helicoid.sine)
    numbers = flank_numbers(pair)["drive"]
    assert 1e3 * pitch * numbers["phase_deg_per_mm"] == pytest.approx(360.0, rel=1e-14)


def test_the_span_of_a_helical_pinion_is_that_of_the_standard():
    """ISO 21771: W_k = m_n cos(a_n) ((k - 1/2) pi + z inv(a_t)) + 2 x m_n sin(a_n), less the thinning."""
    pair = design_of("P1")
    count, span = blank_numbers(pair)["span"]
    angle, transverse = np.radians(25), np.arctan(np.tan(np.radians(25)) / np.cos(np.radians(15)))
    involute = np.tan(transverse) - transverse
    nominal = 3.5 * np.cos(angle) * ((count - 0.5) * np.pi + 25 * involute)
    assert span == pytest.approx(nominal - 0.1, rel=1e-13)
    assert all(blank_numbers(other)["span"] is None for other in map(design_of, ("P2", "P3")))


def test_heights_and_tip_radii_are_the_public_ones(design):
    name, pair = design
    numbers, public = blank_numbers(pair), public_numbers(name)
    assert numbers["tip_heights_mm"][1] == pytest.approx(public["tip height z at mean radius mm"], abs=1e-9)
    assert numbers["root_heights_mm"][1] == pytest.approx(public["root height z at mean radius mm"], abs=1e-9)
    assert numbers["transverse_module_mm"] == pytest.approx(public["transverse module mm"], rel=1e-13)
    assert numbers["pitch_radii_mm"][0] == pytest.approx(public["pinion pitch radius mm"], rel=1e-13)
