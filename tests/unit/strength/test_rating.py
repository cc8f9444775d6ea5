"""Safety and life under a duty cycle: closed forms, bad input, what reversed bending costs."""

import re
from dataclasses import replace
from math import pi, sqrt, tan

import numpy as np
import pandas as pd
import pytest
from contact_bodies import pair_design
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees
from root_stresses import power_law, root

from facegear.build.config import Config, resolved_values
from facegear.build.strength import duty_bins, material_card
from facegear.errors import ConfigErrors, FacegearError
from facegear.report.figures.description import entries
from facegear.report.figures.strength import damage_by_bin, life
from facegear.schema.base import parse
from facegear.schema.cards import CARDS
from facegear.schema.strength import Strength
from facegear.schema.yaml_file import read_yaml
from facegear.strength.contact_pressure import ContactPressure
from facegear.strength.cylindrical import hertz_stress, pinion_form, standard_bending
from facegear.strength.materials import DutyBin, Life, given_duty, reliability
from facegear.strength.rating import rate
from facegear.strength.rating_tables import curve_table, damage_table, rating_table, safety_table
from facegear.strength.safety import RatedBody, RatingRequest, permissible_bending, reversal, safety
from facegear.teeth.analysis import section_contact_ratio

CARD = material_card(CARDS / "case_carburised_din3990_11.yaml")
BODY = {"card": "case_carburised_din3990_11", "root_roughness_um": 16}
DUTY = [{"torque_n_m": 400, "speed_rpm": 1000, "hours": 100}]
SECTION = {"pinion": BODY, "face_gear": BODY, "duty": DUTY}


def request(*duty, both_ways=False, card=CARD):
    body = RatedBody(card=card, root_roughness=16e-6)
    turns = {"pinion": 1.0, "face_gear": 23 / 143}
    return RatingRequest(
        {"pinion": body, "face_gear": body},
        tuple(given_duty(gear, duty, often, both_ways) for gear, often in turns.items()),
        time=sum(one.time for one in duty),
        min_bending=1.4,
        min_pitting=1.0,
    )


ROOTS = {"pinion": root(300e6), "face_gear": root(400e6)}
PRESSURE = ContactPressure(
    torques=np.array([500.0, 1000.0]),
    pressure=np.array([800e6, 1200e6]),
    error=np.array([8e6, 24e6]),
    edge_load=np.array([1e5, 3e5]),
    edge_length=np.array([2e-3, 4e-3]),
    fillet_share=np.zeros(2),
)


def rated(duty, **options):
    design = pair_design()
    found = rate(design, ROOTS, PRESSURE, request(*duty, **options))
    return {(one.duty.body, one.failure, one.method): one for one in found}, found


@against(
    "analytic",
    "definition of safety under one load",
    capability="rating",
    module="facegear.strength.rating",
)
@given(stress=st.floats(1e8, 1e9), exponent=st.floats(3.5, 9.0), allowed=st.floats(2e8, 2e9))
def test_safety_of_a_single_load_is_the_allowed_stress_at_its_cycles_over_its_stress(
    stress, exponent, allowed
):
    life, cycles = Life((1e3, 3e6, 1e10), (2.5, 1.0, 0.85)), 10.0**exponent
    found = safety(np.array([stress]), np.array([cycles]), allowed, life)
    agrees("safety", found, allowed * float(life.factor(cycles)) / stress, relative=1e-9)


def test_damage_adds_up_over_the_bins_and_an_empty_bin_does_none():
    one, two = DutyBin(500.0, 20.0, 3600.0), DutyBin(900.0, 20.0, 36000.0)
    both, found = rated([one, two, DutyBin(900.0, 20.0, 0.0)])
    key = ("face_gear", "bending", "finite elements")
    apart = [rated([load])[0][key].damage.sum() for load in (one, two)]
    assert both[key].damage.sum() == pytest.approx(sum(apart))
    assert both[key].damage[2] == 0.0
    solved = replace(PRESSURE, torques=np.array([250.0, 500.0]))
    table = damage_table(found, (one, two, DutyBin(900.0, 20.0, 0.0)), solved)
    rows = rating_table(found, solved, ROOTS)
    total = table.groupby(["body", "failure", "method"])["damage"].sum()
    np.testing.assert_allclose(
        [total[row.body, row.failure, row.method] for row in rows.itertuples()], rows["damage"]
    )
    assert table[table["bin"] == 1]["within_torques_solved"].all()
    assert not table[table["bin"] == 2]["within_torques_solved"].any()
    assert table[table["bin"] == 3]["within_torques_solved"].all()  # no cycles, so nothing is extrapolated
    assert not rows["within_torques_solved"].any()


def test_a_bin_that_lasts_no_time_changes_no_row_of_the_rating():
    used, empty = DutyBin(750.0, 20.0, 3.6e7), DutyBin(900.0, 20.0, 0.0)
    alone, beside = (rated(duty)[1] for duty in ([used], [used, empty]))
    for message in (
        lambda found: rating_table(found, PRESSURE, ROOTS),
        lambda found: safety_table(found, PRESSURE),
    ):
        pd.testing.assert_frame_equal(message(beside), message(alone), check_exact=True)
    never = rating_table(rated([empty])[1], PRESSURE, ROOTS)  # a flank that only such a bin loads
    assert (never["stress_mpa"] == 0.0).all() and (never["verdict"] == "green").all()


@against(
    "external source",
    "ISO 6336-3: mean stress influence factor",
    capability="rating",
    module="facegear.strength.rating",
)
def test_teeth_bent_both_ways_are_allowed_less():
    load = [DutyBin(500.0, 20.0, 3600.0)]
    key = ("pinion", "bending", "finite elements")
    one_way, both_ways = (rated(load, both_ways=flag)[0][key].allowed_stress for flag in (False, True))
    flank = given_duty("pinion", load, 1.0, True)
    assert reversal(root(300e6), flank) == -1.0
    agrees(
        "stress ratio of unequal loads",
        reversal(root(300e6), replace(flank, opposite=np.array([250.0]))),
        -sqrt(0.5),
        relative=1e-6,
    )
    assert reversal(root(300e6), given_duty("pinion", load, 1.0, False)) == 0.0
    other_flank = [root(150e6), root(60e6)]  # of teeth whose flanks are no mirror images
    assert reversal(root(300e6), flank, other_flank) == -0.5
    mean = 0.8 - 0.15 * 2.0  # M of the card with Y_S = 2
    agrees(
        "allowed stress of reversed over pulsating bending",
        both_ways / one_way,
        1.0 / (1.0 + (1.0 - mean) / (1.0 + mean)),
        relative=1e-6,
    )


def test_gear_turns_slower_than_the_pinion_and_its_teeth_see_fewer_cycles():
    found, _ = rated([DutyBin(500.0, 20.0, 3600.0)])
    cycles = {key[0]: float(one.duty.cycles.sum()) for key, one in found.items()}
    assert cycles == pytest.approx({"pinion": 72000.0, "face_gear": 72000.0 * 23 / 143})


@against(
    "analytic",
    "Hertz: cylinder on a plane",
    capability="rating",
    module="facegear.strength.rating",
)
def test_pitting_stress_at_the_pitch_point_is_hertz_of_a_cylinder_on_a_plane():
    design = replace(pair_design())
    ratio, torque = section_contact_ratio(design), 500.0
    found = hertz_stress(design, ratio, request())["face_gear"](torque)
    face = design.face_gear.outer_radius - design.face_gear.inner_radius
    load = torque / design.pinion_base_radius / min(face, design.pinion.width)
    soft = 2 * (1 - CARD.poisson_ratio**2) / CARD.young_modulus
    hertz = sqrt(load / (pi * soft * design.pinion_base_radius * tan(design.pressure_angle)))
    agrees("contact stress, Pa", found, hertz * sqrt((4 - ratio) / 3), relative=1e-12)


def message(**changes):
    with pytest.raises(ConfigErrors) as caught:
        parse(Strength, {**SECTION, **changes})
    return str(caught.value)


def test_a_card_without_what_the_rating_needs_stops_it_by_name():
    card = read_yaml(CARDS / "case_carburised_din3990_11.yaml")
    for part in ("pitting", "bending"):
        without = {**BODY, "card": {key: value for key, value in card.items() if key != part}}
        assert f"a card with {part}" in message(pinion=without)
    bending = {key: value for key, value in card["bending"].items() if key != "mean_stress"}
    assert "bending.mean_stress" in message(
        face_gear={**BODY, "card": {**card, "bending": bending}, "both_ways": True}
    )


def test_bad_duty_cycles_are_reported_in_one_line(tmp_path):
    assert "duty[0].hours = -1" in message(duty=[{**DUTY[0], "hours": -1}])
    assert "at least one bin with hours" in message(duty=[])
    path = tmp_path / "duty.csv"
    path.write_text("torque_n_m,speed_rpm,hours\n400,1000,abc\n")
    line = message(duty=[], duty_csv=str(path))
    assert "line 2: hours = 'abc' is not a finite number" in line and "\n" not in line
    assert "either duty_csv or duty" in message(duty_csv=str(path))


def test_a_duty_cycle_from_a_csv_is_that_of_the_config(tmp_path):
    path = tmp_path / "duty.csv"
    path.write_text("torque_n_m,speed_rpm,hours\n400,1000,100\n")
    from_csv = parse(Strength, {"pinion": BODY, "face_gear": BODY, "duty_csv": str(path)})
    assert duty_bins(from_csv) == duty_bins(parse(Strength, SECTION))
    assert parse(Strength, from_csv.model_dump(mode="json")) == from_csv


@against(
    "analytic",
    "Weibull distribution through 99 percent",
    capability="rating",
    module="facegear.strength.materials",
)
@given(total=st.floats(1e-2, 3.0), shape=st.floats(0.5, 4.0))
def test_reliability_is_99_percent_at_the_rated_life_and_falls_with_damage(total, shape):
    agrees("reliability at the rated life", reliability(1.0, shape), 0.99, relative=1e-6)
    assert reliability(1.1 * total, shape) < reliability(total, shape) <= 1.0
    assert np.isnan(reliability(total, None)) and np.isnan(reliability(0.0, shape))


def test_reliability_stands_in_the_tables_where_the_card_gives_the_spread_of_lives():
    hard = DutyBin(900.0, 20.0, 3.6e6)
    card = replace(CARD, bending=replace(CARD.bending, weibull_shape=1.5))
    design = pair_design()
    roots = {"pinion": root(300e6), "face_gear": root(600e6)}
    found = rate(design, roots, PRESSURE, request(hard, card=card))
    table = rating_table(found, PRESSURE, roots)
    bending = table[(table["failure"] == "bending") & (table["damage"] > 0.0)]
    np.testing.assert_allclose(bending["reliability"], 0.99 ** (bending["damage"] ** 1.5))
    assert len(bending) and table[table["failure"] == "pitting"]["reliability"].isna().all()
    safety_rows = safety_table(found, PRESSURE).set_index("body")
    gear = bending[bending["body"] == "face_gear"].iloc[0]
    assert safety_rows.loc["face_gear", "reliability"] == pytest.approx(gear["reliability"])
    assert safety_rows.loc["face_gear", "life_hours"] == pytest.approx(1000.0 / gear["damage"])
    assert safety_rows.loc["face_gear", "bending_safety"] == pytest.approx(gear["safety"])


def test_pitting_is_judged_by_the_pressure_of_the_contact_analysis_beside_the_standards():
    found = rated([DutyBin(750.0, 20.0, 3.6e7)])[1]
    table = rating_table(found, PRESSURE, ROOTS).set_index(["body", "failure", "method"])
    row = table.loc[("face_gear", "pitting", "contact analysis")]
    assert row["stress_mpa"] == pytest.approx(800.0 * 1.5 ** np.log2(1.5))  # a straight line in logarithms
    assert row["stress_error_mpa"] == pytest.approx(0.015 * row["stress_mpa"])
    bending = table.loc[("pinion", "bending", "finite elements")]
    assert bending["stress_error_mpa"] == pytest.approx(0.01 * bending["stress_mpa"])
    assert np.isnan(table.loc[("face_gear", "pitting", "ISO 6336-2"), "stress_error_mpa"])
    life = float(CARD.pitting.life.factor(row["cycles"]))
    assert row["safety"] == pytest.approx(1e-6 * CARD.pitting.limit * life / row["stress_mpa"], rel=1e-9)
    flank = safety_table(found, PRESSURE).set_index("body").loc["face_gear"]
    assert flank["pitting_safety"] == row["safety"]
    standard = table.loc[("face_gear", "pitting", "ISO 6336-2"), "safety"]
    assert flank["standard_pitting_safety"] == standard
    assert flank[["edge_line_load_n_per_mm", "edge_length_mm"]].tolist() == pytest.approx(
        [150.0 * (1 - np.log2(1.5)) + 225.0 * np.log2(1.5), 3.0]
    )


def test_the_figures_of_life_and_damage_show_every_method():
    bins = (DutyBin(750.0, 20.0, 3.6e7), DutyBin(900.0, 20.0, 3.6e7))
    found = rated(bins)[1]
    table, harm = rating_table(found, PRESSURE, ROOTS), damage_table(found, bins, PRESSURE)
    shown = life(table, harm, curve_table(found))
    names = {key.name for key in entries(shown.panels)}
    assert {name.rsplit(", ", 1)[1] for name in names} == {one.method for one in found}
    engines = (rows.assign(body="engine A") for rows in (table, harm, curve_table(found)))
    assert all(key.name.startswith("Engine A, ") for key in entries(life(*engines).panels))
    (panel,) = damage_by_bin(table, harm).panels
    assert len(entries([panel])) + panel.title.count("flank") == len(found)


def test_a_contact_on_edges_alone_is_judged_by_the_standard():
    bare = replace(PRESSURE, pressure=np.full(2, np.nan), error=np.full(2, np.nan))
    design = pair_design()
    roots = {"pinion": root(300e6), "face_gear": root(400e6)}
    found = rate(design, roots, bare, request(DutyBin(750.0, 20.0, 3.6e7)))
    methods = {one.method for one in found if one.failure == "pitting"}
    assert methods == {"ISO 6336-2"}
    assert safety_table(found, bare)["pitting_safety"].isna().all()


def test_a_rating_brings_root_stress_and_counts_the_meshes_of_a_turn():
    values = read_yaml("facegear/example.yaml")
    filled = resolved_values(parse(Config, values))
    assert filled["contact"]["root_stress"]
    assert [filled["strength"][body]["cycles_per_turn"] for body in ("pinion", "face_gear")] == [2, 5]


def test_torques_that_the_duty_cycle_needs_are_solved_with_the_others():
    values = read_yaml("facegear/example.yaml")
    solved = resolved_values(parse(Config, values))["contact"]["torques_n_m"]
    assert solved == list(parse(Config, values).contact.torques_n_m)
    values["strength"]["application_factor"] = 2.0
    values["contact"]["torques_n_m"], values["mesh_stiffness"]["torque_n_m"] = [1000], 1000
    loads = [2.0 * one["torque_n_m"] for one in values["strength"]["duty"]]
    given = [1000.0, *(load for load in (min(loads), max(loads)) if load != 1000.0)]
    assert resolved_values(parse(Config, values))["contact"]["torques_n_m"] == sorted(given)
    values["strength"]["duty"].append({"torque_n_m": 1e-3, "speed_rpm": 1000, "hours": 1})
    assert (
        min(resolved_values(parse(Config, values))["contact"]["torques_n_m"]) > 1.0
    )  # no mesh resolves 2 mN m


def test_a_load_below_the_torques_solved_gives_no_false_green():
    """A gear that is 0.98 times as safe as required at 300 N m stays so where 1000 N m alone was solved."""
    design, duty = pair_design(), DutyBin(300.0, 20.0, 3.6e7)

    def bending(torques, level):
        both = {body: power_law(torques, 0.75) for body in ("pinion", "face_gear")}
        both = {body: replace(one, stress=level * one.stress) for body, one in both.items()}
        table = rating_table(
            rate(
                design,
                both,
                replace(PRESSURE, torques=np.array([500.0, 1e3])),
                request(duty),
            ),
            PRESSURE,
            both,
        )
        return table.set_index(["body", "failure", "method"]).loc[("face_gear", "bending", "finite elements")]

    level = bending([300.0, 1000.0], 1.0)["safety"] / (0.98 * 1.4)
    short = bending([300.0, 1000.0], level)
    assert short["verdict"] == "red" and short["reason"] == f"safety {short['safety']:.2f}, 1.4 required"
    alone = bending([1000.0], level)
    assert alone["verdict"] == "red" and alone["safety"] < 1.4
    assert not alone["within_torques_solved"]  # nor is it said to have been solved


def test_flanks_whose_tip_edges_carry_load_keep_their_colour_and_bear_a_caveat():
    light = DutyBin(500.0, 20.0, 36.0)
    free = replace(PRESSURE, edge_load=np.zeros(2), edge_length=np.zeros(2))
    design = pair_design()
    for pressure in (PRESSURE, free):
        found = rate(design, ROOTS, pressure, request(light))
        pitting = [one for one in found if one.failure == "pitting"]
        assert all(one.safety >= one.required_safety for one in pitting)
        assert {one.verdict for one in pitting} == {"green"}
        table = safety_table(found, pressure)
        assert set(table["verdict"]) == {"green"} and not table["reason"].any()
        message = table["caveat"].iloc[0]
        assert ("tip edges carry 100 N/mm" in message) if pressure is PRESSURE else message == ""


@pytest.mark.parametrize(("share", "light"), [(0.0, 500.0), (9e-4, 500.0), (2e-3, 500.0), (0.15, 250.0)])
def test_flanks_with_contact_in_fillets_under_any_load_keep_their_colour_and_bear_a_caveat(share, light):
    """Interfering tips carry most of a small torque, so that the largest load does not tell of them."""
    pressed = replace(
        PRESSURE, edge_load=np.zeros(2), edge_length=np.zeros(2), fillet_share=np.array([share, 0.0])
    )
    design, duty = pair_design(), [DutyBin(light, 20.0, 36.0), DutyBin(1000.0, 20.0, 0.36)]
    roots = {body: root(100e6) for body in ROOTS}
    found = rate(design, roots, pressed, request(*duty))
    assert all(one.safety >= one.required_safety for one in found)
    tables = safety_table(found, pressed), rating_table(found, pressed, roots)
    for table in tables:
        assert set(table["verdict"]) == {"green"}
        message = f"fillets carry up to {100 * share:.2g} % of the torque" if share >= 1e-3 else ""
        assert table["caveat"].str.startswith(message).all() and (message or not table["caveat"].any())


def test_a_flank_that_fails_in_its_duty_cycle_says_its_damage_and_life():
    found = rated([DutyBin(1500.0, 20.0, 3.6e6)])[1]
    broken = [one for one in found if one.damage.sum() > 1.0]
    assert broken
    for one in broken:
        harm, life = float(one.damage.sum()), one.life / 3600.0
        words = re.fullmatch(r"damage ([\d.,]+) in 1,000 h, life ([\d.,]+) h", one.reason)
        assert words, one.reason
        shown = [float(number.replace(",", "")) for number in words.groups()]
        assert shown == pytest.approx([harm, life], rel=6e-3)


def test_no_reliability_is_stated_where_no_card_has_the_shape_of_its_distribution():
    found = rated([DutyBin(900.0, 20.0, 3.6e6)])[1]
    for table in (safety_table(found, PRESSURE), rating_table(found, PRESSURE, ROOTS)):
        assert "reliability" not in table.columns


def test_another_elasticity_in_the_card_than_in_the_body_is_refused():
    values = read_yaml("facegear/example.yaml")
    values["tooth_pair"]["face_gear"]["material"] = {"young_modulus_gpa": 170, "poisson_ratio": 0.3}
    line = (
        r"strength\.face_gear\.card\.young_modulus_gpa = 206\.0: must be 170, as contact and stress take it"
    )
    with pytest.raises(ConfigErrors, match=line):
        parse(Config, values)


@pytest.mark.parametrize("roughness", [1.6e-5, 150])
def test_a_roughness_outside_the_range_of_the_standards_factor_is_refused(roughness):
    line = message(pinion={**BODY, "root_roughness_um": roughness})
    assert f"pinion.root_roughness_um = {roughness:g}" in line and "\n" not in line


def test_only_the_pinion_is_judged_by_the_standard_for_bending():
    found, _ = rated([DutyBin(500.0, 20.0, 3600.0)])
    assert {key[0] for key in found if key[2] == "ISO 6336-3"} == {"pinion"}


def test_what_fillets_would_carry_at_no_torque_is_no_load_of_the_duty_cycle():
    idle, used = DutyBin(0.0, 20.0, 3600.0), DutyBin(1000.0, 20.0, 3600.0)
    pressure = replace(PRESSURE, fillet_share=np.array([0.2, 0.0]))
    design = pair_design()
    for one in rate(design, ROOTS, pressure, request(idle, used)):
        assert one.fillet_share == 0.0


def test_teeth_bent_one_way_need_no_mean_stress_on_their_card():
    limits = replace(CARD.bending, mean_stress=None)
    body = RatedBody(card=replace(CARD, bending=limits), root_roughness=16e-6)
    assert permissible_bending(pair_design(), body, None, 0.0) > 0.0
    with pytest.raises(FacegearError, match="lacks bending"):
        permissible_bending(pair_design(), body, None, -0.1)


def test_the_pinions_tooth_form_does_not_depend_on_its_size_and_its_stress_is_that_of_the_standard():
    design = pair_design()
    ratio = section_contact_ratio(design)
    part = replace(
        design.pinion,
        **{name: 2.0 * getattr(design.pinion, name) for name in ("width", "addendum", "dedendum")},
        rack_tip_radius=2.0 * design.pinion.rack_tip_radius,
        profile_shift=2.0 * design.pinion.profile_shift,
    )
    twice = replace(design, module=2.0 * design.module, pinion=part)
    form, larger = pinion_form(design, ratio), pinion_form(twice, ratio)
    assert larger.form_factor == pytest.approx(form.form_factor, rel=1e-12)
    assert larger.chord == pytest.approx(2.0 * form.chord, rel=1e-12)
    force = 500.0 / design.pinion_pitch_radius
    face = design.face_gear.outer_radius - design.face_gear.inner_radius
    stress = force / (face * design.module) * form.form_factor * form.stress_correction
    assert standard_bending(design, form)(500.0) == pytest.approx(stress, rel=1e-12)
