"""Modes of a machine about the place where its torques hold it: which flank works follows from statics."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Mask
from facegear.transmission.layout import Layout
from facegear.transmission.loaded_contacts import Contact, LoadedContacts, loaded_contacts
from facegear.transmission.machine import Machine
from facegear.transmission.matrices import flank_directions
from facegear.transmission.modes import Modes, modes_of, natural_modes

SAME = 1e-6
"""Relative difference of a frequency, undecided contacts open or closed, that counts as none."""


@dataclass(frozen=True, eq=False)
class VibratingMachine:
    """Modes, the contacts that they keep, and which frequencies (n,) no undecided contact changes.

    contacts: None for printed meshes, which are all closed on their one line of action.
    """

    modes: Modes
    contacts: LoadedContacts | None
    decided: Mask


def loaded_modes(machine: Machine) -> Modes:
    """Modes with mean mesh stiffness on the flanks that carry load, bearings with play as they are pressed.

    An open mesh stays open, a wedged one has both flanks; undecided contacts count as open. Raises
    NotConverged.
    """
    return vibrating_machine(machine).modes


def vibrating_machine(machine: Machine) -> VibratingMachine:
    """loaded_modes() with what is known of the contacts. Raises NotConverged."""
    if not machine.layout.is_geometric:
        modes = natural_modes(machine.layout, machine.stiffness.mean)
        return VibratingMachine(modes, None, np.ones(modes.frequencies.size, bool))
    contacts = loaded_contacts(machine)
    modes = _modes(machine, contacts, (Contact.CLOSED,))
    if not contacts.any_undecided():
        return VibratingMachine(modes, contacts, np.ones(modes.frequencies.size, bool))
    other = _modes(machine, contacts, (Contact.CLOSED, Contact.UNDECIDED)).frequencies
    return VibratingMachine(modes, contacts, np.abs(other - modes.frequencies) <= SAME * other)


def _modes(machine: Machine, contacts: LoadedContacts, holding: tuple[Contact, ...]) -> Modes:
    """Modes with the contacts whose state is among `holding`."""
    stiffness = machine.stiffness.mean * np.tile(machine.imperfections.stiffness, 2)
    pressed = np.where([state in holding for state in contacts.flank_states()], stiffness, 0.0)
    directions = flank_directions(machine.layout)
    layout = _pressed_bearings(machine, contacts, holding)
    return modes_of(layout, (pressed * directions.T) @ directions)


def _pressed_bearings(machine: Machine, contacts: LoadedContacts, holding: tuple[Contact, ...]) -> Layout:
    """The layout with every ring of play replaced by its tangent.

    A bearing pressed against its ring is stiff along its load, k, and less across it, k (1 - play / way); one
    that floats inside carries nothing.
    """
    pinions = list(machine.layout.pinions)
    for i, state in enumerate(contacts.ring_states()):
        if state is None:
            continue
        body, tangent = pinions[i].body, np.zeros((2, 2))
        if state in holding:
            distance = float(np.hypot(*contacts.places[i]))
            stiffness = body.bearing[0]
            across = stiffness * (1.0 - machine.imperfections.clearance[i] / distance)
            direction = contacts.places[i] / distance
            tangent = across * np.eye(2) + (stiffness - across) * np.outer(direction, direction)
        bearing = (float(tangent[0, 0]), float(tangent[1, 1]), body.bearing[2])
        pinions[i] = replace(pinions[i], body=replace(body, bearing=bearing, bearing_xy=float(tangent[0, 1])))
    return replace(machine.layout, pinions=tuple(pinions))
