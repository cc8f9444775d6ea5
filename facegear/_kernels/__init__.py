"""Compiled kernels (C++, `src/`): the modules for the instructions that this processor has.

Each part that `src/bindings` binds is a module of this package, such as `facegear._kernels.arithmetic`. The
build writes its types beside this file (`arithmetic.pyi`).
"""

import hashlib
import os
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType

VARIABLE = "FACEGEAR_INSTRUCTIONS"
"""Environment variable that chooses the module for every processor where it is `baseline`."""
_SOURCES = Path(__file__).with_name("src")
"""Folder of the C++ sources."""
_REMEDY = "rebuild them by `make kernels`, or by `pip install -e .` where pip installed this folder"
"""Advice where the compiled modules are missing or older than their sources."""

try:
    _module = import_module(f"{__name__}._baseline")
    if os.environ.get(VARIABLE) != "baseline" and _module.USE_X86_64_V3:
        _module = import_module(f"{__name__}._x86_64_v3")
except ImportError as error:
    raise ImportError(f"the compiled kernels of facegear cannot be loaded ({error}): {_REMEDY}") from error


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
    raise ImportError(f"the compiled kernels of facegear are older than their sources: {_REMEDY}")

COMPILER: str = _module.COMPILER
"""Name and version of the compiler that built the kernels."""
LEVEL: str = _module.__name__.rpartition(".")[2].strip("_")
"""Level of instructions that is used here: `x86_64_v3`, or `baseline` on other processors."""

for _name, _part in vars(_module).items():
    if isinstance(_part, ModuleType):
        globals()[_name] = sys.modules[f"{__name__}.{_name}"] = _part
del _name, _part
