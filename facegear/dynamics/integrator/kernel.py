"""How the hot functions are compiled, and where the machine code is kept."""

import hashlib
import os
import tempfile
from pathlib import Path

import numba
from numba import njit


def cache_folder(sources: Path) -> Path:
    """Folder for the machine code of all kernels in `sources`, named by their text.

    Numba notices a change of the file a kernel stands in, but not of the kernels it calls in other files.
    """
    digest = hashlib.sha256()
    for path in sorted(sources.glob("*.py")):
        digest.update(path.read_bytes())
    given = numba.config.CACHE_DIR
    own = sources / "__pycache__" if os.access(sources, os.W_OK) else Path(tempfile.gettempdir()) / "facegear"
    return (Path(given) if given else own) / f"kernels-{digest.hexdigest()[:16]}"


numba.config.CACHE_DIR = str(cache_folder(Path(__file__).parent))

_OPTIONS = {"cache": True, "nogil": True, "fastmath": {"contract"}, "_nrt": False}

kernel = njit(**_OPTIONS)
"""Compiled without reference counts: kernels allocate nothing, and counting every array of a Packed or Work
at every use would cost more than the arithmetic."""

inlined = njit(**_OPTIONS, forceinline=True)
"""The same for functions of a Packed and a Work: handing over these hundreds of words would cost more than
most of the functions do.
"""
