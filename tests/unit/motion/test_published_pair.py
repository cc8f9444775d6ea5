"""A published pair with clearance: equation of Antoniadou et al. 2015, numbers of Climaco et al. 2023.

x'' + 2 z x' + K(t) B(x) = F_m + sum of F_j (j w)^2 cos(j w t), B the dead zone of half-width 1, x in half
backlashes and t in 1 / sqrt(k / m). The paper's own list of numbers could not be had. These are those of a
public program that follows it (github.com/Fraunhofer-SCAI/mrDMD-damage-detection), without a crack and in
steady wind. It cannot see bearings, nor a second mesh.
"""

from dataclasses import replace

import numpy as np
from lumped_machines import make_layout, make_machine
from recorded_motion import record
from references import against, agrees
from scipy.integrate import solve_ivp

from facegear.harmonics import Harmonics
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.machine import OpenFlanks
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.simulate import build_model

INERTIA, MASS, RADIUS, TEETH = 0.00115, 0.23, 0.05, 16
"""Inertia of each gear, kg m2, mass of both on the line of action, kg, base radius, m, and teeth."""
STIFFNESS, HALF = 3.8e8, 1e-4
"""Mean mesh stiffness, N/m, and half backlash, m."""
RATIO, FREQUENCY, MEAN_FORCE = 0.05, 0.5, 0.1
"""Damping ratio, mesh frequency over the natural one, and mean force over stiffness times half backlash."""
ERRORS, VARIATION = (0.01, 0.004, 0.002), (0.2, 0.1, 0.05)
"""Harmonics of the transmission error over half the backlash, and of minus the stiffness over its mean."""
PERIODS = 80
"""Mesh periods: five turns, as in the program."""
RIGID = 1e14
NATURAL = np.sqrt(STIFFNESS / MASS)
PHASES = np.linspace(0.0, PERIODS * TAU, 32 * PERIODS, endpoint=False)


def published_pair():
    """Build the two equal gears on rigid bearings."""
    layout = make_layout((("pinion", Role.INPUT, 0.0),), (Side.UPPER,), RIGID, RIGID, GEOMETRIC)
    bodies = [replace(part.body, inertia=INERTIA) for part in (layout.pinions[0], layout.gears[0])]
    layout = replace(
        layout,
        pinions=(replace(layout.pinions[0], body=bodies[0]),),
        gears=(replace(layout.gears[0], body=bodies[1]),),
        pinion_teeth=TEETH,
        gear_teeth=TEETH,
        pinion_radius=RADIUS,
        gear_radius=RADIUS,
    )
    machine = make_machine(
        layout,
        torque=MEAN_FORCE * STIFFNESS * HALF * RADIUS,
        tail_share=0.0,
        backlash=2.0 * HALF,
        stiffness=Harmonics(np.zeros(4), STIFFNESS * np.array([1.0, *(-part for part in VARIATION)])),
        mesh_damping=2.0 * RATIO * MASS * NATURAL,
        mass_damping=0.0,
        bearing_damping=0.0,
        open_flanks=OpenFlanks.MESH_DEFLECTION,
    )
    return replace(machine, error=Harmonics(np.zeros(4), HALF * np.array([0.0, *ERRORS])))


def computed_deflection():
    """Return the deflection (samples,) over half the backlash, from rest in the middle of the backlash."""
    model = build_model(published_pair())
    machine = model.machine
    standing = np.zeros(machine.linear.size)
    standing[machine.torque_coordinates[0]] = machine.error(np.zeros(1))[0] / RADIUS
    displacement = model.reduction.basis.T @ machine.linear.momentum(standing)
    start = State(displacement, np.zeros_like(displacement))
    run = record(model.system, FREQUENCY * NATURAL, start, PERIODS, Settings(tolerance=1e-12))
    assert (run.states == 0).any() and (run.states == 1).any(), "contact is lost"
    return (model.reduction.mesh_jacobian[0] @ run.at(PHASES)[0].T - machine.error(PHASES / TAU)) / HALF


def published_deflection():
    """Return the same of the published equation by DOP853."""
    orders = np.arange(1, 4)
    shaken = np.array(ERRORS) * (orders * FREQUENCY) ** 2

    def right(t, z):
        cosines = np.cos(orders * FREQUENCY * t)
        dead = max(z[0] - 1.0, 0.0) + min(z[0] + 1.0, 0.0)
        stiffness = 1.0 - np.dot(VARIATION, cosines)
        return [z[1], MEAN_FORCE + np.dot(shaken, cosines) - 2.0 * RATIO * z[1] - stiffness * dead]

    times = PHASES / FREQUENCY
    return solve_ivp(
        right, (0.0, times[-1]), [0.0, 0.0], "DOP853", times, rtol=1e-11, atol=1e-13, max_step=0.1
    ).y[0]


def test_mass_on_the_line_of_action_is_the_published_one():
    linear = published_pair().linear
    turns = np.diagonal(linear.stiffness) == 0.0
    mass = 1.0 / (linear.rows[0] ** 2 / np.diagonal(linear.mass))[turns].sum()
    np.testing.assert_allclose(mass, MASS, rtol=1e-12)


@against(
    "third-party program",
    "SciPy's DOP853, the pair with clearance of Antoniadou et al. 2015 in the numbers of Climaco et al. 2023",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_a_published_pair_with_clearance_moves_as_scipy_says():
    computed, published = computed_deflection(), published_deflection()
    largest = np.abs(published).max()
    agrees("deflection over 80 mesh periods, half backlashes", computed, published, absolute=1e-4 * largest)
