"""How the functions of this package are compiled: only when machines are asked for side by side."""

from pathlib import Path

from facegear.dynamics.integrator.kernel import SOURCES
from facegear.machine_code.compiler import FAST, compiler, for_callers

longest = compiler(
    Path(__file__).parent,
    *SOURCES,
    announced="the integration of many machines once, some 10 s",
    as_written=True,
    **FAST,
)
inlined = for_callers(**FAST)
called = for_callers(forceinline=False, **FAST)
"""The same for the large ones that run once in a step, or are called from several places: inlined into one
function, they would take three times as long to compile."""
