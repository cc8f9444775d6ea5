"""A pinion out of place means the same to the lumped model and to the exact tooth surfaces."""

from dataclasses import replace

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine

from facegear.build.load import load_config
from facegear.build.tooth_pair import pair_design
from facegear.machine.flank_errors import constant_errors
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.placement import mirror_design
from facegear.teeth.unloaded_contact import unloaded_contact

SHIFT = 1e-6
PHI = [0.02]


@pytest.fixture(scope="module")
def design():
    return pair_design(load_config("config/paper.yaml").tooth_pair)


def closed_by(design, **assembly):
    """Distance by which the flank pushes the gear further on: (drive, back), m along the line of action."""
    ways = []
    for pair in (design, mirror_design(design)):
        moved = replace(pair, assembly=AssemblyErrors(**assembly))
        moved = mirror_design(moved) if pair is not design else moved
        errors = [unloaded_contact(one, PHI).transmission_error[0] for one in (moved, pair)]
        ways.append(errors[0] - errors[1])
    return np.array(ways)


def lumped(x=0.0, y=0.0):
    """Values of the lumped model's upper and lower mesh: (drive, back) each."""
    layout = make_layout((("one", Role.INPUT, 0.0),), kinematics=GEOMETRIC)
    flaws = replace(perfect(layout), position=np.array([[x, y]]))
    lower_drive, upper_drive, lower_back, upper_back = -constant_errors(
        make_machine(layout, imperfections=flaws, tail_share=0.0)
    )
    return np.array([upper_drive, upper_back]), np.array([lower_drive, lower_back])


def test_an_offset_closes_the_upper_mesh_by_what_it_opens_the_lower_one(design):
    upper, lower = lumped(x=SHIFT)
    np.testing.assert_allclose(closed_by(design, offset=SHIFT), upper, rtol=2e-3)
    # The lower gear sees the pinion turned half round its own axis: the same pair with the opposite offset.
    np.testing.assert_allclose(closed_by(design, offset=-SHIFT), lower, rtol=2e-3)


def test_an_axial_shim_is_twice_its_sine_of_backlash(design):
    upper, lower = lumped(y=-SHIFT)
    opened = closed_by(design, gear_axial=SHIFT)
    np.testing.assert_allclose(opened, upper, rtol=2e-3)
    assert -opened.sum() == pytest.approx(2.0 * SHIFT * np.sin(np.radians(25.0)), rel=2e-3)
    np.testing.assert_allclose(closed_by(design, gear_axial=-SHIFT), lower, rtol=2e-3)


@pytest.mark.parametrize(
    "assembly",
    [
        {"offset": 60e-6},
        {"gear_axial": 40e-6},
        {"shaft_angle_error": np.radians(0.05)},
        {"offset": -30e-6, "gear_axial": 25e-6, "shaft_angle_error": np.radians(-0.03)},
    ],
)
@pytest.mark.parametrize("config", ["paper", "two_pinion"])
def test_errors_of_assembly_change_the_unloaded_errors_mean_and_nothing_else(config, assembly):
    """Show why e(t) from contact is one series for all meshes: a pinion out of place adds a constant only."""
    design = replace(
        pair_design(load_config(f"config/{config}.yaml").tooth_pair), assembly=AssemblyErrors(**assembly)
    )
    cycle = 2.0 * np.pi / design.pinion.teeth * np.linspace(0.0, 1.0, 9)
    error = unloaded_contact(design, cycle).transmission_error
    assert np.ptp(error) < 1e-11
