"""Kinds of motion and how a run is settled."""

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Motion(StrEnum):
    """Class of a response; a periodic one comes with its number of mesh periods."""

    PERIODIC = "periodic"
    QUASI_PERIODIC = "quasi-periodic"
    CHAOTIC = "chaotic"
    NOT_SETTLED = "not settled"


@dataclass(frozen=True)
class Settings:
    """How a steady state is sought. Lengths of time are in mesh periods.

    tolerance: local error of a step over the system's length scale. order: of the Taylor steps, None: from
    the tolerance. settle: most periods before the motion is judged as not periodic (at least `dwell`).
    longest_period: m, the longest period looked for. periodic_residual: change over a period that counts as
    periodic, over the length scale. window: periods over which a motion that is not periodic is measured.
    samples: per period. refine: find periodic orbits to rounding by Newton's method, with Floquet
    multipliers.
    """

    tolerance: float = 1e-6
    order: int | None = None
    dwell: int = 32
    settle: int = 512
    longest_period: int = 8
    periodic_residual: float = 1e-7
    window: int = 256
    samples: int = 64
    refine: bool = True
    extensions: int = 2

    @property
    def taylor_order(self) -> int:
        """Order of the steps; higher pays for tighter tolerances."""
        if self.order is not None:
            return self.order
        return int(np.clip(round(4.0 - 1.0 * np.log10(self.tolerance)), 6, 20))

    def extended(self, times: int) -> "Settings":
        """The same with patience, window and longest period doubled `times` times."""
        factor = 2**times
        return replace(
            self,
            settle=factor * self.settle,
            window=factor * self.window,
            longest_period=factor * self.longest_period,
        )


@dataclass(frozen=True, eq=False)
class State:
    """Displacement and velocity by time, each (n,), in the reduced coordinates at a mesh period's start."""

    displacement: Array
    velocity: Array
