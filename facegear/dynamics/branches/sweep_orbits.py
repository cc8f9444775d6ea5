"""Find the exact orbit next to each periodic motion of a sweep, and the branch that it lies on."""

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
"""Distance, in length scales, of states one divisor of the period apart below which that divisor is the
period.
"""
ON = 1e-5
"""Distance, in length scales, of a branch's orbit at the same speed below which the motion lies on the
branch.
"""
ELSEWHERE = 0.1
"""An orbit farther than this from the sweep's state is not the sweep's motion."""


@dataclass(frozen=True, eq=False)
class SweptMotion:
    """A periodic motion at one speed of a sweep.

    Attributes
    ----------
    direction, speed_rpm : str, float
        Direction of the sweep, and pinion speed.
    label : str
        Class of the motion in the sweep.
    period : int
        Least period of the orbit next to it; that of the label if there is no orbit.
    point : BranchPoint or None
        The orbit next to it.
    error : float
        Distance of the sweep's state from the orbit, in length scales.
    reason : str
        Why there is no orbit.
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
        """Where the motion was found, in words."""
        return f"sweep {self.direction}, {self.speed_rpm:.6g} rpm"


def swept_motions(
    period_map: PeriodMap, pieces: Mapping[str, Sequence[Piece]], from_rpm: float, to_rpm: float
) -> list[SweptMotion]:
    """Return the periodic motions of a sweep between two speeds, each with its orbit.

    Parameters
    ----------
    period_map : PeriodMap
        Map of the machine over its speed in rpm, over one mesh period.
    pieces : mapping
        Pieces of the sweep, by direction.
    from_rpm, to_rpm : float
        Range of speeds, rpm.

    Returns
    -------
    list of SweptMotion
        Motions, by direction and speed.
    """
    return [
        _orbit(period_map, direction, piece, index)
        for direction, chunks in pieces.items()
        for piece in chunks
        for index, speed in enumerate(piece.speeds)
        if piece.period[index] > 0 and from_rpm <= speed <= to_rpm
    ]


def _orbit(period_map: PeriodMap, direction: str, piece: Piece, index: int) -> SweptMotion:
    speed, label, period = float(piece.speeds[index]), piece.labels[index], int(piece.period[index])
    u = float(np.log(speed))
    z = period_map.to_weighted(piece.state(index), u)
    try:
        point, shortest = _next_to(period_map, z, u, period)
    except (NotConverged, np.linalg.LinAlgError) as failure:
        return SweptMotion(direction, speed, label, period, None, np.nan, f"no orbit next to it: {failure}")
    error = min(float(np.abs(image - z).max()) for image in period_map.over(shortest).images(point.z, u))
    if error > ELSEWHERE:
        reason = f"the nearest orbit lies {error:.2g} length scales away"
        return SweptMotion(direction, speed, label, period, None, error, reason)
    return SweptMotion(direction, speed, label, shortest, point, error)


def _next_to(period_map: PeriodMap, z: Array, u: float, period: int) -> tuple[BranchPoint, int]:
    """Return the orbit next to a state and its least period.

    Where a long orbit magnifies the state's error too much for Newton's method, the orbit is that of a run
    from the state at the branches' tolerance.
    """
    try:
        point = at_parameter(period_map.over(period), z, u)
    except (NotConverged, np.linalg.LinAlgError):
        system, frequency = period_map.family.at(float(np.exp(u)))
        response = steady_state(
            system, frequency, Settings(tolerance=period_map.tolerance), period_map.state(z, u)
        )
        if response.motion is not Motion.PERIODIC:
            reason = f"at a tolerance of {period_map.tolerance:g} a run from it is {response.label}"
            raise NotConverged("branches", f"{np.exp(u):.9g} rpm", reason) from None
        period = response.period
        point = at_parameter(period_map.over(period), period_map.to_weighted(response.state, u), u)
    shortest = _shortest_period(period_map, point, period)
    return (point if shortest == period else at_parameter(period_map.over(shortest), point.z, u)), shortest


def _shortest_period(period_map: PeriodMap, point: BranchPoint, period: int) -> int:
    images = period_map.over(period).images(point.z, point.u)
    return next(
        divisor
        for divisor in range(1, period + 1)
        if period % divisor == 0 and (divisor == period or np.abs(images[divisor] - point.z).max() < REPEATS)
    )


def nearest_branch(motion: SweptMotion, branches: Sequence[Branch]) -> tuple[int | None, float]:
    """Find the branch on which a motion lies.

    Parameters
    ----------
    motion : SweptMotion
        Motion of a sweep.
    branches : sequence of Branch
        Branches followed.

    Returns
    -------
    int or None
        Number of the branch; None if there is none.
    float
        Distance of the motion's orbit from the branch in length scales, dimensionless; NaN if there is none.
    """
    if motion.point is None:
        return None, np.nan
    far = [distance(branch, motion.point, motion.period) for branch in branches]
    nearest = int(np.argmin(far))
    return (nearest, far[nearest]) if far[nearest] < ON else (None, np.nan)
