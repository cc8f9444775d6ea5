"""Motions found by random starts as arrays, so that a stage that was stopped goes on from them."""

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


def to_arrays(speed_rpm: float, motions: Sequence[SettledMotion]) -> dict[str, AnyArray]:
    """Arrays of SHAPES."""
    return {
        "speed_rpm": np.array(speed_rpm),
        "label": np.array([motion.label for motion in motions]),
        "period": np.array([motion.period for motion in motions]),
        "count": np.array([motion.count for motion in motions]),
        "has_orbit": np.array([motion.point is not None for motion in motions]),
        "state": np.array([motion.z for motion in motions]),
    }


def from_arrays(period_map: PeriodMap, arrays: Arrays) -> tuple[float, list[SettledMotion]]:
    """Speed and motions of to_arrays(). Raises NotConverged if an orbit is not found again."""
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
LOCUS_KINDS = (Kind.FOLD, Kind.DOUBLING)


def special_arrays(branches: Sequence[Branch]) -> dict[str, AnyArray]:
    """Folds and period doublings as arrays of SPECIAL_SHAPES; images, which have the same, are left out."""
    located = [(b, n, s) for n, b in enumerate(branches) if b.image_of is None for s in b.of(*LOCUS_KINDS)]
    size = branches[0].points[0].x.size
    return {
        "kind": np.array([LOCUS_KINDS.index(special.kind) for _, _, special in located], dtype=int),
        "period": np.array([branch.period_map.period for branch, _, _ in located], dtype=int),
        "number": np.array([number for _, number, _ in located], dtype=int),
        "x": np.array([special.point.x for _, _, special in located]).reshape(-1, size),
    }


def special_points(period_map: PeriodMap, arrays: Arrays) -> list[tuple[PeriodMap, Kind, Array]]:
    """Map, kind and x of the special points of special_arrays()."""
    return [
        (period_map.over(int(period)), LOCUS_KINDS[int(kind)], x)
        for kind, period, x in zip(arrays["kind"], arrays["period"], arrays["x"], strict=True)
    ]
