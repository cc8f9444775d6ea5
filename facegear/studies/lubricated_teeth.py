"""Friction, heat and film of machines among many, by the few points of the contact that decide them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
import pandas as pd

from facegear import quantities
from facegear.arrays import Arrays, Integers, Mask
from facegear.build.lubrication import contacts_of, lubrication_of
from facegear.build.tooth_pair import ToothPair
from facegear.lubrication.contact_points import LoadedContact
from facegear.lubrication.film import temperature_safety
from facegear.lubrication.machine_loss import MachineLoss, MeshLoads, machine_loss
from facegear.lubrication.pairs import FlankPairs, LoadedPair, Pair
from facegear.lubrication.reduction import Condition, FewPlaces, ReducedPair, reduce_contacts
from facegear.lubrication.request import GivenBulk, Limits, Lubrication
from facegear.machine.layout import Layout
from facegear.machine.machine import Machine
from facegear.machine.ratings import compute_ratings
from facegear.schema.lubrication import LubricationSection
from facegear.sharing.quantities import FlankLoads
from facegear.teeth.placement import GEARS

GOLDEN = 0.6180339887
"""Multiples of it, less their whole part, are spread evenly over 0..1 however many are taken."""

State = tuple[LubricationSection, float]
"""Lubrication and the pinion's speed in rpm."""


@dataclass(frozen=True, eq=False)
class LubricatedTeeth:
    """Contacts of the flanks of a tooth pair at all their points, and at few.

    `numbers` (2, 2): number of the contact of each gear (upper, lower) and flank (drive, back).
    """

    section: ToothPair
    contacts: tuple[tuple[LoadedContact, ...], ...]
    few: tuple[FewPlaces, ...]
    numbers: Integers

    def pairs(self, lubrication: LubricationSection, every_place: bool) -> FlankPairs:
        """Return the pairs of all flanks with their lubrication, for losses at any mesh torque.

        Parameters
        ----------
        lubrication : LubricationSection
            Section `lubrication` of the config.
        every_place : bool
            True: all points of the contact. False: the few chosen ones that give nearly the same loss and
            extremes.

        Returns
        -------
        FlankPairs
            Contacts at the torques of the analysis, with the lubrication in SI units.
        """
        request = lubrication_of(lubrication, self.section)
        if every_place:
            pairs: tuple[Pair, ...] = tuple(LoadedPair(contact, request) for contact in self.contacts)
        else:
            pairs = tuple(ReducedPair(few, request) for few in self.few)
        return FlankPairs(pairs, self.numbers)


ReduceTeeth = Callable[[pd.DataFrame, Arrays, ToothPair], LubricatedTeeth]
"""The teeth of a pair, given the table and the arrays of its contact."""


def reduction_over(states: Sequence[State]) -> ReduceTeeth:
    """Return a function that reduces contacts to few points whose loss and extremes hold at some states.

    Where the bulk temperature is not given, the states take it evenly from supplied oil to flash point.

    Parameters
    ----------
    states : Sequence[State]
        Section `lubrication` and pinion speed (rpm) of each state.

    Returns
    -------
    ReduceTeeth
        Function from table `ltca`, arrays `pressure` and section tooth_pair to the contact at all its
        points and at few.
    """

    def reduce_contact(ltca: pd.DataFrame, pressure: Arrays, section: ToothPair) -> LubricatedTeeth:
        """Return a pair's contact at all points and reduced to few, from table `ltca` and arrays
        `pressure`.
        """
        contacts, numbers = contacts_of(ltca, pressure, section)
        conditions = [
            _condition(lubrication_of(lubrication, section), speed_rpm, (GOLDEN * number) % 1.0)
            for number, (lubrication, speed_rpm) in enumerate(states)
        ]
        few = tuple(reduce_contacts(contact, conditions) for contact in contacts)
        return LubricatedTeeth(section, tuple(contacts), few, numbers)

    return reduce_contact


def _condition(lubrication: Lubrication, speed_rpm: float, part: float) -> Condition:
    """Return a state at which reduced contact must be right: pinion speed (rad/s), lubrication and bulk
    temperature.

    The bulk temperature is the given one, else `part` (0 to 1) of the way from the supplied oil to its
    flash point.
    """
    oil = lubrication.oil_temperature
    warm = oil + part * (lubrication.oil.flash_point - oil)
    bulk_temperature = lubrication.bulk.temperature if isinstance(lubrication.bulk, GivenBulk) else warm
    return Condition(speed_rpm * pi / 30, lubrication, bulk_temperature)


def friction_quantities(
    machine: Machine, speed_rpm: float, loads: FlankLoads, pairs: FlankPairs, limits: Limits
) -> dict[str, float]:
    """Compute the friction quantities of a machine: loss by the mean loads of its flanks, heat and film
    by their largest.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Pinion speed, rpm.
    loads : FlankLoads
        Mean and largest force of each flank (2 meshes,), N, drive flanks first.
    pairs : FlankPairs
        Lubricated tooth pairs of all flanks.
    limits : Limits
        Limits of temperature and film.

    Returns
    -------
    dict[str, float]
        Columns `quantities.FRICTION`: loss (W, and % of the power in), hottest bulk, flash and contact
        temperature (C, flash in K), scuffing safety and margin (K), thinnest film (um), its ratio to
        roughness, micropitting film ratio, and the part of the loss outside the torques of the contact
        analysis.

    Raises
    ------
    TooHot
        If a body passes the oil's flash point.
    NotConverged
        If bulk temperatures do not settle.
    """
    meshes, layout = mesh_loads(machine, loads), machine.layout
    flanks, count = np.flatnonzero(loads.largest > 0.0), len(layout.meshes)
    pair = pair_of_meshes(pairs, layout, flanks % count, np.asarray(flanks >= count))
    losses = machine_loss(pair, meshes, speed_rpm * pi / 30)
    power_in = compute_ratings(machine, speed_rpm).power_in
    hottest, film_ratio = float(losses.contact_temperature.max()), float(losses.film_ratio.min())
    allowed_temperature = limits.allowed_contact(pair.lubrication.oil, pair.lubrication.oil_temperature)
    return {
        quantities.LOSS: losses.total,
        quantities.LOSS_PERCENT: 100 * losses.total / power_in if power_in > 0.0 else np.nan,
        quantities.BULK: float(losses.bulk.max()),
        quantities.FLASH: float(losses.flash.max()),
        quantities.CONTACT_TEMPERATURE: hottest,
        quantities.SCUFFING: float(
            temperature_safety(allowed_temperature, pair.lubrication.oil_temperature, hottest)
        ),
        quantities.SCUFFING_MARGIN: allowed_temperature - hottest,
        quantities.FILM: 1e6 * film_ratio * pair.lubrication.composite_rq,
        quantities.FILM_RATIO: film_ratio,
        quantities.MICROPITTING: float(losses.micropitting.min()),
        quantities.UNSOLVED: _unsolved(losses),
    }


def pair_of_meshes(pairs: FlankPairs, layout: Layout, meshes: Integers, on_back: Mask) -> Pair:
    """Return the pair that stands for loaded flanks of a machine.

    Parameters
    ----------
    pairs : FlankPairs
        Pairs of all flanks.
    layout : Layout
        Meshes of the machine.
    meshes : (n,) array of int
        Number of the mesh of each loaded flank.
    on_back : (n,) array of bool
        Whether it is the back flank.

    Returns
    -------
    Pair
        Pair of the n flanks.
    """
    gears = np.array([GEARS.index(layout.contact_gears[g]) for _, g in layout.meshes])
    return pairs.of_meshes(gears[meshes], on_back.astype(int))


def mesh_loads(machine: Machine, loads: FlankLoads) -> MeshLoads:
    """Return the flanks that carry a load at some time, with the torque on the pinion: force times
    the arm of the flank.

    Parameters
    ----------
    machine : Machine
        The machine.
    loads : FlankLoads
        Mean and largest force of each flank (2 meshes,), N, drive flanks first.

    Returns
    -------
    MeshLoads
        Bodies, mean and largest torque (N m) of each loaded flank.
    """
    layout = machine.layout
    on = np.flatnonzero(loads.largest > 0.0)
    bodies = np.array(layout.meshes)[on % len(layout.meshes)]
    arm = layout.pinion_arm * np.where(on < len(layout.meshes), 1.0, layout.back_arm)
    return MeshLoads(
        pinion=bodies[:, 0],
        gear=bodies[:, 1],
        torque=arm * loads.mean[on],
        peak=arm * loads.largest[on],
        pinions=len(layout.pinions),
        bodies=len(layout.bodies),
    )


def _unsolved(losses: MachineLoss) -> float:
    """Return the part of the loss (0 to 1) by torques outside those of the contact analysis; 0 without
    loss.
    """
    return float(losses.loss[~losses.within].sum() / losses.total) if losses.total > 0.0 else 0.0
