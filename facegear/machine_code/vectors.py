"""Vectors of doubles inside compiled functions, made of numba's code generator and LLVM.

LLVM leaves loops as short as these (10 meshes, 17 coordinates) scalar; with explicit vectors an order of the
Taylor recurrence costs a third. Vectors are plain LLVM and run on any processor. Arithmetic is for vectors of
any width; those that are read or made here, and whose lanes are mixed, have LANES doubles.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, models, register_model

from facegear.machine_code.memory import LANES

DOUBLE = ir.DoubleType()


class VectorType(types.Type):
    """Compile-time type of `width` doubles."""

    def __init__(self, width: int) -> None:
        super().__init__(name=f"vector{width}")
        self.width = width

    def of(self, number: ir.Type) -> ir.VectorType:
        """LLVM's type of as many numbers of a type."""
        return ir.VectorType(number, self.width)


@register_model(VectorType)
class _VectorModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: VectorType) -> None:
        super().__init__(manager, kind, kind.of(DOUBLE))


lanes = VectorType(LANES)


def _is_plain(array: Any) -> bool:
    return isinstance(array, types.Array) and array.layout == "C" and array.dtype == types.float64


def _data_of(context: Any, builder: Any, kind: types.Array, array: Any) -> Any:
    """The address of an array's first number; numba's own way there writes the whole array to the stack."""
    return builder.extract_value(array, context.data_model_manager[kind].get_field_position("data"))


def _place(context: Any, builder: Any, kind: types.Array, array: Any, index: Any) -> Any:
    return builder.gep(_data_of(context, builder, kind, array), [index])


def _pointer(
    context: Any, builder: Any, array: types.Array, args: Any, kind: VectorType, counted: ir.Type
) -> Any:
    data = _data_of(context, builder, array, args[0])
    first = builder.gep(builder.bitcast(data, counted.as_pointer()), [args[1]])
    return builder.bitcast(first, kind.of(DOUBLE).as_pointer())


def _splat(builder: Any, kind: VectorType, value: Any) -> Any:
    zero = ir.Constant(ir.IntType(32), 0)
    first = builder.insert_element(ir.Constant(kind.of(DOUBLE), ir.Undefined), value, zero)
    return builder.shuffle_vector(first, first, ir.Constant(kind.of(zero.type), [0] * kind.width))


def loaded(kind: VectorType, array: Any, counted: ir.Type = DOUBLE) -> Any:
    """What an intrinsic returns that reads a vector of a C-contiguous float64 array, at an index that counts
    doubles, or vectors.
    """
    if not _is_plain(array):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.load(_pointer(context, builder, array, args, kind, counted), align=8)

    return kind(array, types.intp), code


def written(kind: VectorType, array: Any, counted: ir.Type = DOUBLE) -> Any:
    """The same for one that writes a vector."""
    if not _is_plain(array):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        builder.store(args[2], _pointer(context, builder, array, args, kind, counted), align=8)
        return context.get_dummy_value()

    return types.void(array, types.intp, kind), code


def splatted(kind: VectorType) -> Any:
    """The same for one that puts a double in every lane."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _splat(builder, kind, args[0])

    return kind(types.float64), code


@intrinsic
def load(typing_context: Any, array: Any, index: Any) -> Any:
    """LANES values of a C-contiguous float64 array from a flat index on."""
    return loaded(lanes, array)


@intrinsic
def store(typing_context: Any, array: Any, index: Any, value: Any) -> Any:
    """Write LANES values to a C-contiguous float64 array from a flat index on."""
    return written(lanes, array)


@intrinsic
def splat(typing_context: Any, value: Any) -> Any:
    """The same double in every lane."""
    return splatted(lanes)


@intrinsic
def spread(typing_context: Any, array: Any, index: Any) -> Any:
    """One value of a C-contiguous float64 array, at a flat index, in every lane (no check of the index)."""
    if not _is_plain(array):
        return None

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _splat(builder, lanes, builder.load(_place(context, builder, array, *args)))

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


def instruction(name: str, kind: VectorType) -> Any:
    """What an intrinsic returns that does an instruction of LLVM on two vectors."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return getattr(builder, name)(*args)

    return kind(kind, kind), code


def vector_call(name: str, kind: VectorType, arguments: int) -> Any:
    """The same for an intrinsic of LLVM's own."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        vector = kind.of(DOUBLE)
        full = f"llvm.{name}.v{kind.width}f64"
        function = ir.FunctionType(vector, [vector] * arguments)
        return builder.call(cgutils.get_or_insert_function(builder.module, function, full), args)

    return kind(*[kind] * arguments), code


@intrinsic
def multiply(typing_context: Any, first: Any, second: Any) -> Any:
    """first * second in every lane."""
    return instruction("fmul", first)


@intrinsic
def add(typing_context: Any, first: Any, second: Any) -> Any:
    """first + second in every lane."""
    return instruction("fadd", first)


@intrinsic
def multiply_add(typing_context: Any, first: Any, second: Any, third: Any) -> Any:
    """first * second + third in every lane, fused where the processor can."""
    return vector_call("fmuladd", first, 3)


@intrinsic
def magnitude(typing_context: Any, value: Any) -> Any:
    """Absolute value in every lane."""
    return vector_call("fabs", value, 1)


@intrinsic
def smaller(typing_context: Any, first: Any, second: Any) -> Any:
    """The smaller of two in every lane."""
    return vector_call("minnum", first, 2)


@intrinsic
def larger(typing_context: Any, first: Any, second: Any) -> Any:
    """The larger of two in every lane."""
    return vector_call("maxnum", first, 2)


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
