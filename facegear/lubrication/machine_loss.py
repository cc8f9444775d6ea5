"""Loss and heat of a machine: those of every mesh by the power it carries, summed over its bodies.

Power that passes several meshes in turn is lost in each of them, and power that circulates in a loop as well:
loss is taken of what a mesh carries, never of what the machine is given. A back flank is the mirror image of
the drive flank and has the same loss. To first order in friction the forces are those without it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Protocol

import numpy as np
from scipy.optimize import NoConvergence, anderson

from facegear.arrays import Array, Integers, Mask
from facegear.errors import NotConverged
from facegear.lubrication.contact_points import LoadedContact
from facegear.lubrication.heat import (
    BULK_TOLERANCE,
    STEPS,
    Running,
    require_cool,
    running,
    running_at,
    starting_bulk,
)
from facegear.lubrication.loss import OverTorque, monotone_at
from facegear.lubrication.request import Cooling, Lubrication


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
        """Interpolate quantities of each mesh at its torque.

        Parameters
        ----------
        torque : (n,) array
            Torques, N m.
        *names : str
            Names of fields.

        Returns
        -------
        (names, n) array
            Values in the units of the fields.
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
        """Torques at which the contact is solved, N m."""
        ...

    def losses(self, speed: float, bulk: Array) -> LossCurves:
        """Compute the friction loss of meshes at every torque, at given bulk temperatures.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C.

        Returns
        -------
        LossCurves
            Loss of the meshes (n, t).
        """

    def curves(self, speed: float, bulk: Array) -> MeshCurves:
        """Compute loss, temperature and film of meshes at every torque, at given bulk temperatures.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C.

        Returns
        -------
        MeshCurves
            Loss, temperature and film of the meshes (n, t).
        """

    def single_mesh_curves(self, speed: float) -> tuple[MeshCurves, Array]:
        """Compute one mesh with the bulk temperatures that the section gives it at each torque.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.

        Returns
        -------
        MeshCurves and (t, 2) array
            Loss, temperature and film (1, t), and bulk temperatures of pinion and gear, C.
        """


@dataclass(frozen=True, eq=False)
class LoadedPair:
    """Contacts of the tooth pair at rising torques, and how it is lubricated."""

    contacts: tuple[LoadedContact, ...]
    lubrication: Lubrication

    @property
    def torques(self) -> Array:
        """Torques of the contacts, N m."""
        return np.array([contact.torque for contact in self.contacts])

    def states(self, speed: float, bulk: tuple[float, float] | None = None) -> list[Running]:
        """Compute the state of the flanks at every torque.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : tuple[float, float] or None
            Bulk temperatures of pinion and gear, C; None: those of a single mesh.

        Returns
        -------
        list[Running]
            One state for each torque.
        """
        if bulk is None:
            return [running(contact, speed, self.lubrication) for contact in self.contacts]
        return [running_at(contact, speed, self.lubrication, bulk) for contact in self.contacts]

    def losses(self, speed: float, bulk: Array) -> LossCurves:
        """Compute the friction loss of meshes at every torque, at given bulk temperatures.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C.

        Returns
        -------
        LossCurves
            Loss of the meshes (n, t).
        """
        return self.curves(speed, bulk)

    def curves(self, speed: float, bulk: Array) -> MeshCurves:
        """Compute loss, temperature and film of meshes; meshes with the same bulk temperatures share theirs.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.
        bulk : (n, 2) array
            Bulk temperatures of pinion and gear of each mesh, C.

        Returns
        -------
        MeshCurves
            Loss, temperature and film of the meshes (n, t).
        """
        different, of = np.unique(bulk, axis=0, return_inverse=True)
        rows = [self._row(self.states(speed, (low, high)), speed) for low, high in different.tolist()]
        return MeshCurves(self.torques, *np.stack(rows, axis=1)[:, of.ravel()])

    def single_mesh_curves(self, speed: float) -> tuple[MeshCurves, Array]:
        """Compute one mesh with the bulk temperatures that the section gives it at each torque.

        Parameters
        ----------
        speed : float
            Pinion speed, rad/s.

        Returns
        -------
        MeshCurves and (t, 2) array
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
        return curves, np.array([state.bulk for state in states])

    def _row(self, states: Sequence[Running], speed: float) -> Array:
        """Return the fields (5, t) of MeshCurves of one mesh from its states at t torques."""
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


@dataclass(frozen=True, eq=False)
class MeshLoads:
    """Loads of n flanks of meshes.

    `pinion` and `gear` are the numbers of their bodies. `torque` is the mean torque (N m) on the pinion,
    positive on either flank, and `peak` the largest, for heat and film. There are `bodies` bodies in all, the
    first `pinions` of them pinions.
    """

    pinion: Integers
    gear: Integers
    torque: Array
    peak: Array
    pinions: int
    bodies: int


@dataclass(frozen=True, eq=False)
class MachineLoss:
    """Loss and heat of a machine with n loaded flanks.

    `loss` (n,) W and `pinion_heat`, its part (n,) W that heats the pinion; `bulk` temperatures of the bodies
    (n, 2) C; the largest `flash` (n,) K under the peak torque with `film_ratio` and `micropitting` ratio;
    `within`: whether mean and peak lie within the torques of the contact analysis. `heat` (bodies,) W.
    """

    loss: Array
    pinion_heat: Array
    bulk: Array
    flash: Array
    film_ratio: Array
    micropitting: Array
    within: Mask
    heat: Array

    @property
    def contact_temperature(self) -> Array:
        """Largest temperature (n,) C of the contact: the mean bulk temperature and the flash."""
        return self.bulk.mean(axis=1) + self.flash

    @property
    def total(self) -> float:
        """Loss of all meshes, W."""
        return float(self.loss.sum())


def machine_loss(pair: Pair, loads: MeshLoads, speed: float) -> MachineLoss:
    """Compute loss and heat of a machine.

    With cooling given, a body's bulk temperature follows from the heat of all its meshes.

    Parameters
    ----------
    pair : Pair
        Lubricated tooth pair.
    loads : MeshLoads
        Torques of the loaded flanks.
    speed : float
        Speed of the pinions, rad/s.

    Returns
    -------
    MachineLoss
        Loss, heat, temperature and film of every loaded flank.

    Raises
    ------
    TooHot
        If a body passes the oil's flash point.
    NotConverged
        If bulk temperatures do not settle.
    """
    lubrication, count = pair.lubrication, loads.torque.size
    if not isinstance(lubrication.bulk, Cooling):
        single, single_bulk = pair.single_mesh_curves(speed)
        curves = MeshCurves(
            pair.torques,
            *(np.repeat(getattr(single, field.name), count, axis=0) for field in fields(single)[1:]),
        )
        return _machine_loss_of(loads, curves, speed, OverTorque(pair.torques, single_bulk).at(loads.torque))
    cooling = lubrication.bulk

    def step(bulk: Array) -> Array:
        heat = _heat(loads, *_losses(loads, pair.losses(speed, bulk), speed))
        return _machine_bulk(loads, heat, cooling, lubrication.oil_temperature)

    bulk = settled_bulk(step, lubrication, loads.torque, speed)
    return _machine_loss_of(loads, pair.curves(speed, bulk), speed, bulk)


def settled_bulk(
    step: Callable[[Array], Array], lubrication: Lubrication, torque: Array, speed: float
) -> Array:
    """Find the bulk temperatures that a step from loss to temperature leaves unchanged.

    Parameters
    ----------
    step : callable
        Function from bulk temperatures (n, 2) C to those that follow from their loss.
    lubrication : Lubrication
        How the flanks are lubricated.
    torque : (n,) array
        Torques, N m.
    speed : float
        Pinion speed, rad/s.

    Returns
    -------
    (n, 2) array
        Bulk temperatures of pinion and gear, C.

    Raises
    ------
    TooHot
        If a body passes the oil's flash point.
    NotConverged
        If they do not settle.
    """

    def cool(bulk: Array) -> Array:
        after = step(bulk)
        for row, load in zip(after.tolist(), torque.tolist(), strict=True):
            require_cool((row[0], row[1]), lubrication, load, speed)
        return after

    start = np.tile(starting_bulk(lubrication), (torque.size, 1))
    try:
        return anderson(
            lambda bulk: cool(bulk) - bulk,
            start,
            alpha=1.0,  # the first step takes over what `cool` gives
            f_tol=BULK_TOLERANCE,
            maxiter=STEPS,
            line_search=None,
        )
    except NoConvergence:
        attempt = f"{STEPS} steps of loss and bulk temperature"
        raise NotConverged("bulk temperature", f"{speed:g} rad/s", attempt) from None


def _losses(loads: MeshLoads, curves: LossCurves, speed: float) -> tuple[Array, Array]:
    """Return the loss (n,) of every loaded flank, and the part of it that heats the pinion, both in W."""
    loss_fraction, fraction = curves.at(loads.torque, "loss_fraction", "heat_fraction")
    loss = loss_fraction * loads.torque * speed
    return loss, fraction * loss


def _heat(loads: MeshLoads, loss: Array, warm: Array) -> Array:
    """Return the heat (bodies,), W, that every body takes up from its meshes."""
    heat = np.zeros(loads.bodies)
    np.add.at(heat, loads.pinion, warm)
    np.add.at(heat, loads.pinions + loads.gear, loss - warm)
    return heat


def _machine_loss_of(loads: MeshLoads, curves: MeshCurves, speed: float, bulk: Array) -> MachineLoss:
    """Return losses, temperatures and film of all meshes at given bulk temperatures, C."""
    loss, warm = _losses(loads, curves, speed)
    flash, film_ratio, micropitting = curves.at(loads.peak, "flash", "film_ratio", "micropitting")
    torque_range = OverTorque(curves.torques, curves.torques)
    return MachineLoss(
        loss=loss,
        pinion_heat=warm,
        bulk=bulk,
        flash=flash,
        film_ratio=film_ratio,
        micropitting=micropitting,
        within=torque_range.within(loads.torque) & torque_range.within(loads.peak),
        heat=_heat(loads, loss, warm),
    )


def _machine_bulk(loads: MeshLoads, heat: Array, cooling: Cooling, oil_temperature: float) -> Array:
    """Bulk temperatures (n, 2) C of the bodies of every loaded flank."""
    rises = heat[loads.pinion] / cooling.pinion, heat[loads.pinions + loads.gear] / cooling.face_gear
    return oil_temperature + np.stack(rises, axis=1)
