"""Averages of a compliance on both sides against dense products of the same matrices."""

import numpy as np
import pytest
import scipy.sparse as sp

from facegear.contact.both_sides import BLOCK, TOGETHER, add_averages
from facegear.contact.influence import mirror


def sparse_rows(random, rows, columns, begin):
    """Rows with a few neighbouring entries each, from column `begin` of the row on."""
    matrix = np.zeros((rows, columns))
    for row in range(rows):
        first = begin(row)
        matrix[row, first : first + random.integers(1, 9)] = 1.0 + random.random()
    matrix = sp.csr_matrix(matrix)
    return (matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64), matrix.data), matrix.toarray()


@pytest.mark.parametrize("count", [1, TOGETHER, TOGETHER + 1, 3 * TOGETHER + 5, BLOCK + 3])
@pytest.mark.parametrize("order", ["rising", "falling", "mixed"])
def test_rows_meet_themselves_as_in_a_dense_product_whatever_their_order(count, order):
    random, nodes = np.random.default_rng(count), 2 * BLOCK + 30
    firsts = np.sort(random.integers(0, nodes - 9, count))
    firsts = {"rising": firsts, "falling": firsts[::-1], "mixed": random.permutation(firsts)}[order]
    rows, dense = sparse_rows(random, count, nodes, lambda row: firsts[row])
    compliance = random.normal(size=(nodes, nodes))
    compliance += compliance.T
    matrix = np.zeros((count + 4, count + 4))
    add_averages(matrix, (2, 2), 0.5, rows, compliance, rows, True)
    expected = 0.5 * dense @ compliance @ dense.T
    whole = matrix[2:-2, 2:-2]
    np.testing.assert_allclose(whole, np.triu(expected), rtol=1e-13, atol=1e-13 * np.abs(expected).max())
    assert not matrix[:2].any() and not matrix[-2:].any() and not matrix[:, :2].any()
    whole = np.ascontiguousarray(whole)
    mirror(whole)
    np.testing.assert_allclose(whole, expected, rtol=1e-13, atol=1e-13 * np.abs(expected).max())


@pytest.mark.parametrize(
    "seen_rows, load_rows", [(3, 2 * TOGETHER + 1), (BLOCK + 9, 7), (TOGETHER, TOGETHER)]
)
def test_rows_meet_others_by_a_compliance_without_symmetry(seen_rows, load_rows):
    random = np.random.default_rng(seen_rows)
    seen, first = sparse_rows(random, seen_rows, 170, lambda row: random.integers(0, 160))
    loads, second = sparse_rows(random, load_rows, 190, lambda row: random.integers(0, 180))
    compliance = random.normal(size=(170, 190))
    matrix = np.ones((load_rows + 1, seen_rows + 2))
    add_averages(matrix, (1, 2), 3.0, seen, compliance, loads, False)
    expected = 1.0 + 3.0 * (first @ compliance @ second.T).T
    np.testing.assert_allclose(matrix[1:, 2:], expected, rtol=1e-12, atol=1e-13 * np.abs(expected).max())
    assert (matrix[0] == 1.0).all() and (matrix[:, :2] == 1.0).all()
