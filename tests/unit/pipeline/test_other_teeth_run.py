"""Helical and tapered pairs through the chain of stages, from contact to the machine's load sharing."""

from dataclasses import fields
from math import cos, pi, radians, sin, tan

import numpy as np
import pandas as pd
import pytest
from kinds_of_teeth import public_section

import facegear
from facegear.build.tooth_pair import ToothPair, pair_design
from facegear.contact.summary import BY_FLANK_COLUMNS
from facegear.lubrication.pairs import FlankPairs
from facegear.pipeline.stages.friction import loaded_pairs
from facegear.pipeline.stages.strength import rating
from facegear.schema.base import parse
from facegear.schema.lubrication import LubricationSection
from facegear.schema.strength import Strength
from facegear.strength.columns import DUTY_SPECTRUM_COLUMNS
from facegear.studies.lubricated_teeth import reduction_over

COARSE = {
    "mesh": {"resolution": {"profile_mm": 1.4, "width_mm": 6, "thickness_mm": 4}},
    "contact": {
        "torques_n_m": [300, 600],
        "positions_per_pitch": 4,
        "refinement": {"profile": 3, "width": 1, "depth": 1},
        "sector": {"pinion_teeth": 7, "face_gear_teeth": 7},
        "edge_contact": False,  # edges press along other normals than the flank's
    },
}
BODY = {"mass_kg": 1.2, "inertia_kg_m2": 0.002, "bearing_stiffness_n_per_m": {"x": 2e8, "y": 2e8, "z": 2e8}}
MACHINE = {
    "mesh_stiffness": {"torque_n_m": 400, "harmonics_kept": 1},
    "transmission": {
        "pinions": [
            {"name": "engine", "role": "input", "angle_deg": 0},
            {"name": "idler", "role": "idler", "angle_deg": 180},
        ],
        "pinion": BODY,
        "face_gear": BODY | {"mass_kg": 8, "inertia_kg_m2": 0.4},
        "damping": {"mesh_n_s_per_m": 1500, "mass_per_s": 50, "bearing_s": 2e-6},
        "transmission_error": "from_contact",
        "torque": {"per_input_n_m": 500, "tail_share": 0},
    },
    "dynamics": {"speed_rpm": 6000, "sweep": {"from_rpm": 500, "to_rpm": 9000, "points": 4}},
}
NAMES = ("P1", "P2")


@pytest.fixture(scope="module")
def gearbox_of():
    """Machines with two gears of public designs, by name; each solves its contact once."""
    known = {}

    def gearbox(name, **pair):
        key = name, *pair.items()
        if key not in known:
            section = public_section(name) | pair
            known[key] = facegear.load(
                {"case": "kind", "tooth_pair": section, **COARSE, **MACHINE}, results=None
            )
        return known[key]

    return gearbox


def axial_force(section, side):
    """Return the closed form of the axial force on the pinion over its torque, 1/m."""
    beta, delta, alpha = (radians(section[f"{name}_angle_deg"]) for name in ("helix", "taper", "pressure"))
    radius = 0.5e-3 * section["pinion_teeth"] * section["module_mm"] / cos(beta)
    return -(side * tan(beta) * cos(delta) - tan(alpha) * sin(delta) / cos(beta)) / radius


@pytest.mark.parametrize("name", NAMES)
def test_axial_force_of_every_flank_is_the_closed_form(gearbox_of, name):
    gearbox = gearbox_of(name)
    table = gearbox.contact().by_flank()
    for flank, side in (("drive", 1), ("back", -1)):
        rows = table[table["flank"] == flank]
        expected = axial_force(gearbox.values["tooth_pair"], side)
        np.testing.assert_allclose(rows["pinion_axial_n"], expected * rows["torque_n_m"], rtol=1e-9)
    assert table["load_share_max"].between(0.4, 1.0).all()


def test_other_hand_swaps_the_flanks(gearbox_of):
    """Rule of the mirror: coast flanks are the drive flanks of the pair of the other hand."""
    ours, others = (gearbox_of("P1", helix_angle_deg=beta).contact().by_flank() for beta in (15, -15))
    quantities = [
        "k_average_mean_n_per_m",
        "ste_peak_to_peak_um",
        "pressure_mpa",
        "force_y_n",
        "path_radius_mm",
    ]
    for flank, other in (("drive", "back"), ("back", "drive")):
        mine, theirs = ours[ours["flank"] == flank], others[others["flank"] == other]
        np.testing.assert_allclose(mine[quantities], theirs[quantities], rtol=1e-9)


def test_spur_pairs_keep_their_table_of_flanks():
    table = facegear.example().contact(torques=[600], positions=4).by_flank()
    assert list(table.columns) == list(BY_FLANK_COLUMNS)


@pytest.mark.parametrize("name", NAMES)
def test_machine_shares_its_load_with_the_stiffness_of_contact(gearbox_of, name):
    gearbox = gearbox_of(name)
    mean = gearbox.stiffness().table()["mean_average_n_per_m"].iloc[0]
    by_torque = gearbox.contact().by_torque()
    assert by_torque["k_average_mean_n_per_m"].min() < mean < by_torque["k_average_mean_n_per_m"].max()
    torques = gearbox.statics().table().set_index("mesh")["pinion_torque_n_m"]
    assert torques["engine/upper"] + torques["engine/lower"] == pytest.approx(500.0, abs=1e-6)
    assert torques["idler/upper"] + torques["idler/lower"] == pytest.approx(0.0, abs=1e-6)
    shares = gearbox.load_sharing().table().iloc[0]
    assert 1.0 < shares["mean"] < 2.0 and shares["minimum"] < shares["mean"] < shares["maximum"]


def test_mesh_law_has_a_table_of_each_flank_of_helical_teeth(gearbox_of):
    gearbox = gearbox_of("P1").with_values({"mesh_stiffness.mesh_law": "load_dependent"})
    levels = gearbox.mesh_law().table()
    assert set(gearbox.mesh_law().arrays()["flank_variant"].ravel()) == {0, 1}
    drive, back = (levels[levels["flank"] == flank] for flank in ("drive", "back"))
    assert 0.9 < drive["slope_n_per_m"].iloc[-1] / back["slope_n_per_m"].iloc[-1] < 1.1


FINE_FILLETS = {"profile_mm": 0.8, "width_mm": 4, "thickness_mm": 4, "fillet_mm": 0.4, "fillet_depth_mm": 0.4}


BODY_STRENGTH = {"card": "case_carburised_din3990_11", "root_roughness_um": 16}
STRENGTH = {
    "pinion": BODY_STRENGTH,
    "face_gear": BODY_STRENGTH,
    "load_factors": "machine",
    "duty": [{"torque_n_m": 600, "speed_rpm": 6000, "hours": 100}],
}
MIRRORED = {"drive": "back", "back": "drive"}


@pytest.fixture(scope="module")
def hands():
    """Pairs with root stress by their helix angle: right-hand pinions and their mirror images."""
    gearboxes = {}
    for beta in (15, -15):
        section = public_section("P1") | {"helix_angle_deg": beta}
        section["shaper"] = section["shaper"] | {"tip_rounding_modules": 0.1}
        contact = COARSE["contact"] | {"root_stress": True, "positions_per_pitch": 8}
        values = {"tooth_pair": section, "contact": contact, "mesh": {"resolution": FINE_FILLETS}}
        gearboxes[beta] = facegear.load({"case": "kind"} | values, results=None)
    return gearboxes


def test_root_stress_and_its_error_follow_the_mirror_rule(hands):
    """The back flanks had the error of the drive flanks' distance of planes: 16.0 instead of 4.5 MPa."""
    tables = [gearbox.root_stress().by_flank() for gearbox in hands.values()]
    for flank, other in MIRRORED.items():
        mine, theirs = tables[0][tables[0]["flank"] == flank], tables[1][tables[1]["flank"] == other]
        for name in ("largest_mpa", "largest_error_mpa", "passage", "radius_mm"):
            np.testing.assert_allclose(mine[name], theirs[name], rtol=1e-6)


def rate_flanks(gearbox, torques):
    """Return table `rating` of a pair whose flanks carry torques (N m) by their names, as in a machine."""
    section = parse(ToothPair, gearbox.values["tooth_pair"])
    arm = pair_design(section).normal_arm
    spectrum = pd.DataFrame(
        [
            (1, body, gear, flank, "engine/upper", 1.0, torque / arm)
            for body, gear in (("engine", "pinion"), ("upper face gear", "face_gear"))
            for flank, torque in torques.items()
        ],
        columns=list(DUTY_SPECTRUM_COLUMNS),
    )
    contents = gearbox.root_stress().content["stress"], gearbox.contact().by_flank()
    strength = parse(Strength, STRENGTH)
    return rating(*contents, spectrum, tooth_pair=section, strength=strength, gears=["upper"]).content


def test_rated_stress_of_each_flank_is_that_of_contact_at_the_same_torque(hands):
    gearbox = hands[15]
    rows = rate_flanks(gearbox, {"drive": 600.0, "back": 300.0})["rating"].set_index(
        ["gear", "flank", "method"]
    )
    roots = gearbox.root_stress().by_flank().groupby(["gear", "flank", "torque_n_m", "body"])["largest_mpa"]
    pressure = gearbox.contact().by_flank().set_index(["gear", "flank", "torque_n_m"])["pressure_mpa"]
    for flank, torque in (("drive", 600.0), ("back", 300.0)):
        for body in ("pinion", "face_gear"):
            stress = rows.loc[(body, flank, "finite elements"), "stress_mpa"]
            assert stress == pytest.approx(roots.max()["upper", flank, torque, body], rel=1e-12)
            stress = rows.loc[(body, flank, "contact analysis"), "stress_mpa"]
            assert stress == pytest.approx(pressure["upper", flank, torque], rel=1e-12)


def test_rating_of_each_flank_is_that_of_the_other_flank_of_the_other_hand(hands):
    """Rule of the mirror, with the compression by either flank's own contact where teeth bend both ways."""
    ours = rate_flanks(hands[15], {"drive": 600.0, "back": 500.0})
    theirs = rate_flanks(hands[-15], {"drive": 500.0, "back": 600.0})
    keys = ["gear", "flank", "failure", "method"]
    for name in ("rating", "damage"):
        mirrored = theirs[name].assign(flank=theirs[name]["flank"].map(MIRRORED))
        mine, others = (table.sort_values(keys, ignore_index=True) for table in (ours[name], mirrored))
        pd.testing.assert_frame_equal(mine, others, rtol=1e-12)
    allowed = ours["rating"].set_index(keys)["allowed_mpa"]
    flanks = [allowed["face_gear", flank, "bending", "finite elements"] for flank in MIRRORED]
    assert abs(flanks[0] / flanks[1] - 1.0) > 0.005  # each has a stress ratio of its own


def test_rating_of_tapered_teeth_goes_to_that_of_spur_teeth_in_proportion():
    """Stress, what is allowed and safety of both gears by finite elements, on a narrow face."""
    section = public_section("P2")
    section["shaper"] = section["shaper"] | {"tip_rounding_modules": 0.1}
    section["face_gear"] = section["face_gear"] | {"outer_radius_mm": 262}
    section["pinion"] = section["pinion"] | {"width_mm": 12, "middle_mm": 257.5}
    sector = {"sector": {"pinion_teeth": 5, "face_gear_teeth": 5}}
    contact = COARSE["contact"] | sector | {"torques_n_m": [300], "root_stress": True}
    strength = STRENGTH | {"load_factors": "given", "pinion": BODY_STRENGTH | {"both_ways": True}}
    strength["duty"] = [{"torque_n_m": 300, "speed_rpm": 6000, "hours": 100}]
    values = {"case": "kind", "contact": contact, "strength": strength}
    values["mesh"] = {"resolution": FINE_FILLETS | {"width_mm": 6}}
    numbers = []
    for taper in (0.0, 1e-4, 1e-3):
        teeth = {"tooth_pair": section | {"taper_angle_deg": taper}}
        table = facegear.load(values | teeth, results=None).rating().table()
        rows = table[table["method"].isin(["finite elements", "contact analysis"])]
        numbers.append(rows[["stress_mpa", "allowed_mpa", "safety"]].to_numpy())
    small, large = (np.abs(each / numbers[0] - 1.0) for each in numbers[1:])
    assert (large < 1e-4).all() and large.max() > 1e-5
    np.testing.assert_allclose(small, 0.1 * large, rtol=1e-2, atol=1e-11)


OIL = {"oil": "polyol_ester_5_cst", "supply_temperature_c": 100, "pinion": {"ra_um": 0.3}}
OIL |= {
    "face_gear": {"ra_um": 0.3},
    "bulk": {"source": "cooling", "pinion_w_per_k": 60, "face_gear_w_per_k": 200},
}


@pytest.mark.parametrize("name", ["P1", "P2", "P3", "P4"])
def test_power_of_the_moments_of_friction_is_its_loss(name):
    """Loss comes from sliding at the contacts, moments from friction's forces about both axes."""
    machine = {"lubrication": OIL, "dynamics": {"speed_rpm": 6000}}
    pair_alone = {"case": "kind", "tooth_pair": public_section(name)}
    friction = facegear.load(pair_alone | COARSE | machine, results=None).friction(speed_rpm=6000)
    design = pair_design(parse(ToothPair, public_section(name)))
    ratio = design.pinion.teeth / design.face_gear.teeth
    table = friction.content["excitation"]
    drive = table[(table["gear"] == "upper") & (table["flank"] == "drive")]
    levers = drive.groupby("torque_n_m")[["pinion_lever_mm", "face_gear_lever_mm"]].mean()
    lever = 1e-3 * (levers["pinion_lever_mm"] + ratio * levers["face_gear_lever_mm"])
    power = -lever * levers.index / design.normal_arm * 6000 * pi / 30
    losses = friction.content["by_torque"].set_index("torque_n_m")["loss_w"]
    np.testing.assert_allclose(power, losses, rtol=1e-12)
    local = friction.content["local"]
    assert all(np.isfinite(values).all() for values in local.values())


LUBRICATED = {"lubrication": OIL | {"friction": {"model": "schlenk"}}}


def pairs_of(gearbox):
    """Return the lubricated pairs of all flanks of a machine, from its stored contact."""
    section = parse(LubricationSection, LUBRICATED["lubrication"])
    contact, teeth = gearbox.contact().content, parse(ToothPair, gearbox.values["tooth_pair"])
    return FlankPairs(*loaded_pairs(contact["ltca"], contact["pressure"], section, teeth))


def test_other_hand_swaps_loss_and_excitation_of_the_flanks(gearbox_of):
    """Rule of the mirror, through loss, heat, film and all ratios of friction."""
    right, left = (pairs_of(gearbox_of("P1", helix_angle_deg=beta)) for beta in (15, -15))
    bulk = np.array([[120.0, 110.0]])
    for flank in (0, 1):
        mine, theirs = (
            pairs.of_meshes(np.array([0]), np.array([side])).curves(600.0, bulk)
            for pairs, side in ((right, flank), (left, 1 - flank))
        )
        for field in fields(mine):
            np.testing.assert_allclose(
                getattr(mine, field.name), getattr(theirs, field.name), rtol=1e-7, err_msg=field.name
            )
    drive, back = (right.pairs[number].losses(600.0, bulk).loss_fraction for number in (0, 1))
    assert np.abs(drive / back - 1.0).max() > 0.01
    tables = [
        gearbox_of("P1", helix_angle_deg=beta).with_values(LUBRICATED).friction().content["excitation"]
        for beta in (15, -15)
    ]
    for flank, other in (("drive", "back"), ("back", "drive")):
        mine, theirs = (
            table[table["flank"] == side].drop(columns="flank").set_index("gear")
            for table, side in zip(tables, (flank, other), strict=True)
        )
        np.testing.assert_allclose(mine, theirs, atol=1e-7 * np.abs(mine.to_numpy()).max())


@pytest.mark.parametrize("name", NAMES)
def test_machine_loses_what_each_loaded_flank_does_and_its_bodies_take_the_heat(gearbox_of, name):
    gearbox = gearbox_of(name).with_values(LUBRICATED)
    losses, pairs = gearbox.losses(), pairs_of(gearbox)
    meshes, bodies = losses.meshes(), losses.content["bodies"]
    assert set(meshes["flank"]) == {"drive", "back"}  # an idler presses on its back flank
    for row in meshes.itertuples():
        number = pairs.numbers[("upper", "lower").index(row.mesh.rpartition("/")[2])][
            ("drive", "back").index(row.flank)
        ]
        bulk = np.array([[row.pinion_bulk_c, row.face_gear_bulk_c]])
        curves = pairs.pairs[number].losses(6000 * pi / 30, bulk)
        (fraction,) = curves.at(np.array([row.pinion_torque_n_m]), "loss_fraction")
        assert row.loss_w == pytest.approx(fraction.item() * row.power_w, rel=1e-6)
    whole = losses.content["machine"].iloc[0]
    assert meshes["loss_w"].sum() == pytest.approx(whole["loss_w"], rel=1e-12)
    assert bodies["heat_w"].sum() == pytest.approx(whole["loss_w"], rel=1e-12)
    cooled = bodies.assign(w_per_k=np.where(bodies["body"].str.contains("gear"), 200.0, 60.0))
    np.testing.assert_allclose(cooled["bulk_c"], 100.0 + cooled["heat_w"] / cooled["w_per_k"], rtol=1e-9)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("bulk", [{"source": "given", "temperature_c": 110}, {"source": "iso_6336_20"}])
def test_flanks_without_cooling_have_the_bulk_of_their_own_contact(gearbox_of, name, bulk):
    gearbox = gearbox_of(name).with_values(
        {"lubrication": OIL | {"bulk": bulk, "friction": {"model": "schlenk"}}}
    )
    meshes = gearbox.losses().meshes().set_index("mesh")
    assert meshes["pinion_bulk_c"].between(100.0, 200.0).all()
    drive, back = meshes.loc["idler/upper"], meshes.loc["idler/lower"]
    assert (drive["flank"], back["flank"]) == ("drive", "back")
    assert drive["power_w"] == pytest.approx(back["power_w"])
    same = drive["pinion_bulk_c"] == pytest.approx(back["pinion_bulk_c"], abs=1e-6)
    assert same == (bulk["source"] == "given" or name == "P2")
    assert (drive["loss_w"] == pytest.approx(back["loss_w"], rel=1e-6)) == (name == "P2")


@pytest.mark.parametrize("name", NAMES)
def test_slow_motion_with_friction_loses_what_the_machine_at_rest_does(gearbox_of, name):
    friction = {"model": "constant", "coefficient": 0.01, "effect": "excitation"}
    changes = {"lubrication": OIL | {"friction": friction}, "dynamics.speed_rpm": 200}
    gearbox = gearbox_of(name).with_values(changes)
    meshes = gearbox.losses().meshes()
    np.testing.assert_allclose(meshes["loss_in_motion_w"], meshes["loss_w"], rtol=0.01)
    rubbed, without = (
        one.response().content["bearings"]["mean_n"]
        for one in (gearbox, gearbox_of(name).with_values({"dynamics.speed_rpm": 200}))
    )
    assert np.abs(rubbed - without).max() > 1e-4 * np.abs(without).max()


def test_few_places_of_both_flanks_lose_as_all_places_do(gearbox_of):
    """Samples of tolerances take friction from few places, of the contact of each loaded flank."""
    contact, values = gearbox_of("P1").contact().content, gearbox_of("P1").values["tooth_pair"]
    section = parse(LubricationSection, LUBRICATED["lubrication"])
    reduce_teeth = reduction_over([(section, speed) for speed in (5000.0, 6000.0, 7000.0)])
    teeth = reduce_teeth(contact["ltca"], contact["pressure"], parse(ToothPair, values))
    both = np.array([0, 0]), np.array([0, 1])
    bulk = np.array([[115.0, 108.0], [112.0, 110.0]])
    few, every = (
        teeth.pairs(section, every_place).of_meshes(*both).losses(6000 * pi / 30, bulk)
        for every_place in (False, True)
    )
    np.testing.assert_allclose(few.loss_fraction, every.loss_fraction, rtol=1e-6)
    assert not np.allclose(few.loss_fraction[0], few.loss_fraction[1], rtol=0.01)
