"""Which speeds a sweep runs, and in which chunks."""

from dataclasses import dataclass
from math import ceil

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.motion import Settings

SLOWEST_RPM = 1.0
"""Slower speeds are not run."""


@dataclass(frozen=True)
class SweepPlan:
    """Evenly spaced speeds from first to last, run in each direction in chunks.

    A chunk first runs `overlap` speeds of the one before it, until the state has forgotten its start.
    """

    first_rpm: float
    last_rpm: float
    points: int
    directions: tuple[str, ...]
    chunks: int
    overlap: int
    jump_resolution_rpm: float
    settings: Settings

    @property
    def speeds(self) -> Array:
        """All speeds, ascending, rpm."""
        return np.linspace(self.first_rpm, self.last_rpm, self.points)

    def chunk(self, direction: str, number: int) -> tuple[Array, Array]:
        """Speeds to run for overlap, and the chunk's own, each in the order of running."""
        speeds = self.speeds if direction == "up" else self.speeds[::-1]
        bounds = np.linspace(0, self.points, self.chunks + 1).round().astype(int)
        start, stop = bounds[number], bounds[number + 1]
        return speeds[max(0, start - self.overlap) : start], speeds[start:stop]


@dataclass(frozen=True)
class JumpRange:
    """Where jumps are looked for: up to `range_rpm` on both sides, at most `step_rpm` from speed to speed.

    A jump is bracketed to `resolution_rpm`; `settings` are those of the sweeps.
    """

    range_rpm: float
    step_rpm: float
    resolution_rpm: float
    settings: Settings

    def plan(self, speed_rpm: float) -> SweepPlan:
        """Up and down through the range around a speed, each in one piece."""
        first, last = max(speed_rpm - self.range_rpm, SLOWEST_RPM), speed_rpm + self.range_rpm
        return SweepPlan(
            first_rpm=first,
            last_rpm=last,
            points=1 + max(ceil((last - first) / self.step_rpm), 2),
            directions=("up", "down"),
            chunks=1,
            overlap=0,
            jump_resolution_rpm=self.resolution_rpm,
            settings=self.settings,
        )
