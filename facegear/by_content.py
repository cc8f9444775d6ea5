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
    """A call of a function, as the key of its stored result: equal to another call with equal `content`
    of its arguments. `compute` makes the call and takes no part in comparisons.
    """

    content: Any
    compute: Callable[[], Any] = field(compare=False)


def kept_by_content(size: int) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorate a pure function: its last `size` results are kept and shared, so that callers must only read
    them.

    Two calls count as equal where all fields of dataclasses, numbers, texts and entries of arrays of their
    arguments are equal, to the last bit. Any other object equals itself alone.

    Parameters
    ----------
    size : int
        Number of results to keep; the least recently used one goes first.

    Returns
    -------
    Callable
        The decorator. The decorated function takes the same arguments; all of its calls share one store.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        """Return the function with a store of its last `size` results."""

        @lru_cache(maxsize=size)
        def compute(call: _Call) -> Any:
            """Make a call; lru_cache finds its result again for an equal one."""
            return call.compute()

        @wraps(function)
        def call_once(*arguments: P.args, **keywords: P.kwargs) -> R:
            """Return the stored result of an equal call, or compute it."""
            result: R = compute(
                _Call(content((arguments, keywords)), partial(function, *arguments, **keywords))
            )
            return result

        return call_once

    return decorate


def content(value: Any) -> Any:
    """Return a hashable object that equals the one of another value only where both values have equal
    content.

    Parameters
    ----------
    value : Any
        Dataclass, array, sequence, mapping or any hashable object.

    Returns
    -------
    Any
        Nested tuple of types, numbers, texts and bytes; an object of another kind stands for itself.
    """
    return _content(value)[0]


_CONTENT_ATTRIBUTE = "_content"
"""Attribute in which a dataclass that nothing can change any more keeps its content."""


def _content(value: Any) -> tuple[Any, bool]:
    """Return the content of a value (see `content`), and whether it can never change, so that it may be
    stored. Read-only arrays, tuples and frozen dataclasses of such parts, and other objects count as
    fixed.
    """
    if isinstance(value, np.ndarray):
        return (value.dtype.str, value.shape, value.tobytes()), _is_fixed(value)
    if isinstance(value, tuple | list):
        parts, is_fixed = _join_contents([_content(part) for part in value])
        return (type(value), parts), is_fixed and isinstance(value, tuple)
    kind: Any = type(value)
    if (names := _field_names(kind)) is not None:
        return _of_fields(value, names)
    if isinstance(value, Mapping):
        return (type(value), tuple([(key, content(part)) for key, part in value.items()])), False
    return (type(value), value), True


def _is_fixed(array: Any) -> bool:
    """Return whether an array is read-only, and so is each array of which it is a view."""
    while isinstance(array, np.ndarray) and not array.flags.writeable:
        array = array.base
    return array is None


def _of_fields(value: Any, names: tuple[str, ...]) -> tuple[Any, bool]:
    """Return the content of a dataclass from the fields `names`, and whether it can never change.

    If so and the class is frozen, it is stored in the object's attribute _CONTENT_ATTRIBUTE and read
    from there.
    """
    content = getattr(value, _CONTENT_ATTRIBUTE, None)
    if content is not None:
        return content, True
    parts, is_fixed = _join_contents([_content(getattr(value, name)) for name in names])
    whole = (type(value), parts)
    if is_fixed and type(value).__dataclass_params__.frozen:
        object.__setattr__(value, _CONTENT_ATTRIBUTE, whole)
        return whole, True
    return whole, False


@cache
def _field_names(kind: Any) -> tuple[str, ...] | None:
    """Return the names of a dataclass's fields; None for any other type."""
    return tuple([part.name for part in fields(kind)]) if is_dataclass(kind) else None


def _join_contents(parts: Sequence[tuple[Any, bool]]) -> tuple[tuple[Any, ...], bool]:
    """Return the contents of several (content, is fixed) as one tuple, and whether all are fixed."""
    return tuple([part for part, _ in parts]), all(is_fixed for _, is_fixed in parts)
