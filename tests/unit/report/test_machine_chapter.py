"""The chapter on the machine says what an engineer looks for first."""

from dataclasses import asdict

import pandas as pd
import pytest
from contact_bodies import pair_design

import facegear
from facegear.pipeline.needs import stage_needs
from facegear.pipeline.run import call
from facegear.pipeline.table import STAGES
from facegear.report.case import _tables as case_tables
from facegear.report.contents import caption_of
from facegear.report.machine import Base, key_numbers, machine_chapter


@pytest.fixture(scope="module")
def example():
    values = facegear.example().values
    harmonics = pd.DataFrame({"order": [0, 1], "sin_n_per_m": [0.0, 0.0], "cos_n_per_m": [4.1e8, 1e7]})
    return values, call(STAGES["ratings"], {"harmonics": harmonics, **stage_needs("ratings", values)}).content


def number_of(text):
    """Return the first number of a cell."""
    return float(text.split(" ")[0].replace(",", ""))


def test_key_numbers_are_ratio_torque_speed_frequency_and_power(example):
    numbers = key_numbers(example[1], None).set_index("quantity")
    assert numbers.loc["Gear ratio (gear teeth over pinion teeth)", "value"] == f"{143 / 23:.4g}"
    assert numbers.loc["Mesh frequency", "value"] == "2,875"
    torque = number_of(numbers.loc["Torque of the output gear", "value"])
    speed = number_of(numbers.loc["Speed of the face gears", "value"])
    bodies = example[1]["bodies"].set_index("body")["power_kw"]
    assert torque * speed * 3.14159265 / 30e3 == pytest.approx(-bodies["upper face gear"], rel=1e-3)


def test_a_machine_in_balance_says_so_and_one_out_of_balance_by_how_much(example):
    values, tables = example
    assert "The power brought in equals the power taken out" in machine_chapter(values, tables).text
    off = tables["ratings"].assign(value=lambda t: t["value"].mask(t["quantity"] == "power_imbalance", -0.07))
    text = machine_chapter(values, {**tables, "ratings": off}).text
    assert "The power taken out is larger than the power brought in, by 7 % of the larger of both." in text


def test_friction_loss_is_taken_off_the_power_out(example):
    values, tables = example
    lossy = {**tables, "machine_loss": pd.DataFrame({"bin": [0, -1], "loss_percent": [0.58, 0.7]})}
    numbers = key_numbers(lossy, None).set_index("quantity")["value"].map(number_of, na_action=None)
    power_in, out = (
        numbers["Power brought in"],
        numbers["Power taken out, less the friction loss of the meshes"],
    )
    assert out == pytest.approx(power_in * (1.0 - 0.0058), rel=1e-4)
    assert numbers["Power taken out, without friction"] == pytest.approx(power_in, rel=1e-4)
    assert "Power taken out" not in numbers
    assert (
        "Friction is not in these torques and powers. It takes 0.58 %" in machine_chapter(values, lossy).text
    )


def pair_record():
    """Return what the chapter reads of the record of a spur pair."""
    return {
        "design_si": asdict(pair_design()),
        "radii_mm": {"gear_inner": 190.0, "gear_outer": 212.0, "gear_contact_path_nominal": 202.0},
        "limits_mm": {"inner_undercut": 188.0, "outer_pointing": 230.0},
        "unloaded": {"drive": {"path_pinion_y_mm": [198.0, 198.2]}},
        "contact_ratio": 1.5,
        "backlash_um": {"smallest": 100.0},
    }


def test_a_face_with_one_limit_does_not_show_it_as_a_range():
    """The row "Radii without undercut and pointed teeth" of tapered teeth held one radius."""
    pair = {**pair_record(), "limits_mm": {"inner_undercut": 188.0, "outer_pointing": None}}
    numbers = key_numbers({}, pair).set_index("quantity")["value"]
    assert numbers["Smallest radius that the face may have; it has no largest"] == "188"
    assert not [name for name in numbers.index if name.startswith(("Radii", "Largest radius"))]


def test_the_shift_of_the_contact_path_is_a_number():
    numbers = key_numbers({}, pair_record()).set_index("quantity")["value"]
    assert numbers["Shift of the unloaded contact path, positive outwards"] == "-3.9"


def test_figures_are_named_by_content_and_numbered_after_the_paper_only_where_it_is_reproduced():
    study = {"name": "backlash", "title": "Effect of backlash", "figures": [13, 14]}
    own, paper = ({"studies": [study], "reproduction": given} for given in (None, {"claims": "x"}))
    assert caption_of("study_backlash_idlers", paper).startswith("Figure 14 of the paper: Effect of backlash")
    assert caption_of("mesh_sweep", paper).startswith("Figure 12 of the paper")
    for name in ("study_backlash_idlers", "mesh_sweep", "campbell"):
        assert "Figure" not in caption_of(name, own)


def test_a_machine_whose_output_is_a_pinion_shows_its_torque_and_ratio(example):
    """It showed the ratio of teeth, and the torque of the gear that only passes it on: 0."""
    pinion = {"role": "idler", "angle_deg": 180.0, "name": "wheel", "torque_n_m": -250.0}
    section = {
        **example[0]["transmission"],
        "pinions": [{"role": "input", "angle_deg": 0.0, "name": "engine", "torque_n_m": 250.0}, pinion],
        "face_gears": ["upper"],
        "torque": {"per_input_n_m": 0.0, "tail_share": 0.0},
    }
    harmonics = pd.DataFrame({"order": [0], "sin_n_per_m": [0.0], "cos_n_per_m": [4.1e8]})
    needs = {**stage_needs("ratings", example[0]), "transmission": section}
    numbers = key_numbers(call(STAGES["ratings"], {"harmonics": harmonics, **needs}).content, None).set_index(
        "quantity"
    )["value"]
    assert numbers["Torque of the output pinions"] == "250"
    assert numbers["Ratio of speeds, input over output pinion"] == "1"
    assert not [name for name in numbers.index if "gear ratio" in name.lower() or "output gear" in name]


def test_the_config_of_a_report_holds_every_section_and_what_the_machine_is_made_of(example):
    values, tables = example
    values = facegear.example().with_values({"branches": {"from_rpm": 300}}).values
    chapter = machine_chapter({**values, "reproduction": False}, tables)
    keys = chapter.tables[-1].frame.set_index("key")["value"]
    assert keys["branches.from_rpm"] == 300.0 and keys["load_sharing.starts"] == 2
    assert keys["strength.duty[0].hours"] == values["strength"]["duty"][0]["hours"]
    assert keys["strength.pinion.card.name"] in chapter.text
    sections = {key.split(".")[0].split("[")[0] for key in keys.index} | {"case"}
    assert sections == {name for name, held in values.items() if held not in (None, [], "")}


def test_a_jump_far_from_a_linear_resonance_is_not_given_its_speed():
    """A jump at 2953 rpm was shown with a resonance at 16 925 rpm."""
    jumps = pd.DataFrame(
        {
            "direction": "up",
            "kind": "jump",
            "speed_before_rpm": [2953.0, 10475.0],
            "error_rpm": 0.8,
            "mesh": "a",
            "class_before": "period-1",
            "class_after": "period-1",
            "resonance": ["mode 28 at 1x", "mode 19 at 1x"],
            "energy_fraction": 0.5,
            "resonance_rpm": [16925.0, 12443.0],
        }
    )
    (table,) = case_tables("Nominal response and speed sweeps", {"jumps": jumps}, 7500.0)
    assert table.header()[-3:] == ["moves most", "energy fraction", "linear resonance (rpm)"]
    assert [row[-1] for row in table.rows()] == ["", "12,443"]
    assert not case_tables("Nominal response and speed sweeps", {"jumps": jumps[:0]}, 7500.0)[0].rows()


def test_a_changed_key_of_the_config_stands_beside_its_value_in_the_file_extended(example):
    values, tables = example
    other = facegear.example().with_values({"transmission.backlash_um": 55.0}).values
    table = machine_chapter(values, tables, base=Base("paper.yaml", other)).tables[-1]
    assert table.caption.endswith("1 key differs from paper.yaml, which it extends")
    row = table.frame.set_index("key").loc["transmission.backlash_um"]
    assert row["against paper.yaml"] == "changed" and row["in paper.yaml"] == 55.0
    assert machine_chapter(values, tables).tables[-1].header() == ["key", "value"]
