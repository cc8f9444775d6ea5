"""Four doubles at a time inside compiled functions: vectors where numba is known, else tuples."""

from facegear.machine_code.memory import LANES
from facegear.machine_code.versions import NUMBA_IS_KNOWN

if NUMBA_IS_KNOWN:
    from facegear.machine_code.vectors import (
        add,
        larger,
        load,
        magnitude,
        multiply,
        multiply_add,
        put,
        smaller,
        splat,
        spread,
        store,
        take,
    )
else:
    from facegear.machine_code.tuples import (
        add,
        larger,
        load,
        magnitude,
        multiply,
        multiply_add,
        put,
        smaller,
        splat,
        spread,
        store,
        take,
    )

__all__ = [
    "LANES",
    "add",
    "larger",
    "load",
    "magnitude",
    "multiply",
    "multiply_add",
    "put",
    "smaller",
    "splat",
    "spread",
    "store",
    "take",
]
