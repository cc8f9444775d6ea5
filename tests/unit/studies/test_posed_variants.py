"""Samples and designs of a machine whose meshes stand as its own forces put them."""

import numpy as np
import pytest

import facegear
from facegear.build.machine import MachineInputs
from facegear.build.tooth_numbers import ToothNumbers
from facegear.errors import ConfigErrors
from facegear.harmonics import Harmonics
from facegear.machine.poses.surface import PoseSurface
from facegear.machine.static_gears import at_rest
from facegear.schema.base import parse
from facegear.schema.transmission import Transmission
from facegear.sharing.quantities import quasi_static_quantities
from facegear.studies.machines import Question, judge
from facegear.studies.tooth_contact import PairExcitation
from validation.poses.measure import SURFACE

K, NONE = Harmonics(np.zeros(1), np.array([4.1e8])), Harmonics(np.zeros(1), np.zeros(1))
QUESTION = Question("quasi_static", 1, {}, {})
POSED = {"transmission.operating_pose": "static"}
CAUSE = {"name": "a", "shape": "normal", "spread": 1.0, "source": "assumed for this test"}
GOALS = {
    "variables": [
        {"name": "bearing", "sets": ["transmission.pinion.bearing_stiffness_n_per_m.x"], "limits": [1e8, 2e8]}
    ]
}


@pytest.fixture(scope="module")
def arrays():
    with np.load(SURFACE) as stored:
        return dict(stored)


@pytest.fixture(scope="module")
def values():
    """Plain values of the concentric machine without runouts: one mesh cycle is all of the hunting cycle."""
    return facegear.load("config/concentric.yaml", results=None).values


def moved(values, key, number):
    """Values with one number in another place."""
    first, *rest = key.split(".")
    return {**values, first: moved(values[first], ".".join(rest), number) if rest else number}


@pytest.mark.parametrize(
    ("key", "number"),
    [
        ("transmission.pinion.bearing_stiffness_n_per_m", {"x": 9e7, "y": 9e7, "z": 0.0, "xy": 0.0}),
        ("transmission.torque.per_input_n_m", 1200.0),
        ("transmission.single_pinions", {"tail idler": {"position_um": {"x": 30.0, "y": -20.0}}}),
    ],
)
def test_machine_among_many_stands_as_the_same_machine_alone(arrays, values, key, number):
    """Bearings, loads and position errors move the poses of each one by itself."""
    numbers = ToothNumbers.of_config(values["tooth_pair"])

    def pair(section):
        return PairExcitation(numbers, K, NONE)

    surface = PoseSurface.of_arrays(arrays)
    judged = judge(QUESTION, pair, "this", surface=surface)
    assembled = judge(QUESTION, pair, "this")
    given = moved(values, key, number)
    section = parse(Transmission, given["transmission"])
    alone = at_rest(
        MachineInputs(
            transmission=section, teeth=numbers, harmonics=K, unloaded_error=NONE, poses=arrays
        ).build()
    )
    expected, _ = quasi_static_quantities(alone, 1)
    found, nominal = judged(given), judged(values)
    assert found == pytest.approx(expected, rel=1e-9)
    assert max(abs(found[name] / nominal[name] - 1.0) for name in found if nominal[name]) > 1e-3
    rest = assembled(given)
    assert max(abs(found[name] / rest[name] - 1.0) for name in found if rest[name]) > 1e-3


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"tolerances": {"causes": [{**CAUSE, "moves": {"tooth_pair.assembly.offset_um": 1.0}}]}},
            r"tolerances\.causes\.moves = .tooth_pair\.assembly\.offset_um..*surface",
        ),
        (
            {
                "tolerances": {
                    "tooth_contact": True,
                    "causes": [{**CAUSE, "moves": {"transmission.pinion.bearing_stiffness_n_per_m.x": 1e6}}],
                }
            },
            r"tolerances\.tooth_contact = true.*as assembled",
        ),
        (
            {
                "search": {
                    "variables": [
                        {"name": "e", "sets": ["tooth_pair.assembly.offset_um"], "limits": [-9.0, 9.0]}
                    ],
                    "objectives": [{"name": "share", "largest_of": ["k_gamma"]}],
                }
            },
            r"search\.variables\.sets = .tooth_pair\.assembly\.offset_um..*surface",
        ),
        (
            {"search": {**GOALS, "objectives": [{"name": "rough", "largest_of": ["pressure"]}]}},
            "search.*rough.*pressure.*as assembled",
        ),
    ],
)
def test_what_one_surface_does_not_describe_is_refused_by_its_key(changes, line):
    with pytest.raises(ConfigErrors, match=line):
        facegear.example().with_values({**POSED, **changes})
