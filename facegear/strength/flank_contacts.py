"""Root stress and pressure of each contact of a machine, and of the flanks that a rated flank meets.

Root stress and pressure of the flanks that a rated flank works with: the worst where there are several. A
pinion's flank meets both face gears. Teeth that are loaded equally both ways meet with both flanks. Each of
these contacts has errors of its own.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from facegear.arrays import Array, Arrays, Integers
from facegear.quantities import BODIES
from facegear.strength.contact_pressure import ContactPressure, contact_pressure
from facegear.strength.materials import FlankDuty
from facegear.strength.root_stress import RootStress, down_the_fillet, largest_tension
from facegear.strength.root_tables import root_from_arrays
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import FLANKS, GEARS, pair_at

if TYPE_CHECKING:
    import pandas as pd


class TensionHistory:
    """Largest tension of all teeth of a body in mesh, over torque and place in the mesh cycle.

    Over torque the largest values go as those of each gauge in `RootStress.at_torque`, between the places
    solved linearly: the result is no less than the largest of the interpolated gauges.
    """

    def __init__(self, root: RootStress) -> None:
        """Tabulate the largest stress over gauges and teeth by solved torque and position in the mesh
        cycle.
        """
        within, position_of = np.unique(np.round(np.mod(root.passage, 1.0), 9), return_inverse=True)
        largest = np.array([down_the_fillet(stress).max(axis=(1, 2, 3)) for stress in root.stress])
        by_position = np.array(
            [largest[:, position_of == index].max(axis=1) for index in range(within.size)]
        ).T
        self._scale = root.scale
        self._positions = np.append(within, within[0] + 1.0)
        self._table = np.hstack([by_position, by_position[:, :1]])

    def __call__(self, torques: Array, positions: Array) -> Array:
        """Return the stress (n,) Pa at torques (n,) N m and positions (n,) in the mesh cycle, in [0, 1)."""
        column, on = _cell(self._positions, positions)
        row, below, above = self._scale.parts(torques)
        low, high = (
            (1.0 - on) * self._table[at, column] + on * self._table[at, column + 1]
            for at in (row, np.minimum(row + 1, len(self._table) - 1))
        )
        return below * low + above * high

    def over_passage(self, torque: float) -> float:
        """Return the largest stress while a torque stays constant all through the passage.

        Parameters
        ----------
        torque : float
            Torque on the pinion, N m.

        Returns
        -------
        float
            Stress, Pa.
        """
        positions = self._positions[:-1]
        return float(self(np.full(positions.size, torque), positions).max())


def _cell(edges: Array, values: Array) -> tuple[Integers, Array]:
    """Return the cell (n,) between rising edges in which each value lies, and how far into it, 0 to 1."""
    cell = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, edges.size - 2)
    return cell, np.clip((values - edges[cell]) / (edges[cell + 1] - edges[cell]), 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class FlankContact:
    """Effects of a contact on its teeth at any torque of the pinion.

    Attributes
    ----------
    roots
        Root stress of pinion and face gear, by body.
    pressure
        Largest pressure and load on edges over the passage, and the largest share of the torque in fillets.
    """

    roots: Mapping[str, RootStress]
    pressure: ContactPressure

    @cached_property
    def tension(self) -> dict[str, Callable[[float], float]]:
        """Function of each body that gives its largest tension (Pa) over the passage at a torque (N m) on
        the pinion.
        """
        return {body: largest_tension(root) for body, root in self.roots.items()}

    @cached_property
    def history(self) -> dict[str, TensionHistory]:
        """Function of each body that gives its largest tension (Pa) at torques and positions in the mesh
        cycle.
        """
        return {body: TensionHistory(root) for body, root in self.roots.items()}

    def is_solved(self, torque: float) -> bool:
        """Whether a torque lies within those of the contact analysis.

        Parameters
        ----------
        torque : float
            Torque on the pinion, N m.

        Returns
        -------
        bool
            True from the first to the last solved torque, and for 0.
        """
        return next(iter(self.roots.values())).scale.is_solved(torque)


def flank_contacts(stress: Arrays, by_flank: "pd.DataFrame") -> dict[tuple[str, str], FlankContact]:
    """Return the contact of each gear's drive and back flank.

    Contacts with the same assembly errors are the same object.

    Parameters
    ----------
    stress : Arrays
        ROOT_STRESS_ARRAYS.
    by_flank : DataFrame
        The contact's table by flank.

    Returns
    -------
    dict[tuple[str, str], FlankContact]
        Contacts by gear (upper, lower) and flank (drive, back).
    """
    tables = dict(iter(by_flank.sort_values("torque_n_m").groupby(["gear", "flank"])))
    by_variant: dict[int, FlankContact] = {}
    contacts = {}
    for row, gear in enumerate(GEARS):
        for column, flank in enumerate(FLANKS):
            variant = int(stress["flank_variant"][row, column])
            if variant not in by_variant:
                roots: dict[str, RootStress] = {
                    body: root_from_arrays(stress, body, gear, flank) for body in BODIES
                }
                by_variant[variant] = FlankContact(roots, contact_pressure(tables[gear, flank]))
            contacts[gear, flank] = by_variant[variant]
    return contacts


def normal_arms(design: PairDesign) -> dict[str, float]:
    """Return the torque on the pinion over the force of each flank along its normal.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    dict[str, float]
        m, by FLANKS; the same at either gear.
    """
    return {flank: pair_at(design, GEARS[0], flank).normal_arm for flank in FLANKS}


def contacts_of(
    mesh: str, contacts: Mapping[tuple[str, str], FlankContact], gears: Sequence[str]
) -> dict[str, FlankContact]:
    """Return the contacts of a mesh by flank.

    A gear alone is the upper one, whatever the machine calls it.

    Parameters
    ----------
    mesh : str
        Name of the mesh, `pinion/gear`.
    contacts : Mapping[tuple[str, str], FlankContact]
        Contacts by gear and flank.
    gears : Sequence[str]
        Gears of the machine.

    Returns
    -------
    dict[str, FlankContact]
        Contacts by flank.
    """
    gear = gears[0] if len(gears) == 1 else mesh.rsplit("/", 1)[1]
    return {flank: contacts[gear, flank] for flank in FLANKS}


def largest_pressure(loads: Iterable[tuple[FlankContact, float]]) -> float:
    """Return the largest pressure of contacts whose edges do not carry all load.

    Parameters
    ----------
    loads : Iterable[tuple[FlankContact, float]]
        Contacts, each with its torque on the pinion, N m.

    Returns
    -------
    float
        Pressure, Pa; nan where the edges of all contacts carry all load.
    """
    return float(np.fmax.reduce([contact.pressure.at(torque) for contact, torque in loads]))


def met_by(duty: FlankDuty, gears: Sequence[str]) -> list[tuple[str, str]]:
    """Return the gears and flanks of the contacts that a rated flank takes part in.

    A face gear's flank has its own gear's contacts, a pinion's those of all gears; loads of flank `each`
    count on both flanks.

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


def worst_contact(duty: FlankDuty, contacts: Mapping[tuple[str, str], FlankContact]) -> tuple[str, str]:
    """Return the contact with the largest root stress under the flank's largest load.

    Parameters
    ----------
    duty : FlankDuty
        Loads of the rated flank.
    contacts : Mapping[tuple[str, str], FlankContact]
        Contacts of that flank, by gear or mesh and by flank.

    Returns
    -------
    tuple[str, str]
        Gear or mesh, and flank, of that contact.
    """
    return max(contacts, key=lambda at: contacts[at].roots[duty.gear].at_torque(duty.largest).max())


def worst_pressure(contacts: Sequence[FlankContact]) -> ContactPressure:
    """Combine the contacts by their largest values at every torque that one of them has solved.

    The error is that of the contact with the largest pressure; edge load, edge length and fillet share
    are the largest of all contacts, each by itself.

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
    """Return the values at other torques (n,), N m, interpolated between the solved ones by the rules of
    each field.
    """
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
