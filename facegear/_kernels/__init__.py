"""Compiled kernels (C++, `src/`): the module for the instructions that this processor has."""

import hashlib
from pathlib import Path

_SOURCES = Path(__file__).with_name("src")
_BUILD = "rebuild them by `make kernels`"

try:
    from facegear._kernels import _baseline
except ImportError as error:
    raise ImportError(f"the compiled kernels of facegear cannot be loaded ({error}): {_BUILD}") from error

_module = _baseline
if _baseline.has_x86_64_v3():
    from facegear._kernels import _x86_64_v3

    _module = _x86_64_v3


def sources_hash() -> str:
    """Compute the hash of the C++ sources, as CMakeLists.txt does.

    Returns
    -------
    str
        SHA-256 in hexadecimal digits.
    """
    files = [*_SOURCES.rglob("*.cpp"), *_SOURCES.rglob("*.hpp")]
    hashes = sorted(hashlib.sha256(file.read_bytes()).hexdigest() for file in files)
    return hashlib.sha256("".join(hashes).encode()).hexdigest()


if (Path(__file__).parents[2] / "CMakeLists.txt").exists() and sources_hash() != _module.SOURCES_HASH:
    raise ImportError(f"the compiled kernels of facegear are older than their sources: {_BUILD}")

arithmetic = _module.arithmetic
motion = _module.motion
