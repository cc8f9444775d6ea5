"""Parts of arrays, and new ones, as compiled callers take them: numba compiles each use of NumPy's own
indexing anew, with all that can be indexed, for a second; these once for a type.
"""

from pathlib import Path

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.machine_code import rooms
from facegear.machine_code.compiler import for_callers

SOURCES = (Path(__file__).parent,)
"""Files that machine code of such callers follows from, beside their own."""
called = for_callers(forceinline=False, fastmath=False, error_model="python")


@called
def taken(values: AnyArray, index: Integers) -> AnyArray:
    """values[index] of one dimension."""
    result = rooms.alike(values, index.size)
    for i in range(index.size):
        result[i] = values[index[i]]
    return result


@called
def marked(mask: Mask) -> Integers:
    """The indices (m,) that are marked (n,), rising."""
    count = 0
    for i in range(mask.size):
        count += 1 if mask[i] else 0
    index, row = rooms.integers(count), 0
    for i in range(mask.size):
        if mask[i]:
            index[row] = i
            row += 1
    return index


@called
def integers(count: int, value: int) -> Integers:
    """As many integers (n,) of one value."""
    result = rooms.integers(count)
    for i in range(count):
        result[i] = value
    return result


@called
def numbers(count: int, value: float) -> Array:
    """As many numbers (n,) of one value."""
    result = rooms.numbers(count)
    for i in range(count):
        result[i] = value
    return result


@called
def marks(count: int, value: bool) -> Mask:
    """As many marks (n,) of one value."""
    result = rooms.marks(count)
    for i in range(count):
        result[i] = value
    return result


@called
def mark_table(rows: int, columns: int) -> Mask:
    """Marks (n, m), none of them set."""
    return rooms.no_marks(rows, columns)


@called
def cube(blocks: int, rows: int, columns: int) -> Array:
    """Zeros (k, n, m)."""
    return rooms.cube(blocks, rows, columns)


@called
def integer_table(rows: int, columns: int) -> Integers:
    """Integers 0 (n, m)."""
    return rooms.integer_table(rows, columns)


@called
def table(rows: int, columns: int) -> Array:
    """Zeros (n, m)."""
    return rooms.zeros(rows, columns)


@called
def empty_table(rows: int, columns: int) -> Array:
    """Room for numbers (n, m)."""
    return rooms.table(rows, columns)


@called
def empty_numbers(count: int) -> Array:
    """Room for numbers (n,)."""
    return rooms.numbers(count)


@called
def empty_integers(count: int) -> Integers:
    """Room for integers (n,)."""
    return rooms.integers(count)


@called
def unsigned(index: Integers) -> AnyArray:
    """The same indices as numbers without a sign: compiled loops look for one at every use of others."""
    result = rooms.unsigned(index.size)
    for i in range(index.size):
        result[i] = index[i]
    return result


@called
def listed(mark: Integers) -> tuple[Integers, Integers]:
    """The indices whose marks (n,) are not 0, rising, and the index of each among them, -1 of the others."""
    used, slot = marked(mark), integers(mark.size, -1)
    for i in range(used.size):
        slot[used[i]] = i
    return used, slot
