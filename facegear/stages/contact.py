"""Loaded tooth contact at every position and torque."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.config.base import parse
from facegear.config.contact import Contact, contact_plan
from facegear.config.tooth_pair import pair
from facegear.contact.gear_flank import GearFlank, from_arrays
from facegear.contact.ltca import even_positions, loaded_contact
from facegear.contact.nodal_loads import load_arrays
from facegear.contact.pair import contact_model
from facegear.contact.pressure import flank_pressure
from facegear.contact.summary import by_torque
from facegear.contact.tables import ltca_table, pressure_arrays
from facegear.stages.outcome import Outcome

WORTH_A_WORD = 0.005
"""Share of the torque in fillets that the stage's line names."""


def contact(
    pinion: Mapping[str, NDArray],
    face_gear: Mapping[str, NDArray],
    tooth_pair: Mapping[str, Any],
    contact: Mapping[str, Any],
) -> Outcome:
    """`ltca`, `by_torque` (tables), `pressure`, `loads` (arrays) from the flanks of stage compliance.

    Raises NotConverged naming position and torque.
    """
    return contact_of(from_arrays(pinion), from_arrays(face_gear), tooth_pair, contact)


def contact_of(
    pinion: GearFlank, face_gear: GearFlank, tooth_pair: Mapping[str, Any], contact: Mapping[str, Any]
) -> Outcome:
    """`contact` of flanks in memory."""
    plan = contact_plan(parse(Contact, contact))
    teeth = pair(tooth_pair)
    model = contact_model(teeth.design, pinion, face_gear)
    found = loaded_contact(model, even_positions(plan.positions), plan.torques, plan.options)
    pressed = flank_pressure(found, model.flanks, teeth.materials)
    table = ltca_table(found, pressed)
    worst = table["kkt_residual"].max()
    pressure = pressure_arrays(found, model.flanks.pinion, pressed)
    return Outcome(
        {
            "ltca": table,
            "by_torque": by_torque(table, pressure),
            "pressure": pressure,
            "loads": load_arrays(found),
        },
        f"{len(table)} contacts, {_mean_stiffness(table)}, worst KKT residual {worst:.0e}",
    )


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
