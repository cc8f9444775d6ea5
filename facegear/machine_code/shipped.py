"""Machine code that comes with a release, for processors with the instructions of x86-64-v3 (Haswell, Zen).

`.ci/ship_machine_code.py` makes an archive of it beside this file; a clone has none. It is read where the
user's cache holds nothing. As there, a name is a hash of all that the code follows from: an archive made by
other sources or versions is never read from.
"""

import sys
import zipfile
import zlib
from functools import cache
from pathlib import Path

from llvmlite import binding
from numba import config

from facegear.machine_code import kept

CPU = "x86-64-v3"
INSTRUCTIONS = (
    *("avx", "avx2", "bmi", "bmi2", "cmov", "crc32", "cx16", "cx8", "f16c", "fma", "fxsr", "lzcnt", "mmx"),
    *("movbe", "popcnt", "sahf", "sse", "sse2", "sse3", "sse4.1", "sse4.2", "ssse3", "xsave"),
)
FEATURES = ",".join(f"+{instruction}" for instruction in INSTRUCTIONS)
COMPILING = {"NUMBA_CPU_NAME": CPU, "NUMBA_CPU_FEATURES": FEATURES, "NUMBA_DISABLE_INTEL_SVML": "1"}
"""Environment of a process that compiles for an archive: without a library that other machines may lack."""
ARCHIVE = f"{CPU}-{sys.implementation.cache_tag}.zip"


def write(archive: Path, folder: Path) -> None:
    """Pack the files of a cache that a process with the environment COMPILING has filled."""
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        for path in sorted(folder.iterdir()):
            packed.writestr(zipfile.ZipInfo(path.name), path.read_bytes(), zipfile.ZIP_DEFLATED)


def archive() -> Path | None:
    """The archive beside this file; None where there is none or the processor cannot run what is in it."""
    path = Path(__file__).with_name(ARCHIVE)
    return path if path.is_file() and can_run(INSTRUCTIONS) else None


def can_run(instructions: tuple[str, ...]) -> bool:
    """Whether the processor has these instructions, and the user asks numba for no others."""
    if config.CPU_NAME is not None or config.CPU_FEATURES is not None or not config.ENABLE_AVX:
        return False
    try:
        known = binding.get_host_cpu_features()
    except RuntimeError:
        return False
    return all(known.get(instruction, False) for instruction in instructions)


def read(archive: Path, name: str) -> bytes | None:
    """The content of a file of an archive; None if it is absent or damaged."""
    try:
        return kept.checked(_opened(archive).read(name))
    except (OSError, KeyError, zipfile.BadZipFile, zlib.error):
        return None


@cache
def _opened(archive: Path) -> zipfile.ZipFile:
    return zipfile.ZipFile(archive)
