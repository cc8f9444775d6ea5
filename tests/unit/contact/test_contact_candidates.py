"""What may touch: no hat that could carry load is left out, however few the solution is sought among."""

import numpy as np
import pytest
import scipy.sparse as sp
from test_pair_contact import misaligned

from facegear.contact import strip
from facegear.contact.averages import Rows, rows_of, spread
from facegear.contact.bodies.surface import interpolation
from facegear.contact.candidates import candidates_of, hat_loads
from facegear.contact.influence import displacement, influence_matrix
from facegear.contact.ltca import analyse
from facegear.contact.options import ContactOptions
from facegear.contact.search import find_candidates
from facegear.geometry.separation import separation
from facegear.geometry.unloaded import PAIRS, unloaded_contact

PLACES = [{}, {"offset": 3e-4}, {"shaft_angle_error": 3.5e-3}]
LIMIT = 1.2e-3
"""Turn (rad) of the order that 1000 N m need."""


def placed(model, position):
    phi1 = (position - 0.5) * 2 * np.pi / 23
    return phi1, float(unloaded_contact(model.design, [phi1]).phi2[0])


def everywhere(model, phi1, phi2, tooth):
    """Candidates from the separation at every point of the flank, none screened."""
    surface, lattice = model.surface, model.lattice
    seen = separation(model.design, surface.points, phi1, phi2, tooth, reach=1e-3)
    place = lattice.coordinates(seen, True, 0.1 * model.design.module)[0]
    on = np.flatnonzero(np.isfinite(place).all(axis=1) & np.isfinite(seen.gap[0]))
    if on.size == 0:
        return None
    loads = [hat_loads(surface, on, seen.gap[0][on], place[on])]
    return candidates_of(surface, lattice.side.shape, lattice.refinement, tooth, loads, LIMIT)


@pytest.mark.parametrize("errors", PLACES)
def test_screening_by_coarse_probes_loses_no_hat(model_of, errors):
    model = misaligned(model_of(), **errors)
    for position in (0.05, 0.4, 0.7):
        angles = placed(model, position)
        options = ContactOptions(edges=False)
        found = find_candidates(model.surface, model.lattice, *angles, PAIRS, LIMIT, options)
        screened = {pair.tooth: pair for pair in found}
        expected = {int(tooth): everywhere(model, *angles, int(tooth)) for tooth in PAIRS}
        assert sum(pair is not None for pair in expected.values()) >= 2
        for tooth, pair in expected.items():
            if pair is not None:
                np.testing.assert_array_equal(screened[tooth].hats, pair.hats)
                np.testing.assert_allclose(screened[tooth].gap, pair.gap, atol=1e-15)


@pytest.mark.parametrize("errors", PLACES)
def test_contact_sought_in_a_strip_is_that_among_all_candidates(model_of, errors, monkeypatch):
    model = misaligned(model_of(), **errors)
    positions, torques = [0.05, 0.4, 0.7], [50.0, 300.0, 1000.0]
    narrow = analyse(model, positions, torques)
    monkeypatch.setattr(strip, "LOWEST", np.inf)
    monkeypatch.setattr(strip, "BAND", np.inf)
    for one, other in zip(narrow, analyse(model, positions, torques), strict=True):
        assert one.candidates == other.candidates
        assert one.ste == pytest.approx(other.ste, rel=1e-9)
        assert one.k_local == pytest.approx(other.k_local, rel=1e-9)
        np.testing.assert_allclose(one.share, other.share, atol=1e-9)


def test_strip_that_is_too_narrow_is_found_out_and_widened(model_of, monkeypatch):
    model = model_of()
    expected = analyse(model, [0.3], [600.0])[0]
    monkeypatch.setattr(strip, "BAND", 0.02)
    widened = analyse(model, [0.3], [600.0])[0]
    assert widened.ste == pytest.approx(expected.ste, rel=1e-9)
    assert widened.residual < 1e-10


def test_displacements_without_the_matrix_are_those_with_it(model_of):
    model = model_of()
    pairs = find_candidates(model.surface, model.lattice, *placed(model, 0.3), PAIRS, 4e-4, ContactOptions())
    count = sum(len(pair.hats) for pair in pairs)
    forces = np.random.default_rng(0).uniform(0, 10, (count, 2))
    bodies = {"pinion": model.pinion, "gear": model.gear}
    with_matrix = influence_matrix(pairs, **bodies) @ forces
    without = displacement(pairs, pairs, forces, **bodies)
    np.testing.assert_allclose(without, with_matrix, rtol=1e-9)


@pytest.mark.parametrize("linear", [False, True])
def test_loads_spread_in_one_pass_are_the_sparse_product(linear):
    rng = np.random.default_rng(1)
    shape, points = (9, 7), rng.uniform(0, 6, (40, 2))
    matrix = sp.random_array((12, 40), density=0.2, format="csr", rng=rng)
    rows = Rows(matrix.indptr, matrix.indices, matrix.data)
    expected = matrix @ interpolation(points, shape, linear)
    np.testing.assert_allclose(spread(rows, points, shape, linear).toarray(), expected.toarray(), atol=1e-14)
    keep = np.arange(12) % 3 == 0
    np.testing.assert_array_equal(rows_of(matrix, keep).toarray(), matrix.toarray()[keep])
