"""The contact analysis of a pair: every flank that meets errors of its own, at all positions and torques."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray
from facegear.contact.gear_flank import GearFlank
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
    """Tables and arrays of the contact; those in lists stand once for each pair that flanks are part of.

    - ltca, pressure, by_torque: the first are those of the upper gear's drive flank
    - by_flank: `by_torque` of both flanks of both gears
    - loads: arrays of all sets, see `facegear.contact.columns`
    """

    ltca: list[pd.DataFrame]
    pressure: list[dict[str, AnyArray]]
    by_torque: list[pd.DataFrame]
    by_flank: pd.DataFrame
    loads: dict[str, AnyArray]


def contact_analysis(
    design: PairDesign,
    materials: tuple[Material, Material],
    flanks: tuple[GearFlank, GearFlank],
    plan: ContactPlan,
    every_flank: bool = True,
) -> ContactAnalysis:
    """Contact of the flanks of pinion and face gear, or of the upper gear's drive flank alone.

    All pairs that differ in assembly errors and deviations are solved on the same compliances. Raises
    NotConverged naming position and torque.
    """
    model = contact_model(design, *flanks)
    different, numbers = distinct_pairs(design)
    if not every_flank:
        different, numbers = different[:1], np.zeros_like(numbers)
    models = [model.of(other) for other in different]
    solved = [_solved(result, materials, plan) for result in models]
    tables = [ltca_table(*result) for result in solved]
    pressures = [
        pressure_arrays(result, each.flanks.pinion, pressure)
        for each, (result, pressure) in zip(models, solved, strict=True)
    ]
    summaries = [by_torque(*result) for result in zip(tables, pressures, strict=True)]
    return ContactAnalysis(
        ltca=tables,
        pressure=pressures,
        by_torque=summaries,
        by_flank=by_flank(summaries, different, numbers),
        loads=load_arrays([result for result, _ in solved], numbers),
    )


def _solved(
    model: ContactModel, materials: tuple[Material, Material], plan: ContactPlan
) -> tuple[list[LoadedPosition], FlankPressure]:
    results = loaded_contact(model, even_positions(plan.positions), plan.torques, plan.options)
    return results, flank_pressure(results, model.flanks, materials)
