"""What numba finds out anew for every expression, remembered while a function is compiled with all its parts.

A sum of two integers is typed by trying forty ways to add, and again wherever it is lowered; that there is no
code to make an array of an array is found by loading all registries of numba, at every use of an array; the
size of a type by having LLVM parse a module. What comes out is the same each time, and so is the code.

Made of numba's private parts, as `stored.py` is.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from numba import types
from numba.core.base import BaseContext
from numba.core.compiler_lock import global_compiler_lock
from numba.core.targetconfig import ConfigStack
from numba.core.types.functions import BaseFunction

Method = Callable[..., Any]
_replaced: dict[tuple[type, str], Method] = {}
"""Numba's own methods where others stand now."""


@contextmanager
def remembered() -> Iterator[None]:
    """Have numba remember until the block ends; a block inside another one is a part of it."""
    with global_compiler_lock:
        if _replaced:
            yield
            return
        for (kind, name), remembering in _REMEMBERING.items():
            _replaced[kind, name] = getattr(kind, name)
            setattr(kind, name, remembering(_replaced[kind, name]))
        try:
            yield
        finally:
            for (kind, name), method in _replaced.items():
                setattr(kind, name, method)
            _replaced.clear()


def _typed_calls(find: Method) -> Method:
    """Of what type a call of numba's own functions is, by the options that its parts are compiled with."""
    known: dict[Any, tuple[Any, Any]] = {}
    options: dict[int, tuple[Any, str]] = {}

    def get_call_type(self: Any, context: Any, args: Any, kws: Any) -> Any:
        flags = ConfigStack.top_or_none()
        if id(flags) not in options:
            options[id(flags)] = flags, "" if flags is None else flags.summary()
        key = self, context, tuple(args), tuple(dict(kws).items()), options[id(flags)][1]
        if key not in known:
            signature = find(self, context, args, kws)
            known[key] = signature, self._impl_keys[signature.args]
        signature, self._impl_keys[signature.args] = known[key]
        return signature

    return get_call_type


def _absent_code(find: Method) -> Method:
    """For which functions and types there is no code: numba asks for some to find out whether there is."""
    absent: set[Any] = set()

    def get_function(self: Any, fn: Any, sig: Any, _firstcall: bool = True) -> Any:
        own = fn.get_impl_key(sig.as_function()) if isinstance(fn, types.Callable) else fn
        key = own, sig.args
        if key in absent:
            raise NotImplementedError(f"No definition for lowering {own}{sig}")
        try:
            return find(self, fn, sig, _firstcall)
        except NotImplementedError:
            absent.add(key)
            raise

    return get_function


def _sizes(find: Method) -> Method:
    """Bytes of a type of LLVM's, or those that it is aligned to."""
    known: dict[Any, int] = {}

    def get(self: Any, kind: Any) -> int:
        if kind not in known:
            known[kind] = find(self, kind)
        return known[kind]

    return get


_REMEMBERING: dict[tuple[type, str], Callable[[Method], Method]] = {
    (BaseFunction, "get_call_type"): _typed_calls,
    (BaseContext, "get_function"): _absent_code,
    (BaseContext, "get_abi_sizeof"): _sizes,
    (BaseContext, "get_abi_alignment"): _sizes,
}
