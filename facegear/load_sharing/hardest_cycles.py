"""The mesh cycles of a long hunting cycle in which its meshes carry most, from a few spread over it."""

import numpy as np

from facegear.load_sharing.hunting import HuntingCycle, at_cycles, hunting_length
from facegear.transmission.flanks import slow_errors


def hardest_cycles(spread: HuntingCycle) -> HuntingCycle:
    """Compute the mesh cycles that are likely to be the hardest of each mesh, from some spread over the
    hunting cycle.

    What changes from cycle to cycle are the errors of the flanks, known for all cycles. The mean load of a
    mesh is nearly linear in them; the linear law through the cycles given says which of the others are the
    hardest.

    Parameters
    ----------
    spread : HuntingCycle
        Some mesh cycles of the hunting cycle.

    Returns
    -------
    HuntingCycle
        The hardest cycles, or `spread` itself where it is the whole hunting cycle.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    machine, length = spread.machine, hunting_length(spread.machine)
    sampled_cycles = spread.cycles[:: spread.positions].astype(np.int64)
    if sampled_cycles.size >= length:
        return spread
    slow = slow_errors(machine, np.arange(length, dtype=float) + 0.5)
    slow -= slow[sampled_cycles].mean(axis=0)
    means = spread.cycle_means
    law = np.linalg.lstsq(slow[sampled_cycles], means - means.mean(axis=0), rcond=None)[0]
    return at_cycles(machine, np.unique((slow @ law).argmax(axis=0)), spread.positions)
