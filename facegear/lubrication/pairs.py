"""Lubricated tooth pairs, and the loss, temperature and film of their meshes over the torque."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Protocol, TypeVar

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.lubrication.contact_points import LoadedContact
from facegear.lubrication.heat import Running, running, running_at
from facegear.lubrication.loss import monotone_at
from facegear.lubrication.request import Lubrication


@dataclass(frozen=True, eq=False)
class LossCurves:
    """Loss of n meshes at a speed and at t torques (t,) N m, both (n, t).

    `loss_fraction` is the part of a mesh's power that is lost, `heat_fraction` the part of the loss that
    heats the pinion. Between torques each is interpolated as in `OverTorque`.
    """

    torques: Array
    loss_fraction: Array
    heat_fraction: Array

    def at(self, torque: Array, *names: str) -> Array:
        """Interpolate fields of each mesh at that mesh's torque, monotone in the logarithm of the torque.

        Outside the solved torques the value at the nearest one is kept.

        Parameters
        ----------
        torque : (n,) array
            Torque of each mesh on its pinion, positive, N m.
        *names : str
            Names of fields, such as "loss_fraction".

        Returns
        -------
        (names, n) array
            One row for each name, in the unit of its field.
        """
        values = np.stack([getattr(self, name) for name in names])
        if self.torques.size == 1:
            return values[..., 0]
        log_torque = np.log(np.clip(torque, self.torques[0], self.torques[-1]))
        return monotone_at(np.log(self.torques), values, log_torque)


@dataclass(frozen=True, eq=False)
class MeshCurves(LossCurves):
    """Loss, temperature and film of n meshes at t torques.

    Besides the loss, the largest `flash` (K), the smallest `film_ratio` and `micropitting` ratio, all (n, t)
    and away from edges.
    """

    flash: Array
    film_ratio: Array
    micropitting: Array


class Pair(Protocol):
    """Tooth pair whose contact is known at some torques, and how it is lubricated."""

    @property
    def lubrication(self) -> Lubrication:
        """Oil, roughness, friction and bulk temperature of the flanks."""
        ...

    @property
    def torques(self) -> Array:
        """Pinion torques (t,) N m at which the contact is solved, rising."""
        ...

    def losses(self, speed: float, bulk: Array) -> LossCurves:
        """Compute the friction loss of meshes at every solved torque, at given bulk temperatures.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C.

        Returns
        -------
        LossCurves
            Lost part of the power, and the pinion's part of its heat, both (n, t).
        """

    def curves(self, speed: float, bulk: Array) -> MeshCurves:
        """Compute loss, temperature and film of meshes at every solved torque, at given bulk temperatures.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C.

        Returns
        -------
        MeshCurves
            Loss and heat fractions, largest flash (K), smallest film and micropitting ratio, each (n, t).
        """

    def single_mesh_curves(self, speed: float) -> tuple[MeshCurves, Array]:
        """Compute one mesh alone, with the bulk temperatures that follow from `lubrication.bulk` at each
        torque.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.

        Returns
        -------
        MeshCurves and (k, t, 2) array
            Loss, temperature and film (k, t), and bulk temperatures of pinion and gear, C; k is 1, or the
            number of meshes.
        """


@dataclass(frozen=True, eq=False)
class LoadedPair:
    """Contacts of the tooth pair at rising torques, and how it is lubricated."""

    contacts: tuple[LoadedContact, ...]
    lubrication: Lubrication

    @property
    def torques(self) -> Array:
        """Pinion torques (t,) N m of the contacts, rising."""
        return np.array([contact.torque for contact in self.contacts])

    def states(self, speed: float, bulk: tuple[float, float] | None = None) -> list[Running]:
        """Compute friction, heat and film of one mesh at every torque, at all of its contact points.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : tuple[float, float] or None
            Bulk temperatures of pinion and gear, C. If None, they follow at each torque from
            `lubrication.bulk` with the heat of this mesh alone.

        Returns
        -------
        list[Running]
            One state for each torque.
        """
        if bulk is None:
            return [running(contact, speed, self.lubrication) for contact in self.contacts]
        return [running_at(contact, speed, self.lubrication, bulk) for contact in self.contacts]

    def losses(self, speed: float, bulk: Array) -> LossCurves:
        """Compute the friction loss of meshes at every torque; this class returns all curves, as `curves`
        does.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C.

        Returns
        -------
        LossCurves
            A MeshCurves, whose lost part of the power and pinion's part of the heat are (n, t).
        """
        return self.curves(speed, bulk)

    def curves(self, speed: float, bulk: Array) -> MeshCurves:
        """Compute loss, temperature and film of meshes; meshes of equal bulk temperatures are computed
        once.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C.

        Returns
        -------
        MeshCurves
            Loss and heat fractions, largest flash (K), smallest film and micropitting ratio, each (n, t).
        """
        different, of = np.unique(bulk, axis=0, return_inverse=True)
        rows = [self._row(self.states(speed, (low, high)), speed) for low, high in different.tolist()]
        return MeshCurves(self.torques, *np.stack(rows, axis=1)[:, of.ravel()])

    def single_mesh_curves(self, speed: float) -> tuple[MeshCurves, Array]:
        """Compute one mesh alone, with the bulk temperatures that follow from `lubrication.bulk` at each
        torque.

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
        states = self.states(speed)
        curves = MeshCurves(self.torques, *self._row(states, speed)[:, None])
        return curves, np.array([[state.bulk for state in states]])

    def _row(self, states: Sequence[Running], speed: float) -> Array:
        """Return five rows by t torques of one mesh, in the order of MeshCurves' fields after `torques`.

        Rows: loss fraction, the pinion's part of the heat, largest flash (K), smallest film ratio and
        smallest micropitting ratio, the last three away from edges. `speed` is the pinion's, rad/s.
        """
        inside = [contact.points.inside for contact in self.contacts]
        rows = [
            (
                state.loss / (torque * speed),
                state.heat[0] / state.loss if state.loss > 0 else 0.5,
                state.flash[on].max(initial=0.0),
                state.film_ratio[on].min(initial=np.inf),
                state.micropitting[on].min(initial=np.inf),
            )
            for state, torque, on in zip(states, self.torques, inside, strict=True)
        ]
        return np.array(rows).T


Curves = TypeVar("Curves", bound=LossCurves)


@dataclass(frozen=True, eq=False)
class PairByMesh:
    """Meshes whose flanks have contacts of their own, as one `Pair`.

    Attributes
    ----------
    pairs
        Pair of each contact; all have the same torques and lubrication.
    of : (n,) array of int
        Number of the contact of each mesh.
    """

    pairs: tuple[Pair, ...]
    of: Integers

    @property
    def lubrication(self) -> Lubrication:
        """Oil, roughness, friction and bulk temperature of the flanks."""
        return self.pairs[0].lubrication

    @property
    def torques(self) -> Array:
        """Pinion torques (t,) N m at which the contacts are solved, rising."""
        return self.pairs[0].torques

    def losses(self, speed: float, bulk: Array) -> LossCurves:
        """Compute the friction loss of meshes at every solved torque, at given bulk temperatures.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C.

        Returns
        -------
        LossCurves
            Lost part of the power, and the pinion's part of its heat, both (n, t).
        """
        return self._join(lambda number, on: self.pairs[number].losses(speed, bulk[on]))

    def curves(self, speed: float, bulk: Array) -> MeshCurves:
        """Compute loss, temperature and film of meshes at every solved torque, at given bulk temperatures.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C.

        Returns
        -------
        MeshCurves
            Loss and heat fractions, largest flash (K), smallest film and micropitting ratio, each (n, t).
        """
        return self._join(lambda number, on: self.pairs[number].curves(speed, bulk[on]))

    def single_mesh_curves(self, speed: float) -> tuple[MeshCurves, Array]:
        """Compute each mesh alone, with the bulk temperatures that follow from `lubrication.bulk` at each
        torque.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.

        Returns
        -------
        MeshCurves and (n, t, 2) array
            Loss, temperature and film (n, t), and bulk temperatures of pinion and gear, C.
        """
        by_contact = {
            number: self.pairs[number].single_mesh_curves(speed) for number in set(self.of.tolist())
        }
        bulk = np.concatenate([by_contact[number][1] for number in self.of.tolist()])
        return self._join(lambda number, _: by_contact[number][0]), bulk

    def _join(self, compute: Callable[[int, Mask], Curves]) -> Curves:
        """Return the curves of all n meshes from those of each contact's meshes.

        `compute` takes the number of a contact and which of the meshes (n,) have it, and returns their
        curves, or one row for all of them.
        """
        by_contact = {number: compute(number, self.of == number) for number in sorted(set(self.of.tolist()))}
        first = next(iter(by_contact.values()))
        whole = {field.name: np.empty((self.of.size, self.torques.size)) for field in fields(first)[1:]}
        for number, curves in by_contact.items():
            for name, values in whole.items():
                values[self.of == number] = getattr(curves, name)
        return type(first)(self.torques, **whole)


@dataclass(frozen=True, eq=False)
class FlankPairs:
    """Pairs of the different contacts of both gears' flanks.

    Attributes
    ----------
    pairs
        Pair of each contact, that of the upper gear's drive flank first.
    numbers : (2, 2) array of int
        Number of the contact of each gear (upper, lower) and flank (drive, back).
    """

    pairs: tuple[Pair, ...]
    numbers: Integers

    def of_meshes(self, gears: Integers, flanks: Integers) -> Pair:
        """Return the pair that stands for the loaded flanks of meshes.

        Parameters
        ----------
        gears : (n,) array of int
            Gear of each mesh, 0 upper or alone, 1 lower.
        flanks : (n,) array of int
            Loaded flank of each mesh, 0 drive, 1 back.

        Returns
        -------
        Pair
            The only pair where all contacts are alike, else one with a contact for each of the n meshes.
        """
        if len(self.pairs) == 1:
            return self.pairs[0]
        return PairByMesh(self.pairs, self.numbers[gears, flanks])
