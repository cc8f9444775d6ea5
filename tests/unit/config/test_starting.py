"""A config to start from is complete, and says what was chosen."""

import pytest

import facegear
from facegear.config.load import config_of
from facegear.config.model import resolved
from facegear.config.starting import Known, starting_config
from facegear.config.yaml_file import read_yaml
from facegear.errors import ConfigError

MACHINES = (
    Known("small", 19, 57, 2, 50, 10000, pinions=3),
    Known("paper", 23, 143, 3.75, 1300, 7500, 2),
    Known("plain", 40, 120, 1, 5, 500, pressure_angle_deg=20),
    Known("large", 25, 160, 6.35, 800, 5000, coarse=True),
    Known("split", 23, 143, 3.75, 1300, 7500, pinions=2, idlers=3),
    Known("odd", 19, 57, 2, 50, 10000, pinions=1, idlers=2),
)


def written(known, tmp_path):
    path = tmp_path / "own.yaml"
    path.write_text(starting_config(known))
    return read_yaml(path)


@pytest.mark.parametrize("known", MACHINES, ids=lambda known: known.case)
def test_what_a_user_knows_is_enough_for_a_config_without_mistakes(known, tmp_path):
    values = resolved(config_of(written(known, tmp_path)))
    assert len(starting_config(known).splitlines()) <= 22
    assert values["tooth_pair"]["face_gear_teeth"] == known.face_gear_teeth
    machine = values["transmission"]
    assert machine["torque"]["per_input_n_m"] == known.torque_n_m
    assert values["mesh_stiffness"]["torque_n_m"] * len(machine["face_gears"]) == known.torque_n_m
    roles = [pinion["role"] for pinion in machine["pinions"]]
    assert (roles.count("input"), roles.count("idler")) == (known.pinions, known.idlers)
    assert len(machine["face_gears"]) == (2 if known.idlers else 1)


def test_idlers_lead_what_the_lower_gear_takes_to_the_upper_one(tmp_path):
    values = written(MACHINES[4], tmp_path)
    values["mesh_stiffness"] = {"source": "harmonics", "table": [{"order": 0, "cos_n_per_m": 4.1e8}]}
    values["transmission"]["transmission_error"] = {"amplitude_um": 0}
    statics = facegear.load(values).statics()
    power = statics.table().set_index("mesh")["power_kw"]
    lower = power[[mesh.endswith("/lower") for mesh in power.index]]
    assert lower.sum() == pytest.approx(0.0, abs=1e-6 * power.abs().max()), (
        "nothing is taken off the lower gear"
    )
    assert lower[["input 1/lower", "input 2/lower"]].min() > 0.0
    led = lower[["idler 1/lower", "idler 2/lower", "idler 3/lower"]]
    assert led.max() <= 0.0 and (led < 0.0).sum() >= 2, "an idler within its backlash carries nothing"


def test_the_chosen_bodies_are_those_of_a_steel_ring(tmp_path):
    machine = written(MACHINES[1], tmp_path)
    pinion, width = machine["transmission"]["pinion"], machine["tooth_pair"]["pinion"]
    outer, bore = 0.5 * 3.75 * 23, width["bore_radius_mm"]
    volume = 3.14159265 * (outer**2 - bore**2) * width["width_mm"]
    assert pinion["mass_kg"] == pytest.approx(7850e-9 * volume, rel=1e-3)
    gyration = 1e-6 * (outer**2 + bore**2) / 2
    assert pinion["inertia_kg_m2"] == pytest.approx(pinion["mass_kg"] * gyration, rel=1e-3)


def test_a_machine_without_load_is_refused_in_one_line():
    with pytest.raises(ConfigError, match=r"^torque_n_m = 0: must be from 1e-05 to 1e\+06$"):
        starting_config(Known("own", 23, 143, 3.75, 0, 7500))
