"""The modal stage's csv tables."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.transmission.loaded_contacts import Contact
from facegear.transmission.loaded_modes import VibratingMachine
from facegear.transmission.machine import Machine
from facegear.transmission.mode_classes import ModeName
from facegear.transmission.modes import Modes

CONTACT_COLUMNS = ("contact", "state", "force_n", "stiffness_n_per_m", "definition")
"""Columns of contact_table()."""


def frequency_table(vibrating_machine: VibratingMachine, names: tuple[ModeName, ...]) -> pd.DataFrame:
    """Return the natural frequencies and the names of the modes.

    Parameters
    ----------
    vibrating_machine : VibratingMachine
        The modes.
    names : tuple of ModeName
        Name of each mode.

    Returns
    -------
    pd.DataFrame
        One row a mode: order, frequency_hz, multiplicity, symbols, class, pinion_energy_fraction, and
        decided: whether the frequency is the same with undecided contacts open and closed.
    """
    modes = vibrating_machine.modes
    multiplicity = [stop - start for start, stop in modes.groups for _ in range(stop - start)]
    return pd.DataFrame(
        {
            "order": range(1, len(names) + 1),
            "frequency_hz": modes.frequencies,
            "multiplicity": multiplicity,
            "symbols": [name.symbols for name in names],
            "class": [name.mode_class.value for name in names],
            "pinion_energy_fraction": [name.pinion_energy_fraction for name in names],
            "decided": vibrating_machine.is_decided,
        }
    )


def contact_table(machine: Machine, vibrating_machine: VibratingMachine, stiffness_name: str) -> pd.DataFrame:
    """Return the contacts that the modes keep closed.

    Parameters
    ----------
    machine : Machine
        The machine.
    vibrating_machine : VibratingMachine
        Its modes and contacts.
    stiffness_name : str
        Definition of the mean stiffness, listed in the column definition.

    Returns
    -------
    pd.DataFrame
        Columns contact, state, force_n, stiffness_n_per_m, definition. One row a mesh, whose state is drive,
        back, wedged, open or undecided, with the mean stiffness of a closed flank; then one a bearing with
        clearance: closed, open or undecided, with its stiffness along the load. Forces under the mean torques
        are negative on the back flank, and empty for printed meshes, all of which are closed.
    """
    layout, contacts = machine.layout, vibrating_machine.contacts
    stiffness = machine.mean_stiffness
    if contacts is None:
        rows = [
            (name, "closed", np.nan, k, stiffness_name)
            for name, k in zip(layout.mesh_names, stiffness, strict=True)
        ]
        return pd.DataFrame(rows, columns=list(CONTACT_COLUMNS))
    count = len(layout.mesh_names)
    states, drive, back = contacts.flank_states(), *np.split(contacts.flanks, 2)
    on_drive, on_back = np.split(contacts.stiffness, 2)
    past = contacts.past_law.reshape(2, count).any(axis=0)
    ways = np.where(past, f"{stiffness_name}, past the law's last level", stiffness_name)
    stiffness = np.where(back > drive, on_back, on_drive)
    rows = [
        (name, _mesh_state(states[m], states[count + m]), drive[m] - back[m], stiffness[m], ways[m])
        for m, name in enumerate(layout.mesh_names)
    ]
    rows += [
        (f"{pinion.name} bearing", state.value, contacts.rings[i], pinion.body.bearing[0], "bearing")
        for i, (pinion, state) in enumerate(zip(layout.pinions, contacts.ring_states(), strict=True))
        if state is not None
    ]
    return pd.DataFrame(rows, columns=list(CONTACT_COLUMNS))


def _mesh_state(drive: Contact, back: Contact) -> str:
    if Contact.UNCERTAIN in (drive, back):
        return Contact.UNCERTAIN.value
    if drive is Contact.IN_CONTACT:
        return "wedged" if back is Contact.IN_CONTACT else "drive"
    return "back" if back is Contact.IN_CONTACT else "open"


def shape_table(labels: Sequence[str], modes: Modes) -> pd.DataFrame:
    """Return the mode shapes.

    Parameters
    ----------
    labels : Sequence of str
        `body:letter` of each coordinate.
    modes : Modes
        The modes.

    Returns
    -------
    pd.DataFrame
        One row a mode and coordinate: order, body, dof, amplitude_m_or_rad (unit modal mass), relative (to
        the mode's largest).
    """
    rows = []
    names = [name.rsplit(":", 1) for name in labels]
    for order, shape in enumerate(modes.shapes.T, start=1):
        largest = shape[abs(shape).argmax()]
        for (body, letter), amplitude in zip(names, shape, strict=True):
            rows.append((order, body, letter, amplitude, amplitude / largest))
    return pd.DataFrame(rows, columns=["order", "body", "dof", "amplitude_m_or_rad", "relative"])
