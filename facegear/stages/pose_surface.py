"""Contact of the pair over its pose: nodes of a response surface."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays
from facegear.config.contact import Contact, contact_plan
from facegear.config.tooth_pair import ToothPair, pair
from facegear.contact.gear_flank import GearFlank, from_arrays
from facegear.contact.posed import PosedContact, posed_contacts
from facegear.errors import FacegearError
from facegear.geometry.bodies import BODIES
from facegear.geometry.conjugate import PairNumbers, contact_at, without_modifications
from facegear.geometry.design import PairDesign
from facegear.number_format import count_noun
from facegear.poses.surface import QUANTITIES, RADIUS, STIFFNESS, Nodes, PoseSurface, surface_nodes
from facegear.stages.outcome import Outcome
from facegear.strength.passage import passing
from facegear.strength.root_stress import largest_tension


def pose_surface(
    pinion: Arrays,
    face_gear: Arrays,
    tooth_pair: ToothPair,
    contact: Contact,
    torque_n_m: float,
    tilting: bool,
) -> Outcome:
    """Solve the contact of the pair at every node of the pose surface.

    Parameters
    ----------
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config.
    torque_n_m : float
        Torque at which the machine takes its mesh stiffness, N m.
    tilting : bool
        Whether the machine's bodies tilt or bend.

    Returns
    -------
    Outcome
        Arrays `surface`, tables `nodes` and `errors`.

    Raises
    ------
    NotConverged
        Naming position and torque.
    FacegearError
        Where teeth interfere.
    """
    teeth, plan = pair(tooth_pair), contact_plan(contact)
    design, flanks = teeth.design, (from_arrays(pinion), from_arrays(face_gear))
    numbers = PairNumbers.of_design(design)
    nodes = surface_nodes(numbers, design.assembly, plan.torques[-1], tilting)
    plan = replace(plan, torques=tuple(nodes.torques.tolist()))
    assemblies = nodes.assemblies(numbers)
    rows = [
        quantities(design, flanks, posed_contact)
        for posed_contact in posed_contacts(design, teeth.materials, flanks, plan, assemblies)
    ]
    shape = len(nodes.angles), len(nodes.paths), len(nodes.torques)
    values = {name: np.array([row[name] for row in rows]).reshape(shape) for name in rows[0]}
    surface = PoseSurface(numbers, design.assembly, nodes, values, torque_n_m)
    errors = error_table(surface)
    worst = errors[errors["quantity"] == STIFFNESS]["largest"].max()
    summary = (
        f"{count_noun(len(assemblies), 'pose')}, paths {1e3 * nodes.paths[0]:.1f} to "
        f"{1e3 * nodes.paths[-1]:.1f} mm, up to "
        f"{nodes.torques[-1]:g} N m; stiffness misses a node that is left out by at most {100 * worst:.2g} %"
    )
    table = node_table(nodes, values, [errors.offset for errors in assemblies])
    return Outcome({"surface": surface.arrays, "nodes": table, "errors": errors}, summary)


def quantities(
    design: PairDesign, flanks: tuple[GearFlank, GearFlank], posed: PosedContact
) -> dict[str, Array]:
    """Return the QUANTITIES that are known of one pose.

    Parameters
    ----------
    design : PairDesign
        Design of the pair.
    flanks : tuple[GearFlank, GearFlank]
        Compliance of the pinion and of the face gear.
    posed : PosedContact
        Contact at the pose.

    Returns
    -------
    dict[str, Array]
        (torques,) each, by name, in SI units. A quantity that is not positive at every torque is left out.

    Raises
    ------
    FacegearError
        Where teeth interfere.
    """
    values = {
        STIFFNESS: _stiffness(design, posed),
        "ste_peak_to_peak_m": 1e-6 * posed.by_torque["ste_peak_to_peak_um"].to_numpy(),
        "pressure_pa": 1e6 * posed.by_torque["pressure_mpa"].to_numpy(),
        RADIUS: 1e-3 * posed.by_torque["path_radius_mm"].to_numpy(),
    }
    torques = posed.by_torque["torque_n_m"].to_numpy()
    for body, flank in zip(BODIES, flanks, strict=True):
        if flank.gauges is not None:
            largest = largest_tension(passing(body, flank, posed.loads))
            values[f"{body}_root_pa"] = np.array([largest(float(torque)) for torque in torques])
    return {name: values[name] for name in QUANTITIES if name in values and (values[name] > 0.0).all()}


def _stiffness(design: PairDesign, posed_contact: PosedContact) -> Array:
    """Mean average stiffness (t,), counted from the contact of flanks extended beyond their ends."""
    table = posed_contact.ltca
    unloaded_error = 1e-6 * table["unloaded_ste_um"]
    exact = contact_at(PairNumbers.of_design(design), posed_contact.errors)
    if exact is not None and without_modifications(design):
        unloaded_error = -exact.transmission_error
    force = table["torque_n_m"] / design.pinion_base_radius
    approach = 1e-6 * table["ste_um"] - unloaded_error
    if not (approach > 0.0).all():
        position = f"offset {1e6 * posed_contact.errors.offset:.4g} um"
        raise FacegearError(f"pose_surface: there is no stiffness at {position}, as the teeth interfere")
    stiffness = force / approach
    return np.asarray(stiffness.groupby(table["torque_n_m"]).mean())


def node_table(nodes: Nodes, values: Mapping[str, Array], offsets: list[float]) -> pd.DataFrame:
    """Tabulate the nodes.

    Parameters
    ----------
    nodes : Nodes
        Nodes of the surface.
    values : Mapping[str, Array]
        Values (angles, paths, torques) at the nodes by quantity, in SI units.
    offsets : list[float]
        Offset of each pose, um.

    Returns
    -------
    pd.DataFrame
        A row for each node.
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
    """Tabulate the error of the surface at nodes that are left out of it.

    Parameters
    ----------
    surface : PoseSurface
        The surface.

    Returns
    -------
    pd.DataFrame
        A row for each quantity and coordinate.
    """
    rows = [
        (name, over, float(np.abs(differences).max()), float(np.sqrt(np.mean(differences**2))))
        for name in surface.values
        for over, differences in surface.left_out(name).items()
    ]
    return pd.DataFrame(rows, columns=["quantity", "left_out", "largest", "rms"])
