"""Drawings of helical, tapered, offset and asymmetric teeth show both flanks as they are."""

from dataclasses import asdict

import numpy as np
import pandas as pd
import pytest
from kinds_of_teeth import public_section
from public_teeth import NAMES, public_numbers

from facegear.build.tooth_pair import ToothPair, pair_design
from facegear.report.chapter_tables import root_stress_tables
from facegear.report.data_sheet import teeth_in_words
from facegear.report.figures.teeth import tooth_pair, tooth_sections
from facegear.report.figures.tooth_skins import (
    coast_array,
    gear_skin,
    pinion_skin,
    place_pinion,
    turned_gear,
    turned_pinion,
)
from facegear.schema.base import parse
from facegear.teeth.document import flank_arrays


@pytest.fixture(scope="module", params=NAMES)
def drawn(request):
    section = parse(ToothPair, public_section(request.param))
    design = pair_design(section)
    return request.param, design, flank_arrays(design, 9, 7)


def test_the_surface_of_a_tooth_ends_where_the_next_one_begins(drawn):
    _, design, flanks = drawn
    pinion = pinion_skin(flanks, design.pinion.teeth, design.pinion.bore_radius)[0]
    gear = gear_skin(flanks, design.face_gear.teeth)[0]
    next_pinion = turned_pinion(pinion[0], 2 * np.pi / design.pinion.teeth)
    next_gear = turned_gear(gear[0], 2 * np.pi / design.face_gear.teeth)
    assert pinion[-1] == pytest.approx(next_pinion, abs=1e-15)
    assert gear[-1] == pytest.approx(next_gear, abs=1e-15)


def test_the_gears_flanks_pass_through_the_public_points(drawn):
    """Height and angle of each flank's end at the mean radius, and the side on which it stands."""
    name, design, flanks = drawn
    numbers = public_numbers(name)
    for flank, sign in (("drive", -1.0), ("coast", 1.0)):
        grid = flanks["gear_flank"] * [-1, 1, 1] if flank == "drive" else coast_array(flanks, "gear_flank")
        end = grid[-1, 3]
        record = numbers[f"{flank} fillet at R {1e3 * design.mean_radius:.3f} mm"]
        assert np.hypot(end[0], end[1]) == pytest.approx(design.mean_radius, rel=1e-12)
        assert 1e3 * end[2] == pytest.approx(record["start_z_mm"], abs=1e-8)
        assert np.arctan2(end[0], end[1]) == pytest.approx(record["start_gear_angle_rad"], abs=1e-11)
        assert sign * (np.arctan2(end[0], end[1]) - np.arctan2(*grid[0, 3, :2])) > 0.0


def test_a_pinion_is_drawn_on_its_axis(drawn):
    _, design, _ = drawn
    middle = place_pinion(np.array([0.0, design.middle, 0.0]), asdict(design))
    sine, cosine = np.sin(design.shaft_angle), np.cos(design.shaft_angle)
    assert middle == pytest.approx([design.offset, design.middle * sine, -design.middle * cosine], abs=1e-15)


def test_unlike_flanks_and_angles_are_told_in_words():
    values = parse(ToothPair, public_section("P3")).model_dump(mode="json")
    assert teeth_in_words(values) == (
        "module 3 mm, pressure angle 25 deg on drive, 20 deg on coast flanks, shaft angle 100 deg. "
    )


def test_teeth_without_a_pointing_radius_are_drawn(drawn):
    _, design, flanks = drawn
    record = {
        "design_si": asdict(design),
        "radii_mm": dict.fromkeys(
            ("pinion_tip", "pinion_pitch", "pinion_fillet_start", "pinion_base", "pinion_root"), 40.0
        )
        | {"gear_inner": 217.0, "gear_outer": 240.0, "gear_contact_path_nominal": 226.0},
        "limits_mm": {"inner_undercut": 214.6, "outer_pointing": None},
        "unloaded": {"drive": {"path_pinion_y_mm": [224.0, 228.0]}},
        "flanks": {
            "drive": {"inner_limit_mm": 214.6, "inner_cause": "undercut"},
            "coast": {"inner_limit_mm": 199.4, "inner_cause": "no height"},
        },
    }
    sections = tooth_sections(record, flanks)
    note = sections.panels[1].x.note
    assert note.startswith("undercut below 214.600 mm") and "not pointed" in note
    assert "contact path from 224.000 to 228.000 mm along the pinion" in note
    assert len(tooth_pair(record, flanks).panels) == 1


def test_root_stress_of_every_flank_is_listed_where_flanks_differ():
    summary = pd.DataFrame({"torque_n_m": [300.0, 600.0], "largest_mpa": [250.0, 444.0]})
    coast = summary.assign(largest_mpa=[187.0, 356.0])
    for back, shown in ((summary, []), (coast, ["drive", "drive", "back", "back"])):
        by_name = {"drive": summary, "back": back}
        flanks = [part.assign(gear="upper", flank=name) for name, part in by_name.items()]
        tables = {"root_stress": summary, "root_stress_by_flank": pd.concat(flanks)}
        by_flank = root_stress_tables(tables)[1:]
        assert [flank for table in by_flank for flank in table.frame["flank"]] == shown
