"""Results of pure functions that are found again where their arguments say the same as before.

Many machines of one study differ in a few numbers: what does not depend on those is computed once.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from functools import lru_cache, partial, wraps
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
    if isinstance(value, np.ndarray):
        return value.dtype.str, value.shape, value.tobytes()
    if isinstance(value, tuple | list):
        return type(value), tuple([content(part) for part in value])
    if isinstance(value, Mapping):
        return type(value), tuple([(key, content(part)) for key, part in value.items()])
    if is_dataclass(value):
        return type(value), tuple([content(getattr(value, part.name)) for part in fields(value)])
    return type(value), value
