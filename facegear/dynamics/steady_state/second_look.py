"""Whether a class of motion comes out again from starts a little aside.

A chaotic transient that ends on an orbit of a long period while a run is watched may go on for longer from
the next start, and one that does not end may end. Rounding of the machine's numbers then decides what the
motion is called.
"""

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import Motion, Settings
from facegear.dynamics.steady_state.closing import SMALL
from facegear.dynamics.steady_state.orbits import change, largest
from facegear.dynamics.steady_state.settle import Settled, settle

WANDERED = 16
"""After so many periods with changes that are not small the orbit reached may be a matter of chance."""


def disagreeing(
    integrator: Integrator, start: Array, settings: Settings, first: Settled, motion: Motion
) -> Settled | None:
    """Where another start (2, n) settles if it does so otherwise than the first; None if the class holds.

    A run that went straight to its orbit is not in doubt, and one that is not settled says
    nothing. Two irregular motions are one class.
    """
    if motion is Motion.NOT_SETTLED or (first.period and not _in_doubt(integrator, first)):
        return None
    looks = settings.second_looks if first.period else min(settings.second_looks, 1)
    random = np.random.default_rng(0)
    for _ in range(looks):
        other = settle(integrator, _moved(integrator, start, settings.aside, random), settings)
        if other.period != first.period:
            return other
    return None


def _in_doubt(integrator: Integrator, settled: Settled) -> bool:
    """Whether a run wandered before it came to its orbit."""
    ends = settled.ends
    changes = largest(integrator, ends[settled.period :] - ends[: -settled.period])
    return int((changes > SMALL).sum()) > WANDERED


def _moved(integrator: Integrator, start: Array, aside: float, random: np.random.Generator) -> Array:
    """A start (2, n) moved by a fraction `aside` of the length scale in any direction."""
    off = random.normal(size=start.shape)
    return start + aside * off / change(integrator, off, 0.0 * off)
