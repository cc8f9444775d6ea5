"""Root stress and pressure of every mesh of a machine in the loaded position of its bodies.

The flank that carries load at rest has contact solved at its pose. The other flank, and every flank under
another load of the machine, has that contact times the ratio that the response surface over pose gives.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import scipy

from facegear.arrays import AnyArray, Array, Arrays
from facegear.machine.poses.surface import PoseSurface
from facegear.quantities import BODIES
from facegear.strength.contact_pressure import contact_pressure
from facegear.strength.flank_contacts import FlankContact, contacts_of
from facegear.strength.materials import FlankDuty
from facegear.strength.rating import LoadStresses
from facegear.strength.root_stress import RootStress
from facegear.teeth.placement import FLANKS

if TYPE_CHECKING:
    import pandas as pd

PRESSURE = "pressure_pa"
"""Name of the pressure, Pa, on the response surface."""
ROOTS: dict[str, str] = {body: f"{body}_root_pa" for body in BODIES}
"""Names of the root stress of each body, Pa, on the response surface."""
STRESSES = (PRESSURE, *ROOTS.values())
"""Quantities of the surface that are stresses."""

Factor = Callable[[Array], Array]
"""Function that returns the factor of a stress at torques (n,) N m on the pinion."""


@dataclass(frozen=True)
class ContactPose:
    """Pose of the unloaded contact of a flank.

    `path`: radius of its path, the position along the pinion from the gear's axis, m. `angle`: error of
    the shaft angle, rad.
    """

    path: float
    angle: float


def stress_ratio(surface: PoseSurface, quantity: str, start: ContactPose, end: ContactPose) -> Factor:
    """Return the ratio of a quantity at one contact pose to that at another, as a function of torque.

    It is interpolated by a spline of logarithms over the surface's torques. Torques beyond the surface's
    count as its last, paths beyond its nodes as the nearest.

    Parameters
    ----------
    surface : PoseSurface
        Response surface over pose.
    quantity : str
        Name of the quantity: PRESSURE or one of ROOTS.
    start : ContactPose
        Pose of the denominator.
    end : ContactPose
        Pose of the numerator.

    Returns
    -------
    Factor
        Ratio at torques (n,) N m on the pinion; nan where the surface does not know the quantity, for
        example pressure where edges carry all.
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


def scale_contact(contact: FlankContact, factors: Mapping[str, Factor]) -> FlankContact:
    """Return a contact whose stresses are multiplied by factors of the torque.

    Pressure and its error have the factor of PRESSURE, root stress of a body that of ROOTS. Loads on
    edges and in fillets stay.

    Parameters
    ----------
    contact : FlankContact
        The contact.
    factors : Mapping[str, Factor]
        Factor of each of STRESSES.

    Returns
    -------
    FlankContact
        The scaled contact.
    """
    pressure = contact.pressure
    by_torque = factors[PRESSURE](pressure.torques)
    scaled_pressure = replace(
        pressure, pressure=pressure.pressure * by_torque, error=pressure.error * by_torque
    )
    roots = {
        body: replace(
            root, stress=root.stress * factors[ROOTS[body]](root.torques)[:, None, None, None, None]
        )
        for body, root in contact.roots.items()
    }
    return FlankContact(roots, scaled_pressure)


def root_arrays_of(number: int, roots: Mapping[str, RootStress]) -> dict[str, AnyArray]:
    """Return the root stress of one contact as arrays that are stored beside those of others.

    Names begin with `contact` and the number: torque_n_m, and of each body passage, stress_pa and the places
    and errors of its gauges, along_m, angle_rad and error, which differ from flank to flank of some teeth.

    Parameters
    ----------
    number : int
        Number of the contact, from 0.
    roots : Mapping[str, RootStress]
        Root stress of each body.

    Returns
    -------
    dict[str, array]
        Arrays by name, in SI units, with the shapes (...) of `RootStress`.
    """
    arrays: dict[str, AnyArray] = {f"contact{number}_torque_n_m": roots[BODIES[0]].torques}
    for body, root in roots.items():
        name = f"contact{number}_{body}"
        arrays |= {
            f"{name}_passage": root.passage,
            f"{name}_stress_pa": root.stress,
            f"{name}_along_m": root.along,
            f"{name}_angle_rad": root.angle,
            f"{name}_error": root.error,
        }
    return arrays


def solved_contacts(arrays: Arrays, by_torque: "pd.DataFrame") -> list[FlankContact]:
    """Restore the contacts from the arrays of `root_arrays_of` and their tables by torque.

    Parameters
    ----------
    arrays : Arrays
        Arrays of all contacts.
    by_torque : DataFrame
        Table by torque of stage contact with a column `contact`.

    Returns
    -------
    list[FlankContact]
        Contacts by number.
    """
    tables = dict(iter(by_torque.drop_duplicates(["contact", "torque_n_m"]).groupby("contact")))
    contacts = []
    for number in range(len(tables)):
        roots: dict[str, RootStress] = {
            body: RootStress(
                torques=arrays[f"contact{number}_torque_n_m"],
                passage=arrays[f"contact{number}_{body}_passage"],
                stress=arrays[f"contact{number}_{body}_stress_pa"],
                along=arrays[f"contact{number}_{body}_along_m"],
                angle=arrays[f"contact{number}_{body}_angle_rad"],
                error=arrays[f"contact{number}_{body}_error"],
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
        Contacts by mesh, then by flank.
    contact_poses
        Pose of each contact, by mesh and flank.
    loaded_flanks
        Flank of each mesh that carries load at rest, `drive` where none does.
    torque
        Load of each mesh at rest, N m on the pinion.
    surface
        Response surface that tells how another pose changes the stress.
    """

    contacts: Mapping[str, Mapping[str, FlankContact]]
    contact_poses: Mapping[tuple[str, str], ContactPose]
    loaded_flanks: Mapping[str, str]
    torque: Mapping[str, float]
    surface: PoseSurface

    def met_by(self, duty: FlankDuty) -> list[tuple[str, str]]:
        """Return the mesh and flank of the contacts of a rated flank.

        If the duty cycle names no meshes, it is the mesh that carries most on this flank, or most where none
        does.

        Parameters
        ----------
        duty : FlankDuty
            Loads of the rated flank.

        Returns
        -------
        list[tuple[str, str]]
            Mesh and flank of each contact.
        """
        flanks = FLANKS if duty.flank == "each" else (duty.flank,)
        meshes = list(dict.fromkeys(duty.meshes))
        if not meshes:
            on = [mesh for mesh, flank in self.loaded_flanks.items() if flank in flanks] or list(
                self.contacts
            )
            meshes = [max(on, key=self.torque.__getitem__)]
        return [(mesh, flank) for mesh in meshes for flank in flanks]

    def of_body(self, body: str, contacts: Sequence[tuple[str, str]]) -> dict[tuple[str, str], FlankContact]:
        """Return the contacts that a gear has on both its flanks, in all its meshes.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`, as which the gear is rated.
        contacts : Sequence[tuple[str, str]]
            Mesh and flank of some contacts of that gear.

        Returns
        -------
        dict[tuple[str, str], FlankContact]
            Contacts by mesh and flank.
        """
        part = BODIES.index(body)
        names = {mesh.rsplit("/", 1)[part] for mesh, _ in contacts}
        meshes = [mesh for mesh in self.contacts if mesh.rsplit("/", 1)[part] in names]
        return {(mesh, flank): self.contacts[mesh][flank] for mesh in meshes for flank in FLANKS}

    def stresses(
        self, duty: FlankDuty, contact_poses: Mapping[tuple[int, str, str], ContactPose]
    ) -> LoadStresses:
        """Compute the stresses of every load of a rated flank in the loaded position of its bin.

        The stress of the mesh's contact at rest is multiplied by `stress_ratio` from its pose to that of
        the bin. Where several meshes load the flank, the largest stress counts.

        Parameters
        ----------
        duty : FlankDuty
            Loads of the rated flank.
        contact_poses : Mapping[tuple[int, str, str], ContactPose]
            Poses by bin from 0, mesh and flank.

        Returns
        -------
        LoadStresses
            Largest tension and pressure of each load.
        """
        tension, pressure = np.zeros(duty.torque.size), np.full(duty.torque.size, np.nan)
        mesh_names = np.array(duty.meshes)
        for number in np.unique(duty.bins):
            for mesh, flank in self.met_by(duty):
                rows = np.flatnonzero(
                    (duty.bins == number) & ((mesh_names == mesh) if mesh_names.size else True)
                )
                torque, contact = duty.torque[rows], self.contacts[mesh][flank]
                ends = self.contact_poses[mesh, flank], contact_poses[int(number), mesh, flank]
                tensions = np.array([contact.tension[duty.gear](value) for value in torque])
                surface = self.surface.of_flank(mesh.rsplit("/", 1)[1], flank)
                tensions = tensions * stress_ratio(surface, ROOTS[duty.gear], *ends)(torque)
                pressures = np.array([contact.pressure.at(value) for value in torque])
                pressures = pressures * stress_ratio(surface, PRESSURE, *ends)(torque)
                tension[rows] = np.maximum(tension[rows], tensions)
                pressure[rows] = np.fmax(pressure[rows], pressures)
        return LoadStresses(tension, pressure)


def mesh_contacts(
    meshes: Iterable[str],
    assembled_contacts: Mapping[tuple[str, str], FlankContact],
    gears: Sequence[str],
    loaded_contacts: PosedContacts | None,
) -> dict[str, Mapping[str, FlankContact]]:
    """Return the contacts of meshes by flank, in the loaded position of the bodies if it is known.

    Parameters
    ----------
    meshes : Iterable[str]
        Names of the meshes.
    assembled_contacts : Mapping[tuple[str, str], FlankContact]
        Contacts as assembled, by gear and flank.
    gears : Sequence[str]
        Gears of the machine.
    loaded_contacts : PosedContacts or None
        Contacts in the loaded position; None for those as assembled.

    Returns
    -------
    dict[str, Mapping[str, FlankContact]]
        Contacts by mesh and flank.
    """
    if loaded_contacts is not None:
        return {mesh: loaded_contacts.contacts[mesh] for mesh in meshes}
    return {mesh: contacts_of(mesh, assembled_contacts, gears) for mesh in meshes}


def duty_contact_poses(table: "pd.DataFrame") -> dict[tuple[int, str, str], ContactPose]:
    """Read the contact poses of the bins of a duty cycle.

    Parameters
    ----------
    table : DataFrame
        Table of stage duty_poses: columns bin (from 1), mesh, flank, unloaded_path_mm and
        shaft_angle_error_deg.

    Returns
    -------
    dict[tuple[int, str, str], ContactPose]
        Poses by bin from 0, mesh and flank.
    """
    return {
        (row.bin - 1, row.mesh, row.flank): ContactPose(
            1e-3 * row.unloaded_path_mm, float(np.radians(row.shaft_angle_error_deg))
        )
        for row in table.itertuples()
    }


def posed_of(
    assembled_contacts: Mapping[tuple[str, str], FlankContact],
    gears: Sequence[str],
    arrays: Arrays | None,
    by_torque: "pd.DataFrame | None",
    poses: Arrays | None,
) -> PosedContacts | None:
    """Return `posed_contacts` if all of its inputs are given.

    Parameters
    ----------
    assembled_contacts : Mapping[tuple[str, str], FlankContact]
        Contacts as assembled, by gear and flank.
    gears : Sequence[str]
        Gears of the machine.
    arrays, by_torque : Arrays or None
        Parts of stage posed_stress.
    poses : Arrays or None
        Arrays of stage pose_surface.

    Returns
    -------
    PosedContacts or None
        Contacts in the loaded position; None where an input is None.
    """
    if arrays is None or by_torque is None or poses is None:
        return None
    return posed_contacts(arrays, by_torque, PoseSurface.of_arrays(poses), assembled_contacts, gears)


def posed_contacts(
    arrays: Arrays,
    by_torque: "pd.DataFrame",
    surface: PoseSurface,
    assembled_contacts: Mapping[tuple[str, str], FlankContact],
    gears: Sequence[str],
) -> PosedContacts:
    """Assemble the contacts in the loaded position from the parts of stage posed_stress.

    Parameters
    ----------
    arrays : Arrays
        Arrays of stage posed_stress.
    by_torque : DataFrame
        Table by torque of stage posed_stress.
    surface : PoseSurface
        Response surface over pose.
    assembled_contacts : Mapping[tuple[str, str], FlankContact]
        Contacts as assembled, by gear and flank.
    gears : Sequence[str]
        Gears of the machine.

    Returns
    -------
    PosedContacts
        Contacts of all meshes.
    """
    contacts_by_number, contacts, contact_poses, loaded_flanks, torque = (
        solved_contacts(arrays, by_torque),
        {},
        {},
        {},
        {},
    )
    for row, name in enumerate(map(str, arrays["mesh"])):
        loaded_flank = FLANKS[int(arrays["carrying"][row])]
        (other_flank,) = set(FLANKS) - {loaded_flank}
        for column, flank in enumerate(FLANKS):
            contact_poses[name, flank] = ContactPose(
                float(arrays["path_m"][row, column]), float(arrays["angle_rad"][row])
            )
        rest = ContactPose(float(arrays["path_at_rest_m"][row]), float(arrays["angle_at_rest_rad"][row]))
        flank_surface = surface.of_flank(name.rsplit("/", 1)[1], other_flank)
        end = contact_poses[name, other_flank]
        factors = {stress: stress_ratio(flank_surface, stress, rest, end) for stress in STRESSES}
        at_rest = contacts_of(name, assembled_contacts, gears)[other_flank]
        contacts[name] = {
            loaded_flank: contacts_by_number[int(arrays["contact"][row])],
            other_flank: scale_contact(at_rest, factors),
        }
        loaded_flanks[name], torque[name] = loaded_flank, float(arrays["mesh_torque_n_m"][row])
    return PosedContacts(contacts, contact_poses, loaded_flanks, torque, surface)
