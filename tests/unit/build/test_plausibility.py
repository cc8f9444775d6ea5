"""A value in a wrong unit is pointed out by `check`, with the size that teeth of steel suggest."""

import json
from copy import deepcopy
from pathlib import Path

import pytest

from facegear.__main__ import main
from facegear.build.cases import expand_cases
from facegear.build.load import config_of, load_config, read_layers
from facegear.errors import ConfigErrors
from facegear.schema.plausibility import expected_sizes, plausibility_notes

ROOT = Path(__file__).parents[3]
SHIPPED = sorted(
    [*(ROOT / "config").glob("*.yaml"), *(ROOT / "examples" / "machines").glob("*.yaml")]
    + [ROOT / "facegear" / "example.yaml"]
)
SHAFT = "transmission.shafts.input.bearings.0.radial_n_per_m"
WRONG_UNITS = {
    "mass in g": ("concentric", "transmission.pinion.mass_kg", 1e3, "g"),
    "inertia in kg mm2": ("concentric", "transmission.face_gear.inertia_kg_m2", 1e6, "kg mm2"),
    "mesh stiffness in N/um": ("concentric", "mesh_stiffness.mean_n_per_m", 1e-6, "N/um"),
    "inertia beyond its bound": ("webs", "transmission.face_gear.inertia_kg_m2", 1e6, "kg mm2"),
    "bearing x in N/um": ("concentric", "transmission.pinion.bearing_stiffness_n_per_m.x", 1e-6, "N/um"),
    "bearing z in N/um": ("concentric", "transmission.face_gear.bearing_stiffness_n_per_m.z", 1e-6, "N/um"),
    "shaft bearing in N/um": ("shafts", SHAFT, 1e-6, "N/um"),
    "backlash in mm": ("concentric", "transmission.backlash_um", 1e-3, "mm"),
    "torque in kN m": ("concentric", "transmission.torque.per_input_n_m", 1e-3, "kN m"),
    "contact torques in kN m": ("concentric", "contact.torques_n_m", 1e-3, "kN m"),
    "module in m": ("concentric", "tooth_pair.module_mm", 1e-3, "m"),
    "face width in m": ("concentric", "tooth_pair.pinion.width_mm", 1e-3, "m"),
    "face radius in m": ("strength_only", "tooth_pair.face_gear.outer_radius_mm", 1e-3, "m"),
    "mesh damping in kN s/m": ("concentric", "transmission.damping.mesh_n_s_per_m", 1e-3, "kN s/m"),
    "Ra in mm": ("friction", "lubrication.pinion.ra_um", 1e-3, "mm"),
}


def place_of(values, key):
    *sections, last = (int(part) if part.isdecimal() else part for part in key.split("."))
    for section in sections:
        values = values[section]
    return values, last


@pytest.mark.parametrize("wrong", WRONG_UNITS)
def test_a_wrong_unit_is_pointed_out_by_check_with_the_unit_that_was_meant(wrong, tmp_path, capsys):
    name, key, factor, unit = WRONG_UNITS[wrong]
    values = read_layers(ROOT / "config" / f"{name}.yaml")
    values |= {"studies": [], "reproduction": None}
    if values.get("strength"):
        values["strength"]["duty_csv"] = str(ROOT / "config" / "duty_cycle.csv")
    inside, last = place_of(values, key)
    given = inside[last]
    inside[last] = [factor * one for one in given] if isinstance(given, list) else factor * given
    path = tmp_path / "own.yaml"
    path.write_text(json.dumps(values, default=str))
    main(("check", str(path)))
    said = capsys.readouterr()
    dotted = key.replace(".0.", "[0].")
    pointed = [line for line in (said.out + said.err).splitlines() if dotted in line]
    assert any(f"; is it in {unit}?" in line for line in pointed), said


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_no_shipped_config_has_an_implausible_value(path):
    cases = expand_cases(load_config(path))
    assert [note for values in cases.values() for note in plausibility_notes(values)] == []


def test_every_expected_size_of_the_example_is_noted_far_beyond_it_and_not_within():
    values = config_of({"extends": str(ROOT / "facegear" / "example.yaml")}).model_dump(mode="json")
    alone = [size for size in expected_sizes(values) if "[" not in size.key]  # of lists the largest counts
    assert len(alone) >= 20
    for size in alone:
        parts = size.key.replace("[", ".").replace("]", "")
        for factor, is_noted in ((size.high * 35, True), (size.low / 35, True), (size.high * 25, False)):
            changed = deepcopy(values)
            inside, last = place_of(changed, parts)
            inside[last] = factor
            assert any(note.startswith(size.key) for note in plausibility_notes(changed)) is is_noted


@pytest.mark.parametrize("stiffness", [0.0, 1e12, 1e14])
def test_no_spring_and_a_rigid_one_are_as_plausible_as_any(stiffness):
    values = read_layers(ROOT / "facegear" / "example.yaml")
    values["transmission"]["pinion"]["bearing_stiffness_n_per_m"]["z"] = stiffness
    assert plausibility_notes(values) == []


@pytest.mark.parametrize("junk", [None, "x", float("nan"), -3, 10**400, [], {"a": 1}])
@pytest.mark.parametrize(
    "key", ["tooth_pair", "tooth_pair.module_mm", "contact", "transmission", "lubrication"]
)
def test_values_that_are_refused_elsewhere_end_in_no_error_here(key, junk):
    values = read_layers(ROOT / "facegear" / "example.yaml") | {"lubrication": {"pinion": {"ra_um": 0.3}}}
    inside, last = place_of(values, key)
    inside[last] = junk
    assert isinstance(plausibility_notes(values), list)


@pytest.mark.parametrize(("angle", "end"), [(10.0, "equal to 20"), (1.5, "equal to 20; is it in rad?")])
def test_an_angle_beyond_half_a_turn_in_rad_is_not_taken_for_one(angle, end):
    """An angle of 10 deg was asked whether it is in rad, 573 deg."""
    values = {"extends": str(ROOT / "facegear" / "example.yaml"), "tooth_pair": {"shaft_angle_deg": angle}}
    with pytest.raises(ConfigErrors) as refused:
        config_of(values)
    assert refused.value.lines[0].endswith(end)
