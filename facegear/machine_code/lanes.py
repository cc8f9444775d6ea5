"""Four doubles at a time inside compiled functions: vectors where numba is known, else tuples."""

from types import ModuleType

from facegear.machine_code.memory import LANES as LANES
from facegear.machine_code.versions import NUMBA_IS_KNOWN

_four: ModuleType
if NUMBA_IS_KNOWN:
    from facegear.machine_code import vectors

    _four = vectors
else:
    from facegear.machine_code import tuples

    _four = tuples

add = _four.add
larger = _four.larger
load = _four.load
magnitude = _four.magnitude
multiply = _four.multiply
multiply_add = _four.multiply_add
put = _four.put
smaller = _four.smaller
splat = _four.splat
spread = _four.spread
store = _four.store
sums = _four.sums
swap_ends = _four.swap_ends
swap_halves = _four.swap_halves
swap_neighbours = _four.swap_neighbours
take = _four.take
