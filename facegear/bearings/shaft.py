"""Shafts on rolling bearings: equilibrium, and what pinion and seats feel of it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from facegear.arrays import Array
from facegear.bearings.elements import AnyBearing
from facegear.bearings.equilibrium import ESCAPE, Curvature, bearing_curve, minimise
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
        A rolling bearing, or the stiffness (5, 5) of a linear one, N/m, N/rad and N m/rad.
    offset : (5,)
        Motion of the inner ring against the outer one where neither shaft nor seat moves, m and rad: preload,
        and the opposite of the place of the outer ring.
    factor
        By which the energy of the bearing is multiplied, for trials of softer and stiffer ones; 1.
    """

    position: float
    bearing: AnyBearing | Array
    offset: Array
    factor: float = 1.0

    def derivatives(self, motion: Array) -> Curvature:
        """Return energy, load and stiffness of the bearing at a motion of its inner ring, in which
        `offset` is.

        Parameters
        ----------
        motion : (5,) array
            x, y, z (m), tilt_x, tilt_y (rad) of the inner ring against the outer one.

        Returns
        -------
        Curvature
            Energy (J), loads on the inner ring (N and N m) and tangent (N/m, N/rad and N m/rad).
        """
        if not isinstance(self.bearing, np.ndarray):
            curve = bearing_curve(self.bearing, motion)
            if self.factor == 1.0:
                return curve
            energy, size, rounding = np.array([curve.energy, curve.size, curve.rounding]) * self.factor
            return Curvature(
                float(energy),
                self.factor * curve.gradient,
                self.factor * curve.matrix,
                float(size),
                float(rounding),
            )
        matrix = self.factor * self.bearing
        force = matrix @ motion
        rounding = np.finfo(float).eps * float((np.abs(matrix) @ np.abs(motion)).max())
        return Curvature(0.5 * float(motion @ force), force, matrix, float(np.abs(force).max()), rounding)


@dataclass(frozen=True, eq=False)
class ShaftState:
    """Balance of a shaft and its bearings at a motion of pinion and seats.

    Attributes
    ----------
    energy
        Of bearings and bent shaft, J.
    pinion : (5,)
        Motion of the pinion's middle, m and rad.
    bend : (m,)
        Coordinates y of the bent shaft, whose energy is half the sum of their squares, J^0.5.
    rings : (bearings, 5)
        Motions of the inner rings against the outer ones, m and rad.
    forces : (bearings, 5)
        Loads of the shaft on its bearings, N and N m.
    pinion_load : (5,)
        Load on the middle of the pinion that `forces` balance, N and N m.
    stiffness : (5 (1 + bearings), 5 (1 + bearings))
        Derivative of `loads` by the motions of pinion and seats, in this order, the bent shaft eliminated.
    """

    energy: float
    pinion: Array
    bend: Array
    rings: Array
    forces: Array
    pinion_load: Array
    stiffness: Array

    @property
    def loads(self) -> Array:
        """Outer loads that hold pinion (row 0) and seats, (1 + bearings, 5), N and N m: the energy's
        gradient.
        """
        return np.asarray(np.concatenate([self.pinion_load[None], -self.forces]))

    @property
    def compliance(self) -> Array:
        """Derivative of the pinion's motion by its load with the seats at rest, (5, 5): m/N, rad/N and
        rad/(N m).
        """
        return np.asarray(np.linalg.inv(self.stiffness[:MOTIONS, :MOTIONS]))


@dataclass(frozen=True, eq=False)
class RollingShaft:
    """Timoshenko shaft on bearings of any kind, as `facegear.parts.shafts.Shaft` has it on springs; `pinion`
    is the place of the pinion's middle along it, m.

    Seen from the pinion's middle the shaft bends by C = B B^T for loads on its bearings, so the rings
    move by T q + B y for a motion q of the pinion, T being `rigid`, with the energy y^T y / 2: no
    stiffness of the shaft is inverted, and bearings may be beside each other.
    """

    segments: tuple[Segment, ...]
    material: Elasticity
    supports: tuple[Support, ...]
    pinion: float

    def scale(self, factor: float) -> "RollingShaft":
        """Return the shaft with all stiffness of its bearings and of itself multiplied by a factor.

        Parameters
        ----------
        factor : float
            On the energy, dimensionless.

        Returns
        -------
        RollingShaft
            With the same clearances and preload.
        """
        material = replace(self.material, young=factor * self.material.young)
        supports = tuple(replace(support, factor=factor * support.factor) for support in self.supports)
        return replace(self, material=material, supports=supports)

    @cached_property
    def rigid(self) -> Array:
        """T: motions of the inner rings by those of the pinion's middle on a rigid shaft, (5 bearings, 5)."""
        return np.concatenate([carry_motion(support.position - self.pinion) for support in self.supports])

    def deflections(self, pinion: Array, forces: Array, at: Array) -> Array:
        """Return the motions of the shaft along its length.

        Parameters
        ----------
        pinion : (5,) array
            Motion of the pinion's middle, m and rad.
        forces : (bearings, 5) array
            Loads of the shaft on its bearings, N and N m.
        at : (n,) array
            Distances from the shaft's beginning, m.

        Returns
        -------
        (n, 5) array
            x, y, z, tilt_x, tilt_y, m and rad.
        """
        positions = np.array([support.position for support in self.supports])
        relative = self._relative_compliance(np.concatenate([positions, at]))
        bearings = MOTIONS * positions.size
        rigid = np.concatenate([carry_motion(float(z) - self.pinion) for z in at])
        motions = rigid @ pinion - relative[bearings:, :bearings] @ forces.ravel()
        return np.asarray(motions.reshape(-1, MOTIONS))

    def _relative_compliance(self, at: Array) -> Array:
        """Return the compliance (5 n, 5 n) of places (n,), m, seen from the pinion, SI units."""
        blocks = clamped_compliance(self.segments, self.material, np.array([self.pinion, *at]))
        size = MOTIONS * (at.size + 1)
        from_beginning = blocks.transpose(0, 2, 1, 3).reshape(size, size)
        rigid = np.concatenate([carry_motion(float(z) - self.pinion) for z in at])
        relative = np.concatenate([-rigid, np.eye(size - MOTIONS)], axis=1)
        return np.asarray(relative @ from_beginning @ relative.T)

    @cached_property
    def bending(self) -> Array:
        """B: motions of the rings by the m coordinates of the bent shaft, (5 bearings, m), m/J^0.5 and
        rad/J^0.5.

        Columns are eigenvectors of the compliance C of the rings, seen from the pinion, times the roots
        of their eigenvalues; eigenvalues below RANGE of the largest are left out.
        """
        arms = self.arms
        positions = np.array([support.position for support in self.supports])
        compliance = self._relative_compliance(positions) * np.outer(arms, arms)
        values, vectors = np.linalg.eigh(0.5 * (compliance + compliance.T))
        counts = values > RANGE * max(float(values[-1]), 1e-300)
        return np.asarray(vectors[:, counts] * np.sqrt(values[counts]) / arms[:, None])

    @property
    def arms(self) -> Array:
        """Arms by which motions of the rings are compared, (5 bearings,): 1 for shifts, the shaft's length
        (m) for tilts.
        """
        length = sum(segment.length for segment in self.segments)
        return np.tile([1.0, 1.0, 1.0, length, length], len(self.supports))

    @cached_property
    def bend_arms(self) -> Array:
        """Largest motion of a ring by each coordinate of the bent shaft, (m,), m/J^0.5."""
        return np.asarray(np.abs(self.bending * self.arms[:, None]).max(axis=0, initial=0.0))

    def search_limits(self, size: float) -> tuple[float, float]:
        """Return `tie` and `reach` of `minimise` for the balance under a load.

        Parameters
        ----------
        size : float
            Largest load, N, moments by their arms.

        Returns
        -------
        float, float
            Largest stiffness that the load would meet in one element of a rolling bearing, N/m (1 without
            any), and the motion, m, beyond which nothing holds the load (infinite without any).
        """
        bearings = [support.bearing for support in self.supports]
        rolling = [bearing for bearing in bearings if not isinstance(bearing, np.ndarray)]
        tie = max((bearing.stiffness_at(max(size, 1.0)) for bearing in rolling), default=1.0)
        return tie, ESCAPE * max((bearing.element_diameter for bearing in rolling), default=np.inf)

    def assemble(self, coordinates: Array, seats: Array) -> tuple[Array, list[Curvature]]:
        """Return the motions of the inner rings against the outer ones and what each bearing answers.

        Parameters
        ----------
        coordinates : (5 + m,) array
            Motion of the pinion (5, m and rad), then coordinates of the bent shaft (m, J^0.5).
        seats : (bearings, 5) array
            Motions of the seats of the outer rings, m and rad.

        Returns
        -------
        (bearings, 5) array, list of Curvature
            Motions with the supports' offsets, m and rad, and energy, loads and tangent of each bearing.
        """
        shaft_motions = self.rigid @ coordinates[:MOTIONS] + self.bending @ coordinates[MOTIONS:]
        rings = shaft_motions.reshape(-1, MOTIONS) - seats
        rings += [support.offset for support in self.supports]
        pairs = zip(self.supports, rings, strict=True)
        return rings, [support.derivatives(ring) for support, ring in pairs]


def find_shaft_equilibrium(shaft: RollingShaft, load: Array, seats: Array | None = None) -> ShaftState:
    """Find the equilibrium of a shaft on its bearings under a load on its pinion, by `minimise`.

    Parameters
    ----------
    shaft : RollingShaft
        The shaft.
    load : (5,) array
        Forces (N) and moments (N m) on the middle of the pinion.
    seats : (bearings, 5) array, optional
        Given motions of the seats of the outer rings, m and rad; 0 by default.

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
    length = float(shaft.arms[3])
    scale = np.concatenate([[1.0, 1.0, 1.0, length, length], shaft.bend_arms])
    tie, reach = shaft.search_limits(float(np.abs(load / scale[:MOTIONS]).max()))
    rows = np.concatenate([shaft.rigid, shaft.bending], axis=1)

    def derivatives(coordinates: Array) -> Curvature:
        """Return the energy and its derivatives by pinion motion and bend coordinates (5 + m,)."""
        return _curve(shaft, coordinates, given_seats, rows)

    outer = np.concatenate([load, np.zeros(shaft.bend_arms.size)])
    return _state(shaft, minimise(derivatives, np.zeros(outer.size), outer, scale, tie, reach), given_seats)


def follow_pinion(shaft: RollingShaft, pinion: Array, seats: Array, bend: Array | None = None) -> ShaftState:
    """Find how a shaft bends, and how it loads its bearings, where motions of pinion and seats are given.

    The energy that remains is convex in the motions of pinion and seats. `ShaftState.loads` is its gradient,
    `ShaftState.stiffness` its second derivative: one element for the statics of a machine.

    Parameters
    ----------
    shaft : RollingShaft
        The shaft.
    pinion : (5,) array
        Motion of the pinion's middle, m and rad.
    seats : (bearings, 5) array
        Motions of the seats, m and rad.
    bend : (m,) array, optional
        Coordinates of the bent shaft at which the search begins, J^0.5; 0 by default.

    Returns
    -------
    ShaftState
        Balance of shaft and bearings.
    """
    begin = np.zeros(shaft.bend_arms.size) if bend is None else bend

    def derivatives(coordinates: Array) -> Curvature:
        """Return the energy and its derivatives by the bend coordinates (m,), the pinion at rest."""
        return _curve(shaft, np.concatenate([pinion, coordinates]), seats, shaft.bending)

    tie, _ = shaft.search_limits(1.0)
    no_load = np.zeros(begin.size)
    bend = minimise(derivatives, begin, no_load, shaft.bend_arms, tie, np.inf) if begin.size else no_load
    return _state(shaft, np.concatenate([pinion, bend]), seats)


def _curve(shaft: RollingShaft, coordinates: Array, seats: Array, rows: Array) -> Curvature:
    """Return the energy of shaft and bearings, and its derivatives by the coordinates that are searched.

    `coordinates` (5 + m,) are motion of the pinion and bend; `rows` (5 bearings, k) map the searched
    ones, all (k = 5 + m) or the bend alone (k = m), to motions of the rings.
    """
    _, answers = shaft.assemble(coordinates, seats)
    bend, count = coordinates[MOTIONS:], rows.shape[1]
    gradient = rows.T @ np.concatenate([answer.gradient for answer in answers])
    matrix = rows.T @ _blocks(answers) @ rows
    gradient[count - bend.size :] += bend
    matrix[count - bend.size :, count - bend.size :] += np.eye(bend.size)
    energy = 0.5 * float(bend @ bend) + sum(answer.energy for answer in answers)
    size = max(answer.size for answer in answers)
    return Curvature(energy, gradient, matrix, size, max(answer.rounding for answer in answers))


def _state(shaft: RollingShaft, coordinates: Array, seats: Array) -> ShaftState:
    """Return loads, ring motions and condensed stiffness at balanced coordinates (5 + m,) of pinion and
    bend.
    """
    rings, answers = shaft.assemble(coordinates, seats)
    pinion, bend = coordinates[:MOTIONS], coordinates[MOTIONS:]
    forces = np.array([answer.gradient for answer in answers])
    energy = 0.5 * float(bend @ bend) + sum(answer.energy for answer in answers)
    stiffness = _condense(shaft, _blocks(answers))
    return ShaftState(energy, pinion, bend, rings, forces, shaft.rigid.T @ forces.ravel(), stiffness)


def _blocks(answers: Sequence[Curvature]) -> Array:
    """Return the block-diagonal matrix of the bearings' tangents, (5 bearings, 5 bearings)."""
    size = MOTIONS * len(answers)
    matrix = np.zeros((size, size))
    for number, answer in enumerate(answers):
        block = slice(MOTIONS * number, MOTIONS * (number + 1))
        matrix[block, block] = answer.matrix
    return matrix


def _condense(shaft: RollingShaft, springs: Array) -> Array:
    """Return the tangent of the loads by motions of pinion and seats, (5 (1 + bearings), ...), symmetric.

    `springs` are the bearings' tangents by `_blocks`; the bend coordinates are eliminated by a Schur
    complement.
    """
    outer = np.concatenate([shaft.rigid, -np.eye(springs.shape[0])], axis=1)
    inner = np.eye(shaft.bending.shape[1]) + shaft.bending.T @ springs @ shaft.bending
    coupling = shaft.bending.T @ springs @ outer
    matrix = outer.T @ springs @ outer - coupling.T @ np.linalg.solve(inner, coupling)
    return np.asarray(0.5 * (matrix + matrix.T))
