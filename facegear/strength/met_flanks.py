"""Root stress and pressure of the flanks that a rated flank works with: the worst where there are several.

A pinion's flank meets both face gears, teeth that are loaded both ways alike meet with both flanks; each of
these contacts has errors of its own.
"""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from facegear.geometry.flank_errors import FLANKS
from facegear.strength.contact_pressure import ContactPressure, contact_pressure
from facegear.strength.duty import FlankDuty
from facegear.strength.root_stress import RootStress
from facegear.strength.root_tables import root_from_arrays

if TYPE_CHECKING:
    import pandas as pd


def met_by(duty: FlankDuty, gears: Sequence[str]) -> list[tuple[str, str]]:
    """Gear and flank of the contacts of a rated flank in a machine with these `gears` (upper, lower)."""
    own = [gear for gear in gears if duty.gear == "face_gear" and duty.body == f"{gear} face gear"]
    flanks = FLANKS if duty.flank == "each" else (duty.flank,)
    return [(gear, flank) for gear in own or gears for flank in flanks]


def worst_root(
    stress: Mapping[str, NDArray], duty: FlankDuty, contacts: Sequence[tuple[str, str]]
) -> RootStress:
    """That of the contact with the largest stress under the flank's largest load, from ROOT_STRESS_ARRAYS."""
    roots = [root_from_arrays(stress, duty.gear, *one) for one in contacts]
    return max(roots, key=lambda root: root.at_torque(duty.largest).max())


def worst_pressure(by_flank: "pd.DataFrame", contacts: Sequence[tuple[str, str]]) -> ContactPressure:
    """The largest of all contacts at every torque, from the contact's table by flank."""
    table = by_flank.set_index(["gear", "flank"]).sort_index()
    found = [contact_pressure(table.loc[[one]].sort_values("torque_n_m")) for one in contacts]
    pressures, errors = (np.array([getattr(one, name) for one in found]) for name in ("pressure", "error"))
    worst = np.argmax(np.nan_to_num(pressures), axis=0)
    columns = np.arange(worst.size)
    return ContactPressure(
        torques=found[0].torques,
        pressure=pressures[worst, columns],
        error=errors[worst, columns],
        edge_load=np.max([one.edge_load for one in found], axis=0),
        edge_length=np.max([one.edge_length for one in found], axis=0),
    )
