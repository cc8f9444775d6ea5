"""Reduction of the loaded contact to the few points that decide its loss, its heat and its film.

The loss is a sum over thousands of points. Over any range of oil, roughness, temperature and speed it lies in
a space of few dimensions, so a few points with weights that are not negative have the same sum (empirical
cubature). The largest flash temperature and the smallest film lie at a few points too, wherever they move
over that range. At these points everything is evaluated by the same functions as at all others.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import nnls

from facegear.arrays import Array, Integers
from facegear.contact.pattern import passage
from facegear.lubrication.contact_points import ContactPoints, LoadedContact, concatenate, select
from facegear.lubrication.heat import (
    Local,
    friction_and_heat_fraction,
    local_state,
    mean_flash,
    starting_bulk,
)
from facegear.lubrication.machine_loss import settled_bulk
from facegear.lubrication.pairs import LossCurves, MeshCurves
from facegear.lubrication.request import BorrowedBulk, Lubrication

SINGULAR = 1e-10
"""Singular values of the losses over the conditions below this part of the largest are rounding."""
CONTENDERS = 3
"""Number of points kept for each extreme at each condition: between conditions it may lie at a neighbour."""


@dataclass(frozen=True, eq=False)
class Condition:
    """State that a reduced contact must be right at: the pinion's speed (rad/s), lubrication, bulk C."""

    speed: float
    lubrication: Lubrication
    bulk: float


@dataclass(frozen=True, eq=False)
class Group:
    """Points (m,) of t torques, torque by torque; `parts` (t): which points each torque has."""

    points: ContactPoints
    parts: tuple[slice, ...]

    @classmethod
    def of(cls, by_torque: Sequence[ContactPoints]) -> "Group":
        """Join the contact points of t torques into one array and remember where each torque's points lie.

        Parameters
        ----------
        by_torque : Sequence[ContactPoints]
            Points of each torque, t entries.

        Returns
        -------
        Group
            All points (m,), torque by torque, and `parts`: t slices into them.
        """
        ends = np.cumsum([0, *(points.plane.size for points in by_torque)]).tolist()
        return cls(concatenate(by_torque), tuple(slice(*bounds) for bounds in pairwise(ends)))

    def reduce_by_torque(self, how: Callable[..., Array], values: Array, empty_value: float) -> Array:
        """Reduce values at the points of all torques to one value for each torque, such as a sum or a
        maximum.

        Parameters
        ----------
        how : callable
            NumPy reduction that takes (n, k), `axis=1` and `initial`, and returns (n,): np.sum, np.max or
            np.min.
        values : (n, m) array
            Values at the points, one row for each of n meshes, any unit.
        empty_value : float
            Passed as `initial`: it also takes part in the reduction where a torque has points.

        Returns
        -------
        (n, t) array
            Reduced values in the same unit.
        """
        return np.stack([how(values[:, part], axis=1, initial=empty_value) for part in self.parts], axis=1)


@dataclass(frozen=True, eq=False)
class FewPlaces:
    """Contacts at t rising torques (N m) by a few points each.

    A point of `loss_points` with friction mu loses `speed mu weight`, `weights` (m,) in N m. Among the points
    of `extreme` are the hottest and those of the thinnest film; no edge is near.
    """

    torques: Array
    loss_points: Group
    weights: Array
    extreme: Group


def reduce_contacts(contacts: Sequence[LoadedContact], conditions: Sequence[Condition]) -> FewPlaces:
    """Choose few points of loaded contacts that give loss, heat and extremes within the range of
    conditions.

    At each torque apart: cubature weights preserve the loss and the pinion's heat at every condition
    exactly (but for rounding). The points of largest flash and smallest films at each condition are kept
    whole.

    Parameters
    ----------
    contacts : Sequence[LoadedContact]
        Contacts with all their points, at rising torques.
    conditions : Sequence[Condition]
        Pinion speeds, lubrications and bulk temperatures that span the range of use.

    Returns
    -------
    FewPlaces
        Points and weights of the loss, and the extreme points, for all torques.
    """
    loss_points, weights, extreme = zip(*(_few(contact, conditions) for contact in contacts), strict=True)
    return FewPlaces(
        torques=np.array([contact.torque for contact in contacts]),
        loss_points=Group.of(loss_points),
        weights=np.concatenate(weights),
        extreme=Group.of(extreme),
    )


def _few(
    contact: LoadedContact, conditions: Sequence[Condition]
) -> tuple[ContactPoints, Array, ContactPoints]:
    """Choose the points of one torque's contact that stand for all of its points at the conditions.

    Returned are the k points that carry the loss, their weights (k,) in N m (loss at a friction
    coefficient of 1 and 1 rad/s of the pinion), and the points that may have the largest flash or the
    smallest film.
    """
    spots, whole = contact.points, contact.weights
    states = [
        local_state(spots, condition.speed, condition.lubrication, condition.bulk) for condition in conditions
    ]
    losses = [state.friction * whole for state in states]
    heat = [loss * state.heat_fraction for loss, state in zip(losses, states, strict=True)]
    factors = cubature(np.array([*losses, *heat]))
    loss_points = np.flatnonzero(factors)
    is_borrowed = any(isinstance(condition.lubrication.bulk, BorrowedBulk) for condition in conditions)
    extreme = np.unique(np.concatenate([_extremes(spots, state, is_borrowed) for state in states]))
    return select(spots, loss_points), (factors * whole)[loss_points], select(spots, extreme)


def cubature(rows: Array) -> Array:
    """Compute sparse non-negative weights w with which `rows @ w` equals the sum of every row (cubature).

    Non-negative least squares match the sums of the right singular vectors of the rows, each divided by
    its sum. Singular values below SINGULAR times the largest are dropped, so sums are exact but for
    rounding. Rows whose sum is not above 0 are left out.

    Parameters
    ----------
    rows : (r, m) array
        Non-negative rows, such as the loss at m points under r conditions; any unit.

    Returns
    -------
    (m,) array
        Weights, dimensionless; most are 0, and all if no row has a positive sum.
    """
    sums = rows.sum(axis=1)
    scaled_rows = rows[sums > 0.0] / sums[sums > 0.0, None]
    if scaled_rows.size == 0:
        return np.zeros(rows.shape[1])
    _, sizes, directions = np.linalg.svd(scaled_rows, full_matrices=False)
    basis = directions[sizes > SINGULAR * sizes[0]]
    factors, _ = nnls(basis, basis.sum(axis=1))
    return factors


def _extremes(spots: ContactPoints, state: Local, is_borrowed: bool) -> Integers:
    """Return the indices of points that may be the hottest or have the thinnest film.

    They are the CONTENDERS points of largest flash, of smallest film ratio and of smallest micropitting
    ratio, all away from edges. With `is_borrowed` the point of largest flash of each contact line is
    added, which the mean flash along the path needs. Indices into the points, possibly repeated.
    """
    on = np.flatnonzero(spots.inside)
    if on.size == 0:
        return on
    contenders = [
        on[np.argsort(values[on], kind="stable")[:CONTENDERS]]
        for values in (-state.flash, state.film_ratio, state.micropitting)
    ]
    if is_borrowed:
        stage = passage(spots.position, spots.tooth)[on]
        hottest_first = on[np.lexsort((-state.flash[on], stage))]
        contenders.append(hottest_first[np.unique(np.sort(stage), return_index=True)[1]])
    return np.concatenate(contenders)


@dataclass(frozen=True, eq=False)
class ReducedPair:
    """Tooth pair by few points of its contact, and how it is lubricated: a `Pair`."""

    few: FewPlaces
    lubrication: Lubrication

    @property
    def torques(self) -> Array:
        """Pinion torques (t,) N m at which the contact was solved, rising."""
        return self.few.torques

    def losses(self, speed: float, bulk: Array) -> LossCurves:
        """Compute the friction loss of meshes at every solved torque, at given bulk temperatures.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C; only their mean counts.

        Returns
        -------
        LossCurves
            Lost part of the power, and the pinion's part of its heat, both (n, t).
        """
        return LossCurves(self.torques, *self._loss_fractions(speed, self._at_torques(bulk)))

    def curves(self, speed: float, bulk: Array) -> MeshCurves:
        """Compute loss, temperature and film of meshes at every solved torque, at given bulk temperatures.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C; only their mean counts.

        Returns
        -------
        MeshCurves
            Lost part of the power, the pinion's part of its heat, largest flash (K), smallest film ratio
            and smallest micropitting ratio, each (n, t).
        """
        return self._curves(speed, self._at_torques(bulk))

    def single_mesh_curves(self, speed: float) -> tuple[MeshCurves, Array]:
        """Compute one mesh alone, with the bulk temperatures that follow from `lubrication.bulk` at each
        torque.

        A given bulk temperature is taken as it is. A borrowed one (ISO/TR 13989-1) is the oil's
        temperature plus 0.47 X_S times the mean flash, found by iteration. With cooling, use
        `machine_loss`, which couples the meshes.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.

        Returns
        -------
        MeshCurves and (1, t, 2) array
            Loss, temperature and film (1, t), and bulk temperatures of pinion and gear, C.

        Raises
        ------
        TooHot
            If a body passes the oil's flash point.
        NotConverged
            If bulk temperatures do not settle.
        """
        lubrication, few = self.lubrication, self.few
        bulk = np.tile(starting_bulk(lubrication), (self.torques.size, 1))
        if isinstance(lubrication.bulk, BorrowedBulk):
            factor, points = 0.47 * lubrication.bulk.supply_factor, few.extreme.points

            def step(before: Array) -> Array:
                """Return the bulk temperatures (t, 2) C that the mean flash at bulk temperatures `before`
                (t, 2) C gives.
                """
                flash = local_state(
                    points, speed, lubrication, _spread(few.extreme, before.mean(axis=1))
                ).flash
                means = [mean_flash(select(points, part), flash[part]) for part in few.extreme.parts]
                return np.repeat(lubrication.oil_temperature + factor * np.array(means), 2).reshape(-1, 2)

            bulk = settled_bulk(step, lubrication, self.torques, speed)
        return self._curves(speed, bulk.mean(axis=1)[None]), bulk[None]

    def _at_torques(self, bulk: Array) -> Array:
        """Average bulk temperatures (n, 2) C of pinion and gear, and repeat the mean at every torque: (n,
        t) C.
        """
        return np.repeat(bulk.mean(axis=1, keepdims=True), self.torques.size, axis=1)

    def _loss_fractions(self, speed: float, warm: Array) -> tuple[Array, Array]:
        """Return the lost part of each mesh's power, and the pinion's part of the lost heat, both (n, t),
        fractions.

        `speed` is the pinion's, rad/s, and `warm` (n, t) the mean bulk temperature, C. The loss is the
        sum of friction * weight over the points, per torque. Where nothing is lost, the pinion's part is
        0.5.
        """
        few, group = self.few, self.few.loss_points
        friction, fraction = friction_and_heat_fraction(
            group.points, speed, self.lubrication, _spread(group, warm)
        )
        loss = np.broadcast_to(friction * few.weights, (warm.shape[0], few.weights.size))
        lost_power, to_pinion = (
            group.reduce_by_torque(np.sum, part, 0.0) for part in (loss, loss * fraction)
        )
        pinion_fraction = np.where(
            lost_power > 0.0, to_pinion / np.where(lost_power > 0.0, lost_power, 1.0), 0.5
        )
        return lost_power / few.torques, pinion_fraction

    def _curves(self, speed: float, warm: Array) -> MeshCurves:
        """Return loss, largest flash and smallest films of n meshes at t torques.

        `speed` is the pinion's, rad/s, and `warm` (n, t) the mean bulk temperature of the flanks, C.
        Where a torque has no point away from edges, the flash is 0 and the films are infinite.
        """
        group = self.few.extreme
        state = local_state(group.points, speed, self.lubrication, _spread(group, warm))
        shape = warm.shape[0], group.points.plane.size
        flash, film, micro = (
            np.broadcast_to(values, shape) for values in (state.flash, state.film_ratio, state.micropitting)
        )
        return MeshCurves(
            self.torques,
            *self._loss_fractions(speed, warm),
            flash=group.reduce_by_torque(np.max, flash, 0.0),
            film_ratio=group.reduce_by_torque(np.min, film, np.inf),
            micropitting=group.reduce_by_torque(np.min, micro, np.inf),
        )


def _spread(group: Group, values: Array) -> Array:
    """Repeat one value per torque, (..., t), at each point of that torque: (..., m), in the order of the
    group.
    """
    return np.repeat(values, [part.stop - part.start for part in group.parts], axis=-1)
