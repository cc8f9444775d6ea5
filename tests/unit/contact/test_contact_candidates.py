"""Candidates of contact: no hat that could carry load is left out, however few the solver searches."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from skfem import ElementQuad1, ElementQuad2
from test_pair_contact import misaligned

from facegear.contact import ltca
from facegear.contact.basis_functions import Lattice, functions_within
from facegear.contact.bodies.surface import face_functions
from facegear.contact.candidates import candidates_of, flank_cover, flank_points, influence_matrix
from facegear.contact.ltca import known_contact, loaded_contact
from facegear.contact.options import ContactOptions, Refinement
from facegear.contact.position_solver import PositionSolver
from facegear.contact.search import cover_of, facing_points, find_candidates
from facegear.teeth.closest import PAIRS
from facegear.teeth.opposite import locate_hits
from facegear.teeth.separation import separation
from facegear.teeth.unloaded_contact import unloaded_contact

PLACES = [{}, {"offset": 3e-4}, {"shaft_angle_error": 3.5e-3}]
LIMIT = 1.2e-3
"""Turn (rad) of the order that 1000 N m need."""


def placed(model, position):
    phi1 = (position - 0.5) * 2 * np.pi / 23
    return phi1, float(unloaded_contact(model.design, [phi1]).phi2[0])


def everywhere(model, placement, tooth):
    """Candidates from the separation at every point of the flank, none screened."""
    pinion, gear = model.flanks.pinion, model.flanks.gear
    hits = locate_hits(model.design, separation(model.design, pinion.points, *placement, tooth, 1e-3))
    on_gear = gear.coordinates(hits, True, 0.1 * model.design.module)[0]
    points = flank_points(pinion, np.arange(len(pinion.at)), hits.gap[0], pinion.lever_arm, on_gear)
    return candidates_of(pinion.lattice, gear.lattice, tooth, points, flank_cover(pinion), LIMIT)


@pytest.mark.parametrize("errors", PLACES)
def test_screening_by_coarse_probes_loses_no_hat(model_of, errors):
    model = misaligned(model_of(), **errors)
    for position in (0.05, 0.4, 0.7):
        angles = placed(model, position)
        options = ContactOptions(edges=False)
        found = find_candidates(model.flanks, angles, PAIRS, LIMIT, options)
        screened = {pair.tooth: pair for pair in found}
        expected = [pair for tooth in PAIRS for pair in everywhere(model, angles, int(tooth))]
        assert len(expected) >= 2
        for pair in expected:
            np.testing.assert_array_equal(screened[pair.tooth].hats, pair.hats)
            np.testing.assert_allclose(screened[pair.tooth].gap, pair.gap, atol=1e-15)


def test_teeth_that_stand_apart_have_no_candidates(model_of):
    model = model_of()
    phi1, phi2 = placed(model, 0.4)
    apart = phi1, phi2 + 3e-4 / model.design.gear_base_radius
    for options in (ContactOptions(), ContactOptions(edges=False)):
        assert find_candidates(model.flanks, (phi1, phi2), PAIRS, LIMIT, options)
        assert not find_candidates(model.flanks, apart, PAIRS, LIMIT, options)


def test_a_cell_lies_in_the_element_that_its_points_lie_in(model_of):
    pinion = model_of().flanks.pinion
    row, column = np.floor(pinion.at / (2 * pinion.lattice.factors)).astype(int).T
    number = row * ((pinion.side.shape[1] - 1) // 2) + column
    np.testing.assert_array_equal(pinion.element[pinion.cell], number)


@pytest.mark.parametrize("errors", PLACES)
def test_contact_sought_in_a_strip_is_that_among_all_candidates(model_of, errors, monkeypatch):
    model = misaligned(model_of(), **errors)
    positions, torques = [0.05, 0.4, 0.7], [50.0, 300.0, 1000.0]
    narrow = loaded_contact(model, positions, torques)
    monkeypatch.setattr(ltca, "GAP", np.inf)
    monkeypatch.setattr(ltca, "WIDTH", np.inf)
    for one, other in zip(narrow, loaded_contact(model, positions, torques), strict=True):
        assert one.candidates == other.candidates
        assert one.ste == pytest.approx(other.ste, rel=1e-9)
        assert one.k_local == pytest.approx(other.k_local, rel=1e-9)
        np.testing.assert_allclose(one.load_share, other.load_share, atol=1e-9)


def test_strip_that_is_too_narrow_is_found_out_and_widened(model_of, monkeypatch):
    model = model_of()
    expected = loaded_contact(model, [0.3], [600.0])[0]
    monkeypatch.setattr(ltca, "WIDTH", 0.02)
    widened = loaded_contact(model, [0.3], [600.0])[0]
    assert widened.ste == pytest.approx(expected.ste, rel=1e-9)
    assert widened.residual < 1e-10


POSITIONS, TORQUES = [0.05, 0.4, 0.7], [300.0, 1000.0]


def known_of(model):
    results = loaded_contact(model, POSITIONS, TORQUES)
    pinion = model.flanks.pinion
    return known_contact(results, POSITIONS, pinion.shape, model.design.pinion_base_radius)


def same_results(found, expected):
    for one, other in zip(found, expected, strict=True):
        assert (one.position, one.torque) == (other.position, other.torque)
        assert one.ste == pytest.approx(other.ste, rel=1e-10)
        assert one.k_local == pytest.approx(other.k_local, rel=1e-10)
        np.testing.assert_allclose(one.load_share, other.load_share, atol=1e-10)
        for spot, same in zip(one.spots, other.spots, strict=True):
            np.testing.assert_array_equal(spot.hats, same.hats)


def test_contact_sought_beside_a_known_one_is_the_same_among_fewer_hats(model_of, monkeypatch):
    known, model, sought = known_of(model_of()), misaligned(model_of(), offset=2e-5), []

    class CountingSolver(PositionSolver):
        def solve(self, *given):
            contact = super().solve(*given)
            sought.append(contact.strip_size)
            return contact

    monkeypatch.setattr(ltca, "PositionSolver", CountingSolver)
    expected = loaded_contact(model, POSITIONS, TORQUES)
    among_all, _ = list(sought), sought.clear()
    same_results(loaded_contact(model, POSITIONS, TORQUES, known_contact=known), expected)
    assert len(sought) == len(POSITIONS)
    assert sum(sought) < 0.97 * sum(among_all)


@pytest.mark.parametrize("part", [0.5, 3.0])
def test_known_contact_that_has_little_to_do_with_the_pair_changes_no_result(model_of, part):
    known, model = known_of(model_of()), misaligned(model_of(), shaft_angle_error=2e-3)
    turn = known.turn * np.array([part, 1.0, 1.0 / part])
    wrong = replace(known, turn=turn, near=np.roll(known.near, 1, axis=0))
    expected = loaded_contact(model, POSITIONS, TORQUES)
    same_results(loaded_contact(model, POSITIONS, TORQUES, known_contact=wrong), expected)


def test_known_contact_marks_what_carries_load_and_what_stands_beside_across_the_profile(model_of):
    model = model_of()
    results, (rows, columns) = loaded_contact(model, POSITIONS, TORQUES), model.flanks.pinion.shape
    known = known_contact(results, POSITIONS, (rows, columns), model.design.pinion_base_radius)
    for at, position in enumerate(POSITIONS):
        expected = set()
        for result in results:
            for spot in result.spots if result.position == position else ():
                for row, column in zip(*np.divmod(spot.hats, columns), strict=True):
                    around = [other for other in (row - 1, row, row + 1) if 0 <= other < rows]
                    expected |= {(spot.tooth, other * columns + column) for other in around}
        pair, node = np.nonzero(known.near[at])
        assert set(zip(PAIRS[pair].tolist(), node.tolist(), strict=True)) == expected


def test_contact_that_fillets_turn_back_is_none_to_go_by(model_of):
    model = model_of(coarse=True, rack_tip_radius=0.25)
    positions = np.arange(4) / 4
    results = loaded_contact(model, positions, [10.0])
    assert min(result.ste - result.unloaded_error for result in results) < 0.0
    base_radius = model.design.pinion_base_radius
    assert known_contact(results, positions.tolist(), model.flanks.pinion.shape, base_radius) is None


@pytest.mark.parametrize("coupled", [True, False])
def test_solver_has_the_influence_of_sparse_products(model_of, coupled):
    """The approach without the matrix, too: of all functions at a position, and of some in some cases."""
    model, options, limit = model_of(), ContactOptions(), 4e-4
    flanks, angles = model.flanks, placed(model, 0.3)
    facing = facing_points(flanks, [angles], [PAIRS], limit, options)[0]
    lattices = flanks.pinion.lattice, flanks.gear.lattice
    solver = PositionSolver(cover_of(flanks, options), lattices, (model.pinion, model.gear), coupled)
    pairs = find_candidates(flanks, angles, PAIRS, limit, options)
    expected = influence_matrix(pairs, model.pinion, model.gear, coupled)
    matrix, largest = solver.influence(facing, limit), np.abs(expected).max()
    np.testing.assert_allclose(matrix, expected, rtol=1e-12, atol=1e-13 * largest)
    forces = np.random.default_rng(0).uniform(0, 10, (7, len(expected)))
    approach, largest = (forces @ expected).T, np.abs(forces @ expected).max()
    cases = np.full(len(expected), 7)
    found = solver.approach(facing, limit, forces, cases)
    np.testing.assert_allclose(found, approach, rtol=1e-12, atol=1e-13 * largest)
    cases[::3], cases[1::3] = 0, 2
    within = np.arange(7) < cases[:, None]
    found = solver.approach(facing, limit, forces, cases)
    some = np.where(within, approach, 0.0)[cases > 0]
    np.testing.assert_allclose(found, some, rtol=1e-12, atol=1e-13 * largest)


def test_functions_that_a_rotation_closes_average_gap_and_lever_arm(model_of):
    model, limit = model_of(), 4e-4
    facing = facing_points(model.flanks, [placed(model, 0.3)], [PAIRS], limit, ContactOptions())[0]
    found = functions_within(facing, cover_of(model.flanks, ContactOptions()), limit)
    pointer, index, weight = found.average
    average = sp.csr_matrix((weight, index, pointer), shape=(found.gap.size, facing.points.gap.size))
    finite = [np.where(np.isfinite(each), each, 0.0) for each in (facing.points.gap, facing.points.lever_arm)]
    np.testing.assert_allclose(average.sum(axis=1), 1.0, rtol=1e-13)
    np.testing.assert_allclose(average @ finite[0], found.gap, rtol=1e-12, atol=1e-18)
    np.testing.assert_allclose(average @ finite[1], found.lever_arm, rtol=1e-13)
    assert (found.gap < limit * found.lever_arm).all()
    assert (np.diff(found.pair) >= 0).all() and found.node.max() < np.prod(model.flanks.pinion.shape)


@pytest.mark.parametrize("linear", [False, True])
def test_loads_before_refinement_follow_from_the_refined_ones(linear):
    """Also of points beside the lattice."""
    rng = np.random.default_rng(2)
    lattice = Lattice((5, 7), Refinement(3, 2), linear)
    points = rng.uniform(-0.5, 12.5, (40, 2))
    matrix = sp.random_array((12, 40), density=0.2, format="csr", rng=rng)
    rows = matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64), matrix.data
    refined, coarse = (lattice.loads(rows, points, finer) for finer in (True, False))
    pointer, index, weight = lattice.interpolation_rows()
    interpolated = sp.csr_matrix((weight, index, pointer), shape=(refined.shape[1], 35))
    np.testing.assert_allclose((refined @ interpolated).toarray(), coarse.toarray(), atol=1e-13)


@pytest.mark.parametrize(("element", "linear"), [(ElementQuad1(), True), (ElementQuad2(), False)])
def test_shape_functions_of_the_surface_are_those_of_the_elements(element, linear):
    size = 1 if linear else 2
    local = np.random.default_rng(3).random((2, 50))
    _, values, gradients = face_functions(size * local.T, (size + 1, size + 1), linear)
    for number in range(len(element.doflocs)):
        value, gradient = element.lbasis(local, number)
        np.testing.assert_allclose(values[:, number], value, atol=1e-15)
        np.testing.assert_allclose(size * gradients[:, number], gradient.T, atol=1e-14)
