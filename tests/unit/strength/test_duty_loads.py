"""Load factors of a duty cycle from the machine's own motion."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees

import facegear
from facegear.build.machine import MachineInputs, at_mesh_torque
from facegear.errors import ConfigError, ConfigErrors
from facegear.machine.ratings import mesh_table
from facegear.pipeline.needs import stage_needs, stages_before
from facegear.pipeline.run import call
from facegear.pipeline.table import STAGES
from facegear.schema.transmission import Transmission
from facegear.sharing.even_shares import even_shares
from facegear.strength.duty_loads import classes, hardest_tooth
from facegear.strength.materials import DutyBin, machine_duty

pytestmark = pytest.mark.xdist_group("notebooks")  # the example's contact is computed once a process

BIN = {"speed_rpm": 7500, "hours": 10}
SMOOTH = {
    "mesh_stiffness": {"source": "harmonics", "table": [{"order": 0, "cos_n_per_m": 4e8}]},
    "transmission.transmission_error.amplitude_um": 0,
    "strength.load_factors": "machine",
    "dynamics.accuracy.periodic_residual": 1e-9,  # a transient that is left may be some twenty times as large
}


def found_by(gearbox, harmonics):
    given = {"harmonics": harmonics, **stage_needs("duty_loads", gearbox.values)}
    return call(STAGES["duty_loads"], given).content


@against(
    "analytic",
    "a mesh of constant stiffness without errors runs at its static force",
    capability="duty_loads",
    module="facegear.pipeline.stages.duty",
)
def test_smooth_meshes_run_at_their_mean_force_on_the_flanks_of_the_statics():
    gearbox = facegear.example().with_values(SMOOTH)
    harmonics = gearbox.stiffness().content["harmonics"]
    found = found_by(gearbox, harmonics)
    loads = found["duty_loads"]
    agrees("dynamic factor", loads["dynamic_factor"], 1.0, relative=1e-6)
    assert loads["settled"].all()
    for number, torque in ((1, 600.0), (2, 900.0)):
        machine = MachineInputs.of_config(gearbox.values, harmonics).at_torque(torque).build()
        at_rest = mesh_table(machine, 0.0).set_index("mesh")
        running = loads[loads["bin"] == number].set_index("mesh")
        assert running["flank"].to_dict() == at_rest["flank"].to_dict()
        even = pd.Series(even_shares(machine), machine.layout.mesh_names)
        expected = at_rest["pinion_torque_n_m"].abs() / machine.layout.pinion_arm / even
        agrees("mesh load factor", running["mesh_load_factor"], expected[running.index], relative=1e-3)


@against(
    "analytic",
    "turns times meshes of a turn",
    capability="rating",
    module="facegear.strength.materials",
)
def test_teeth_of_each_body_meet_its_own_meshes_and_idlers_bend_both_ways():
    gearbox = facegear.example().with_values(SMOOTH)
    harmonics = gearbox.stiffness().content["harmonics"]
    found = found_by(gearbox, harmonics)
    spectrum, loads = found["duty_spectrum"], found["duty_loads"]
    flanks = {
        body: set(rows["flank"]) for body, rows in spectrum[spectrum["bin"] == 1].groupby("body", sort=False)
    }
    assert flanks["right input"] == flanks["upper face gear"] == {"drive"}
    assert flanks["right idler"] == flanks["lower face gear"] == {"drive", "back"}
    most = spectrum.groupby(["bin", "mesh"])["force_n"].max()
    np.testing.assert_allclose(most, loads.groupby(["bin", "mesh"])["largest_force_n"].max(), rtol=1e-12)
    duty = [DutyBin(600.0, 125.0, 3600.0), DutyBin(900.0, 80.0, 60.0)]
    by_body = {
        (one.body, one.flank): one
        for one in machine_duty(spectrum, duty, 23 / 143, {"drive": 0.04, "back": 0.04})
    }
    turns = 125.0 * 3600.0 + 80.0 * 60.0
    agrees(
        "cycles of an input's drive flank",
        by_body["right input", "drive"].cycles.sum(),
        2 * turns,
        relative=1e-6,
    )
    agrees(
        "cycles of an idler's back flank", by_body["right idler", "back"].cycles.sum(), turns, relative=1e-6
    )
    agrees(
        "cycles of the upper face gear's drive flank",
        by_body["upper face gear", "drive"].cycles.sum(),
        5 * turns * 23 / 143,
        relative=1e-6,
    )
    assert not by_body["right input", "drive"].opposite.any()
    idler = by_body["right idler", "drive"]
    np.testing.assert_allclose(idler.opposite, [by_body["right idler", "back"].torque[n] for n in (0, 1)])


def test_runouts_load_the_teeth_at_their_high_point_hardest():
    eccentric = {"runout": {"eccentricity_um": 10}}
    values = {**SMOOTH, "transmission.single_pinions": {"right input": eccentric}}
    gearbox = facegear.example().with_values({**values, "strength.duty": [{**BIN, "torque_n_m": 600}]})
    harmonics = gearbox.stiffness().content["harmonics"]
    found = found_by(gearbox, harmonics)
    assert found["duty_loads"]["motion"].unique().tolist() == ["followed"]
    spectrum = found["duty_spectrum"][found["duty_spectrum"]["mesh"] == "right input/upper"]
    own = spectrum[spectrum["body"] == "right input"]["force_n"]
    seen = spectrum[spectrum["body"] == "upper face gear"]["force_n"]
    assert len(own) == 1  # a pinion's tooth comes to its high point in every turn
    assert seen.max() > 1.01 * seen.min()  # a gear's tooth meets all teeth of the pinion
    assert own.iloc[0] == pytest.approx(seen.max(), rel=1e-3)


@given(st.lists(st.floats(0.0, 1e5), min_size=1, max_size=60), st.floats(1.0, 12.0))
def test_classes_of_passages_never_do_less_harm_than_the_passages(forces, slope):
    found = list(classes(np.array(forces)))
    assert sum(share for share, _ in found) == pytest.approx(1.0)
    assert max(force for _, force in found) == max(forces)
    harm = sum(share * force**slope for share, force in found)
    assert harm >= np.mean(np.array(forces) ** slope) * (1.0 - 1e-12)


@against(
    "manufactured",
    "passages of which one tooth's are the largest",
    capability="duty_loads",
    module="facegear.strength.duty_loads",
)
def test_the_hardest_tooth_is_the_one_whose_passages_do_most_harm():
    met = np.stack([np.arange(12) % 3, (np.arange(12) + 1) % 3], axis=1)
    passages = np.where(met == 2, 100.0, 90.0) + np.arange(12)[:, None] * 0.01
    for forces, expected in zip(
        hardest_tooth(passages, met), (passages[2::3, 0], passages[1::3, 1]), strict=True
    ):
        agrees("force of the hardest tooth, N", forces, expected, relative=1e-7)


@against(
    "analytic",
    "proportion",
    capability="duty_loads",
    module="facegear.build.lumped_model",
)
def test_all_torques_follow_the_one_in_an_inputs_mesh():
    values = facegear.example().values["transmission"]
    own = {**values["pinions"][1], "torque_n_m": 100.0}
    given = {**values, "pinions": [own, *values["pinions"][2:]]}
    scaled = at_mesh_torque(Transmission.of_config(given), 2 * 1327.6 / 2)
    agrees("torque of an input, N m", scaled.torque.per_input_n_m, 2 * 1327.6, relative=1e-6)
    agrees("torque of another pinion, N m", scaled.pinions[0].torque_n_m, 200.0, relative=1e-6)
    assert scaled.pinions[1].torque_n_m is None
    with pytest.raises(ConfigError, match="duty cycle"):
        unloaded = {**given, "torque": {"per_input_n_m": 0.0, "tail_share": 0.0}}
        at_mesh_torque(Transmission.of_config(unloaded), 600.0)


def test_the_machines_loads_come_before_the_rating_where_it_takes_them():
    values = facegear.example().with_values(SMOOTH).values
    assert "duty_loads" in stages_before("rating", values)
    assert "duty_loads" not in stages_before("rating", facegear.example().values)


def test_factors_are_either_given_or_the_machines():
    with pytest.raises(ConfigErrors, match=r"strength\.dynamic_factor = 1\.2: must be left out where"):
        facegear.example().with_values({**SMOOTH, "strength.dynamic_factor": 1.2})
    for key, value in (("pinion.both_ways", True), ("face_gear.cycles_per_turn", 5)):
        with pytest.raises(ConfigErrors, match=rf"strength\.{key} = (true|5): must be left out where"):
            facegear.example().with_values({**SMOOTH, f"strength.{key}": value})
    with pytest.raises(ConfigErrors, match=r"required by strength\.load_factors = machine"):
        facegear.example().with_values({"strength.load_factors": "machine", "transmission": None})


def test_a_bin_outside_the_range_of_speeds_is_reported_before_any_work():
    fast = {**SMOOTH, "strength.duty": [{**BIN, "torque_n_m": 600, "speed_rpm": 25000}]}
    with pytest.raises(
        ConfigErrors,
        match=r"strength\.duty\[0\]\.speed_rpm = 25000.*: must be within dynamics\.sweep, 5000 to 9200",
    ):
        facegear.example().with_values(fast)
