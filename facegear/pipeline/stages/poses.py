"""Stages of poses: contact over pose, and where forces put the teeth."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Array, Arrays
from facegear.build.plans import contact_plan
from facegear.build.tooth_pair import Pair, ToothPair, pair
from facegear.contact.analysis import PosedContact, met_contacts, posed_contacts
from facegear.contact.gear_flank import (
    GearFlank,
    PairFlanks,
    every_flank_from_arrays,
    flanks_of,
    gears_of,
)
from facegear.contact.nodal_loads import REACTION_COLUMNS
from facegear.contact.options import ContactPlan
from facegear.contact.pattern import pattern_margins
from facegear.errors import FacegearError
from facegear.machine.machine import Machine
from facegear.machine.poses.fixed_point import OperatingPose, carrying_pairs
from facegear.machine.poses.fixed_point import operating_pose as fixed_point
from facegear.machine.poses.posed_flanks import assembly_errors
from facegear.machine.poses.surface import QUANTITIES, RADIUS, STIFFNESS, Nodes, PoseSurface, surface_nodes
from facegear.machine.poses.tables import (
    PERCENT,
    REACTIONS,
    gear_reactions,
    hardest_mesh,
    leaving_text,
    load_tables,
    loaded_surfaces,
    margin_text,
    mesh_table,
    with_margins,
)
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import mean_equilibrium
from facegear.number_format import count_noun
from facegear.pipeline.outcome import Outcome
from facegear.quantities import BODIES
from facegear.schema.contact import Contact
from facegear.strength.passage import passing
from facegear.strength.root_stress import largest_tension
from facegear.teeth.conjugate import PairNumbers, contact_at, without_modifications
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.placement import FLANKS, GEARS, nominal_teeth, pair_at


def pose_surface(
    pinion: Arrays,
    face_gear: Arrays,
    tooth_pair: ToothPair,
    contact: Contact,
    torque_n_m: float,
    tilting: bool,
) -> Outcome:
    """Solve the loaded contact of the pair at every node of the pose surface.

    A pose of a mesh comes down to two numbers: the error of the shaft angle, and the path, which is the
    place of the unloaded contact along the pinion. The nodes are a grid of angles, paths and torques.
    At each angle and path the contact is solved at all torques over a pitch; later stages interpolate
    between the nodes. Flanks on other bodies than the upper gear's drive flank have surfaces of their own.

    Parameters
    ----------
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config; its largest torque is the last node of the torques.
    torque_n_m : float
        Torque at which the machine takes its mesh stiffness, N m.
    tilting : bool
        Whether bodies of the machine may tilt or bend; otherwise the shaft angle has one node.

    Returns
    -------
    Outcome
        Arrays `surface` (`PoseSurface.arrays`, SI units), table `nodes` (see `node_table`) and table
        `errors` (see `error_table`); where there are several surfaces, with columns `gear` and `flank` of the
        first flank that each is of.

    Raises
    ------
    NotConverged
        Naming position and torque.
    FacegearError
        Where teeth interfere.
    """
    teeth, plan = pair(tooth_pair), contact_plan(contact)
    flanks = list(zip(*map(every_flank_from_arrays, (pinion, face_gear)), strict=True))
    pairs, numbers = surface_pairs(teeth.design, gears_of(teeth.design, flanks), tilting)
    surfaces, nodes, errors = [], [], []
    for design in pairs.values():
        flank_surface, offsets = _solve_surface(teeth, design, flanks, plan, torque_n_m, tilting)
        surfaces.append(flank_surface)
        nodes.append(node_table(flank_surface.nodes, flank_surface.values, offsets))
        errors.append(error_table(flank_surface))
    first, *further = surfaces
    surface = replace(first, further=tuple(further), flank_numbers=numbers)
    worst = max(table[table["quantity"] == STIFFNESS]["largest"].max() for table in errors)
    poses = sum(one_surface.nodes.angles.size * one_surface.nodes.paths.size for one_surface in surfaces)
    lowest = min(one_surface.nodes.paths[0] for one_surface in surfaces)
    highest = max(one_surface.nodes.paths[-1] for one_surface in surfaces)
    summary = (
        f"{count_noun(poses, 'pose')}, paths {1e3 * lowest:.1f} to {1e3 * highest:.1f} mm, up to "
        f"{first.nodes.torques[-1]:g} N m; stiffness misses a node that is left out by at most "
        f"{100 * worst:.2g} %"
    )
    content = {
        "surface": surface.arrays,
        "nodes": _by_flank(list(pairs), nodes),
        "errors": _by_flank(list(pairs), errors),
    }
    return Outcome(content, summary)


def surface_pairs(
    design: PairDesign, gears: Sequence[str], tilting: bool = True
) -> tuple[dict[tuple[str, str], PairDesign], tuple[tuple[int, int], ...]]:
    """Return the pairs that have a pose surface of their own, and which of them each flank belongs to.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gears : Sequence[str]
        Gears that there are, of `upper` and `lower`; a missing one has the surfaces of the other.
    tilting : bool
        Whether bodies may tilt. Else a surface has the error of the shaft angle of its own gear alone, which
        the lower gear meets with the other sign.

    Returns
    -------
    tuple of dict and tuple
        Pairs by gear and flank, assembled as the first flank that needs them, that of the upper gear's drive
        flank first; their numbers for drive and back flank of both of GEARS.
    """
    pairs: dict[tuple[str, str], PairDesign] = {}
    number_of_teeth: dict[PairDesign, int] = {}
    numbers = []
    for gear in GEARS:
        present = gear if gear in gears else gears[0]
        for flank in FLANKS:
            pair_of_flank = pair_at(design, present, flank)
            teeth = nominal_teeth(pair_of_flank)
            if not tilting:
                errors = AssemblyErrors(shaft_angle_error=pair_of_flank.assembly.shaft_angle_error)
                teeth = replace(teeth, assembly=errors)
            if teeth not in number_of_teeth:
                number_of_teeth[teeth] = len(pairs)
                pairs[present, flank] = pair_of_flank
            numbers.append(number_of_teeth[teeth])
    return pairs, ((numbers[0], numbers[1]), (numbers[2], numbers[3]))


def _solve_surface(
    teeth: Pair,
    design: PairDesign,
    flanks: Sequence[PairFlanks],
    plan: ContactPlan,
    torque: float,
    tilting: bool,
) -> tuple[PoseSurface, list[float]]:
    """Return the surface of the drive flanks of a pair, and the offset of each pose, m.

    flanks: of `placement.nominal_pairs` of `teeth.design`; torque: reference torque, N m; tilting: whether
    bodies may tilt.
    """
    pair_flanks, numbers = flanks_of(design, teeth.design, flanks), PairNumbers.of_design(design)
    nodes = surface_nodes(numbers, design.assembly, plan.torques[-1], tilting)
    plan = replace(plan, torques=tuple(nodes.torques.tolist()))
    assemblies = nodes.assemblies(numbers, design.assembly.pinion_axial)
    rows = [
        quantities(design, pair_flanks, posed_contact)
        for posed_contact in posed_contacts(design, teeth.materials, pair_flanks, plan, assemblies)
    ]
    shape = len(nodes.angles), len(nodes.paths), len(nodes.torques)
    values = {name: np.array([row[name] for row in rows]).reshape(shape) for name in rows[0]}
    surface = PoseSurface(numbers, design.assembly, nodes, values, torque)
    return surface, [errors.offset for errors in assemblies]


def _by_flank(keys: list[tuple[str, str]], tables: list[pd.DataFrame]) -> pd.DataFrame:
    """Join the tables of several surfaces, with columns `gear` and `flank`; one alone stays as it is."""
    if len(tables) == 1:
        return tables[0]
    parts = []
    for (gear, flank), table in zip(keys, tables, strict=True):
        parts.append(table.assign(gear=gear, flank=flank)[["gear", "flank", *table.columns]])
    return pd.concat(parts, ignore_index=True)


def quantities(
    design: PairDesign, flanks: tuple[GearFlank, GearFlank], posed_contact: PosedContact
) -> dict[str, Array]:
    """Compute the QUANTITIES of the pose surface at one pose: stiffness, transmission error, pressure,
    radius, root stress.

    Stiffness is the mean of a pitch, transmission error its peak-to-peak value, pressure and root
    tension the largest of a pitch. Root stress is there for bodies whose fillets carry gauges.

    Parameters
    ----------
    design : PairDesign
        Design of the pair.
    flanks : tuple[GearFlank, GearFlank]
        Surface and compliance of the pinion's and of the face gear's flank.
    posed_contact : PosedContact
        Contact solved at the pose at t torques.

    Returns
    -------
    dict[str, Array]
        (t,) each, by name, in N/m, m and Pa. A quantity that is not positive at every torque is left
        out.

    Raises
    ------
    FacegearError
        Where teeth interfere.
    """
    values = {
        STIFFNESS: _stiffness(design, posed_contact),
        "ste_peak_to_peak_m": 1e-6 * posed_contact.by_torque["ste_peak_to_peak_um"].to_numpy(),
        "pressure_pa": 1e6 * posed_contact.by_torque["pressure_mpa"].to_numpy(),
        RADIUS: 1e-3 * posed_contact.by_torque["path_radius_mm"].to_numpy(),
    }
    torques = posed_contact.by_torque["torque_n_m"].to_numpy()
    for body, flank in zip(BODIES, flanks, strict=True):
        if flank.gauges is not None:
            largest = largest_tension(passing(body, flank, posed_contact.loads))
            values[f"{body}_root_pa"] = np.array([largest(float(torque)) for torque in torques])
    return {name: values[name] for name in QUANTITIES if name in values and (values[name] > 0.0).all()}


def _stiffness(design: PairDesign, posed_contact: PosedContact) -> Array:
    """Return the mean over a pitch of the average mesh stiffness at each torque (t,), N/m.

    It is force over approach. Force is torque over the base radius; approach is the loaded less the
    unloaded transmission error. For unmodified flanks the unloaded error is the closed form of flanks
    extended beyond the ends of the face; otherwise it is that of the contact table. Raises
    FacegearError where an approach is not positive.
    """
    table = posed_contact.ltca
    unloaded_error = 1e-6 * table["unloaded_ste_um"]
    exact = contact_at(PairNumbers.of_design(design), posed_contact.errors)
    if exact is not None and without_modifications(design):
        unloaded_error = -exact.transmission_error
    force = table["torque_n_m"] / design.normal_arm
    approach = 1e-6 * table["ste_um"] - unloaded_error
    if not (approach > 0.0).all():
        position = f"offset {1e6 * posed_contact.errors.offset:.4g} um"
        raise FacegearError(f"pose_surface: there is no stiffness at {position}, as the teeth interfere")
    stiffness = force / approach
    return np.asarray(stiffness.groupby(table["torque_n_m"]).mean())


def node_table(nodes: Nodes, values: Mapping[str, Array], offsets: list[float]) -> pd.DataFrame:
    """Tabulate the quantities at all poses and torques at which contact is solved for the pose surface.

    Parameters
    ----------
    nodes : Nodes
        Nodes of the surface.
    values : Mapping[str, Array]
        Values (angles, paths, torques) at the nodes by quantity, in SI units.
    offsets : list[float]
        Offset of each pose, m, angle by angle and path by path.

    Returns
    -------
    pd.DataFrame
        A row for each angle, path and torque (the torque changes fastest): shaft_angle_error_deg,
        offset_um, unloaded_path_mm, torque_n_m, then the quantities in SI units.
    """
    angle, path, torque = np.meshgrid(nodes.angles, nodes.paths, nodes.torques, indexing="ij")
    coordinates = {
        "shaft_angle_error_deg": np.degrees(angle).ravel(),
        "offset_um": np.repeat(1e6 * np.array(offsets), len(nodes.torques)),
        "unloaded_path_mm": 1e3 * path.ravel(),
        "torque_n_m": torque.ravel(),
    }
    return pd.DataFrame({**coordinates, **{name: part.ravel() for name, part in values.items()}})


def error_table(surface: PoseSurface) -> pd.DataFrame:
    """Tabulate the interpolation error of the surface: each inner node is left out and interpolated
    from the others.

    As the distance of nodes is doubled there, the errors bound those of the whole surface.

    Parameters
    ----------
    surface : PoseSurface
        The surface with its values at all nodes.

    Returns
    -------
    pd.DataFrame
        A row for each quantity and each coordinate (`left_out`: path or torque) along which a node was
        left out: `largest` and `rms` error, relative, but in m for the radius of the path.
    """
    rows = [
        (name, over, float(np.abs(differences).max()), float(np.sqrt(np.mean(differences**2))))
        for name in surface.values
        for over, differences in surface.left_out(name).items()
    ]
    return pd.DataFrame(rows, columns=["quantity", "left_out", "largest", "rms"])


def operating_pose(
    surface: Arrays,
    pinion: Arrays,
    face_gear: Arrays,
    machine: Machine,
    tooth_pair: ToothPair,
    contact: Contact,
) -> Outcome:
    """Find the pose of every mesh under the machine's mean torques, and solve the contact directly
    there.

    Pose and forces are a fixed point: forces displace the bodies, and displaced bodies change the mesh
    stiffness that the pose surface gives. The contact of every mesh is then solved once at its pose and
    torque, without root stress. This gives the distances of its pattern to every edge, and checks the
    surface for the mesh whose stiffness its pose changes most.

    Parameters
    ----------
    surface : Arrays
        Arrays of stage pose_surface.
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    machine : Machine
        The machine as assembled.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config.

    Returns
    -------
    Outcome
        Tables `meshes` (a row a mesh), `loads` (paths over fractions of the torques), `leaving`
        (contacts that leave the face) and `check` (the surface beside the direct contact).
        `OperatingPoseResult` describes their columns. Arrays `as_assembled` and `running` hold
        pressures of that one mesh in both positions, as PRESSURE_ARRAYS of stage contact.

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
    flanks = list(zip(*map(every_flank_from_arrays, (pinion, face_gear)), strict=True))
    assembled_there, *running = met_contacts(design, pair_here.materials, flanks, plan, requests)
    contacts = [assembled_there, running[pairs.numbers[worst]]]
    own_flanks = flanks_of(worst_design, design, flanks)
    check = _check(
        pose_surface,
        result,
        worst,
        [_direct(worst_design, own_flanks, posed_contact) for posed_contact in contacts],
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
    """Return the QUANTITIES and the REACTIONS of contact solved directly at one pose, (t,) each by
    name, in SI units.

    REACTIONS are forces and a moment of the touching loads on the gear (N, N m).
    """
    table = posed_contact.reactions[list(REACTION_COLUMNS[1:])].to_numpy()
    return {**quantities(design, flanks, posed_contact), **dict(zip(REACTIONS, table.T, strict=True))}


def _check(
    surface: PoseSurface, result: OperatingPose, mesh: int, direct: list[dict[str, AnyArray]]
) -> pd.DataFrame:
    """Compare the surface at the pose of one mesh with the contact that was solved there.

    `direct` holds the results of `_direct` as assembled, then at the pose, each at one torque. A row a
    quantity: quantity, surface, direct, direct_as_assembled (SI units) and surface_error_percent = 100
    (surface / direct - 1). Reactions of the surface are derivatives of its energy; the direct ones are
    sums of the touching loads.
    """
    at = float(result.torque[mesh]), float(result.path[mesh]), float(result.angle[mesh])
    loaded_surface = loaded_surfaces(result, surface)[mesh]
    at_pose = {name: loaded_surface.at(name, *at) for name in loaded_surface.values if name in direct[1]}
    at_pose |= dict(zip(REACTIONS, gear_reactions(result, surface)[mesh].tolist(), strict=True))
    rows = [
        (name, value, float(direct[1][name][0]), float(direct[0][name][0])) for name, value in at_pose.items()
    ]
    table = pd.DataFrame(rows, columns=["quantity", "surface", "direct", "direct_as_assembled"])
    return table.assign(surface_error_percent=100.0 * (table["surface"] / table["direct"] - 1.0))


def _summary(meshes: pd.DataFrame, leaving_loads: pd.DataFrame, worst: int, result: OperatingPose) -> str:
    """Say in one line how the search for the loaded position ended and which mesh it changes most."""
    row = meshes.iloc[worst]
    text = (
        f"converged in {count_noun(result.steps, 'step')}; contact of {row['mesh']} at "
        f"{row['unloaded_path_mm']:.2f} mm, "
        f"its stiffness changes by {row[PERCENT[STIFFNESS]]:.1f} %"
    )
    text = f"{text}; {margin_text(meshes)}"
    return f"{text}; {leaving_text(leaving_loads)}" if len(leaving_loads) else text
