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
    return facegear.example().with_values({"lubrication": OIL, "mesh_stiffness.mesh_law": "constant_load"})


@against(
    "second implementation",
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
    module="facegear.pipeline.stages.friction",
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
    assert limits["limit_source"].str.endswith("unverified: the document was not at hand").all()
    assert table["allowed_contact_temperature_source"].str.startswith("AGMA 925, mean for MIL-L-23699").all()
    assert limits["loss_outside_percent"].between(0, 100).all()
    chart = found.map()
    assert chart["efficiency"].between(0.98, 1).all() and (chart["loss_w"] > 0).all()
    at = found.positions().groupby("torque_n_m")["loss_w"].mean().to_numpy()
    assert at == pytest.approx(table["loss_w"].to_numpy(), rel=1e-12)
    for what in ("path", "flank", "efficiency"):
        assert found.plot(what).axes


def cause(name, key, **shape):
    return {"name": name, "moves": {key: 1.0}, "source": "drawing", **shape}


def fixed(name, key, value):
    return cause(name, key, shape="choice", values=[value])


ONE_PINION = {
    "transmission.pinions": [{"name": "engine", "role": "input", "angle_deg": 0}],
    "transmission.face_gears": ["upper"],
    "transmission.torque": {"per_input_n_m": 550, "tail_share": 0},
    "transmission.transmission_error": "from_contact",
    "transmission.mesh_kinematics": "geometric",
}


def test_a_sample_of_tolerances_loses_what_the_machine_with_its_values_does(gearbox):
    """The machine has one mesh at a constant torque, whose mean and largest load are those at rest."""
    moves = {
        "lubrication.supply_temperature_c": 8.0,
        "lubrication.pinion.ra_um": 0.1,
        "lubrication.oil.viscosities_mm2_s.0": -1.0,
        "lubrication.bulk.pinion_w_per_k": -10.0,
        "dynamics.speed_rpm": 500.0,
    }
    start = gearbox.with_values(ONE_PINION)
    causes = [fixed(f"cause_{number}", *item) for number, item in enumerate(moves.items())]
    section = {"causes": causes, "samples": 1, "chunk_samples": 1}
    found = start.with_values({"tolerances": section}).tolerances()
    sample, missed = found.samples().iloc[0], found.content["sampling"].set_index("quantity")
    values = start.values["lubrication"]
    oil = {**values["oil"], "viscosities_mm2_s": [values["oil"]["viscosities_mm2_s"][0] - 1.0, 5.1]}
    changed = start.with_values(
        {
            "lubrication.oil": oil,
            "lubrication.supply_temperature_c": 98.0,
            "lubrication.pinion.ra_um": 0.4,
            "lubrication.bulk.pinion_w_per_k": 50.0,
            "dynamics.speed_rpm": 8000.0,
        }
    )
    assert values["oil"]["viscosities_mm2_s"][1] == 5.1
    losses = changed.losses()
    mesh, whole = losses.meshes().iloc[0], losses.table().iloc[0]
    assert sample["friction_loss_w"] == pytest.approx(whole["loss_w"], rel=1e-6)
    assert sample["friction_loss_percent"] == pytest.approx(whole["loss_percent"], rel=1e-6)
    assert sample["hottest_body_c"] == pytest.approx(mesh["pinion_bulk_c"], abs=1e-4)
    names = ["largest_flash_k", "contact_temperature_c", "scuffing_safety", "scuffing_margin_k"]
    names += ["smallest_film_ratio", "smallest_micropitting_film_ratio"]
    for name in names:
        assert sample[name] == pytest.approx(mesh[name], rel=1e-6), name
    assert sample["unsolved_loss_share"] == 0.0
    simplified = missed["largest_missed"][missed.index.str.endswith("few places of the contact")]
    assert len(simplified) == 5 and (simplified < 1e-6).all()


def test_samples_say_what_oil_and_roughness_do_and_small_percentiles_of_what_is_better_large(gearbox):
    causes = [
        cause("oil", "lubrication.supply_temperature_c", spread=5.0),
        cause("rough", "lubrication.pinion.ra_um", shape="uniform", limits=[-0.1, 0.2]),
        cause("teeth", "transmission.single_meshes.right input/lower.error_um", spread=4.0),
    ]
    section = {"causes": causes, "samples": 32, "chunk_samples": 32, "hunting_cycles": 1}
    machine = {"transmission.mesh_kinematics": "geometric", "tolerances": section}
    found = gearbox.with_values(machine).tolerances()
    samples, table = found.samples(), found.table().set_index(["quantity", "percentile"])["value"]
    assert (samples["error"] == "").all()
    ranks = found.content["importance"].set_index(["quantity", "cause"])["rank_correlation"]
    assert ranks["friction_loss_w", "rough"] > 0.9
    assert ranks["smallest_film_um", "oil"] < -0.9
    assert ranks["hottest_body_c", "oil"] > 0.9
    assert ranks["k_gamma right input/lower", "oil"] == pytest.approx(0.0, abs=0.4)
    assert table["smallest_film_um", 1.0] < table["smallest_film_um", 50.0]
    assert table["friction_loss_w", 99.0] > table["friction_loss_w", 50.0]
    assert ("smallest_film_um", 99.0) not in table.index
    assert "W of friction and a contact temperature of" in found.summary
    torques = gearbox.values["contact"]["torques_n_m"]
    outside = found.content["fractions"].set_index("what")["fraction"].filter(like="outside those")
    assert samples["unsolved_loss_share"].between(0, 1).all() and len(outside) == 1
    assert torques[0] == 300  # some meshes of the machine carry less
    assert outside.iloc[0] == 1.0


def test_a_sample_whose_oil_passes_its_flash_point_is_a_row_with_its_error(gearbox):
    section = {"causes": [fixed("hot", "lubrication.supply_temperature_c", 170.0)], "samples": 1}
    found = gearbox.with_values({"tolerances": {**section, "chunk_samples": 1}}).tolerances()
    message = found.samples()["error"].iloc[0]
    assert "supply_temperature_c = 260.0: must be below the oil's flash point, 246" in message


@pytest.mark.parametrize(
    ("key", "line"),
    [
        ("lubrication.supply_temperature", "a key of lubrication whose nominal value is a number"),
        ("lubrication.pinion.rq_um", "a key of lubrication whose nominal value is a number"),
        ("lubrication.oil.name", "a key of lubrication whose nominal value is a number"),
        ("lubrication.oil.viscosities_mm2_s.2", "a key of lubrication whose nominal value is a number"),
    ],
)
def test_a_cause_that_moves_what_the_oil_does_not_have_is_one_line(gearbox, key, line):
    with pytest.raises(FacegearError, match=line) as caught:
        gearbox.with_values({"tolerances": {"causes": [cause("one", key, spread=1.0)]}})
    assert len(str(caught.value).splitlines()) == 1


def test_a_cause_that_moves_lubrication_asks_for_the_section(gearbox):
    moved = [cause("oil", "lubrication.supply_temperature_c", spread=1.0)]
    with pytest.raises(FacegearError, match="lubrication = null: must be given, as required by tolerances"):
        gearbox.with_values({"lubrication": None, "tolerances": {"causes": moved}})


def test_without_the_section_friction_is_refused_in_one_line(gearbox):
    with pytest.raises(FacegearError, match=r"lubrication = None: must be given, for friction and heat"):
        gearbox.with_values({"lubrication": None}).friction()


def test_a_section_without_contact_analysis_says_what_is_missing():
    with pytest.raises(
        FacegearError, match=r"tooth_pair.pinion = null: must be given, as required by lubrication"
    ):
        facegear.load(CONFIG / "harmonics_only.yaml").with_values({"lubrication": OIL})
