"""The strip of hats that can be expected to touch: by the turn of the pinion that closes each one's gap, and
the least of it in a column of hats, across the profile.
"""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Mask
from facegear.contact.averages import Hats
from facegear.machine_code.compiler import for_callers
from facegear.machine_code.picked import empty_numbers, marks, numbers
from facegear.machine_code.records import Record

called = for_callers(forceinline=False)

GAP, WIDTH = 0.8, 0.23
"""Where contact is sought: the least gap of a column of hats as a part of the rigid approach (the bodies give
way by the rest), and by how much the gap of the others in it exceeds that, as a part of what it is below."""

WIDER = 1.6
"""Factor on the second part where contact is missed beside the strip."""

KNOWN_WIDTH = 0.08
"""In place of WIDTH where the contact of a pair that differs little is known, whose hats are sought among,
too."""

START_GAP, START_WIDTH = 0.6, 0.14
"""The same for the first guess of what touches."""


@Record.register
class Strip(NamedTuple):
    """How wide a strip contact is sought in, GAP, WIDTH and WIDER; where the search starts, START_GAP of the
    turn that is expected under the first torque, as a part of the limit, and START_WIDTH.

    near: nodes (p, n) of the lattice of each pair whose hats belong to the strip in any case; (0, 0) if none
    is known to.
    """

    gap: float
    width: float
    wider: float
    begin: float
    start_width: float
    near: Mask


@called
def turns_of(hats: Hats, columns: int, pairs: int) -> tuple[Array, Array]:
    """Turn (n,) of the pinion that closes each hat's gap, and the least (n,) in its column of hats."""
    count = hats.gap.size
    own, of_column = numbers(count, np.inf), numbers(pairs * columns, np.inf)
    for i in range(count):
        if hats.lever_arm[i] > 0.0:
            own[i] = hats.gap[i] / hats.lever_arm[i]
            column = hats.pair[i] * columns + hats.node[i] % columns
            of_column[column] = min(of_column[column], own[i])
    column_min = empty_numbers(count)
    for i in range(count):
        column_min[i] = of_column[hats.pair[i] * columns + hats.node[i] % columns]
    return own, column_min


@called
def expected(own: Array, column_min: Array, min_turn: float, width: float) -> Mask:
    """Hats that are expected to touch: the lesser a column's least gap, the wider."""
    touching = marks(own.size, False)
    for i in range(own.size):
        touching[i] = own[i] - column_min[i] < width * (min_turn - column_min[i])
    return touching
