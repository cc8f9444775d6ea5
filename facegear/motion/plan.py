"""Kinds of motion, and plain settings of runs, sweeps and branches; light to import."""

import math
from dataclasses import dataclass
from enum import StrEnum
from math import ceil

import numpy as np

from facegear.arrays import Array


class Motion(StrEnum):
    """Class of a response; a periodic one comes with its number of mesh periods."""

    PERIODIC = "periodic"
    QUASI_PERIODIC = "quasi-periodic"
    CHAOTIC = "chaotic"
    NOT_SETTLED = "not settled"


@dataclass(frozen=True)
class Look:
    """Motion in which the run from one start has ended, to compare it with other starts.

    Attributes
    ----------
    period : int
        In mesh periods where the motion is periodic, else 0.
    motion : Motion or None
        Class of motion; None where the run did not close and was watched no longer.
    """

    period: int
    motion: Motion | None = None

    def __str__(self) -> str:
        """Return `period-n`, the class of motion, or `irregular`."""
        if self.period:
            return f"period-{self.period}"
        return "irregular" if self.motion is None else self.motion.value


@dataclass(frozen=True)
class Settings:
    """Settings by which a steady state is sought.

    Lengths of time are in mesh periods.

    Attributes
    ----------
    tolerance
        Local error of a step over the system's length scale.
    order
        Order of the Taylor steps; None: from the tolerance, see taylor_order.
    dwell
        Periods that are run before it is examined whether the motion repeats.
    settle
        Periods for which a motion is watched before it counts as not periodic.
    longest_period
        M, the longest period looked for.
    periodic_residual
        Change over a period that counts as periodic, over the length scale.
    window
        Periods over which a motion that is not periodic is measured, and before that its exponent.
    samples
        Least number of samples per period; more are taken where the motion needs them.
    refine
        Find periodic orbits to rounding by Newton's method, with Floquet multipliers.
    extensions
        Number of times that the window is doubled while the exponent is undecided, and number of times
        that a motion is watched again whose exponent and window do not agree.
    second_looks
        Number of other starts from which a class of motion in doubt must result again; 0 for no check.
    aside
        Distance of these starts from the first, over the length scale. A state carried over from an
        irregular motion may be any of its states.
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
        """Order of the Taylor steps: `order` if given, else 4 - log10(tolerance), rounded, from 6 to 20, as
        higher orders pay for tighter tolerances.
        """
        if self.order is not None:
            return self.order
        return min(max(round(4.0 - math.log10(self.tolerance)), 6), 20)


@dataclass(frozen=True, eq=False)
class State:
    """Displacement and velocity by time, each (n,), in the reduced coordinates at a mesh period's start."""

    displacement: Array
    velocity: Array


SLOWEST_RPM = 1.0
"""Lowest speed of a sweep for jumps, rpm; slower speeds are not run."""


@dataclass(frozen=True)
class SweepPlan:
    """Evenly spaced pinion speeds from first to last, rpm, run in each direction ("up", "down") in
    chunks.

    A chunk first runs the last `overlap` speeds of the chunk before it, until the state has forgotten its
    start. Jumps are bracketed to `jump_resolution_rpm`; `settings` are those of every run.
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
            Number of the chunk from 0 to chunks - 1, in the order of running.

        Returns
        -------
        tuple of array
            Speeds of the overlap (up to overlap,) and the chunk's own speeds (about points / chunks,),
            rpm.
        """
        speeds = self.speeds if direction == "up" else self.speeds[::-1]
        bounds = np.linspace(0, self.points, self.chunks + 1).round().astype(int)
        start, stop = bounds[number], bounds[number + 1]
        return speeds[max(0, start - self.overlap) : start], speeds[start:stop]


@dataclass(frozen=True)
class JumpRange:
    """Range in which jumps are sought.

    It reaches `range_rpm` to both sides of a speed, in steps of at most `step_rpm`. A jump is bracketed
    to `resolution_rpm`; `settings` are those of the sweeps.
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


class JumpKind(StrEnum):
    """Kind of an abrupt change of the response between two speeds.

    JUMP: the periodic motion before it ends or loses its stability there, and another periodic one follows.
    STEP: another periodic motion follows, but no loss of stability was found: the sweep left a motion that is
    stable at both speeds, because its step was too large, or the orbit could not be followed.
    IRREGULAR: the motion on one side is not periodic.
    """

    JUMP = "jump"
    STEP = "step"
    IRREGULAR = "irregular"


@dataclass(frozen=True)
class BranchPlan:
    """Settings of the branches stage.

    Speeds are in rpm, lengths in m. `spread` is the half width of the box of random starts: displacements,
    and rotations at the mesh radius.
    """

    from_rpm: float
    to_rpm: float
    nominal_rpm: float
    tolerance: float
    longest_period: int
    longest_start_period: int
    max_branches: int
    speeds_rpm: tuple[float, ...]
    starts: int
    spread: float
    seed: int
    parameters: tuple[str, ...]
    factors: tuple[float, float]
    nearest: int
