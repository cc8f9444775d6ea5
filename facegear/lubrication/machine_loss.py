"""Loss and heat of a machine: of every mesh by the power it carries, summed over its bodies.

Power that passes several meshes in turn is lost in each of them, and power that circulates in a loop as well:
loss is taken of what a mesh carries, never of what the machine is given. A back flank is the mirror image of
the drive flank and loses alike. To first order in friction the forces are those without it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.errors import NotConverged
from facegear.lubrication.heat import (
    STEPS,
    Running,
    require_cool,
    running,
    running_at,
    settled,
    starting_bulk,
    warmed,
)
from facegear.lubrication.loss import OverTorque
from facegear.lubrication.places import LoadedContact
from facegear.lubrication.request import Cooling, Lubrication


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


@dataclass(frozen=True, eq=False)
class MeshCurves:
    """Of one mesh at a speed, over torque: part of its power `lost`, the pinion's `heat_fraction`, the
    largest `flash` (K), the smallest `film_ratio` and `micropitting` ratio; the last three away from edges.
    """

    lost: OverTorque
    heat_fraction: OverTorque
    flash: OverTorque
    film_ratio: OverTorque
    micropitting: OverTorque


def _mesh_curves(pair: LoadedPair, states: Sequence[Running], speed: float) -> MeshCurves:
    """Curves over the torques of the pair in its `states` at a speed (rad/s)."""
    inside = [contact.places.inside for contact in pair.contacts]
    rows = [
        (
            state.loss / (torque * speed),
            state.heat[0] / state.loss if state.loss > 0 else 0.5,
            state.flash[on].max(initial=0.0),
            state.film_ratio[on].min(initial=np.inf),
            state.micropitting[on].min(initial=np.inf),
        )
        for state, torque, on in zip(states, pair.torques, inside, strict=True)
    ]
    return MeshCurves(*(OverTorque(pair.torques, np.array(column)) for column in zip(*rows, strict=True)))


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


def machine_loss(pair: LoadedPair, loads: MeshLoads, speed: float) -> MachineLoss:
    """At the pinions' speed (rad/s). Raises TooHot and NotConverged as `running` does.

    With cooling given, a body's bulk temperature follows from the heat of all its meshes.
    """
    known = pair.known
    if not isinstance(known.bulk, Cooling):
        states = pair.states(speed)
        same = [_mesh_curves(pair, states, speed)] * loads.torque.size
        return _evaluated(loads, same, speed, _own_bulk(pair, states, loads.torque))
    bulk = np.tile(starting_bulk(known), (loads.torque.size, 1))
    for _ in range(STEPS):
        curves = _curves_at(pair, speed, bulk)
        losses = _evaluated(loads, curves, speed, bulk)
        after = _machine_bulk(loads, losses.heat, known.bulk, known.oil_temperature)
        if all(settled(tuple(new), tuple(old)) for new, old in zip(after, bulk, strict=True)):
            return losses
        for row, torque in zip(after, loads.torque, strict=True):
            require_cool((row[0], row[1]), known, float(torque), speed)
        bulk = after
    raise NotConverged("bulk temperature", f"{speed:g} rad/s", f"{STEPS} steps of loss and bulk temperature")


def _curves_at(pair: LoadedPair, speed: float, bulk: Array) -> list[MeshCurves]:
    """Of every loaded flank; those with the same bulk temperatures share theirs."""
    known: dict[tuple[float, float], MeshCurves] = {}
    for low, high in bulk.tolist():
        if (low, high) not in known:
            known[low, high] = _mesh_curves(pair, pair.states(speed, (low, high)), speed)
    return [known[low, high] for low, high in bulk.tolist()]


def _own_bulk(pair: LoadedPair, states: Sequence[Running], torque: Array) -> Array:
    """Bulk temperatures (n, 2) of meshes under torques (n,) that do not feel each other's heat."""
    sides = zip(*(state.bulk for state in states), strict=True)
    return np.stack([OverTorque(pair.torques, np.array(side)).at(torque) for side in sides], axis=1)


def _evaluated(loads: MeshLoads, curves: Sequence[MeshCurves], speed: float, bulk: Array) -> MachineLoss:
    def at(name: str, torques: Array) -> Array:
        return np.array(
            [float(getattr(curve, name).at(torque)) for curve, torque in zip(curves, torques, strict=True)]
        )

    loss = at("lost", loads.torque) * loads.torque * speed
    warm = at("heat_fraction", loads.torque) * loss
    heat = np.zeros(loads.bodies)
    np.add.at(heat, loads.pinion, warm)
    np.add.at(heat, loads.pinions + loads.gear, loss - warm)
    within = [
        bool(curve.lost.within(low)) and bool(curve.lost.within(high))
        for curve, low, high in zip(curves, loads.torque, loads.peak, strict=True)
    ]
    return MachineLoss(
        loss=loss,
        pinion_heat=warm,
        bulk=bulk,
        flash=at("flash", loads.peak),
        film_ratio=at("film_ratio", loads.peak),
        micropitting=at("micropitting", loads.peak),
        within=np.array(within),
        heat=heat,
    )


def _machine_bulk(loads: MeshLoads, heat: Array, cooling: Cooling, oil_temperature: float) -> Array:
    rows = [
        warmed((heat[i], heat[loads.pinions + g]), cooling, oil_temperature)
        for i, g in zip(loads.pinion.tolist(), loads.gear.tolist(), strict=True)
    ]
    return np.array(rows)
