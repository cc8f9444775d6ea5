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
    """What a contact does to its teeth at any torque of the pinion.

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

    def solved(self, torque: float) -> bool:
        """Whether a torque (N m) lies within those of the contact analysis."""
        return next(iter(self.roots.values())).scale.solved(torque)


def flank_contacts(stress: Arrays, by_flank: "pd.DataFrame") -> dict[tuple[str, str], FlankContact]:
    """By gear and flank, from ROOT_STRESS_ARRAYS and the contact's table by flank.

    Contacts with the same assembly errors are the same object.
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
    """Contacts by flank of a mesh, named `pinion/gear`, of a machine with these `gears`.

    A gear alone is the upper one, whatever the machine calls it.
    """
    gear = gears[0] if len(gears) == 1 else mesh.rsplit("/", 1)[1]
    return {flank: contacts[gear, flank] for flank in FLANKS}


def largest_pressure(loaded: Iterable[tuple[FlankContact, float]]) -> float:
    """Largest pressure (Pa) of contacts at torques (N m), of those whose edges do not carry all; else nan."""
    return float(np.fmax.reduce([contact.pressure.at(torque) for contact, torque in loaded]))
