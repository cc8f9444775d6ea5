"""A second law of contact, known to the tests alone, through statics, motion, tangents and multipliers.

c x^1.5 has closed forms (quadrature to 12 digits) for its free period; the forced orbits were found by
high-order Taylor series and confirmed by DOP853 with located events.
"""

from dataclasses import replace

import numpy as np
import pytest
from law_oscillators import closing_error, law_period_map, orbit, oscillator
from lumped_machines import make_layout, make_machine
from references import against, agrees
from whole_branches import branch_at

from facegear.machine.kinematics import GEOMETRIC, PRINTED_KINEMATICS
from facegear.machine.layout import Role, Side
from facegear.machine.linear_model import bearing_diagonal, flank_jacobian, mass_diagonal
from facegear.machine.machine import mesh_frequency
from facegear.machine.statics import static_equilibrium
from facegear.meshing.power import PowerLaw
from facegear.motion.branches.continuation import ContinuationSettings
from facegear.motion.branches.special import Kind
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Settings
from facegear.motion.steady_state.orbits import monodromy
from facegear.motion.steady_state.simulate import simulate

C, N = 2.4e11, 1.5


@against(
    "analytic",
    "period of an oscillator with a power law",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@pytest.mark.parametrize(
    ("start", "period", "least"),
    [(1.60460120203, 5.229541362450, 0.32387905595), (1.5, 5.1936418419845, 0.45296577331444)],
)
def test_a_body_on_a_power_law_swings_with_the_period_of_the_closed_form(start, period, least):
    agrees(
        "distance from the start after a period",
        closing_error(PowerLaw(), start, period, least),
        0.0,
        absolute=3e-11,
    )


@against(
    "analytic",
    "period of an oscillator with a power law and flight",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_a_body_that_leaves_contact_returns_on_time_the_better_the_earlier_the_power_law_begins():
    start, period, least = 2.0, 5.6280728407732, -0.26274169979695
    errors = [closing_error(PowerLaw(level=level), start, period, least) for level in (0.16, 0.04, 0.01)]
    assert (np.array(errors[:-1]) > 16.0 * np.array(errors[1:])).all()
    agrees(
        "distance from the start after a period",
        closing_error(PowerLaw(level=1e-4), start, period, least),
        0.0,
        absolute=1e-9,
    )


def test_the_motion_keeps_its_order_where_it_passes_the_level_of_a_law():
    """A level that was not located would leave a jump in the motion's fourth derivative inside the steps."""
    law, state = PowerLaw(level=0.5), np.array([[2.0], [0.0]])
    exact = Integrator(oscillator(law), 1.1, 1e-15).run(state, 2).state
    rows = []
    for tolerance in 10.0 ** -np.arange(6.0, 12.0):
        run = Integrator(oscillator(law), 1.1, tolerance, 9).run(state, 2)
        rows.append((1.0 / run.steps, np.abs(run.state - exact).max()))
    length, error = np.log(rows).T
    assert np.polyfit(length, error, 1)[0] > 7.5


@against(
    "second implementation",
    "power law of force: closed form and Taylor series of high order",
    capability="branches",
    module="facegear.motion.branches.points",
)
def test_an_unstable_orbit_that_loses_contact_has_the_multipliers_of_the_power_law():
    """Damping .02, load 1 + .1 cos W t, W 1.1; the place is the reference's as well."""
    period_map = law_period_map(PowerLaw(level=1e-4), 0.02, 0.1)
    found = orbit(period_map, 1.1, 1.79379722656, 0.68475098448)
    agrees(
        "multipliers of the unstable orbit",
        np.sort(found.multipliers.real),
        [0.51611544, 1.54179196],
        absolute=8e-9,
    )
    place = period_map.state(found.z, found.u)
    agrees("displacement of the unstable orbit", place.displacement[0], 1.79379722656, absolute=2e-11)
    agrees("velocity of the unstable orbit", place.velocity[0], 0.68475098448, absolute=2e-11)
    agrees(
        "product of the multipliers",
        found.multipliers.prod().real,
        np.exp(-0.04 * 2 * np.pi / 1.1),
        relative=1e-9,
    )


def test_a_parametric_power_law_doubles_its_period_where_the_taylor_series_say():
    """Damping .03, depth .25, no other load."""
    for speed in (2.28318159363, 2.60138748211):
        found = orbit(law_period_map(PowerLaw(depth=0.25), 0.03), speed, 1.0, 0.0)
        assert found.multipliers.real.min() == pytest.approx(-1.0, abs=1e-8)


@against(
    "second implementation",
    "power law of force: closed form and Taylor series of high order",
    capability="branches",
    module="facegear.motion.branches.continuation",
)
def test_a_branch_on_the_power_law_folds_while_it_keeps_contact():
    """Damping .02, load 1 + .1 cos W t: no linear law has a fold without a loss of contact."""
    branch = branch_at(
        law_period_map(PowerLaw(), 0.02, 0.1, 1e-11),
        np.array([1.2, 0.0]),
        1.0,
        ContinuationSettings(0.95, 1.2),
    )
    folds = [special.point for special in branch.of(Kind.FOLD)]
    agrees("speed of the fold", [point.value for point in folds], [1.13889845103], relative=1e-9)
    agrees("amplitude at the fold", folds[0].extrema[0, 1].max(), 0.267231, absolute=1e-5)


def test_tangents_of_the_law_are_differences_of_its_motions():
    integrator = Integrator(oscillator(PowerLaw(level=0.2), 0.02, 0.1), 1.1, 1e-14)
    start = np.array([[2.2], [0.1]])
    matrix, run = monodromy(integrator, start, 1)
    assert 0.0 < run.fractions[0, 0] < 1.0
    for column in range(2):
        shift = np.zeros((2, 1))
        shift[column] = 1e-5
        ends = [integrator.run(start + sign * shift, 1, fine=True).state for sign in (1.0, -1.0)]
        np.testing.assert_allclose(matrix[:, column], (ends[0] - ends[1]).ravel() / 2e-5, atol=1e-7)


def one_mesh(kinematics=GEOMETRIC, torque=600.0, flanks=2):
    layout = make_layout((("engine", Role.INPUT, 0.0),), (Side.UPPER,), kinematics=kinematics)
    machine = make_machine(layout, torque, 0.0, error=0.0)
    return replace(machine, law=PowerLaw(C, N, 2e-6, contacts=flanks, largest=4e-4))


@against(
    "analytic",
    "inverse of the power law",
    capability="load_sharing_reference",
    module="facegear.machine.statics",
)
@pytest.mark.parametrize("torque", [60.0, 600.0, 3000.0])
def test_statics_press_a_mesh_in_by_the_inverse_of_its_law(torque):
    machine = one_mesh(torque=torque)
    found = static_equilibrium(machine)
    force = torque / machine.layout.pinion_arm
    agrees("mesh force, N", found.forces[0], force, relative=1e-11)
    amount = (flank_jacobian(machine.layout) @ found.displacements)[0] - machine.half_backlash[0]
    agrees("deflection, m", amount, (force / C) ** (1.0 / N), relative=1e-10)


@pytest.mark.parametrize("torque", [600.0, -600.0])
def test_statics_on_one_line_of_action_take_the_law_on_both_flanks(torque):
    machine = one_mesh(PRINTED_KINEMATICS, torque, 1)
    found = static_equilibrium(machine)
    force = torque / machine.layout.pinion_arm
    assert found.forces[0] == pytest.approx(force, rel=1e-9)
    amount = abs(found.deflections[0]) - machine.half_backlash[0]
    assert amount == pytest.approx((abs(force) / C) ** (1.0 / N), rel=1e-9)


def test_a_machine_at_rest_on_a_law_answers_disturbances_with_its_local_stiffness():
    """Multipliers against the eigenvalues of M, C and K with n F / x, half as much again as F / x."""
    machine, speed = one_mesh(), 7000.0
    response = simulate(machine, speed, Settings(tolerance=1e-12, periodic_residual=1e-10))
    assert response.label == "period-1"
    force = 600.0 / machine.layout.pinion_arm
    np.testing.assert_allclose(response.forces[:, 0], force, rtol=1e-8)
    local = N * force / (force / C) ** (1.0 / N)
    mass, bearing = mass_diagonal(machine.layout), bearing_diagonal(machine.layout)
    directions = flank_jacobian(machine.layout)
    dampers = 0.5 * machine.damping.mesh * directions.T @ directions
    own = np.diag(machine.damping.mass * mass + machine.damping.bearing * bearing)
    stiffness = np.diag(bearing) + local * np.outer(directions[0], directions[0])
    size = mass.size
    matrix = np.zeros((2 * size, 2 * size))
    matrix[:size, size:] = np.eye(size)
    matrix[size:, :size], matrix[size:, size:] = -stiffness / mass[:, None], -(own + dampers) / mass[:, None]
    exact = np.exp(np.linalg.eigvals(matrix) / mesh_frequency(machine.layout, speed))
    for multiplier in response.multipliers:
        assert np.abs(exact - multiplier).min() < 1e-7 * np.abs(exact).max()
