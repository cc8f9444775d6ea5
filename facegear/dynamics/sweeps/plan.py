"""Speeds that a sweep runs, and its chunks."""

from dataclasses import dataclass
from math import ceil

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.motion import Settings

SLOWEST_RPM = 1.0
"""Lowest speed of a sweep for jumps, rpm; slower speeds are not run."""


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
        """Return the speeds of a chunk in the order of running.

        Parameters
        ----------
        direction : str
            "up" or "down".
        number : int
            Number of the chunk.

        Returns
        -------
        tuple of array
            Speeds of the overlap (overlap,) and the chunk's own speeds (points,), rpm.
        """
        speeds = self.speeds if direction == "up" else self.speeds[::-1]
        bounds = np.linspace(0, self.points, self.chunks + 1).round().astype(int)
        start, stop = bounds[number], bounds[number + 1]
        return speeds[max(0, start - self.overlap) : start], speeds[start:stop]


@dataclass(frozen=True)
class JumpRange:
    """Range in which jumps are sought.

    It reaches `range_rpm` to both sides, in steps of at most `step_rpm`. A jump is bracketed to
    `resolution_rpm`; `settings` are those of the sweeps.
    """

    range_rpm: float
    step_rpm: float
    resolution_rpm: float
    settings: Settings

    def plan(self, speed_rpm: float) -> SweepPlan:
        """Return a sweep up and down through the range around a speed, each in one piece.

        Parameters
        ----------
        speed_rpm : float
            Pinion speed, rpm.

        Returns
        -------
        SweepPlan
            Plan in one chunk.
        """
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
