"""The gear data sheet states what a drawing states, and the summary for the terminal holds it."""

from dataclasses import asdict, replace
from math import hypot, pi, tan
from pathlib import Path

import pytest
from contact_bodies import pair_design
from kinds_of_teeth import public_section

import facegear
from facegear.build.tooth_pair import ToothPair
from facegear.build.tooth_pair import pair_design as public_pair
from facegear.report.data_sheet import data_sheet_table, pinion_span, pinion_tooth_thickness
from facegear.schema.base import parse
from facegear.teeth.analysis import analyse
from facegear.teeth.document import pair_record
from facegear.teeth.flank_numbers import blank_numbers, flank_numbers


@pytest.fixture(scope="module", params=[0.0, 0.4e-3])
def designed(request):
    design = pair_design()
    design = replace(design, pinion=replace(design.pinion, profile_shift=request.param, thinning=0.12e-3))
    return design, pair_record(design, analyse(design))


def test_thickness_and_span_are_those_of_the_base_circle(designed):
    """The half tooth angle on the base circle, which the teeth are generated from, gives both another way."""
    design, record = designed
    half, base = design.pinion_half_base_angle, 1e3 * design.pinion_base_radius
    angle = design.pressure_angle
    thickness = 2e3 * design.pinion_pitch_radius * (half - (tan(angle) - angle))
    assert pinion_tooth_thickness(record) == pytest.approx(thickness, rel=1e-12)
    count, span = pinion_span(record)
    pitch = 2.0 * pi * base / design.pinion.teeth
    assert span == pytest.approx((count - 1) * pitch + 2.0 * base * half, rel=1e-12)
    touched = hypot(base, span / 2.0)
    assert 1e3 * design.pinion_root_radius < touched < 1e3 * design.pinion_tip_radius


def test_the_sheet_holds_diameters_face_position_and_backlash(designed):
    design, record = designed
    sheet = data_sheet_table(record).set_index("quantity")
    assert float(sheet.loc["Tip diameter", "pinion"]) == pytest.approx(
        2e3 * design.pinion_tip_radius, abs=6e-4
    )
    assert float(sheet.loc["Base diameter", "face gear"]) == pytest.approx(
        2e3 * design.gear_base_radius, abs=6e-4
    )
    plane = {
        name: float(sheet.loc[f"Pinion axis to {name} plane", "face gear"])
        for name in ("pitch", "tip", "root")
    }
    tip = float(design.family.gear_tip.height(design.mean_radius))
    root = design.shaper_lift - design.shaper_tip_radius
    assert plane["pitch"] == pytest.approx(-1e3 * (tip - design.face_gear.addendum), abs=6e-4)
    assert plane["tip"] == pytest.approx(-1e3 * tip, abs=6e-4)
    assert plane["root"] == pytest.approx(-1e3 * root, abs=6e-4)
    assert sheet.loc["Backlash along the line of action, as assembled", "unit"] == "µm"
    assert not sheet.isin(["None", "nan", "-0.000"]).any().any()


def test_the_summary_holds_key_numbers_verdicts_and_the_data_sheet():
    # No other test of this process has rated teeth of this width, so that no verdict on them is known.
    text = facegear.example().with_values({"tooth_pair.pinion.width_mm": 29.5}).summary()
    for words in ("As required so far:", "23 / 143", "No interference", "Pitch diameter", "Span over"):
        assert words in text, words


def test_the_summary_computes_no_statics_and_holds_them_once_they_are_known():
    config = Path(__file__).parents[3] / "config" / "harmonics_only.yaml"
    gearbox = facegear.load(config, results=None)
    assert "Power in" not in gearbox.summary()
    gearbox.statics()
    text = gearbox.summary()
    assert "Power in → out" in text and "Power balance" in text and "Gear data" not in text


def record_of(name):
    """Return the parts of a record of the tooth geometry that the sheet of a public design takes."""
    design = public_pair(parse(ToothPair, public_section(name)))
    gear = design.face_gear
    return {
        "design_si": asdict(design),
        "blanks": blank_numbers(design),
        "flanks": flank_numbers(design),
        "radii_mm": {"gear_inner": 1e3 * gear.inner_radius, "gear_outer": 1e3 * gear.outer_radius},
        "backlash_um": {"smallest": 100.0},
    }


def test_the_sheet_of_helical_teeth_has_a_row_for_each_flank_that_differs():
    sheet = data_sheet_table(record_of("P1")).set_index("quantity")
    assert sheet.loc["Helix angle, right hand", "pinion"] == "15"
    assert sheet.loc["Normal pressure angle", "pinion"] == "25"
    assert sheet.loc["Base helix angle, drive flank", "pinion"] == "13.566"
    assert sheet.loc["Base helix angle, coast flank", "pinion"] == "-13.566"
    assert sheet.loc["Axial force for 1 N m, outwards, drive flank", "pinion"] == "-5.9159"
    assert sheet.loc["Axial force for 1 N m, outwards, coast flank", "pinion"] == "5.9159"
    assert not sheet.index.duplicated().any() and not sheet.isin(["nan", "-0.000", "-0"]).any().any()


def test_the_sheet_of_tapered_teeth_has_lengths_at_both_ends_and_the_axial_setting():
    sheet = data_sheet_table(record_of("P2")).set_index("quantity")
    inner, middle, outer = map(float, sheet.loc["Tip diameter", "pinion"].split(" / "))
    assert outer - inner == pytest.approx(2 * 30 * tan(4 * pi / 180), abs=1e-3)
    assert middle == pytest.approx(2 * (43.125 + 3.75), abs=1e-3)
    assert sheet.loc["Backlash by axial way", "pinion"] == "65.056"
    assert sheet.loc["Half angle of the tip surface", "face gear"] == "86"
