"""Requests for memory inside compiled functions."""

import numba
import numpy as np
import pytest
from numba.core.errors import TypingError

from facegear.machine_code.prefetch import request


@numba.njit
def summed(table, ahead):
    total = 0.0
    for i in range(table.size):
        request(table, min(i + ahead, table.size - 1))
        total += table.flat[i]
    return total


def test_a_request_becomes_an_instruction_and_changes_nothing():
    table = np.arange(60.0).reshape(6, 10)
    assert summed(table, 8) == 1770.0
    np.testing.assert_array_equal(table, np.arange(60.0).reshape(6, 10))
    assert "llvm.prefetch" in next(iter(summed.inspect_llvm().values()))


def test_only_what_is_contiguous_can_be_requested():
    with pytest.raises(TypingError):
        summed(np.asfortranarray(np.ones((6, 10))), 8)
