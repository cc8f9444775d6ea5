"""Periodic motions of a sweep: the exact orbit next to each, and the branch that it lies on."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.branches.continuation import Branch
from facegear.dynamics.branches.explore import distance
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint, at_parameter
from facegear.dynamics.motion import Motion, Settings
from facegear.dynamics.steady_state.simulate import steady_state
from facegear.dynamics.sweeps.sweep import Piece
from facegear.errors import NotConverged

REPEATS = 1e-5
"""An orbit whose states one shorter period apart differ by less, in length scales, has that period."""
ON = 1e-5
"""A branch whose orbit at the same speed is this close, in length scales, is the motion's."""
ELSEWHERE = 0.1
"""An orbit farther than this from the sweep's state is not the sweep's motion."""


@dataclass(frozen=True, eq=False)
class Swept:
    """A periodic motion at one speed of a sweep.

    label: its class in the sweep. period: least period of the orbit next to it, of the label if there is
    none. point: that orbit, and error how far the sweep's state lies from it, in length scales. reason: why
    there is none.
    """

    direction: str
    speed_rpm: float
    label: str
    period: int
    point: BranchPoint | None
    error: float
    reason: str = ""

    @property
    def origin(self) -> str:
        """Where it was found."""
        return f"sweep {self.direction}, {self.speed_rpm:.6g} rpm"


def swept_motions(
    period_map: PeriodMap, pieces: Mapping[str, Sequence[Piece]], from_rpm: float, to_rpm: float
) -> list[Swept]:
    """The periodic motions of a sweep's directions between two speeds, each with its orbit.

    flow: the machine's map over its speed in rpm and one mesh period.
    """
    return [
        _orbit(period_map, direction, piece, index)
        for direction, chunks in pieces.items()
        for piece in chunks
        for index, speed in enumerate(piece.speeds)
        if piece.period[index] > 0 and from_rpm <= speed <= to_rpm
    ]


def _orbit(period_map: PeriodMap, direction: str, piece: Piece, index: int) -> Swept:
    speed, label, period = float(piece.speeds[index]), piece.labels[index], int(piece.period[index])
    u = float(np.log(speed))
    z = period_map.weighted(piece.state(index), u)
    try:
        point, shortest = _next_to(period_map, z, u, period)
    except (NotConverged, np.linalg.LinAlgError) as failure:
        return Swept(direction, speed, label, period, None, np.nan, f"no orbit next to it: {failure}")
    error = min(float(np.abs(image - z).max()) for image in period_map.over(shortest).images(point.z, u))
    if error > ELSEWHERE:
        reason = f"the nearest orbit lies {error:.2g} length scales away"
        return Swept(direction, speed, label, period, None, error, reason)
    return Swept(direction, speed, label, shortest, point, error)


def _next_to(period_map: PeriodMap, z: Array, u: float, period: int) -> tuple[BranchPoint, int]:
    """The orbit next to a state and its least period; where a long orbit magnifies the state's error too
    much for Newton's method, that of a run from there at the branches' tolerance.
    """
    try:
        point = at_parameter(period_map.over(period), z, u)
    except (NotConverged, np.linalg.LinAlgError):
        system, frequency = period_map.family.at(float(np.exp(u)))
        settled = steady_state(
            system, frequency, Settings(tolerance=period_map.tolerance), period_map.state(z, u)
        )
        if settled.motion is not Motion.PERIODIC:
            what = f"at a tolerance of {period_map.tolerance:g} a run from it is {settled.label}"
            raise NotConverged("branches", f"{np.exp(u):.9g} rpm", what) from None
        period = settled.period
        point = at_parameter(period_map.over(period), period_map.weighted(settled.state, u), u)
    shortest = _shortest_period(period_map, point, period)
    return (point if shortest == period else at_parameter(period_map.over(shortest), point.z, u)), shortest


def _shortest_period(period_map: PeriodMap, point: BranchPoint, period: int) -> int:
    images = period_map.over(period).images(point.z, point.u)
    return next(
        divisor
        for divisor in range(1, period + 1)
        if period % divisor == 0 and (divisor == period or np.abs(images[divisor] - point.z).max() < REPEATS)
    )


def nearest_branch(motion: Swept, branches: Sequence[Branch]) -> tuple[int | None, float]:
    """Number of the branch that a motion lies on, and how far its orbit there is, in length scales."""
    if motion.point is None:
        return None, np.nan
    far = [distance(branch, motion.point, motion.period) for branch in branches]
    nearest = int(np.argmin(far))
    return (nearest, far[nearest]) if far[nearest] < ON else (None, np.nan)
