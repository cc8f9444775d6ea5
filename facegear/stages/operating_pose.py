"""Where the machine's own forces put the teeth of every mesh, and what contact makes of it."""

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
    """`meshes`, `loads`, `leaving`, `check` (tables), `as_assembled` and `running` (arrays).

    Contact is solved at the pose of every mesh and its load: `meshes` has how far its pattern stays from
    every edge. The arrays are the contact of the mesh that its pose changes most, as stage contact has
    pressures; `check` compares them with the surface. Raises InvalidInput for a pose outside the surface,
    NotConverged.
    """
    known = PoseSurface.of_arrays(surface)
    result = fixed_point(machine, known)
    before = mean_equilibrium(at_rest(machine)).forces[0]
    meshes = mesh_table(machine, known, result, before)
    loads, leaving = load_tables(machine, known)
    worst = hardest_mesh(meshes)
    pair_here, plan = pair(tooth_pair), replace(contact_plan(contact), root_stress=False)
    design, pairs = pair_here.design, carrying_pairs(result, pair_here.design)
    own = pairs.designs[pairs.numbers[worst]]
    rest = assembly_errors(machine, known, worst, bool(result.forces[worst] < 0.0))
    torque, torques = float(result.torque[worst]), [torque or plan.torques[0] for torque in pairs.torques]
    asked = [(replace(own, assembly=rest), (torque or plan.torques[0],))]
    asked += [(met, (at,)) for met, at in zip(pairs.designs, torques, strict=True)]
    flanks = from_arrays(pinion), from_arrays(face_gear)
    assembled_there, *running = met_contacts(design, pair_here.materials, flanks, plan, asked)
    solved = [assembled_there, running[pairs.numbers[worst]]]
    check = _check(known, result, worst, [_direct(design, flanks, posed) for posed in solved])
    margins = [
        pattern_margins(posed.pressure, met, at)
        for posed, met, at in zip(running, pairs.designs, torques, strict=True)
    ]
    known_margins = [None if margin is None else asdict(margin) for margin in margins]
    meshes = with_margins(meshes, [known_margins[number] for number in pairs.numbers])
    content = {
        "meshes": meshes,
        "loads": loads,
        "leaving": leaving,
        "check": check,
        "as_assembled": solved[0].pressure,
        "running": solved[1].pressure,
    }
    return Outcome(content, _summary(meshes, leaving, worst, result))


def _direct(
    design: PairDesign, flanks: tuple[GearFlank, GearFlank], posed: PosedContact
) -> dict[str, AnyArray]:
    """Quantities of a surface, and REACTIONS of the touching loads."""
    table = posed.reactions[list(REACTION_COLUMNS[1:])].to_numpy()
    return {**quantities(design, flanks, posed), **dict(zip(REACTIONS, table.T, strict=True))}


def _check(
    surface: PoseSurface, result: OperatingPose, mesh: int, direct: list[dict[str, AnyArray]]
) -> pd.DataFrame:
    """The surface at the pose of a mesh beside the contact that was solved there, a row a quantity.

    Of reactions it is what the energy has, beside what the touching loads press with.
    """
    at = float(result.torque[mesh]), float(result.path[mesh]), float(result.angle[mesh])
    known = {name: surface.at(name, *at) for name in surface.values if name in direct[1]}
    known |= dict(zip(REACTIONS, gear_reactions(result, surface)[mesh].tolist(), strict=True))
    rows = [
        (name, value, float(direct[1][name][0]), float(direct[0][name][0])) for name, value in known.items()
    ]
    table = pd.DataFrame(rows, columns=["quantity", "surface", "direct", "direct_as_assembled"])
    return table.assign(surface_error_percent=100.0 * (table["surface"] / table["direct"] - 1.0))


def _summary(meshes: pd.DataFrame, leaving: pd.DataFrame, worst: int, result: OperatingPose) -> str:
    row = meshes.iloc[worst]
    text = (
        f"converged in {result.steps} steps; contact of {row['mesh']} at {row['unloaded_path_mm']:.2f} mm, "
        f"its stiffness changes by {row[PERCENT[STIFFNESS]]:.1f} %"
    )
    text = f"{text}; {margin_text(meshes)}"
    return f"{text}; {leaving_text(leaving)}" if len(leaving) else text
