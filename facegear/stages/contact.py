"""Loaded tooth contact at every position and torque."""

from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.config.contact import Contact, contact_plan
from facegear.config.tooth_pair import ToothPair, pair
from facegear.contact.analysis import ContactAnalysis, contact_analysis
from facegear.contact.columns import FILLET_CONTACT
from facegear.contact.gear_flank import from_arrays
from facegear.number_format import format_number
from facegear.stages.outcome import Outcome


def contact(
    pinion: Arrays,
    face_gear: Arrays,
    tooth_pair: ToothPair,
    contact: Contact,
) -> Outcome:
    """`ltca`, `by_torque`, `by_flank` (tables), `pressure`, `loads` (arrays), of stage compliance's flanks.

    All but `by_flank` and `loads` are those of the upper gear's drive flank. The others are solved where
    assembly errors part them from it, on the same compliances. Raises NotConverged naming position and
    torque.
    """
    teeth, plan = pair(tooth_pair), contact_plan(contact)
    flanks = from_arrays(pinion), from_arrays(face_gear)
    analysis = contact_analysis(teeth.design, teeth.materials, flanks, plan)
    return Outcome(contents(analysis), _mean_stiffness(analysis.ltca[0]))


def contents(analysis: ContactAnalysis) -> dict[str, Any]:
    """The parts of stage contact."""
    return {
        "ltca": analysis.ltca[0],
        "by_torque": analysis.by_torque[0],
        "by_flank": analysis.by_flank,
        "pressure": analysis.pressure[0],
        "loads": analysis.loads,
    }


def _mean_stiffness(table: pd.DataFrame) -> str:
    """The mean, or why there is none, and what fillets carry from FILLET_CONTACT on."""
    mean, row = table["k_average_n_per_m"].mean(skipna=False), table.loc[table["fillet_share"].idxmax()]
    text = f"mean stiffness {format_number(1e-6 * mean)} N/um"
    if np.isnan(mean):
        depth = table["interference_um"].max()
        text = f"no mean stiffness as the teeth interfere, by {depth:.3g} um along the line of action"
    if row["fillet_share"] < FILLET_CONTACT:
        return text
    carried = f"{100 * row['fillet_share']:.2g} % of the torque at {row['torque_n_m']:g} N m"
    return f"{text}, fillets carry up to {carried}, kept out of pressure and root stress"
