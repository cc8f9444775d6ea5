"""Motions of random machines that follow from one another: scaled, negated, mirrored."""

from dataclasses import replace

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from random_machines import FINE, frequency, kicked, machines, speeds
from recorded_motion import record
from references import against, agrees

from facegear.harmonics import Harmonics
from facegear.machine.flank_errors import mirror_series as backwards
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC, KINEMATICS, PRINTED_KINEMATICS
from facegear.machine.layout import Body, Role, Side, Tilt
from facegear.machine.linear_model import mass_diagonal
from facegear.machine.machine import OpenFlanks
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import State
from facegear.motion.steady_state.simulate import Model, build_model, static_start


@against(
    "analytic",
    "scaling of the equation of motion",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@settings(max_examples=12, deadline=None)
@given(machine=machines(), speed=speeds, factor=st.floats(0.01, 100))
def test_scaling_torques_backlash_and_error_scales_the_motion(machine, speed, factor):
    model = build_model(machine)
    start = kicked(model)
    scaled = replace(
        machine,
        torques=factor * machine.torques,
        half_backlash=factor * machine.half_backlash,
        error=machine.error.scale(factor),
        imperfections=replace(
            machine.imperfections,
            error=factor * machine.imperfections.error,
            bearing_clearance=factor * machine.imperfections.bearing_clearance,
        ),
    )
    bigger = replace(build_model(scaled).system, scale=factor * model.system.scale)
    first = record(model.system, frequency(model, speed), start, 2, FINE)
    second = record(
        bigger, frequency(model, speed), State(factor * start.displacement, factor * start.velocity), 2, FINE
    )
    phases = np.linspace(0.0, 2 * TAU, 50)
    one, two = first.at(phases)[1], second.at(phases)[1]
    agrees("deflection of a mesh, m", two / factor, one, relative=1e-7, absolute=1e-9 * model.system.scale)


@against(
    "analytic",
    "symmetry of the equation of motion",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@settings(max_examples=12, deadline=None)
@given(machine=machines(kinematics=PRINTED_KINEMATICS), speed=speeds)
def test_negated_torques_and_error_negate_the_motion(machine, speed):
    model = build_model(machine)
    start = kicked(model)
    mirrored = build_model(replace(machine, torques=-machine.torques, error=machine.error.scale(-1.0)))
    first = record(model.system, frequency(model, speed), start, 2, FINE)
    second = record(
        mirrored.system, frequency(model, speed), State(-start.displacement, -start.velocity), 2, FINE
    )
    phases = np.linspace(0.0, 2 * TAU, 50)
    agrees(
        "deflection of a mesh, m",
        second.at(phases)[1],
        -first.at(phases)[1],
        relative=1e-7,
        absolute=1e-9 * model.system.scale,
    )


def standing_on_an_edge():
    """A gear without load at rest where its flank just touches, from where only the jerk moves it."""
    layout = make_layout((("p0", Role.INPUT, 0.0),), kinematics=GEOMETRIC)
    layout = replace(
        layout,
        pinions=(replace(layout.pinions[0], body=Body(1.199, 0.002, (1e7, 1e7, 0.0))),),
        gears=tuple(replace(gear, body=Body(7.795, 0.54, (1e8,) * 3)) for gear in layout.gears),
    )
    flaws = replace(perfect(layout), bearing_clearance=np.array([1e-5]))
    swing = Harmonics(np.array([0.0, 0.0, 8.2e6]), np.array([4.1e8, 0.0, 0.0]))
    options = {"error": 0.0, "stiffness": swing, "mesh_damping": 0.0, "mass_damping": 0.0}
    return make_machine(layout, 50.0, 0.0, backlash=1.14732774e-4, imperfections=flaws, **options)


def resting_on_rings():
    """Idle pinions that stand on the rims of their play until a flank touches one, without mesh damping.

    What such a touch moves grows with the cube of time. Rounding once decided whether the ring was pressed in
    the first 1e-4 rad, which impacts magnified to 2e-9 of the length scale.
    """
    roles = (Role.INPUT, Role.TAIL, Role.IDLER, Role.INPUT, Role.TAIL, Role.IDLER)
    pitches = (117.0, 128.0, 88.5, 84.5, 62.0, 117.0)
    places = tuple((f"p{i}", *place) for i, place in enumerate(zip(roles, pitches, strict=True)))
    layout = make_layout(places, (Side.UPPER,), 1e7, 6329249313.423762, GEOMETRIC)
    tilting = tuple(replace(gear, body=replace(gear.body, tilt=Tilt(0.3, 1e7))) for gear in layout.gears)
    layout = replace(layout, gears=tilting)
    swing = Harmonics(
        np.array([0.0, 87174057.83775103, 8200000.0]), np.array([4.1e8, 43587028.918875515, 0.0])
    )
    options = {"stiffness": swing, "mesh_damping": 0.0, "mass_damping": 468.78866131223623}
    options |= {"open_flanks": OpenFlanks.CONTACT_ONLY, "backlash": 6.103515625e-05}
    flaws = replace(perfect(layout), bearing_clearance=np.full(6, 1e-5))
    error = 3.0399327968901198e-05
    return make_machine(layout, 1996.3598187060481, 0.0, error=error, imperfections=flaws, **options)


def mirrored_start(model: Model, mirrored: Model) -> State:
    """The mirror image of static equilibrium; bodies that float freely have no other way to match."""
    layout = model.machine.layout
    place = model.reduction.basis @ static_start(model).displacement
    bodies = 4 * len(layout.bodies)
    place[0:bodies:4] *= -1.0
    place[layout.spins] *= -1.0
    place[bodies + 1 :: 2] *= -1.0
    start = mirrored.reduction.basis.T @ (mass_diagonal(layout) * place)
    return State(start, np.zeros_like(start))


@against(
    "analytic",
    "mirror symmetry",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@settings(max_examples=12, deadline=None)
@given(machine=machines(kinematics=GEOMETRIC, symmetric=True), speed=speeds)
@example(machine=standing_on_an_edge(), speed=3000.0)
@example(machine=resting_on_rings(), speed=6836.269395264446)
def test_in_a_mirror_drive_and_back_flanks_change_places(machine, speed):
    """Angles, torques and the waveforms' direction mirrored; at half pitches the teeth stand as before."""
    model = build_model(machine)
    layout = machine.layout
    turned = tuple(replace(pinion, pitches=-pinion.pitches) for pinion in layout.pinions)
    mirrored = build_model(
        replace(
            machine,
            layout=replace(layout, pinions=turned),
            torques=-machine.torques,
            stiffness=backwards(machine.stiffness),
            error=backwards(machine.error),
        )
    )
    run = record(model.system, frequency(model, speed), static_start(model), 3, FINE)
    other = record(mirrored.system, frequency(mirrored, speed), mirrored_start(model, mirrored), 3, FINE)
    phases = np.linspace(0.0, 3 * TAU, 50)
    flanks = slice(0, model.system.contacts)
    drive, back = np.split(run.at(phases)[1][:, flanks], 2, axis=1)
    swapped = np.concatenate([back, drive], axis=1)
    agrees(
        "deflection of a flank, m",
        other.at(phases)[1][:, flanks],
        swapped,
        relative=1e-7,
        absolute=1e-9 * model.system.scale,
    )


@settings(max_examples=8, deadline=None)
@given(
    torque=st.floats(100, 2000),
    speed=speeds,
    backlash=st.floats(0, 2e-4),
    kinematics=st.sampled_from(list(KINEMATICS.values())),
)
def test_left_and_right_move_alike_where_the_machine_is_symmetric(torque, speed, backlash, kinematics):
    model = build_model(make_machine(make_layout(kinematics=kinematics), torque=torque, backlash=backlash))
    run = record(model.system, frequency(model, speed), static_start(model), 3, FINE)
    deflections = run.at(np.linspace(0.0, 3 * TAU, 200))[1]
    for right, left in ((1, 4), (2, 3), (6, 9), (7, 8)):
        np.testing.assert_allclose(
            deflections[:, right], deflections[:, left], atol=1e-9 * model.system.scale
        )
