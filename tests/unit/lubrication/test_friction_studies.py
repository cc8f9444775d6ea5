"""Studies over oil, temperature, roughness, speed and torque stand side by side with the machine."""

from pathlib import Path

import pandas as pd
import pytest
from references import against, agrees

from facegear.build.cases import expand_cases
from facegear.build.config import Config, resolved_values
from facegear.build.load import load_config
from facegear.pipeline.contact_studies import friction_cases, friction_points, friction_studied
from facegear.pipeline.needs import shared_sources
from facegear.pipeline.stage import Case
from facegear.pipeline.stages.friction import friction_studies
from facegear.schema.base import parse

CONFIG = Path(__file__).parents[3] / "config" / "friction.yaml"
STUDIED = {
    "oil": {"lubrication.oil": "pao_vg_68"},
    "cool": {"lubrication.supply_temperature_c": 80},
    "rough": {"lubrication.pinion.ra_um": 0.6, "lubrication.face_gear.ra_um": 0.6},
    "slow": {"dynamics.speed_rpm": 5000},
    "light": {"transmission.torque.per_input_n_m": 900},
    "sampled": {"load_sharing.hunting_positions": 8},
}


@pytest.fixture(scope="module")
def case():
    studies = [
        {
            "name": name,
            "title": name,
            "axes": [{"label": name, "points": [{"label": name, "set": changes}]}],
        }
        for name, changes in STUDIED.items()
    ]
    values = resolved_values(load_config(CONFIG))
    cases = expand_cases(parse(Config, {**values, "studies": studies}))
    name = values["case"]
    return Case(cases[name], cases, lambda stage, other: shared_sources(cases, stage)[other])


def test_a_study_of_oil_temperature_roughness_speed_or_torque_is_set_beside_the_machine(case):
    assert [study for study, _, _ in friction_points(case)] == [
        *("nominal", "oil", "cool", "rough", "slow", "light")
    ]
    assert friction_studied(case) and len(friction_cases(case)) == 6
    assert friction_cases(case)[1]["case"].startswith("friction/studies/oil/")


@against(
    "manufactured",
    "tables of two cases",
    capability="friction_studies",
    module="facegear.pipeline.stages.friction",
)
def test_each_case_tells_the_machine_s_loss_and_its_hottest_mesh_at_the_nominal_load():
    meshes = pd.DataFrame(
        {
            "bin": [0, 0, 1],
            "mesh": ["a", "b", "a"],
            "contact_temperature_c": [150.0, 220.0, 300.0],
            "scuffing_safety": [2.0, 1.0, 0.5],
            "smallest_film_ratio": [0.2, 0.3, 0.1],
            "within_torques_solved": [True, True, False],
        }
    )
    machine = pd.DataFrame(
        {
            "bin": [0, 1],
            "speed_rpm": 7500.0,
            "power_in_w": 2e6,
            "loss_w": [12e3, 9e3],
            "loss_percent": [0.6, 0.5],
        }
    )
    lighter = machine.assign(loss_w=6e3, loss_percent=0.3)
    points = [("nominal", "nominal", "as configured"), ("oil", "pao", "PAO")]
    found = friction_studies(points, [meshes, meshes], [machine, lighter])
    table = found.content["table"].set_index("label")
    agrees("loss of the machine, W", table["loss_w"], [12e3, 6e3])
    assert table.loc["PAO", ["hottest_mesh", "scuffing_safety", "smallest_film_ratio"]].tolist() == [
        "b",
        1.0,
        0.2,
    ]
    assert table["within_torques_solved"].all() and "0.300 to 0.600 %" in found.summary
