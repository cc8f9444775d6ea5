"""Loads, stiffness and life of rolling bearings by bin of a duty cycle, from the question of a user on."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from rolling_bearings import P1
from ruamel.yaml import YAML
from three_pinions import STIFFNESS, TEETH, TEXT

import facegear
from facegear.bearings.life import BASIS, life_together, load_rating
from facegear.build.machine import MachineInputs
from facegear.errors import ConfigError, ConfigErrors
from facegear.pipeline.needs import require_section
from facegear.pipeline.stage import Case
from facegear.pipeline.stages.bearing_life import bearing_life
from facegear.pipeline.table import STAGES
from facegear.report.bearings import bearing_life_tables, bearing_tables, largest_change
from facegear.report.figures.bearings import bearing_figures
from facegear.schema.base import parse
from facegear.schema.strength import BearingStrength, DutySection
from facegear.schema.transmission import Transmission
from facegear.strength.bearing_rating import NO_LIFE_LIMIT, PRESSED_IN

BALL = {"card": "deep_groove_6210", "clearance_diametral_um": 15}
ROLLER = {"card": "cylindrical_roller_nu210", "clearance_diametral_um": 30}
SHAFT = {
    "segments": [{"length_mm": 130, "diameter_mm": 50}],
    "pinion_mm": 60,
    "bearings": [{"at_mm": 10, "rolling": BALL}, {"at_mm": 120, "rolling": ROLLER}],
}


class Duty:
    """The part of section strength that the stage reads."""

    def __init__(self, *bins, bearings=None, application_factor=1.0):
        self.duty = [
            DutySection(torque_n_m=torque, speed_rpm=speed, hours=hours) for torque, speed, hours in bins
        ]
        self.bearings = None if bearings is None else BearingStrength(**bearings)
        self.application_factor = application_factor


def inputs(**changes):
    values = {**YAML(typ="safe").load(TEXT), "shafts": {"input": {**SHAFT, **changes}}}
    return MachineInputs(transmission=parse(Transmission, values), teeth=TEETH, harmonics=STIFFNESS)


def answers(*bins, **more):
    duty = Duty(*bins, **more) if bins else None
    return bearing_life(inputs(), 3000.0, duty).content


CYCLE = ((100.0, 2000.0, 60.0), (250.0, 3000.0, 40.0))


@pytest.fixture(scope="module")
def rated():
    conditions = {"required_hours": 5000.0, "contamination_factor": 0.5, "viscosity_ratio": 1.8}
    return answers(*CYCLE, bearings=conditions)


def of(table, pinion, letter, label):
    rows = table[(table["pinion"] == pinion) & (table["bearing"] == letter) & (table["bin"] == label)]
    assert len(rows) == 1
    return rows.iloc[0]


def test_every_bearing_has_a_row_for_the_mean_load_and_each_bin(rated):
    assert rated["loads"].groupby(["pinion", "bearing"])["bin"].apply(list).tolist() == 4 * [
        ["mean", "1", "2"]
    ]


def test_lives_over_the_cycle_are_those_of_its_bins_by_miners_rule(rated):
    life = rated["life"]
    bins = [of(life, "one", "A", label) for label in "12"]
    whole = of(life, "one", "A", "all")
    for name in ("l10_hours", "l10r_hours"):
        expected = 100.0 / sum(row["hours"] / row[name] for row in bins)
        assert whole[name] == pytest.approx(expected, rel=1e-12)
    assert sum(row["damage_share"] for row in bins) == pytest.approx(1.0)


def test_the_basic_life_follows_from_the_radial_load_and_the_rating(rated):
    load, row = of(rated["loads"], "one", "B", "2"), of(rated["life"], "one", "B", "2")
    million = (row["load_rating_n"] / load["radial_n"]) ** (10.0 / 3.0)
    assert row["l10_million"] == pytest.approx(million, rel=1e-9)
    assert row["l10_hours"] == pytest.approx(million * 1e6 / (60.0 * 3000.0), rel=1e-9)
    assert of(rated["life"], "one", "A", "2")["load_rating_n"] == pytest.approx(load_rating(P1), rel=1e-9)


def test_all_bearings_together_live_shorter_than_the_shortest(rated):
    life = rated["life"]
    whole = life[life["bin"] == "all"]
    assert whole["pinion"].iloc[-1] == "all bearings"
    assert whole["l10r_hours"].iloc[-1] < whole["l10r_hours"].iloc[:-1].min()


def test_a_required_life_is_judged_and_standards_not_at_hand_are_marked(rated):
    life = rated["life"]
    whole = life[life["bin"] == "all"]
    verdicts = np.where(whole["l10r_hours"] >= 5000.0, "yes", "no")
    assert whole["is_enough"].tolist() == verdicts.tolist()
    assert set(verdicts) == {"yes", "no"}
    assert all(BASIS["basic"] in basis and "not at hand" in basis for basis in life["basis"])


def test_a_modified_life_needs_the_fatigue_load_limit_of_the_bearing(rated):
    assert rated["life"]["modified_hours"].isna().all()
    limited = {
        **SHAFT,
        "bearings": [{**SHAFT["bearings"][0], "rolling": {**BALL, "fatigue_load_limit_n": 980}}],
    }
    limited["bearings"].append(SHAFT["bearings"][1])
    conditions = Duty(*CYCLE, bearings={"contamination_factor": 0.5, "viscosity_ratio": 1.8})
    life = bearing_life(inputs(**limited), 3000.0, conditions).content["life"]
    first, second = of(life, "one", "A", "all"), of(life, "one", "B", "all")
    assert first["modified_hours"] > 0.0 and BASIS["modified"] in first["basis"]
    assert np.isnan(second["modified_hours"]) and BASIS["modified"] not in second["basis"]


def test_bearings_without_load_have_no_limit_of_l10_and_say_why():
    """L10 was 1e48 hours where elements are pressed in: by the 1e-10 N of the shaft that rounding leaves.

    At 200 N m the idlers stay inside the backlash. Their balls are pressed in, and their rollers have play.
    """
    clearances = {"transmission.shafts.idler.bearings.0.rolling.clearance_diametral_um": -10}
    torque = {"transmission.torque.per_input_n_m": 200}
    content = facegear.load(EXAMPLE).with_values({**clearances, **torque}).bearing_life().content
    life, loads = content["life"], content["loads"]
    pressed, loose = (of(life, "right idler", letter, "all") for letter in "AB")
    assert pressed["l10_hours"] == np.inf and pressed["l10r_hours"] < np.inf
    assert pressed["remark"] == PRESSED_IN and loose["remark"] == NO_LIFE_LIMIT
    assert loose["l10_hours"] == loose["l10r_hours"] == np.inf and loose["damage_share"] == 0.0
    assert of(life, "right input", "A", "all")["remark"] == ""
    assert of(loads, "right idler", "A", "mean")["radial_n"] == 0.0
    (shown, _) = bearing_life_tables({"bearings_life": life})
    assert "remark" in shown.frame.columns and "remark" in shown.main


def test_all_bearings_together_have_no_known_life_where_one_has_none():
    """Bearings of unknown modified life were left out, which made the life of all too long."""
    assert np.isnan(life_together([P1, P1], [5.0, np.nan]))


def test_stiffness_is_given_at_the_mean_load_and_at_both_ends_of_the_cycle(rated):
    stiffness = rated["stiffness"]
    assert stiffness["bin"].unique().tolist() == ["mean", "1", "2"]
    matrix = stiffness[(stiffness["pinion"] == "one") & (stiffness["bearing"] == "A")]
    matrix = matrix[matrix["bin"] == "2"][["x", "y", "z", "tilt_x", "tilt_y"]].to_numpy()
    assert np.allclose(matrix, matrix.T, rtol=1e-9) and np.linalg.eigvalsh(matrix).min() > 0.0
    assert 0.05 < largest_change(stiffness) < 1.0


def test_without_a_duty_cycle_the_own_torques_are_the_only_bin():
    content = answers()
    assert content["life"]["bin"].unique().tolist() == ["mean", "all"]
    assert content["stiffness"]["bin"].unique().tolist() == ["mean"]
    assert content["life"]["is_enough"].eq("").all()


def test_the_application_factor_raises_the_loads():
    plain, raised = (answers(*CYCLE, application_factor=factor)["loads"] for factor in (1.0, 1.25))
    assert of(raised, "one", "A", "2")["torque_n_m"] == 312.5
    assert of(raised, "one", "A", "2")["radial_n"] > 1.2 * of(plain, "one", "A", "2")["radial_n"]


def test_the_stiffness_along_the_load_grows_with_the_torque(rated):
    rows = rated["over_torque"]
    rows = rows[(rows["pinion"] == "one") & (rows["bearing"] == "A")]
    assert (np.diff(rows["radial_stiffness_n_per_m"]) > 0.0).all() and len(rows) == 15


def test_bearings_that_do_the_same_are_drawn_once(rated):
    figure = bearing_figures(rated["over_torque"])[0]
    names = [mark.name for mark in figure.panels[0].marks[1:]]
    assert names == ["one A", "one B", "two A", "two B"]
    only = rated["over_torque"][rated["over_torque"]["pinion"] == "one"]
    twins = pd.concat([only, only.assign(pinion="three")])
    names = [mark.name for mark in bearing_figures(twins)[0].panels[0].marks[1:]]
    assert names == ["one A, three A", "one B, three B"]


def test_the_report_says_how_much_stiffness_changes_and_shows_lives_once(rated):
    tables = {f"bearings_{name}": table for name, table in rated.items()}
    captions = [table.caption for table in bearing_tables(tables)]
    assert len(captions) == 4 and any("changes by up to" in caption for caption in captions)
    assert len(bearing_tables({**tables, "root_stress": None})) == 2
    assert len(bearing_life_tables(tables)) == 2 and bearing_life_tables({}) == []


def test_balls_are_thrown_at_the_speed_of_each_bin():
    thrown = {**SHAFT, "bearings": [{"at_mm": 10, "rolling": {**BALL, "centrifugal": True}}]}
    thrown["bearings"].append(SHAFT["bearings"][1])
    duty = Duty((250.0, 3000.0, 1.0), (250.0, 12000.0, 1.0), (250.0, 1e-3, 1.0))
    loads = bearing_life(inputs(**thrown), 3000.0, duty).content["loads"]
    slow, fast, still = (of(loads, "one", "A", label)["outer_pressure_mpa"] for label in "123")
    plain = of(answers((250.0, 3000.0, 1.0))["loads"], "one", "A", "1")["outer_pressure_mpa"]
    assert still < slow < fast and still == pytest.approx(plain, rel=1e-6)


OVERLOADS = [
    ({"card": "deep_groove_6203"}, r"bearings\[0\]\.rolling = .* MPa on one at 400 N m.*4200 MPa.*ISO 76"),
    ({**BALL, "shoulder_angle_deg": 0.001}, "must be loaded up to shoulder_angle_deg = 0.001"),
]
ROLLERS = {
    "type": "cylindrical_roller",
    "elements": 10,
    "element_diameter_mm": 3,
    "pitch_diameter_mm": 30,
}


def test_overloaded_rollers_are_refused_at_their_own_limit():
    bearings = [SHAFT["bearings"][0], {"at_mm": 120, "rolling": {**ROLLERS, "effective_length_mm": 2}}]
    line = r"bearings\[1\]\.rolling = .* MPa on one at 400 N m.*4000 MPa.*ISO 76"
    with pytest.raises(ConfigError, match=line):
        bearing_life(inputs(bearings=bearings), 3000.0, None)


@pytest.mark.parametrize(("rolling", "line"), OVERLOADS)
def test_overloaded_bearings_are_refused_with_their_key(rolling, line):
    bearings = [{"at_mm": 10, "rolling": rolling}, SHAFT["bearings"][1]]
    with pytest.raises(ConfigError, match=line):
        bearing_life(inputs(bearings=bearings), 3000.0, None)


DUTY = [{"torque_n_m": torque, "speed_rpm": 3000, "hours": 40} for torque in (150, 300)]
EXAMPLE = Path(__file__).parents[3] / "config" / "bearings.yaml"


def test_a_duty_cycle_of_bearings_needs_no_bodies_of_teeth():
    """The section asked for materials of the teeth, and the pair then for its bodies."""
    gearbox = facegear.load(EXAMPLE).with_values({"strength": {"bearings": {}, "duty": DUTY}})
    life = gearbox.bearing_life().content["life"]
    assert life["bin"].unique().tolist() == ["1", "2", "all"]
    case = Case(gearbox.values)
    stages = {name for name, stage in STAGES.items() if stage.condition and stage.condition(case)}
    assert "bearing_life" in stages and not {"rating", "root_stress", "contact"} & stages
    with pytest.raises(ConfigError, match=r"strength\.pinion = None: must be given, as rule rating"):
        require_section("rating", gearbox.values)


TEETH_ALONE = {"card": "case_carburised_din3990_11", "root_roughness_um": 16}
INCOMPLETE = [
    ({"duty": DUTY}, r"strength\.bearings = null: must be given where pinion and face_gear are left out"),
    ({"duty": DUTY, "bearings": {}, "load_factors": "machine"}, "load_factors = .machine.: must be left out"),
    ({"duty": DUTY, "bearings": {}, "dynamic_factor": 1.2}, r"dynamic_factor = 1\.2: must be left out"),
    ({"duty": DUTY, "pinion": TEETH_ALONE}, r"face_gear = null: must be given beside pinion"),
    ({"bearings": {}}, r"strength\.duty = \[\]: must be at least one bin with hours"),
]


@pytest.mark.parametrize(("section", "line"), INCOMPLETE)
def test_a_duty_cycle_that_rates_nothing_or_half_is_refused(section, line):
    with pytest.raises(ConfigErrors, match=line):
        facegear.load(EXAMPLE).with_values({"strength": section})


def test_a_duty_cycle_of_bearings_needs_rolling_bearings():
    springs = EXAMPLE.with_name("harmonics_only.yaml")
    with pytest.raises(ConfigErrors, match=r"strength\.pinion = null: must be given, or else transmission"):
        facegear.load(springs).with_values({"strength": {"bearings": {}, "duty": DUTY}})


def test_a_machine_on_springs_has_no_such_answer():
    springs = [{"at_mm": at, "radial_n_per_m": 2e8, "axial_n_per_m": 1e8} for at in (10, 120)]
    with pytest.raises(ConfigError, match="given with rolling bearings"):
        bearing_life(inputs(bearings=springs), 3000.0, None)
