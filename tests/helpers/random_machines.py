"""Random lumped machines with their speeds, and a start that opens contacts."""

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine

from facegear.harmonics import Harmonics
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import KINEMATICS, PRINTED_KINEMATICS
from facegear.machine.layout import Role, Side, Tilt
from facegear.machine.machine import OpenFlanks, mesh_frequency
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.simulate import Model, static_start

FINE = Settings(tolerance=1e-14)


@st.composite
def machines(draw, **fixed):
    """One to six pinions at half-pitch places between one or two face gears.

    Geometric ones may tilt, have play in their bearings and errors in every mesh.
    """
    count = draw(st.integers(1, 6))
    places = []
    for i in range(count):
        role = Role.INPUT if i == 0 else draw(st.sampled_from(list(Role)))
        places.append((f"p{i}", role, draw(st.integers(0, 285)) / 2.0))
    sides = draw(st.sampled_from([(Side.LOWER, Side.UPPER), (Side.UPPER,)]))
    kinematics = fixed.pop("kinematics", None) or draw(st.sampled_from(list(KINEMATICS.values())))
    bearings = draw(st.floats(1e7, 1e9)), draw(st.floats(1e8, 1e10))
    layout = make_layout(tuple(places), sides, *bearings, kinematics)
    swing = draw(st.floats(0.0, 0.25))
    options = {
        "torque": draw(st.floats(50, 2000)),
        # Smaller shares may be refused: `test_next_to_no_torque_against_a_ring_...` of the statics.
        "tail_share": draw(st.one_of(st.just(0.0), st.floats(1e-6, 0.3))),
        "backlash": draw(st.floats(2e-5, 2e-4)),
        "error": draw(st.floats(0, 8e-5)),
        "stiffness": Harmonics(4.1e8 * np.array([0, swing, 0.02]), 4.1e8 * np.array([1.0, 0.5 * swing, 0.0])),
        "mesh_damping": draw(st.floats(0, 5000)),
        "mass_damping": draw(st.floats(0, 2000)),
        "open_flanks": draw(st.sampled_from(list(OpenFlanks))),
    }
    symmetric = fixed.pop("symmetric", False)
    if kinematics is PRINTED_KINEMATICS:
        return make_machine(layout, **(options | fixed))
    if draw(st.booleans()):
        tilt = Tilt(0.3, draw(st.floats(1e6, 1e8)))
        gears = tuple(replace(gear, body=replace(gear.body, tilt=tilt)) for gear in layout.gears)
        layout = replace(layout, gears=gears)
    error = np.zeros(len(layout.meshes)) if symmetric else np.array([draw(ERRORS) for _ in layout.meshes])
    clearance = draw(st.sampled_from([0.0, 1e-5, 5e-5]))
    flaws = replace(perfect(layout), error=error, bearing_clearance=np.full(count, clearance))
    return make_machine(layout, **(options | fixed), imperfections=flaws)


ERRORS = st.floats(-2e-5, 2e-5)


speeds = st.floats(3000, 20_000)


def frequency(model: Model, speed: float) -> float:
    return TAU * mesh_frequency(model.machine.layout, speed)


def kicked(model: Model, seed: int = 0) -> State:
    """Static equilibrium with a random velocity that opens contacts within a period."""
    start = static_start(model)
    kick = np.random.default_rng(seed).normal(size=start.velocity.size)
    reach = np.abs(model.reduction.mesh_jacobian).max()
    return replace(start, velocity=0.5 * model.system.scale / reach * kick * 2e3)
