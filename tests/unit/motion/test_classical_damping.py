"""One damper on the mesh deflection as a whole, as in the equation of Kahraman and Singh (1990)."""

from functools import cache

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from recorded_motion import record
from references import against, agrees
from scipy.integrate import solve_ivp

from facegear.harmonics import Harmonics
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.machine import OpenFlanks, mesh_frequency
from facegear.machine.shaft_orders import loaded_machine
from facegear.machine.turning_modes import machine_at_speeds
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model, static_start

SPEED, HALF, ERROR, DAMPER, PERIODS = 9000.0, 50e-6, 20e-6, 3000.0, 12
PHASES = np.linspace(0.0, PERIODS * TAU, 64 * PERIODS, endpoint=False)
STIFFNESS = Harmonics(np.array([0.0, 2e7]), np.array([4.1e8, 3e7]))
RIGID = 1e14


def single_pair(open_flanks):
    """Return one pinion on one gear, both held by bearings that hardly give way."""
    layout = make_layout(
        (("pinion", Role.INPUT, 0.0),),
        (Side.UPPER,),
        pinion_bearing=RIGID,
        gear_bearing=RIGID,
        kinematics=GEOMETRIC,
    )
    return make_machine(
        layout,
        torque=800.0,
        tail_share=0.0,
        backlash=2 * HALF,
        error=ERROR,
        stiffness=STIFFNESS,
        mesh_damping=DAMPER,
        mass_damping=0.0,
        bearing_damping=0.0,
        open_flanks=open_flanks,
    )


def deflection(open_flanks):
    """Return the deflection (samples,) of the drive flank, m, from rest in the static equilibrium."""
    model = build_model(single_pair(open_flanks))
    omega = TAU * mesh_frequency(model.machine.layout, SPEED)
    run = record(model.system, omega, static_start(model), PERIODS, Settings(tolerance=1e-12))
    deflections = model.reduction.mesh_jacobian[0] @ run.at(PHASES)[0].T
    return deflections - model.machine.error.shift(float(model.machine.error_phases[0]))(PHASES / TAU)


@cache
def published_deflection():
    """Return the same of m d'' + c d' + k(t) max(d - b, 0) = F - m e'' by DOP853; d = x - e."""
    machine = single_pair(OpenFlanks.MESH_DEFLECTION)
    linear, omega = machine.linear, TAU * mesh_frequency(machine.layout, SPEED)
    turns = np.diagonal(linear.stiffness) == 0.0
    mass = 1.0 / (linear.rows[0] ** 2 / np.diagonal(linear.mass))[turns].sum()
    force = machine.torques[0] / machine.layout.pinion_arm
    error, lag = machine.error.shift(float(machine.error_phases[0])), machine.phases[0]
    assert not error.sine.any() and not lag

    def right(t, z):
        k = float(STIFFNESS(omega * t / TAU))
        bend = -(omega**2) * ERROR * np.cos(omega * t)
        return [z[1], (force - DAMPER * z[1] - k * max(z[0] - HALF, 0.0)) / mass - bend]

    start = [deflection(OpenFlanks.MESH_DEFLECTION)[0], 0.0]
    times = PHASES / omega
    return solve_ivp(
        right, (0.0, times[-1]), start, "DOP853", times, rtol=1e-11, atol=1e-16, max_step=1e-6
    ).y[0]


@against(
    "analytic",
    "the equation of Kahraman and Singh (1990), integrated by SciPy's DOP853",
    capability="dynamics_response",
    module="facegear.machine.flanks",
)
def test_one_damper_for_each_mesh_moves_a_single_pair_as_published():
    published = published_deflection()
    assert (published < HALF).any() and (published > -HALF).all(), "contact is lost, backs stay apart"
    computed, largest = 1e6 * deflection(OpenFlanks.MESH_DEFLECTION), np.abs(published).max()
    agrees("deflection over 12 mesh periods, um", computed, 1e6 * published, absolute=30.0 * largest)


def test_half_of_the_damper_on_each_flank_is_another_motion():
    missed = np.abs(deflection(OpenFlanks.ALWAYS) - published_deflection()).max()
    assert missed > 1e-3 * np.abs(published_deflection()).max()


@pytest.mark.parametrize(
    ("open_flanks", "shares"),
    [
        (OpenFlanks.MESH_DEFLECTION, (1.0, 0.0)),
        (OpenFlanks.ALWAYS, (0.5, 0.5)),
        (OpenFlanks.CONTACT_ONLY, (1.0, 0.0)),
    ],
)
def test_modes_and_shaft_orders_have_the_dampers_of_the_motion(open_flanks, shares):
    machine = single_pair(open_flanks)
    loaded = loaded_machine(machine)
    np.testing.assert_array_equal(loaded.dampers, DAMPER * np.array(shares))
    damping = machine.linear.damping + (loaded.dampers * machine.linear.rows.T) @ machine.linear.rows
    turns = np.diagonal(machine.linear.stiffness) == 0.0
    mode = machine_at_speeds(machine, [SPEED])[0]
    mass, row = np.diagonal(machine.linear.mass)[turns], machine.linear.rows[0, turns]
    shape = row / mass
    expected = shape @ damping[np.ix_(turns, turns)] @ shape / (shape @ (mass * shape))
    slowest = np.argmin(np.abs(mode.exponents))
    assert -2.0 * mode.exponents[slowest].real == pytest.approx(expected, rel=1e-4)
