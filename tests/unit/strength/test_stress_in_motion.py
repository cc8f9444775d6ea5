"""Root stress and pressure of the running machine: in its history and over speed."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import scipy.sparse as sp
from references import against, agrees
from root_readings import POSITIONS, TORQUES, passing

import facegear
from facegear.build.config import resolved_values
from facegear.build.load import config_of
from facegear.build.lumped_model import stiffness_lags
from facegear.build.machine import MachineInputs
from facegear.build.machine_layout import lumped_sections
from facegear.harmonics import Harmonics
from facegear.machine.flanks import flank_law, flank_places
from facegear.quantities import BODIES
from facegear.strength.contact_pressure import ContactPressure
from facegear.strength.dynamic_stress import (
    FORCE_COLUMNS,
    branch_forces,
    dynamic_stress_table,
    stress_table,
    swept_forces,
)
from facegear.strength.flank_contacts import FlankContact, TensionHistory
from facegear.strength.root_stress import down_the_fillet
from facegear.strength.root_tables import root_tables
from facegear.teeth.placement import FLANKS

PRESSURE = ContactPressure(TORQUES, np.sqrt(TORQUES), *np.zeros((4, 2)))
ARMS = dict.fromkeys(FLANKS, 0.1)
"""Torque over force of both flanks, m."""
EDGES_ALONE = replace(PRESSURE, pressure=np.full(2, np.nan))


@against(
    "manufactured",
    "mesh forces of two instants",
    capability="dynamic_root_stress",
    module="facegear.strength.dynamic_stress",
)
def test_running_machine_is_judged_by_the_magnitude_of_each_mesh_force():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    forces = {
        "pulsing": np.array([1000.0, 3000.0]),
        "back": np.array([-2000.0, -2000.0]),
        "open": np.zeros(2),
    }
    places = dict.fromkeys([*forces, "high"], np.array([0.0, 0.5]))
    roots = {"pinion": found, "face_gear": found}
    contacts = dict.fromkeys(places, dict.fromkeys(FLANKS, FlankContact(roots, PRESSURE)))
    table = dynamic_stress_table(forces, places, ARMS, contacts).set_index("mesh")
    agrees("dynamic factor", table["dynamic_factor"].iloc[:2].tolist(), [1.5, 1.0], relative=1e-6)
    assert np.isnan(table.loc["open", "dynamic_factor"])
    assert table.loc["pulsing", "pinion_mean_mpa"] == pytest.approx(table.loc["back", "pinion_bound_mpa"])
    solved = root_tables({"pinion": found})["summary"]
    largest = solved[solved["torque_n_m"] == 300.0]["largest_mpa"].max()
    agrees(
        "bound of the root stress, MPa", table.loc["pulsing", "face_gear_bound_mpa"], largest, relative=1e-6
    )
    assert table["within_torques_solved"].all()
    agrees(
        "bound of the pressure, MPa",
        table.loc["pulsing", "pressure_bound_mpa"],
        1e-6 * np.sqrt(300.0),
        relative=1e-6,
    )
    agrees(
        "pressure at the mean force, MPa",
        table.loc["pulsing", "pressure_mean_mpa"],
        1e-6 * np.sqrt(200.0),
        relative=1e-6,
    )
    beyond = dynamic_stress_table({"high": np.array([4000.0, 0.0])}, places, ARMS, contacts)
    assert not beyond["within_torques_solved"].any()


def test_stress_in_motion_is_that_of_the_force_and_the_place_of_the_moment():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    history = TensionHistory(found)
    for torque in (50.0, 100.0, 300.0, 700.0):
        for place in POSITIONS:
            here = found.at_torque(torque)[np.isclose(np.mod(found.passage, 1.0), place)]
            expected = down_the_fillet(here).max()
            assert history(np.array([torque]), np.array([place]))[0] == pytest.approx(expected)
    torques, places = np.full(8, 200.0), np.arange(8) / 8
    bound = max(down_the_fillet(found.at_torque(200.0)).max(), 0.0)
    assert history(torques, places).max() <= max(bound, history(torques[:2], POSITIONS).max()) * (1 + 1e-12)
    np.testing.assert_allclose(history(torques, places + 1e-12), history(torques, places), rtol=1e-9)


@against(
    "manufactured",
    "contacts of which one has twice the stress",
    capability="dynamic_root_stress",
    module="facegear.strength.dynamic_stress",
)
def test_each_flank_of_each_gear_in_motion_has_the_stress_of_its_own_contact():
    """Assembly errors part the flanks; every flank was read as the drive flank."""
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    drive, back = (
        FlankContact(dict.fromkeys(BODIES, replace(found, stress=factor * found.stress)), press)
        for factor, press in ((1.0, PRESSURE), (2.0, replace(PRESSURE, pressure=2.0 * PRESSURE.pressure)))
    )
    force = np.array([1000.0, 3000.0])
    forces = {"a/upper": force, "a/lower": -force, "b/lower": np.array([3000.0, -1000.0])}
    places = dict.fromkeys(forces, np.array([0.0, 0.5]))
    contacts = {key: {"drive": drive, "back": back} for key in forces}
    table = dynamic_stress_table(forces, places, ARMS, contacts).set_index("mesh")
    for column in ("pinion_mean_mpa", "pinion_running_mpa", "face_gear_bound_mpa"):
        agrees(
            "stress of the back flank, MPa",
            table.loc["a/lower", column],
            2.0 * table.loc["a/upper", column],
            relative=1e-6,
        )
    agrees(
        "pressure of the back flank, MPa",
        table.loc["a/lower", "pressure_bound_mpa"],
        2e-6 * np.sqrt(300.0),
        relative=1e-6,
    )
    both = table.loc["b/lower", "face_gear_bound_mpa"]
    alone = [contact.history["face_gear"].over_passage(at) for contact, at in ((drive, 300.0), (back, 100.0))]
    agrees("bound of a flank loaded from both sides, MPa", both, 1e-6 * max(alone), relative=1e-6)
    swept = pd.DataFrame([("sweep up", "period-1", 1000.0, "a/lower", 3000.0)], columns=list(FORCE_COLUMNS))
    over = stress_table(swept, 1.0, ARMS, {"a/lower": {"drive": drive, "back": back}})
    assert over["pinion_mpa"].iloc[0] == pytest.approx(1e-6 * back.tension["pinion"](300.0))


def test_each_flank_in_motion_has_the_torque_of_its_own_arm():
    """Forces of coast flanks became torques by the arm of drive flanks, whatever their pressure angle."""
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    contact = FlankContact(dict.fromkeys(BODIES, found), PRESSURE)
    contacts = {"a/upper": dict.fromkeys(FLANKS, contact)}
    places = {"a/upper": np.array([0.0, 0.5])}
    forces = {"a/upper": np.array([-2000.0, -1500.0])}
    found_with, expected = (
        dynamic_stress_table(forces, places, {"drive": drive, "back": 0.1}, contacts) for drive in (0.05, 0.1)
    )
    pd.testing.assert_frame_equal(found_with, expected, check_exact=True)
    swept = pd.DataFrame([("sweep up", "period-1", 1000.0, "a/upper", 3000.0)], columns=list(FORCE_COLUMNS))
    for arms in ({"drive": 0.05, "back": 0.1}, {"drive": 0.1, "back": 0.07}):
        over = stress_table(swept, 1.0, arms, contacts)
        assert over["pinion_mpa"].iloc[0] == pytest.approx(1e-6 * contact.tension["pinion"](300.0))


@pytest.mark.parametrize("edges_alone", FLANKS)
def test_pressure_in_motion_is_known_where_edges_carry_all_on_one_of_two_loaded_flanks(edges_alone):
    """It was empty or not by the order of the flanks."""
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    roots = dict.fromkeys(BODIES, found)
    contacts = {
        flank: FlankContact(roots, EDGES_ALONE if flank == edges_alone else PRESSURE) for flank in FLANKS
    }
    forces, places = {"a/upper": np.array([3000.0, -3000.0])}, {"a/upper": np.array([0.0, 0.5])}
    table = dynamic_stress_table(forces, places, ARMS, {"a/upper": contacts})
    assert table["pressure_bound_mpa"].iloc[0] == pytest.approx(1e-6 * np.sqrt(300.0))
    swept = pd.DataFrame([("sweep up", "period-1", 1000.0, "a/upper", 3000.0)], columns=list(FORCE_COLUMNS))
    over = stress_table(swept, 1.0, ARMS, {"a/upper": contacts})
    assert over["pressure_mpa"].iloc[0] == pytest.approx(1e-6 * np.sqrt(300.0))


def test_stress_in_motion_stays_below_its_bound_where_another_gauge_leads_at_each_torque():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    rough = replace(found, stress=np.random.default_rng(0).normal(size=found.stress.shape))
    roots = {"pinion": rough, "face_gear": rough}
    forces = {str(force): np.full(16, force) for force in (500.0, 1500.0, 1700.0, 2500.0, 5000.0)}
    places = dict.fromkeys(forces, np.arange(16) / 16)
    contacts = dict.fromkeys(forces, dict.fromkeys(FLANKS, FlankContact(roots, PRESSURE)))
    table = dynamic_stress_table(forces, places, ARMS, contacts)
    assert (table["pinion_bound_mpa"] >= table["pinion_running_mpa"]).all()


@against(
    "analytic",
    "phase of a mesh",
    capability="dynamic_root_stress",
    module="facegear.machine.flanks",
)
@pytest.mark.parametrize("config", ["facegear/example.yaml", "config/helical.yaml"])
def test_the_place_of_a_flank_is_where_its_stiffness_is_that_of_the_reference(config):
    """A helical pinion that stands outwards is as one that has turned, which stress did not know."""
    stiffness = Harmonics(np.array([0, 3e7, 1e7]), np.array([4e8, 2e7, -1e7]))
    values = facegear.load(config).config.model_dump(mode="json")
    for pinion in values["transmission"]["pinions"]:
        place = {"x": 0, "y": 0, "z": 700}
        values["transmission"]["single_pinions"].setdefault(pinion["name"], {})["position_um"] = place
    values = resolved_values(config_of(values))
    inputs = MachineInputs.of_config(values, stiffness)
    machine = replace(inputs, unloaded_error=Harmonics(np.zeros(1), np.zeros(1))).build()
    cycles = np.linspace(0.0, 2.0, 23)
    lags = stiffness_lags(*lumped_sections(values["transmission"], values["tooth_pair"]))
    places = flank_places(lags, cycles)
    found = flank_law(machine).stiffness(cycles)
    agrees("stiffness of a flank, N/m", found, machine.stiffness(places), relative=1e-9)


SWEPT = pd.DataFrame(
    [
        ("up", 1000.0, "largest_elastic_force_n", "a/upper", 100.0, "period-1"),
        ("up", 1000.0, "largest_elastic_force_n", "b/upper", 900.0, "period-1"),
        ("up", 2000.0, "largest_elastic_force_n", "a/upper", 2000.0, "chaotic"),
        ("up", 2000.0, "largest_elastic_force_n", "b/upper", 500.0, "chaotic"),
        ("up", 1000.0, "mean_elastic_force_n", "a/upper", 1e9, "period-1"),
    ],
    columns=["direction", "speed_rpm", "quantity", "body_or_mesh", "value", "class"],
)


@against(
    "manufactured",
    "a branch whose force is twice the speed",
    capability="stress_over_speed",
    module="facegear.strength.dynamic_stress",
)
@pytest.mark.parametrize("way", [1, -1])
def test_a_stable_stretch_counts_at_both_its_ends_and_once_where_its_pieces_meet(way):
    """A path that is followed to its limit comes there but for rounding."""
    speed = np.array([1000.0, 1400.0, 1999.9999999999998])[::way]
    one = {"branch": 0, "period": 1, "stable": True, "mesh": "a/upper"}
    path = pd.DataFrame({**one, "point": range(3), "speed_rpm": speed, "peak_force_n": 2.0 * speed})
    found = branch_forces(path, np.array([1000.0, 1200.0, 1400.0, 1700.0, 2000.0]))
    assert sorted(found["speed_rpm"]) == [1000.0, 1200.0, 1400.0, 1700.0, 2000.0]
    agrees("largest force, N", found["largest_force_n"], 2.0 * found["speed_rpm"], relative=1e-7)
    torn = path.assign(stable=[True, True, False])
    assert sorted(branch_forces(torn, np.array([1000.0, 1400.0, 2000.0]))["speed_rpm"]) == (
        [1000.0, 1400.0] if way == 1 else [1400.0, 2000.0]
    )


@against(
    "manufactured",
    "a sweep and a branch of known forces",
    capability="stress_over_speed",
    module="facegear.strength.dynamic_stress",
)
def test_stress_over_speed_takes_the_hardest_of_coexisting_motions():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    branches = pd.DataFrame(
        {
            "branch": 3,
            "point": [0, 0, 1, 1, 2, 2],
            "period": 2,
            "speed_rpm": [900.0, 900.0, 1100.0, 1100.0, 2100.0, 2100.0],
            "stable": [True, True, True, True, False, False],
            "mesh": ["a/upper", "b/upper"] * 3,
            "peak_force_n": [1000.0, 10.0, 2000.0, 10.0, 9000.0, 10.0],
        }
    )
    forces = pd.concat([swept_forces(SWEPT), branch_forces(branches, np.array([1000.0, 2000.0]))])
    pressure = replace(PRESSURE, pressure=np.array([5e8, 9e8]))
    roots = {"pinion": found, "face_gear": found}
    contacts = {key: {"drive": FlankContact(roots, pressure)} for key in forces["mesh"]}
    table = stress_table(forces.reset_index(drop=True), 750.0, ARMS, contacts)
    at_1000 = table[table["speed_rpm"] == 1000.0].set_index("motion")
    assert at_1000.loc["sweep up", "mesh"] == "b/upper"
    agrees(
        "force between two points of a branch, N",
        at_1000.loc["branch 3", "largest_force_n"],
        1500.0,
        relative=1e-6,
    )
    assert at_1000.loc["branch 3", "class"] == "period-2"
    assert at_1000["worst"].to_dict() == {"branch 3": True, "sweep up": False}
    at_2000 = table[table["speed_rpm"] == 2000.0]
    assert at_2000["motion"].tolist() == ["sweep up"]  # the branch is not stable there
    agrees("dynamic factor", at_2000["dynamic_factor"].iloc[0], 2000.0 / 750.0, relative=1e-6)
    expected = down_the_fillet(found.at_torque(200.0)).max()
    agrees("root stress, MPa", at_2000["pinion_mpa"].iloc[0], 1e-6 * expected, relative=1e-6)
    agrees(
        "pressure, MPa",
        at_2000["pressure_mpa"].iloc[0],
        500.0 * 2.0 ** (np.log(1.8) / np.log(3.0)),
        relative=1e-6,
    )
    assert pressure.at(1200.0) == pytest.approx(2.0 * 9e8)
    nowhere = {key: {"drive": FlankContact(roots, EDGES_ALONE)} for key in forces["mesh"]}
    idle = stress_table(forces.reset_index(drop=True), 0.0, ARMS, nowhere)
    assert idle["pressure_mpa"].isna().all() and idle["dynamic_factor"].isna().all()
