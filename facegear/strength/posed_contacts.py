"""Root stress and pressure of every mesh of a machine whose teeth stand where its own forces put them.

The flank that carries at rest has contact solved at its pose. The other flank, and every flank under another
load of the machine, has that contact times what the response surface over pose says of the change.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import scipy

from facegear.arrays import AnyArray, Array, Arrays
from facegear.geometry.bodies import BODIES
from facegear.geometry.flank_errors import FLANKS
from facegear.poses.surface import PoseSurface
from facegear.strength.contact_pressure import contact_pressure
from facegear.strength.duty import FlankDuty
from facegear.strength.flank_contacts import FlankContact, contacts_of
from facegear.strength.rating import LoadStresses
from facegear.strength.root_stress import RootStress

if TYPE_CHECKING:
    import pandas as pd

PRESSURE = "pressure_pa"
ROOTS: dict[str, str] = {body: f"{body}_root_pa" for body in BODIES}
STRESSES = (PRESSURE, *ROOTS.values())
"""Quantities of the surface that are stresses."""

Factor = Callable[[Array], Array]
"""Of a stress at torques (n,) N m on the pinion."""


@dataclass(frozen=True)
class Stand:
    """Where the unloaded contact of a flank stands along the pinion (m), and its error of the shaft angle
    (rad).
    """

    path: float
    angle: float


def change(surface: PoseSurface, quantity: str, start: Stand, end: Stand) -> Factor:
    """By how much a quantity is more at one stand than at another.

    Torques beyond the surface's count as its last, paths beyond its nodes as the nearest. nan where the
    surface does not know the quantity, as of pressure where edges carry all.
    """
    if quantity not in surface.values:
        return lambda torque: np.full(torque.shape, np.nan)
    if start == end:
        return np.ones_like
    torques = surface.nodes.torques
    low, high = surface.nodes.paths[[0, -1]]
    logs = [
        np.log(
            [surface.at(quantity, torque, float(np.clip(at.path, low, high)), at.angle) for torque in torques]
        )
        for at in (start, end)
    ]
    over = scipy.interpolate.CubicSpline(np.log(torques), logs[1] - logs[0])
    return lambda torque: np.asarray(np.exp(over(np.log(np.clip(torque, torques[0], torques[-1])))))


def changed(contact: FlankContact, factors: Mapping[str, Factor]) -> FlankContact:
    """A contact whose stresses are more by factors of the torque, by STRESSES."""
    pressure = contact.pressure
    by_torque = factors[PRESSURE](pressure.torques)
    scaled = replace(pressure, pressure=pressure.pressure * by_torque, error=pressure.error * by_torque)
    roots = {
        body: replace(
            root, stress=root.stress * factors[ROOTS[body]](root.torques)[:, None, None, None, None]
        )
        for body, root in contact.roots.items()
    }
    return FlankContact(roots, scaled)


def root_arrays_of(number: int, roots: Mapping[str, RootStress]) -> dict[str, AnyArray]:
    """Root stress of one contact, to be stored beside others."""
    arrays: dict[str, AnyArray] = {f"contact{number}_torque_n_m": roots[BODIES[0]].torques}
    for body, root in roots.items():
        arrays[f"contact{number}_{body}_passage"] = root.passage
        arrays[f"contact{number}_{body}_stress_pa"] = root.stress
        arrays |= {
            f"{body}_along_m": root.along,
            f"{body}_angle_rad": root.angle,
            f"{body}_error": root.error,
        }
    return arrays


def solved_contacts(arrays: Arrays, by_torque: "pd.DataFrame") -> list[FlankContact]:
    """Contacts by number, from what `root_arrays_of` gives and their tables by torque."""
    tables = dict(iter(by_torque.drop_duplicates(["contact", "torque_n_m"]).groupby("contact")))
    contacts = []
    for number in range(len(tables)):
        roots: dict[str, RootStress] = {
            body: RootStress(
                torques=arrays[f"contact{number}_torque_n_m"],
                passage=arrays[f"contact{number}_{body}_passage"],
                stress=arrays[f"contact{number}_{body}_stress_pa"],
                along=arrays[f"{body}_along_m"],
                angle=arrays[f"{body}_angle_rad"],
                error=arrays[f"{body}_error"],
            )
            for body in BODIES
        }
        contacts.append(FlankContact(roots, contact_pressure(tables[number].sort_values("torque_n_m"))))
    return contacts


@dataclass(frozen=True, eq=False)
class PosedContacts:
    """Contacts of all meshes under the machine's mean torques.

    Attributes
    ----------
    contacts
        By mesh, then by flank.
    stands
        Where they stand, by mesh and flank.
    carrying
        The flank of each mesh that carries at rest, `drive` where none does.
    torque
        What each mesh carries at rest, N m on the pinion.
    surface
        What another stand changes.
    """

    contacts: Mapping[str, Mapping[str, FlankContact]]
    stands: Mapping[tuple[str, str], Stand]
    carrying: Mapping[str, str]
    torque: Mapping[str, float]
    surface: PoseSurface

    def met_by(self, duty: FlankDuty) -> list[tuple[str, str]]:
        """Mesh and flank of the contacts of a rated flank.

        Of a duty cycle that names no meshes the one that carries most on this flank, or most where none does.
        """
        flanks = FLANKS if duty.flank == "each" else (duty.flank,)
        meshes = list(dict.fromkeys(duty.meshes))
        if not meshes:
            on = [mesh for mesh, flank in self.carrying.items() if flank in flanks] or list(self.contacts)
            meshes = [max(on, key=self.torque.__getitem__)]
        return [(mesh, flank) for mesh in meshes for flank in flanks]

    def stresses(self, duty: FlankDuty, stands: Mapping[tuple[int, str, str], Stand]) -> LoadStresses:
        """Of every load of a rated flank, where the load of its bin puts its teeth; the worst of its meshes.

        stands: by bin from 0, mesh and flank.
        """
        tension, pressure = np.zeros(duty.torque.size), np.full(duty.torque.size, np.nan)
        named = np.array(duty.meshes)
        for number in np.unique(duty.bins):
            for mesh, flank in self.met_by(duty):
                here = np.flatnonzero((duty.bins == number) & ((named == mesh) if named.size else True))
                torque, contact = duty.torque[here], self.contacts[mesh][flank]
                ends = self.stands[mesh, flank], stands[int(number), mesh, flank]
                tense = np.array([contact.tension[duty.gear](value) for value in torque])
                tense = tense * change(self.surface, ROOTS[duty.gear], *ends)(torque)
                pressed = np.array([contact.pressure.at(value) for value in torque])
                pressed = pressed * change(self.surface, PRESSURE, *ends)(torque)
                tension[here] = np.maximum(tension[here], tense)
                pressure[here] = np.fmax(pressure[here], pressed)
        return LoadStresses(tension, pressure)


def mesh_contacts(
    meshes: Iterable[str],
    assembled: Mapping[tuple[str, str], FlankContact],
    gears: Sequence[str],
    posed: PosedContacts | None,
) -> dict[str, Mapping[str, FlankContact]]:
    """Contacts of meshes by flank: where the machine's own forces put them, or as `assembled`."""
    if posed is not None:
        return {mesh: posed.contacts[mesh] for mesh in meshes}
    return {mesh: contacts_of(mesh, assembled, gears) for mesh in meshes}


def duty_stands(table: "pd.DataFrame") -> dict[tuple[int, str, str], Stand]:
    """By bin from 0, mesh and flank, from the table of stage duty_poses."""
    return {
        (row.bin - 1, row.mesh, row.flank): Stand(
            1e-3 * row.unloaded_path_mm, float(np.radians(row.shaft_angle_error_deg))
        )
        for row in table.itertuples()
    }


def posed_of(
    assembled: Mapping[tuple[str, str], FlankContact],
    gears: Sequence[str],
    arrays: Arrays | None,
    by_torque: "pd.DataFrame | None",
    poses: Arrays | None,
) -> PosedContacts | None:
    """`posed_contacts` where all of it is given, `poses` as arrays of stage pose_surface."""
    if arrays is None or by_torque is None or poses is None:
        return None
    return posed_contacts(arrays, by_torque, PoseSurface.of_arrays(poses), assembled, gears)


def posed_contacts(
    arrays: Arrays,
    by_torque: "pd.DataFrame",
    surface: PoseSurface,
    assembled: Mapping[tuple[str, str], FlankContact],
    gears: Sequence[str],
) -> PosedContacts:
    """From the parts of stage posed_stress; `assembled`: contacts by gear and flank of the `gears`."""
    solved, contacts, stands, carrying, torque = solved_contacts(arrays, by_torque), {}, {}, {}, {}
    for row, name in enumerate(map(str, arrays["mesh"])):
        own = FLANKS[int(arrays["carrying"][row])]
        (other,) = set(FLANKS) - {own}
        for column, flank in enumerate(FLANKS):
            stands[name, flank] = Stand(float(arrays["path_m"][row, column]), float(arrays["angle_rad"][row]))
        rest = Stand(float(arrays["path_at_rest_m"][row]), float(arrays["angle_at_rest_rad"][row]))
        factors = {name_: change(surface, name_, rest, stands[name, other]) for name_ in STRESSES}
        at_rest = contacts_of(name, assembled, gears)[other]
        contacts[name] = {own: solved[int(arrays["contact"][row])], other: changed(at_rest, factors)}
        carrying[name], torque[name] = own, float(arrays["mesh_torque_n_m"][row])
    return PosedContacts(contacts, stands, carrying, torque, surface)
