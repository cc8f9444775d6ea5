"""Operating pose of every mesh under the machine's own forces, and its contact there."""

from dataclasses import asdict, replace

import pandas as pd

from facegear.arrays import AnyArray, Arrays
from facegear.config.contact import Contact, contact_plan
from facegear.config.tooth_pair import ToothPair, pair
from facegear.contact.gear_flank import GearFlank, from_arrays
from facegear.contact.margins import pattern_margins
from facegear.contact.posed import PosedContact, met_contacts
from facegear.contact.reactions import REACTION_COLUMNS
from facegear.geometry.design import PairDesign
from facegear.poses.fixed_point import OperatingPose
from facegear.poses.fixed_point import operating_pose as fixed_point
from facegear.poses.loaded_pairs import carrying_pairs
from facegear.poses.posed_flanks import assembly_errors
from facegear.poses.surface import STIFFNESS, PoseSurface
from facegear.poses.tables import (
    PERCENT,
    REACTIONS,
    gear_reactions,
    hardest_mesh,
    leaving_text,
    load_tables,
    margin_text,
    mesh_table,
    with_margins,
)
from facegear.stages.outcome import Outcome
from facegear.stages.pose_surface import quantities
from facegear.transmission.machine import Machine
from facegear.transmission.static_gears import at_rest
from facegear.transmission.statics import mean_equilibrium


def operating_pose(
    surface: Arrays,
    pinion: Arrays,
    face_gear: Arrays,
    machine: Machine,
    tooth_pair: ToothPair,
    contact: Contact,
) -> Outcome:
    """Solve the contact at the pose of every mesh under its load.

    `meshes` tells how far each contact pattern stays from every edge. The arrays are the contact of the mesh
    that its pose changes most, in the form of stage contact's pressures; `check` compares them with the
    surface.

    Parameters
    ----------
    surface : Arrays
        Arrays of stage pose_surface.
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    machine : Machine
        The machine.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config.

    Returns
    -------
    Outcome
        Tables `meshes`, `loads`, `leaving` and `check`, arrays `as_assembled` and `running`.

    Raises
    ------
    InvalidInput
        For a pose outside the surface.
    NotConverged
        Where equilibrium or contact does not converge.
    """
    pose_surface = PoseSurface.of_arrays(surface)
    result = fixed_point(machine, pose_surface)
    before = mean_equilibrium(at_rest(machine)).forces[0]
    meshes = mesh_table(machine, pose_surface, result, before)
    loads, leaving_loads = load_tables(machine, pose_surface)
    worst = hardest_mesh(meshes)
    pair_here, plan = pair(tooth_pair), replace(contact_plan(contact), root_stress=False)
    design, pairs = pair_here.design, carrying_pairs(result, pair_here.design)
    worst_design = pairs.designs[pairs.numbers[worst]]
    rest = assembly_errors(machine, pose_surface, worst, bool(result.forces[worst] < 0.0))
    torque, torques = float(result.torque[worst]), [torque or plan.torques[0] for torque in pairs.torques]
    requests = [(replace(worst_design, assembly=rest), (torque or plan.torques[0],))]
    requests += [(design_at_pose, (at,)) for design_at_pose, at in zip(pairs.designs, torques, strict=True)]
    flanks = from_arrays(pinion), from_arrays(face_gear)
    assembled_there, *running = met_contacts(design, pair_here.materials, flanks, plan, requests)
    contacts = [assembled_there, running[pairs.numbers[worst]]]
    check = _check(
        pose_surface, result, worst, [_direct(design, flanks, posed_contact) for posed_contact in contacts]
    )
    margins = [
        pattern_margins(posed_contact.pressure, design_at_pose, at)
        for posed_contact, design_at_pose, at in zip(running, pairs.designs, torques, strict=True)
    ]
    known_margins = [None if margin is None else asdict(margin) for margin in margins]
    meshes = with_margins(meshes, [known_margins[number] for number in pairs.numbers])
    content = {
        "meshes": meshes,
        "loads": loads,
        "leaving": leaving_loads,
        "check": check,
        "as_assembled": contacts[0].pressure,
        "running": contacts[1].pressure,
    }
    return Outcome(content, _summary(meshes, leaving_loads, worst, result))


def _direct(
    design: PairDesign, flanks: tuple[GearFlank, GearFlank], posed_contact: PosedContact
) -> dict[str, AnyArray]:
    """Quantities of a surface, and REACTIONS of the touching loads."""
    table = posed_contact.reactions[list(REACTION_COLUMNS[1:])].to_numpy()
    return {**quantities(design, flanks, posed_contact), **dict(zip(REACTIONS, table.T, strict=True))}


def _check(
    surface: PoseSurface, result: OperatingPose, mesh: int, direct: list[dict[str, AnyArray]]
) -> pd.DataFrame:
    """Compare the surface at the pose of a mesh with the contact solved there, a row for each quantity.

    Reactions of the surface follow from its energy; beside them stand the reactions of the touching loads.
    """
    at = float(result.torque[mesh]), float(result.path[mesh]), float(result.angle[mesh])
    at_pose = {name: surface.at(name, *at) for name in surface.values if name in direct[1]}
    at_pose |= dict(zip(REACTIONS, gear_reactions(result, surface)[mesh].tolist(), strict=True))
    rows = [
        (name, value, float(direct[1][name][0]), float(direct[0][name][0])) for name, value in at_pose.items()
    ]
    table = pd.DataFrame(rows, columns=["quantity", "surface", "direct", "direct_as_assembled"])
    return table.assign(surface_error_percent=100.0 * (table["surface"] / table["direct"] - 1.0))


def _summary(meshes: pd.DataFrame, leaving_loads: pd.DataFrame, worst: int, result: OperatingPose) -> str:
    row = meshes.iloc[worst]
    text = (
        f"converged in {result.steps} steps; contact of {row['mesh']} at {row['unloaded_path_mm']:.2f} mm, "
        f"its stiffness changes by {row[PERCENT[STIFFNESS]]:.1f} %"
    )
    text = f"{text}; {margin_text(meshes)}"
    return f"{text}; {leaving_text(leaving_loads)}" if len(leaving_loads) else text
