"""Compiled functions, their machine code stored and found again only while its sources are the same."""

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba import njit
from numba.core.caching import FunctionCache


def text_of(sources: Path) -> str:
    """Hash of the text of all Python files in a folder."""
    digest = hashlib.sha256()
    for path in sorted(sources.glob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


class SourcesCache(FunctionCache):
    """Machine code of a function, found again only while the text of all files in a folder is the same.

    Numba notices a change of the file a kernel stands in, but not of the kernels it calls in other files.
    """

    def __init__(self, function: Callable[..., Any], text: str) -> None:
        super().__init__(function)
        self._text = text

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
