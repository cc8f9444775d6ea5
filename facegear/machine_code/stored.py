"""Compiled functions, their machine code stored and found again only while its sources are the same.

Made of numba's private parts: `compiler.py` lets only known versions of numba come here.
"""

import hashlib
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, TextIO

from numba import njit, types
from numba.core.caching import FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering

from facegear.io.run_lock import hold
from facegear.machine_code.sources import text_of

PATIENCE = 300.0
"""How long (s) another process may compile a function before this one compiles it as well."""


def _records(kind: Any) -> Iterator[type]:
    """All classes of NamedTuples that a numba type consists of."""
    if isinstance(kind, types.NamedTuple):
        yield kind.instance_class
    for part in kind.types if isinstance(kind, types.BaseTuple) else ():
        yield from _records(part)


class SourcesCache(FunctionCache):
    """Machine code of a function, found again only while the text of all files in its sources is the same.

    Numba notices a change of the file a kernel stands in, but not of the kernels it calls in other files, nor
    of the files of the NamedTuples that choose between implementations: these count as well. The index holds
    text alone, so that a process reads it that cannot import what another one had compiled a function for.
    Of processes that miss the same function for the same types one compiles it, and the others wait for what
    it stores. They store one after the other: each rewrites the function's index.
    """

    def __init__(self, function: Callable[..., Any], text: str) -> None:
        super().__init__(function)
        self._text = text
        self._turn = f"{function.__module__.rpartition('.')[2]}.{function.__qualname__}"
        self._lock: TextIO | None = None

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        overload = super().load_overload(sig, target_context)
        if overload is None and self._lock is None:
            types_hash = hashlib.sha256(str(sig).encode()).hexdigest()[:8]
            self._lock = self._wait(f"{self._turn}.{types_hash}.lock")
            overload = super().load_overload(sig, target_context)
            if overload is not None:
                self._end()
        return overload

    def save_overload(self, sig: Any, data: Any) -> None:
        index = self._wait(f"{self._turn}.lock")
        try:
            super().save_overload(sig, data)
        finally:
            if index is not None:
                index.close()
        self._end()

    def _wait(self, name: str) -> TextIO | None:
        """The lock that one process may hold; None after PATIENCE and where nothing can be written."""
        end = time.monotonic() + PATIENCE
        with suppress(OSError):
            while time.monotonic() < end:
                if (lock := hold(Path(self.cache_path) / name)) is not None:
                    return lock
                time.sleep(0.02)
        return None

    def _end(self) -> None:
        if self._lock is not None:
            self._lock.close()
            self._lock = None

    def _index_key(self, sig: Any, codegen: Any) -> tuple[Any, ...]:
        records = {record for kind in sig for record in _records(kind)}
        files = {sys.modules[record.__module__].__file__ for record in records}
        names = sorted(f"{record.__module__}.{record.__qualname__}" for record in records)
        text = text_of(*sorted(Path(file) for file in files if file is not None))
        _, *rest = super()._index_key(sig, codegen)
        return (str(sig), *names, *rest, text, self._text)


def stored(*sources: Path, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Decorator that compiles a function and stores its machine code by the text of all of `sources`."""
    text = text_of(*sources)

    def compiled(function: Callable[..., Any]) -> Any:
        dispatcher = njit(**options)(function)
        dispatcher._cache = SourcesCache(function, text)
        return dispatcher

    return compiled


class _CodeForCallers(JITCodeLibrary):
    """LLVM code that waits, as it was written, to be linked into what calls it."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalized = True


@register_pass(mutates_CFG=True, analysis_only=False)
class _LowerForCallers(NativeLowering):
    _name = "lower_for_callers"

    def run_pass(self, state: Any) -> bool:
        flags = state.flags
        flags.no_compile = flags.no_cpython_wrapper = flags.no_cfunc_wrapper = True
        state.library = _CodeForCallers(state.targetctx.codegen(), state.func_id.func_qualname)
        super().run_pass(state)
        lowered = state["cr"]

        def entry(*arguments: Any) -> None:
            raise TypeError(f"{lowered.fndesc.qualname} is only for compiled callers")

        state.targetctx.insert_user_function(entry, lowered.fndesc, [state.library])
        state["cr"] = lowered._replace(cfunc=entry)
        return True


class _ForCallers(Compiler):
    def define_pipelines(self) -> list[Any]:
        pipelines = super().define_pipelines()
        for pipeline in pipelines:
            pipeline.passes = [
                (_LowerForCallers, name) if step is NativeLowering else (step, name)
                for step, name in pipeline.passes
            ]
            pipeline.finalize()
        return pipelines


def inlined(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Decorator for functions that are inlined into compiled callers and have no machine code of their own.

    Numba optimises and compiles every function that another one calls, with all that it calls in turn, and
    so a function at depth d of a tree d times; here only the root is. Python cannot call such a function.
    """

    def typed(function: Callable[..., Any]) -> Any:
        dispatcher = njit(forceinline=True, pipeline_class=_ForCallers, **options)(function)

        def add_overload(overload: Any) -> None:
            dispatcher.overloads[tuple(overload.signature.args)] = overload

        dispatcher.add_overload = add_overload
        return dispatcher

    return typed
