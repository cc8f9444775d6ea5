"""Tooth places: which angles can be assembled, and at which place of its cycle each mesh stands."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import PLACES, make_layout, make_machine

from facegear.harmonics import Harmonics
from facegear.machine.assembly import assembly
from facegear.machine.flank_errors import constant_errors
from facegear.machine.flanks import flank_law
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.mesh_phases import PhaseConvention, mesh_phases

HALF = np.full(10, 50e-6)


def turned(pitches, index=1):
    places = list(PLACES)
    places[index] = (*places[index][:2], pitches)
    return make_layout(tuple(places), kinematics=GEOMETRIC)


def test_the_papers_two_sets_of_angles_can_be_assembled():
    for right, left in ((45.5, 97.5), (45.0, 98.0)):
        places = [*PLACES[:2], ("right", Role.INPUT, right), ("left", Role.INPUT, left), PLACES[4]]
        found = assembly(make_layout(tuple(places), kinematics=GEOMETRIC), HALF)
        assert found.fits.all()
        assert np.abs(found.misfit).max() < 1e-12


def test_angles_printed_with_three_decimals_leave_a_few_micrometres():
    degrees = (0.0, 56.643, 114.545, 245.455, 303.357)
    places = tuple((*place[:2], d / 360.0 * 143) for place, d in zip(PLACES, degrees, strict=True))
    found = assembly(make_layout(places, kinematics=GEOMETRIC), 0.0 * HALF)
    assert found.fits.all()
    assert 1e-6 < np.ptp(found.misfit) < 2 * 4e-4 * 10.677e-3


def test_56_degrees_are_refused_with_the_misfit_and_the_nearest_angles():
    found = assembly(turned(56.0 / 360.0 * 143), HALF)
    np.testing.assert_array_equal(found.fits, [True, False, True, True, True])
    left_over = 2.0 * 56.0 / 360.0 * 143 - 44.0
    assert abs(found.misfit[1]) == pytest.approx(left_over * 10.677e-3, rel=1e-3)
    assert (found.below[1], found.above[1]) == pytest.approx((22.0, 22.5))


def test_two_pinions_mount_while_their_misfits_differ_by_at_most_four_half_backlashes():
    base_pitch = make_layout(kinematics=GEOMETRIC).base_pitch
    assert base_pitch == pytest.approx(10.677e-3, abs=1e-6)
    for misfit, fits in ((198e-6, True), (-198e-6, True), (215e-6, False)):
        found = assembly(turned(22.5 + 0.5 * misfit / base_pitch), HALF)
        assert found.fits.all() == fits


def test_a_clocked_rim_makes_any_angle_fit():
    layout = turned(22.244)
    clocking = np.array([0.0, 2.0 * 22.244 % 1.0, 0.0, 0.0, 0.0])
    found = assembly(layout, HALF, clocking)
    assert found.fits.all() and np.abs(found.misfit).max() < 1e-12
    assert found.below[1] == pytest.approx(22.244) or found.above[1] == pytest.approx(22.244)


def test_a_misfit_is_what_moving_the_pinion_would_give():
    """A pinion off its angle by d phi stands m N2 / 2 d phi aside, and its teeth with it."""
    layout = make_layout(kinematics=GEOMETRIC)
    off = 1e-3
    moved = make_machine(turned(22.5 + off), backlash=0.0)
    aside = 2.0 * np.pi * off / 143 * layout.mesh_radius
    position = np.zeros((5, 2))
    position[1, 0] = aside
    flaws = replace(perfect(layout), position=position)
    shifted = make_machine(layout, backlash=0.0, imperfections=flaws)

    def loop(machine):
        """Error between lower and upper mesh of the pinion, less that of another."""
        drive = constant_errors(machine)[:10]
        return (drive[1] - drive[6]) - (drive[2] - drive[7])

    assert loop(moved) == pytest.approx(loop(shifted), rel=1e-9)


@settings(max_examples=40, deadline=None)
@given(
    halves=st.lists(st.integers(0, 285), min_size=1, max_size=6, unique=True),
    teeth=st.integers(12, 40),
    start=st.floats(0.0, 1.0),
)
def test_phases_are_those_of_teeth_followed_one_by_one(halves, teeth, start):
    """The upper gear's teeth pass at +angle, the lower gear's at -angle; both must agree with the pinion."""
    places = tuple((f"p{i}", Role.IDLER, start + half / 2.0) for i, half in enumerate(halves))
    layout = make_layout(places, kinematics=GEOMETRIC)
    layout = replace(layout, pinion_teeth=teeth, gear_radius=layout.pinion_radius * 143 / teeth)
    phases = mesh_phases(layout, PhaseConvention.GEOMETRIC).reshape(2, -1)
    pitches = np.array([place[2] - places[0][2] for place in places])
    lower_gear = phases[0] + pitches
    upper_gear = phases[1] - pitches
    for lag in (lower_gear - lower_gear[0], upper_gear, phases[0] - phases[1] - 0.5 * teeth):
        np.testing.assert_allclose(lag - np.round(lag), 0.0, atol=1e-9)


def test_alone_the_lower_gears_teeth_come_round_the_other_way():
    places = (("a", Role.INPUT, 0.0), ("b", Role.INPUT, 10.3))
    lower, upper = (make_layout(places, (side,), kinematics=GEOMETRIC) for side in (Side.LOWER, Side.UPPER))
    behind = np.diff(mesh_phases(lower, PhaseConvention.GEOMETRIC)) % 1.0
    before = np.diff(mesh_phases(upper, PhaseConvention.GEOMETRIC)) % 1.0
    assert behind == pytest.approx(0.7) and before == pytest.approx(0.3)


def test_the_back_flank_is_the_drive_flank_run_backwards():
    stiffness = Harmonics(np.array([0.0, 3e7, -1e7]), np.array([4e8, 2e7, 5e6]))
    machine = make_machine(make_layout(kinematics=GEOMETRIC), stiffness=stiffness)
    cycles = np.linspace(0.0, 1.0, 33)
    drive, back = np.split(flank_law(machine).stiffness(cycles), 2, axis=1)
    for mesh, lag in enumerate(machine.phases):
        np.testing.assert_allclose(drive[:, mesh], stiffness(cycles - lag), rtol=1e-12)
        np.testing.assert_allclose(back[:, mesh], stiffness(lag - cycles), rtol=1e-12)
