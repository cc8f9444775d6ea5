"""Pressure and root stress of every mesh, at the pose under the machine's own forces."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Arrays
from facegear.build.plans import contact_plan
from facegear.build.tooth_pair import ToothPair, pair
from facegear.contact.analysis import met_contacts
from facegear.contact.gear_flank import every_flank_from_arrays, flanks_of
from facegear.machine.machine import Machine
from facegear.machine.poses.fixed_point import OperatingPose, carrying_pairs
from facegear.machine.poses.fixed_point import operating_pose as fixed_point
from facegear.machine.poses.posed_flanks import flank_surfaces, nominal_contact
from facegear.machine.poses.surface import PoseSurface
from facegear.pipeline.outcome import Outcome
from facegear.quantities import BODIES
from facegear.schema.contact import Contact
from facegear.strength.flank_contacts import FlankContact, contacts_of, flank_contacts
from facegear.strength.passage import passing
from facegear.strength.posed_contacts import root_arrays_of, solved_contacts
from facegear.strength.root_stress import RootStress
from facegear.teeth.conjugate import contact_at
from facegear.teeth.placement import FLANKS


def posed_stress(
    surface: Arrays,
    pinion: Arrays,
    face_gear: Arrays,
    stress: Arrays,
    by_flank: pd.DataFrame,
    machine: Machine,
    tooth_pair: ToothPair,
    contact: Contact,
    gears: Sequence[str],
) -> Outcome:
    """Solve the contact and root stress at the pose of every mesh under the machine's mean torques.

    Meshes with the same pose are solved once. The torques are those of the contact analysis and the
    mesh's own. The relative error of root stress is taken over from the pair as assembled.

    Parameters
    ----------
    surface : Arrays
        Arrays `surface` of stage pose_surface.
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    stress : Arrays
        Arrays `stress` of stage root_stress, of the pair as assembled.
    by_flank : pd.DataFrame
        Table `by_flank` of stage contact, of the pair as assembled.
    machine : Machine
        The machine as assembled.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config.
    gears : Sequence[str]
        Face gears of the machine, `upper` alone or `upper` and `lower`.

    Returns
    -------
    Outcome
        Table `by_mesh` (see `_by_mesh`). Table `by_torque`: mesh, flank, contact, then the columns of
        stage contact's `by_torque`. Arrays `contacts`: root stress of each solved contact
        (`root_arrays_of`), name, number of the contact and carrying flank (0 drive, 1 back) of each
        mesh, and the poses of `_contact_poses`.

    Raises
    ------
    InvalidInput
        For a pose outside the surface.
    NotConverged
        Where equilibrium or contact does not converge.
    """
    pose_surface = PoseSurface.of_arrays(surface)
    result = fixed_point(machine, pose_surface)
    design, plan = pair(tooth_pair).design, contact_plan(contact)
    pairs = carrying_pairs(result, design)
    numbers = pairs.numbers
    requests = [
        (pair_design, tuple(sorted({*plan.torques, mesh_torque or plan.torques[0]})))
        for pair_design, mesh_torque in zip(pairs.designs, pairs.torques, strict=True)
    ]
    flanks = list(zip(*map(every_flank_from_arrays, (pinion, face_gear)), strict=True))
    arrays: dict[str, AnyArray] = {}
    tables, names = [], machine.layout.mesh_names
    assembled_contacts = flank_contacts(stress, by_flank)
    for number, posed_contact in enumerate(
        met_contacts(design, pair(tooth_pair).materials, flanks, plan, requests)
    ):
        mesh = int(np.argmax(numbers == number))
        loaded_flank = FLANKS[int(result.forces[mesh] < 0.0)]
        assembled_roots = contacts_of(names[mesh], assembled_contacts, gears)[loaded_flank].roots
        roots: dict[str, RootStress] = {
            body: replace(passing(body, flank, posed_contact.loads), error=assembled_roots[body].error)
            for body, flank in zip(BODIES, flanks_of(pairs.designs[number], design, flanks), strict=True)
        }
        arrays |= root_arrays_of(number, roots)
        tables.append(posed_contact.by_torque.assign(contact=number))
    every = pd.concat(tables, ignore_index=True)
    contact_poses = _contact_poses(machine, pose_surface, result)
    by_torque = pd.concat(
        [
            every[every["contact"] == number].assign(mesh=name, flank=FLANKS[int(back)])
            for name, number, back in zip(names, numbers, result.forces < 0.0, strict=True)
        ],
        ignore_index=True,
    )
    arrays |= {"mesh": np.array(names), "contact": numbers, "carrying": (result.forces < 0.0).astype(int)}
    contacts = solved_contacts(arrays, by_torque)
    by_mesh = _by_mesh(result, names, [contacts[number] for number in numbers], assembled_contacts, gears)
    first = ["mesh", "flank", "contact"]
    by_torque = by_torque[[*first, *(name for name in by_torque.columns if name not in first)]]
    content = {"by_mesh": by_mesh, "by_torque": by_torque, "contacts": {**arrays, **contact_poses}}
    return Outcome(content, _summary(by_mesh))


def _contact_poses(machine: Any, surface: PoseSurface, result: OperatingPose) -> dict[str, AnyArray]:
    """Return where the unloaded contact of the m meshes lies, as arrays.

    `mesh_torque_n_m` (m,) on the pinion; `path_m` (m, 2), place along the pinion on drive and back
    flank at the pose, nan where flanks do not meet; `angle_rad` (m,), error of the shaft angle.
    `path_at_rest_m` and `angle_at_rest_rad` (m,) are those of the flank that does not carry, as
    assembled.
    """
    back = result.forces < 0.0
    paths, rest, surfaces = [], [], flank_surfaces(machine, surface)
    for mesh in range(back.size):
        poses = (
            contact_at(surfaces[mesh + back.size * side].pair, result.poses.errors(mesh, side))
            for side in (False, True)
        )
        paths.append([np.nan if pose is None else pose.path for pose in poses])
        rest.append(nominal_contact(machine, surface, mesh, not back[mesh]))
    nominal_contacts = np.array(rest)
    return {
        "mesh_torque_n_m": result.torque,
        "path_m": np.array(paths),
        "angle_rad": result.angle,
        "path_at_rest_m": nominal_contacts[:, 0],
        "angle_at_rest_rad": nominal_contacts[:, 1],
    }


def _by_mesh(
    result: OperatingPose,
    names: Sequence[str],
    contacts: Sequence[FlankContact],
    assembled_contacts: Any,
    gears: Sequence[str],
) -> pd.DataFrame:
    """Tabulate pressure and root stress of every mesh at its own torque, at its pose and as assembled.

    `contacts` are those at the pose, one a mesh; `assembled_contacts` hold those as assembled by gear
    and flank. A row a mesh: mesh, flank that carries, torque_n_m, unloaded_path_mm, then pressure_mpa,
    pinion_root_mpa, face_gear_root_mpa and the same with `_as_assembled`. Stresses are 0 without a
    torque.
    """
    rows = []
    for mesh, (name, contact) in enumerate(zip(names, contacts, strict=True)):
        flank, torque = FLANKS[int(result.forces[mesh] < 0.0)], float(result.torque[mesh])
        rest = contacts_of(name, assembled_contacts, gears)[flank]
        row = {
            "mesh": name,
            "flank": flank,
            "torque_n_m": torque,
            "unloaded_path_mm": 1e3 * result.path[mesh],
        }
        for text, flank_contact in (("", contact), ("_as_assembled", rest)):
            row[f"pressure{text}_mpa"] = 1e-6 * flank_contact.pressure.at(torque) if torque > 0.0 else 0.0
            for body in BODIES:
                tension = flank_contact.tension[body](torque) if torque > 0.0 else 0.0
                row[f"{body}_root{text}_mpa"] = 1e-6 * tension
        rows.append(row)
    return pd.DataFrame(rows)


def _summary(table: pd.DataFrame) -> str:
    """Say in one line by how much the pose changes the face gear's root stress at the mesh where it
    changes most.
    """
    loaded_meshes = table[table["torque_n_m"] > 0.0]
    if loaded_meshes.empty:
        return "no mesh carries a load"
    change = loaded_meshes["face_gear_root_mpa"] / loaded_meshes["face_gear_root_as_assembled_mpa"] - 1.0
    row = loaded_meshes.loc[change.abs().idxmax()]
    return (
        f"{row['mesh']}: face gear {row['face_gear_root_mpa']:.0f} MPa at {row['torque_n_m']:.0f} N m, "
        f"{100 * change.loc[row.name]:+.0f} % by its pose"
    )
