"""The equations as a right-hand side z' = f(s, z), z = (displacement, velocity), for other integrators."""

from collections.abc import Callable

import numpy as np

from facegear.arrays import Array
from facegear.meshing.linear import LinearLaw
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.integrator.system import System


def compiled_right_side(integrator: Integrator) -> Callable[[float, Array], Array]:
    """Return f(s, z) with accelerations from the kernels of an integrator.

    Parameters
    ----------
    integrator : Integrator
        The integrator.

    Returns
    -------
    callable
        Derivative (2 n,) by phase at a phase in rad and a state (2 n,), in the integrator's unit.
    """
    n = integrator.size

    def derivative(s: float, z: Array) -> Array:
        state = np.asarray(z).reshape(2, n)
        return np.concatenate([state[1], integrator.accelerations(s % TAU, state)])

    return derivative


def fixed_rk4(integrator: Integrator, state: Array, per_sample: int, width: float, samples: int) -> Array:
    """Compute states of the classical Runge-Kutta method with fixed steps, which are taken in Python.

    Parameters
    ----------
    integrator : Integrator
        Gives the accelerations.
    state : Array
        Start (2, n): coordinates and their derivatives by phase, any unit.
    per_sample : int
        Steps from one sample to the next.
    width : float
        Of a step, rad.
    samples : int
        Their number.

    Returns
    -------
    Array
        States (samples, 2 n), the start first, in the unit of the start.
    """
    derivative, z, s = compiled_right_side(integrator), state.ravel().copy(), 0.0
    out = np.empty((samples, z.size))
    for sample in out:
        sample[:] = z
        for _ in range(per_sample):
            first = derivative(s, z)
            second = derivative(s + 0.5 * width, z + 0.5 * width * first)
            third = derivative(s + 0.5 * width, z + 0.5 * width * second)
            fourth = derivative(s + width, z + width * third)
            z += width / 6.0 * (first + 2.0 * (second + third) + fourth)
            s += width
    return out


def linear(system: System) -> LinearLaw:
    """Return the law of a system.

    Parameters
    ----------
    system : System
        The system.

    Returns
    -------
    LinearLaw
        Its linear law.

    Raises
    ------
    ValueError
        For any but the linear one.
    """
    if not isinstance(system.law, LinearLaw):
        raise ValueError("only the linear law is set up here")
    return system.law


def plain_forces(system: System) -> Callable[[float, Array], Array]:
    """Return elastic forces at a phase and the deflections beyond the edges, in NumPy.

    Parameters
    ----------
    system : System
        The system.

    Returns
    -------
    callable
        Forces (m,), N, at a phase in rad and deflections (m,), m.
    """
    law = system.law
    if not isinstance(law, LinearLaw):
        return lambda s, gap: law.force(np.array([s / TAU]), gap[None])[0]
    order, stiffness = np.arange(law.fourier.shape[2]), law.fourier[law.kind]

    def forces(s: float, gap: Array) -> Array:
        k = stiffness[:, 0] @ np.sin(order * s) + stiffness[:, 1] @ np.cos(order * s)
        return np.asarray(k * gap)

    return forces


def plain_right_side(system: System, frequency: float) -> Callable[[float, Array], Array]:
    """Return f(s, z) in NumPy as people write it.

    Parameters
    ----------
    system : System
        The system.
    frequency : float
        Mesh frequency, rad/s.

    Returns
    -------
    callable
        Derivative (2 n,) by phase at a phase in rad and a state (2 n,), in the system's unit.
    """
    n = system.size
    elastic = plain_forces(system)
    always = system.damping_when_open | (system.lower >= system.upper)
    order_e = np.arange(system.error.shape[2])
    error, load = system.error[system.error_kind], system.load

    def derivative(s: float, z: Array) -> Array:
        displacement, velocity = z[:n], z[n:] * frequency
        e = error[:, 0] @ np.sin(order_e * s) + error[:, 1] @ np.cos(order_e * s)
        e_rate = frequency * (
            error[:, 0] @ (order_e * np.cos(order_e * s)) - error[:, 1] @ (order_e * np.sin(order_e * s))
        )
        order_f = np.arange(load.shape[2])
        external_load = load[:, 0] @ np.sin(order_f * s) + load[:, 1] @ np.cos(order_f * s)
        d = system.mesh_jacobian @ displacement - e
        gap = np.where(d > system.upper, d - system.upper, np.where(d < system.lower, d - system.lower, 0.0))
        damper = np.where(always | (gap != 0.0), system.mesh_damping, 0.0)
        force = elastic(s, gap) + damper * (system.mesh_jacobian @ velocity - e_rate)
        acceleration = (
            external_load
            - system.damping * velocity
            - system.omega_squared * displacement
            - system.mesh_jacobian.T @ force
        )
        out = np.zeros_like(z)
        out[:n] = velocity / frequency
        out[n:] = acceleration / frequency**2
        return out

    return derivative
