"""Records inside compiled functions: one address in at of all fields, made of numba's code generator.

A call from Python writes the fields to the caller's stack, and they stay as they are until it returns: loads
of them are marked as invariant, so that LLVM keeps what it has read whatever is stored to the arrays.
"""

import hashlib
from collections.abc import Iterator
from itertools import accumulate
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import NativeValue, lower_getattr_generic, models, register_model, typeof_impl, unbox

from facegear.machine_code.records import Record

_BYTE, _WORD = ir.IntType(8), ir.IntType(64)
_BYTES = 8


class Address(types.NamedTuple):
    """Compile-time type of a record: fields that are C-contiguous arrays, numbers, records, tuples of them
    or None.

    Of an array stand there the address of its data and its shape, and nothing that counts who keeps it.
    """

    def __init__(self, fields: tuple[types.Type, ...], kind: type) -> None:
        super().__init__(fields, kind)
        self.begins = tuple(accumulate((_words(field) for field in fields), initial=0))

    @property
    def mangling_args(self) -> tuple[str, tuple[()]]:
        """A short name: that of all fields would be longer than the code."""
        return f"{self.instance_class.__name__}{hashlib.sha256(self.name.encode()).hexdigest()[:16]}", ()


@register_model(Address)
class _AddressModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Address) -> None:
        super().__init__(manager, kind, _BYTE.as_pointer())


def _words(field: types.Type) -> int:
    """Words of a field."""
    if isinstance(field, Address):
        return field.begins[-1]
    if isinstance(field, types.BaseTuple):
        return sum(_words(item) for item in field)
    if isinstance(field, types.Array):
        return 1 + field.ndim
    return 0 if field == types.none else 1


def _placed(items: types.BaseTuple, at: int) -> Iterator[tuple[types.Type, int]]:
    """Types of a tuple's items, and where each begins in a record if the tuple does `at` a word."""
    return zip(items, accumulate((_words(item) for item in items), initial=at), strict=False)


def _is_held(field: types.Type | None) -> bool:
    """Whether a record may have a field of a type."""
    if isinstance(field, types.BaseTuple) and not isinstance(field, Address):
        return all(_is_held(item) for item in field)
    if isinstance(field, types.Array):
        return field.layout == "C"
    return field == types.none or isinstance(field, Address | types.Integer | types.Float | types.Boolean)


@typeof_impl.register(Record)
def _type_of_record(record: Any, context: Any) -> Address:
    fields = tuple(typeof_impl(value, context) for value in record)
    for name, field in zip(record._fields, fields, strict=True):
        if not _is_held(field):
            raise TypeError(f"{type(record).__qualname__}.{name} must not be {field}")
    return Address(fields, type(record))


def _word(builder: Any, record: Any, at: int, kind: ir.Type) -> Any:
    """The address of a word of a record."""
    return builder.bitcast(builder.gep(record, [ir.Constant(_WORD, _BYTES * at)]), kind.as_pointer())


def _read(builder: Any, record: Any, at: int, kind: ir.Type) -> Any:
    value = builder.load(_word(builder, record, at, kind))
    value.set_metadata("invariant.load", builder.module.add_metadata([]))
    return value


def _array(context: Any, builder: Any, field: types.Array, record: Any, at: int) -> Any:
    """The array that numba knows, of what a record holds; it owns no memory."""
    model = context.data_model_manager[field]
    item = ir.Constant(_WORD, context.get_abi_sizeof(context.get_data_type(field.dtype)))
    shape = [_read(builder, record, at + 1 + axis, _WORD) for axis in range(field.ndim)]
    strides = [item]
    for length in reversed(shape[1:]):
        strides.insert(0, builder.mul(strides[0], length))
    size = shape[0] if shape else ir.Constant(_WORD, 1)
    for length in shape[1:]:
        size = builder.mul(size, length)
    parts = {
        "nitems": size,
        "itemsize": item,
        "data": _read(builder, record, at, context.get_data_type(field.dtype).as_pointer()),
        "shape": cgutils.pack_array(builder, shape, _WORD),
        "strides": cgutils.pack_array(builder, strides[: field.ndim], _WORD),
    }
    value = ir.Constant(model.get_value_type(), None)
    for name, part in parts.items():
        value = builder.insert_value(value, part, model.get_field_position(name))
    return value


@lower_getattr_generic(Address)
def _field(context: Any, builder: Any, kind: Address, record: Any, name: str) -> Any:
    index = kind.fields.index(name)
    return _value(context, builder, kind.types[index], record, kind.begins[index])


def _value(context: Any, builder: Any, field: types.Type, record: Any, at: int) -> Any:
    if isinstance(field, types.Array):
        return _array(context, builder, field, record, at)
    if isinstance(field, Address):
        return builder.gep(record, [ir.Constant(_WORD, _BYTES * at)])
    if isinstance(field, types.BaseTuple):
        items = [_value(context, builder, item, record, begin) for item, begin in _placed(field, at)]
        return context.make_tuple(builder, field, items)
    if field == types.none:
        return context.get_dummy_value()
    return _read(builder, record, at, context.get_value_type(field))


@unbox(Address)
def _unbox(kind: Address, value: Any, c: Any) -> NativeValue:
    """Write a record to the stack of the function that Python calls."""
    builder = c.builder
    with builder.goto_entry_block():
        room = builder.alloca(_WORD, size=max(kind.begins[-1], 1))
    failed = cgutils.alloca_once_value(builder, cgutils.false_bit)
    record = builder.bitcast(room, _BYTE.as_pointer())
    _write(kind, value, c, record, failed)
    # Passed through nothing the compiler can see, so that no invariant load stands before what is written.
    same = ir.FunctionType(record.type, [record.type])
    record = builder.asm(same, "", "=r,0,~{memory}", [record], side_effect=True)
    return NativeValue(record, is_error=builder.load(failed))


def _write(kind: types.BaseTuple, value: Any, c: Any, record: Any, failed: Any) -> None:
    """Write the items of a tuple, from the beginning of a record on."""
    builder = c.builder
    for index, (field, at) in enumerate(_placed(kind, 0)):
        item = c.pyapi.tuple_getitem(value, index)
        if isinstance(field, types.BaseTuple):
            _write(field, item, c, builder.gep(record, [ir.Constant(_WORD, _BYTES * at)]), failed)
        elif isinstance(field, types.Array):
            _write_array(field, item, c, record, at, failed)
        elif field != types.none:
            native = c.unbox(field, item)
            with builder.if_then(native.is_error, likely=False):
                builder.store(cgutils.true_bit, failed)
            builder.store(native.value, _word(builder, record, at, native.value.type))


def _write_array(field: types.Array, item: Any, c: Any, record: Any, at: int, failed: Any) -> None:
    """Write what numba reads of an array where nothing counts who keeps it: its other way would count."""
    builder, array = c.builder, c.context.make_array(field)(c.context, c.builder)
    adapts = ir.FunctionType(ir.IntType(32), [c.pyapi.pyobj, c.pyapi.voidptr])
    adapt = cgutils.get_or_insert_function(builder.module, adapts, "numba_adapt_ndarray")
    unknown = builder.call(adapt, (item, builder.bitcast(array._getpointer(), c.pyapi.voidptr)))
    with builder.if_then(cgutils.is_not_null(builder, unknown), likely=False):
        builder.store(cgutils.true_bit, failed)
    builder.store(array.data, _word(builder, record, at, array.data.type))
    for axis, length in enumerate(cgutils.unpack_tuple(builder, array.shape)):
        builder.store(length, _word(builder, record, at + 1 + axis, _WORD))
