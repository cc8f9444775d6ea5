"""Root stress of a tooth on its way through the mesh, from readings of gauges and the loads on all teeth."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import scipy

from facegear.arrays import Array, Integers, Mask
from facegear.strength.contact_pressure import Scale, scale

if TYPE_CHECKING:
    import scipy.sparse as sp

LONE = 0.5
"""Exponent of stress over torque below a single solved torque, dimensionless: less than its true value, so
that stress there is not underestimated."""
FINER = 8
"""Number of points for each gauge at which a maximum down the fillet is searched."""


@dataclass(frozen=True, eq=False)
class RootStress:
    """Stress (Pa, tension positive) at the gauges of one tooth while it passes through the mesh; t
    torques.

    Attributes
    ----------
    torques : (t,)
        Torques on the pinion, rising, N m.
    passage : (n,)
        Positions in pitches, 0 to 1 while the tooth belongs to pair 0.
    stress : (t, n, 2, a, b)
        Normal stress along the fillet, below the loaded flank (index 0) and below the other; a gauges
        down each fillet, b along the face.
    along : (b,)
        Gear radius, the pinion's distance from the gear's axis, m.
    angle : (2, a, b)
        Angle between the tangent and the tooth's middle line, rad.
    error : (b,)
        Relative error of the largest stress due to the mesh, nan where it is not known.
    """

    torques: Array
    passage: Array
    stress: Array
    along: Array
    angle: Array
    error: Array

    @cached_property
    def scale(self) -> Scale:
        """Growth of stress with torque, interpolated by its largest value between solved torques and in
        proportion beyond.
        """
        largest = self.stress.reshape(len(self.torques), -1).max(axis=1)
        return scale(self.torques, largest, LONE, 1.0)

    def at_torque(self, torque: float) -> Array:
        """Interpolate the stress at a torque by `scale`.

        Parameters
        ----------
        torque : float
            Torque on the pinion, N m.

        Returns
        -------
        (n, 2, a, b) array
            Stress, Pa.
        """
        return self.scale.at(self.stress, torque)

    def error_at(self, torque: float) -> float:
        """Return the error of the largest stress at a torque that the mesh causes.

        Parameters
        ----------
        torque : float
            Torque on the pinion, N m.

        Returns
        -------
        float
            Error, Pa; nan where it is not known.
        """
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
    """Superpose gauge readings by the loads of t torques at p positions.

    Teeth further apart than d do not affect each other. The tooth that is read runs through the numbers
    `teeth`: tooth j at position x is at j + x of its passage.

    Parameters
    ----------
    readings : (2 d + 1, g, c) array
        Stress at g gauges of a tooth by unit forces along the outward normal on c nodes, Pa/N; entry k is
        for forces on the tooth with a number larger by d - k.
    loads : Mapping[int, csr_matrix]
        Forces into the flank by tooth, (t p, c), N, torque by torque and position by position.
    torques : (t,) array
        Torques on the pinion, N m.
    positions : (p,) array
        Positions of the mesh, in pitches.
    along : (b,) array
        Gear radius of the gauges, m.
    angle : (2, a, b) array
        Angle between the tangent at the gauges and the tooth's middle line, rad; g = 2 a b.
    error : (b,) array or None
        Relative error of the largest stress, None where it is not known.
    teeth : (n,) array of int or None
        Numbers of the teeth whose gauges are read, None for the loaded ones and their neighbours.

    Returns
    -------
    RootStress
        Stress over torque and passage (n p places).
    """
    shape, count = angle.shape, len(positions)
    teeth = np.arange(min(loads) - 1, max(loads) + 2) if teeth is None else teeth
    stress = np.zeros((len(torques), len(teeth), count, readings.shape[1]))
    reach = len(readings) // 2
    by_node = np.ascontiguousarray(readings.swapaxes(1, 2))
    loaded_nearby = [[tooth for tooth in loads if abs(read - tooth) <= reach] for read in teeth]
    for position in range(count):
        # the torques of a position press on few nodes, and on much the same ones
        forces = {tooth: force[position::count] for tooth, force in loads.items()}
        nodes = {tooth: np.unique(force.indices) for tooth, force in forces.items()}
        pressures = {tooth: -force[:, nodes[tooth]].toarray() for tooth, force in forces.items()}
        for row, read in enumerate(teeth):
            if near := loaded_nearby[row]:
                influence = np.vstack([by_node[read - tooth + reach, nodes[tooth]] for tooth in near])
                stress[:, row, position] = np.hstack([pressures[tooth] for tooth in near]) @ influence
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
    """Interpolate values by splines at FINER times as many points from the first to the last gauge.

    Parameters
    ----------
    values : (..., a, b) array
        Values at a gauges down the fillet, b along the face, in any unit.

    Returns
    -------
    (..., FINER a, b) array
        Values between the gauges, in their unit.
    """
    finer: Array = _finer(values.shape[-2]) @ values
    return finer


@lru_cache(maxsize=8)
def _finer(rows: int) -> Array:
    """Return the matrix (FINER rows, rows) from values at `rows` gauges to a cubic spline at FINER times
    as many points.

    The points run evenly from the first to the last gauge. The array is shared; callers only read it.
    """
    spline = scipy.interpolate.CubicSpline(np.arange(rows), np.eye(rows))
    return np.asarray(spline(np.linspace(0.0, rows - 1.0, FINER * rows)))


def largest_tension(root: RootStress) -> Callable[[float], float]:
    """Return the largest stress on either fillet over the passage and the face, as a function of torque.

    The function evaluates only places where the largest stress may be at some torque, so that it is cheap in
    time and memory.

    Parameters
    ----------
    root : RootStress
        Root stress over torque and passage.

    Returns
    -------
    Callable[[float], float]
        Stress (Pa) at a torque (N m) on the pinion.
    """
    sections = _sections_with_the_largest(root.stress)
    values = np.stack([(_finer(stress.shape[-1]) @ stress.T).ravel() for stress in sections])
    may_be_largest = np.zeros(values.shape[1], dtype=bool)
    may_be_largest[values.argmax(axis=1)] = True
    for low, high in pairwise(values):
        may_be_largest |= _may_be_largest(low, high)
    worst, growth = values[:, may_be_largest], root.scale
    return lambda torque: float(growth.at(worst, torque).max())


def _sections_with_the_largest(stress: Array) -> Array:
    """Return sections (t, s, a) across the fillet that may have the largest of the stresses (t, n, 2, a,
    b), Pa.

    A section is the a gauges down one fillet at one place of the passage and along the face. Between two
    torques the larger of two places of tension is at least half the blend of their stresses; a section
    whose spline stays below half the largest stress at every torque solved is never the largest.
    """
    sections = np.moveaxis(stress, -2, -1).reshape(len(stress), -1, stress.shape[-2])
    values = sections.reshape(len(sections), -1)
    best = values.argmax(axis=1)
    if (values[:, best] < 0.0).any():
        return sections
    reach = np.abs(_finer(sections.shape[-1])).sum(axis=1).max() * np.abs(sections).max(axis=-1)
    may_be_largest = (reach >= 0.5 * values.max(axis=1)[:, None]).any(axis=0)
    return sections[:, may_be_largest]


def _may_be_largest(low: Array, high: Array) -> Mask:
    """Mark the lines from `low` to `high` (n,) that rise anywhere above those that are largest at an end.

    `low` and `high` are the stresses (Pa) of n places at two neighbouring torques. Two lines bound the
    largest from below by a kinked line, so that it is enough to look at the kink.
    """
    first, last = int(np.argmax(low)), int(np.argmax(high))
    lead, gain = low[first] - low[last], high[last] - high[first]
    part = lead / (lead + gain) if lead + gain > 0.0 else 0.0
    at_kink = (1.0 - part) * low + part * high
    return np.asarray(at_kink > at_kink[first])
