"""The pair's friction as a disturbance of the machine's motion, from the config to the loss of the meshes."""

import numpy as np
import pytest

import facegear
from facegear.errors import FacegearError

pytestmark = pytest.mark.xdist_group("notebooks")  # the example's contact is computed once a process

OIL = {
    "oil": "polyol_ester_5_cst",
    "supply_temperature_c": 100,
    "pinion": {"ra_um": 0.3},
    "face_gear": {"ra_um": 0.3},
    "bulk": {"source": "given", "temperature_c": 100},
    "friction": {"model": "constant", "coefficient": 0.05},
}
ONE = {
    "transmission.pinions": [{"name": "engine", "role": "input", "angle_deg": 0}],
    "transmission.face_gears": ["upper"],
    "transmission.torque": {"per_input_n_m": 550, "tail_share": 0},
    "transmission.transmission_error": "from_contact",
}


@pytest.fixture(scope="module")
def gearbox():
    return facegear.example().with_values({"lubrication": OIL, "mesh_stiffness.mesh_law": "constant_load"})


def base_radius(gearbox):
    pair = gearbox.values["tooth_pair"]
    return 0.5e-3 * pair["module_mm"] * 23 * np.cos(np.radians(pair["pressure_angle_deg"]))


def running(gearbox, effect, coefficient=0.05, speed=7500.0, **more):
    changes = {"lubrication.friction.effect": effect, "lubrication.friction.coefficient": coefficient}
    return gearbox.with_values({**changes, "dynamics.speed_rpm": speed, **more})


def test_sums_of_friction_over_the_flank_are_the_loss_and_turn_at_the_pitch_line(gearbox):
    found = gearbox.friction()
    table, base = found.content["excitation"], base_radius(gearbox)
    speeds = np.array([1.0, 23 / 143])
    lost = -(1e-3 * table[["pinion_lever_mm", "face_gear_lever_mm"]] @ speeds)
    mean = lost.groupby(table["torque_n_m"]).mean() / base
    by_torque = found.table().set_index("torque_n_m")
    np.testing.assert_allclose(mean, 0.05 * by_torque["loss_factor"], rtol=1e-9)
    lever = table.groupby("torque_n_m")["pinion_lever_mm"]
    assert (lever.min() < 0.0).all() and (lever.max() > 0.0).all()


@pytest.mark.parametrize("coefficient", [0.01, 0.05])
def test_slow_motion_loses_what_the_machine_at_rest_does(gearbox, coefficient):
    """The force of the mesh falls by the moment of friction on the pinion, which is of second order in the
    loss."""
    slow = running(gearbox, "excitation", coefficient, 160.0, **ONE)
    meshes, table = slow.losses().meshes(), slow.friction().content["excitation"]
    found = (meshes["loss_in_motion_w"] / meshes["loss_w"]).item()
    at = table[table["torque_n_m"] == 600.0]
    pinion, gear = 1e-3 * at["pinion_lever_mm"], 1e-3 * at["face_gear_lever_mm"] * 23 / 143
    base = base_radius(slow)
    expected = (-(pinion + gear) / (1.0 - pinion / base)).mean() / -(pinion + gear).mean()
    assert found == pytest.approx(expected, abs=1e-3)
    if coefficient == 0.01:
        assert found == pytest.approx(1.0, abs=5e-3)


def test_loss_only_leaves_the_motion_as_it_is_without_lubrication_to_the_bit(gearbox):
    without = gearbox.with_values({"lubrication": None}).response()
    alone = running(gearbox, "loss_only").response()
    rubbed = running(gearbox, "excitation").response()
    for name in ("response", "summary", "bearings"):
        assert alone.content[name].equals(without.content[name])
    change = rubbed.content["bearings"]["mean_n"] - without.content["bearings"]["mean_n"]
    assert 1e-3 < change.abs().max() / without.content["bearings"]["mean_n"].abs().max() < 0.05
    assert running(gearbox, "loss_only").losses().meshes()["loss_in_motion_w"].isna().all()


def test_friction_in_motion_is_refused_for_meshes_as_printed(gearbox):
    printed = {"transmission.mesh_kinematics": "printed", "transmission.face_gear.mesh_radius_mm": 262.5}
    with pytest.raises(FacegearError, match=r'lubrication.friction.effect = "excitation": must be loss_only'):
        running(gearbox, "excitation", **printed)
