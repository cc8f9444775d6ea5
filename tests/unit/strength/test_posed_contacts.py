"""Stress of meshes whose teeth stand where the machine's own forces put them."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from references import against, agrees

from facegear.machine.poses.surface import PoseSurface
from facegear.quantities import BODIES
from facegear.strength.contact_pressure import ContactPressure
from facegear.strength.flank_contacts import FlankContact
from facegear.strength.materials import FlankDuty
from facegear.strength.posed_contacts import (
    PRESSURE,
    ROOTS,
    STRESSES,
    ContactPose,
    PosedContacts,
    duty_contact_poses,
    posed_contacts,
    root_arrays_of,
    scale_contact,
    stress_ratio,
)
from facegear.strength.root_stress import RootStress
from facegear.teeth.conjugate import contact_at
from validation.poses.measure import ASSEMBLIES, LOADED_CONTACT, SURFACE, TORQUE

TORQUES = np.array([300.0, 600.0, 1000.0])
REST = ContactPose(0.268125, 0.0)
ASIDE = ContactPose(0.2725, 0.0)
GEARS = ("upper", "lower")


@pytest.fixture(scope="module")
def surface():
    with np.load(SURFACE) as stored:
        return PoseSurface.of_arrays(dict(stored))


def contact(size=1.0):
    """Stress and pressure in proportion to a power of the torque."""
    grid = (2, 4, 3)
    stress = np.zeros((3, 4, *grid))
    stress[:, 1, 0] = size * 1e6 * TORQUES[:, None, None]
    stress[:, 2, 1] = -0.3 * stress[:, 1, 0]
    root = RootStress(TORQUES, np.arange(4) / 2, stress, np.zeros(3), np.zeros(grid), np.zeros(3))
    pressed = 1e9 * size * np.sqrt(TORQUES / 600.0)
    zeros = np.zeros(3)
    return FlankContact(
        dict.fromkeys(BODIES, root), ContactPressure(TORQUES, pressed, 0.01 * pressed, zeros, zeros, zeros)
    )


def duty(torques, bins, meshes=(), flank="drive", gear="face_gear"):
    size = len(torques)
    return FlankDuty(
        gear, gear, flank, np.array(bins), np.array(torques), 1e6 * np.ones(size), np.zeros(9), tuple(meshes)
    )


@against(
    "second implementation",
    "contact of a pair solved in two assemblies",
    capability="posed_stress",
    module="facegear.strength.posed_contacts",
)
def test_what_a_pose_changes_of_stress_is_what_contact_solved_in_both_assemblies_says(surface):
    """Between the surface's nodes; contact at default accuracy, stored by `validation.poses.measure`."""
    rows = pd.read_csv(LOADED_CONTACT).set_index("assembly")
    ends = [
        ContactPose(contact_at(surface.pair, ASSEMBLIES[name]).y, 0.0)
        for name in ("nominal", "offset -120 um")
    ]
    for name in STRESSES:
        known = rows.loc["offset -120 um", name] / rows.loc["nominal", name]
        factor = stress_ratio(surface, name, *ends)(np.array([TORQUE]))
        agrees(f"{name} over that as assembled", factor, known, relative=5e-3)


@settings(max_examples=20, deadline=None)
@given(st.floats(0.261, 0.277), st.floats(0.261, 0.277), st.floats(0.261, 0.277), st.floats(70.0, 1190.0))
def test_changes_of_stress_follow_one_another(surface, first, second, third, torque):
    stands = [ContactPose(path, 0.0) for path in (first, second, third)]
    at = np.array([torque])
    for name in STRESSES:
        steps = stress_ratio(surface, name, *stands[:2])(at) * stress_ratio(surface, name, *stands[1:])(at)
        assert steps == pytest.approx(stress_ratio(surface, name, stands[0], stands[2])(at), rel=1e-9)
        there, here = (surface.at(name, torque, stand.path, 0.0) for stand in (stands[2], stands[0]))
        assert steps == pytest.approx(there / here, rel=1e-9)


def table_of(solved):
    """Table by torque of stage posed_stress for one contact."""
    return pd.DataFrame(
        {
            "contact": 0,
            "torque_n_m": TORQUES,
            "pressure_mpa": 1e-6 * solved.pressure.pressure,
            "pressure_error_mpa": 1e-6 * solved.pressure.error,
            **dict.fromkeys(("tip_line_load_n_per_mm", "tip_length_mm", "fillet_share"), 0.0),
        }
    )


def solved_arrays(solved):
    """Arrays of stage posed_stress for one mesh that carries on its back flank."""
    return {
        **root_arrays_of(0, solved.roots),
        "mesh": np.array(["one/upper"]),
        "contact": np.array([0]),
        "carrying": np.array([1]),
        "mesh_torque_n_m": np.array([500.0]),
        "path_m": np.array([[ASIDE.path, 0.264]]),
        "angle_rad": np.zeros(1),
        "path_at_rest_m": np.array([REST.path]),
        "angle_at_rest_rad": np.zeros(1),
    }


def posed(surface):
    contacts = {
        "tail/upper": {"drive": contact(1.0), "back": contact(0.9)},
        "left/upper": {"drive": contact(1.2), "back": contact(0.8)},
    }
    stands = {(mesh, flank): REST for mesh in contacts for flank in ("drive", "back")}
    torque = {"tail/upper": 250.0, "left/upper": 600.0}
    return PosedContacts(contacts, stands, dict.fromkeys(contacts, "drive"), torque, surface)


@settings(max_examples=10, deadline=None)
@given(st.floats(150.0, 1190.0), st.sampled_from(["tail/upper", "left/upper"]), st.sampled_from(BODIES))
def test_a_load_has_the_stress_of_its_own_mesh_where_its_bin_puts_it(surface, torque, mesh, gear):
    """A bin with the machine's own load changes nothing; another one what the surface says."""
    machine = posed(surface)
    stands = {(number, name, flank): REST for number in (0, 1) for name, flank in machine.contact_poses}
    stands[1, mesh, "drive"] = ASIDE
    loads = machine.stresses(duty([torque, torque], [0, 1], [mesh, mesh], gear=gear), stands)
    own = machine.contacts[mesh]["drive"]
    at = np.array([torque])
    for found, stress, name in (
        (loads.tension, own.tension[gear](torque), ROOTS[gear]),
        (loads.pressure, own.pressure.at(torque), PRESSURE),
    ):
        assert found[0] == stress
        assert found[1] == pytest.approx(stress * stress_ratio(surface, name, REST, ASIDE)(at)[0], rel=1e-12)


def test_a_lower_gear_alone_is_judged_by_the_surface_of_its_own_flanks(surface):
    """Its errors of assembly are not those of an upper one; the statics of its pose use it, too."""
    lower = replace(surface, values={name: values**2 for name, values in surface.values.items()})
    both = replace(surface, further=(lower,), flank_numbers=((0, 0), (1, 1)))
    arrays = {**solved_arrays(contact(1.0)), "mesh": np.array(["one/lower"])}
    assembled = {("upper", flank): contact(1.0) for flank in ("drive", "back")}
    machine = posed_contacts(arrays, table_of(contact(1.0)), both, assembled, ("upper",))
    ratio = stress_ratio(lower, ROOTS["pinion"], REST, ASIDE)(np.array([600.0]))[0]
    other_flank = machine.contacts["one/lower"]["drive"]
    assert other_flank.tension["pinion"](600.0) == pytest.approx(600e6 * ratio, rel=1e-6)
    stands = {(0, "one/lower", "drive"): ContactPose(0.27, 0.0)}
    loads = machine.stresses(duty([600.0], [0], ["one/lower"], gear="pinion"), stands)
    ratio *= stress_ratio(lower, ROOTS["pinion"], ASIDE, *stands.values())(np.array([600.0]))[0]
    assert loads.tension[0] == pytest.approx(600e6 * ratio, rel=1e-6)


def test_a_duty_cycle_that_names_no_mesh_is_judged_by_the_one_that_carries_most(surface):
    machine = posed(surface)
    stands = {(0, *key): REST for key in machine.contact_poses}
    assert machine.met_by(duty([600.0], [0])) == [("left/upper", "drive")]
    loads = machine.stresses(duty([600.0], [0]), stands)
    assert loads.tension[0] == pytest.approx(1.2 * 600e6, rel=1e-6)
    other = replace(machine, loaded_flanks={"tail/upper": "drive", "left/upper": "back"})
    assert other.met_by(duty([600.0], [0])) == [("tail/upper", "drive")]
    each = duty([600.0], [0], flank="each")
    assert other.met_by(each) == [("left/upper", "drive"), ("left/upper", "back")]
    assert machine.met_by(duty([600.0], [0], flank="back")) == [("left/upper", "back")]


def test_the_flank_that_carries_has_contact_solved_there_and_the_other_that_of_the_assembly_changed(surface):
    solved = contact(2.0)
    arrays, table = solved_arrays(solved), table_of(solved)
    assembled = {(gear, flank): contact(1.0) for gear in GEARS for flank in ("drive", "back")}
    found = posed_contacts(arrays, table, surface, assembled, GEARS)
    assert found.loaded_flanks == {"one/upper": "back"}
    own, other = (found.contacts["one/upper"][flank] for flank in ("back", "drive"))
    np.testing.assert_array_equal(own.roots["pinion"].stress, solved.roots["pinion"].stress)
    np.testing.assert_allclose(own.pressure.pressure, solved.pressure.pressure, rtol=1e-12)
    factors = {name: stress_ratio(surface, name, REST, ASIDE) for name in STRESSES}
    expected = scale_contact(contact(1.0), factors)
    np.testing.assert_array_equal(other.roots["face_gear"].stress, expected.roots["face_gear"].stress)
    at = np.array([600.0])
    assert other.tension["face_gear"](600.0) == pytest.approx(
        600e6 * factors[ROOTS["face_gear"]](at)[0], rel=1e-3
    )
    assert factors[ROOTS["face_gear"]](at)[0] > 1.1


def test_stands_of_bins_are_read_as_they_were_written():
    table = pd.DataFrame(
        [(1, "one/upper", "drive", 270.0, 0.02), (2, "one/upper", "back", 265.0, 0.0)],
        columns=["bin", "mesh", "flank", "unloaded_path_mm", "shaft_angle_error_deg"],
    )
    assert duty_contact_poses(table) == {
        (0, "one/upper", "drive"): ContactPose(0.27, float(np.radians(0.02))),
        (1, "one/upper", "back"): ContactPose(0.265, 0.0),
    }
