"""First screen of a report: one sentence, key numbers, verdicts with reasons, warnings by subject."""

import re

import numpy as np
import pandas as pd
import pytest

import facegear
from facegear.pipeline.needs import stage_needs
from facegear.pipeline.run import call
from facegear.pipeline.table import STAGES
from facegear.report.compact import error_picture, machine_picture, sweep_picture
from facegear.report.first_screen import first_screen, key_cards
from facegear.report.verdicts import verdicts
from facegear.report.warnings import grouped_warnings

RATED = {
    "body": "right_input",
    "gear": "pinion",
    "flank": "drive",
    "failure": "pitting",
    "method": "contact analysis",
    "safety": 1.2,
    "required": 1.0,
    "verdict": "green",
    "reason": "",
    "caveat": "",
    "damage": 0.0,
    "life_hours": np.inf,
    "within_torques_solved": True,
}
GAP = {"gap_um": 7.8, "gear_part": "tip edge", "pinion_part": "fillet", "gear_radius_mm": 259.6}
PAIR = {
    "interference": None,
    "smallest_gap": GAP,
    "backlash_um": {"smallest": 100.0},
    "contact_ratio": 1.55,
}


@pytest.fixture(scope="module")
def example():
    values = facegear.example().values
    harmonics = pd.DataFrame({"order": [0, 1], "sin_n_per_m": [0.0, 0.0], "cos_n_per_m": [4.1e8, 1e7]})
    return values, call(STAGES["ratings"], {"harmonics": harmonics, **stage_needs("ratings", values)}).content


def rating(**columns):
    return {"rating": pd.DataFrame([{**RATED, **columns}])}


def judged(values, tables, pair=None):
    """Return the verdicts by subject."""
    return {verdict.subject: verdict for verdict in verdicts(values, tables, pair)}


def sharing(k_gamma):
    row = {"group": "right input", "kind": "inputs", "k_gamma": k_gamma, "k_v": 1.1, "mesh_cycles": 3289}
    return {"following_groups": pd.DataFrame([row])}


def contact(**columns):
    table = {
        "torque_n_m": [300.0, 600.0],
        "k_average_mean_n_per_m": 5e8,
        "ste_peak_to_peak_um": 4.0,
        "ste_peak_to_peak_half_um": 4.0,
        "fillet_share": 0.0,
        "pressure_mpa": 1200.0,
        "pressure_error_mpa": 10.0,
    }
    return {"by_torque": pd.DataFrame({**table, **columns})}


def test_a_rating_below_what_is_required_is_red_and_says_damage_and_life(example):
    reason = "damage 24.8 in 2,500 h, life 101 h"
    failed = {"safety": 0.96, "verdict": "red", "reason": reason, "damage": 24.8, "life_hours": 2500 / 24.8}
    tables = {**example[1], **rating(**failed)}
    verdict = judged(example[0], tables)["Pitting"]
    assert (
        verdict.colour == "red" and reason in verdict.reason and "Right input, drive flank" in verdict.reason
    )
    screen = first_screen(example[0], tables, None)
    assert screen.status == "Not as required:" and screen.colour == "red"
    assert screen.sentence.startswith("the right input fails by pitting after 101 h of the required 2,500 h")


@pytest.mark.parametrize("safety", [1.2, 0.9])
def test_a_caveat_is_a_mark_and_never_the_colour(example, safety):
    caveat = "tip edges carry 327 N/mm, where pressure has no limit"
    colours = []
    for words in ("", caveat):
        verdict = judged(example[0], {**example[1], **rating(safety=safety, caveat=words)})["Pitting"]
        colours.append(verdict.colour)
        assert verdict.caveats == (("edge contact",) if words else ())
    assert set(colours) == {"green" if safety >= 1.0 else "red"}


def test_teeth_that_the_standard_does_not_know_are_marked(example):
    caveat = "not compared with ISO 6336, which does not know tapered teeth"
    verdict = judged(example[0], {**example[1], **rating(safety=1.2, caveat=caveat)})["Pitting"]
    assert verdict.colour == "green" and verdict.caveats == ("not in ISO 6336",)


def test_pitting_without_a_rating_of_every_flank_is_grey(example):
    """Edges that carry all load on tapered teeth leave nothing to rate: bending alone made all green."""
    (table,) = rating(safety=1.2).values()
    bending = table.assign(failure="bending")
    for pitting, words in ((table.iloc[:0], "Not rated: edges"), (table, "1 of 2 flanks are not rated")):
        other_flank = bending.assign(flank="back")
        rows = {"rating": pd.concat([bending, other_flank, pitting], ignore_index=True)}
        verdict = judged(example[0], {**example[1], **rows})["Pitting"]
        assert verdict.colour == "grey" and words in verdict.reason


def test_what_was_not_asked_for_or_not_computed_is_grey_and_says_which(example):
    values, tables = example
    found = judged({**values, "lubrication": None}, tables)
    for name in ("Bending", "Pitting"):
        assert (found[name].colour, found[name].reason) == ("grey", "Not computed.")
    for name in ("Scuffing", "Micropitting"):
        assert (found[name].colour, found[name].reason) == ("grey", "Not asked for (section lubrication).")
    screen = first_screen(values, tables, PAIR)
    assert screen.status == "As required so far:" and screen.colour == "grey"


@pytest.mark.parametrize(("required", "colour"), [(None, "grey"), (1.5, "green"), (1.3, "red")])
def test_load_sharing_is_judged_by_the_limit_of_the_config(required, colour):
    values = facegear.example().with_values({"load_sharing.required_k_gamma": required}).values
    verdict = judged(values, sharing(1.466))["Load sharing"]
    assert (
        verdict.colour == colour
        and "K_gamma 1.47 (right input, running over 3,289 mesh cycles)" in verdict.reason
    )
    (card,) = (key for key in key_cards(values, sharing(1.466), None) if key.name.startswith("Load sharing"))
    assert card.value == "1.47" and card.red == (colour == "red")
    assert "Largest mean load of a mesh over its nominal even share" in card.definition


def test_power_balance_and_contact_at_rest_have_verdicts(example):
    values, tables = example
    found = judged(values, tables)
    assert found["Power balance"].colour == "green" == found["Contact at rest"].colour
    lossy = {**tables, "machine_loss": pd.DataFrame({"bin": [0, -1], "loss_percent": [0.58, 0.7]})}
    assert "kW of friction" in judged(values, lossy)["Power balance"].reason
    (card,) = (key for key in key_cards(values, lossy, None) if key.name.startswith("Power"))
    assert card.beside == "with friction, 99.42 %"
    off = tables["ratings"].assign(value=lambda t: t["value"].mask(t["quantity"] == "power_imbalance", -0.07))
    idle = tables["meshes"].assign(flank=["open", *["drive"] * (len(tables["meshes"]) - 1)])
    broken = judged(values, {**tables, "ratings": off, "meshes": idle})
    assert broken["Power balance"].colour == "red"
    assert re.match(r"[\d,.]+ kW in, [\d,.]+ kW out, 7 % apart: ", broken["Power balance"].reason)
    assert broken["Contact at rest"].colour == "red"
    assert tables["meshes"]["mesh"].iloc[0] in broken["Contact at rest"].reason


def test_the_range_solved_is_red_where_a_load_exceeds_it_and_not_by_rounding(example):
    values, tables = example
    most = tables["meshes"]["pinion_torque_n_m"].abs().max()
    for factor, colour in ((0.5, "red"), (1 - 1e-12, "green"), (2.0, "green")):
        solved = contact(torque_n_m=[0.1 * most, factor * most])
        assert judged(values, {**tables, **solved})["Range solved"].colour == colour
    beyond = {**tables, **contact(torque_n_m=[1.0, 2 * most]), **rating(within_torques_solved=False)}
    verdict = judged(values, beyond)["Range solved"]
    assert verdict.colour == "red" and "1 of 1 rating exceeds it" in verdict.reason


def test_red_verdicts_come_first_and_grey_ones_last(example):
    order = [verdict.colour for verdict in verdicts(example[0], {**example[1], **rating(safety=0.5)}, PAIR)]
    assert order == sorted(order, key=("red", "green", "grey").index) and len(set(order)) == 3


def test_teeth_that_interfere_are_red_and_say_where(example):
    deep = judged(*example, {**PAIR, "interference": GAP})["Teeth"]
    assert deep.colour == "red" and "interfere by 7.8 µm" in deep.reason and "259.6 mm" in deep.reason
    assert judged(*example, PAIR)["Teeth"].reason.startswith("No interference; smallest gap 7.8 µm")


def test_lubrication_names_the_mesh_nearest_to_scuffing(example):
    losses = pd.DataFrame(
        {
            "bin": [0, 1],
            "mesh": ["engine/upper", "engine/lower"],
            "flank": "drive",
            "scuffing_safety": [0.2, 1.4],
            "scuffing_margin_k": [-90.0, 40.0],
            "micropitting_safety": np.nan,
            "within_torques_solved": [False, True],
        }
    )
    found = judged(example[0], {"mesh_losses": losses})
    assert found["Scuffing"].colour == "red" and found["Micropitting"].colour == "grey"
    hottest = "Engine/upper, drive flank, at the nominal load: safety 0.20 of 1, 90 K above the limit."
    assert found["Scuffing"].reason == hottest
    assert found["Scuffing"].caveats == ("beyond torques solved",)
    of_duty = judged(example[0], {"mesh_losses": losses[1:]})["Scuffing"]
    assert of_duty.colour == "green" and "bin 1 of the duty cycle" in of_duty.reason
    assert of_duty.reason.endswith("40 K below the limit.")


def test_warnings_are_grouped_by_subject_one_line_a_kind_most_serious_first(example):
    edges = {
        "torque_n_m": [300.0, 600.0],
        "tip_line_load_n_per_mm": [0.0, 412.3],
        "tip_length_mm": [0.0, 7.26],
    }
    tables = {
        **example[1],
        **contact(
            pressure_mpa=[3900.0, 5800.0], fillet_share=[0.01, 0.152], ste_peak_to_peak_half_um=[3.99, 3.0]
        ),
        "ltca": pd.DataFrame(edges),
    }
    found = grouped_warnings(example[0], tables, PAIR, ["lubrication: a note"])
    subjects = [subject for subject, _ in found]
    assert len(set(subjects)) == len(subjects) and subjects[0] == "Contact" and subjects[-1] == "Friction"
    lines = dict(found)["Contact"]
    assert lines[0].startswith("Pressure at 600 N m is up to 5,800 MPa")
    assert any("from 600 N m on tip edges carry up to 412 N/mm over 7.3 mm" in line for line in lines)
    assert any(
        "press into fillets at every torque and carry up to 15 % of the torque" in line for line in lines
    )
    assert any("at 600 N m 4.00 µm peak to peak, 3.00 µm with half" in line for line in lines)
    assert len(lines) == 4
    quiet = {**example[1], **contact()}
    assert [subject for subject, _ in grouped_warnings(example[0], quiet, PAIR)] == ["Stiffness"]


def test_a_note_of_a_whole_section_is_a_sentence_and_one_of_a_key_names_it(example):
    """`transmission: runouts ...` stood below the heading Machine."""
    notes = ["transmission: runouts are left out", "mesh_stiffness.scale = 2: not 1"]
    found = dict(grouped_warnings(example[0], {}, None, notes))
    assert found["Machine"] == ["Runouts are left out."]
    assert found["Stiffness"][-1] == "mesh_stiffness.scale = 2: not 1."


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


def test_motions_that_are_not_periodic_and_meshes_out_of_contact_are_warned_of(example):
    """A report said: warnings none, where half of the speeds were chaotic and a mesh never touched."""
    sweep = sweep_table([True, False, False], a=[1.0, 1.0, 1.0], b=[0.0, 0.999, 0.0], c=[0.0, 0.0, 0.0])
    lines = dict(grouped_warnings(example[0], {**example[1], "sweep": sweep}, None))["Motion"]
    assert lines[0] == "Open at every speed: a."
    assert lines[1].startswith("Motion is not periodic at 4 of 6 speeds")
    assert lines[2] == "Contact is lost at some speeds, up to 100 % of the time: b."
    quiet = sweep_table([True, True, True], c=[0.0, 0.0, 0.0])
    assert "Motion" not in dict(grouped_warnings(example[0], {**example[1], "sweep": quiet}, None))


def test_losses_outside_the_friction_model_and_undecided_contacts_are_warned_of(example):
    tables = {
        **example[1],
        "limits": pd.DataFrame(
            [("xu_kahraman", "load", 600.0, 12.5), ("xu_kahraman", "speed", 600.0, 0.0)],
            columns=["friction_model", "limit", "torque_n_m", "loss_outside_percent"],
        ),
        "contacts": pd.DataFrame({"contact": ["a/upper", "b/upper"], "state": ["undecided", "drive"]}),
    }
    found = dict(grouped_warnings(example[0], tables, None))
    assert found["Friction"] == ["12 % of the loss at 600 N m lies outside the limits of xu_kahraman: load."]
    assert found["Modes"] == ["Too little load to tell from rounding, taken as open: a/upper."]
    assert judged(example[0], tables)["Contact at rest"].caveats == ("1 contact undecided",)


def test_key_cards_name_the_first_resonance_in_the_speed_range_and_the_peak_force(example):
    tables = example[1]
    values = facegear.example().with_values({"dynamics.sweep.from_rpm": 500}).values
    modes = pd.DataFrame({"order": [1, 7, 8], "frequency_hz": [0.0, 756.7, 900.0]})
    forces = pd.DataFrame({"mesh": ["a/upper", "b/upper"], "mean_n": 1.0, "largest_n": [26500.0, 36480.0]})
    found = {
        key.name: key for key in key_cards(values, {**tables, "frequencies": modes, "forces": forces}, PAIR)
    }
    resonance = found["First resonance"]
    assert resonance.value == f"{round(60 * 756.7 / 23):,} rpm" and resonance.beside == "mode 7, 756.7 Hz"
    assert (found["Peak mesh force"].value, found["Peak mesh force"].beside) == ("36.5 kN", "b/upper")
    assert found["Teeth, module"].value == "23 / 143"


def test_a_machine_picture_has_every_pinion_and_a_pair_alone_has_none(example):
    values, tables = example
    drawn = machine_picture(values, tables["meshes"]).svg
    assert drawn.count('<polygon class="input"') == 2
    for pinion in values["transmission"]["pinions"]:
        assert pinion["name"] in drawn
    assert machine_picture({**values, "transmission": None}, None) is None


def test_the_sweep_picture_shows_the_mesh_that_vibrates_most_and_ignores_gaps():
    rows = [
        (direction, speed, "deflection_ac_rms_um", mesh, level * speed if speed != 2000.0 else np.nan)
        for direction in ("up", "down")
        for mesh, level in (("a/upper", 1e-3), ("b/upper", 3e-3))
        for speed in np.linspace(1000.0, 9000.0, 2001)
    ]
    sweep = pd.DataFrame(rows, columns=["direction", "speed_rpm", "quantity", "body_or_mesh", "value"])
    sweep = pd.concat([sweep[sweep["direction"] == one].reset_index(drop=True) for one in ("up", "down")])
    assert sweep.index.has_duplicates, "as parts of a sweep that were computed in this session"
    jumps = pd.DataFrame({"direction": ["up"], "speed_after_rpm": [4000.0]})
    picture = sweep_picture(sweep, jumps, 7500.0)
    assert picture.title == "Vibration of b/upper" and "nan" not in picture.svg
    assert len(picture.svg) < 30_000 and picture.svg.count('class="jump up"') == 1
    assert sweep_picture(None, None, 7500.0) is None and error_picture(None) is None


@pytest.mark.parametrize("known", [(), ("by_torque",), ("ratings", "bodies", "meshes")])
def test_the_first_screen_of_a_pair_alone_and_of_few_results_stands(example, known):
    values, tables = example
    shown = {name: {**tables, **contact()}[name] for name in known}
    for transmission in (values["transmission"], None):
        case = {**values, "transmission": transmission}
        if transmission is None:
            shown = {name: table for name, table in shown.items() if name == "by_torque"}
        screen = first_screen(case, shown, PAIR)
        assert screen.status and screen.keys[0].value == "23 / 143"
        text = repr(screen)
        assert "nan" not in text and "-0.0" not in text and "1 verdicts" not in text
