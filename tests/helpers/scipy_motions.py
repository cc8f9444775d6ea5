"""Kicked motions of a model beside SciPy's."""

from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

from facegear.dynamics.steady_state.simulate import static_start


def kicked(model, size):
    """The static equilibrium with a random velocity."""
    start = static_start(model)
    kick = np.random.default_rng(3).normal(size=start.velocity.size)
    reach = np.abs(model.reduced.mesh_jacobian).max()
    return replace(start, velocity=size / reach * kick)


def gap_to_scipy(model, omega, right_side, start, run, phases, tolerance):
    """Largest distance, m, of a recorded motion from that of DOP853 at phases from 0 on, rad."""
    scale = np.abs(model.reduced.mesh_jacobian).max()
    found = solve_ivp(
        right_side,
        (0.0, phases[-1] / omega),
        np.concatenate([start.displacement, start.velocity]),
        "DOP853",
        phases / omega,
        rtol=tolerance,
        atol=1e-2 * tolerance / scale,
        max_step=2e-6,
    )
    return np.abs(found.y[: model.system.size].T - run.at(phases)[0]).max() * scale
