"""Every stage on a machine with rolling bearings on a casing, at small settings."""

from pathlib import Path

import numpy as np
import pytest

import facegear
from facegear.build.machine import MachineInputs
from facegear.sharing.groups import GroupKind
from facegear.sharing.mapped_machine import groups_of_kind
from facegear.sharing.sharing_map import floating_machine

EXAMPLE = Path(__file__).parents[3] / "config" / "casing.yaml"
BALL = {"card": "deep_groove_6210", "clearance_diametral_um": 15}
ROLLER = {"card": "cylindrical_roller_nu210", "clearance_diametral_um": 30}
SHAFT = {
    "segments": [{"length_mm": 130, "diameter_mm": 50}],
    "pinion_mm": 60,
    "bearings": [{"at_mm": 10, "rolling": BALL}, {"at_mm": 120, "rolling": ROLLER}],
}
PLAY = "transmission.shafts.input.bearings.0.rolling.clearance_diametral_um"
BORE = "transmission.shafts.input.bearings.0.position_um.x"
CAUSES = [
    {"name": "play", "spread": 4, "limits": [-8, 8], "moves": {PLAY: 1}, "source": "maker"},
    {"name": "bore", "spread": 4, "limits": [-10, 10], "moves": {BORE: 1}, "source": "drawing"},
]
SETTINGS = {
    "transmission.pinion.runout": {"eccentricity_um": 8},
    "transmission.shafts": {"input": SHAFT},
    "transmission.torque.per_input_n_m": 500,
    "transmission.casing.modes": 4,
    "dynamics.sweep": {"from_rpm": 2900, "to_rpm": 3100, "points": 2, "directions": ["up"]},
    "load_sharing": {"cycles": 20, "starts": 1},
    "sharing_map": {"samples": 100, "points": 2, "input_bearing_factors": [1.0]},
    "tolerances": {
        "samples": 2,
        "index_blocks": 0,
        "chunk_samples": 2,
        "hunting_cycles": 2,
        "causes": CAUSES,
    },
    "search": {
        "variables": [{"name": "play", "limits": [0, 40], "sets": [PLAY]}],
        "objectives": [
            {"name": "k", "largest_of": ["k_gamma p0"]},
            {"name": "c", "largest_of": ["coefficient idlers"]},
        ],
        "hunting_cycles": 2,
        "population": 4,
        "generations": 1,
        "seeds": [1],
        "winner_samples": 2,
    },
    "branches": {
        "from_rpm": 2990,
        "to_rpm": 3010,
        "longest_start_period": 1,
        "max_branches": 1,
        "explore": {"starts": 1},
        "loci": {"parameters": ["backlash"], "from_factor": 0.99, "to_factor": 1.01, "nearest": 1},
    },
}


@pytest.fixture(scope="module")
def gearbox():
    return facegear.load(EXAMPLE).with_values(SETTINGS)


@pytest.fixture(scope="module")
def machine(gearbox):
    harmonics = gearbox.stiffness().content["harmonics"]
    return MachineInputs.of_config(gearbox.values, harmonics).build()


def forces(table, column="force_n"):
    return table.set_index("mesh")[column].abs()


ANSWERS = (
    *("modes", "shaft_orders", "casing_response", "load_sharing", "sensitivity", "tolerances", "sweep"),
    *("branches", "branch_loci", "search", "sharing_map"),
)


@pytest.mark.parametrize("name", ANSWERS)
def test_a_stage_answers(gearbox, name):
    answer = getattr(gearbox, name)()
    assert answer.summary and answer.source == "computed"


def test_samples_of_clearance_and_bore_are_all_solved(gearbox):
    samples = gearbox.tolerances().content["samples"]
    assert samples["error"].eq("").all() and samples["k_gamma p0/upper"].nunique() == len(samples)


def test_motion_has_the_mean_forces_of_statics(gearbox):
    at_rest = forces(gearbox.statics().content["meshes"])
    running = gearbox.response().content["response"].groupby("mesh")["elastic_force_n"].mean().abs()
    assert np.allclose(running.loc[at_rest.index], at_rest, rtol=2e-3)


def test_statics_and_the_casings_own_table_have_the_same_forces(gearbox):
    at_rest, beside = gearbox.statics().content["meshes"], gearbox.casing_loads().content["sharing"]
    assert np.allclose(forces(at_rest), forces(beside).loc[forces(at_rest).index], rtol=1e-9)


def test_bearings_carry_in_their_life_what_the_shaft_lays_on_them(gearbox):
    shaft = gearbox.shafts().content["bearings"].set_index("bearing")["radial_n"]
    loads = gearbox.bearing_life().content["loads"].set_index("bearing")["radial_n"]
    assert np.allclose(shaft.loc[["A", "B"]], loads.loc[["A", "B"]], rtol=1e-9)


def test_the_running_machine_shares_as_its_hunting_cycle_at_rest(gearbox):
    at_rest = gearbox.hunting().content["groups"].set_index("group")["k_gamma"]
    running = gearbox.following().content["groups"].set_index("group")
    assert np.allclose(running["k_gamma_static"], at_rest.loc[running.index], rtol=1e-9)
    assert np.allclose(running["k_gamma"], at_rest.loc[running.index], rtol=1e-2)


def test_a_floating_gear_with_a_late_idler_comes_to_rest(machine):
    """The search stalled at 4e-10 of the largest force, and the map of load sharing ended with it."""
    (group,) = groups_of_kind(machine, GroupKind.IDLERS)
    mapped = floating_machine(machine, group, "upper")
    late = np.array([[0.0, -8.000633077401508e-05, 9.506373750375751e-06]])
    assert mapped.equilibria(late).residual.max() < 1e-12


CASING = {
    "stiffness": str(EXAMPLE.parent / "casing" / "box.npz"),
    "units": "mm_t_s",
    "modes": 4,
    "damping_ratio": 0.02,
    "seats": {"tail idler": 101, "right input": 102, "left input": 103, "lower gear": 104, "upper gear": 105},
    "feet": [{"name": "base", "node": 301, "held": True}],
}
OILED = {"ra_um": 0.3}
TOOTHED = {
    "transmission.casing": CASING,
    "transmission.shafts": {"input": SHAFT},
    "transmission.mesh_kinematics": "geometric",
    "transmission.face_gear.mesh_radius_mm": None,
    "transmission.damping.open_flanks": "contact_only",
    "transmission.torque.per_input_n_m": 700,
    "dynamics.speed_rpm": 6000,
    "dynamics.sweep": {"from_rpm": 5900, "to_rpm": 6100, "points": 2, "chunks": 1, "directions": ["up"]},
    "strength.load_factors": "machine",
    "strength.duty": [{"torque_n_m": 320, "speed_rpm": 6000, "hours": 100}],
    "lubrication": {
        "oil": "polyol_ester_5_cst",
        "supply_temperature_c": 100,
        "pinion": OILED,
        "face_gear": OILED,
        "bulk": {"source": "cooling", "pinion_w_per_k": 60, "face_gear_w_per_k": 200},
    },
}
"""The example with its teeth, on the casing: the seats of three pinions and of both gears."""


@pytest.fixture(scope="module")
def toothed():
    return facegear.example().with_values(TOOTHED)


@pytest.fixture(scope="module")
def posed(toothed):
    return toothed.with_values({"transmission.operating_pose": "static", "lubrication": None})


@pytest.mark.parametrize(
    "name", ["rating", "dynamic_stress", "stress_over_speed", "losses", "bearing_life", "modes"]
)
def test_a_stage_on_teeth_answers(toothed, name):
    assert getattr(toothed, name)().summary


@pytest.mark.parametrize("name", ["operating_pose", "rating", "modes", "response"])
def test_a_stage_on_teeth_where_forces_put_them_answers(posed, name):
    assert getattr(posed, name)().summary


def test_feet_balance_the_torques_of_teeth(toothed):
    """Where forces put the teeth, moments of contacts that move along the face are left out of pinions."""
    feet = toothed.casing_loads().content["feet"].set_index("foot")
    assert np.abs(feet.loc["out of balance"].to_numpy(float)).max() < 1e-5
    assert np.abs(feet.loc["applied"].to_numpy(float)).max() > 100.0
