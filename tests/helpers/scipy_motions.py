"""Kicked motions of a model beside SciPy's."""

from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

from facegear.harmonics import stacked_values
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.steady_state.simulate import static_start


def kicked(model, size):
    """The static equilibrium with a random velocity."""
    start = static_start(model)
    kick = np.random.default_rng(3).normal(size=start.velocity.size)
    reach = np.abs(model.reduction.mesh_jacobian).max()
    return replace(start, velocity=size / reach * kick)


def right_side(model, omega, acting):
    """y', y'' written out once more; acting(cycles, y, v, pressed): forces on the coordinates beside those of
    their own springs, dampers and loads and of the flanks, whose laws' forces are `pressed`, N.
    """
    system, flanks = model.system, model.system.contacts
    rows = system.mesh_jacobian[:flanks]
    errors = system.error[system.error_kind[:flanks]]
    orders = np.arange(errors.shape[2])
    rates = np.stack([-orders * errors[:, 1], orders * errors[:, 0]], axis=1) * omega

    def right(t, z):
        y, v = np.split(z, 2)
        cycles = np.array([omega * t / TAU])
        over = rows @ y - stacked_values(errors, cycles)[0] - system.upper[:flanks]
        rate = rows @ v - stacked_values(rates, cycles)[0]
        pressed = system.law.force(cycles, np.maximum(over, 0.0)[None])[0]
        damped = system.mesh_damping[:flanks] * ((over > 0.0) | system.damping_when_open) * rate
        own = system.load[:, 1, 0] - system.damping * v - system.omega_squared * y
        return np.concatenate([v, own - rows.T @ (pressed + damped) + acting(cycles, y, v, pressed)])

    return right


def gap_to_scipy(model, omega, acting, start, run, phases, tolerance):
    """Largest distance, m, of a recorded motion from that of DOP853 at phases from 0 on, rad."""
    scale = np.abs(model.reduction.mesh_jacobian).max()
    found = solve_ivp(
        right_side(model, omega, acting),
        (0.0, phases[-1] / omega),
        np.concatenate([start.displacement, start.velocity]),
        "DOP853",
        phases / omega,
        rtol=tolerance,
        atol=1e-2 * tolerance / scale,
        max_step=2e-6,
    )
    return np.abs(found.y[: model.system.size].T - run.at(phases)[0]).max() * scale
