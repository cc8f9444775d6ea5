"""Friction, heat and film of machines among many: by the few places of the contact that decide them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.config.loaded_teeth import contacts_of, lubrication_of
from facegear.config.lubrication import LubricationSection
from facegear.config.tooth_pair import ToothPair
from facegear.load_sharing import quantity_names as names
from facegear.load_sharing.quantities import FlankLoads
from facegear.lubrication.machine_loss import LoadedPair, MachineLoss, MeshLoads, Pair, machine_loss
from facegear.lubrication.places import LoadedContact
from facegear.lubrication.reduction import Condition, FewPlaces, ReducedPair, reduced
from facegear.lubrication.request import GivenBulk, Limits, Lubrication
from facegear.lubrication.scuffing import temperature_safety
from facegear.transmission.machine import Machine
from facegear.transmission.ratings import compute_ratings

GOLDEN = 0.6180339887
"""Multiples of it, less their whole part, are spread evenly over 0..1 however many are taken."""

State = tuple[LubricationSection, float]
"""Lubrication and the pinion's speed in rpm."""


@dataclass(frozen=True, eq=False)
class RubbedTeeth:
    """The contact of a tooth pair at all its places, and at few."""

    section: ToothPair
    contacts: tuple[LoadedContact, ...]
    few: FewPlaces

    def pair(self, lubrication: LubricationSection, every_place: bool) -> Pair:
        """The pair with a lubrication."""
        known = lubrication_of(lubrication, self.section)
        return LoadedPair(self.contacts, known) if every_place else ReducedPair(self.few, known)


Rub = Callable[[pd.DataFrame, Arrays, ToothPair], RubbedTeeth]
"""The teeth of a pair, given the table and the arrays of its contact."""


def rubbing(states: Sequence[State]) -> Rub:
    """Teeth by few places that are right over the range of some states."""

    def rubbed(ltca: pd.DataFrame, pressure: Arrays, section: ToothPair) -> RubbedTeeth:
        contacts = contacts_of(ltca, pressure, section)
        conditions = [
            _condition(lubrication_of(lubrication, section), speed_rpm, (GOLDEN * number) % 1.0)
            for number, (lubrication, speed_rpm) in enumerate(states)
        ]
        return RubbedTeeth(section, contacts, reduced(contacts, conditions))

    return rubbed


def _condition(known: Lubrication, speed_rpm: float, part: float) -> Condition:
    """A bulk temperature that is `part` of the way from the oil as supplied to its flash point, or the given
    one."""
    oil = known.oil_temperature
    warm = oil + part * (known.oil.flash_point - oil)
    given = known.bulk.temperature if isinstance(known.bulk, GivenBulk) else warm
    return Condition(speed_rpm * pi / 30, known, given)


def friction_quantities(
    machine: Machine, speed_rpm: float, loads: FlankLoads, pair: Pair, limits: Limits
) -> dict[str, float]:
    """Columns FRICTION of a machine: loss of the mean loads of its flanks, heat and film of their largest.

    Raises TooHot and NotConverged as `facegear.lubrication.machine_loss` does.
    """
    meshes = mesh_loads(machine, loads)
    losses = machine_loss(pair, meshes, speed_rpm * pi / 30)
    power_in = compute_ratings(machine, speed_rpm).power_in
    hottest, film_ratio = float(losses.contact_temperature.max()), float(losses.film_ratio.min())
    allowed = limits.allowed_contact(pair.known.oil, pair.known.oil_temperature)
    return {
        names.LOSS: losses.total,
        names.LOSS_PERCENT: 100 * losses.total / power_in if power_in > 0.0 else np.nan,
        names.BULK: float(losses.bulk.max()),
        names.FLASH: float(losses.flash.max()),
        names.CONTACT_TEMPERATURE: hottest,
        names.SCUFFING: float(temperature_safety(allowed, pair.known.oil_temperature, hottest)),
        names.SCUFFING_MARGIN: allowed - hottest,
        names.FILM: 1e6 * film_ratio * pair.known.composite_rq,
        names.FILM_RATIO: film_ratio,
        names.MICROPITTING: float(losses.micropitting.min()),
        names.UNSOLVED: _unsolved(losses),
    }


def mesh_loads(machine: Machine, loads: FlankLoads) -> MeshLoads:
    """The flanks that carry anything, with the torques on their pinions."""
    layout = machine.layout
    on = np.flatnonzero(loads.largest > 0.0)
    bodies = np.array(layout.meshes)[on % len(layout.meshes)]
    return MeshLoads(
        pinion=bodies[:, 0],
        gear=bodies[:, 1],
        torque=layout.pinion_arm * loads.mean[on],
        peak=layout.pinion_arm * loads.largest[on],
        pinions=len(layout.pinions),
        bodies=len(layout.bodies),
    )


def _unsolved(losses: MachineLoss) -> float:
    """Part of the loss that arises under torques outside those of the contact analysis."""
    return float(losses.loss[~losses.within].sum() / losses.total) if losses.total > 0.0 else 0.0
