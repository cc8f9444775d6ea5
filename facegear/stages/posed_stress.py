"""Pressure and root stress of every mesh, its teeth where the machine's own forces put them."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Arrays
from facegear.config.contact import Contact, contact_plan
from facegear.config.tooth_pair import ToothPair, pair
from facegear.contact.gear_flank import from_arrays
from facegear.contact.posed import met_contacts
from facegear.geometry.bodies import BODIES
from facegear.geometry.conjugate import contact_at
from facegear.geometry.flank_errors import FLANKS
from facegear.poses.fixed_point import OperatingPose
from facegear.poses.fixed_point import operating_pose as fixed_point
from facegear.poses.loaded_pairs import carrying_pairs
from facegear.poses.posed_flanks import nominal_contact
from facegear.poses.surface import PoseSurface
from facegear.stages.outcome import Outcome
from facegear.strength.flank_contacts import FlankContact, contacts_of, flank_contacts
from facegear.strength.passage import passing
from facegear.strength.posed_contacts import root_arrays_of, solved_contacts
from facegear.strength.root_stress import RootStress
from facegear.transmission.machine import Machine


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
    """`by_mesh`, `by_torque` (tables) and `contacts` (arrays): contact solved at the pose of every mesh.

    stress: arrays of stage root_stress; by_flank: table of stage contact, the pair as assembled. At the
    torques of the contact analysis and at the mesh's own. Raises InvalidInput for a pose outside the surface,
    NotConverged.
    """
    known = PoseSurface.of_arrays(surface)
    result = fixed_point(machine, known)
    design, plan = pair(tooth_pair).design, contact_plan(contact)
    pairs = carrying_pairs(result, design)
    numbers = pairs.numbers
    asked = [
        (met, tuple(sorted({*plan.torques, own or plan.torques[0]})))
        for met, own in zip(pairs.designs, pairs.torques, strict=True)
    ]
    flanks = from_arrays(pinion), from_arrays(face_gear)
    arrays: dict[str, AnyArray] = {}
    tables = []
    for number, posed in enumerate(met_contacts(design, pair(tooth_pair).materials, flanks, plan, asked)):
        roots: dict[str, RootStress] = {
            body: replace(passing(body, flank, posed.loads), error=stress[f"{body}_error"])
            for body, flank in zip(BODIES, flanks, strict=True)
        }
        arrays |= root_arrays_of(number, roots)
        tables.append(posed.by_torque.assign(contact=number))
    every, names = pd.concat(tables, ignore_index=True), machine.layout.mesh_names
    places = _places(machine, known, result)
    by_torque = pd.concat(
        [
            every[every["contact"] == number].assign(mesh=name, flank=FLANKS[int(back)])
            for name, number, back in zip(names, numbers, result.forces < 0.0, strict=True)
        ],
        ignore_index=True,
    )
    arrays |= {"mesh": np.array(names), "contact": numbers, "carrying": (result.forces < 0.0).astype(int)}
    contacts = solved_contacts(arrays, by_torque)
    by_mesh = _by_mesh(
        result, names, [contacts[number] for number in numbers], flank_contacts(stress, by_flank), gears
    )
    first = ["mesh", "flank", "contact"]
    by_torque = by_torque[[*first, *(name for name in by_torque.columns if name not in first)]]
    content = {"by_mesh": by_mesh, "by_torque": by_torque, "contacts": {**arrays, **places}}
    return Outcome(content, _summary(by_mesh))


def _places(machine: Any, surface: PoseSurface, result: OperatingPose) -> dict[str, AnyArray]:
    """Where both flanks of every mesh stand, and where its other flank does as assembled."""
    back = result.forces < 0.0
    paths, rest = [], []
    for mesh in range(back.size):
        poses = (contact_at(surface.pair, result.poses.errors(mesh, side)) for side in (False, True))
        paths.append([np.nan if pose is None else pose.y for pose in poses])
        rest.append(nominal_contact(machine, surface, mesh, not back[mesh]))
    places = np.array(rest)
    return {
        "mesh_torque_n_m": result.torque,
        "path_m": np.array(paths),
        "angle_rad": result.angle,
        "path_at_rest_m": places[:, 0],
        "angle_at_rest_rad": places[:, 1],
    }


def _by_mesh(
    result: OperatingPose,
    names: Sequence[str],
    contacts: Sequence[FlankContact],
    assembled: Any,
    gears: Sequence[str],
) -> pd.DataFrame:
    """Stress of every mesh at its own torque, where it stands and as assembled."""
    rows = []
    for mesh, (name, contact) in enumerate(zip(names, contacts, strict=True)):
        flank, torque = FLANKS[int(result.forces[mesh] < 0.0)], float(result.torque[mesh])
        rest = contacts_of(name, assembled, gears)[flank]
        row = {
            "mesh": name,
            "flank": flank,
            "torque_n_m": torque,
            "unloaded_path_mm": 1e3 * result.path[mesh],
        }
        for text, met in (("", contact), ("_as_assembled", rest)):
            row[f"pressure{text}_mpa"] = 1e-6 * met.pressure.at(torque) if torque > 0.0 else 0.0
            for body in BODIES:
                tension = met.tension[body](torque) if torque > 0.0 else 0.0
                row[f"{body}_root{text}_mpa"] = 1e-6 * tension
        rows.append(row)
    return pd.DataFrame(rows)


def _summary(table: pd.DataFrame) -> str:
    loaded = table[table["torque_n_m"] > 0.0]
    if loaded.empty:
        return "no mesh carries a load"
    change = loaded["face_gear_root_mpa"] / loaded["face_gear_root_as_assembled_mpa"] - 1.0
    row = loaded.loc[change.abs().idxmax()]
    return (
        f"{row['mesh']}: face gear {row['face_gear_root_mpa']:.0f} MPa at {row['torque_n_m']:.0f} N m, "
        f"{100 * change.loc[row.name]:+.0f} % by its pose"
    )
