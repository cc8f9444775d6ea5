"""One-degree systems with known answers, for the same code as the gearbox."""

import numpy as np

from facegear.meshing.linear import LinearLaw, Piecewise
from facegear.motion.integrator.system import System


def one_degree(
    damping,
    stiffness=((0.0,), (1.0,)),
    load=((0.0,), (0.0,)),
    lower=-1.0,
    upper=1.0,
    pieces=(),
    contact_damping=0.0,
    push_only=False,
) -> System:
    return System(
        mesh_jacobian=np.ones((1, 1)),
        omega_squared=np.zeros(1),
        damping=np.array([damping]),
        mesh_damping=np.array([contact_damping]),
        lower=np.array([lower]),
        upper=np.array([upper]),
        law=LinearLaw(np.array([stiffness], dtype=float), np.zeros(1, dtype=int), pieces),
        error=np.zeros((1, 2, 1)),
        error_kind=np.zeros(1, dtype=int),
        load=np.array([load], dtype=float),
        damping_when_open=contact_damping == 0.0,
        push_only=push_only,
        scale=1.0,
    )


def backlash_oscillator(speed, damping_ratio=0.05, mean=0.1, amplitude=0.05, in_gap=None) -> System:
    """Oracle (a): x'' + 2 z x' + f(x) = Fm + Fa W^2 cos W t, damping in the gap its own if given."""
    always = damping_ratio if in_gap is None else in_gap
    return one_degree(
        2 * always,
        load=((0.0, 0.0), (mean, amplitude * speed**2)),
        contact_damping=2 * (damping_ratio - always),
    )


def square_wave(depth=0.2, share=0.5) -> Piecewise:
    """Stiffness 1 + depth for a share of the period, then 1 - depth share / (1 - share)."""
    levels = np.array([[1.0 + depth], [1.0 - depth * share / (1.0 - share)]])
    return Piecewise(np.array([0.0, share, 1.0]), levels)


def meissner(damping_ratio, one_sided=False, in_gap=None) -> System:
    """Oracles (b), one-sided contact under unit load, and (c), the linear equation."""
    always = damping_ratio if in_gap is None else in_gap
    return one_degree(
        2 * always,
        stiffness=((0.0,), (0.0,)),
        load=((0.0,), (1.0 if one_sided else 0.0,)),
        lower=-np.inf if one_sided else 0.0,
        upper=0.0,
        pieces=(square_wave(),),
        contact_damping=2 * (damping_ratio - always),
    )


def two_coordinates() -> System:
    """y'' + .04 y' + diag(.2, 1.1) y + g k(t) (g . y) = (1, .5), g = (1, .8), k = 1.4 and 0.6 by halves."""
    load = np.zeros((2, 2, 1))
    load[:, 1, 0] = 1.0, 0.5
    return System(
        mesh_jacobian=np.array([[1.0, 0.8]]),
        omega_squared=np.array([0.2, 1.1]),
        damping=np.full(2, 0.04),
        mesh_damping=np.zeros(1),
        lower=np.zeros(1),
        upper=np.zeros(1),
        law=LinearLaw(np.zeros((1, 2, 1)), np.zeros(1, dtype=int), (square_wave(0.4),)),
        error=np.zeros((1, 2, 1)),
        error_kind=np.zeros(1, dtype=int),
        load=load,
        damping_when_open=True,
        scale=1.0,
    )


def mathieu(depth) -> System:
    return one_degree(0.0, stiffness=((0.0, 0.0), (1.0, depth)), lower=0.0, upper=0.0)
