"""A config to start from is complete, and says what was chosen."""

import pytest

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
    assert (
        values["mesh_stiffness"]["torque_n_m"]
        == values["transmission"]["torque"]["per_input_n_m"]
        == known.torque_n_m
    )
    assert len(values["transmission"]["pinions"]) == known.pinions


def test_the_chosen_bodies_are_those_of_a_steel_ring(tmp_path):
    machine = written(MACHINES[1], tmp_path)
    pinion, width = machine["transmission"]["pinion"], machine["tooth_pair"]["pinion"]
    outer, bore = 0.5 * 3.75 * 23, width["bore_radius_mm"]
    volume = 3.14159265 * (outer**2 - bore**2) * width["width_mm"]
    assert pinion["mass_kg"] == pytest.approx(7850e-9 * volume, rel=1e-3)
    gyration = 1e-6 * (outer**2 + bore**2) / 2
    assert pinion["inertia_kg_m2"] == pytest.approx(pinion["mass_kg"] * gyration, rel=1e-3)


def test_a_machine_without_load_is_refused_in_one_line():
    with pytest.raises(ConfigError, match=r"^torque_n_m = 0: must be above 0$"):
        starting_config(Known("own", 23, 143, 3.75, 0, 7500))
