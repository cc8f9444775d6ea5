from itertools import pairwise

import numpy as np
import pytest
from oscillators import backlash_oscillator, mathieu, meissner
from recorded_motion import record
from references import against, agrees
from scipy.linalg import expm
from scipy.optimize import brentq

from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.orbits import monodromy
from facegear.motion.steady_state.simulate import steady_state
from facegear.motion.sweeps.held_orbit import OrbitFollower
from facegear.motion.sweeps.jumps import side

FINE = Settings(tolerance=1e-14, periodic_residual=1e-12, settle=20_000, longest_period=1)
LOWER = (1.1624504362, 0.0080293418, 1.03663857, 1.16336143, 1.1, 0.04480330)
UPPER = (0.8338430125, 0.1640787518, 0.71634912, 1.35304199, 0.99812462, 0.22472379)


def state(displacement, velocity):
    return State(np.array([displacement]), np.array([velocity]))


@against(
    "second implementation",
    "oscillator with backlash, computed twice by independent means",
    capability="dynamics_response",
    module="facegear.motion.steady_state.simulate",
)
@pytest.mark.parametrize("branch", [LOWER, UPPER])
def test_backlash_oscillator_has_both_orbits_of_oracle_a(branch):
    displacement, velocity, least, most, mean, ac_rms = branch
    system = backlash_oscillator(0.75)
    response = steady_state(system, 0.75, FINE, state(round(displacement, 2), round(velocity, 2)))
    assert response.label == "period-1"
    agrees("displacement of the orbit", response.coordinates[0, 0], displacement, absolute=2e-10)
    agrees("velocity of the orbit", response.state.velocity[0], velocity, absolute=2e-10)
    orbit = record(system, 0.75, response.state, 1, FINE)
    agrees("extremes of the orbit", orbit.extremes(0), (least, most), absolute=1e-8)
    phases, weights = orbit.quadrature()
    values = orbit.at(phases)[1][:, 0]
    found = weights @ values / (2 * np.pi)
    agrees("mean of the orbit", found, mean, absolute=1e-8)
    agrees("RMS of the orbit", np.sqrt(weights @ (values - found) ** 2 / (2 * np.pi)), ac_rms, absolute=1e-8)


def exact_multipliers(speed, displacement, velocity):
    """Piecewise-linear flow by matrix exponentials, contact switches by root finding: nothing of ours."""
    damping, period = 0.1, 2 * np.pi / speed
    force = 0.05 * speed**2

    def period_matrix(contact):
        return np.array(
            [
                [0, 1, 0, 0, 0],
                [-contact, -damping, 0.1 + contact, force, 0],
                [0, 0, 0, 0, 0],
                [0, 0, 0, 0, -speed],
                [0, 0, 0, speed, 0],
            ],
            dtype=float,
        )

    now, vector, product = 0.0, np.array([displacement, velocity, 1.0, 1.0, 0.0]), np.eye(2)
    contact = displacement > 1.0
    while now < period - 1e-13:
        matrix = period_matrix(contact)

        def gap(t, matrix=matrix, vector=vector):
            return (expm(matrix * t) @ vector)[0] - 1.0

        grid = np.linspace(1e-9, period - now, 400)
        values = np.array([gap(t) for t in grid])
        turns = np.flatnonzero(np.sign(values[1:]) != np.sign(values[:-1]))
        step = brentq(gap, grid[turns[0]], grid[turns[0] + 1], xtol=1e-14) if turns.size else grid[-1]
        product = expm(matrix[:2, :2] * step) @ product
        vector = expm(matrix * step) @ vector
        now += step
        contact = bool(vector[1] > 0) if turns.size else contact
    return np.sort_complex(np.linalg.eigvals(product))


@against(
    "third-party program",
    "scipy.linalg.expm between the switches of contact",
    capability="dynamics_response branches",
    module="facegear.motion.steady_state.orbits",
)
@pytest.mark.parametrize("branch", [LOWER, UPPER])
def test_multipliers_agree_with_matrix_exponentials_between_switches(branch):
    response = steady_state(backlash_oscillator(0.75), 0.75, FINE, state(*branch[:2]))
    exact = exact_multipliers(0.75, *branch[:2])
    difference = np.abs(np.sort_complex(response.multipliers) - exact)
    agrees("difference of the multipliers", difference, 0.0, absolute=2e-9)
    agrees("logarithm of the determinant, less Liouville's", response.liouville, 0.0, absolute=1e-9)


def jump(make, approach, first, last):
    """Run through `approach`, sweep from first to last in coarse steps, follow the orbit before the largest
    change until it is lost; return the motion before and the width of the bracket."""

    def respond(speed, at):
        return steady_state(make(speed), speed, FINE, at)

    start = state(1.1, 0.0)
    for speed in approach:
        start = respond(speed, start).state
    sides = []
    for speed in np.linspace(first, last, 6):
        sides.append(side(speed, respond(speed, sides[-1].state if sides else start)))
    changes = [abs(np.log(b.ac_rms[0] / a.ac_rms[0])) for a, b in pairwise(sides)]
    position = int(np.argmax(changes))

    follower = OrbitFollower(lambda speed: (make(speed), speed), FINE)
    before = sides[position]
    orbit = follower.orbit(before.speed, before.state, before.period)
    held, lost = follower.until_lost(orbit, sides[position + 1].speed, 2e-6)
    return side(held.speed, respond(held.speed, held.state)), lost


@against(
    "analytic",
    "fold speeds of the oscillator with backlash in closed pieces",
    capability="dynamics_sweep",
    module="facegear.motion.sweeps.jumps",
)
@pytest.mark.parametrize(
    ("approach", "first", "last", "speed"),
    [((), 0.80, 0.84, 0.82846394), ((0.9, 0.85, 0.8), 0.76, 0.69, 0.70803163)],
)
def test_fold_speeds_of_oracle_a(approach, first, last, speed):
    before, lost = jump(backlash_oscillator, approach, first, last)
    agrees(
        "speed of the jump, over the natural frequency",
        0.5 * (before.speed + lost),
        speed,
        absolute=1e-5,
    )
    assert before.multiplier > 0.95


@against(
    "analytic",
    "jump speeds of the square-wave oscillator in closed pieces",
    capability="dynamics_sweep",
    module="facegear.motion.sweeps.jumps",
)
@pytest.mark.parametrize(
    ("approach", "first", "last", "speed"),
    [((), 0.84, 0.90, 0.871224), ((0.95, 0.9, 0.85, 0.8, 0.77), 0.74, 0.66, 0.688016)],
)
def test_jump_speeds_of_oracle_b(approach, first, last, speed):
    before, lost = jump(lambda w: meissner(0.05, one_sided=True), approach, first, last)
    agrees(
        "speed of the jump, over the natural frequency",
        0.5 * (before.speed + lost),
        speed,
        absolute=1e-5,
    )


def matrix_of(system, speed, tolerance=1e-15):
    return monodromy(Integrator(system, speed, tolerance, 20), np.zeros((2, system.size)), 1)[0]


@against(
    "analytic",
    "Liouville: exp(-2 z T)",
    capability="dynamics_response branches",
    module="facegear.motion.steady_state.orbits",
)
def test_determinant_of_the_monodromy_matrix_is_the_damping_alone():
    matrix = matrix_of(meissner(0.05), 0.8)
    agrees(
        "determinant of the monodromy matrix",
        np.linalg.det(matrix),
        np.exp(-0.1 * 2 * np.pi / 0.8),
        relative=1e-12,
    )


def radius(system, speed):
    return np.abs(np.linalg.eigvals(matrix_of(system, speed))).max()


@against(
    "analytic",
    "Meissner's equation in closed pieces",
    capability="dynamics_response branches",
    module="facegear.motion.steady_state.orbits",
)
def test_meissner_spectral_radius():
    agrees("spectral radius", radius(meissner(0.05), 2.0), 1.043579854635, absolute=1e-11)


@against(
    "analytic",
    "edges of the principal tongues of Meissner's and Mathieu's equations",
    capability="dynamics_response branches",
    module="facegear.motion.steady_state.orbits",
)
@pytest.mark.parametrize(
    ("make", "edges"),
    [
        (lambda: meissner(0.0), (1.8710541958, 2.1252722146)),
        (lambda: mathieu(0.1), (1.9496984, 2.0496788)),
        (lambda: mathieu(0.2), (1.8988481, 2.0986876)),
        (lambda: mathieu(0.4), (1.7959893, 2.1945997)),
    ],
)
def test_undamped_tongue_edges(make, edges):
    system = make()

    def beyond(speed):
        return np.trace(matrix_of(system, speed)) + 2.0

    for edge in edges:
        agrees(
            "edge of the tongue, over the natural frequency",
            brentq(beyond, edge - 0.02, edge + 0.02, xtol=1e-12),
            edge,
            absolute=1e-7,
        )


@against(
    "analytic",
    "edges of Meissner's principal tongue with damping, in closed pieces",
    capability="dynamics_response branches",
    module="facegear.motion.steady_state.orbits",
)
def test_damped_tongue_edges():
    system = meissner(0.05)
    for edge in (1.9169701716, 2.0743382093):
        found = brentq(lambda w: radius(system, w) - 1.0, edge - 0.01, edge + 0.01, xtol=1e-12)
        agrees("edge of the tongue, over the natural frequency", found, edge, absolute=1e-9)


@against(
    "third-party program",
    "scipy.special.mathieu_a and mathieu_b",
    capability="dynamics_response branches",
    module="facegear.motion.steady_state.orbits",
)
def test_mathieu_edges_agree_with_scipys_characteristic_values():
    from scipy.special import mathieu_a, mathieu_b

    for depth in (0.1, 0.4):
        # x'' + (1 + depth cos W t) x: a = 4 / W^2, q = 2 depth / W^2 with the sign of q immaterial.
        low = brentq(lambda w, e=depth: mathieu_a(1, 2 * e / w**2) - 4 / w**2, 1.5, 2.0)
        high = brentq(lambda w, e=depth: mathieu_b(1, 2 * e / w**2) - 4 / w**2, 2.0, 2.5)
        system = mathieu(depth)
        for edge in (low, high):
            trace = np.trace(matrix_of(system, edge))
            agrees("trace of the monodromy matrix", trace, -2.0, absolute=1e-6)
