"""Arrays as compiled functions read them fastest; no compiler is needed to make them."""

import math
from collections.abc import Mapping

import numpy as np

from facegear.arrays import Array

LANES = 4
"""Numbers that a vector holds."""
_LINE = 64


def aligned(*shape: int) -> Array:
    """Zeros that start on a line of the processor's cache: a vector that lies across two is read twice."""
    size, width = math.prod(shape), _LINE // 8
    room = np.zeros(size + width)
    start = -room.__array_interface__["data"][0] % _LINE // 8
    return room[start : start + size].reshape(shape)


def aligned_together(shapes: Mapping[str, tuple[int, ...]]) -> dict[str, Array]:
    """Arrays by name, each as aligned() makes it, in one piece of memory."""
    per_line = _LINE // 8
    sizes = [math.prod(shape) for shape in shapes.values()]
    room, begin, tables = aligned(sum(sizes) + per_line * len(sizes)), 0, {}
    for (name, shape), size in zip(shapes.items(), sizes, strict=True):
        tables[name] = room[begin : begin + size].reshape(shape)
        begin += -(-size // per_line) * per_line
    return tables


def whole_lanes(length: int) -> int:
    """The length of an array padded to whole vectors."""
    return -(-length // LANES) * LANES


def padded(values: Array, length: int) -> Array:
    """Values with zeros behind the last row up to a length."""
    buffer = aligned(length, *values.shape[1:])
    buffer[: len(values)] = values
    return buffer


def divided(values: Array, divisor: float) -> Array:
    """Values over a divisor, in an aligned array."""
    return np.divide(values, divisor, out=aligned(*values.shape))
