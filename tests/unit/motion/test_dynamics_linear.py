"""Random machines without backlash: the linear equations with periodic coefficients, solved exactly."""

import numpy as np
from hypothesis import given, settings
from random_machines import FINE, frequency, machines, speeds
from recorded_motion import record
from references import against, agrees

from facegear.errors import NotConverged
from facegear.harmonics import Harmonics
from facegear.machine.kinematics import PRINTED_KINEMATICS
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.orbits import monodromy
from facegear.motion.steady_state.simulate import build_model, simulate


@against(
    "analytic",
    "Hill's equations solved by harmonic balance to rounding",
    capability="dynamics_response dynamics_sweep_chunk",
    module="facegear.motion.steady_state.simulate",
)
@settings(max_examples=12, deadline=None)
@given(machine=machines(kinematics=PRINTED_KINEMATICS, backlash=0.0, mass_damping=800.0), speed=speeds)
def test_without_backlash_the_response_is_hills(machine, speed):
    """Harmonic balance of the linear system with periodic k, solved to rounding in the frequency domain."""
    model = build_model(machine)
    system = model.system
    omega = frequency(model, speed)
    harmonics = 30
    size, orders = system.size, np.arange(-harmonics, harmonics + 1)
    matrix = np.zeros((orders.size * size, orders.size * size), dtype=complex)
    right = np.zeros(orders.size * size, dtype=complex)
    right[harmonics * size : (harmonics + 1) * size] = model.reduction.load
    mesh_jacobian = system.mesh_jacobian
    k = np.stack([fourier(machine.stiffness, p, harmonics) for p in machine.phases], axis=1)
    e = np.stack([fourier(machine.error, p, harmonics) for p in machine.error_phases], axis=1)
    for i, n in enumerate(orders):
        rows = slice(i * size, (i + 1) * size)
        s = 1j * n * omega
        matrix[rows, rows] += np.diag(s**2 + s * system.damping + system.omega_squared)
        matrix[rows, rows] += s * machine.damping.mesh * mesh_jacobian.T @ mesh_jacobian
        right[rows] += s * machine.damping.mesh * mesh_jacobian.T @ e[i]
        for j, other in enumerate(orders):
            if abs(n - other) <= harmonics:
                coupling = k[n - other + harmonics]
                matrix[rows, j * size : (j + 1) * size] += (mesh_jacobian.T * coupling) @ mesh_jacobian
                right[rows] += mesh_jacobian.T @ (coupling * e[j])
    solution = np.linalg.solve(matrix, right).reshape(orders.size, size)
    cycles = np.arange(64) / 64
    exact = (np.exp(2j * np.pi * np.outer(cycles, orders)) @ solution).real
    rate = (1j * omega * orders @ solution).real
    reach = np.abs(mesh_jacobian).max()
    close = 1e-9 * max(system.scale, np.abs(exact).max() * reach)
    # Started on it, the motion follows it for a period, whether it is stable or not.
    run = record(system, omega, State(exact[0], rate), 1, FINE)
    agrees(
        "motion over one period, m",
        np.abs(run.at(TAU * cycles)[0] - exact).max() * reach,
        0.0,
        absolute=close,
    )
    settings_ = Settings(tolerance=1e-14, periodic_residual=1e-12)
    try:
        response = simulate(model, speed, settings_)
    except NotConverged as grown:
        assert "beyond all bounds" in str(grown)
        response = None
    if response is not None and response.period == 1:
        agrees("steady state, m", np.abs(response.coordinates - exact).max() * reach, 0.0, absolute=close)
    else:  # only a parametric resonance keeps a motion with this damping from settling
        rest = np.zeros((2, system.size))
        matrix, _ = monodromy(Integrator(system, omega, 1e-14, 20), rest, 1)
        assert np.abs(np.linalg.eigvals(matrix)).max() > 0.97


def fourier(series: Harmonics, phase: float, harmonics: int) -> np.ndarray:
    """Complex coefficients of orders -harmonics .. harmonics of a shifted series."""
    shifted = series.shift(phase)
    result = np.zeros(2 * harmonics + 1, dtype=complex)
    for j in range(shifted.order + 1):
        value = 0.5 * (shifted.cosine[j] - 1j * shifted.sine[j])
        result[harmonics + j] += value
        result[harmonics - j] += value.conjugate()
    return result
