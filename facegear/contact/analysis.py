"""The contact analysis of a pair: every flank with its own errors, at all positions and torques."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Integers
from facegear.contact.gear_flank import GearFlank
from facegear.contact.known_contact import KnownContact
from facegear.contact.ltca import ContactModel, even_positions, loaded_contact
from facegear.contact.nodal_loads import load_arrays
from facegear.contact.options import ContactPlan
from facegear.contact.pair import contact_model
from facegear.contact.position import LoadedPosition
from facegear.contact.pressure import FlankPressure, flank_pressure
from facegear.contact.summary import by_flank, by_torque
from facegear.contact.tables import ltca_table, pressure_arrays
from facegear.geometry.design import Material, PairDesign
from facegear.geometry.flank_errors import distinct_pairs


@dataclass(frozen=True, eq=False)
class ContactAnalysis:
    """Solved contact of the different pairs that flanks are part of; tables and arrays are made when first
    read.

    Attributes
    ----------
    models
        The pairs, that of the upper gear's drive flank first.
    results
        Positions of each pair at each torque, and the pressure on its flanks.
    numbers : (gears, flanks) array of int
        Which of the pairs each flank is part of.
    """

    models: list[ContactModel]
    results: list[tuple[list[LoadedPosition], FlankPressure]]
    numbers: Integers

    @cached_property
    def ltca(self) -> list[pd.DataFrame]:
        """The contact table of each pair."""
        return [ltca_table(*result) for result in self.results]

    @cached_property
    def pressure(self) -> list[dict[str, AnyArray]]:
        """Loads and pressures of each pair, as PRESSURE_ARRAYS."""
        return [
            pressure_arrays(results, model.flanks.pinion, pressure)
            for model, (results, pressure) in zip(self.models, self.results, strict=True)
        ]

    @cached_property
    def by_torque(self) -> list[pd.DataFrame]:
        """Summary of each pair's tables, one row a torque."""
        return [by_torque(*tables) for tables in zip(self.ltca, self.pressure, strict=True)]

    @cached_property
    def by_flank(self) -> pd.DataFrame:
        """`by_torque` of both flanks of both gears."""
        return by_flank(self.by_torque, [model.design for model in self.models], self.numbers)

    @cached_property
    def loads(self) -> dict[str, AnyArray]:
        """Forces of all pairs on the nodes of both bodies, see `facegear.contact.columns`."""
        return load_arrays([results for results, _ in self.results], self.numbers)


def contact_analysis(
    design: PairDesign,
    materials: tuple[Material, Material],
    flanks: tuple[GearFlank, GearFlank],
    plan: ContactPlan,
    every_flank: bool = True,
    known_contact: KnownContact | None = None,
) -> ContactAnalysis:
    """Solve the contact of the flanks of pinion and face gear, or of the upper gear's drive flank alone.

    All pairs that differ in assembly errors and deviations are solved on the same compliances.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    materials : tuple[Material, Material]
        Pinion and face gear.
    flanks : tuple[GearFlank, GearFlank]
        Surfaces and compliances of pinion and face gear.
    plan : ContactPlan
        Torques, positions and options.
    every_flank : bool
        Whether all flanks are solved, not only the upper gear's drive flank.
    known_contact : KnownContact, optional
        Contact of a pair that differs little, with the same nodes and plan.

    Returns
    -------
    ContactAnalysis
        Solved contact of all different pairs.

    Raises
    ------
    NotConverged
        Names position and torque.
    """
    model = contact_model(design, *flanks)
    different, numbers = distinct_pairs(design)
    if not every_flank:
        different, numbers = different[:1], np.zeros_like(numbers)
    models = [model.of(pair_design) for pair_design in different]
    return ContactAnalysis(
        models, [_solve_model(pair_model, materials, plan, known_contact) for pair_model in models], numbers
    )


def _solve_model(
    model: ContactModel,
    materials: tuple[Material, Material],
    plan: ContactPlan,
    known_contact: KnownContact | None,
) -> tuple[list[LoadedPosition], FlankPressure]:
    results = loaded_contact(model, even_positions(plan.positions), plan.torques, plan.options, known_contact)
    return results, flank_pressure(results, model.flanks, materials)
