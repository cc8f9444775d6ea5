"""Compiled functions, their machine code stored and found again only while its sources are the same.

Made of numba's private parts: `compiler.py` lets only known versions of numba come here.
"""

import hashlib
import pickle
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import llvmlite
import numba
from filelock import FileLock, Timeout
from numba import njit, types
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps
from numba.core.typing.templates import infer, infer_global, make_overload_template

from facegear.machine_code import addresses, kept, shipped
from facegear.machine_code.errors import NotStored
from facegear.machine_code.pipelines import AsWritten, ForCallers, Whole
from facegear.machine_code.sources import text_of

PATIENCE = 300.0
"""How long (s) another process may compile a function before this one compiles it as well."""


def _records(kind: Any) -> Iterator[type]:
    """All classes of NamedTuples that a numba type consists of."""
    if isinstance(kind, types.NamedTuple | addresses.Address):
        yield kind.instance_class
    for part in kind.types if isinstance(kind, types.BaseTuple) else ():
        yield from _records(part)


class SourcesCache(_Cache):
    """Machine code of a function, found again only while the text of all files in its sources is the same.

    Numba's own cache notices a change of the file a kernel stands in, but not of the kernels it calls in
    other files, nor of the files of the NamedTuples that choose between implementations. These count here as
    well, and paths do not. Of processes that miss the same function for the same types one compiles it, and
    the others wait for what it stores.
    """

    compiles = True
    """Whether the caller may compile what is not found."""

    def __init__(self, function: Callable[..., Any], text: str, announced: str) -> None:
        self._function = function
        self._text = text
        self._announced = announced
        self._locks: dict[str, FileLock] = {}

    @property
    def cache_path(self) -> str:
        """The folder of all machine code; empty for a user without a home."""
        with suppress(OSError):
            return str(kept.folder())
        return ""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """What was compiled for a signature; None if the caller is to compile it, for others too."""
        target_context.refresh()
        processor = target_context.codegen().magic_tuple()
        name = self._name(sig, processor)
        content = kept.read(name) or self._shipped(sig, processor)
        if content is None and not self.compiles:
            raise NotStored(name)
        if content is None and name not in self._locks:
            if (lock := _wait(name)) is not None:
                self._locks[name] = lock
            content = kept.read(name)
            if content is not None:
                self._release(name)
            elif self._announced:
                print(f"compiling {self._announced}", file=sys.stderr, flush=True)
        if content is None:
            return None
        return CompileResult._rebuild(target_context, *pickle.loads(content))

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled, unless addresses of this process are in it."""
        name = self._name(sig, data.codegen.magic_tuple())
        if not data.library.has_dynamic_globals:
            kept.write(name, dumps(data._reduce()))
        self._release(name)

    def enable(self) -> None:
        """Numba asks for it; nothing is ever disabled."""

    def disable(self) -> None:
        """Numba asks for it; nothing is ever disabled."""

    def flush(self) -> None:
        """Numba asks for it; what is kept is never stale."""

    def _shipped(self, sig: Any, processor: tuple[str, str, str]) -> bytes | None:
        """What came with the release for processors like this one."""
        archive, system = shipped.archive(), processor[0]
        if archive is None:
            return None
        return shipped.read(archive, self._name(sig, (system, shipped.CPU, shipped.FEATURES)))

    def _name(self, sig: Any, processor: tuple[str, str, str]) -> str:
        """The file for a signature: a hash of sources, types, processor, and versions."""
        records = {record for kind in sig for record in _records(kind)}
        files = {sys.modules[record.__module__].__file__ for record in records}
        function = self._function
        cells = tuple(cell.cell_contents for cell in function.__closure__ or ())
        parts = (
            f"{function.__module__}.{function.__qualname__}",
            function.__code__.co_code,
            dumps(cells) if cells else b"",
            str(sig),
            *sorted(f"{record.__module__}.{record.__qualname__}" for record in records),
            text_of(*sorted(Path(file) for file in files if file is not None)),
            self._text,
            processor,
            (sys.implementation.cache_tag, numba.__version__, llvmlite.__version__),
        )
        return f"{function.__name__}-{hashlib.sha256(repr(parts).encode()).hexdigest()[:32]}"

    def _release(self, name: str) -> None:
        if (lock := self._locks.pop(name, None)) is not None:
            lock.release()


def _wait(name: str) -> FileLock | None:
    """The lock that one process may hold; None after PATIENCE and where nothing can be written."""
    with suppress(OSError, Timeout):
        kept.folder().mkdir(parents=True, exist_ok=True)
        lock = FileLock(kept.folder() / f"{name}.lock", timeout=PATIENCE, poll_interval=0.02)
        lock.acquire()
        return lock
    return None


def stored(
    *sources: Path, announced: str = "", as_written: bool = False, **options: Any
) -> Callable[[Callable[..., Any]], Any]:
    """Decorator that compiles a function and stores its machine code by the text of all of `sources`, and of
    the function's own file. Compiled callers have it as a part of their own code, called or inlined as the
    compiler sees fit: only what Python calls is compiled to machine code.

    as_written: no loop is unrolled or made vectors.
    """

    def compiled(function: Callable[..., Any]) -> Any:
        pipeline = AsWritten if as_written else Whole
        dispatcher = njit(pipeline_class=pipeline, **options)(function)
        part = inlined(**{"forceinline": False, **options})(function)
        own = Path(function.__code__.co_filename)
        dispatcher._cache = SourcesCache(function, text_of(*sources, own), announced)
        dispatcher.get_call_template, dispatcher.get_overload = part.get_call_template, part.get_overload
        return dispatcher

    return compiled


def inlined(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Decorator for functions that are a part of compiled callers and have no machine code of their own;
    inlined into them unless the option `forceinline` is False.

    Numba optimises and compiles every function that another one calls, with all that it calls in turn, and
    so a function at depth d of a tree d times; here only the root is. Python cannot call such a function.
    """

    def typed(function: Callable[..., Any]) -> Any:
        options.setdefault("forceinline", True)
        dispatcher = njit(pipeline_class=ForCallers, **options)(function)

        def add_overload(overload: Any) -> None:
            dispatcher.overloads[tuple(overload.signature.args)] = overload

        def get_call_template(arguments: Any, names: Any) -> Any:
            alike = tuple(types.unliteral(argument) for argument in arguments)
            return template(alike, {name: types.unliteral(kind) for name, kind in names.items()})

        template = dispatcher.get_call_template
        dispatcher.add_overload, dispatcher.get_call_template = add_overload, get_call_template
        return dispatcher

    return typed


def chosen(function: Callable[..., Any], choose: Callable[..., Any], **options: Any) -> None:
    """Have compiled callers of a function take, inlined, the one that is chosen by the types of arguments.

    Numba's own `overload` makes machine code of each of them beside.
    """
    template = make_overload_template(function, choose, options, strict=False, inline="never")
    template._get_jit_decorator = lambda self: inlined
    infer(template)
    infer_global(function, types.Function(template))
