"""DOP853 of SciPy on the equations in plain NumPy follows the motion on the load-dependent law."""

from dataclasses import replace

import numpy as np
import pytest
from force_tables import power_table
from lumped_machines import PLACES, make_layout, make_machine
from references import against, agrees
from scipy.integrate import solve_ivp

from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Side
from facegear.machine.machine import FlankTables, mesh_frequency
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.steady_state.simulate import build_model, static_start
from validation.dynamics.right_side import plain_right_side

pytestmark = pytest.mark.xdist_group("load_dependent")  # its compiled motion is that of other tests

SAMPLES = 16
TOLERANCES = (1e-3, 1e-6, 1e-10)
"""Three points of the work-precision diagram."""


@pytest.fixture(scope="module")
def model():
    """Two inputs and an idler between two gears; a table of x^1.5 that changes by a tenth over the pitch."""
    table = power_table(6, 0.1, 8e-6, 1.2e-4, 6e10)
    layout = make_layout(PLACES[1:4], (Side.UPPER, Side.LOWER), kinematics=GEOMETRIC)
    machine = make_machine(layout, 700.0, 0.0, error=0.0)
    return build_model(replace(machine, tables=2 * (FlankTables(table, table),)))


@against(
    "third-party program",
    "DOP853 of SciPy on the equations written plainly with NumPy",
    capability="dynamics_response mesh_law",
    module="facegear.meshing.load_dependent",
)
@pytest.mark.parametrize("speed", [4000.0, 8000.0, 12000.0])
def test_dop853_follows_the_same_motion_through_the_levels_of_the_table(model, speed):
    system, frequency = model.system, TAU * mesh_frequency(model.machine.layout, speed)
    runs = [Integrator(system, frequency, tolerance) for tolerance in TOLERANCES]
    start = runs[-1].run(runs[-1].by_phase(static_start(model)), 4).state
    exact = (
        solve_ivp(
            plain_right_side(system, frequency),
            (0.0, TAU),
            start.ravel(),
            "DOP853",
            t_eval=TAU * np.arange(SAMPLES) / SAMPLES,
            rtol=1e-12,
            atol=1e-13 * np.abs(start).max(),
        )
        .y[: system.size]
        .T
    )
    moved = (exact @ system.mesh_jacobian.T).max(axis=0) - system.upper
    assert np.ptp(exact @ system.mesh_jacobian.T, axis=0).max() > 1e-6
    assert moved.max() < 1.2e-4
    found = [
        np.abs(run.run(start, 1, samples=SAMPLES).samples - exact).max() / np.abs(exact).max() for run in runs
    ]
    assert found[0] > 3.0 * found[1] > 9.0 * found[2]
    for tolerance, error in zip(TOLERANCES, found, strict=True):
        agrees(f"motion at tolerance {tolerance:g}, scaled", error, 0.0, absolute=max(tolerance, 1e-10))
