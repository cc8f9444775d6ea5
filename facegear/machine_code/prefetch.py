"""Requests for memory ahead of its use, inside compiled functions."""

from typing import Any

from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic

from facegear.machine_code.versions import NUMBA_IS_KNOWN

_FOR_READING, _KEPT, _DATA = (ir.Constant(ir.IntType(32), value) for value in (0, 3, 1))


@intrinsic
def _request(typing_context: Any, array: Any, index: Any) -> Any:
    """Have the processor fetch the line of its cache that holds an element of a C-contiguous array, at a flat
    index, without waiting for it. Nothing is changed.
    """
    if not (isinstance(array, types.Array) and array.layout == "C"):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        from facegear.machine_code.vectors import data_of

        data = data_of(context, builder, array, args[0])
        address = builder.bitcast(builder.gep(data, [args[1]]), ir.IntType(8).as_pointer())
        constants = [_FOR_READING, _KEPT, _DATA]
        kind = ir.FunctionType(ir.VoidType(), [address.type, *(constant.type for constant in constants)])
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0")
        builder.call(function, [address, *constants])
        return context.get_dummy_value()

    return types.void(array, types.intp), code


@njit
def _ask_for_nothing(array: Any, index: Any) -> None:
    """In place of a request, which changes nothing."""


request = _request if NUMBA_IS_KNOWN else _ask_for_nothing
