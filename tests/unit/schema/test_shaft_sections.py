"""Shafts and turning masses in the config: one section for a role or a pinion, and one line of refusal."""

from pathlib import Path

import numpy as np
import pytest
from ruamel.yaml import YAML
from three_pinions import STIFFNESS, TEETH, TEXT

import facegear
from facegear.build.lumped_model import machine
from facegear.errors import ConfigErrors
from facegear.machine.statics import mean_equilibrium
from facegear.schema.base import parse
from facegear.schema.changes import add_changes, movable
from facegear.schema.transmission import Transmission

EXAMPLE = Path(__file__).parents[3] / "config" / "shafts.yaml"
SHAFT = """
segments: [{length_mm: 120, diameter_mm: 40}]
pinion_mm: 50
bearings:
  - {at_mm: 0, radial_n_per_m: 1.5e8, axial_n_per_m: 1.0e8}
  - {at_mm: 120, radial_n_per_m: 2.5e8}
"""


def plain(text):
    return YAML(typ="safe").load(text)


def section(**changes):
    return {**plain(TEXT), **changes}


def shaft(**changes):
    return {**plain(SHAFT), **changes}


def built(**changes):
    return machine(parse(Transmission, section(**changes)), TEETH, STIFFNESS)


def test_a_shaft_of_a_role_is_replaced_by_that_of_a_pinion_and_others_keep_their_bearings():
    overhung = shaft(
        segments=[{"length_mm": 135, "diameter_mm": 36}],
        pinion_mm=135,
        bearings=[
            {"at_mm": 0, "radial_n_per_m": 2e8, "axial_n_per_m": 1e8},
            {"at_mm": 90, "radial_n_per_m": 3e8},
        ],
    )
    found = built(shafts={"input": shaft(), "two": overhung})
    bearings = [pinion.body.bearing[0] for pinion in found.layout.pinions]
    np.testing.assert_allclose(bearings, [2.170162e8, 6.640309e7, 6.5e7], rtol=5e-7)
    assert found.linear.size == 20
    tilting = built(shafts={"input": shaft(tilt_inertia_kg_m2=1.5e-3)})
    assert tilting.linear.labels[20:] == ("one:tilt_x", "one:tilt_y", "two:tilt_x", "two:tilt_y")
    forces = [mean_equilibrium(machine).forces for machine in (tilting, built(shafts={"input": shaft()}))]
    np.testing.assert_allclose(*forces, rtol=1e-10)


def test_no_common_bearing_stiffness_is_needed_where_every_pinion_has_a_shaft():
    bare = {"mass_kg": 1.2, "inertia_kg_m2": 0.002}
    found = built(pinion=bare, shafts={"input": shaft(), "tail": shaft()})
    assert [pinion.body.bearing[0] for pinion in found.layout.pinions] == [pytest.approx(2.170162e8)] * 3


def test_turning_masses_go_to_the_pinions_of_a_role_and_to_the_output():
    engine = {"name": "engine", "inertia_kg_m2": 0.08, "stiffness_n_m_per_rad": 2.5e4}
    tube = {"length_mm": 500, "diameter_mm": 60, "bore_mm": 40}
    rotor = {"name": "rotor", "inertia_kg_m2": 30, "segments": [tube, tube]}
    found = built(torsion={"input": [engine], "output": [rotor]})
    assert found.linear.labels[20:] == ("one:engine", "two:engine", "upper face gear:rotor")
    polar = np.pi / 32 * (0.06**4 - 0.04**4)
    assert found.drive_line.masses[4][0].stiffness == pytest.approx(206e9 / 2.6 * polar / 1.0, rel=1e-12)
    assert found.linear.torques[found.torque_coordinates].tolist() == found.torques.tolist()


def test_a_stiffness_of_a_bearing_may_vary_from_machine_to_machine():
    key = "transmission.shafts.input.bearings.0.radial_n_per_m"
    values = {"transmission": section(shafts={"input": shaft()})}
    softer = add_changes(movable(values, [key]), {key: -0.5e8})["transmission"]
    found = machine(Transmission.of_config(softer), TEETH, STIFFNESS).layout.pinions[0].body.bearing[0]
    assert found == pytest.approx(1.0 / (1.0 / 2.170162e8 + (7 / 12) ** 2 * (1e-8 - 1.0 / 1.5e8)), rel=1e-6)


@pytest.mark.parametrize(
    ("name", "beside"),
    [("shafts.yaml", r"transmission\.torsion"), ("flexible.yaml", "a body of a face gear")],
)
def test_branches_do_not_scale_bearings_beside_springs_that_are_none(name, beside):
    config = facegear.load(EXAMPLE.with_name(name))
    config.with_values({"branches": {"loci": {"parameters": ["torque"]}}})
    with pytest.raises(ConfigErrors, match=rf"branches\.loci\.parameters = .* beside {beside}"):
        config.with_values({"branches": {"loci": {"parameters": ["bearing_stiffness"]}}})


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"bearings": [{"at_mm": 130, "radial_n_per_m": 1e8}]}, "bearings[0].at_mm = 130.0: must be on the"),
        ({"pinion_mm": 200}, "pinion_mm = 200.0: must be on the shaft, from 0 to 120 mm"),
        ({"segments": [{"length_mm": 0.12, "diameter_mm": 40}]}, "length_mm = 0.12: must be greater"),
        ({"segments": [{"length_mm": 120, "diameter_mm": 0.04}]}, "diameter_mm = 0.04: must be greater"),
        ({"segments": [{"length_mm": 120, "diameter_mm": -40}]}, "diameter_mm = -40: must be greater"),
        (
            {"segments": [{"length_mm": 120, "diameter_mm": 40, "bore_mm": 40}]},
            "bore_mm = 40.0: must be below diameter_mm = 40",
        ),
        ({"bearings": [{"at_mm": 0, "radial_n_per_m": 1.5e5}]}, "radial_n_per_m = 150000.0: must be greater"),
        ({"bearings": [{"at_mm": 0}]}, "radial_n_per_m = null: must be given, or else matrix or rolling"),
        (
            {"bearings": [{"at_mm": 0, "radial_n_per_m": 1e8}, {"at_mm": 120, "radial_n_per_m": 1e8}]},
            'bearings = "at 0, 120 mm": must be such that they hold it along its axis and against tilting',
        ),
        (
            {"bearings": [{"at_mm": 0, "tilt_n_m_per_rad": 1e5, "matrix": [[1.0] * 5] * 5}]},
            "tilt_n_m_per_rad = 100000.0: must be left out beside matrix, which holds it",
        ),
        ({"bearings": [{"at_mm": 0, "matrix": [[1.0] * 5] * 4}]}, "must be 5 rows of 5 numbers"),
        ({"bearings": [{"at_mm": 0, "matrix": np.triu(np.ones((5, 5))).tolist()}]}, "must be symmetric"),
        (
            {"bearings": [{"at_mm": 0, "matrix": np.diag([1e8, -1e8, 1e8, 1e5, 1e5]).tolist()}]},
            "must be such that it resists every motion",
        ),
        (
            {"material": {"young_modulus_gpa": 206000, "poisson_ratio": 0.3}},
            "young_modulus_gpa = 206000: mus",
        ),
    ],
)
def test_a_shaft_that_cannot_be_is_refused_in_one_line(change, line):
    with pytest.raises(ConfigErrors) as refused:
        parse(Transmission, section(shafts={"input": shaft(**change)}))
    assert len(refused.value.lines) == 1
    assert "shafts.input." in refused.value.lines[0] and line in refused.value.lines[0]


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"shafts": {"three": shaft()}}, 'shafts.three = "three": must be one of one, two, tail, input'),
        (
            {
                "shafts": {"input": shaft()},
                "single_pinions": {"one": {"bearing_stiffness_n_per_m": {"x": 1e8, "y": 1e8, "z": 0}}},
            },
            "single_pinions.one.bearing_stiffness_n_per_m = {",
        ),
        (
            {"shafts": {"input": shaft(), "tail": shaft()}},
            "pinion.bearing_stiffness_n_per_m = {",
        ),
        (
            {"pinion": {"mass_kg": 1.2, "inertia_kg_m2": 0.002}, "shafts": {"input": shaft()}},
            "pinion.bearing_stiffness_n_per_m = null: must be given: 'tail' has no shaft",
        ),
        (
            {
                "shafts": {"input": shaft(tilt_inertia_kg_m2=1e-3)},
                "single_pinions": {"one": {"clearance_um": 20}},
            },
            "single_pinions.one.clearance_um = 20.0: must be 0 beside a shaft with tilt_inertia_kg_m2",
        ),
        ({"torsion": {"output": []}}, "torsion.output = []: must be one turning mass or more"),
        (
            {"torsion": {"input": [{"name": "engine", "inertia_kg_m2": 0.1}]}},
            "stiffness_n_m_per_rad = null: must be given, or else segments, but not both",
        ),
        (
            {"torsion": {"input": [{"name": "theta", "inertia_kg_m2": 0.1, "stiffness_n_m_per_rad": 1e4}]}},
            'name = "theta": must be none of x, y, z, theta',
        ),
        (
            {
                "torsion": {
                    "input": [{"name": "engine", "inertia_kg_m2": 0.1, "stiffness_n_m_per_rad": 1e4}] * 2
                }
            },
            'torsion.input[1].name = "engine": must be a name that no other mass of the chain has',
        ),
    ],
)
def test_a_machine_that_is_held_twice_or_not_at_all_is_refused_in_one_line(change, line):
    with pytest.raises(ConfigErrors) as refused:
        parse(Transmission, section(**change))
    assert len(refused.value.lines) == 1 and line in refused.value.lines[0], refused.value.lines
