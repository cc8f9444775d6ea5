"""A machine to start from is complete, meshes freely, can be rated, splits its torque, and says why."""

import random
import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import facegear
from facegear.build.config import resolved_values
from facegear.build.load import config_of
from facegear.build.tooth_pair import pair
from facegear.errors import ConfigError, FacegearError
from facegear.new_machine.draft import STIFFNESS
from facegear.new_machine.first_machine import first_machine, load_concentration
from facegear.new_machine.teeth import choose_teeth
from facegear.new_machine.wishes import MachineWishes, ToothWishes
from facegear.schema.yaml_file import read_yaml
from facegear.strength.cylindrical import pinion_form
from facegear.teeth.analysis import analyse, path_curvatures


def make_known(case, pinion_teeth, face_gear_teeth, module_mm, torque_n_m, speed_rpm, pinions=1, **others):
    """A machine by what is always given of it."""
    return MachineWishes(
        pinion_teeth=pinion_teeth,
        face_gear_teeth=face_gear_teeth,
        module_mm=module_mm,
        case=case,
        torque_n_m=torque_n_m,
        speed_rpm=speed_rpm,
        pinions=pinions,
        **others,
    )


MACHINES = (
    make_known("small", 19, 57, 2, 50, 10000, pinions=3),
    make_known("paper", 23, 143, 3.75, 1300, 7500, 2),
    make_known("plain", 40, 120, 1, 5, 500, pressure_angle_deg=20),
    make_known("large", 25, 160, 6.35, 800, 5000, coarse=True),
    make_known("split", 23, 143, 3.75, 1300, 7500, pinions=2, idlers=3),
    make_known("odd", 19, 57, 2, 50, 10000, pinions=1, idlers=2),
)
TEETH = (5, 7, 9, 10, 11, 12, 14, 16, 17, 20, 25, 40)
ANGLES = (17.5, 20.0, 22.5, 25.0, 27.5)
KINDS = ((1, 0), (3, 0), (5, 0), (2, 3), (1, 2))
"""Inputs and idlers of the five machines that are made of every pair of teeth."""
MODULE = 3.0
NAMED = re.compile(r"no teeth for .*: (the contact ratio is|the teeth of every candidate interfere)")


def values_of(text, folder):
    path = folder / "own.yaml"
    path.write_text(text)
    return read_yaml(path)


@cache
def pairs_of_teeth():
    """Sixty pairs of tooth numbers and pressure angles, drawn by a fixed seed over the whole range."""
    draw = random.Random(50)
    return [(teeth, round(teeth * draw.uniform(3, 7)), angle) for teeth in TEETH for angle in ANGLES]


def torque_for(teeth, unit_load, idlers):
    """Torque of an input, N m, that gives a mesh F_t/(b m) in MPa on 6.4 modules of face."""
    force = unit_load * 6.4 * MODULE * MODULE
    return force * MODULE * teeth / 2e3 * (2 if idlers else 1)


@pytest.mark.parametrize("teeth", TEETH)
def test_every_machine_of_a_grid_passes_check_or_has_no_teeth(teeth, tmp_path):
    """19 of 63 starter machines had interfering teeth and 7 were refused."""
    draw = random.Random(teeth)
    for pinion, gear, angle in [one for one in pairs_of_teeth() if one[0] == teeth]:
        for pinions, idlers in KINDS:
            torque = torque_for(pinion, draw.uniform(20, 60), idlers)
            known = make_known(
                "own", pinion, gear, MODULE, torque, 3000, pinions, pressure_angle_deg=angle, idlers=idlers
            )
            try:
                machine = first_machine(known)
            except FacegearError as error:
                assert teeth < 12 and NAMED.match(str(error)), error
                continue
            config = config_of(values_of(machine.text, tmp_path))
            assert not idlers or "worse than" not in "".join(machine.expectations)
            assert config.tooth_pair.face_gear_teeth == gear


@pytest.mark.parametrize("known", MACHINES, ids=lambda known: known.case)
def test_chosen_teeth_mesh_freely_at_more_positions_and_can_be_rated(known, tmp_path):
    config = config_of(values_of(first_machine(known).text, tmp_path))
    design = pair(config.tooth_pair).design
    analysis = analyse(design, 48)
    assert analysis.interference is None
    assert analysis.contact_ratio > 1.05
    assert design.shaper.tip_rounding > 0.0
    assert np.isfinite(pinion_form(design, analysis.contact_ratio).notch_parameter)


@pytest.mark.parametrize("known", MACHINES, ids=lambda known: known.case)
def test_what_a_user_knows_is_enough_for_a_config_without_mistakes(known, tmp_path):
    values = resolved_values(config_of(values_of(first_machine(known).text, tmp_path)))
    assert values["tooth_pair"]["face_gear_teeth"] == known.face_gear_teeth
    machine = values["transmission"]
    assert machine["torque"]["per_input_n_m"] == known.torque_n_m
    roles = [pinion["role"] for pinion in machine["pinions"]]
    assert (roles.count("input"), roles.count("idler")) == (known.pinions, known.idlers)
    assert len(machine["face_gears"]) == (2 if known.idlers else 1)
    assert len(values["strength"]["duty"]) == 1 and values["lubrication"] is not None


def with_constant_stiffness(known, tmp_path):
    """The written machine with one mesh stiffness, so that no contact analysis is needed."""
    values = values_of(first_machine(known).text, tmp_path)
    face = values["tooth_pair"]["face_gear"]
    stiffness = 1.4e7 * (face["outer_radius_mm"] - face["inner_radius_mm"])
    values["mesh_stiffness"] = {"source": "harmonics", "table": [{"order": 0, "cos_n_per_m": stiffness}]}
    values["transmission"]["transmission_error"] = {"amplitude_um": 0}
    del values["strength"], values["lubrication"]
    return values, facegear.load(values)


def test_idlers_lead_what_the_lower_gear_takes_to_the_upper_one(tmp_path):
    _, gearbox = with_constant_stiffness(MACHINES[4], tmp_path)
    power = gearbox.statics().table().set_index("mesh")["power_kw"]
    lower = power[[mesh.endswith("/lower") for mesh in power.index]]
    assert lower.sum() == pytest.approx(0.0, abs=1e-6 * power.abs().max())
    assert lower[["input 1/lower", "input 2/lower"]].min() > 0.0
    assert lower[["idler 1/lower", "idler 2/lower", "idler 3/lower"]].max() < 0.0


@pytest.mark.parametrize(
    "known",
    [
        make_known("split", 23, 143, 3.75, 1328, 7500, pinions=2, idlers=3),
        make_known("light", 22, 101, 3.5, 300, 3000, pinions=2, idlers=2),
    ],
    ids=lambda known: known.case,
)
def test_a_split_torque_machine_splits_its_torque_as_it_says(known, tmp_path):
    """It shared nothing: K_gamma was 1.999, and idlers carried 0.1 %."""
    _, gearbox = with_constant_stiffness(known, tmp_path)
    groups = gearbox.hunting().table().set_index("group")
    said = first_machine(known).expectations[1]
    inputs, _, highest, ratio = map(float, re.findall(r"\d+\.\d+|\d+", said.partition(" (")[0]))
    found = groups["k_gamma"].filter(like="input").max()
    assert found == pytest.approx(inputs, rel=0.1) and found <= 1.3
    assert groups.loc["idlers", "k_gamma"] == pytest.approx(highest, rel=0.1)
    assert 0.7 <= groups.loc["idlers", "k_gamma"] <= 1.3
    assert groups["group_ratio"].max() == pytest.approx(ratio, rel=0.1)
    assert groups["group_ratio"].max() <= 1.3 * 1.02


@pytest.mark.parametrize("known", [MACHINES[1], MACHINES[4]], ids=lambda known: known.case)
def test_printed_resonances_are_natural_frequencies_in_the_speed_range(known, tmp_path):
    """They were frequencies in Hz divided by 2 pi."""
    values, gearbox = with_constant_stiffness(known, tmp_path)
    sweep = values["dynamics"]["sweep"]
    frequencies = gearbox.modes().table()["frequency_hz"].round(1).unique()
    speeds = 60.0 * frequencies / known.pinion_teeth
    within = sorted(speed for speed in speeds if sweep["from_rpm"] <= speed <= sweep["to_rpm"])
    said = [float(number) for number in re.findall(r"[\d.]+", first_machine(known).expectations[-1])]
    assert said == pytest.approx(within[: len(said)], rel=2e-3) and len(said) > 1


def with_face(design, inner, outer):
    """A design whose face reaches from `inner` to `outer`, m from the path of contact."""
    path = 0.5 * design.module * design.face_gear.teeth
    gear = replace(design.face_gear, inner_radius=path + inner, outer_radius=path + outer)
    return replace(design, face_gear=gear, pinion=replace(design.pinion, width=outer - inner))


def test_the_line_load_of_a_wide_face_is_the_parabola_of_the_crowning():
    """Strips of stiffness c carry F = 2/3 c k a^3 within the half-width a, the largest 3/4 F / a."""
    design = choose_teeth(ToothWishes(23, 143, 3.75)).design
    concentration = [load_concentration(with_face(design, -0.1, 0.1), torque) for torque in (100.0, 800.0)]
    assert concentration[0] == pytest.approx(2.0 * concentration[1], rel=1e-6)
    roll, _, curvature, _ = path_curvatures(design)
    at_pitch = np.interp(np.tan(design.pressure_angle), roll, curvature)
    half_width = (1.5 * 100.0 / design.pinion_base_radius / (STIFFNESS * at_pitch)) ** (1 / 3)
    assert concentration[0] == pytest.approx(0.75 * 0.2 / half_width, rel=0.02)


def test_a_face_beside_the_path_carries_more_and_flanks_without_crowning_none():
    design = choose_teeth(ToothWishes(23, 143, 3.75)).design
    even = [
        load_concentration(with_face(design, start, start + 0.02), 500.0) for start in (-0.01, -0.002, 0.001)
    ]
    assert 1.0 < even[0] < even[1] < even[2]
    straight = choose_teeth(ToothWishes(23, 143, 3.75, shaper_teeth=23)).design
    assert load_concentration(straight, 500.0) == pytest.approx(1.0, abs=1e-6)


def test_every_mesh_at_rest_lies_inside_the_torques_of_the_contact_analysis(tmp_path):
    values, gearbox = with_constant_stiffness(MACHINES[4], tmp_path)
    at_rest = gearbox.statics().table()["pinion_torque_n_m"].abs()
    torques = values["contact"]["torques_n_m"]
    assert torques[0] < at_rest.min() and at_rest.max() < torques[-1]


def test_a_load_too_small_to_share_says_what_is_nearest():
    known = make_known("light", 23, 143, 3.75, 20, 7500, pinions=2, idlers=5)
    (line,) = [line for line in first_machine(known).expectations if "worse than" in line]
    assert re.search(r"F_t/\(b m\) = 2\.06 MPa; nearest: at least", line)


def test_a_load_too_light_for_the_contact_analysis_names_the_nearest():
    with pytest.raises(FacegearError, match=r"^torque_n_m = 0\.01: the contact analysis .* nearest: 2\.02$"):
        first_machine(make_known("own", 23, 143, 3.75, 0.01, 7500))


def test_the_chosen_bodies_are_those_of_a_steel_ring(tmp_path):
    machine = values_of(first_machine(MACHINES[1]).text, tmp_path)
    pinion, width = machine["transmission"]["pinion"], machine["tooth_pair"]["pinion"]
    outer, bore = 0.5 * 3.75 * 23, width["bore_radius_mm"]
    volume = np.pi * (outer**2 - bore**2) * width["width_mm"]
    assert pinion["mass_kg"] == pytest.approx(7850e-9 * volume, rel=1e-3)
    gyration = 1e-6 * (outer**2 + bore**2) / 2
    assert pinion["inertia_kg_m2"] == pytest.approx(pinion["mass_kg"] * gyration, rel=1e-3)


@pytest.mark.parametrize(
    ("key", "value", "place"),
    [
        ("profile_shift_modules", 0.2, ("tooth_pair", "pinion", "profile_shift_modules")),
        ("gear_addendum_modules", 0.7, ("tooth_pair", "face_gear", "addendum_modules")),
        ("shaper_teeth", 24, ("tooth_pair", "shaper", "teeth")),
        ("thinning_um", 90.0, ("tooth_pair", "pinion", "thinning_um")),
        ("pinion_mass_kg", 3.0, ("transmission", "pinion", "mass_kg")),
        ("mesh_damping_n_s_per_m", 900.0, ("transmission", "damping", "mesh_n_s_per_m")),
        ("input_bearing_n_per_m", 2e8, ("transmission", "pinion", "bearing_stiffness_n_per_m", "x")),
    ],
)
def test_a_given_value_stands_in_the_config(key, value, place, tmp_path):
    found = values_of(
        first_machine(make_known("own", 23, 143, 3.75, 600, 7500, **{key: value})).text, tmp_path
    )
    for name in place:
        found = found[name]
    assert found == value


def test_a_machine_without_load_is_refused_in_one_line():
    with pytest.raises(ConfigError, match=r"^torque_n_m = 0: must be from 1e-05 to 1e\+06$"):
        first_machine(make_known("own", 23, 143, 3.75, 0, 7500))


@pytest.mark.parametrize(
    ("wishes", "line"),
    [
        (
            {"pinions": 30},
            r"pinions = 30: must be at most 16 round this gear, each of .* 21\.29 deg",
        ),
        ({"torque_n_m": 1e6}, r"torque_n_m = 1000000\.0: must be at most .* for these teeth: beyond it the"),
        ({"idlers": 20}, "pinions and idlers = 21: must be at most 16 round this gear"),
        (
            {"pinion_bore_radius_mm": 45.0},
            r"pinion_bore_radius_mm = 45\.0: must be less than",
        ),
        ({"gear_bearing_n_per_m": 0.0}, r"gear_bearing_n_per_m = 0\.0: must be from 1 to"),
        ({"idler_bearing_n_per_m": 1e9}, "idler_bearing_n_per_m = .*: must be left out without idlers"),
    ],
)
def test_a_wish_that_no_machine_can_meet_is_refused_with_what_can(wishes, line):
    """A bearing of 0 was replaced in silence, a wide bore ended in a traceback."""
    with pytest.raises(ConfigError, match=f"^{line}"):
        first_machine(replace(make_known("own", 23, 143, 3.75, 600, 7500), **wishes))


def test_a_single_idler_has_no_load_sharing_of_its_own():
    """It was said to have K_gamma nan to nan."""
    (line,) = [
        line
        for line in first_machine(make_known("own", 23, 143, 3.75, 600, 7500, idlers=1)).expectations
        if line.startswith("K_gamma")
    ]
    assert "nan" not in line and "idlers" not in line


def test_bearings_that_a_user_gave_are_named_where_they_keep_the_torque_from_being_shared():
    known = make_known("own", 23, 143, 3.75, 600, 7500, 2, idlers=2, idler_bearing_n_per_m=100.0)
    assert "nearest: bearings as chosen without idler_bearing_n_per_m" in "".join(
        first_machine(known).expectations
    )


def pair_of_19_and_97(torque_n_m, **others):
    return make_known("own", 19, 97, 2.5, torque_n_m, 5000, pressure_angle_deg=20.0, coarse=True, **others)


def test_teeth_that_pit_get_a_shaper_that_spreads_the_contact():
    """A face that undercut ends beside the path of contact was red for pitting at its own torque."""
    light, hard = (first_machine(pair_of_19_and_97(torque)).text for torque in (15, 60))
    assert "teeth: 22 # chosen: three more than the pinion, which localises the contact" in light
    assert "teeth: 20 # chosen: 1 tooth more than the pinion, which spreads the contact" in hard


@pytest.mark.parametrize("others", [{}, {"idlers": 2}, {"shaper_teeth": 22}])
def test_a_torque_that_is_too_large_is_named_with_one_that_is_not(others):
    lines = "\n".join(first_machine(pair_of_19_and_97(300, **others)).expectations)
    (nearest,) = re.findall(r"leaves the rating without reserve .* nearest: at most ([\d.]+) N m", lines)
    assert 20.0 < float(nearest) < 300.0
    for part, is_named in ((0.97, False), (1.05, True)):
        lines = "\n".join(first_machine(pair_of_19_and_97(part * float(nearest), **others)).expectations)
        assert ("leaves the rating without reserve" in lines) == is_named


def test_too_few_teeth_are_refused_by_the_geometric_reason():
    with pytest.raises(FacegearError, match=r"the contact ratio is 0\.\d+ at most, below 1\.05"):
        choose_teeth(ToothWishes(6, 40, 3.0, 25.0))
