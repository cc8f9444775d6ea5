"""Motions found by random starts as arrays, so that a stage that was stopped goes on from them."""

from collections.abc import Sequence

import numpy as np

from facegear.arrays import AnyArray, Array, Arrays
from facegear.dynamics.branches.continuation import Branch
from facegear.dynamics.branches.explore import Found
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


def to_arrays(speed_rpm: float, found: Sequence[Found]) -> dict[str, AnyArray]:
    """Arrays of SHAPES."""
    return {
        "speed_rpm": np.array(speed_rpm),
        "label": np.array([one.label for one in found]),
        "period": np.array([one.period for one in found]),
        "count": np.array([one.count for one in found]),
        "has_orbit": np.array([one.point is not None for one in found]),
        "state": np.array([one.z for one in found]),
    }


def from_arrays(flow: PeriodMap, arrays: Arrays) -> tuple[float, list[Found]]:
    """Speed and motions of to_arrays(). Raises NotConverged if an orbit is not found again."""
    speed = float(arrays["speed_rpm"])
    counts = arrays["count"].astype(int)
    found = []
    for i, count in enumerate(counts):
        period, z, share = int(arrays["period"][i]), arrays["state"][i], count / counts.sum()
        point = None
        if arrays["has_orbit"][i]:
            point = at_parameter(flow.over(period), z, float(np.log(speed)))
        error = float(np.sqrt(share * (1.0 - share) / counts.sum()))
        found.append(Found(str(arrays["label"][i]), period, z, point, int(count), float(share), error))
    return speed, found


SPECIAL_SHAPES = {"kind": (None,), "period": (None,), "x": (None, None), "number": (None,)}
LOCUS_KINDS = (Kind.FOLD, Kind.DOUBLING)


def special_arrays(branches: Sequence[Branch]) -> dict[str, AnyArray]:
    """Folds and period doublings as arrays of SPECIAL_SHAPES."""
    found = [(b, n, s) for n, b in enumerate(branches) for s in b.of(*LOCUS_KINDS)]
    size = branches[0].points[0].x.size
    return {
        "kind": np.array([LOCUS_KINDS.index(special.kind) for _, _, special in found], dtype=int),
        "period": np.array([branch.flow.period for branch, _, _ in found], dtype=int),
        "number": np.array([number for _, number, _ in found], dtype=int),
        "x": np.array([special.point.x for _, _, special in found]).reshape(-1, size),
    }


def special_points(flow: PeriodMap, arrays: Arrays) -> list[tuple[PeriodMap, Kind, Array]]:
    """Map, kind and x of the special points of special_arrays()."""
    return [
        (flow.over(int(period)), LOCUS_KINDS[int(kind)], x)
        for kind, period, x in zip(arrays["kind"], arrays["period"], arrays["x"], strict=True)
    ]
