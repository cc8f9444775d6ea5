"""Root stress of a tooth on its way through the mesh, from readings of gauges and the loads on all teeth."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import scipy

from facegear.arrays import Array, Integers, Mask
from facegear.strength.between_torques import Scale, scale

if TYPE_CHECKING:
    import scipy.sparse as sp


LONE = 0.5
"""Exponent of stress over torque below a single torque solved: less than it is, so that stress is not."""
FINER = 8
"""Points a gauge at which a maximum down the fillet is looked for."""


@dataclass(frozen=True, eq=False)
class RootStress:
    """Stress (Pa) at the gauges of one tooth while it passes through the mesh; t torques.

    Attributes
    ----------
    torques : (t,)
        N m.
    passage : (n,)
        Positions in pitches, 0 to 1 while the tooth belongs to pair 0.
    stress : (t, n, 2, a, b)
        Fillets below the loaded and below the other flank, a gauges down them, b along the face.
    along : (b,)
        Gear radius, the pinion's distance from the gear's axis, m.
    angle : (2, a, b)
        Between the tangent and the tooth's middle line, rad.
    error : (b,)
        Relative error of the largest stress that the mesh makes, nan where it is not known.
    """

    torques: Array
    passage: Array
    stress: Array
    along: Array
    angle: Array
    error: Array

    @cached_property
    def scale(self) -> Scale:
        """How stress grows with torque: as its largest value between those solved, in proportion beyond."""
        largest = self.stress.reshape(len(self.torques), -1).max(axis=1)
        return scale(self.torques, largest, LONE, 1.0)

    def at_torque(self, torque: float) -> Array:
        """Stress (n, 2, a, b) at a torque, as `scale` has it."""
        return self.scale.at(self.stress, torque)

    def error_at(self, torque: float) -> float:
        """Error (Pa) that the mesh makes of the largest stress at a torque, nan where it is not known."""
        along_face = down_the_fillet(self.at_torque(torque)).max(axis=(0, 1, 2))
        return float(along_face.max() * self.error[np.argmax(along_face)])


def root_stress(
    readings: Array,
    loads: Mapping[int, "sp.csr_matrix"],
    torques: Array,
    positions: Array,
    along: Array,
    angle: Array,
    error: Array | None = None,
    teeth: Integers | None = None,
) -> RootStress:
    """Superpose the readings (2 d + 1, g, c) by the loads {tooth: (t p, c)} of t torques at p positions.

    Teeth further apart than d do not feel each other. `along` (b,), `angle` (2, a, b) and `error` (b,) of the
    gauges as in `RootStress`. `teeth`: those that are read, None for the loaded ones and their neighbours.
    """
    shape, count = angle.shape, len(positions)
    teeth = np.arange(min(loads) - 1, max(loads) + 2) if teeth is None else teeth
    stress = np.zeros((len(torques), len(teeth), count, readings.shape[1]))
    reach = len(readings) // 2
    by_node = np.ascontiguousarray(readings.swapaxes(1, 2))
    felt = [[tooth for tooth in loads if abs(read - tooth) <= reach] for read in teeth]
    for position in range(count):
        # the torques of a position press on few nodes, and on much the same ones
        here = {tooth: force[position::count] for tooth, force in loads.items()}
        nodes = {tooth: np.unique(force.indices) for tooth, force in here.items()}
        pressed = {tooth: -force[:, nodes[tooth]].toarray() for tooth, force in here.items()}
        for row, read in enumerate(teeth):
            if near := felt[row]:
                here_read = np.vstack([by_node[read - tooth + reach, nodes[tooth]] for tooth in near])
                stress[:, row, position] = np.hstack([pressed[tooth] for tooth in near]) @ here_read
    passage = (teeth[:, None] + np.asarray(positions, dtype=float)).ravel()
    return RootStress(
        torques=np.asarray(torques, dtype=float),
        passage=passage,
        stress=stress.reshape(len(torques), passage.size, *shape),
        along=along,
        angle=angle,
        error=np.full(len(along), np.nan) if error is None else error,
    )


def down_the_fillet(values: Array) -> Array:
    """Values (..., a, b) at FINER times as many points from the first to the last gauge, by splines."""
    finer: Array = _finer(values.shape[-2]) @ values
    return finer


@lru_cache(maxsize=8)
def _finer(rows: int) -> Array:
    """Splines through unit values at each of `rows` gauges, at FINER times as many points; only read."""
    spline = scipy.interpolate.CubicSpline(np.arange(rows), np.eye(rows))
    return np.asarray(spline(np.linspace(0.0, rows - 1.0, FINER * rows)))


def largest_tension(root: RootStress) -> Callable[[float], float]:
    """Largest stress (Pa) on either fillet over the passage and the face, at a torque (N m).

    It looks only where the largest stress may be at some torque, so that it is cheap in time and memory.
    """
    sections = _sections_with_the_largest(root.stress)
    places = np.stack([(_finer(stress.shape[-1]) @ stress.T).ravel() for stress in sections])
    kept = np.zeros(places.shape[1], dtype=bool)
    kept[places.argmax(axis=1)] = True
    for low, high in pairwise(places):
        kept |= _may_be_largest(low, high)
    worst, growth = places[:, kept], root.scale
    return lambda torque: float(growth.at(worst, torque).max())


def _sections_with_the_largest(stress: Array) -> Array:
    """Sections (t, s, a) across the fillet that may have the largest of the stresses (t, n, 2, a, b).

    Between two torques the larger of two places of tension is at least half the blend of their stresses; a
    section whose spline stays below half the largest stress at every torque solved is never the largest.
    """
    sections = np.moveaxis(stress, -2, -1).reshape(len(stress), -1, stress.shape[-2])
    places = sections.reshape(len(sections), -1)
    best = places.argmax(axis=1)
    if (places[:, best] < 0.0).any():
        return sections
    reach = np.abs(_finer(sections.shape[-1])).sum(axis=1).max() * np.abs(sections).max(axis=-1)
    kept = (reach >= 0.5 * places.max(axis=1)[:, None]).any(axis=0)
    return sections[:, kept]


def _may_be_largest(low: Array, high: Array) -> Mask:
    """Which of the lines from `low` to `high` (n,) are anywhere above those that are largest at an end.

    Two lines bound the largest from below by a kinked line, so that it is enough to look at the kink.
    """
    first, last = int(np.argmax(low)), int(np.argmax(high))
    lead, gain = low[first] - low[last], high[last] - high[first]
    part = lead / (lead + gain) if lead + gain > 0.0 else 0.0
    there = (1.0 - part) * low + part * high
    return np.asarray(there > there[first])
