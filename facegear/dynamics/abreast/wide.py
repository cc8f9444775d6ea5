"""Vectors of eight doubles inside compiled functions, one double for each machine that runs side by side.

LLVM splits them where the processor's own vectors are shorter. Indices count vectors. Arithmetic that the
vectors of a single machine need as well, which are shorter, is in `facegear.machine_code.vectors`.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from facegear.machine_code.vectors import (
    DOUBLE,
    VectorType,
    instruction,
    loaded,
    splatted,
    vector_call,
    written,
)

WIDTH = 8
"""Machines that run side by side."""
doubles = VectorType(WIDTH)
_VECTOR, _BITS = doubles.of(DOUBLE), doubles.of(ir.IntType(64))
_MANTISSA, _ONE, _BIAS = 52, 1023 << 52, 1023


def _constant(kind: ir.VectorType, value: Any) -> ir.Constant:
    return ir.Constant(kind, [value] * WIDTH)


@intrinsic
def load(typing_context: Any, array: Any, index: Any) -> Any:
    """Vector number `index` of a C-contiguous float64 array."""
    return loaded(doubles, array, _VECTOR)


@intrinsic
def store(typing_context: Any, array: Any, index: Any, value: Any) -> Any:
    """Write vector number `index` of a C-contiguous float64 array."""
    return written(doubles, array, _VECTOR)


@intrinsic
def splat(typing_context: Any, value: Any) -> Any:
    """The same double in every lane."""
    return splatted(doubles)


@intrinsic
def subtract(typing_context: Any, first: Any, second: Any) -> Any:
    """first - second."""
    return instruction("fsub", doubles)


@intrinsic
def divide(typing_context: Any, first: Any, second: Any) -> Any:
    """first / second."""
    return instruction("fdiv", doubles)


@intrinsic
def nearest(typing_context: Any, value: Any) -> Any:
    """The nearest whole number."""
    return vector_call("rint", doubles, 1)


@intrinsic
def where_positive(typing_context: Any, test: Any, then: Any, otherwise: Any) -> Any:
    """`then` where test > 0, else `otherwise`."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.select(builder.fcmp_ordered(">", args[0], _constant(_VECTOR, 0.0)), *args[1:])

    return doubles(doubles, doubles, doubles), code


@intrinsic
def exponent(typing_context: Any, value: Any) -> Any:
    """The power of two in positive normal numbers, as doubles."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        bits = builder.lshr(builder.bitcast(args[0], _BITS), _constant(_BITS, _MANTISSA))
        return builder.sitofp(builder.sub(bits, _constant(_BITS, _BIAS)), _VECTOR)

    return doubles(doubles), code


@intrinsic
def mantissa(typing_context: Any, value: Any) -> Any:
    """Positive normal numbers over their power of two, in [1, 2)."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        bits = builder.and_(builder.bitcast(args[0], _BITS), _constant(_BITS, (1 << _MANTISSA) - 1))
        return builder.bitcast(builder.or_(bits, _constant(_BITS, _ONE)), _VECTOR)

    return doubles(doubles), code


@intrinsic
def power_of_two(typing_context: Any, value: Any) -> Any:
    """Two to the power of whole numbers between -1022 and 1023."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        whole = builder.add(builder.fptosi(args[0], _BITS), _constant(_BITS, _BIAS))
        return builder.bitcast(builder.shl(whole, _constant(_BITS, _MANTISSA)), _VECTOR)

    return doubles(doubles), code


@intrinsic
def positive_lanes(typing_context: Any, test: Any) -> Any:
    """A number whose bit l says whether test > 0 in lane l."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        positive = builder.fcmp_ordered(">", args[0], _constant(_VECTOR, 0.0))
        return builder.zext(builder.bitcast(positive, ir.IntType(WIDTH)), ir.IntType(64))

    return types.int64(doubles), code
