"""Root stress: superposition over teeth and loads, and the spur pinion against ISO 6336-3."""

import base64
from dataclasses import replace
from math import cos, sqrt
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
import scipy.sparse as sp
from contact_bodies import pair_design
from hypothesis import given
from hypothesis import strategies as st
from spur_gears import fzg_c, root_tension, slab_design

import facegear
from facegear.config.machines import case_machine
from facegear.geometry.flank_errors import FLANKS
from facegear.harmonics.series import Harmonics
from facegear.io.meshes import write_vtu
from facegear.strength.columns import BODIES
from facegear.strength.contact_pressure import ContactPressure
from facegear.strength.dynamic_stress import dynamic_stress_table
from facegear.strength.fillet_surface import stress_surface
from facegear.strength.flank_contacts import FlankContact
from facegear.strength.root_form import root_form
from facegear.strength.root_stress import down_the_fillet, root_stress
from facegear.strength.root_tables import root_arrays, root_tables
from facegear.strength.spur import SpurGear
from facegear.strength.stress_over_speed import FORCE_COLUMNS, branch_forces, stress_table, swept_forces
from facegear.strength.tension_history import TensionHistory
from facegear.transmission.flanks import flank_places, stiffness_series

TORQUES, POSITIONS = np.array([100.0, 300.0]), np.array([0.0, 0.5])
GRID = (2, 4, 3)
ALIKE = np.zeros((2, 2), int)
"""Flanks of both gears without assembly errors."""
ERROR = np.array([0.02, 0.01, 0.03])
PRESSURE = ContactPressure(TORQUES, np.sqrt(TORQUES), *np.zeros((4, 2)))
EDGES_ALONE = replace(PRESSURE, pressure=np.full(2, np.nan))


def passing(loads):
    """Root stress by readings on five teeth of gauges GRID from seven flank nodes."""
    readings = np.random.default_rng(1).normal(size=(5, int(np.prod(GRID)), 7))
    angle = np.broadcast_to(np.linspace(0.4, 1.2, 4)[:, None], GRID)
    found = root_stress(readings, loads, TORQUES, POSITIONS, np.linspace(0.25, 0.27, 3), angle, ERROR)
    return readings, found


def test_a_tooth_feels_its_own_load_and_those_of_the_teeth_beside_it():
    forces = {tooth: sp.csr_matrix(np.arange(28.0).reshape(4, 7) + tooth) for tooth in (-1, 0, 1)}
    readings, found = passing(forces)
    case = 1 * 2 + 1  # 300 N m at half a pitch
    for seen in (-2, 0, 2):
        expected = sum(
            -readings[seen - tooth + 2] @ force.toarray()[case]
            for tooth, force in forces.items()
            if abs(seen - tooth) <= 2
        )
        place = np.flatnonzero(np.isclose(found.passage, seen + 0.5))
        np.testing.assert_allclose(found.stress[1, place[0]].ravel(), expected, rtol=1e-12)


@given(factor=st.floats(0.1, 10.0))
def test_root_stress_is_linear_in_the_load_at_a_fixed_contact(factor):
    one = {0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))}
    many = {0: factor * one[0]}
    np.testing.assert_allclose(passing(many)[1].stress, factor * passing(one)[1].stress, rtol=1e-10)


def test_between_the_torques_solved_stress_is_a_power_of_the_torque_and_beyond_them_proportional():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    growth = found.stress[1].max() / found.stress[0].max()
    power = np.clip(np.log(growth) / np.log(3.0), 1 / 3, 1.0)
    np.testing.assert_allclose(found.at_torque(50.0), 0.5 ** max(power - 0.1, 1 / 3) * found.stress[0])
    np.testing.assert_allclose(found.at_torque(600.0), 2.0 * found.stress[1])
    middle = 3.0 ** (power / 2) * found.stress[0] + 3.0 ** (-power / 2) * found.stress[1]
    np.testing.assert_allclose(found.at_torque(100.0 * np.sqrt(3.0)), 0.5 * middle)


def test_tables_name_the_largest_stress_and_where_it_is():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    summary = root_tables({"pinion": found})["summary"].set_index(["torque_n_m", "fillet"])
    row = summary.loc[(300.0, "other")]
    assert row["largest_mpa"] >= 1e-6 * found.stress[1, :, 1].max()
    assert row["radius_mm"] in 1e3 * found.along
    assert summary["at_30_deg_mpa"].le(summary["largest_mpa"]).all()
    relative = summary["largest_error_mpa"] / summary["largest_mpa"]
    assert relative.tolist() == pytest.approx(ERROR[np.searchsorted(1e3 * found.along, summary["radius_mm"])])


def published(index):
    """An FZG C gear, the roll angle of its outer point of single contact, and sigma_F0 there per N/m."""
    mesh = fzg_c()
    gear = (mesh.pinion, mesh.wheel)[index]
    force = 5912.1 / 14e-3  # of the publication, N/m
    return (
        gear,
        sqrt((mesh.single_contact_radius(gear) / gear.base_radius) ** 2 - 1),
        (271.2e6, 263.2e6)[index] / force,
    )


def paper_pinion(rack_tip_radius):
    """The paper's pinion loaded high on the flank, and the standard's stress there per N/m."""
    nominal = pair_design()
    gear = SpurGear(
        teeth=23,
        module=nominal.module,
        pressure_angle=nominal.pressure_angle,
        profile_shift=0.0,
        tip_radius=nominal.pinion_tip_radius,
        width=0.03,
        rack_addendum=1.25,
        rack_tip_radius=rack_tip_radius,
    )
    roll = 0.85 * nominal.pinion_tip_roll
    form = root_form(gear, gear.base_radius * sqrt(1 + roll**2))
    return gear, roll, cos(gear.pressure_angle) / gear.module * form.form_factor * form.stress_correction


@pytest.mark.parametrize(
    "tooth",
    [lambda: paper_pinion(0.1), lambda: paper_pinion(0.25), lambda: published(0), lambda: published(1)],
    ids=["rack tip of 0.1 modules", "of 0.25 modules", "FZG C pinion", "FZG C wheel"],
)
def test_spur_teeth_in_plane_strain_agree_with_the_standard(tooth):
    """Finite elements over sigma_F0 of ISO 6336-3, of the FZG gears as it is published, thick rim."""
    gear, roll, standard = tooth()
    ratio = root_tension(slab_design(gear), roll) / standard
    assert 0.90 < ratio < 1.05


def vtu_arrays(path):
    """Arrays of a .vtu by name, read as VTK's description of the format has it: base64, its length first."""
    kinds = {
        "Float64": np.float64,
        "Int64": np.int64,
        "UInt32": np.uint32,
        "UInt8": np.uint8,
        "Int32": np.int32,
    }
    found = {}
    for array in ElementTree.parse(path).getroot().iter("DataArray"):
        content = base64.b64decode(array.text.strip())
        assert np.frombuffer(content[:4], np.uint32)[0] == len(content) - 4
        found[array.get("Name")] = np.frombuffer(content[4:], kinds[array.get("type")])
    return found


def test_the_file_for_paraview_holds_points_quadrilaterals_and_stress(tmp_path):
    _, root = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    position = np.random.default_rng(2).normal(size=(*GRID, 3))
    both = {"pinion": root, "face_gear": root}
    points, cells, told = stress_surface(root_arrays([both], ALIKE, dict.fromkeys(both, position)))
    write_vtu(tmp_path / "stress.vtu", points, cells, told)
    stored = vtu_arrays(tmp_path / "stress.vtu")
    np.testing.assert_array_equal(stored["Points"].reshape(-1, 3), points)
    np.testing.assert_array_equal(stored["connectivity"].reshape(-1, 4), cells["quad"])
    np.testing.assert_array_equal(stored["offsets"], 4 * np.arange(1, len(cells["quad"]) + 1))
    assert (stored["types"] == 9).all()  # VTK_QUAD
    for name, values in told.items():
        np.testing.assert_array_equal(stored[name], values)


def test_surface_for_paraview_shows_the_largest_and_smallest_stress_of_every_gauge():
    _, root = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    position = np.random.default_rng(2).normal(size=(*GRID, 3))
    both = {"pinion": root, "face_gear": root}
    arrays = root_arrays([both], ALIKE, {"pinion": position, "face_gear": 2 * position})
    points, cells, told = stress_surface(arrays)
    assert len(points) == 2 * np.prod(GRID)
    assert len(cells["quad"]) == 2 * 2 * (GRID[1] - 1) * (GRID[2] - 1)
    np.testing.assert_array_equal(told["body"], np.repeat([0.0, 1.0], np.prod(GRID)))
    for name, found in (("largest", root.stress.max(axis=1)), ("smallest", root.stress.min(axis=1))):
        on_gear = told[f"{name}_pa_at_300_n_m"][told["body"] == 1].reshape(GRID)
        np.testing.assert_array_equal(on_gear, found[1])
    corners = points[cells["quad"][0]]
    np.testing.assert_array_equal(corners, position[0][[0, 1, 1, 0], [0, 0, 1, 1]])


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
    table = dynamic_stress_table(forces, places, 0.1, contacts).set_index("mesh")
    assert table["dynamic_factor"].iloc[:2].tolist() == pytest.approx([1.5, 1.0])
    assert np.isnan(table.loc["open", "dynamic_factor"])
    assert table.loc["pulsing", "pinion_mean_mpa"] == pytest.approx(table.loc["back", "pinion_bound_mpa"])
    solved = root_tables({"pinion": found})["summary"]
    largest = solved[solved["torque_n_m"] == 300.0]["largest_mpa"].max()
    assert table.loc["pulsing", "face_gear_bound_mpa"] == pytest.approx(largest)
    assert table["within_torques_solved"].all()
    assert table.loc["pulsing", "pressure_bound_mpa"] == pytest.approx(1e-6 * np.sqrt(300.0))
    assert table.loc["pulsing", "pressure_mean_mpa"] == pytest.approx(1e-6 * np.sqrt(200.0))
    beyond = dynamic_stress_table({"high": np.array([4000.0, 0.0])}, places, 0.1, contacts)
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
    table = dynamic_stress_table(forces, places, 0.1, contacts).set_index("mesh")
    for column in ("pinion_mean_mpa", "pinion_running_mpa", "face_gear_bound_mpa"):
        assert table.loc["a/lower", column] == pytest.approx(2.0 * table.loc["a/upper", column])
    assert table.loc["a/lower", "pressure_bound_mpa"] == pytest.approx(2e-6 * np.sqrt(300.0))
    both = table.loc["b/lower", "face_gear_bound_mpa"]
    alone = [contact.history["face_gear"].over_passage(at) for contact, at in ((drive, 300.0), (back, 100.0))]
    assert both == pytest.approx(1e-6 * max(alone))
    swept = pd.DataFrame([("sweep up", "period-1", 1000.0, "a/lower", 3000.0)], columns=list(FORCE_COLUMNS))
    over = stress_table(swept, 1.0, 0.1, {"a/lower": [drive, back]})
    assert over["pinion_mpa"].iloc[0] == pytest.approx(1e-6 * back.tension["pinion"](300.0))


@pytest.mark.parametrize("edges_alone", FLANKS)
def test_pressure_in_motion_is_known_where_edges_carry_all_on_one_of_two_loaded_flanks(edges_alone):
    """It was empty or not by the order of the flanks."""
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    roots = dict.fromkeys(BODIES, found)
    contacts = {
        flank: FlankContact(roots, EDGES_ALONE if flank == edges_alone else PRESSURE) for flank in FLANKS
    }
    forces, places = {"a/upper": np.array([3000.0, -3000.0])}, {"a/upper": np.array([0.0, 0.5])}
    table = dynamic_stress_table(forces, places, 0.1, {"a/upper": contacts})
    assert table["pressure_bound_mpa"].iloc[0] == pytest.approx(1e-6 * np.sqrt(300.0))
    swept = pd.DataFrame([("sweep up", "period-1", 1000.0, "a/upper", 3000.0)], columns=list(FORCE_COLUMNS))
    over = stress_table(swept, 1.0, 0.1, {"a/upper": list(contacts.values())})
    assert over["pressure_mpa"].iloc[0] == pytest.approx(1e-6 * np.sqrt(300.0))


def test_stress_in_motion_stays_below_its_bound_where_another_gauge_leads_at_each_torque():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    rough = replace(found, stress=np.random.default_rng(0).normal(size=found.stress.shape))
    roots = {"pinion": rough, "face_gear": rough}
    forces = {str(force): np.full(16, force) for force in (500.0, 1500.0, 1700.0, 2500.0, 5000.0)}
    places = dict.fromkeys(forces, np.arange(16) / 16)
    contacts = dict.fromkeys(forces, dict.fromkeys(FLANKS, FlankContact(roots, PRESSURE)))
    table = dynamic_stress_table(forces, places, 0.1, contacts)
    assert (table["pinion_bound_mpa"] >= table["pinion_running_mpa"]).all()


def test_the_place_of_a_flank_is_where_its_stiffness_is_that_of_the_reference():
    machine = case_machine(
        facegear.example().values, Harmonics(np.array([0, 3e7, 1e7]), np.array([4e8, 2e7, -1e7]))
    )
    cycles = np.linspace(0.0, 2.0, 23)
    places = flank_places(machine.phases, cycles)
    for flank, series in enumerate(stiffness_series(machine)):
        np.testing.assert_allclose(series(cycles), machine.stiffness(places[:, flank]), rtol=1e-9)


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


@pytest.mark.parametrize("way", [1, -1])
def test_a_stable_stretch_counts_at_both_its_ends_and_once_where_its_pieces_meet(way):
    """A path that is followed to its limit comes there but for rounding."""
    speed = np.array([1000.0, 1400.0, 1999.9999999999998])[::way]
    one = {"branch": 0, "period": 1, "stable": True, "mesh": "a/upper"}
    path = pd.DataFrame({**one, "point": range(3), "speed_rpm": speed, "peak_force_n": 2.0 * speed})
    found = branch_forces(path, np.array([1000.0, 1200.0, 1400.0, 1700.0, 2000.0]))
    assert sorted(found["speed_rpm"]) == [1000.0, 1200.0, 1400.0, 1700.0, 2000.0]
    np.testing.assert_allclose(found["largest_force_n"], 2.0 * found["speed_rpm"])
    torn = path.assign(stable=[True, True, False])
    assert sorted(branch_forces(torn, np.array([1000.0, 1400.0, 2000.0]))["speed_rpm"]) == (
        [1000.0, 1400.0] if way == 1 else [1400.0, 2000.0]
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
    contacts = {key: [FlankContact(roots, pressure)] for key in forces["mesh"]}
    table = stress_table(forces.reset_index(drop=True), 750.0, 0.1, contacts)
    at_1000 = table[table["speed_rpm"] == 1000.0].set_index("motion")
    assert at_1000.loc["sweep up", "mesh"] == "b/upper"
    assert at_1000.loc["branch 3", "largest_force_n"] == pytest.approx(1500.0)
    assert at_1000.loc["branch 3", "class"] == "period-2"
    assert at_1000["worst"].to_dict() == {"branch 3": True, "sweep up": False}
    at_2000 = table[table["speed_rpm"] == 2000.0]
    assert at_2000["motion"].tolist() == ["sweep up"]  # the branch is not stable there
    assert at_2000["dynamic_factor"].iloc[0] == pytest.approx(2000.0 / 750.0)
    expected = down_the_fillet(found.at_torque(200.0)).max()
    assert at_2000["pinion_mpa"].iloc[0] == pytest.approx(1e-6 * expected)
    assert at_2000["pressure_mpa"].iloc[0] == pytest.approx(500.0 * 2.0 ** (np.log(1.8) / np.log(3.0)))
    assert pressure.at(1200.0) == pytest.approx(2.0 * 9e8)
    nowhere = {key: [FlankContact(roots, EDGES_ALONE)] for key in forces["mesh"]}
    idle = stress_table(forces.reset_index(drop=True), 0.0, 0.1, nowhere)
    assert idle["pressure_mpa"].isna().all() and idle["dynamic_factor"].isna().all()
