"""New arrays inside compiled functions.

Numba compiles NumPy's own functions for them anew for each type, to machine code of their own, a tenth of a
second each. These are made of its code generator where its version is known.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import from_dtype, njit, types

from facegear.machine_code.versions import NUMBA_IS_KNOWN


def _codes(array: types.Array, zeros: bool, *counts: Any) -> Any:
    """What an intrinsic returns that makes an array of a type, by its numbers of rows and columns."""
    from numba.core import cgutils
    from numba.core.imputils import impl_ret_new_ref
    from numba.np.arrayobj import _empty_nd_impl

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        made = _empty_nd_impl(context, builder, array, args[-array.ndim :])
        if zeros:
            cgutils.memset(builder, made.data, builder.mul(made.nitems, made.itemsize), 0)
        return impl_ret_new_ref(context, builder, array, made._getvalue())

    return array(*counts[: -array.ndim], *[types.intp] * array.ndim), code


def _maker(kind: type, dimensions: int, zeros: bool) -> Callable[..., Any]:
    """A function for compiled callers that makes an array of a kind by its numbers of rows and columns."""
    if not NUMBA_IS_KNOWN:
        make = np.zeros if zeros else np.empty
        return njit(
            (
                lambda count: make(count, kind),
                lambda rows, columns: make((rows, columns), kind),
                lambda blocks, rows, columns: make((blocks, rows, columns), kind),
            )[dimensions - 1]
        )
    from numba.extending import intrinsic

    array = types.Array(from_dtype(np.dtype(kind)), dimensions, "C")
    return intrinsic(
        (
            lambda typing, count: _codes(array, zeros, count),
            lambda typing, rows, columns: _codes(array, zeros, rows, columns),
            lambda typing, blocks, rows, columns: _codes(array, zeros, blocks, rows, columns),
        )[dimensions - 1]
    )


def _alike() -> Callable[..., Any]:
    """A function that makes an array of so many items of another one's kind."""
    if not NUMBA_IS_KNOWN:
        return njit(lambda values, count: np.empty(count, values.dtype))
    from numba.extending import intrinsic

    return intrinsic(
        lambda typing, values, count: _codes(types.Array(values.dtype, 1, "C"), False, values, count)
    )


alike = _alike()
numbers, integers, unsigned, marks = (
    _maker(kind, 1, False) for kind in (float, np.int64, np.uint64, np.bool_)
)
table = _maker(float, 2, False)
zeros, cube, no_marks, integer_table = (
    _maker(kind, dimensions, True)
    for kind, dimensions in ((float, 2), (float, 3), (np.bool_, 2), (np.int64, 2))
)
