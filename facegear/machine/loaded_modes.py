"""Modes of a machine about the place where its torques hold it: which flank works follows from statics."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import pandas as pd

from facegear.arrays import Array, Mask
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.linear_model import LinearModel
from facegear.machine.loaded_contacts import (
    Contact,
    LoadedContacts,
    coupled_meshes,
    flank_springs,
    loaded_contacts,
)
from facegear.machine.machine import Machine
from facegear.machine.modes import ModeName, Modes, drive_flanks, modes_of

MOTION_LIMIT = 0.85
"""Highest frequency of the modes of a casing in motion over that of the machine without it.

Steps in time then need not be shorter than without the casing. On the casing of config/casing.yaml at 19
speeds from 700 to 6000 rpm, the amplitudes of loaded flanks differ from those with all motions by 0.4 % of
the largest in the median and by 1.2 % at a resonance; with 1.5 by 0.1 and 0.5 % at twice the time."""
FREQUENCY_TOLERANCE = 1e-6
"""Relative difference of a frequency, undecided contacts open or closed, that counts as none."""


@dataclass(frozen=True, eq=False)
class VibratingMachine:
    """Modes, the contacts that they keep, and which frequencies are certain.

    Attributes
    ----------
    modes : Modes
        Frequencies in Hz, and shapes.
    contacts : LoadedContacts or None
        None for printed meshes, which are all closed on their one line of action.
    is_decided : (n,) array of bool
        Whether no undecided contact changes the frequency.
    """

    modes: Modes
    contacts: LoadedContacts | None
    is_decided: Mask


def loaded_modes(machine: Machine, speed_rpm: float = 0.0) -> Modes:
    """Compute the modes at a pinion speed with the stiffness of the flanks that carry load.

    The stiffness is the mean of each flank, or its slope under the load where it depends on the load.
    Bearings with clearance have their tangent stiffness under load. An open mesh stays open, a wedged one
    (both flanks press) has both; undecided contacts count as open. Damping is left out.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Speed of the pinions, rpm.

    Returns
    -------
    Modes
        Frequencies in Hz.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    return vibrating_machine(machine, speed_rpm).modes


def vibrating_machine(machine: Machine, speed_rpm: float = 0.0) -> VibratingMachine:
    """Compute loaded_modes() together with the contacts and which frequencies are certain.

    If contacts are undecided, modes are computed a second time with these closed; a frequency is certain
    if it is the same to FREQUENCY_TOLERANCE.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Speed of the pinions, rpm.

    Returns
    -------
    VibratingMachine
        Frequencies in Hz, forces in N; `modes` are those with undecided contacts open.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    speed = speed_rpm * np.pi / 30.0
    if not machine.layout.kinematics.flanks_apart:
        meshes = drive_flanks(machine.layout, machine.linear, machine.stiffness.mean)
        modes = modes_of(machine.linear, meshes, speed)
        return VibratingMachine(modes, None, np.ones(modes.frequencies.size, bool))
    contacts = loaded_contacts(machine)
    modes = _modes(machine, contacts, (Contact.IN_CONTACT,), speed)
    if not contacts.any_undecided():
        return VibratingMachine(modes, contacts, np.ones(modes.frequencies.size, bool))
    closed_states = (Contact.IN_CONTACT, Contact.UNCERTAIN)
    other_frequencies = _modes(machine, contacts, closed_states, speed).frequencies
    return VibratingMachine(
        modes,
        contacts,
        np.abs(other_frequencies - modes.frequencies) <= FREQUENCY_TOLERANCE * other_frequencies,
    )


def machine_in_motion(machine: Machine) -> Machine:
    """Return the machine as it moves: with a coordinate attached to each mesh whose two flanks both press.

    The coordinate couples the flanks by the compliance of the gear that its modes leave out. Of a casing the
    motions up to MOTION_LIMIT of the machine's highest frequency without it are coordinates.

    Parameters
    ----------
    machine
        Any machine. What its modes leave out between two flanks stands in `Machine.softening`.

    Returns
    -------
    Machine
        The machine with a coordinate attached to each mesh whose two flanks press under the mean torques; the
        same machine where there is none.

    Raises
    ------
    NotConverged
        Where its equilibrium is not found.
    """
    if machine.casing is not None and machine.casing.frequency_limit is None:
        limit = MOTION_LIMIT * _highest_without_casing(machine)
        machine = replace(machine, casing=replace(machine.casing, frequency_limit=limit))
    bodies = machine.bodies
    if not isinstance(bodies, ElasticGears) or not machine.layout.kinematics.flanks_apart or bodies.attached:
        return machine
    meshes = _wedged_meshes(machine)
    if not meshes:
        return machine
    attached = _attached(bodies, tuple(meshes))
    return replace(machine, bodies=attached, softening=attached.softening())


def _highest_without_casing(machine: Machine) -> float:
    """Return the highest frequency of the machine on seats that stand still, drive flanks closed, Hz."""
    without_casing = replace(machine, casing=None)
    linear = without_casing.linear
    meshes = drive_flanks(machine.layout, linear, float(without_casing.mean_flank_stiffness.max()))
    return float(modes_of(linear, meshes).frequencies[-1])


@lru_cache(maxsize=16)
def _attached(bodies: ElasticGears, meshes: tuple[int, ...]) -> ElasticGears:
    """Return the bodies with a coordinate attached to each of `meshes` (numbers); machines that share
    bodies share the result.
    """
    return replace(bodies, attached=meshes)


def _wedged_meshes(machine: Machine) -> list[int]:
    """Return the numbers of the meshes whose two flanks press under the mean torques and are coupled by
    `Machine.softening`.
    """
    if machine.softening is None or not machine.softening[:, 0, 1].any():
        return []
    contacts = loaded_contacts(machine)
    contact_mask = np.array([state is Contact.IN_CONTACT for state in contacts.flank_states()])
    return coupled_meshes(machine, contact_mask).tolist()


def _modes(
    machine: Machine, contacts: LoadedContacts, closed_states: tuple[Contact, ...], speed: float
) -> Modes:
    """Return the modes at a pinion speed (rad/s) with those contacts closed whose state is among
    `closed_states`.
    """
    linear, springs = _springs_in_states(machine, contacts, closed_states)
    return modes_of(linear, linear.rows.T @ springs @ linear.rows, speed)


def pressed_springs(machine: Machine) -> tuple[LinearModel, Array]:
    """Return the linear model with its bearings linearised under load, and the stiffness of the pressed
    flanks.

    Undecided contacts count as open.

    Parameters
    ----------
    machine : Machine
        With geometric meshes.

    Returns
    -------
    tuple of LinearModel and (2 meshes, 2 meshes) array
        The model holds no flanks: add rows^T stiffness rows. The stiffness in N/m is that of
        `flank_springs`: zero for flanks that carry no load.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    return _springs_in_states(machine, loaded_contacts(machine), (Contact.IN_CONTACT,))


def _springs_in_states(
    machine: Machine, contacts: LoadedContacts, closed_states: tuple[Contact, ...]
) -> tuple[LinearModel, Array]:
    """Return the linear model with linearised bearings and the flank stiffness (2 meshes, 2 meshes), N/m,
    with those contacts closed whose state is among `closed_states`.
    """
    contact_mask = np.array([state in closed_states for state in contacts.flank_states()])
    return _pressed_bearings(machine, contacts, closed_states), flank_springs(machine, contacts, contact_mask)


def _pressed_bearings(
    machine: Machine, contacts: LoadedContacts, closed_states: tuple[Contact, ...]
) -> LinearModel:
    """Return the linear model with every bearing that has clearance replaced by its tangent stiffness.

    A bearing pressed against its ring has stiffness k along its load, and k (1 - clearance / distance)
    across it. A bearing whose state is not among `closed_states` floats inside its ring and carries
    nothing.
    """
    linear, states = machine.linear, contacts.ring_states()
    if not linear.rings.body.size:
        return linear
    stiffness, rings = linear.stiffness_without_rings.copy(), linear.rings
    for at, i, spring, clearance in zip(
        linear.ring_coordinates, rings.body, rings.stiffness, rings.clearance, strict=True
    ):
        if states[i] in closed_states:
            distance = float(np.hypot(*contacts.ring_positions[i]))
            across = spring * (1.0 - clearance / distance)
            direction = contacts.ring_positions[i] / distance
            tangent = across * np.eye(2) + (spring - across) * np.outer(direction, direction)
            stiffness[np.ix_(at, at)] += tangent
    return replace(linear, stiffness=stiffness)


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
    """Return the state of a mesh from those of its two flanks: drive, back, wedged (both closed), open or
    undecided.
    """
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
