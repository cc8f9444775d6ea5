"""Decorators for compiled functions; the plain `njit` where the version of numba is not known."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any, Protocol

from numba import njit
from numba.extending import overload

from facegear.machine_code.errors import NotStored
from facegear.machine_code.versions import NUMBA_IS_KNOWN, warn_once

PRIVATE_OPTIONS = ("_nrt",)
FAST: dict[str, Any] = {"nogil": True, "fastmath": {"contract"}, "_nrt": False}
"""For functions that allocate nothing: counting references to every array of a NamedTuple at every use would
cost more than their arithmetic. Without the interpreter's lock; products and sums may be fused."""
Decorator = Callable[[Callable[..., Any]], Any]


class ByType(Protocol):
    """A function that has another implementation for every type of its first argument, a NamedTuple."""

    def __call__(self, first: Any, *rest: Any) -> Any:
        """Call the implementation from Python; compiled callers choose it while they are compiled."""

    def of(self, kind: type) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        """Decorator that makes a function the implementation for a NamedTuple."""


def compiler(*sources: Path, announced: str = "", as_written: bool = False, **options: Any) -> Decorator:
    """Decorator that compiles a function, and keeps its machine code in the user's cache: it is found again
    while the function's own file and `sources`, folders or files, have the same text.

    announced: what is said to be compiled, on standard error, when it is not found there. as_written: for
    loops that are short or of vectors: they are compiled as they stand, in a third of the time.
    """
    if NUMBA_IS_KNOWN:
        from facegear.machine_code.stored import stored

        return stored(*sources, announced=announced, as_written=as_written, **options)
    warn_once()
    return njit(**_public(options))


@contextmanager
def nothing_compiled() -> Iterator[None]:
    """Have functions raise NotStored where their machine code is not stored, instead of being compiled."""
    if not NUMBA_IS_KNOWN:
        raise NotStored
    from facegear.machine_code.stored import SourcesCache

    SourcesCache.compiles = False
    try:
        yield
    finally:
        SourcesCache.compiles = True


def for_callers(**options: Any) -> Decorator:
    """Decorator for functions that are compiled as a part of their compiled callers only."""
    if NUMBA_IS_KNOWN:
        from facegear.machine_code.stored import inlined

        return inlined(**options)
    return njit(**_public(options))


def by_type(**options: Any) -> Callable[[Callable[..., Any]], ByType]:
    """Decorator for a function whose first argument, a NamedTuple, says which implementation is meant.

    The function itself is a signature with a docstring. Each caller is compiled for each type anew, and what
    is chosen is inlined into it, so that a choice costs nothing at run time. Python gets a TypeError for a
    type without an implementation, a compiled caller numba's TypingError.
    """

    def generic(signature: Callable[..., Any]) -> ByType:
        implementations: dict[type, Callable[..., Any]] = {}

        @wraps(signature)
        def call(first: Any, *rest: Any) -> Any:
            if type(first) not in implementations:
                name = signature.__qualname__
                raise TypeError(f"{name} has no implementation for {type(first).__qualname__}")
            return implementations[type(first)](first, *rest)

        def typed(first: Any, *rest: Any) -> Callable[..., Any] | None:
            return implementations.get(getattr(first, "instance_class", None))  # type: ignore[arg-type]

        def of(kind: type) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
            def register(function: Callable[..., Any]) -> Callable[..., Any]:
                implementations[kind] = function
                return function

            return register

        if NUMBA_IS_KNOWN:
            from facegear.machine_code.stored import chosen

            chosen(call, typed, **options)
        else:
            overload(call, jit_options=_public(options), strict=False)(typed)
        call.of = of  # type: ignore[attr-defined]
        return call  # type: ignore[return-value]

    return generic


def _public(options: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in options.items() if name not in PRIVATE_OPTIONS}
