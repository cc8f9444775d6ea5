"""The equations as a right-hand side z' = f(s, z), z = (displacement, velocity), for other integrators."""

from collections.abc import Callable

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.compiled import TAU, Packed
from facegear.dynamics.integrator.excitation import excitation
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.kernel import kernel
from facegear.dynamics.integrator.system import System
from facegear.dynamics.integrator.work import Work
from facegear.machine_code.lanes import LANES, load, multiply, multiply_add, splat, store
from facegear.mesh_law.linear import LinearLaw


@kernel
def right_side(packed: Packed, work: Work, s: float, z: Array, out: Array) -> None:
    """Derivative by s of z (2 n,) into out, for a linear law; work must be of order 1 or more."""
    n, width = packed.mesh_jacobian.shape
    excitation(packed, work, s, 0, 2)
    minus = splat(-1.0)
    for c in range(0, width, LANES):
        level, rate = multiply(minus, load(work.error, c)), multiply(minus, load(work.error, width + c))
        for k in range(packed.n):
            direction = load(packed.mesh_jacobian, k * width + c)
            level = multiply_add(direction, splat(z[k]), level)
            rate = multiply_add(direction, splat(z[n + k]), rate)
        store(work.deflection, c, level)
        store(work.deflection, width + c, rate)
    for m in range(packed.m):
        d = work.deflection[0, m]
        beyond = max(d - packed.upper[m], 0.0) + min(d - packed.lower[m], 0.0)
        touching = packed.damping_when_open or beyond != 0.0
        if packed.lower[m] >= packed.upper[m]:
            beyond, touching = d - packed.upper[m], True
        acting = packed.mesh_damping[m] if touching else 0.0
        push = work.law.slope[0, m] * beyond + acting * work.deflection[1, m]
        pulls = packed.push_only and packed.lower[m] < packed.upper[m] and push * beyond < 0.0
        work.force[m] = 0.0 if pulls else push
    for c in range(0, n, LANES):
        velocity = load(z, n + c)
        store(out, c, velocity)
        total = multiply_add(multiply(minus, load(packed.damping, c)), velocity, load(work.load, c))
        total = multiply_add(multiply(minus, load(packed.omega_squared, c)), load(z, c), total)
        for m in range(packed.m):
            total = multiply_add(load(packed.transposed, m * n + c), splat(-work.force[m]), total)
        store(out, n + c, total)


@kernel
def fixed_rk4(
    packed: Packed, work: Work, z: Array, scratch: Array, per_sample: int, width: float, out: Array
) -> None:
    """Classical Runge-Kutta with fixed steps; out (samples, 2 n) is filled every `per_sample` steps."""
    size = z.size
    s = 0.0
    for sample in range(out.shape[0]):
        for i in range(size):
            out[sample, i] = z[i]
        for _ in range(per_sample):
            right_side(packed, work, s, z, scratch[0])
            for i in range(size):
                scratch[4, i] = z[i] + 0.5 * width * scratch[0, i]
            right_side(packed, work, s + 0.5 * width, scratch[4], scratch[1])
            for i in range(size):
                scratch[4, i] = z[i] + 0.5 * width * scratch[1, i]
            right_side(packed, work, s + 0.5 * width, scratch[4], scratch[2])
            for i in range(size):
                scratch[4, i] = z[i] + width * scratch[2, i]
            right_side(packed, work, s + width, scratch[4], scratch[3])
            for i in range(size):
                z[i] += width / 6.0 * (scratch[0, i] + 2.0 * (scratch[1, i] + scratch[2, i]) + scratch[3, i])
            s += width


def compiled_right_side(integrator: Integrator) -> Callable[[float, Array], Array]:
    """f(s, z) for SciPy, on the compiled code of an integrator of order 1 or more."""
    packed, work = integrator.packed, integrator.work

    def derivative(s: float, z: Array) -> Array:
        out = np.empty(z.size)
        right_side(packed, work, s, np.ascontiguousarray(z), out)
        return out

    return derivative


def linear(system: System) -> LinearLaw:
    """The law of a system. Raises ValueError for any but the linear one."""
    if not isinstance(system.law, LinearLaw):
        raise ValueError("only the linear law is set up here")
    return system.law


def plain_forces(system: System) -> Callable[[float, Array], Array]:
    """Elastic forces (m,) at a phase and the deflections (m,) beyond the edges, in NumPy."""
    law = system.law
    if not isinstance(law, LinearLaw):
        return lambda s, gap: law.force(np.array([s / TAU]), gap[None])[0]
    order, stiffness = np.arange(law.fourier.shape[2]), law.fourier[law.kind]

    def forces(s: float, gap: Array) -> Array:
        k = stiffness[:, 0] @ np.sin(order * s) + stiffness[:, 1] @ np.cos(order * s)
        return np.asarray(k * gap)

    return forces


def plain_right_side(system: System, frequency: float, width: int) -> Callable[[float, Array], Array]:
    """f(s, z) in NumPy as people write it, z padded to 2 * width."""
    n = system.size
    elastic = plain_forces(system)
    order_e = np.arange(system.error.shape[2])
    error, load = system.error[system.error_kind], system.load

    def derivative(s: float, z: Array) -> Array:
        displacement, velocity = z[:n], z[width : width + n] * frequency
        e = error[:, 0] @ np.sin(order_e * s) + error[:, 1] @ np.cos(order_e * s)
        e_rate = frequency * (
            error[:, 0] @ (order_e * np.cos(order_e * s)) - error[:, 1] @ (order_e * np.sin(order_e * s))
        )
        order_f = np.arange(load.shape[2])
        applied = load[:, 0] @ np.sin(order_f * s) + load[:, 1] @ np.cos(order_f * s)
        d = system.mesh_jacobian @ displacement - e
        gap = np.where(d > system.upper, d - system.upper, np.where(d < system.lower, d - system.lower, 0.0))
        force = elastic(s, gap) + system.mesh_damping * (system.mesh_jacobian @ velocity - e_rate)
        acceleration = (
            applied
            - system.damping * velocity
            - system.omega_squared * displacement
            - system.mesh_jacobian.T @ force
        )
        out = np.zeros_like(z)
        out[:n] = velocity / frequency
        out[width : width + n] = acceleration / frequency**2
        return out

    return derivative
