"""How the hot functions are compiled."""

from pathlib import Path

from facegear.machine_code import compiler, for_callers

_OPTIONS = {"nogil": True, "fastmath": {"contract"}, "_nrt": False}

kernel = compiler(Path(__file__).parent, **_OPTIONS)
"""Compiled without reference counts: kernels allocate nothing, and counting every array of a Packed or Work
at every use would cost more than the arithmetic."""

inlined = for_callers(**_OPTIONS)
"""The same for functions of a Packed and a Work: handing over these hundreds of words would cost more than
most of the functions do. They are compiled as part of the kernels that call them.
"""
