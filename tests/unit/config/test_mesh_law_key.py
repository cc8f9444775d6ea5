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


def test_a_constant_stiffness_is_the_default_and_the_law_is_asked_for_by_its_name():
    example = facegear.example()
    assert example.values["mesh_stiffness"]["mesh_law"] == "constant_load"
    assert example.with_values(LAW).values["mesh_stiffness"]["mesh_law"] == "load_dependent"
