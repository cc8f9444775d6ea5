"""Parts of arrays as compiled callers take them: numba compiles each use of NumPy's own indexing anew, with
all that can be indexed, for a second; these once for a type.
"""

import numpy as np

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.machine_code.compiler import for_callers

called = for_callers(forceinline=False, fastmath=False, error_model="python")


@called
def taken(values: AnyArray, index: Integers) -> AnyArray:
    """values[index] of one dimension."""
    result = np.empty(index.size, values.dtype)
    for i in range(index.size):
        result[i] = values[index[i]]
    return result


@called
def marked(mask: Mask) -> Integers:
    """The indices (m,) that are marked (n,), rising."""
    count = 0
    for i in range(mask.size):
        count += 1 if mask[i] else 0
    index, row = np.empty(count, np.int64), 0
    for i in range(mask.size):
        if mask[i]:
            index[row] = i
            row += 1
    return index


@called
def integers(count: int, value: int) -> Integers:
    """As many integers (n,) of one value."""
    result = np.empty(count, np.int64)
    for i in range(count):
        result[i] = value
    return result


@called
def numbers(count: int, value: float) -> Array:
    """As many numbers (n,) of one value."""
    result = np.empty(count)
    for i in range(count):
        result[i] = value
    return result


@called
def table(rows: int, columns: int) -> Array:
    """Zeros (n, m)."""
    return np.zeros((rows, columns))


@called
def empty_table(rows: int, columns: int) -> Array:
    """Room for numbers (n, m)."""
    return np.empty((rows, columns))


@called
def empty_numbers(count: int) -> Array:
    """Room for numbers (n,)."""
    return np.empty(count)


@called
def empty_integers(count: int) -> Integers:
    """Room for integers (n,)."""
    return np.empty(count, np.int64)


@called
def unsigned(index: Integers) -> AnyArray:
    """The same indices as numbers without a sign: compiled loops look for one at every use of others."""
    result = np.empty(index.size, np.uint64)
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
