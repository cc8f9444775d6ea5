"""Records: what compiled functions read of them, and that their calls and loops stay as small as written."""

import re
import sys
from typing import NamedTuple

import numpy as np
import pytest

from facegear.machine_code.compiler import FAST, compiler, for_callers
from facegear.machine_code.kept import VARIABLE
from facegear.machine_code.records import Record

kernel = compiler(as_written=True, **FAST)
inlined = for_callers(**FAST)


@Record.register
class Inner(NamedTuple):
    """A record within another one."""

    factor: float
    table: np.ndarray


@Record.register
class Outer(NamedTuple):
    """One field of every kind."""

    count: int
    inner: Inner
    absent: Inner | None
    adds: bool
    cube: np.ndarray
    kinds: np.ndarray
    ends: tuple[float, float]
    rows: tuple[int, tuple[np.ndarray, float]]
    out: np.ndarray


@pytest.fixture(autouse=True)
def _own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))


def record(size, adds):
    """A record whose arrays depend on a size."""
    cube = np.arange(6.0 * size).reshape(size, 2, 3)
    inner = Inner(0.5 + size, np.arange(2.0 * size).reshape(2, size) ** 2)
    return Outer(
        size,
        inner,
        None,
        adds,
        cube,
        np.arange(size)[::-1].copy(),
        (0.25, size + 0.5),
        (size, (np.arange(2.0 * size), 0.75)),
        np.zeros(size),
    )


def fill(outer, inner):
    """Write to the record's own array, and read again what was written."""
    total = 0.0
    for i in range(outer.count):
        sign = 1.0 if outer.adds else -1.0
        column = outer.cube[outer.kinds[i]]
        outer.out[i] = inner.factor * inner.table[1, i] + sign * column[1, 2] * column.shape[1]
        if outer.absent is None:
            total += outer.out[i] + outer.out.size - outer.ends[1] * outer.ends[0]
        count, (values, factor) = outer.rows
        total += factor * values[count + i]
    return total


def test_compiled_functions_read_of_a_record_and_write_to_its_arrays_what_python_does():
    part = inlined(fill)
    call = kernel(lambda outer: part(outer, outer.inner))
    for size, adds in ((2, True), (5, False), (2, False)):
        mine, python = record(size, adds), record(size, adds)
        assert call(mine) == fill(python, python.inner)
        np.testing.assert_array_equal(mine.out, python.out)
    assert len(call.signatures) == 1


def test_functions_that_make_arrays_read_a_record_and_keep_none_of_its_arrays():
    mine = record(3, True)
    owners = [sys.getrefcount(mine.out)]

    @compiler()
    def doubled(outer):
        made = np.empty(outer.count)
        for i in range(outer.count):
            made[i] = 2.0 * outer.inner.table[1, i]
        return made, outer.kinds.copy()

    made, kinds = doubled(mine)
    np.testing.assert_array_equal(made, 2.0 * mine.inner.table[1])
    np.testing.assert_array_equal(kinds, mine.kinds)
    owners.append(sys.getrefcount(mine.out))
    assert owners[0] == owners[1]


def test_a_field_that_compiled_functions_cannot_read_is_named():
    call = kernel(lambda inner: inner.factor)
    with pytest.raises(TypeError, match=r"^Inner\.table must not be array\(float64, 2d, F\)$"):
        call(Inner(1.0, np.zeros((3, 2)).T))


def add_all(values):
    """The sum of values that wait for each other."""
    total = 0.0
    for i in range(values.size):
        total = total * 0.5 + values[i]
    return total


@pytest.mark.parametrize("as_written", [True, False])
def test_loops_are_unrolled_unless_as_written(as_written):
    function = compiler(as_written=as_written, **FAST)(add_all)
    assert function(np.ones(3)) == 1.75
    (code,) = function.inspect_asm().values()
    assert (len(re.findall("fmadd|mulsd|fmul", code)) == 1) == as_written
