"""Root stress and pressure of each contact of a machine: a gear's drive or back flank with its pinions."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from facegear.arrays import Arrays
from facegear.geometry.bodies import BODIES
from facegear.geometry.flank_errors import FLANKS, GEARS
from facegear.strength.contact_pressure import ContactPressure, contact_pressure
from facegear.strength.root_stress import RootStress, largest_tension
from facegear.strength.root_tables import root_from_arrays
from facegear.strength.tension_history import TensionHistory

if TYPE_CHECKING:
    import pandas as pd


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
        """Largest tension (Pa) of each body over the passage at a torque (N m)."""
        return {body: largest_tension(root) for body, root in self.roots.items()}

    @cached_property
    def history(self) -> dict[str, TensionHistory]:
        """Largest tension of each body at torques and places in the mesh cycle."""
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
