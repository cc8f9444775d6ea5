"""Vectors of eight doubles inside compiled functions, one double for each machine that runs side by side.

LLVM splits them where the processor's own vectors are shorter. Indices count vectors.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, models, register_model

WIDTH = 8
"""Machines that run side by side."""
_VECTOR = ir.VectorType(ir.DoubleType(), WIDTH)
_BITS = ir.VectorType(ir.IntType(64), WIDTH)
_MANTISSA, _ONE, _BIAS = 52, 1023 << 52, 1023


class WideType(types.Type):
    """Compile-time type of WIDTH doubles."""

    def __init__(self) -> None:
        super().__init__(name=f"wide{WIDTH}")


doubles = WideType()


@register_model(WideType)
class _WideModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: WideType) -> None:
        super().__init__(manager, kind, _VECTOR)


def _is_plain(array: Any) -> bool:
    return isinstance(array, types.Array) and array.layout == "C" and array.dtype == types.float64


def _pointer(context: Any, builder: Any, kind: types.Array, array: Any, index: Any) -> Any:
    data = context.make_array(kind)(context, builder, array).data
    return builder.gep(builder.bitcast(data, _VECTOR.as_pointer()), [index])


def _constant(kind: ir.VectorType, value: Any) -> ir.Constant:
    return ir.Constant(kind, [value] * WIDTH)


@intrinsic
def load(typing_context: Any, array: Any, index: Any) -> Any:
    """Vector number `index` of a C-contiguous float64 array."""
    if not _is_plain(array):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.load(_pointer(context, builder, array, *args), align=8)

    return doubles(array, types.intp), code


@intrinsic
def store(typing_context: Any, array: Any, index: Any, value: Any) -> Any:
    """Write vector number `index` of a C-contiguous float64 array."""
    if not _is_plain(array):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        builder.store(args[2], _pointer(context, builder, array, *args[:2]), align=8)
        return context.get_dummy_value()

    return types.void(array, types.intp, doubles), code


@intrinsic
def splat(typing_context: Any, value: Any) -> Any:
    """The same double in every lane."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        first = builder.insert_element(
            ir.Constant(_VECTOR, ir.Undefined), args[0], ir.Constant(ir.IntType(32), 0)
        )
        order = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH)
        return builder.shuffle_vector(first, first, order)

    return doubles(types.float64), code


def _arithmetic(operation: str) -> Any:
    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return getattr(builder, operation)(*args)

    return doubles(doubles, doubles), code


@intrinsic
def add(typing_context: Any, first: Any, second: Any) -> Any:
    """first + second."""
    return _arithmetic("fadd")


@intrinsic
def subtract(typing_context: Any, first: Any, second: Any) -> Any:
    """first - second."""
    return _arithmetic("fsub")


@intrinsic
def multiply(typing_context: Any, first: Any, second: Any) -> Any:
    """first * second."""
    return _arithmetic("fmul")


@intrinsic
def divide(typing_context: Any, first: Any, second: Any) -> Any:
    """first / second."""
    return _arithmetic("fdiv")


def _vector_call(name: str, arguments: int) -> Any:
    """An LLVM intrinsic on whole vectors."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(_VECTOR, [_VECTOR] * arguments)
        full = f"llvm.{name}.v{WIDTH}f64"
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, full), args)

    return doubles(*[doubles] * arguments), code


@intrinsic
def multiply_add(typing_context: Any, first: Any, second: Any, third: Any) -> Any:
    """first * second + third, fused where the processor can."""
    return _vector_call("fmuladd", 3)


@intrinsic
def magnitude(typing_context: Any, value: Any) -> Any:
    """Absolute value."""
    return _vector_call("fabs", 1)


@intrinsic
def smaller(typing_context: Any, first: Any, second: Any) -> Any:
    """The smaller of two."""
    return _vector_call("minnum", 2)


@intrinsic
def larger(typing_context: Any, first: Any, second: Any) -> Any:
    """The larger of two."""
    return _vector_call("maxnum", 2)


@intrinsic
def nearest(typing_context: Any, value: Any) -> Any:
    """The nearest whole number."""
    return _vector_call("rint", 1)


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
