"""Store motions found by random starts as arrays, so that a stage that was stopped continues from them."""

from collections.abc import Sequence

import numpy as np

from facegear.arrays import AnyArray, Array, Arrays
from facegear.dynamics.branches.continuation import Branch
from facegear.dynamics.branches.explore import SettledMotion
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import at_parameter
from facegear.dynamics.branches.special import Kind

SHAPES = {
    "speed_rpm": (),
    "label": (None,),
    "period": (None,),
    "count": (None,),
    "has_orbit": (None,),
    "state": (None, None),
}
"""Arrays of the motions at one speed, with their shapes; None is any length."""


def to_arrays(speed_rpm: float, motions: Sequence[SettledMotion]) -> dict[str, AnyArray]:
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
        Arrays with the names and shapes of SHAPES, such as (motions,).
    """
    return {
        "speed_rpm": np.array(speed_rpm),
        "label": np.array([motion.label for motion in motions]),
        "period": np.array([motion.period for motion in motions]),
        "count": np.array([motion.count for motion in motions]),
        "has_orbit": np.array([motion.point is not None for motion in motions]),
        "state": np.array([motion.z for motion in motions]),
    }


def from_arrays(period_map: PeriodMap, arrays: Arrays) -> tuple[float, list[SettledMotion]]:
    """Return the motions that to_arrays() has stored, with their orbits solved for again.

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
        Arrays with the names and shapes of SPECIAL_SHAPES, such as (points,).
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
