"""Order of the integrator with and without contact switches, and of the multipliers."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from lumped_machines import make_machine

from facegear._kernels import motion
from facegear.machine.machine import mesh_frequency
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings
from facegear.motion.steady_state.orbits import monodromy
from facegear.motion.steady_state.simulate import build_model, simulate

FINE = Settings(tolerance=1e-14, periodic_residual=1e-10)


def errors(order, backlash):
    """Step length, error of the end state and of the multipliers after a period, over a ladder of
    tolerances.
    """
    model = build_model(make_machine(torque=1500.0, backlash=backlash, error=30e-6))
    speed = 9000.0
    state = simulate(model, speed, FINE).state
    omega = TAU * mesh_frequency(model.machine.layout, speed)

    def end(p, tolerance):
        integrator = Integrator(model.system, omega, tolerance, p)
        matrix, run = monodromy(integrator, integrator.by_phase(state), 1)
        largest = np.sort(np.abs(np.linalg.eigvals(matrix)))[::-1][:6]
        return integrator.mesh_jacobian @ run.state[0] / integrator.scale, largest, run.steps, run.fractions

    exact, multipliers, _, shares = end(20, 1e-15)
    rows = []
    for tolerance in 10.0 ** -np.arange(5.0, 10.5, 0.5):
        found, largest, steps, _ = end(order, tolerance)
        rows.append((TAU / steps, np.abs(found - exact).max(), np.abs(largest - multipliers).max()))
    return np.array(rows), shares


@pytest.mark.parametrize("order", [4, 6])
@pytest.mark.parametrize("backlash", [0.0, 100e-6])
def test_error_falls_with_the_order_of_the_steps_even_across_switches(order, backlash):
    rows, shares = errors(order, backlash)
    assert (shares[0].max() > 0.0) == (backlash > 0.0)
    rows = rows[rows[:, 1:].min(axis=1) > 3e-13]
    assert len(rows) >= 5
    length, error, multiplier = np.log(rows).T
    # The velocity is the derivative of a polynomial of degree p, so the method has order p - 1.
    assert np.polyfit(length, error, 1)[0] > order - 1.2
    assert np.polyfit(length, multiplier, 1)[0] > order - 1.2


@settings(max_examples=200, deadline=None)
@given(st.lists(st.floats(-1, 1), min_size=3, max_size=12), st.floats(0.01, 0.99))
@example([-0.5, 1.0, 1.0], 0.5)  # a later root where an interval is halved
@example([0.63, -1.6, 1.0], 0.5)  # the first root there
@example([1.5, -3.5, 1.0], 0.5)
@example([-0.5, 1.0, 0.3319332765330668], 0.5)  # zero there but for rounding
def test_first_root_is_the_first_sign_change(coefficients, root):
    polynomial = np.polynomial.Polynomial(coefficients) * np.polynomial.Polynomial([-root, 1.0])
    values = np.zeros(20)
    values[: polynomial.coef.size] = polynomial.coef
    found = motion.first_root(values)
    grid = np.linspace(0.0, 1.0, 20_001)
    signs = np.sign(polynomial(grid))
    flips = np.flatnonzero(signs[1:] * signs[:-1] < 0)
    size = np.abs(values).sum()
    if found <= 1.0:
        assert abs(polynomial(found)) <= 1e-12 * size
    if flips.size and np.abs(polynomial(grid[: flips[0] + 1])).min() > 1e-9 * size:
        assert found == pytest.approx(grid[flips[0]], abs=1e-4)


@pytest.mark.parametrize(
    ("coefficients", "root"), [([-0.2, 0.7, -1.0], 0.25), ([-0.4, 0.5, -1.0], 0.5), ([-0.6, 0.4, 0.6], 0.5)]
)
def test_a_zero_where_an_interval_is_halved_is_found_whatever_sign_rounding_gives_it_on_each_side(
    coefficients, root
):
    polynomial = np.polynomial.Polynomial(coefficients) * np.polynomial.Polynomial([-root, 1.0])
    found = motion.first_root(polynomial.coef)
    assert found == pytest.approx(root, abs=1e-12)


def test_a_root_is_found_after_many_places_where_the_polynomial_nearly_touches_zero():
    """Each such place is halved down to its width, and the search goes on beside it with long intervals."""
    polynomial = np.polynomial.Polynomial.fromroots([0.91, 0.97])
    for place in (0.13, 0.29, 0.47, 0.61, 0.83):
        polynomial *= np.polynomial.Polynomial([place**2 + 3e-9, -2.0 * place, 1.0])
    assert motion.first_root(polynomial.coef) == pytest.approx(0.91, abs=1e-7)
