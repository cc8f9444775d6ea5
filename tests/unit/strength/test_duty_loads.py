"""Load factors of a duty cycle from the machine's own motion."""

import numpy as np
import pytest

import facegear
from facegear.config.base import parse
from facegear.config.lumped_model import at_mesh_torque
from facegear.config.machines import wired_machine
from facegear.config.needs import stage_needs, stages_before
from facegear.config.strength import Strength, rating_request
from facegear.errors import ConfigError, ConfigErrors
from facegear.stages.duty_loads import duty_loads
from facegear.transmission.ratings import mesh_table

SMOOTH = {
    "mesh_stiffness": {"source": "harmonics", "table": [{"order": 0, "b_n_per_m": 4e8}]},
    "transmission.transmission_error.amplitude_um": 0,
    "strength.load_factors": "machine",
}


def test_smooth_meshes_run_at_their_mean_force_and_the_load_factor_is_that_of_the_statics():
    gearbox = facegear.example().with_values(SMOOTH)
    harmonics = gearbox.stiffness().content["harmonics"]
    found = duty_loads(harmonics, **stage_needs("duty_loads", gearbox.values)).content["duty_loads"]
    assert found["torque_n_m"].tolist() == [600.0, 900.0]
    np.testing.assert_allclose(found["dynamic_factor"], 1.0, rtol=1e-6)
    for row in found.itertuples():
        loaded = at_mesh_torque(gearbox.values["transmission"], row.torque_n_m)
        at_rest = mesh_table(wired_machine(loaded, gearbox.values["tooth_pair"], harmonics), 0.0)
        largest = at_rest["pinion_torque_n_m"].abs().max()
        assert row.mesh_load_factor * row.torque_n_m == pytest.approx(largest, rel=1e-3)


def test_all_torques_follow_the_one_in_an_inputs_mesh():
    values = facegear.example().values["transmission"]
    own = {**values["pinions"][1], "torque_n_m": 100.0}
    given = {**values, "pinions": [own, *values["pinions"][2:]]}
    scaled = at_mesh_torque(given, 2 * 1327.6 / 2)
    assert scaled["torque"]["per_input_n_m"] == pytest.approx(2 * 1327.6)
    assert scaled["pinions"][0]["torque_n_m"] == pytest.approx(200.0)
    assert scaled["pinions"][1]["torque_n_m"] is None
    with pytest.raises(ConfigError, match="duty cycle"):
        at_mesh_torque({**given, "torque": {"per_input_n_m": 0.0, "tail_share": 0.0}}, 600.0)


def test_factors_of_the_machine_multiply_each_bin_and_come_before_the_rating():
    values = facegear.example().with_values(SMOOTH).values
    section = parse(Strength, values["strength"])
    torques = [one.torque for one in rating_request(section, [1.5, 2.0]).duty]
    assert torques == pytest.approx([900.0, 1800.0])
    assert "duty_loads" in stages_before("rating", values)
    assert "duty_loads" not in stages_before("rating", facegear.example().values)


def test_factors_are_either_given_or_the_machines():
    with pytest.raises(ConfigErrors, match=r"strength\.dynamic_factor = 1\.2: left out where load_factors"):
        facegear.example().with_values({**SMOOTH, "strength.dynamic_factor": 1.2})
    with pytest.raises(ConfigErrors, match=r"required by strength\.load_factors = machine"):
        facegear.example().with_values({"strength.load_factors": "machine", "transmission": None})
