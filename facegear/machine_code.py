"""Compiled functions, their machine code stored and found again only while its sources are the same."""

import hashlib
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TextIO

from numba import njit
from numba.core.caching import FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering

from facegear.io.run_lock import hold

PATIENCE = 300.0
"""How long (s) another process may compile a function before this one compiles it as well."""


def text_of(sources: Path) -> str:
    """Hash of the text of all Python files in a folder."""
    digest = hashlib.sha256()
    for path in sorted(sources.glob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


class SourcesCache(FunctionCache):
    """Machine code of a function, found again only while the text of all files in a folder is the same.

    Numba notices a change of the file a kernel stands in, but not of the kernels it calls in other files.
    Of processes that miss the same function one compiles it, and the others wait for what it stores.
    """

    def __init__(self, function: Callable[..., Any], text: str) -> None:
        super().__init__(function)
        self._text = text
        self._turn = f"{function.__module__.rpartition('.')[2]}.{function.__qualname__}.lock"
        self._lock: TextIO | None = None

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        found = super().load_overload(sig, target_context)
        if found is None and self._lock is None:
            self._lock = self._wait()
            found = super().load_overload(sig, target_context)
            if found is not None:
                self._end()
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        super().save_overload(sig, data)
        self._end()

    def _wait(self) -> TextIO | None:
        """The lock of the one process that compiles; None after PATIENCE and where nothing can be written."""
        end = time.monotonic() + PATIENCE
        with suppress(OSError):
            while time.monotonic() < end:
                if (lock := hold(Path(self.cache_path) / self._turn)) is not None:
                    return lock
                time.sleep(0.02)
        return None

    def _end(self) -> None:
        if self._lock is not None:
            self._lock.close()
            self._lock = None

    def _index_key(self, sig: Any, codegen: Any) -> tuple[Any, ...]:
        return (*super()._index_key(sig, codegen), self._text)


def compiler(sources: Path, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Decorator that compiles a function and stores its machine code by the text of all of `sources`."""
    text = text_of(sources)

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
                (_LowerForCallers, told) if step is NativeLowering else (step, told)
                for step, told in pipeline.passes
            ]
            pipeline.finalize()
        return pipelines


def for_callers(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Decorator for functions that are inlined into compiled callers and have no machine code of their own.

    Numba optimises and compiles every function that another one calls, with all that it calls in turn, and
    so a function at depth d of a tree d times; here only the root is. Python cannot call such a function.
    """

    def typed(function: Callable[..., Any]) -> Any:
        dispatcher = njit(forceinline=True, pipeline_class=_ForCallers, **options)(function)

        def add_overload(found: Any) -> None:
            dispatcher.overloads[tuple(found.signature.args)] = found

        dispatcher.add_overload = add_overload
        return dispatcher

    return typed
