"""How the hot functions are compiled."""

from pathlib import Path

from facegear import machine_code, mesh_law
from facegear.machine_code.compiler import FAST, compiler, for_callers

SOURCES = (
    Path(__file__).parent,
    *(Path(str(package.__file__)).parent for package in (machine_code, mesh_law)),
)
"""Folders whose text the machine code of the kernels depends on."""

kernel = compiler(*SOURCES, as_written=True, **FAST)
"""Compiled, and called from Python."""

longest = compiler(*SOURCES, announced="the time integration once, some 15 s", as_written=True, **FAST)
"""The same for the one that takes so long to compile that the user reads so."""

inlined = for_callers(**FAST)
"""The same for what kernels call: it is compiled as a part of them."""

called = for_callers(forceinline=False, **FAST)
"""The same for the large ones that run at most once in a step: it compiles sooner than one huge function."""
