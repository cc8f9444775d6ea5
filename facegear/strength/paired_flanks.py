"""Root stress and pressure of the flanks that a rated flank works with: the worst where there are several.

A pinion's flank meets both face gears. Teeth that are loaded equally both ways meet with both flanks. Each of
these contacts has errors of its own.
"""

from collections.abc import Sequence

import numpy as np

from facegear.arrays import Array
from facegear.geometry.flank_errors import FLANKS
from facegear.strength.contact_pressure import ContactPressure
from facegear.strength.duty import FlankDuty
from facegear.strength.flank_contacts import FlankContact
from facegear.strength.root_stress import RootStress


def met_by(duty: FlankDuty, gears: Sequence[str]) -> list[tuple[str, str]]:
    """Return the gears and flanks of the contacts of a rated flank.

    Parameters
    ----------
    duty : FlankDuty
        Loads of the rated flank.
    gears : Sequence[str]
        Gears of the machine (upper, lower).

    Returns
    -------
    list[tuple[str, str]]
        Gear and flank of each contact.
    """
    own_gear = [gear for gear in gears if duty.gear == "face_gear" and duty.body == f"{gear} face gear"]
    flanks = FLANKS if duty.flank == "each" else (duty.flank,)
    return [(gear, flank) for gear in own_gear or gears for flank in flanks]


def worst_root(duty: FlankDuty, contacts: Sequence[FlankContact]) -> RootStress:
    """Return the root stress of the contact with the largest stress under the flank's largest load.

    Parameters
    ----------
    duty : FlankDuty
        Loads of the rated flank.
    contacts : Sequence[FlankContact]
        Contacts of that flank.

    Returns
    -------
    RootStress
        Root stress of the rated gear in that contact.
    """
    roots = [contact.roots[duty.gear] for contact in contacts]
    return max(roots, key=lambda root: root.at_torque(duty.largest).max())


def worst_pressure(contacts: Sequence[FlankContact]) -> ContactPressure:
    """Combine the contacts by their largest values at every torque that one of them has solved.

    Parameters
    ----------
    contacts : Sequence[FlankContact]
        Contacts of a rated flank.

    Returns
    -------
    ContactPressure
        Largest pressure with its error, edge load, edge length and fillet share.
    """
    torques = np.unique([torque for contact in contacts for torque in contact.pressure.torques])
    by_contact = [_at_torques(entry.pressure, torques) for entry in contacts]
    pressures, errors = (
        np.array([getattr(entry, name) for entry in by_contact]) for name in ("pressure", "error")
    )
    worst = np.argmax(np.nan_to_num(pressures), axis=0)
    columns = np.arange(worst.size)
    largest = {
        name: np.max([getattr(entry, name) for entry in by_contact], axis=0)
        for name in ("edge_load", "edge_length", "fillet_share")
    }
    return ContactPressure(torques, pressures[worst, columns], errors[worst, columns], **largest)


def _at_torques(pressure: ContactPressure, torques: Array) -> ContactPressure:
    """Interpolate the pressure at more torques (n,) N m than were solved."""
    if np.array_equal(pressure.torques, torques):
        return pressure
    edges = np.array([pressure.edge_at(torque) for torque in torques])
    return ContactPressure(
        torques=torques,
        pressure=np.array([pressure.at(torque) for torque in torques]),
        error=np.array([pressure.error_at(torque) for torque in torques]),
        edge_load=edges[:, 0],
        edge_length=edges[:, 1],
        fillet_share=pressure.fillet_at(torques),
    )
