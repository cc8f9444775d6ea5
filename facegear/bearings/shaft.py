"""Shafts on rolling bearings: equilibrium, and what pinion and seats feel of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array
from facegear.bearings.elements import AnyBearing
from facegear.bearings.equilibrium import ESCAPE, Curvature, minimise
from facegear.bearings.response import largest_gap, respond
from facegear.parts.shafts import Elasticity, Segment, clamped_compliance
from facegear.rigid_body import MOTIONS, carry_motion

RANGE = 1e-14
"""Compliance over the largest, dimensionless, below which a shaft counts as rigid: bearings beside its
pinion, or beside each other."""


@dataclass(frozen=True, eq=False)
class Support:
    """Bearing of a shaft.

    Attributes
    ----------
    position
        From the beginning of the shaft, m.
    bearing
        A rolling bearing, or a stiffness (5, 5), N/m, N/rad and N m/rad.
    offset : (5,)
        Motion of the inner ring against the outer one where neither shaft nor seat moves, m and rad: preload.
    """

    position: float
    bearing: AnyBearing | Array
    offset: Array

    def derivatives(self, motion: Array) -> Curvature:
        """Return load and stiffness at a motion of the inner ring.

        Parameters
        ----------
        motion : (5,) array
            m and rad.

        Returns
        -------
        Curvature
            Of the bearing's energy, N, N m, N/m, N/rad and N m/rad.
        """
        if isinstance(self.bearing, np.ndarray):
            return Curvature(self.bearing @ motion, self.bearing)
        response = respond(self.bearing, motion[None])
        return Curvature(response.force[0], response.stiffness[0])


@dataclass(frozen=True, eq=False)
class ShaftState:
    """Equilibrium of a shaft on bearings.

    Attributes
    ----------
    pinion : (5,)
        Motion of the pinion's middle, m and rad.
    bend : (m,)
        Coordinates of the bent shaft, whose energy is half of their squares, J^0.5.
    rings : (bearings, 5)
        Motions of the inner rings against the outer ones, m and rad.
    forces : (bearings, 5)
        Loads of the shaft on its bearings, N and N m.
    stiffness : (5 (1 + bearings), 5 (1 + bearings))
        Tangent of the loads on pinion and seats by their motions, the bent shaft eliminated.
    """

    pinion: Array
    bend: Array
    rings: Array
    forces: Array
    stiffness: Array

    @property
    def compliance(self) -> Array:
        """Motions of the pinion by its loads with the seats at rest, (5, 5)."""
        return np.asarray(np.linalg.inv(self.stiffness[:MOTIONS, :MOTIONS]))


@dataclass(frozen=True, eq=False)
class RollingShaft:
    """Timoshenko shaft on bearings of any kind, as `facegear.parts.shafts.Shaft` has it on springs.

    Seen from the pinion's middle the shaft bends by C = B B^T for loads on its bearings, so the rings move by
    T q + B y with the energy y^T y / 2: no stiffness of the shaft is inverted, and bearings may be beside
    each other.
    """

    segments: tuple[Segment, ...]
    material: Elasticity
    supports: tuple[Support, ...]
    pinion: float

    @cached_property
    def rigid(self) -> Array:
        """Motions of the rings by those of the pinion on a rigid shaft, (5 bearings, 5)."""
        return np.concatenate([carry_motion(support.position - self.pinion) for support in self.supports])

    @cached_property
    def bending(self) -> Array:
        """B: motions of the rings by the coordinates of the bent shaft, (5 bearings, m)."""
        at = np.array([self.pinion, *(support.position for support in self.supports)])
        blocks = clamped_compliance(self.segments, self.material, at)
        size = MOTIONS * at.size
        from_beginning = blocks.transpose(0, 2, 1, 3).reshape(size, size)
        relative = np.concatenate([-self.rigid, np.eye(size - MOTIONS)], axis=1)
        arms = self.arms
        compliance = relative @ from_beginning @ relative.T * np.outer(arms, arms)
        values, vectors = np.linalg.eigh(0.5 * (compliance + compliance.T))
        counts = values > RANGE * max(float(values[-1]), 1e-300)
        return np.asarray(vectors[:, counts] * np.sqrt(values[counts]) / arms[:, None])

    @property
    def arms(self) -> Array:
        """Length by which motions of the rings are compared, 1 for shifts, (5 bearings,), m."""
        length = sum(segment.length for segment in self.segments)
        return np.tile([1.0, 1.0, 1.0, length, length], len(self.supports))

    def assemble(self, coordinates: Array, seats: Array) -> tuple[Array, list[Curvature]]:
        """Return the motions of the rings and the answers of their bearings.

        Parameters
        ----------
        coordinates : (5 + m,) array
            Motion of the pinion and coordinates of the bent shaft.
        seats : (bearings, 5) array
            Motions of the seats of the outer rings, m and rad.

        Returns
        -------
        (bearings, 5) array, list of Curvature
            m and rad, N and N m.
        """
        shaft_motions = self.rigid @ coordinates[:MOTIONS] + self.bending @ coordinates[MOTIONS:]
        rings = shaft_motions.reshape(-1, MOTIONS) - seats
        rings += [support.offset for support in self.supports]
        pairs = zip(self.supports, rings, strict=True)
        return rings, [support.derivatives(ring) for support, ring in pairs]


def find_shaft_equilibrium(shaft: RollingShaft, load: Array, seats: Array | None = None) -> ShaftState:
    """Find the equilibrium of a shaft on its bearings.

    Parameters
    ----------
    shaft : RollingShaft
        The shaft.
    load : (5,) array
        Forces (N) and moments (N m) on the middle of the pinion.
    seats : (bearings, 5) array, optional
        Motions of the seats, m and rad; 0 by default.

    Returns
    -------
    ShaftState
        Equilibrium with its tangent.

    Raises
    ------
    NotConverged
        If the bearings do not hold the load.
    """
    given_seats = np.zeros((len(shaft.supports), MOTIONS)) if seats is None else seats
    rows = np.concatenate([shaft.rigid, shaft.bending], axis=1)
    bends = np.concatenate([np.zeros(MOTIONS), np.ones(shaft.bending.shape[1])])

    def derivatives(coordinates: Array) -> Curvature:
        _, answers = shaft.assemble(coordinates, given_seats)
        gradient = rows.T @ np.concatenate([answer.gradient for answer in answers]) + bends * coordinates
        return Curvature(gradient, rows.T @ _blocks(answers) @ rows + np.diag(bends))

    length = float(shaft.arms[3])
    columns = np.linalg.norm(shaft.bending * shaft.arms[:, None], axis=0)
    scale = np.concatenate([[1.0, 1.0, 1.0, length, length], columns])
    bearings = [support.bearing for support in shaft.supports]
    rolling = [bearing for bearing in bearings if not isinstance(bearing, np.ndarray)]
    size = max(float(np.abs(load / scale[:MOTIONS]).max()), 1.0)
    tie = max((bearing.stiffness_at(size) for bearing in rolling), default=1.0)
    reach = ESCAPE * max((bearing.element_diameter for bearing in rolling), default=np.inf)
    outer = np.concatenate([load, np.zeros(columns.size)])
    gap = max((largest_gap(bearing) for bearing in rolling), default=0.0)
    coordinates = minimise(derivatives, np.zeros(outer.size), outer, scale, tie, reach, gap)
    rings, answers = shaft.assemble(coordinates, given_seats)
    forces = np.array([answer.gradient for answer in answers])
    stiffness = _condense(shaft, _blocks(answers))
    return ShaftState(coordinates[:MOTIONS], coordinates[MOTIONS:], rings, forces, stiffness)


def _blocks(answers: Sequence[Curvature]) -> Array:
    """Return the stiffness of all bearings, (5 bearings, 5 bearings)."""
    size = MOTIONS * len(answers)
    matrix = np.zeros((size, size))
    for number, answer in enumerate(answers):
        block = slice(MOTIONS * number, MOTIONS * (number + 1))
        matrix[block, block] = answer.matrix
    return matrix


def _condense(shaft: RollingShaft, springs: Array) -> Array:
    """Return the tangent of pinion and seats, the coordinates of the bent shaft eliminated."""
    outer = np.concatenate([shaft.rigid, -np.eye(springs.shape[0])], axis=1)
    inner = np.eye(shaft.bending.shape[1]) + shaft.bending.T @ springs @ shaft.bending
    coupling = shaft.bending.T @ springs @ outer
    matrix = outer.T @ springs @ outer - coupling.T @ np.linalg.solve(inner, coupling)
    return np.asarray(0.5 * (matrix + matrix.T))
