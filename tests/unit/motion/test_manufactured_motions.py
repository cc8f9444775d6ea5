"""Known motions whose disturbances are known too: the tangents of the integrator converge to them.

A disturbance of a mesh in contact obeys z'' + c z' + K(t) z = 0. With a positive function r(t) and

    K = c^2/4 + 1/r^2 - r''/(2 r) + r'^2/(4 r^2),

z = sqrt(r) exp(-c t/2) cos(psi) and the same with sin(psi) solve it, where psi' = 1/r (Ermakov, 1880). Here t
is the mesh phase and r = (1 + a cos t)/v. The law of a mesh is made such that its slope along a chosen motion
is K, and the load is what this motion needs.
"""

from dataclasses import replace

import numpy as np
import pytest
from oscillators import one_degree
from references import against, agrees
from scipy.linalg import block_diag

from facegear.meshing.linear import LinearLaw
from facegear.meshing.power import PowerLaw
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.steady_state.orbits import monodromy

POINTS = 256
PHASES = TAU * np.arange(POINTS) / POINTS
FREQUENCY = 1.7
"""Mesh frequency, rad/s."""
DAMPING = 0.1
PERIODS = 2
TOLERANCES = (1e-5, 1e-7, 1e-9, 1e-11)


def rates(values):
    """First and second derivative of a periodic function (POINTS,) by phase."""
    waves = 1j * np.fft.rfftfreq(POINTS, 1.0 / POINTS)
    parts = np.fft.rfft(values)
    return np.fft.irfft(waves * parts, POINTS), np.fft.irfft(waves**2 * parts, POINTS)


def series(values):
    """Fourier rows (2, 41) of a periodic function (POINTS,), sine part first."""
    parts = np.fft.rfft(values)[:41] / POINTS
    parts[1:] *= 2.0
    return np.array([-parts.imag, parts.real])


def slope(depth, swings):
    """K (POINTS,) of a disturbance that swings so many times a period."""
    v = swings * np.sqrt(1.0 - depth**2)
    r = (1.0 + depth * np.cos(PHASES)) / v
    rate, bend = -depth * np.sin(PHASES) / v, -depth * np.cos(PHASES) / v
    return 0.25 * DAMPING**2 + 1.0 / r**2 - bend / (2.0 * r) + rate**2 / (4.0 * r**2)


def exact_matrix(depth, swings):
    """Matrix (2, 2) by which PERIODS map a disturbance (z, z') at phase zero, where r' = 0."""
    psi, r = TAU * PERIODS * swings, (1.0 + depth) / (swings * np.sqrt(1.0 - depth**2))
    turn = np.array([[np.cos(psi), r * np.sin(psi)], [-np.sin(psi) / r, np.cos(psi)]])
    undamped = np.array([[1.0, 0.0], [0.5 * DAMPING, 1.0]])
    return np.exp(-0.5 * DAMPING * TAU * PERIODS) * np.linalg.solve(undamped, turn @ undamped)


def curved_mesh():
    """One mesh with the law k(t) x^1.5 and x = (K / (1.5 k))^2, so that 1.5 k x^0.5 = K."""
    disturbance = 0.3, 2.15
    k = 1.0 + 0.25 * np.cos(PHASES)
    x = (slope(*disturbance) / (1.5 * k)) ** 2
    rate, bend = rates(x)
    load = series(bend + DAMPING * rate + k * x**1.5)
    system = one_degree(DAMPING * FREQUENCY, load=FREQUENCY**2 * load, lower=-np.inf, upper=0.0)
    law = PowerLaw(FREQUENCY**2, depth=0.25, largest=x.max())
    return replace(system, law=law), np.array([x[:1], rate[:1]]), exact_matrix(*disturbance)


def two_linear_meshes():
    """Two meshes of different k(t) on two coordinates that both take part in either deflection."""
    disturbances, turned = ((0.3, 1.15), (0.2, 2.4)), np.array([[0.8, 0.6], [-0.6, 0.8]])
    x = np.array([1.0 + 0.4 * np.cos(PHASES + 1.0), 0.7 + 0.2 * np.sin(2.0 * PHASES)])
    slopes = np.array([slope(*one) for one in disturbances])
    moves = [rates(one) for one in x]
    forces = np.array([b + DAMPING * v + k * d for (v, b), k, d in zip(moves, slopes, x, strict=True)])
    system = replace(
        one_degree(0.0),
        mesh_jacobian=turned,
        omega_squared=np.zeros(2),
        damping=np.full(2, 0.25 * DAMPING * FREQUENCY),
        mesh_damping=np.full(2, 0.75 * DAMPING * FREQUENCY),
        lower=np.full(2, -np.inf),
        upper=np.zeros(2),
        law=LinearLaw(FREQUENCY**2 * np.array([series(one) for one in slopes]), np.arange(2)),
        error_kind=np.zeros(2, dtype=int),
        load=FREQUENCY**2 * np.array([series(one) for one in turned.T @ forces]),
    )
    start = np.array([x[:, 0], [rate[0] for rate, _ in moves]]) @ turned
    by_mesh = block_diag(*(exact_matrix(*one) for one in disturbances))[np.ix_([0, 2, 1, 3], [0, 2, 1, 3])]
    both = block_diag(turned, turned)
    return system, start, both.T @ by_mesh @ both


@against(
    "manufactured",
    "motion in contact whose disturbances solve Ermakov's equation",
    capability="dynamics_response branches",
    module="facegear.motion.integrator.integrator",
)
@pytest.mark.parametrize("make", [curved_mesh, two_linear_meshes])
def test_tangents_of_a_known_motion_converge_with_the_tolerance(make):
    """Errors stay below the number of steps times the error that each is allowed."""
    system, start, exact = make()
    for tolerance in TOLERANCES:
        integrator = Integrator(system, FREQUENCY, tolerance)
        matrix, run = monodromy(integrator, start, PERIODS)
        single = integrator.run(start, PERIODS, np.ones((1, *start.shape))).tangents[0]
        assert run.fractions[1].min() == pytest.approx(1.0)
        allowed = run.steps * tolerance
        name = f"{make.__name__.replace('_', ' ')}, tolerance {tolerance:g}"
        agrees(f"state after two periods, {name}", run.state, start, absolute=allowed)
        agrees(f"monodromy matrix, {name}", matrix, exact, absolute=allowed)
        agrees(f"a single tangent, {name}", single.ravel(), exact.sum(axis=1), absolute=allowed)
