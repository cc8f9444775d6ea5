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
    """Solve the loaded tooth contact at every position and torque.

    All parts but `by_flank` and `loads` belong to the drive flank of the upper gear. The other flanks are
    solved where assembly errors make them differ from it, on the same compliances.

    Parameters
    ----------
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config.

    Returns
    -------
    Outcome
        Tables `ltca`, `by_torque` and `by_flank`, arrays `pressure` and `loads`.

    Raises
    ------
    NotConverged
        Naming position and torque.
    """
    teeth, plan = pair(tooth_pair), contact_plan(contact)
    flanks = from_arrays(pinion), from_arrays(face_gear)
    analysis = contact_analysis(teeth.design, teeth.materials, flanks, plan)
    return Outcome(contents(analysis), _mean_stiffness(analysis.ltca[0]))


def contents(analysis: ContactAnalysis) -> dict[str, Any]:
    """Return the parts of stage contact.

    Parameters
    ----------
    analysis : ContactAnalysis
        Solved contact of all flanks that differ.

    Returns
    -------
    dict[str, Any]
        Tables `ltca`, `by_torque` and `by_flank`, arrays `pressure` and `loads`.
    """
    return {
        "ltca": analysis.ltca[0],
        "by_torque": analysis.by_torque[0],
        "by_flank": analysis.by_flank,
        "pressure": analysis.pressure[0],
        "loads": analysis.loads,
    }


def _mean_stiffness(table: pd.DataFrame) -> str:
    """Mean stiffness, or why there is none, and the share of the fillets from FILLET_CONTACT on."""
    mean, row = table["k_average_n_per_m"].mean(skipna=False), table.loc[table["fillet_share"].idxmax()]
    text = f"mean stiffness {format_number(1e-6 * mean)} N/um"
    if np.isnan(mean):
        depth = table["interference_um"].max()
        text = f"no mean stiffness as the teeth interfere, by {depth:.3g} um along the line of action"
    if row["fillet_share"] < FILLET_CONTACT:
        return text
    fillet_text = f"{100 * row['fillet_share']:.2g} % of the torque at {row['torque_n_m']:g} N m"
    return f"{text}, fillets carry up to {fillet_text}, kept out of pressure and root stress"
