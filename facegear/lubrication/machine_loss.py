"""Loss and heat of a machine: of every mesh by the power it carries, summed over its bodies.

Power that passes several meshes in turn is lost in each of them, and power that circulates in a loop as well:
loss is taken of what a mesh carries, never of what the machine is given. A back flank is the mirror image of
the drive flank and loses alike. To first order in friction the forces are those without it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Protocol

import numpy as np
from scipy.optimize import NoConvergence, anderson

from facegear.arrays import Array, Integers, Mask
from facegear.errors import NotConverged
from facegear.lubrication.heat import (
    SETTLED,
    STEPS,
    Running,
    require_cool,
    running,
    running_at,
    starting_bulk,
)
from facegear.lubrication.loss import OverTorque
from facegear.lubrication.monotone import monotone_at
from facegear.lubrication.places import LoadedContact
from facegear.lubrication.request import Cooling, Lubrication


@dataclass(frozen=True, eq=False)
class LossCurves:
    """Of n meshes at a speed, at t torques (t,) N m, both (n, t): the part of a mesh's power that is `lost`,
    and the pinion's `heat_fraction`. Between torques each is what `OverTorque` says.
    """

    torques: Array
    lost: Array
    heat_fraction: Array

    def at(self, torque: Array, *names: str) -> Array:
        """The quantities named, a row (n,) each, at the torque (n,) of each mesh."""
        values = np.stack([getattr(self, name) for name in names])
        if self.torques.size == 1:
            return values[..., 0]
        asked = np.log(np.clip(torque, self.torques[0], self.torques[-1]))
        return monotone_at(np.log(self.torques), values, asked)


@dataclass(frozen=True, eq=False)
class MeshCurves(LossCurves):
    """The same with the largest `flash` (K), the smallest `film_ratio` and `micropitting` ratio, all (n, t)
    and away from edges.
    """

    flash: Array
    film_ratio: Array
    micropitting: Array


class Pair(Protocol):
    """A tooth pair whose contact is known at some torques, and how it is lubricated."""

    @property
    def known(self) -> Lubrication: ...

    @property
    def torques(self) -> Array: ...

    def losses(self, speed: float, bulk: Array) -> LossCurves:
        """Of meshes with bulk temperatures (n, 2) C at a pinion's speed (rad/s)."""

    def curves(self, speed: float, bulk: Array) -> MeshCurves:
        """The same with temperature and film."""

    def own(self, speed: float) -> tuple[MeshCurves, Array]:
        """Of one mesh (1, t) with the bulk temperatures (t, 2) C that the section gives it at each torque."""


@dataclass(frozen=True, eq=False)
class LoadedPair:
    """Contacts of the tooth pair at rising torques, and how it is lubricated."""

    contacts: tuple[LoadedContact, ...]
    known: Lubrication

    @property
    def torques(self) -> Array:
        """Of the contacts, N m."""
        return np.array([contact.torque for contact in self.contacts])

    def states(self, speed: float, bulk: tuple[float, float] | None = None) -> list[Running]:
        """At every torque at a pinion's speed (rad/s); `bulk` given (C), or its own of a single mesh."""
        if bulk is None:
            return [running(contact, speed, self.known) for contact in self.contacts]
        return [running_at(contact, speed, self.known, bulk) for contact in self.contacts]

    def losses(self, speed: float, bulk: Array) -> LossCurves:
        """As of Pair."""
        return self.curves(speed, bulk)

    def curves(self, speed: float, bulk: Array) -> MeshCurves:
        """As of Pair; meshes with the same bulk temperatures share theirs."""
        different, of = np.unique(bulk, axis=0, return_inverse=True)
        rows = [self._row(self.states(speed, (low, high)), speed) for low, high in different.tolist()]
        return MeshCurves(self.torques, *np.stack(rows, axis=1)[:, of.ravel()])

    def own(self, speed: float) -> tuple[MeshCurves, Array]:
        """As of Pair. Raises TooHot and NotConverged as `running` does."""
        states = self.states(speed)
        curves = MeshCurves(self.torques, *self._row(states, speed)[:, None])
        return curves, np.array([state.bulk for state in states])

    def _row(self, states: Sequence[Running], speed: float) -> Array:
        """Fields of MeshCurves (5, t) of one mesh in its states."""
        inside = [contact.places.inside for contact in self.contacts]
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
    """n loaded flanks of meshes: numbers of their bodies, the mean `torque` (N m) on the pinion, positive on
    either flank, and the largest, `peak`, for heat and film. `bodies` in all, the first `pinions` pinions.
    """

    pinion: Integers
    gear: Integers
    torque: Array
    peak: Array
    pinions: int
    bodies: int


@dataclass(frozen=True, eq=False)
class MachineLoss:
    """Loss (n,) W of every loaded flank, its part that heats the pinion (n,) W, the bulk temperatures of its
    bodies (n, 2) C, the largest flash (n,) K under the peak torque with the film and micropitting ratios,
    and whether mean and peak lie within the torques of the contact analysis. `heat` (bodies,) W.
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
    """At the pinions' speed (rad/s). Raises TooHot and NotConverged as `running` does.

    With cooling given, a body's bulk temperature follows from the heat of all its meshes.
    """
    known, count = pair.known, loads.torque.size
    if not isinstance(known.bulk, Cooling):
        single, own = pair.own(speed)
        curves = MeshCurves(
            pair.torques,
            *(np.repeat(getattr(single, field.name), count, axis=0) for field in fields(single)[1:]),
        )
        return _evaluated(loads, curves, speed, OverTorque(pair.torques, own).at(loads.torque))
    cooling = known.bulk

    def step(bulk: Array) -> Array:
        heat = _heat(loads, *_losses(loads, pair.losses(speed, bulk), speed))
        return _machine_bulk(loads, heat, cooling, known.oil_temperature)

    bulk = settled_bulk(step, known, loads.torque, speed)
    return _evaluated(loads, pair.curves(speed, bulk), speed, bulk)


def settled_bulk(step: Callable[[Array], Array], known: Lubrication, torque: Array, speed: float) -> Array:
    """Bulk temperatures (n, 2) C under torques (n,) N m that `step`, from loss to temperature, leaves alone.

    Raises TooHot where a body passes the oil's flash point, NotConverged.
    """

    def cool(bulk: Array) -> Array:
        after = step(bulk)
        for row, load in zip(after.tolist(), torque.tolist(), strict=True):
            require_cool((row[0], row[1]), known, load, speed)
        return after

    start = np.tile(starting_bulk(known), (torque.size, 1))
    try:
        return anderson(
            lambda bulk: cool(bulk) - bulk,
            start,
            alpha=1.0,  # the first step takes over what `cool` gives
            f_tol=SETTLED,
            maxiter=STEPS,
            line_search=None,
        )
    except NoConvergence:
        what = f"{STEPS} steps of loss and bulk temperature"
        raise NotConverged("bulk temperature", f"{speed:g} rad/s", what) from None


def _losses(loads: MeshLoads, curves: LossCurves, speed: float) -> tuple[Array, Array]:
    """Loss (n,) W of every loaded flank, and the part of it that heats the pinion."""
    lost, fraction = curves.at(loads.torque, "lost", "heat_fraction")
    loss = lost * loads.torque * speed
    return loss, fraction * loss


def _heat(loads: MeshLoads, loss: Array, warm: Array) -> Array:
    """Heat (bodies,) W."""
    heat = np.zeros(loads.bodies)
    np.add.at(heat, loads.pinion, warm)
    np.add.at(heat, loads.pinions + loads.gear, loss - warm)
    return heat


def _evaluated(loads: MeshLoads, curves: MeshCurves, speed: float, bulk: Array) -> MachineLoss:
    loss, warm = _losses(loads, curves, speed)
    flash, film_ratio, micropitting = curves.at(loads.peak, "flash", "film_ratio", "micropitting")
    solved = OverTorque(curves.torques, curves.torques)
    return MachineLoss(
        loss=loss,
        pinion_heat=warm,
        bulk=bulk,
        flash=flash,
        film_ratio=film_ratio,
        micropitting=micropitting,
        within=solved.within(loads.torque) & solved.within(loads.peak),
        heat=_heat(loads, loss, warm),
    )


def _machine_bulk(loads: MeshLoads, heat: Array, cooling: Cooling, oil_temperature: float) -> Array:
    """Bulk temperatures (n, 2) C of the bodies of every loaded flank."""
    rises = heat[loads.pinion] / cooling.pinion, heat[loads.pinions + loads.gear] / cooling.face_gear
    return oil_temperature + np.stack(rises, axis=1)
