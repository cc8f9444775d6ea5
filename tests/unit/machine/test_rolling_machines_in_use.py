"""Questions on machines with rolling bearings: motion, hunting cycle, tolerances and loci."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rolling_machines import S1, machine_on

import facegear
from facegear.build.machine import MachineInputs
from facegear.errors import ConfigErrors
from facegear.machine.layout import Role
from facegear.machine.machine import Damping
from facegear.machine.mean_load import at_mean_load
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import bearing_forces, mean_equilibrium
from facegear.motion.bearing_forces import bearing_history, shaft_bearing_history
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.schema.changes import add_changes, movable, variable_part
from facegear.sharing import sensitivity
from facegear.sharing.hunting import hunting_cycle

EXAMPLE = Path(__file__).parents[3] / "config" / "bearings.yaml"
CLEARANCE = "transmission.shafts.input.bearings.0.rolling.clearance_diametral_um"
BORE = "transmission.shafts.input.bearings.0.position_um.x"


@pytest.fixture(scope="module")
def example():
    return facegear.load(EXAMPLE)


@pytest.fixture(scope="module")
def machine(example):
    return MachineInputs.of_config(example.values, example.stiffness().content["harmonics"]).build()


@pytest.fixture(scope="module")
def steady():
    """Model and response of the machine of the notes, tilting, whose meshes are even: it rests in motion."""
    machine = at_mean_load(machine_on({0: S1}, tilt_inertias={0: 1.5e-3}))
    model = build_model(replace(machine, damping=Damping(2000.0, 300.0, 2e-6)))
    return model, simulate(model, 2000.0)


def test_a_motion_at_rest_loads_every_body_as_statics_do(steady):
    model, response = steady
    history = bearing_history(model, response)
    static = bearing_forces(model.machine, mean_equilibrium(model.machine))
    assert np.allclose(history, static, rtol=0, atol=1e-6 * np.abs(static).max())


def test_a_motion_at_rest_loads_both_bearings_as_statics_do(steady):
    model, response = steady
    on_bearings = shaft_bearing_history(model, response, bearing_history(model, response))
    static = mean_equilibrium(model.machine).shafts[0].forces
    assert np.allclose(on_bearings, static, rtol=0, atol=1e-6 * np.abs(static).max())


def test_the_hunting_cycle_knows_the_load_of_every_position(machine):
    run = hunting_cycle(at_rest(machine), 8)
    assert run.at_rest.residual.max() < 1e-11
    loads = run.at_rest.shafts[2].forces[:, 0, :2]
    assert np.ptp(np.hypot(*loads.T)) > 10.0


def test_the_scan_over_bearing_stiffness_keeps_the_other_rolling_bearings(machine):
    """They were springs without their load, on which idlers carried nothing."""
    compared = sensitivity._with_kinematics(at_rest(machine), machine.layout.kinematics)
    forces = [mean_equilibrium(at_rest(each)).forces[0] for each in (machine, compared)]
    assert np.allclose(*forces, rtol=0, atol=1e-7 * np.abs(forces[0]).max())
    changed = sensitivity._with_bearings(compared, (Role.INPUT,), 1e9)
    assert changed.drive_line.rolling == compared.drive_line.rolling[:2] + compared.drive_line.rolling[4:]


def test_clearance_bore_and_preload_are_numbers_that_tolerances_may_move(example):
    values = variable_part(example.values["transmission"], example.values["tooth_pair"], 3000.0)
    start = movable(values, [CLEARANCE, BORE])
    moved = add_changes(start, {CLEARANCE: 10.0, BORE: -3.0})
    bearing = moved["transmission"]["shafts"]["input"]["bearings"][0]
    assert bearing["rolling"]["clearance_diametral_um"] == 25.0 and bearing["position_um"]["x"] == -3.0
    shaft = {
        **values["transmission"]["shafts"]["input"],
        "preload": {"bearings": ["A", "B"], "axial_um": 5.0},
    }
    values["transmission"] = {**values["transmission"], "shafts": {"input": shaft}}
    assert movable(values, ["transmission.shafts.input.preload.axial_um"])


def test_more_clearance_softens_the_seat_of_an_input(example):
    tight, wide = (
        example.with_values({CLEARANCE: clearance}).shafts().table().set_index("pinion")
        for clearance in (0.0, 60.0)
    )
    stiffness = [table.loc["right input", "stiffness_x_n_per_m"] for table in (tight, wide)]
    assert stiffness[0] > 1.02 * stiffness[1]


def test_samples_of_a_clearance_are_solved_and_counted(example):
    causes = [
        {"name": "play", "spread": 4, "limits": [-8, 8], "moves": {CLEARANCE: 1}, "source": "maker"},
        {"name": "bore", "spread": 4, "limits": [-10, 10], "moves": {BORE: 1}, "source": "drawing"},
    ]
    section = {"samples": 8, "chunk_samples": 8, "index_blocks": 0, "causes": causes}
    try:
        samples = example.with_values({"tolerances": section}).tolerances().content["samples"]
    except ConfigErrors as error:
        pytest.fail(str(error))
    assert samples["error"].eq("").all() and samples["k_gamma right input/upper"].std() > 0.0


def test_the_deflected_shaft_ends_at_its_bearings(example, machine):
    table = example.shafts().content["deflections"]
    at = mean_equilibrium(at_rest(machine))
    pinion = [pinion.name for pinion in machine.layout.pinions].index("right input")
    rows = table[table["pinion"] == "right input"].set_index("at_mm")
    for place, ring in zip((10.0, 120.0), at.shafts[pinion].rings[0], strict=True):
        assert rows.loc[place, ["x_um", "y_um"]].to_numpy(float) == pytest.approx(1e6 * ring[:2], rel=1e-6)


@pytest.mark.parametrize("parameter", ["torque", "bearing_stiffness"])
def test_loci_that_would_leave_the_tangent_are_refused_by_name(example, parameter):
    example.with_values({"branches": {"loci": {"parameters": ["backlash"]}}})
    with pytest.raises(
        ConfigErrors, match=rf"branches\.loci\.parameters.*without {parameter} beside rolling"
    ):
        example.with_values({"branches": {"loci": {"parameters": [parameter]}}})
