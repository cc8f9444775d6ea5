"""Rolling bearings and preload in the section of a shaft: what they build, and one line of refusal."""

import shutil
from pathlib import Path
from string import ascii_uppercase

import numpy as np
import pytest
from ruamel.yaml import YAML
from three_pinions import TEXT

from facegear.bearings.shaft import find_shaft_equilibrium
from facegear.build.load import load_config
from facegear.build.rolling import nominal_state, rolling_shaft
from facegear.errors import ConfigErrors
from facegear.schema.base import parse
from facegear.schema.rolling import ROLLING_CARDS
from facegear.schema.shafts import ShaftSection
from facegear.schema.transmission import Transmission

EXAMPLE = Path(__file__).parents[3] / "config" / "bearings.yaml"
BALL, ROLLER = {"card": "deep_groove_6210"}, {"card": "cylindrical_roller_nu210"}
AHEAD = {"card": "angular_contact_7208", "loaded_by": "+z"}
BACK = {**AHEAD, "loaded_by": "-z"}
SPRING = {"radial_n_per_m": 2e8, "axial_n_per_m": 1e8}


def shaft(*bearings, **more):
    rolling = [{"rolling": each} if "card" in each else each for each in bearings]
    placed = [{"at_mm": 10 + 100 * i, **each} for i, each in enumerate(rolling)]
    segments = [{"length_mm": 50 + 100 * (len(bearings) - 1), "diameter_mm": 45}]
    return {"segments": segments, "pinion_mm": 40, "bearings": placed, **more}


def built(*bearings, **more):
    return rolling_shaft(parse(ShaftSection, shaft(*bearings, **more), "the shaft"))


def offsets(*bearings, **preload):
    return [1e6 * support.offset[2] for support in built(*bearings, preload=preload).supports]


def test_a_preload_presses_the_pair_as_the_thrust_that_loads_it():
    pair = {"bearings": ["A", "B"], "axial_um": 8}
    assert offsets(AHEAD, BACK, **pair) == pytest.approx([4.0, -4.0])
    assert offsets(BACK, AHEAD, **pair) == pytest.approx([-4.0, 4.0])


def test_inner_rings_of_ball_bearings_are_preloaded_towards_each_other():
    assert offsets(BALL, BALL, bearings=["A", "B"], axial_um=10) == pytest.approx([5.0, -5.0])
    assert offsets(BALL, BALL, bearings=["B", "A"], axial_um=10) == pytest.approx([5.0, -5.0])


def test_a_ball_bearing_beside_an_angular_one_is_pressed_against_it():
    assert offsets(BALL, AHEAD, bearings=["A", "B"], axial_um=6) == pytest.approx([-3.0, 3.0])


def test_a_preload_as_a_force_is_the_thrust_in_the_unloaded_pair():
    shaft = built(AHEAD, BACK, preload={"bearings": ["A", "B"], "axial_n": 400})
    state = find_shaft_equilibrium(shaft, np.zeros(5))
    assert np.allclose(state.forces[:, 2], [400.0, -400.0], rtol=1e-8)


def test_a_positive_preload_stiffens_and_endplay_leaves_the_pair_loose():
    pressed, loose = (
        find_shaft_equilibrium(
            built(AHEAD, BACK, preload={"bearings": ["A", "B"], "axial_um": amount}), np.zeros(5)
        )
        for amount in (8, -20)
    )
    assert pressed.forces[0, 2] > 0.0 > pressed.forces[1, 2]
    assert not loose.forces.any() and not loose.stiffness.any()


def test_a_bore_out_of_place_moves_the_shaft_and_loads_a_bearing_beside_two_others():
    moved = {"position_um": {"x": 20, "y": -5}}
    pair = built({"rolling": BALL, **moved}, {"rolling": BALL, **moved})
    state = find_shaft_equilibrium(pair, np.array([500.0, 0.0, 0.0, 0.0, 0.0]))
    nominal = find_shaft_equilibrium(built(BALL, BALL), np.array([500.0, 0.0, 0.0, 0.0, 0.0]))
    assert np.allclose(state.pinion - nominal.pinion, [20e-6, -5e-6, 0, 0, 0], rtol=0, atol=1e-10)
    strained = built(BALL, {"rolling": BALL, "position_um": {"x": 60, "y": 0}}, BALL)
    assert find_shaft_equilibrium(strained, np.zeros(5)).forces[1, 0] < -100.0


def test_a_tilt_of_the_shaft_tilts_both_inner_rings_and_lifts_the_second():
    made = built(BALL, ROLLER)
    tilted = made.rigid @ np.array([0.0, 0.0, 0.0, 0.0, 1e-3])
    assert tilted.reshape(2, 5)[:, 0] == pytest.approx([-30e-6, 70e-6])
    tilted = made.rigid @ np.array([0.0, 0.0, 0.0, 1e-3, 0.0])
    assert tilted.reshape(2, 5)[:, 1] == pytest.approx([30e-6, -70e-6])


def test_springs_and_rolling_bearings_may_hold_one_shaft():
    made = built(BALL, SPRING)
    assert isinstance(made.supports[1].bearing, np.ndarray)
    assert made.supports[1].bearing[0, 0] == 2e8


REFUSALS = [
    ((ROLLER, ROLLER), {}, 'bearings = "at 10, 110 mm"'),
    ((BALL,), {}, 'bearings = "at 10 mm"'),
    ((AHEAD, AHEAD), {}, 'loaded_by = "+z": must be the opposite'),
    ((AHEAD, ROLLER), {}, "bearings[0].rolling.loaded_by"),
    (({**SPRING, "position_um": {"x": 3, "y": 0}}, BALL), {}, "bearings[0].position_um"),
    (({"rolling": BALL, "position_um": {"x": 0, "y": 400}}, BALL), {}, "smaller than 0.02 element_diam"),
    (({"radial_n_per_m": 1e8, "rolling": BALL}, BALL), {}, "radial_n_per_m = 100000000.0: must be left out"),
    ((BALL, BALL), {"preload": {"bearings": ["A", "C"], "axial_um": 3}}, 'preload.bearings = "C"'),
    ((BALL, BALL), {"preload": {"bearings": ["A", "A"], "axial_um": 3}}, "two different letters"),
    ((BALL, BALL), {"preload": {"bearings": ["A", "B"]}}, "axial_um = null: must be given"),
    ((BALL, BALL), {"preload": {"bearings": ["A", "B"], "axial_um": 3, "axial_n": 9}}, "but not both"),
    ((BALL, ROLLER), {"preload": {"bearings": ["A", "B"], "axial_um": 3}}, "neither springs nor"),
    (
        (AHEAD, AHEAD, BACK),
        {"preload": {"bearings": ["A", "B"], "axial_um": 3}},
        "bearings with opposite loaded_by",
    ),
]


@pytest.mark.parametrize(("bearings", "more", "line"), REFUSALS)
def test_bearings_that_do_not_hold_the_shaft_are_refused_in_one_line(bearings, more, line):
    with pytest.raises(ConfigErrors) as refusal:
        parse(ShaftSection, shaft(*bearings, **more), "the shaft")
    messages = str(refusal.value).splitlines()
    assert len(messages) == 1 and line in messages[0]


def test_a_thrust_that_no_preload_gives_is_refused_by_its_whole_key():
    """The key began at the shaft's section, so that nobody saw which shaft it was."""
    pair = shaft(BALL, BALL, preload={"bearings": ["A", "B"], "axial_n": 1e6})
    with pytest.raises(ConfigErrors) as refusal:
        load_config(EXAMPLE, {"transmission": {"shafts": {"idler": pair}}})
    (line,) = refusal.value.lines
    assert line.startswith("transmission.shafts.idler.preload.axial_n = 1000000.0: must be less than 4")


@pytest.mark.parametrize("as_text", [False, True])
def test_a_card_of_ones_own_lies_beside_the_config_that_names_it(as_text, tmp_path):
    """It was looked for in the working directory, unlike every other file that a config names."""
    shutil.copy(ROLLING_CARDS / "deep_groove_6305.yaml", tmp_path / "own_card.yaml")
    rolling = "own_card.yaml" if as_text else {"card": "own_card.yaml"}
    own = {"transmission": {"shafts": {"idler": shaft({"rolling": rolling}, BALL)}}}
    YAML().dump(own, tmp_path / "own.yaml")
    bearings = load_config([EXAMPLE, tmp_path / "own.yaml"]).transmission.shafts["idler"].bearings
    assert [bearing.rolling.elements for bearing in bearings] == [7, 10]


def test_letters_name_as_many_bearings_as_a_shaft_may_have():
    assert len(ascii_uppercase) > ShaftSection.model_fields["bearings"].metadata[0].max_length


def test_bearings_far_too_small_for_the_torque_have_a_state_to_begin_with():
    tiny = {"type": "deep_groove_ball", "elements": 7, "element_diameter_mm": 0.5, "pitch_diameter_mm": 30}
    made = parse(ShaftSection, shaft(BALL, BALL), "the shaft")
    small = parse(ShaftSection, shaft({"rolling": tiny}, {"rolling": tiny}), "the shaft")
    assert nominal_state(made, 1e4).pinion_load[0] == pytest.approx(1e4)
    assert 0.0 <= nominal_state(small, 1e7).pinion_load[0] < 1e7


def transmission(**changes):
    values = YAML(typ="safe").load(TEXT)
    values["pinion"] = {**values["pinion"], **changes.pop("pinion", {})}
    return parse(Transmission, {**values, "shafts": {"one": shaft(BALL, BALL)}, **changes})


def test_a_clearance_of_the_pinion_beside_rolling_bearings_is_refused():
    assert transmission().shafts["one"].is_rolling
    with pytest.raises(ConfigErrors) as refusal:
        transmission(pinion={"clearance_um": 10.0})
    (line,) = str(refusal.value).splitlines()
    assert "pinion.clearance_um = 10.0" in line and "0 beside rolling, whose clearance_diametral_um" in line


def test_a_bearing_stiffness_of_the_pinion_beside_rolling_bearings_is_refused():
    stiffness = {"x": 1e8, "y": 1e8, "z": 0.0}
    with pytest.raises(ConfigErrors, match=r"single_pinions\.one\.bearing_stiffness_n_per_m.*left out"):
        transmission(single_pinions={"one": {"bearing_stiffness_n_per_m": stiffness}})
