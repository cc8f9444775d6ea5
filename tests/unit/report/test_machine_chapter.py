"""The chapter on the machine says what an engineer looks for first."""

import numpy as np
import pandas as pd
import pytest

import facegear
from facegear.pipeline.needs import stage_needs
from facegear.pipeline.run import call
from facegear.pipeline.table import STAGES
from facegear.report.case import _tables as case_tables
from facegear.report.contents import caption_of
from facegear.report.glance import findings, glance_chapter
from facegear.report.machine import Base, key_numbers, machine_chapter
from facegear.report.warnings import warnings


@pytest.fixture(scope="module")
def example():
    values = facegear.example().values
    harmonics = pd.DataFrame({"order": [0, 1], "sin_n_per_m": [0.0, 0.0], "cos_n_per_m": [4.1e8, 1e7]})
    return values, call(STAGES["ratings"], {"harmonics": harmonics, **stage_needs("ratings", values)}).content


def test_key_numbers_are_ratio_torque_speed_frequency_and_power(example):
    numbers = key_numbers(example[1], None).set_index("quantity")
    assert numbers.loc["Gear ratio (gear teeth over pinion teeth)", "value"] == f"{143 / 23:.5g}"
    assert numbers.loc["Mesh frequency", "value"] == "2875"
    torque = float(numbers.loc["Torque of the output gear", "value"])
    speed = float(numbers.loc["Speed of the face gears", "value"])
    bodies = example[1]["bodies"].set_index("body")["power_kw"]
    assert torque * speed * 3.14159265 / 30e3 == pytest.approx(-bodies["upper face gear"], rel=1e-4)


def test_a_machine_in_balance_says_so_and_one_out_of_balance_by_how_much(example):
    values, tables = example
    assert "The power brought in equals the power taken out" in machine_chapter(values, tables).text
    off = tables["ratings"].assign(value=lambda t: t["value"].mask(t["quantity"] == "power_imbalance", -0.07))
    assert "-7 % of the larger" in machine_chapter(values, {**tables, "ratings": off}).text


def test_friction_loss_is_taken_off_the_power_out(example):
    values, tables = example
    lossy = {**tables, "machine_loss": pd.DataFrame({"bin": [0, -1], "loss_percent": [0.58, 0.7]})}
    numbers = key_numbers(lossy, None).set_index("quantity")["value"].map(float)
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


@pytest.mark.parametrize("k_gamma", [0.701, 1.2])
def test_k_gamma_is_defined_where_it_is_shown_and_explained_below_one(k_gamma):
    row = {
        "group": "idlers",
        "k_gamma": k_gamma,
        "k_gamma_static": k_gamma,
        "k_v": 1.1,
        "torque_n_m": 1328.0,
        "speed_rpm": 7500.0,
        "mesh_cycles": 99,
    }
    (found,) = findings({"following_groups": pd.DataFrame([row])}, None)
    assert "largest mean load of a mesh over its nominal even share" in found.finding
    assert ("below 1, less load takes this path" in found.finding) == (k_gamma < 1.0)


def test_the_shift_of_the_contact_path_is_a_number():
    pair = {
        "radii_mm": {"gear_inner": 190.0, "gear_outer": 212.0, "gear_contact_path_nominal": 202.0},
        "limits_mm": {"inner_undercut": 188.0, "outer_pointing": 230.0},
        "unloaded": {"drive": {"path_pinion_y_mm": [198.0, 198.2]}},
        "contact_ratio": 1.5,
        "backlash_um": {"smallest": 100.0},
    }
    numbers = key_numbers({}, pair).set_index("quantity")["value"]
    assert numbers["Shift of the unloaded contact path, positive outwards"] == "-3.9"


def test_figures_are_named_by_content_and_numbered_after_the_paper_only_where_it_is_reproduced():
    study = {"name": "backlash", "title": "Effect of backlash", "figures": [13, 14]}
    own, paper = ({"studies": [study], "reproduction": given} for given in (None, {"claims": "x"}))
    assert caption_of("study_backlash_idlers", paper).startswith("Figure 14 of the paper: Effect of backlash")
    assert caption_of("mesh_sweep", paper).startswith("Figure 12 of the paper")
    for name in ("study_backlash_idlers", "mesh_sweep", "campbell"):
        assert "Figure" not in caption_of(name, own)


def test_the_first_screen_warns_of_what_the_results_hide(example):
    values, tables = example
    contact = {
        "torque_n_m": [300.0, 600.0],
        "k_average_mean_n_per_m": 5e8,
        "ste_peak_to_peak_um": 4.0,
        "ste_peak_to_peak_half_um": [3.99, 3.0],
        "fillet_share": [0.0, 0.0],
        "pressure_mpa": [3900.0, 5800.0],
        "pressure_error_mpa": 10.0,
    }
    edges = pd.DataFrame(
        {
            "torque_n_m": [300.0, 600.0],
            "tip_line_load_n_per_mm": [0.0, 412.3],
            "tip_length_mm": [0.0, 7.26],
        }
    )
    gap = {"gap_um": 7.8, "gear_part": "tip edge", "pinion_part": "fillet", "gear_radius_mm": 259.6}
    pair = {"interference": gap, "smallest_gap": gap, "backlash_um": {"smallest": 60.0}}
    found = {**tables, "by_torque": pd.DataFrame(contact), "ltca": edges}
    message = [" ".join(row) for row in warnings(values, found, pair)]
    for words in (
        "the bodies interfere",
        "from 600 N m on tip edges carry load, up to 412 N/mm over 7.3 mm",
        "contact at 600 N m peak-to-peak",
        "contact at 600 N m a pressure of 5800 MPa: from 4000 MPa on even hardened steel yields",
        "solved up to 600 N m",
        "the dynamics take 100 um, the teeth as assembled have 60.0 um",
    ):
        assert any(words in one for one in message), words
    assert len(message) == len(set(message)) and not any("3900 MPa" in one for one in message)
    pressed = pd.DataFrame(contact).assign(fillet_share=[0.0, 0.152], k_average_mean_n_per_m=[5e8, np.nan])
    message = [" ".join(row) for row in warnings(values, found | {"by_torque": pressed}, pair)]
    words = "contact at 600 N m tips press into fillets and carry up to 15.2 % of the torque there"
    assert any(words in one for one in message)
    light = pd.DataFrame(contact).assign(fillet_share=[0.0009, 0.002])
    message = [
        row for row in warnings(values, found | {"by_torque": light}, pair) if "into fillets" in row[1]
    ]
    assert [about for about, _ in message] == ["contact at 600 N m"], "as the rating judges it"
    known = {row.about: row for row in findings(found | {"by_torque": pressed}, pair)}
    assert known["contact at 600 N m"].finding.startswith("no mean stiffness, ")
    most = tables["meshes"]["pinion_torque_n_m"].abs().max()
    barely = found | {"by_torque": pd.DataFrame(contact).assign(torque_n_m=most * (1 - 1e-12))}
    assert not any("solved up to" in row[1] for row in warnings(values, barely, pair)), "rounding"
    clean = {"gap_um": 7.8} | gap
    quiet = pd.DataFrame(contact).assign(ste_peak_to_peak_half_um=4.0, torque_n_m=2000.0, pressure_mpa=1200.0)
    pair = {"interference": None, "smallest_gap": clean, "backlash_um": {"smallest": 100.0}}
    assert not [
        row for row in warnings(values, {**tables, "by_torque": quiet}, pair) if row[0] != "mesh stiffness"
    ]
    assert next(iter(findings(found, pair))).finding.startswith(
        "free; smallest gap beside the contact 7.8 um"
    )


def test_a_green_rating_beside_loaded_tip_edges_is_amber_with_its_reason_on_the_first_screen():
    row = {
        "body": "pinion",
        "gear": "pinion",
        "flank": "drive",
        "failure": "pitting",
        "method": "contact analysis",
        "safety": 1.2,
        "required": 1.0,
        "verdict": "amber",
        "reason": "tip edges carry 327 N/mm, where pressure has no limit",
        "within_torques_solved": False,
    }
    message = {row.about: row for row in findings({"rating": pd.DataFrame([row])}, None)}
    line = message["pinion, drive flank, pitting (contact analysis)"]
    assert line.light == "amber" and "327 N/mm" in line.finding
    assert line.finding.endswith("outside the torques of the contact analysis")


def test_the_first_screen_names_k_gamma_of_the_running_machine_beside_that_at_rest():
    row = {
        "group": "idlers",
        "k_gamma": 1.4164,
        "k_gamma_static": 1.2684,
        "k_v": 1.1,
        "torque_n_m": 1328.0,
        "speed_rpm": 7500.0,
        "mesh_cycles": 99,
    }
    message = {row.about: row for row in findings({"following_groups": pd.DataFrame([row])}, None)}
    assert message["K_gamma, idlers"].finding.startswith(
        "1.416 (K_v 1.100) at 7500 rpm and 1328 N m, 1.268 at rest, over 99 mesh cycles"
    )


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


def sweep_table(periodic, **open_shares):
    """A sweep up and down over speeds, with shares of time out of contact by mesh."""
    rows = [
        (direction, 1000.0 * i, "open_fraction", mesh, share, regular)
        for direction in ("up", "down")
        for mesh, shares in open_shares.items()
        for i, (share, regular) in enumerate(zip(shares, periodic, strict=True))
    ]
    columns = ["direction", "speed_rpm", "quantity", "body_or_mesh", "value", "periodic"]
    return pd.DataFrame(rows, columns=columns)


def test_the_first_screen_warns_of_motions_that_are_not_periodic_and_of_meshes_out_of_contact(example):
    """A report said: warnings none, where half of the speeds were chaotic and a mesh never touched."""
    values, tables = example
    meshes = tables["meshes"].assign(flank=["open", *["drive"] * (len(tables["meshes"]) - 1)])
    sweep = sweep_table([True, False, False], a=[1.0, 1.0, 1.0], b=[0.0, 0.999, 0.0], c=[0.0, 0.0, 0.0])
    message = list(warnings(values, {**tables, "meshes": meshes, "sweep": sweep}, None))
    assert ("meshes at rest", f"no load at {meshes['mesh'].iloc[0]}") in message
    swept = [words for about, words in message if about == "speed sweep"]
    assert swept[0].startswith("the motion is not periodic at 4 of 6 speeds")
    assert swept[1:] == [
        "open at every speed: a",
        "contact is lost at some speeds, up to 100 % of the time: b",
    ]
    quiet = sweep_table([True, True, True], c=[0.0, 0.0, 0.0])
    left = [about for about, _ in warnings(values, {**tables, "sweep": quiet}, None)]
    assert left == ["mesh stiffness"], "what the example warns of by itself"


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
    assert [row[-1] for row in table.rows()] == ["", "12443"]
    assert not case_tables("Nominal response and speed sweeps", {"jumps": jumps[:0]}, 7500.0)[0].rows()


def test_a_number_beyond_what_was_solved_or_undecided_is_warned_of(example):
    """Half of the ratings lay outside the torques solved, and the first screen was silent."""
    values, tables = example
    beyond = {
        "rating": pd.DataFrame({"within_torques_solved": [True, False]}),
        "limits": pd.DataFrame(
            [("xu_kahraman", "load", 600.0, 12.5), ("xu_kahraman", "speed", 600.0, 0.0)],
            columns=["friction_model", "limit", "torque_n_m", "loss_outside_percent"],
        ),
        "contacts": pd.DataFrame({"contact": ["a/upper", "b/upper"], "state": ["undecided", "drive"]}),
    }
    message = [": ".join(row) for row in warnings(values, {**tables, **beyond}, None)]
    for words in (
        "strength: 1 of 2 ratings lie outside the torques of the contact analysis (contact.torques_n_m)",
        "friction: 12 % of the loss at 600 N m lies outside the limits of xu_kahraman: load",
        "modes: too little load to tell from rounding, taken as open: a/upper",
    ):
        assert words in message, words
    assert not any("speed" in one for one in message), "nothing of that limit is outside"


def test_the_worst_verdict_stands_first_and_each_colour_is_counted(example):
    values, tables = example
    row = {"gear": "pinion", "method": "contact analysis", "safety": 1.2, "required": 1.0, "reason": ""}
    rated = [
        {
            **row,
            "body": "a",
            "flank": "drive",
            "failure": failure,
            "verdict": light,
            "within_torques_solved": True,
        }
        for failure, light in (("bending", "green"), ("pitting", "red"))
    ]
    chapter = glance_chapter(
        values, {**tables, "rating": pd.DataFrame(rated)}, (), None, ["lubrication: a note"]
    )
    judged, warned = chapter.tables[:2]
    assert judged.caption == "Verdicts: 1 red, 1 green" and list(judged.frame["verdict"]) == ["red", "green"]
    assert ["lubrication", "a note"] in warned.frame.to_numpy().tolist()
    numbers = key_numbers({"rating": pd.DataFrame(rated)}, None).set_index("quantity")["value"]
    assert numbers["Smallest safety against pitting"] == "1.2"


def test_a_changed_key_of_the_config_stands_beside_its_value_in_the_file_extended(example):
    values, tables = example
    other = facegear.example().with_values({"transmission.backlash_um": 55.0}).values
    table = machine_chapter(values, tables, Base("paper.yaml", other)).tables[-1]
    assert table.caption.endswith("1 keys differ from paper.yaml, which it extends")
    row = table.frame.set_index("key").loc["transmission.backlash_um"]
    assert row["against paper.yaml"] == "changed" and row["in paper.yaml"] == 55.0
    assert machine_chapter(values, tables).tables[-1].header() == ["key", "value"]
