"""A shaft on rolling bearings as one element of a machine, at many positions together.

Its energy is convex in the machine's coordinates that move pinion and seats, and in inner ones: tilts of the
pinion that are no coordinates, and the bent shaft.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array, Integers
from facegear.bearings.elements import thrown_stiffness
from facegear.bearings.equilibrium import ROUNDINGS
from facegear.bearings.response import largest_gap, respond
from facegear.bearings.shaft import RollingShaft, ShaftState, Support, follow_pinion
from facegear.rigid_body import MOTIONS


@dataclass(frozen=True, eq=False)
class ElementResponse:
    """Answer of a shaft at K positions to its k outer and m inner coordinates.

    Attributes
    ----------
    gradient : (K, k + m)
        Derivative of the energy, outer coordinates first, N and N m, and J^0.5 of the bent shaft.
    matrix : (K, k + m, k + m)
        Second derivative.
    rings, forces : (K, bearings, 5)
        Motions of the inner rings against the outer ones, m and rad, and loads of the shaft on its bearings,
        N and N m.
    size, rounding : (K,)
        Largest load of a bearing, and the error of loads by rounding, N, moments by their arms.
    """

    gradient: Array
    matrix: Array
    rings: Array
    forces: Array
    size: Array
    rounding: Array


@dataclass(frozen=True, eq=False)
class ShaftElement:
    """A shaft on its bearings as the statics of a machine take it.

    The inner rings move by `rows` times the outer coordinates plus `inner` times the inner ones, and by the
    offsets of their supports.

    Attributes
    ----------
    shaft : RollingShaft
        The shaft.
    at : (k,)
        Coordinates of the machine that move its rings: those of the pinion, and of seats that move.
    rows : (5 bearings, k)
        Motions of the rings by these coordinates.
    pinion : (5,) array of int
        Motions of the pinion: number among the outer coordinates (below k), or k plus that among the inner.
    """

    shaft: RollingShaft
    at: Integers
    rows: Array
    pinion: Integers

    @cached_property
    def inner(self) -> Array:
        """Motions of the rings by the inner coordinates, (5 bearings, m): tilts that are none of the
        machine's, then the bent shaft.
        """
        free = self.shaft.rigid[:, self.pinion >= self.at.size]
        return np.concatenate([free, self.shaft.bending], axis=1)

    @cached_property
    def springs(self) -> Array:
        """Own stiffness of the inner coordinates, (m,): 0 of tilts, 1 of the bent shaft."""
        bends = self.shaft.bending.shape[1]
        return np.repeat([0.0, 1.0], [self.inner.shape[1] - bends, bends])

    @cached_property
    def inner_arms(self) -> Array:
        """Length that one unit of each inner coordinate counts as, (m,), m."""
        bends = self.shaft.bend_arms
        tilts = np.full(self.inner.shape[1] - bends.size, self.shaft.arms[3])
        return np.concatenate([tilts, bends])

    @cached_property
    def offsets(self) -> Array:
        """Preload of the supports as motions of the rings, (5 bearings,), m and rad."""
        return np.concatenate([support.offset for support in self.shaft.supports])

    def respond(self, outer: Array, inner: Array) -> ElementResponse:
        """Return energy's derivatives and what the bearings carry at K positions.

        Parameters
        ----------
        outer : (K, k) array
            Outer coordinates, m and rad.
        inner : (K, m) array
            Inner coordinates, rad and J^0.5.

        Returns
        -------
        ElementResponse
            SI units.
        """
        count, bearings = len(outer), len(self.shaft.supports)
        rings = (outer @ self.rows.T + inner @ self.inner.T + self.offsets).reshape(count, bearings, MOTIONS)
        rows = np.concatenate([self.rows, self.inner], axis=1).reshape(bearings, MOTIONS, -1)
        size, rounding = np.zeros((2, count))
        forces, gradient = np.empty_like(rings), np.zeros((count, rows.shape[2]))
        matrix = np.zeros((count, rows.shape[2], rows.shape[2]))
        for number, support in enumerate(self.shaft.supports):
            force, stiffness = _respond(support, rings[:, number])
            forces[:, number] = force
            gradient += force @ rows[number]
            matrix += rows[number].T @ stiffness @ rows[number]
            largest, error = self._sizes(support, rings[:, number], force, stiffness)
            size, rounding = np.maximum(size, largest), np.maximum(rounding, error)
        first = self.at.size
        gradient[:, first:] += self.springs * inner
        at = first + np.arange(self.springs.size)
        matrix[:, at, at] += self.springs
        return ElementResponse(gradient, matrix, rings, forces, size, rounding)

    def _sizes(self, support: Support, motion: Array, force: Array, stiffness: Array) -> tuple[Array, Array]:
        """Return the largest load of a bearing (K,) and its rounding (K,), N, moments by their arms, at
        motions, forces (K, 5) and tangents (K, 5, 5).
        """
        arms = self.shaft.arms[:MOTIONS]
        bearing = support.bearing
        length = np.abs(motion * arms).max(axis=1)
        # The largest entry of a matrix without negative eigenvalues stands on its diagonal.
        largest = (np.diagonal(stiffness, axis1=1, axis2=2) / arms**2).max(axis=1)
        if not isinstance(bearing, np.ndarray):
            length = np.maximum(length, largest_gap(bearing))
            largest = np.maximum(largest, thrown_stiffness(bearing))
        return np.abs(force / arms).max(axis=1), ROUNDINGS * np.finfo(float).eps * largest * length

    def longest_step(self, outer: Array, inner: Array) -> Array:
        """Return the part of a step (K, k) and (K, m) in which no ring moves further than its elements may
        give way, (K,), dimensionless.

        Parameters
        ----------
        outer : (K, k) array
            Changes of the outer coordinates, m and rad.
        inner : (K, m) array
            Changes of the inner coordinates, rad and J^0.5.

        Returns
        -------
        (K,) array
            Infinite where nothing moves, or hardly anything.
        """
        rings = (outer @ self.rows.T + inner @ self.inner.T) * self.shaft.arms
        _, reach = self.shaft.search_limits(1.0)
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray(reach / np.abs(rings).max(axis=1))

    def motion(self, outer: Array, inner: Array) -> Array:
        """Return the motions of the pinion's middle, (K, 5), m and rad.

        Parameters
        ----------
        outer : (K, k) array
            Outer coordinates, m and rad.
        inner : (K, m) array
            Inner coordinates, rad and J^0.5.

        Returns
        -------
        (K, 5) array
            x, y, z, tilt_x, tilt_y.
        """
        return np.concatenate([outer, inner], axis=1)[:, self.pinion]

    def start(self, state: ShaftState) -> tuple[Array, Array]:
        """Return outer (k,) and inner (m,) coordinates at a state of the shaft whose seats are at rest.

        Parameters
        ----------
        state : ShaftState
            The state.

        Returns
        -------
        (k,) array, (m,) array
            m, rad and J^0.5.
        """
        tilts = int((self.pinion >= self.at.size).sum())
        coordinates = np.zeros(self.at.size + tilts)
        coordinates[self.pinion] = state.pinion
        return coordinates[: self.at.size], np.concatenate([coordinates[self.at.size :], state.bend])

    def state(self, outer: Array, inner: Array, seats: Array | None = None) -> ShaftState:
        """Return the shaft's state at one position, with its tangent.

        Parameters
        ----------
        outer : (k,) array
            Outer coordinates, m and rad.
        inner : (m,) array
            Inner coordinates, rad and J^0.5.
        seats : (bearings, 5) array or None
            Motions of the seats, m and rad; None at rest.

        Returns
        -------
        ShaftState
            Balance of shaft and bearings at the pinion's motion.
        """
        rest = np.zeros((len(self.shaft.supports), MOTIONS)) if seats is None else seats
        bend = inner[self.springs > 0.0]
        return follow_pinion(self.shaft, self.motion(outer[None], inner[None])[0], rest, bend)


def _respond(support: Support, motion: Array) -> tuple[Array, Array]:
    """Return force (K, 5) and tangent (K, 5, 5) of a bearing at motions (K, 5) of its inner ring."""
    bearing = support.bearing
    if isinstance(bearing, np.ndarray):
        matrix = support.factor * bearing
        return motion @ matrix, np.broadcast_to(matrix, (len(motion), MOTIONS, MOTIONS))
    response = respond(bearing, motion)
    return support.factor * response.force, support.factor * response.stiffness
