"""Machines whose teeth are nearly spur teeth at right angles, and whose pinions tilt."""

from dataclasses import replace
from functools import cache
from math import pi, radians

import numpy as np
import pytest
from public_casing import mount_public
from rolling_machines import S1, machine_on, public_layout
from scipy_motions import kicked
from seated_machines import make_small_machine, place_on
from wrench_machines import Teeth, flank_rows, make_layout, random_shaft, solved

import facegear
from facegear.build.machine_layout import wired_layout
from facegear.build.tooth_numbers import machine_teeth
from facegear.harmonics import Harmonics
from facegear.machine.disturbances import rigid_rotation
from facegear.machine.drive_line import DriveLine, Seat
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Body, FaceGear, Layout, Pinion, Role, Side, Tilt
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.machine import Damping, Machine, OpenFlanks
from facegear.machine.statics import mean_equilibrium
from facegear.machine.torques import balanced_torques
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.steady_state.simulate import build_model

ANGLE, MIDDLE = radians(25), 0.2625
SPUR = Teeth(23, 143, 3.75e-3, (ANGLE, ANGLE), middle=MIDDLE)
SMALL = (1e-4, 1e-6, 1e-8)


def make_near(smallness: float) -> Teeth:
    angles = ANGLE, ANGLE + smallness
    return replace(
        SPUR, angles=angles, helix=smallness, taper=smallness, shaft=pi / 2 + smallness, offset=smallness
    )


@cache
def make_machine(smallness: float, moving: bool = False) -> Machine:
    """Two pinions on shafts that bend between two gears that tilt; 0 is the machine with spur teeth."""
    shaft = random_shaft(np.random.default_rng(12))
    across = np.linalg.inv(shaft.compliance[:2, :2])
    bearing = Body(1.2, 0.002, (across[0, 0], across[1, 1], 1.0 / shaft.compliance[2, 2]), across[0, 1])
    pinions = Pinion("in", Role.INPUT, 0.0, bearing), Pinion("idler", Role.IDLER, 50.5, bearing)
    gears = tuple(
        FaceGear(side, Body(8.0, 0.5, (2e9, 2e9, 1e9), 0.0, Tilt(0.3, 2e7, 0.01)))
        for side in (Side.LOWER, Side.UPPER)
    )
    if smallness == 0.0:
        arm = SPUR.pitch_radius * np.cos(ANGLE)
        layout = Layout(pinions, gears, 23, 143, ANGLE, arm, arm * 143 / 23, GEOMETRIC, middle=MIDDLE)
    else:
        layout = make_layout(make_near(smallness), pinions, gears)
    seats = {number: Seat(shaft, 1.5e-3) for number in (0, 1)}
    return Machine(
        layout=layout,
        torques=balanced_torques(layout, np.array([800.0, 0.0])),
        stiffness=Harmonics(np.array([0.0, 6e7]), np.array([4e8, 0.0])),
        error=Harmonics(np.array([0.0, 0.0]), np.array([0.0, 4e-6])),
        half_backlash=np.full(4, 8e-6),
        damping=Damping(800.0, 300.0, 1e-6, OpenFlanks.CONTACT_ONLY),
        imperfections=perfect(layout),
        drive_line=DriveLine(layout, seats, {}),
        has_phase_shifts=moving,
    )


def without_common_rotation(machine: Machine, moved: np.ndarray) -> np.ndarray:
    """Motions of all coordinates as lengths, without the rotation that nothing resists."""
    rotation = rigid_rotation(machine.layout, machine.linear, machine.drive_line)
    return (moved - rotation * (rotation @ moved) / (rotation @ rotation)) * machine.linear.lengths


def placed_at_rest(machine: Machine) -> np.ndarray:
    return without_common_rotation(machine, mean_equilibrium(machine).displacements[0])


def squared_frequencies(machine: Machine) -> np.ndarray:
    return loaded_modes(machine).frequencies ** 2


def moved_after_a_period(machine: Machine) -> np.ndarray:
    model = build_model(machine)
    integrator = Integrator(model.system, 2 * pi * 1900.0, tolerance=1e-13)
    still = kicked(build_model(make_machine(0.0)), 0.05)
    spur = build_model(make_machine(0.0)).reduction.basis
    # The same place and speed of all bodies, in the coordinates of either machine.
    to_own = model.reduction.basis.T @ machine.linear.mass @ spur
    start = np.array([to_own @ still.displacement, to_own @ still.velocity / integrator.frequency])
    return without_common_rotation(machine, model.reduction.basis @ integrator.run(start, 1).state[0])


def test_a_config_with_a_face_says_where_spur_pinions_stand():
    values = facegear.load("config/paper.yaml").values
    places = {}
    for name, section in (("face", values["tooth_pair"]), ("machine", machine_teeth(values["tooth_pair"]))):
        places[name] = wired_layout(values["transmission"], section).pinion_middle
    assert places == {"face": pytest.approx(0.2625), "machine": pytest.approx(0.2625)}
    teeth = {**values["tooth_pair"], "pinion": None, "face_gear": None}
    bare = wired_layout(values["transmission"], teeth)
    assert bare.pinion_middle == bare.mesh_radius and not bare.meshes_tilt_pinions


@pytest.mark.parametrize(
    ("answer", "moving"),
    [
        (placed_at_rest, False),
        (squared_frequencies, False),
        (moved_after_a_period, False),
        (moved_after_a_period, True),
    ],
)
def test_answers_of_nearly_spur_machines_differ_in_proportion(answer, moving):
    spur = answer(make_machine(0.0, moving))
    apart = [(answer(make_machine(small, moving)) - spur) / small for small in SMALL]
    size = np.abs(apart[1]).max()
    assert size > 1e-3 * np.abs(spur).max()
    assert np.abs(apart[0] - apart[1]).max() < 0.02 * size
    assert np.abs(apart[2] - apart[1]).max() < 0.02 * size


def test_spur_pinions_that_tilt_feel_the_whole_wrench_of_their_meshes():
    machine = make_machine(0.0)
    layout, rows = machine.layout, machine.linear.rows
    tilts = rows[:, machine.drive_line.tilts(0)]
    lever = layout.mesh_radius - MIDDLE
    for flank in (0, 4):
        for mesh, sign in ((0, -1.0), (2, 1.0)):
            side = 1.0 if flank == 0 else -1.0
            expected = lever * np.array([-sign * np.sin(ANGLE), side * sign * np.cos(ANGLE)])
            np.testing.assert_allclose(tilts[flank + mesh], expected, rtol=1e-12)


def test_spur_machines_with_tilts_stand_as_the_independent_model_says():
    machine = replace(
        make_machine(0.0),
        stiffness=Harmonics(np.zeros(1), np.array([4e8])),
        error=Harmonics(*np.zeros((2, 1))),
    )
    _, forces = solved(machine, SPUR)
    found = mean_equilibrium(machine)
    np.testing.assert_allclose(machine.linear.rows, flank_rows(machine, SPUR), rtol=0.0, atol=1e-14)
    assert np.abs(found.flank_forces[0] - forces).max() < 1e-9 * forces.max()


def on_rolling_bearings(layout: Layout) -> np.ndarray:
    machine = machine_on({0: S1, 2: S1}, layout=layout, tilt_inertias={0: 1.5e-3, 2: 1.5e-3})
    return without_common_rotation(machine, mean_equilibrium(machine).displacements[0])


def on_a_casing(layout: Layout) -> np.ndarray:
    machine = make_small_machine(layout, place_on(mount_public(0), layout))
    moved = mean_equilibrium(machine).displacements[0]
    return without_common_rotation(machine, moved)


SMALL_TEETH = Teeth(20, 60, 3e-3, (ANGLE, ANGLE), middle=0.085)


@pytest.mark.parametrize("answer", [on_rolling_bearings, on_a_casing])
def test_nearly_spur_pinions_on_rolling_bearings_and_casings_stand_in_proportion(answer):
    spur = replace(public_layout(), middle=SMALL_TEETH.middle)

    def apart_from_spur(small: float) -> np.ndarray:
        angles = ANGLE, ANGLE + small
        teeth = replace(
            SMALL_TEETH, angles=angles, helix=small, taper=small, shaft=pi / 2 + small, offset=small
        )
        return (answer(make_layout(teeth, spur.pinions, spur.gears)) - answer(spur)) / small

    apart = [apart_from_spur(small) for small in SMALL]
    size = np.abs(apart[1]).max()
    assert np.abs(apart[0] - apart[1]).max() < 0.02 * size
    assert np.abs(apart[2] - apart[1]).max() < 0.02 * size
    at_meshes = answer(public_layout())
    assert np.abs(answer(spur) - at_meshes).max() > 1e-3 * np.abs(at_meshes).max()
