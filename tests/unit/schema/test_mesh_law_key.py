"""mesh_stiffness.mesh_law: what it needs, in one line where it is missing."""

import pytest

import facegear
from facegear.errors import ConfigError, ConfigErrors

LAW = {"mesh_stiffness.mesh_law": "load_dependent", "modal.stiffness": "local"}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"transmission.mesh_kinematics": "printed", "transmission.face_gear.mesh_radius_mm": 262.5},
            "geometric",
        ),
        ({"modal.stiffness": "average"}, "modal.stiffness"),
        ({"mesh_stiffness.variation": 0.5}, "mesh_stiffness.variation"),
    ],
)
def test_what_a_load_dependent_law_cannot_be_combined_with_is_refused_in_one_line(changes, message):
    with pytest.raises((ConfigError, ConfigErrors), match=message):
        facegear.example().with_values({**LAW, **changes})


@pytest.mark.parametrize(
    ("config", "law"),
    [
        *((name, "load_dependent") for name in ("concentric", "tolerances")),
        *((name, "constant_load") for name in ("paper", "quick", "two_pinion", "friction", "search")),
    ],
)
def test_the_machine_as_it_would_be_built_knows_its_load_and_that_of_the_paper_does_not(config, law):
    assert facegear.load(f"config/{config}.yaml").values["mesh_stiffness"]["mesh_law"] == law


def test_the_example_takes_the_load_dependent_law_and_a_config_that_says_nothing_a_constant_stiffness():
    values = facegear.example().values
    assert values["mesh_stiffness"]["mesh_law"] == "load_dependent"
    section = {key: value for key, value in values["mesh_stiffness"].items() if key != "mesh_law"}
    silent = facegear.example().with_values({"mesh_stiffness": section})
    assert silent.values["mesh_stiffness"]["mesh_law"] == "constant_load"
