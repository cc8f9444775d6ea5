"""Results of pure functions that are found again where their arguments say the same as before.

Many machines of one study differ in a few numbers: what does not depend on those is computed once.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cache, lru_cache, partial, wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np

P = ParamSpec("P")
R = TypeVar("R")


@dataclass(frozen=True)
class _Call:
    """A call, equal to another one whose arguments have the same content."""

    content: Any
    compute: Callable[[], Any] = field(compare=False)


def kept_by_content(size: int) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorator of a pure function: its last `size` results are kept and shared, so
    that callers only read them.

    Arguments count as the same where all fields of dataclasses, numbers, texts and entries of arrays are, to
    the last bit; any other object is the same as itself alone.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        @lru_cache(maxsize=size)
        def kept(call: _Call) -> Any:
            return call.compute()

        @wraps(function)
        def shared(*arguments: P.args, **named: P.kwargs) -> R:
            result: R = kept(_Call(content((arguments, named)), partial(function, *arguments, **named)))
            return result

        return shared

    return decorate


def content(value: Any) -> Any:
    """A hashable that equals that of another value only where both say the same."""
    return _content(value)[0]


_KEPT = "_content"
"""Attribute in which a dataclass that nothing can change any more keeps its content."""


def _content(value: Any) -> tuple[Any, bool]:
    """The content of a value, and whether it will be that for good."""
    if isinstance(value, np.ndarray):
        return (value.dtype.str, value.shape, value.tobytes()), _is_fixed(value)
    if isinstance(value, tuple | list):
        parts, fixed = _all([_content(part) for part in value])
        return (type(value), parts), fixed and isinstance(value, tuple)
    kind: Any = type(value)
    if (names := _field_names(kind)) is not None:
        return _of_fields(value, names)
    if isinstance(value, Mapping):
        return (type(value), tuple([(key, content(part)) for key, part in value.items()])), False
    return (type(value), value), True


def _is_fixed(array: Any) -> bool:
    """Whether nothing can be written into an array, nor into one that it is a view of."""
    while isinstance(array, np.ndarray) and not array.flags.writeable:
        array = array.base
    return array is None


def _of_fields(value: Any, names: tuple[str, ...]) -> tuple[Any, bool]:
    known = getattr(value, _KEPT, None)
    if known is not None:
        return known, True
    parts, fixed = _all([_content(getattr(value, name)) for name in names])
    whole = (type(value), parts)
    if fixed and type(value).__dataclass_params__.frozen:
        object.__setattr__(value, _KEPT, whole)
        return whole, True
    return whole, False


@cache
def _field_names(kind: Any) -> tuple[str, ...] | None:
    """Names of a dataclass's fields; None of any other type."""
    return tuple([part.name for part in fields(kind)]) if is_dataclass(kind) else None


def _all(parts: Sequence[tuple[Any, bool]]) -> tuple[tuple[Any, ...], bool]:
    """Contents of several values, and whether all will stay as they are."""
    return tuple([part for part, _ in parts]), all(fixed for _, fixed in parts)
