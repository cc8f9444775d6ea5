"""The strip of basis functions that contact is sought in at first, by the rotations that close their gaps."""

from typing import NamedTuple

from facegear.arrays import Mask

GAP, WIDTH = 0.8, 0.23
"""Where contact is sought: the least gap of a column of functions as a part of the rigid approach (the bodies
give way by the rest), and by how much the gap of others in it exceeds that, as a part of what it is below.
Found by trial. No result depends on them: functions that are missed join the strip."""

WIDER = 1.6
"""Factor on the second part where contact is missed beside the strip."""

KNOWN_WIDTH = 0.08
"""In place of WIDTH where the contact of a pair that differs little is known: its functions are in the strip,
too."""

START_GAP, START_WIDTH = 0.6, 0.14
"""GAP and WIDTH of the first guess of what touches."""


class SearchStrip(NamedTuple):
    """How wide a strip contact is sought in.

    Attributes
    ----------
    gap, width, wider
        GAP, WIDTH and WIDER.
    begin, begin_width
        Where the search starts: START_GAP of the rotation that is expected under the first torque, as a part
        of the limit, and START_WIDTH.
    near : (p, n)
        Nodes of the lattice of each pair whose functions belong to the strip in any case; (0, 0) if none is
        known to.
    """

    gap: float
    width: float
    wider: float
    begin: float
    begin_width: float
    near: Mask
