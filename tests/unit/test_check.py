"""`facegear check` finds in seconds what a run would find later, and keys that have no effect."""

from pathlib import Path

import pytest
from ruamel.yaml import YAML

from facegear.__main__ import main
from facegear.build.load import load_config
from facegear.checking import check_config
from facegear.new_machine.first_machine import first_machine
from facegear.new_machine.wishes import MachineWishes
from facegear.schema.yaml_file import read_yaml

ROOT = Path(__file__).parents[2]
SHIPPED = sorted([*(ROOT / "config").glob("*.yaml"), *(ROOT / "examples" / "machines").glob("*.yaml")])


def checked(path):
    return check_config(load_config(path), read_yaml(path))


def write_changed(folder, changes, base="facegear/example.yaml"):
    """A copy of a shipped config with dotted keys changed."""
    values = YAML(typ="safe").load((ROOT / base).read_text())
    for key, value in changes.items():
        *sections, last = key.split(".")
        inside = values
        for section in sections:
            inside = inside.setdefault(section, {})
        inside[last] = value
    path = folder / "own.yaml"
    with path.open("w") as stream:
        YAML(typ="safe").dump(values, stream)
    return path


RACK = "tooth_pair.pinion.rack_tip_radius_modules"


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({RACK: 0.25}, "tooth_pair: the teeth interfere: at gear radius"),
        ({RACK: 0.25, "tooth_pair.pinion.thinning_um": 1}, "tooth_pair: the bodies jam"),
    ],
)
def test_what_would_end_a_run_ends_the_check_in_one_line(changes, line, tmp_path, capsys):
    path = write_changed(tmp_path, changes)
    assert main(("check", str(path))) == 1
    message = capsys.readouterr().err
    assert message.startswith(f"{path}: would fail later: {line}") and message.count("\n") == 1


def test_a_face_beside_the_path_of_contact_is_remarked(tmp_path):
    """Contact at the end of a face was found by the contact analysis alone."""
    path = tmp_path / "own.yaml"
    wishes = MachineWishes(23, 143, 3.75, case="own", torque_n_m=600, speed_rpm=7500, inner_radius_mm=300)
    path.write_text(first_machine(wishes).text)
    remarks = checked(path).remarks
    assert any("the path of contact, at gear radius 268.1 mm, lies beside the face of" in r for r in remarks)


def test_fillets_too_sharp_to_be_rated_are_refused_with_the_key_that_rounds_them(tmp_path, capsys):
    path = write_changed(
        tmp_path, {"tooth_pair.module_mm": 1.875, "tooth_pair.pinion.bore_radius_mm": 12} | HALF
    )
    assert main(("check", str(path))) == 1
    message = capsys.readouterr().err
    assert "it is too coarse to resolve their stress; a larger tooth_pair.shaper.tip_rounding" in message
    assert " mm (fillet_depth_mm), 2 times the smallest radius of the fillets" in message
    assert message.count("\n") == 1


HALF = {
    "tooth_pair.face_gear.inner_radius_mm": 125,
    "tooth_pair.face_gear.outer_radius_mm": 137.5,
    "transmission.backlash_um": 50,
    "mesh.resolution": {"profile_mm": 1.0, "width_mm": 3, "thickness_mm": 2, "fillet_depth_mm": 0.4},
    "contact.torques_n_m": [300, 600, 700],
}
TWO = "config/two_pinion.yaml"


@pytest.mark.parametrize(
    ("changes", "base", "line"),
    [
        ({}, TWO, "no load at rest: engine B/upper"),
        (
            {"contact.torques_n_m": [150, 500], "mesh_stiffness.torque_n_m": 500},
            TWO,
            "torques_n_m ends at 500",
        ),
        ({"contact.torques_n_m": [300, 1000]}, "facegear/example.yaml", "contact.torques_n_m begins at 300"),
    ],
)
def test_what_a_run_would_warn_of_is_said_at_once(changes, base, line, tmp_path):
    assert any(line in remark for remark in checked(write_changed(tmp_path, changes, base)).remarks)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_no_shipped_config_would_fail_later(path):
    assert not checked(path).failures


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        ("contact: {positions_per_pitch: 16}\nmesh: {resolution: fine}\n", ["contact", "mesh"]),
        ("dynamics: {sweep: {chunks: 1, overlap_points: 3}}\n", ["dynamics.sweep.overlap_points"]),
        ("mesh_stiffness: {definition: local}\n", ["mesh_stiffness.definition"]),
        ("dynamics: {speed_rpm: 5000}\n", []),
        ("load_sharing: {cycles: 100}\n", []),
    ],
)
def test_keys_without_effect_are_listed_and_no_others(text, keys, tmp_path):
    base = (ROOT / "config" / "harmonics_only.yaml").read_text()
    values = YAML(typ="safe").load(base) | {"extends": "base.yaml"}
    for name in ("paper.yaml",):
        (tmp_path / name).write_text((ROOT / "config" / name).read_text())
    (tmp_path / "base.yaml").write_text(base)
    assert values["mesh_stiffness"]["source"] == "harmonics"
    path = tmp_path / "own.yaml"
    path.write_text(f"extends: base.yaml\ncase: own\n{text}")
    opening = "without effect: "
    listed = [line for line in checked(path).remarks if line.startswith(opening)]
    assert [line.removeprefix(opening).partition(":")[0] for line in listed] == keys


def test_no_shipped_config_lists_a_key_without_effect_but_one():
    """Each input of unequal_inputs.yaml has its own torque, and the schema requires the common one."""
    lines = [line for path in SHIPPED for line in checked(path).remarks if "without effect" in line]
    assert lines in (
        [],
        ["without effect: transmission.torque.per_input_n_m: every input has a torque_n_m of its own"],
    )
