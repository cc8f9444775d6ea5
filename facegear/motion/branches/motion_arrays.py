"""Motions found by random starts or by a sweep: stored as arrays, and joined to branches."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from facegear.arrays import AnyArray, Array, Arrays
from facegear.errors import NotConverged
from facegear.motion.branches.continuation import Branch
from facegear.motion.branches.explore import SettledMotion, distance
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint, at_parameter
from facegear.motion.branches.special import Kind
from facegear.motion.plan import Motion, Settings
from facegear.motion.steady_state.simulate import steady_state
from facegear.motion.sweeps.sweep import Piece

SHAPES = {
    "speed_rpm": (),
    "label": (None,),
    "period": (None,),
    "count": (None,),
    "has_orbit": (None,),
    "state": (None, None),
}
"""Arrays of the motions at one speed, with their shapes; None is any length."""


def motions_to_arrays(speed_rpm: float, motions: Sequence[SettledMotion]) -> dict[str, AnyArray]:
    """Return the motions at one speed as arrays.

    Parameters
    ----------
    speed_rpm : float
        Pinion speed, rpm.
    motions : sequence of SettledMotion
        Motions found at it.

    Returns
    -------
    dict
        Arrays with the names and shapes of SHAPES, such as (motions,); `state` holds the weighted states
        z.
    """
    return {
        "speed_rpm": np.array(speed_rpm),
        "label": np.array([motion.label for motion in motions]),
        "period": np.array([motion.period for motion in motions]),
        "count": np.array([motion.count for motion in motions]),
        "has_orbit": np.array([motion.point is not None for motion in motions]),
        "state": np.array([motion.z for motion in motions]),
    }


def motions_from_arrays(period_map: PeriodMap, arrays: Arrays) -> tuple[float, list[SettledMotion]]:
    """Return the motions that motions_to_arrays() has stored, with their orbits solved for again.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    arrays : Arrays
        Arrays of SHAPES.

    Returns
    -------
    float
        Pinion speed, rpm.
    list of SettledMotion
        Motions found at it.

    Raises
    ------
    NotConverged
        If an orbit is not found again.
    """
    speed = float(arrays["speed_rpm"])
    counts = arrays["count"].astype(int)
    motions = []
    for i, count in enumerate(counts):
        period, z, fraction = int(arrays["period"][i]), arrays["state"][i], count / counts.sum()
        point = None
        if arrays["has_orbit"][i]:
            point = at_parameter(period_map.over(period), z, float(np.log(speed)))
        error = float(np.sqrt(fraction * (1.0 - fraction) / counts.sum()))
        motions.append(
            SettledMotion(str(arrays["label"][i]), period, z, point, int(count), float(fraction), error)
        )
    return speed, motions


SPECIAL_SHAPES = {"kind": (None,), "period": (None,), "x": (None, None), "number": (None,)}
"""Arrays of special points, with their shapes; None is any length."""
LOCUS_KINDS = (Kind.FOLD, Kind.DOUBLING)
"""Kinds of special points of which loci are followed; stored as their index."""


def special_arrays(branches: Sequence[Branch]) -> dict[str, AnyArray]:
    """Return the folds and period doublings of branches as arrays; images, which have the same, are left out.

    Parameters
    ----------
    branches : sequence of Branch
        Branches followed.

    Returns
    -------
    dict
        Arrays with the names and shapes of SPECIAL_SHAPES, such as (points,): index in LOCUS_KINDS, mesh
        periods, x of BranchPoint, and number of the branch.
    """
    special_list = [
        (b, n, s) for n, b in enumerate(branches) if b.image_of is None for s in b.of(*LOCUS_KINDS)
    ]
    size = branches[0].points[0].x.size
    return {
        "kind": np.array([LOCUS_KINDS.index(special.kind) for _, _, special in special_list], dtype=int),
        "period": np.array([branch.period_map.period for branch, _, _ in special_list], dtype=int),
        "number": np.array([number for _, number, _ in special_list], dtype=int),
        "x": np.array([special.point.x for _, _, special in special_list]).reshape(-1, size),
    }


def special_points(period_map: PeriodMap, arrays: Arrays) -> list[tuple[PeriodMap, Kind, Array]]:
    """Return the special points that special_arrays() has stored.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    arrays : Arrays
        Arrays of SPECIAL_SHAPES.

    Returns
    -------
    list of tuple
        Period map, kind and x (2 n + 1,) of each special point, dimensionless.
    """
    return [
        (period_map.over(int(period)), LOCUS_KINDS[int(kind)], x)
        for kind, period, x in zip(arrays["kind"], arrays["period"], arrays["x"], strict=True)
    ]


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
        Why there is no orbit; empty if there is one.
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
        """Sweep direction and speed at which the motion was found, in words."""
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
    """Solve for the orbit of the motion at index `index` of a piece of a sweep; `reason` says why there
    is none.
    """
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
    """Return the orbit next to a weighted state z (2 n,) at the parameter's logarithm u, and its least
    period.

    It is sought over `period` mesh periods. Where a long orbit magnifies the state's error too much for
    Newton's method, a run from the state at the branches' tolerance leads to it. Raises NotConverged if
    the run is not periodic.
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
    """Return the smallest divisor of `period`, in mesh periods, after which an orbit repeats to within
    REPEATS.
    """
    images = period_map.over(period).images(point.z, point.u)
    return next(
        divisor
        for divisor in range(1, period + 1)
        if period % divisor == 0 and (divisor == period or np.abs(images[divisor] - point.z).max() < REPEATS)
    )


def nearest_branch(motion: SweptMotion, branches: Sequence[Branch]) -> tuple[int | None, float]:
    """Find the branch on which the orbit of a motion lies: the nearest, if it is closer than ON.

    Parameters
    ----------
    motion : SweptMotion
        Motion of a sweep.
    branches : sequence of Branch
        Branches followed.

    Returns
    -------
    int or None
        Index of the branch; None if there is none.
    float
        Distance of the motion's orbit from the branch in length scales, dimensionless; NaN if there is none.
    """
    if motion.point is None:
        return None, np.nan
    far = [distance(branch, motion.point, motion.period) for branch in branches]
    nearest = int(np.argmin(far))
    return (nearest, far[nearest]) if far[nearest] < ON else (None, np.nan)
