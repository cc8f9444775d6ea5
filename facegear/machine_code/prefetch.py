"""Requests for memory ahead of its use, inside compiled functions."""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

LINE = 8
"""Doubles in a line of the cache."""
_FOR_READING, _KEPT, _DATA = (ir.Constant(ir.IntType(32), value) for value in (0, 3, 1))


@intrinsic
def request(typing_context: Any, table: Any, row: Any, column: Any) -> Any:
    """Have the processor fetch the line of the cache with an element of a C-contiguous table, not waiting for
    it. Nothing is changed.
    """
    if not (isinstance(table, types.Array) and table.layout == "C" and table.ndim == 2):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        array = context.make_array(table)(context, builder, args[0])
        width = cgutils.unpack_tuple(builder, array.shape, 2)[1]
        at = builder.add(builder.mul(args[1], width), args[2])
        address = builder.bitcast(builder.gep(array.data, [at]), ir.IntType(8).as_pointer())
        constants = [_FOR_READING, _KEPT, _DATA]
        kind = ir.FunctionType(ir.VoidType(), [address.type, *(constant.type for constant in constants)])
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0")
        builder.call(function, [address, *constants])
        return context.get_dummy_value()

    return types.void(table, types.uint64, types.uint64), code
