"""The linear law of contacts: stiffness times deflection."""

import numpy as np
import pytest

from facegear.harmonics import Harmonics
from facegear.meshing.linear import LinearLaw, Piecewise, linear_law
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.system import System

PHASES = np.array([0.0, 0.28, 0.7])
SERIES = [
    Harmonics(np.array([0.0, 0.1, 0.3]), np.array([4.0, 0.5, -0.2])),
    Harmonics(np.array([0.0, 0.0, 0.2]), np.array([2.0, -0.4, 0.1])),
]
CONSTANT = [Harmonics(np.zeros(1), np.array([mean])) for mean in (3.0, 5.0)]
CUBICS = (
    Piecewise(np.array([0.0, 0.3, 1.0]), np.array([[0.2, -0.4, 1.1, 0.3], [0.6, 0.1, -0.5, 0.2]])),
    Piecewise(np.array([0.0, 0.25, 1.0]), np.array([[0.1, 0.7, 0.0, -0.9], [0.3, -0.2, 0.4, 0.8]])),
)


def with_pieces():
    """Two contacts whose stiffness has a series and cubic pieces each."""
    plain = linear_law(SERIES)
    return LinearLaw(plain.fourier, plain.kind, tuple(CUBICS[m] for m in np.argsort(plain.kind)))


def stiffness_with_pieces(phases):
    """The stiffness (K, 2) of the contacts of `with_pieces`, written out once more."""
    found = []
    for series, cubic in zip(SERIES, CUBICS, strict=True):
        start = cubic.breaks[1]
        first, second = (np.polynomial.Polynomial(row) for row in cubic.coefficients)
        found.append(series(phases) + np.where(phases < start, first(phases), second(phases - start)))
    return np.stack(found, axis=1)


def contacts_alone(law) -> System:
    """Contacts that never open, each on a coordinate of its own, and nothing else."""
    count = law.contacts
    return System(
        mesh_jacobian=np.eye(count),
        omega_squared=np.zeros(count),
        damping=np.zeros(count),
        mesh_damping=np.zeros(count),
        lower=np.zeros(count),
        upper=np.zeros(count),
        law=law,
        error=np.zeros((1, 2, 1)),
        error_kind=np.zeros(count, dtype=int),
        load=np.zeros((count, 2, 1)),
        damping_when_open=True,
        scale=1.0,
    )


def test_contacts_that_all_differ_do_not_run_in_the_space_of_contacts_alike():
    """Machines of one family share it: five kinds once ran in the space of one, past its end."""
    swings = [Harmonics(np.array([0.0, swing]), np.array([4.0, 0.0])) for swing in range(5)]
    different, alike = (contacts_alone(linear_law(each)) for each in (swings, 5 * swings[:1]))
    one = Integrator(alike, 2.0)
    assert Integrator(alike, 2.5, like=one).work is one.work
    assert Integrator(different, 2.0, like=one).work is not one.work


@pytest.mark.parametrize("series", [SERIES, CONSTANT])
def test_force_is_stiffness_times_deflection_and_a_mesh_without_contact_has_no_slope(series):
    law = linear_law(series)
    beyond = np.array([[0.0, 2.0], [-1.5, 0.0], [3.0, 0.5]])
    stiffness = np.stack([one(PHASES) for one in series], axis=1)
    np.testing.assert_allclose(law.force(PHASES, beyond), stiffness * beyond, rtol=1e-14)
    np.testing.assert_allclose(law.slope(PHASES, beyond), np.where(beyond == 0.0, 0.0, stiffness), rtol=1e-14)
    assert law.straight and not law.levels.any() and law.breaks.size == 0
    np.testing.assert_allclose(law.steepest, [one.amplitudes.sum() for one in series], rtol=1e-14)


def test_pieces_add_their_polynomials_to_the_series():
    law = with_pieces()
    np.testing.assert_allclose(law.stiffness(PHASES), stiffness_with_pieces(PHASES), rtol=1e-13)
    np.testing.assert_allclose(law.stiffness(PHASES + 3.0), stiffness_with_pieces(PHASES), rtol=1e-13)
    np.testing.assert_array_equal(law.breaks, [0.0, 0.25, 0.3, 1.0])
    assert (
        law.steepest >= stiffness_with_pieces(np.linspace(0.0, 1.0, 99, endpoint=False)).max(axis=0)
    ).all()


def test_the_mean_law_has_the_mean_of_the_stiffness_over_the_mesh_period():
    nodes, weights = np.polynomial.legendre.leggauss(20)
    law = with_pieces()
    pieces = zip(law.breaks[:-1], law.breaks[1:], strict=True)
    parts = [(0.5 * (end - start), 0.5 * (end + start)) for start, end in pieces]
    mean = sum(half * weights @ stiffness_with_pieces(middle + half * nodes) for half, middle in parts)
    np.testing.assert_allclose(law.mean().stiffness(PHASES), np.tile(mean, (3, 1)), rtol=1e-12)


def test_the_law_at_a_phase_keeps_the_stiffness_of_that_phase():
    held = with_pieces().at_phase(0.7)
    np.testing.assert_allclose(held.stiffness(PHASES), np.tile(stiffness_with_pieces(PHASES)[-1], (3, 1)))


def test_compiled_motions_see_the_same_stiffness_over_the_squared_mesh_frequency():
    law, frequency = with_pieces(), 3.0
    integrator, pressed = Integrator(contacts_alone(law), frequency), np.array([[1.0, 1.0], [0.0, 0.0]])
    for phase, expected in zip(PHASES, stiffness_with_pieces(PHASES), strict=True):
        found = -integrator.accelerations(2.0 * np.pi * phase, pressed)
        np.testing.assert_allclose(found, expected / frequency**2, rtol=1e-12)
