"""Loaded tooth contact at every position and torque."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.config.base import parse
from facegear.config.contact import Contact, contact_plan
from facegear.config.tooth_pair import pair
from facegear.contact.gear_flank import GearFlank, from_arrays
from facegear.contact.ltca import ContactModel, even_positions, loaded_contact
from facegear.contact.nodal_loads import load_arrays
from facegear.contact.options import ContactPlan
from facegear.contact.pair import contact_model
from facegear.contact.position import LoadedPosition
from facegear.contact.pressure import FlankPressure, flank_pressure
from facegear.contact.summary import by_flank, by_torque
from facegear.contact.tables import ltca_table, pressure_arrays
from facegear.geometry.design import Material
from facegear.geometry.flank_errors import distinct_errors
from facegear.stages.outcome import Outcome

WORTH_A_WORD = 0.005
"""Share of the torque in fillets that the stage's line names."""


def contact(
    pinion: Arrays,
    face_gear: Arrays,
    tooth_pair: Mapping[str, Any],
    contact: Mapping[str, Any],
) -> Outcome:
    """`ltca`, `by_torque`, `by_flank` (tables), `pressure`, `loads` (arrays), of stage compliance's flanks.

    All but `by_flank` and `loads` are those of the upper gear's drive flank. The others are solved where
    assembly errors part them from it, on the same compliances. Raises NotConverged naming position and
    torque.
    """
    return contact_of(from_arrays(pinion), from_arrays(face_gear), tooth_pair, contact)


def contact_of(
    pinion: GearFlank,
    face_gear: GearFlank,
    tooth_pair: Mapping[str, Any],
    contact: Mapping[str, Any],
    every_flank: bool = True,
) -> Outcome:
    """`contact` of flanks in memory; of the upper gear's drive flank alone unless `every_flank`."""
    plan = contact_plan(parse(Contact, contact))
    teeth = pair(tooth_pair)
    model = contact_model(teeth.design, pinion, face_gear)
    errors = teeth.design.assembly
    different, numbers = distinct_errors(errors)
    if not every_flank:
        different, numbers = different[:1], np.zeros_like(numbers)
    models = [model.assembled(one) for one in different]
    solved = [_solved(one, teeth.materials, plan) for one in models]
    tables = [ltca_table(*one) for one in solved]
    pressures = [
        pressure_arrays(one, each.flanks.pinion, pressure)
        for each, (one, pressure) in zip(models, solved, strict=True)
    ]
    summaries = [by_torque(*one) for one in zip(tables, pressures, strict=True)]
    worst = max(table["kkt_residual"].max() for table in tables)
    return Outcome(
        {
            "ltca": tables[0],
            "by_torque": summaries[0],
            "by_flank": by_flank(summaries, different, numbers),
            "pressure": pressures[0],
            "loads": load_arrays([one for one, _ in solved], numbers),
        },
        f"{sum(map(len, tables))} contacts, {_mean_stiffness(tables[0])}, worst KKT residual {worst:.0e}",
    )


def _solved(
    model: ContactModel, materials: tuple[Material, Material], plan: ContactPlan
) -> tuple[list[LoadedPosition], FlankPressure]:
    found = loaded_contact(model, even_positions(plan.positions), plan.torques, plan.options)
    return found, flank_pressure(found, model.flanks, materials)


def _mean_stiffness(table: pd.DataFrame) -> str:
    """The mean, or why there is none, and what fillets carry where that is worth a word."""
    mean, row = table["k_average_n_per_m"].mean(skipna=False), table.loc[table["fillet_share"].idxmax()]
    told = f"mean stiffness {mean:.4g} N/m"
    if np.isnan(mean):
        depth = table["interference_um"].max()
        told = f"no mean stiffness as the teeth interfere, by {depth:.3g} um along the line of action"
    if row["fillet_share"] < WORTH_A_WORD:
        return told
    carried = f"{100 * row['fillet_share']:.0f} % of the torque at {row['torque_n_m']:g} N m"
    return f"{told}, fillets carry up to {carried}, kept out of pressure and root stress"
