"""The functions of `lanes.py` on tuples of four doubles, by the public part of numba alone.

Slower by a factor of a few. Arrays are C-contiguous, indices are flat.
"""

from typing import Any

from numba import njit

from facegear.arrays import AnyArray, Array

Four = tuple[float, float, float, float]


@njit
def load(array: Array, index: int) -> Four:
    """Four values from an index on."""
    flat = array.flat
    return flat[index], flat[index + 1], flat[index + 2], flat[index + 3]


@njit
def store(array: Array, index: int, value: Four) -> None:
    """Write four values from an index on."""
    flat = array.flat
    flat[index] = value[0]
    flat[index + 1] = value[1]
    flat[index + 2] = value[2]
    flat[index + 3] = value[3]


@njit
def splat(value: float) -> Four:
    """The same number four times."""
    return value, value, value, value


@njit
def take(array: AnyArray, index: int) -> Any:
    """One value."""
    return array.flat[index]


@njit
def spread(array: Array, index: int) -> Four:
    """One value four times."""
    value = array.flat[index]
    return value, value, value, value


@njit
def put(array: Array, index: int, value: float) -> None:
    """Write one value."""
    array.flat[index] = value


@njit
def multiply(a: Four, b: Four) -> Four:
    """a * b, each by each."""
    return a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]


@njit
def add(a: Four, b: Four) -> Four:
    """a + b, each to each."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]


@njit
def multiply_add(a: Four, b: Four, c: Four) -> Four:
    """a * b + c, each by each."""
    return a[0] * b[0] + c[0], a[1] * b[1] + c[1], a[2] * b[2] + c[2], a[3] * b[3] + c[3]


@njit
def magnitude(a: Four) -> Four:
    """Absolute values."""
    return abs(a[0]), abs(a[1]), abs(a[2]), abs(a[3])


@njit
def smaller(a: Four, b: Four) -> Four:
    """The smaller of each two."""
    return min(a[0], b[0]), min(a[1], b[1]), min(a[2], b[2]), min(a[3], b[3])


@njit
def larger(a: Four, b: Four) -> Four:
    """The larger of each two."""
    return max(a[0], b[0]), max(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3])


@njit
def sums(a: Four, b: Four, c: Four, d: Four) -> Four:
    """The sum of each of four."""
    return _sum(a), _sum(b), _sum(c), _sum(d)


@njit
def _sum(a: Four) -> float:
    return a[0] + a[2] + (a[1] + a[3])


@njit
def swap_neighbours(a: Four) -> Four:
    """Values 1, 0, 3, 2."""
    return a[1], a[0], a[3], a[2]


@njit
def swap_halves(a: Four) -> Four:
    """Values 2, 3, 0, 1."""
    return a[2], a[3], a[0], a[1]


@njit
def swap_ends(a: Four) -> Four:
    """Values 3, 2, 1, 0."""
    return a[3], a[2], a[1], a[0]
