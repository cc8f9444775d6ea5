"""Kinds of motion and how a run is settled."""

import math
from dataclasses import dataclass
from enum import StrEnum

from facegear.arrays import Array


class Motion(StrEnum):
    """Class of a response; a periodic one comes with its number of mesh periods."""

    PERIODIC = "periodic"
    QUASI_PERIODIC = "quasi-periodic"
    CHAOTIC = "chaotic"
    NOT_SETTLED = "not settled"


@dataclass(frozen=True)
class Settings:
    """How a steady state is sought.

    Lengths of time are in mesh periods.

    Attributes
    ----------
    tolerance
        Local error of a step over the system's length scale.
    order
        Of the Taylor steps, None: from the tolerance.
    dwell
        Periods before anything is judged.
    settle
        Periods for which a motion is watched before it counts as not periodic.
    longest_period
        M, the longest period looked for.
    periodic_residual
        Change over a period that counts as periodic, over the length scale.
    window
        Periods over which a motion that is not periodic is measured, and before that its exponent.
    samples
        Least number per period; more are taken where the motion needs them.
    refine
        Find periodic orbits to rounding by Newton's method, with Floquet multipliers.
    extensions
        Times that the window of an undecided exponent is doubled, and that a motion is watched again whose
        exponent and window do not agree.
    second_looks
        Other starts that a class of motion which is in doubt must come out from again.
    aside
        How far they lie from the first, over the length scale. A state carried over from an irregular motion
        may be any of its states.
    """

    tolerance: float = 1e-8
    order: int | None = None
    dwell: int = 32
    settle: int = 8192
    longest_period: int = 64
    periodic_residual: float = 1e-7
    window: int = 256
    samples: int = 64
    refine: bool = True
    extensions: int = 2
    second_looks: int = 0
    aside: float = 1e-6

    @property
    def taylor_order(self) -> int:
        """Order of the steps; higher pays for tighter tolerances."""
        if self.order is not None:
            return self.order
        return min(max(round(4.0 - math.log10(self.tolerance)), 6), 20)


@dataclass(frozen=True, eq=False)
class State:
    """Displacement and velocity by time, each (n,), in the reduced coordinates at a mesh period's start."""

    displacement: Array
    velocity: Array
