"""The mesh cycles of a long hunting cycle in which its meshes carry most, from a few spread over it."""

import numpy as np

from facegear.load_sharing.hunting import HuntingCycle, at_cycles, hunting_length
from facegear.transmission.flanks import slow_errors


def hardest_cycles(spread: HuntingCycle) -> HuntingCycle:
    """The cycles that are likely to be the hardest of each mesh, given some `spread` over the hunting cycle.

    What changes from cycle to cycle are the errors of the flanks, known for all cycles. The mean load of a
    mesh is nearly linear in them; the linear law through the cycles given says which of the others are the
    hardest. Where the whole hunting cycle is given it is returned itself. Raises NotConverged.
    """
    machine, length = spread.machine, hunting_length(spread.machine)
    taken = spread.cycles[:: spread.positions].astype(np.int64)
    if taken.size >= length:
        return spread
    slow = slow_errors(machine, np.arange(length, dtype=float) + 0.5)
    slow -= slow[taken].mean(axis=0)
    means = spread.cycle_means
    law = np.linalg.lstsq(slow[taken], means - means.mean(axis=0), rcond=None)[0]
    return at_cycles(machine, np.unique((slow @ law).argmax(axis=0)), spread.positions)
