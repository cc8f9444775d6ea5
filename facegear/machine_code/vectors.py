"""Vectors of four doubles inside compiled functions, made of numba's code generator and LLVM.

LLVM leaves loops as short as these (10 meshes, 17 coordinates) scalar; with explicit vectors an order of the
Taylor recurrence costs a third. Vectors of four are plain LLVM and run on any processor.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, models, register_model

from facegear.machine_code.memory import LANES

_VECTOR = ir.VectorType(ir.DoubleType(), LANES)


class LanesType(types.Type):
    """Compile-time type of LANES doubles."""

    def __init__(self) -> None:
        super().__init__(name=f"lanes{LANES}")


lanes = LanesType()


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: LanesType) -> None:
        super().__init__(manager, kind, _VECTOR)


def _is_plain(array: Any) -> bool:
    return isinstance(array, types.Array) and array.layout == "C" and array.dtype == types.float64


def _place(context: Any, builder: Any, kind: types.Array, array: Any, index: Any) -> Any:
    return builder.gep(context.make_array(kind)(context, builder, array).data, [index])


def _pointer(context: Any, builder: Any, kind: types.Array, array: Any, index: Any) -> Any:
    return builder.bitcast(_place(context, builder, kind, array, index), _VECTOR.as_pointer())


def _splat(builder: Any, value: Any) -> Any:
    vector = ir.Constant(_VECTOR, ir.Undefined)
    for lane in range(LANES):
        vector = builder.insert_element(vector, value, ir.Constant(ir.IntType(32), lane))
    return vector


@intrinsic
def load(typing_context: Any, array: Any, index: Any) -> Any:
    """LANES values of a C-contiguous float64 array from a flat index on."""
    if not _is_plain(array):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.load(_pointer(context, builder, array, *args), align=8)

    return lanes(array, types.intp), code


@intrinsic
def store(typing_context: Any, array: Any, index: Any, value: Any) -> Any:
    """Write LANES values to a C-contiguous float64 array from a flat index on."""
    if not _is_plain(array):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        builder.store(args[2], _pointer(context, builder, array, *args[:2]), align=8)
        return context.get_dummy_value()

    return types.void(array, types.intp, lanes), code


@intrinsic
def splat(typing_context: Any, value: Any) -> Any:
    """The same double in every lane."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _splat(builder, args[0])

    return lanes(types.float64), code


@intrinsic
def spread(typing_context: Any, array: Any, index: Any) -> Any:
    """One value of a C-contiguous float64 array, at a flat index, in every lane (no check of the index)."""
    if not _is_plain(array):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _splat(builder, builder.load(_place(context, builder, array, *args)))

    return lanes(array, types.intp), code


@intrinsic
def take(typing_context: Any, array: Any, index: Any) -> Any:
    """One value of a C-contiguous array of numbers at a flat index, which is not checked or wrapped."""
    if not (isinstance(array, types.Array) and array.layout == "C"):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.load(_place(context, builder, array, *args))

    return array.dtype(array, types.intp), code


@intrinsic
def put(typing_context: Any, array: Any, index: Any, value: Any) -> Any:
    """Write one value to a C-contiguous float64 array at a flat index, which is not checked or wrapped."""
    if not _is_plain(array):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        builder.store(args[2], _place(context, builder, array, *args[:2]))
        return context.get_dummy_value()

    return types.void(array, types.intp, types.float64), code


@intrinsic
def multiply(typing_context: Any, first: Any, second: Any) -> Any:
    """first * second in every lane."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fmul(*args)

    return lanes(lanes, lanes), code


@intrinsic
def add(typing_context: Any, first: Any, second: Any) -> Any:
    """first + second in every lane."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fadd(*args)

    return lanes(lanes, lanes), code


def _vector_call(name: str, arguments: int) -> Any:
    """An LLVM intrinsic on whole vectors."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(_VECTOR, [_VECTOR] * arguments)
        full = f"llvm.{name}.v{LANES}f64"
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, full), args)

    return code


@intrinsic
def multiply_add(typing_context: Any, first: Any, second: Any, third: Any) -> Any:
    """first * second + third in every lane, fused where the processor can."""
    return lanes(lanes, lanes, lanes), _vector_call("fmuladd", 3)


@intrinsic
def magnitude(typing_context: Any, value: Any) -> Any:
    """Absolute value in every lane."""
    return lanes(lanes), _vector_call("fabs", 1)


@intrinsic
def smaller(typing_context: Any, first: Any, second: Any) -> Any:
    """The smaller of two in every lane."""
    return lanes(lanes, lanes), _vector_call("minnum", 2)


@intrinsic
def larger(typing_context: Any, first: Any, second: Any) -> Any:
    """The larger of two in every lane."""
    return lanes(lanes, lanes), _vector_call("maxnum", 2)


def _shuffled(builder: Any, first: Any, second: Any, *order: int) -> Any:
    return builder.shuffle_vector(first, second, ir.Constant(ir.VectorType(ir.IntType(32), LANES), order))


def _pairs(builder: Any, first: Any, second: Any) -> Any:
    """Sums of neighbours: of the first vector in lanes 0 and 2, of the second in lanes 1 and 3."""
    even = _shuffled(builder, first, second, 0, 4, 2, 6)
    return builder.fadd(even, _shuffled(builder, first, second, 1, 5, 3, 7))


def _reordered(*order: int) -> Any:
    """The lanes of a vector in another order."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _shuffled(builder, args[0], args[0], *order)

    return lanes(lanes), code


@intrinsic
def swap_neighbours(typing_context: Any, value: Any) -> Any:
    """Lanes 1, 0, 3, 2."""
    return _reordered(1, 0, 3, 2)


@intrinsic
def swap_halves(typing_context: Any, value: Any) -> Any:
    """Lanes 2, 3, 0, 1."""
    return _reordered(2, 3, 0, 1)


@intrinsic
def swap_ends(typing_context: Any, value: Any) -> Any:
    """Lanes 3, 2, 1, 0."""
    return _reordered(3, 2, 1, 0)


@intrinsic
def sums(typing_context: Any, first: Any, second: Any, third: Any, fourth: Any) -> Any:
    """The sum of the lanes of each of four vectors."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        front, back = _pairs(builder, *args[:2]), _pairs(builder, *args[2:])
        low = _shuffled(builder, front, back, 0, 1, 4, 5)
        return builder.fadd(low, _shuffled(builder, front, back, 2, 3, 6, 7))

    return lanes(lanes, lanes, lanes, lanes), code
