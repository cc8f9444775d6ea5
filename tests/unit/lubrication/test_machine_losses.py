"""Loss and heat of machines: every mesh by the power it carries, heat summed over bodies."""

from math import pi
from pathlib import Path

import numpy as np
import pytest
from references import against, agrees

import facegear
from facegear.errors import FacegearError
from facegear.lubrication.loss import OverTorque

pytestmark = pytest.mark.xdist_group("notebooks")  # the example's contact is computed once a process

CONFIG = Path(__file__).parents[3] / "config"
OIL = {
    "oil": "polyol_ester_5_cst",
    "supply_temperature_c": 90,
    "pinion": {"ra_um": 0.3},
    "face_gear": {"ra_um": 0.3},
    "bulk": {"source": "cooling", "pinion_w_per_k": 60, "face_gear_w_per_k": 200},
}


@pytest.fixture(scope="module")
def gearbox():
    return facegear.example().with_values({"lubrication": OIL})


@against(
    "other program",
    "loss summed over the meshes by another program",
    capability="machine_loss",
    module="facegear.lubrication.loss",
)
def test_the_concentric_machine_loses_what_the_power_of_its_meshes_loses():
    """Its ten torques at rest and the loss factors of its pair, both from the reference: 19 123 W."""
    torques = [304.946, 238.714, 383.252, 408.464, 248.056, 214.642, 238.714, 944.748, 919.536, 248.056]
    factors = OverTorque(
        np.array([100.0, 300.0, 550.0, 1000.0]), np.array([0.104676, 0.112617, 0.117747, 0.124134])
    )
    power = np.array(torques) * 7500 * pi / 30
    loss = 0.05 * factors.at(torques) * power
    agrees("loss of the machine, W", loss.sum(), 19123, relative=1e-3)
    agrees("loss of a mesh, W", loss[[7, 8, 0]], [4581, 4448, 1350], relative=1e-3)
    agrees("power through the meshes over the power brought in", power.sum() / 2086e3, 1.5622, relative=1e-4)


@against(
    "analytic",
    "balance of heat",
    capability="machine_loss",
    module="facegear.stages.machine_loss",
)
def test_mesh_losses_machine_loss_and_heat_of_the_bodies_are_one_sum(gearbox):
    found = gearbox.losses()
    meshes, bodies, machine = found.meshes(), found.bodies(), found.table()
    assert (machine["bin"] == 0).all()
    loss = machine["loss_w"].item()
    agrees("sum of the mesh losses, W", meshes["loss_w"].sum(), loss, relative=1e-12)
    agrees("sum of the heat of the bodies, W", bodies["heat_w"].sum(), loss, relative=1e-12)
    agrees(
        "heat of both gears over the loss of a mesh",
        (meshes[["pinion_heat_w", "face_gear_heat_w"]].sum(axis=1) / meshes["loss_w"]).to_numpy(),
        1.0,
        relative=1e-12,
    )
    agrees(
        "efficiency", machine["efficiency"].item(), 1 - loss / machine["power_in_w"].item(), relative=1e-12
    )
    assert machine["power_through_meshes"].item() >= 1 - 1e-9
    assert (bodies["bulk_c"] > 90).any()


def test_an_oil_s_limits_and_the_model_stand_beside_the_numbers(gearbox):
    found = gearbox.friction()
    table = found.table()
    assert (table["friction_model"] == "schlenk").all()
    assert (table["allowed_contact_temperature_c"] == 220).all()
    rises = (220 - 90) / (table["contact_temperature_c"] - 90)
    assert table["scuffing_safety"].to_numpy() == pytest.approx(rises.to_numpy(), rel=1e-12)
    limits = found.limits()
    assert set(limits["limit"]) == {"line load at least 150 N/mm", "pitch line velocity at most 50 m/s"}
    assert limits["loss_outside_percent"].between(0, 100).all()
    chart = found.map()
    assert chart["efficiency"].between(0.98, 1).all() and (chart["loss_w"] > 0).all()
    at = found.positions().groupby("torque_n_m")["loss_w"].mean().to_numpy()
    assert at == pytest.approx(table["loss_w"].to_numpy(), rel=1e-12)
    for what in ("path", "flank", "efficiency"):
        assert found.plot(what).axes


def test_without_the_section_friction_is_refused_in_one_line(gearbox):
    with pytest.raises(FacegearError, match=r"lubrication = None: must be given, for friction and heat"):
        gearbox.with_values({"lubrication": None}).friction()


def test_a_section_without_contact_analysis_says_what_is_missing():
    with pytest.raises(
        FacegearError, match=r"tooth_pair.pinion = null: must be given, as required by lubrication"
    ):
        facegear.load(CONFIG / "harmonics_only.yaml").with_values({"lubrication": OIL})
