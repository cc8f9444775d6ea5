"""The compiled kernels of contact by themselves: properties, and what they refuse."""

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear._kernels import contact as kernels
from facegear.contact.position_solver import NEWTON_STEPS, TOLERANCE, kkt_residual

LIMITS = NEWTON_STEPS, TOLERANCE
TOGETHER, BLOCK = 16, 512
"""Rows and columns that `TwoSidedAverage` takes together: sizes around them are its edges."""


def make_rows(random, rows, columns, begin):
    """Rows with a few neighbouring entries each, from column `begin` of the row on."""
    matrix = np.zeros((rows, columns))
    for row in range(rows):
        first = begin(row)
        matrix[row, first : first + random.integers(1, 9)] = 1.0 + random.random()
    matrix = sp.csr_matrix(matrix)
    return (matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64), matrix.data), matrix.toarray()


@pytest.mark.parametrize("count", [1, TOGETHER, TOGETHER + 1, 3 * TOGETHER + 5, BLOCK + 3])
@pytest.mark.parametrize("order", ["rising", "falling", "mixed"])
def test_rows_meet_themselves_as_in_a_dense_product_in_any_order(count, order):
    random, nodes = np.random.default_rng(count), BLOCK + 30
    firsts = np.sort(random.integers(0, nodes - 9, count))
    firsts = {"rising": firsts, "falling": firsts[::-1], "mixed": random.permutation(firsts)}[order]
    rows, dense = make_rows(random, count, nodes, lambda row: firsts[row])
    compliance = random.normal(size=(nodes, nodes))
    compliance += compliance.T
    found = kernels.two_sided_average(compliance, *rows, *rows, True)
    expected = dense @ compliance @ dense.T
    np.testing.assert_allclose(found, np.triu(expected), rtol=1e-13, atol=1e-13 * np.abs(expected).max())


@pytest.mark.parametrize(
    "seen_rows, load_rows", [(3, 2 * TOGETHER + 1), (BLOCK + 9, 7), (TOGETHER, TOGETHER), (0, 3), (3, 0)]
)
def test_rows_meet_others_by_a_compliance_without_symmetry(seen_rows, load_rows):
    random = np.random.default_rng(seen_rows)
    seen, first = make_rows(random, seen_rows, 170, lambda row: random.integers(0, 160))
    loads, second = make_rows(random, load_rows, 190, lambda row: random.integers(0, 180))
    compliance = random.normal(size=(170, 190))
    found = kernels.two_sided_average(compliance, *seen, *loads, False)
    expected = (first @ compliance @ second.T).T
    atol = 1e-13 * np.abs(expected).max(initial=0.0)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=atol)


def make_problem(seed, points):
    random = np.random.default_rng(seed)
    spread = random.normal(size=(points, points))
    compliance = spread @ spread.T + points * np.eye(points)
    return compliance, random.uniform(-0.5, 1.0, points), random.uniform(0.5, 1.0, points)


def solve(compliance, gap, lever_arm, torque, start=None, limits=LIMITS):
    begin = np.zeros(gap.size, bool) if start is None else start
    return kernels.solve_active_set(compliance, gap, lever_arm, torque, begin, *limits)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), points=st.integers(1, 40), torque=st.floats(0.01, 100.0))
def test_active_set_fulfils_the_conditions_from_any_start_and_by_exchanges_alone(seed, points, torque):
    problem = make_problem(seed, points)
    found = solve(*problem, torque)
    start = np.random.default_rng(seed).random(points) < 0.5
    others = solve(*problem, torque, start), solve(*problem, torque, limits=(0, TOLERANCE))
    assert kkt_residual(*problem, torque, found["force"], found["rotation"]) < 1e-12
    assert found["residual"] < 1e-12
    for other in others:
        np.testing.assert_array_equal(found["force"] > 0.0, other["force"] > 0.0)
        np.testing.assert_allclose(found["force"], other["force"], rtol=1e-10, atol=1e-12 * torque)


def test_compliance_that_is_not_positive_definite_has_no_solution():
    compliance, gap, lever_arm = make_problem(0, 6)
    for wrong in (-compliance, np.full_like(compliance, np.nan), np.ones_like(compliance)):
        assert solve(wrong, gap, lever_arm, 1.0)["steps"] == 0


@pytest.mark.parametrize(
    "changes",
    [
        {"gap": np.zeros(5)},
        {"gap": np.zeros(0)},
        {"gap": np.full(6, np.nan)},
        {"lever_arm": np.full(6, np.inf)},
        {"compliance": np.eye(7)},
        {"torque": 0.0},
        {"torque": np.nan},
        {"start": np.zeros(3, bool)},
    ],
)
def test_active_set_refuses_values_that_do_not_fit(changes):
    compliance, gap, lever_arm = make_problem(0, 6)
    fitting = {"compliance": compliance, "gap": gap, "lever_arm": lever_arm, "torque": 1.0}
    with pytest.raises(ValueError, match="must"):
        solve(**{**fitting, **changes})


@pytest.mark.parametrize(
    "wrong", [np.eye(12)[::2, ::2], np.eye(6, dtype=np.float32), np.eye(6, dtype=int), [[1.0]]]
)
def test_arrays_of_another_kind_are_refused(wrong):
    _, gap, lever_arm = make_problem(0, 6)
    with pytest.raises(TypeError):
        solve(wrong, gap, lever_arm, 1.0)


def make_points(**changes):
    fitting = {
        "gap": np.zeros(3),
        "lever_arm": np.ones(3),
        "pinion": np.zeros((3, 2)),
        "gear": np.zeros((3, 2)),
        "function": np.zeros((3, 4), np.int64),
        "value": np.ones((3, 4)),
        "area": np.ones(3),
        "starts": np.array([0, 3]),
        "teeth": np.array([0]),
    }
    return kernels.FacingPoints(**{**fitting, **changes})


def make_cover(functions=9):
    return kernels.Cover(np.zeros(functions), 0, (3, 3), (2.0, 2.0))


def make_surface(**changes):
    steps = np.ascontiguousarray(np.argwhere(np.ones((3, 3))))
    fitting = {
        "shape": (3, 3),
        "steps": steps,
        "pointer": np.arange(10),
        "index": np.arange(9),
        "weight": np.ones(9),
        "own": np.eye(9),
        "others": np.zeros((1, 9, 9)),
        "scale": 1.0,
    }
    return kernels.Surface(**{**fitting, **changes})


@pytest.mark.parametrize(
    "changes",
    [
        {"lever_arm": np.ones(2)},
        {"pinion": np.zeros((3, 3))},
        {"starts": np.array([0, 4])},
        {"starts": np.array([1, 3])},
        {"starts": np.array([0])},
        {"starts": np.array([0, 2, 1, 3]), "teeth": np.arange(3)},
        {"teeth": np.array([2**62])},
        {"value": np.ones((3, 2))},
    ],
)
def test_facing_points_that_do_not_fit_each_other_are_refused(changes):
    with pytest.raises(ValueError):
        make_points(**changes)


@pytest.mark.parametrize(
    "changes",
    [
        {"shape": (3, 4)},
        {"shape": (2, 3), "own": np.eye(6)},
        {"steps": np.full((9, 2), 3)},
        {"steps": np.zeros((5, 2), np.int64)},
        {"index": np.full(9, 9)},
        {"index": np.full(9, -1)},
        {"pointer": np.arange(9), "index": np.arange(8), "weight": np.ones(8)},
        {"own": np.eye(8)},
        {"others": np.zeros((2, 9, 9))},
        {"others": np.zeros((1, 9, 8))},
    ],
)
def test_surfaces_that_do_not_fit_their_lattice_are_refused(changes):
    with pytest.raises(ValueError):
        make_surface(**changes)


def make_solver():
    return kernels.PositionSolver(make_cover(), make_surface(), make_surface(), True, *LIMITS)


STRIP = 0.8, 0.2, 1.6, 0.6, 0.1, np.zeros((0, 0), bool)


@pytest.mark.parametrize(
    "points, torques, strip",
    [
        ({"function": np.full((3, 4), 9)}, [1.0], STRIP),
        ({}, [], STRIP),
        ({}, [-1.0], STRIP),
        ({}, [np.nan], STRIP),
        ({}, [1.0], (0.8, 0.2, 1.0, 0.6, 0.1, np.zeros((0, 0), bool))),
        ({}, [1.0], (*STRIP[:5], np.zeros((2, 9), bool))),
        ({}, [1.0], (*STRIP[:5], np.zeros((1, 8), bool))),
    ],
)
def test_solver_refuses_positions_that_do_not_fit(points, torques, strip):
    with pytest.raises(ValueError):
        make_solver().solve(make_points(**points), np.array(torques), 1.0, *strip)


@pytest.mark.parametrize("gap", [np.nan, np.inf, -np.inf, 2.0])
@pytest.mark.parametrize("limit", [1.0, np.nan])
def test_points_that_face_nothing_make_no_contact(gap, limit):
    points = make_points(gap=np.full(3, gap))
    found = make_solver().solve(points, np.ones(2), limit, *STRIP)
    assert found["candidates"] == 0 and not found["steps"].any() and found["force"].shape == (2, 0)


def test_position_without_points_makes_no_contact():
    none = {name: np.zeros(0) for name in ("gap", "lever_arm", "area")}
    places = {name: np.zeros((0, 2)) for name in ("pinion", "gear")}
    functions = {"function": np.zeros((0, 4), np.int64), "value": np.zeros((0, 4))}
    points = make_points(**none, **places, **functions, starts=np.array([0]), teeth=np.zeros(0, np.int64))
    found = make_solver().solve(points, np.ones(1), 1.0, *STRIP)
    assert found["candidates"] == 0 and found["on_pinion"].shape == (1, 0, 9)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_random_positions_are_solved_or_say_that_they_are_not(seed):
    """Coordinates far beside the lattice, gaps of any size and sign, and parts that are nan."""
    random, count = np.random.default_rng(seed), 40
    gap = random.normal(size=count) * 10.0 ** random.integers(-3, 4, count)
    gap[random.random(count) < 0.1] = np.nan
    points = make_points(
        gap=gap,
        lever_arm=random.normal(size=count),
        pinion=random.uniform(-1e6, 1e6, (count, 2)),
        gear=random.uniform(-3.0, 5.0, (count, 2)),
        function=random.integers(0, 9, (count, 4)),
        value=random.random((count, 4)),
        area=random.random(count),
        starts=np.sort([0, *random.integers(0, count, 2), count]),
        teeth=np.array([-1, 0, 1]),
    )
    found = make_solver().solve(points, np.array([2.0, 1.0]), 10.0 ** random.uniform(-2, 3), *STRIP)
    assert found["rotation"].shape == (2,) and found["node"].min(initial=0) >= 0


def make_front(pivots, boundary):
    return tuple(
        np.zeros(shape, order="F") for shape in ((pivots, pivots), (boundary, pivots), (boundary, boundary))
    )


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), pivots=st.integers(0, 6), boundary=st.integers(0, 6))
def test_element_matrices_are_added_to_the_lower_triangle_of_a_front(seed, pivots, boundary):
    random, size = np.random.default_rng(seed), pivots + boundary
    elements, rows = random.normal(size=(4, 3, 3)), random.integers(0, 5, (4, 3))
    moved = (
        sp.random_array((5, size), density=0.5, format="csr", rng=random) if size else sp.csr_array((5, 0))
    )
    place, front = random.permutation(size), make_front(pivots, boundary)
    indices = moved.indptr.astype(np.int64), moved.indices.astype(np.int64)
    kernels.add_elements(elements + elements.swapaxes(1, 2), rows, *indices, moved.data, place, *front)
    expected, order = np.zeros((size, size)), np.argsort(place)
    for matrix, row in zip(elements + elements.swapaxes(1, 2), rows, strict=True):
        by = moved.toarray()[row][:, order]
        expected += by.T @ matrix @ by
    found = np.block([[front[0], np.zeros((pivots, boundary))], [front[1], front[2]]])
    np.testing.assert_allclose(np.tril(found), np.tril(expected), atol=1e-13)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), pivots=st.integers(0, 6), boundary=st.integers(0, 6))
def test_update_of_an_earlier_front_is_added_at_its_places(seed, pivots, boundary):
    random, size = np.random.default_rng(seed), pivots + boundary
    place = np.sort(random.permutation(size)[: random.integers(0, size + 1)])
    added, front = (
        np.asfortranarray(random.normal(size=(place.size, place.size))),
        make_front(pivots, boundary),
    )
    kernels.extend_add(added, place, *front)
    expected = np.zeros((size, size))
    expected[np.ix_(place, place)] = np.tril(added)
    found = np.block([[front[0], np.zeros((pivots, boundary))], [front[1], front[2]]])
    np.testing.assert_array_equal(found, expected)


def test_elimination_refuses_what_does_not_fit_its_front():
    front, place, none = make_front(2, 1), np.arange(3), np.zeros(0, np.int64)
    unknowns = np.array([0, 1]), np.array([0]), np.ones(1)
    element, row = np.ones((1, 1, 1)), np.zeros((1, 1), np.int64)
    kernels.add_elements(element, row, *unknowns, place, *front)
    for wrong in ((row + 1, *unknowns, place), (row, *unknowns, place + 3), (row, *unknowns, none)):
        with pytest.raises(ValueError):
            kernels.add_elements(element, *wrong, *front)
    with pytest.raises(ValueError):
        kernels.extend_add(np.ones((2, 2), order="F"), np.array([1, 0]), *front)
    with pytest.raises(ValueError):
        kernels.extend_add(np.ones((1, 1), order="F"), np.array([3]), *front)
    with pytest.raises(ValueError):
        kernels.extend_add(
            np.ones((1, 1), order="F"), np.array([0]), *make_front(2, 1)[:2], make_front(0, 2)[2]
        )
    with pytest.raises(TypeError):
        kernels.extend_add(np.ones((2, 2))[:, ::-1], np.arange(2), *front)
