"""Keys of helical, tapered, offset and asymmetric teeth."""

from dataclasses import asdict

import pytest
from kinds_of_teeth import public_section
from public_teeth import NAMES, public_design, public_numbers

import facegear
from facegear.build.checks import geometric_backlash
from facegear.build.load import config_of
from facegear.build.tooth_pair import ToothPair, check_lower_gear, pair_design
from facegear.checking import check_config
from facegear.errors import ConfigError
from facegear.pipeline.stages.teeth import geometry
from facegear.schema.base import parse

PER_MM = {"P2": 65.055955826}
"""Change of backlash (um) by 1 mm of axial setting of public designs with taper, from the reference page."""


def make_config(name: str, **changes) -> dict:
    """Return the plain values of a config of a public design alone."""
    return {"case": "kind", "tooth_pair": {**public_section(name), **changes}}


def flat(values, key=""):
    """Return the numbers of nested mappings by dotted key."""
    if not isinstance(values, dict):
        return {key: values}
    return {
        name: value for inner, part in values.items() for name, value in flat(part, f"{key}.{inner}").items()
    }


@pytest.mark.parametrize("name", NAMES)
def test_the_keys_make_the_public_design(name):
    family = pair_design(parse(ToothPair, public_section(name))).family
    given, found = flat(asdict(public_design(name))), flat(asdict(family))
    assert found == {
        key: pytest.approx(value, rel=1e-14, abs=1e-20)
        if key != ".rack.pressure_angles"
        else pytest.approx(value)
        for key, value in given.items()
    }


@pytest.mark.parametrize("name", NAMES)
def test_backlash_as_assembled_is_the_public_one_and_grows_with_the_axial_setting(name):
    numbers, section = public_numbers(name), public_section(name)
    design = pair_design(parse(ToothPair, section))
    nominal, scale = (
        numbers["backlash at gear pitch circle um"],
        design.gear_normal_arm / design.family.gear_pitch_radius,
    )
    assert geometric_backlash(parse(ToothPair, section)) / scale == pytest.approx(nominal, abs=1e-7)
    section["assembly"] = {"pinion_axial_um": 1000}
    grown = geometric_backlash(parse(ToothPair, section)) / scale - nominal
    assert grown == pytest.approx(PER_MM.get(name, 0.0), abs=1e-7)


@pytest.mark.parametrize("name", NAMES)
def test_public_designs_mesh_freely_with_their_contact_ratio_and_backlash(name):
    """Tips of both gears clear the other on all of them; a point beside a tapered tooth counted as inside its
    tip land, so that P2 jammed by 408 um and P4 interfered by 2 um.
    """
    record = geometry(parse(ToothPair, public_section(name))).content["pair"]
    numbers = public_numbers(name)
    assert record["interference"] is None and record["smallest_gap"]["gap_um"] > 0.0
    assert record["contact_ratio"] == pytest.approx(numbers["drive contact ratio"], rel=1e-10)
    arm = pair_design(parse(ToothPair, public_section(name)))
    scale = arm.gear_normal_arm / arm.family.gear_pitch_radius
    backlash = scale * numbers["backlash at gear pitch circle um"]
    assert record["backlash_um"]["smallest"] == pytest.approx(backlash, abs=1e-7)


def test_one_angle_for_both_flanks_is_that_angle():
    both = public_section("P3") | {"pressure_angle_deg": {"drive": 25, "coast": 25}}
    one = public_section("P3") | {"pressure_angle_deg": 25}
    assert pair_design(parse(ToothPair, both)) == pair_design(parse(ToothPair, one))


BODY = {"card": "case_carburised_din3990_11", "root_roughness_um": 16}
STRENGTH = {
    "pinion": BODY,
    "face_gear": BODY,
    "duty": [{"torque_n_m": 400, "speed_rpm": 6000, "hours": 1}],
}


@pytest.mark.parametrize(("name", "kinds"), [("P1", None), ("P2", "tapered teeth")])
def test_a_check_says_which_teeth_the_standard_cannot_rate(name, kinds):
    values = make_config(name) | {"strength": STRENGTH}
    findings = check_config(config_of(values), values)
    lines = [line for line in findings.remarks if line.startswith("strength: ")]
    expected = f"strength: rated by contact alone, as ISO 6336 does not know {kinds}"
    assert not findings.failures and (expected in lines) == bool(kinds)


def test_a_tolerance_of_the_axial_setting_is_a_key_of_the_config():
    values = facegear.load("config/microgeometry.yaml").config.model_dump(mode="json")
    cause = values["tolerances"]["causes"][0]
    values["tolerances"]["causes"] = [{**cause, "moves": {"tooth_pair.assembly.pinion_axial_um": 1}}]
    config = config_of(values)
    assert config.tolerances.causes[0].moves == {"tooth_pair.assembly.pinion_axial_um": 1}


def test_radii_below_undercut_of_a_lower_gear_that_is_another_one_are_refused_by_key():
    """Contact of the lower gear ended in Newton steps of its flank, long after the check of the config."""
    section = parse(ToothPair, public_section("P4"))
    refused = r"tooth_pair\.face_gear\.inner_radius_mm = 231\.0: must be between 242\.410 \(undercut of the"
    with pytest.raises(ConfigError, match=rf"{refused} .* lower gear's limit$"):
        check_lower_gear(section)
    check_lower_gear(parse(ToothPair, public_section("P1")))
