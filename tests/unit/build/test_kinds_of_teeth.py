"""Keys of helical, tapered, offset and asymmetric teeth."""

from dataclasses import asdict
from pathlib import Path

import pytest
from kinds_of_teeth import public_section
from public_teeth import NAMES, public_design, public_numbers

import facegear
from facegear.build.checks import geometric_backlash
from facegear.build.config import resolved_values
from facegear.build.early_checks import pair_findings
from facegear.build.load import config_of, read_layers
from facegear.build.tooth_pair import ToothPair, pair_design
from facegear.checking import check_config
from facegear.errors import ConfigErrors, FacegearError
from facegear.pipeline.stages.teeth import geometry
from facegear.schema.base import parse

ROOT = Path(__file__).parents[3]
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


SPRINGS = dict.fromkeys("xyz", 2e8)
BODY = {"mass_kg": 1, "inertia_kg_m2": 0.002, "bearing_stiffness_n_per_m": SPRINGS}
ONE_GEAR = {
    "mesh_stiffness": {"torque_n_m": 400},
    "transmission": {
        "pinions": [{"name": "engine", "role": "input", "angle_deg": 0}],
        "face_gears": ["lower"],
        "pinion": BODY,
        "face_gear": BODY,
        "damping": {"mesh_n_s_per_m": 1500, "mass_per_s": 50, "bearing_s": 2e-6},
        "transmission_error": "from_contact",
        "torque": {"per_input_n_m": 500, "tail_share": 0},
    },
    "dynamics": {"speed_rpm": 6000, "sweep": {"from_rpm": 500, "to_rpm": 9000, "points": 4}},
}
"""A machine of a lower gear alone, with stiffness from contact."""


@pytest.mark.parametrize(
    ("changes", "turned_over"),
    [
        ({"offset_mm": 2.0}, "tooth_pair.offset_mm = -2 and"),
        ({"shaft_angle_deg": 91.0}, "tooth_pair.shaft_angle_deg = 89 and"),
        ({"assembly": {"offset_um": 60}}, "tooth_pair.assembly.offset_um = -60 and"),
        ({"assembly": {"shaft_angle_error_deg": 0.01}}, "shaft_angle_error_deg = -0.01 and"),
    ],
)
def test_a_lower_gear_alone_that_differs_from_an_upper_one_is_refused(changes, turned_over):
    """Contact took the upper gear, the rows of the machine the lower one, in silence."""
    with pytest.raises(FacegearError) as refused:
        config_of({**make_config("P2", **changes), **ONE_GEAR})
    message = str(refused.value)
    assert 'transmission.face_gears = ["lower"]: must be [upper]' in message and turned_over in message


def test_a_lower_gear_alone_on_axes_that_samples_move_is_refused():
    cause = {"name": "axes", "spread": 5, "moves": {"tooth_pair.assembly.offset_um": 1}, "source": "drawing"}
    values = {**make_config("P2"), **ONE_GEAR, "tolerances": {"samples": 256, "causes": [cause]}}
    with pytest.raises(
        FacegearError, match=r"\[upper\] where samples or designs change tooth_pair\.assembly"
    ):
        config_of(values)


def test_a_lower_gear_alone_at_right_angles_or_without_bodies_of_teeth_is_a_machine():
    config_of({**make_config("P1"), **ONE_GEAR})
    bare = dict.fromkeys(("pinion", "face_gear", "shaper"))
    table = [{"order": 1, "sin_n_per_m": 0.0, "cos_n_per_m": 1e7}]
    given = {"mesh_stiffness": {"source": "harmonics", "mean_n_per_m": 4e8, "table": table}}
    section = {**public_section("P2"), **bare, "offset_mm": 2.0}
    machine = ONE_GEAR["transmission"] | {"backlash_um": 100, "transmission_error": {"amplitude_um": 0}}
    config_of({"case": "kind", **ONE_GEAR, **given, "transmission": machine, "tooth_pair": section})


def make_machine_of_two_gears(teeth: dict) -> dict:
    """Return the plain values of the shipped helical machine with other teeth and two face gears."""
    values = read_layers(ROOT / "config" / "helical.yaml") | {"tooth_pair": teeth}
    values["transmission"] |= {
        "face_gears": ["lower", "upper"],
        "pinions": values["transmission"]["pinions"][:1],
    }
    return values


@pytest.mark.parametrize(
    ("name", "key", "decides"),
    [
        ("P4", "face_gear.inner_radius_mm = 231.0", "undercut of the coast flank"),
        ("P3", "pinion.middle_mm = 162.0", "to cover half of the gear's face"),
    ],
)
def test_a_lower_gear_that_cannot_exist_is_refused_by_its_key(name, key, decides):
    """The machine passed, and its run ended in a solver that found no flank at a height."""
    with pytest.raises(ConfigErrors) as refused:
        config_of(make_machine_of_two_gears(public_section(name)))
    (line,) = refused.value.lines
    assert f"tooth_pair.{key}: must be " in line and decides in line
    assert "for the lower gear, which the pinions meet at offset_mm = " in line


def test_a_check_tells_what_is_wrong_with_the_teeth_of_another_lower_gear():
    """The upper gear's contact lies on its face, that of the lower gear beside it, which went unsaid."""
    teeth = public_section("P4") | {"offset_mm": -15}
    teeth["face_gear"]["inner_radius_mm"] = 243
    teeth["pinion"]["middle_mm"] = 247
    findings = pair_findings(resolved_values(config_of(make_machine_of_two_gears(teeth))))
    assert len(findings.facts) == 2 and findings.facts[0].startswith("geometry: contact ratio 1.673")
    assert len(findings.remarks) >= 2
    assert all(line.startswith("lower gear: tooth_pair: ") for line in findings.remarks)
