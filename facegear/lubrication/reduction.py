"""The loaded contact reduced to the few places that decide its loss, its heat and its film.

The loss is a sum over thousands of places. Over any range of oil, roughness, temperature and speed it lies in
a space of few dimensions, so a few places with weights that are not negative have the same sum (empirical
cubature). The largest flash temperature and the smallest film lie at a few places too, wherever they move
over that range. At these places everything is evaluated by the same functions as at all others.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import nnls

from facegear.arrays import Array, Integers
from facegear.contact.pattern import passage
from facegear.lubrication.heat import Local, local_state, mean_flash, rubbed, starting_bulk
from facegear.lubrication.machine_loss import LossCurves, MeshCurves, settled_bulk
from facegear.lubrication.places import LoadedContact, Places, joined, taken
from facegear.lubrication.request import BorrowedBulk, Lubrication

SINGULAR = 1e-10
"""Singular values of the losses over the conditions below this part of the largest are rounding."""
CONTENDERS = 3
"""Places kept for each extreme at each condition: between conditions the extreme may lie at a neighbour."""


@dataclass(frozen=True, eq=False)
class Condition:
    """A state that a reduced contact must be right at: the pinion's speed (rad/s), lubrication, bulk C."""

    speed: float
    known: Lubrication
    bulk: float


@dataclass(frozen=True, eq=False)
class Group:
    """Places (m,) of t torques, torque by torque; `parts` (t): which places each torque has."""

    places: Places
    parts: tuple[slice, ...]

    @classmethod
    def of(cls, by_torque: Sequence[Places]) -> "Group":
        """From the places of each torque."""
        ends = np.cumsum([0, *(places.plane.size for places in by_torque)]).tolist()
        return cls(joined(by_torque), tuple(slice(*bounds) for bounds in pairwise(ends)))

    def gathered(self, how: Callable[..., Array], values: Array, nothing: float) -> Array:
        """Values (n, m) gathered to (n, t); `nothing` where a torque has no place."""
        return np.stack([how(values[:, part], axis=1, initial=nothing) for part in self.parts], axis=1)


@dataclass(frozen=True, eq=False)
class FewPlaces:
    """Contacts at t rising torques (N m) by a few places each.

    A place of `losing` with friction mu loses `speed mu weight`, `weights` (m,) in N m. Among the places of
    `extreme` are the hottest and those of the thinnest film; no edge is near.
    """

    torques: Array
    losing: Group
    weights: Array
    extreme: Group


def reduced(contacts: Sequence[LoadedContact], conditions: Sequence[Condition]) -> FewPlaces:
    """Few places of contacts at rising torques, for any state within the range of the conditions."""
    losing, weights, extreme = zip(*(_few(contact, conditions) for contact in contacts), strict=True)
    return FewPlaces(
        torques=np.array([contact.torque for contact in contacts]),
        losing=Group.of(losing),
        weights=np.concatenate(weights),
        extreme=Group.of(extreme),
    )


def _few(contact: LoadedContact, conditions: Sequence[Condition]) -> tuple[Places, Array, Places]:
    """Places that lose, with their weights, and extreme ones."""
    spots, whole = contact.places, contact.weights
    states = [
        local_state(spots, condition.speed, condition.known, condition.bulk) for condition in conditions
    ]
    losses = [state.friction * whole for state in states]
    heat = [loss * state.heat_fraction for loss, state in zip(losses, states, strict=True)]
    factors = cubature(np.array([*losses, *heat]))
    losing = np.flatnonzero(factors)
    borrowed = any(isinstance(condition.known.bulk, BorrowedBulk) for condition in conditions)
    extreme = np.unique(np.concatenate([_extremes(spots, state, borrowed) for state in states]))
    return taken(spots, losing), (factors * whole)[losing], taken(spots, extreme)


def cubature(rows: Array) -> Array:
    """Factors (m,), none negative and most 0, with which every row (r, m) has the sum that it has with 1.

    Rows of sum 0 are left out.
    """
    sums = rows.sum(axis=1)
    scaled = rows[sums > 0.0] / sums[sums > 0.0, None]
    if scaled.size == 0:
        return np.zeros(rows.shape[1])
    _, sizes, directions = np.linalg.svd(scaled, full_matrices=False)
    basis = directions[sizes > SINGULAR * sizes[0]]
    factors, _ = nnls(basis, basis.sum(axis=1))
    return factors


def _extremes(spots: Places, state: Local, borrowed: bool) -> Integers:
    """Places of the largest flash and the smallest films; with `borrowed` the hottest of each line too."""
    on = np.flatnonzero(spots.inside)
    if on.size == 0:
        return on
    contenders = [
        on[np.argsort(values[on], kind="stable")[:CONTENDERS]]
        for values in (-state.flash, state.film_ratio, state.micropitting)
    ]
    if borrowed:
        stage = passage(spots.position, spots.tooth)[on]
        hottest_first = on[np.lexsort((-state.flash[on], stage))]
        contenders.append(hottest_first[np.unique(np.sort(stage), return_index=True)[1]])
    return np.concatenate(contenders)


@dataclass(frozen=True, eq=False)
class ReducedPair:
    """A tooth pair by few places of its contact, and how it is lubricated; a `Pair` of machine_loss."""

    few: FewPlaces
    known: Lubrication

    @property
    def torques(self) -> Array:
        """Of the contacts, N m."""
        return self.few.torques

    def losses(self, speed: float, bulk: Array) -> LossCurves:
        """As of Pair."""
        return LossCurves(self.torques, *self._lost(speed, self._at_torques(bulk)))

    def curves(self, speed: float, bulk: Array) -> MeshCurves:
        """As of Pair."""
        return self._curves(speed, self._at_torques(bulk))

    def own(self, speed: float) -> tuple[MeshCurves, Array]:
        """As of Pair. Raises TooHot and NotConverged as `facegear.lubrication.heat.running` does."""
        known, few = self.known, self.few
        bulk = np.tile(starting_bulk(known), (self.torques.size, 1))
        if isinstance(known.bulk, BorrowedBulk):
            factor, places = 0.47 * known.bulk.supply_factor, few.extreme.places

            def step(before: Array) -> Array:
                flash = local_state(places, speed, known, _spread(few.extreme, before.mean(axis=1))).flash
                means = [mean_flash(taken(places, part), flash[part]) for part in few.extreme.parts]
                return np.repeat(known.oil_temperature + factor * np.array(means), 2).reshape(-1, 2)

            bulk = settled_bulk(step, known, self.torques, speed)
        return self._curves(speed, bulk.mean(axis=1)[None]), bulk

    def _at_torques(self, bulk: Array) -> Array:
        """Mean bulk temperatures (n, t) C, the same at every torque."""
        return np.repeat(bulk.mean(axis=1, keepdims=True), self.torques.size, axis=1)

    def _lost(self, speed: float, warm: Array) -> tuple[Array, Array]:
        """Part of the power that is lost, and of that what heats the pinion (n, t), at mean bulk (n, t) C."""
        few, group = self.few, self.few.losing
        friction, fraction = rubbed(group.places, speed, self.known, _spread(group, warm))
        loss = np.broadcast_to(friction * few.weights, (warm.shape[0], few.weights.size))
        lost, to_pinion = (group.gathered(np.sum, part, 0.0) for part in (loss, loss * fraction))
        parted = np.where(lost > 0.0, to_pinion / np.where(lost > 0.0, lost, 1.0), 0.5)
        return lost / few.torques, parted

    def _curves(self, speed: float, warm: Array) -> MeshCurves:
        """Of n meshes with mean bulk temperatures (n, t) C at the torques."""
        group = self.few.extreme
        state = local_state(group.places, speed, self.known, _spread(group, warm))
        shape = warm.shape[0], group.places.plane.size
        flash, film, micro = (
            np.broadcast_to(values, shape) for values in (state.flash, state.film_ratio, state.micropitting)
        )
        return MeshCurves(
            self.torques,
            *self._lost(speed, warm),
            flash=group.gathered(np.max, flash, 0.0),
            film_ratio=group.gathered(np.min, film, np.inf),
            micropitting=group.gathered(np.min, micro, np.inf),
        )


def _spread(group: Group, values: Array) -> Array:
    """Values (..., t) of torques at the places (..., m) of a group."""
    return np.repeat(values, [part.stop - part.start for part in group.parts], axis=-1)
