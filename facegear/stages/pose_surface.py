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
    """`surface` (arrays), `nodes` and `errors` (tables).

    torque_n_m: at which the machine takes its mesh stiffness; tilting: whether its bodies tilt or bend.
    Raises NotConverged naming position and torque, FacegearError where teeth interfere.
    """
    teeth, plan = pair(tooth_pair), contact_plan(contact)
    design, flanks = teeth.design, (from_arrays(pinion), from_arrays(face_gear))
    numbers = PairNumbers.of_design(design)
    nodes = surface_nodes(numbers, design.assembly, plan.torques[-1], tilting)
    plan = replace(plan, torques=tuple(nodes.torques.tolist()))
    assemblies = nodes.assemblies(numbers)
    rows = [
        quantities(design, flanks, posed)
        for posed in posed_contacts(design, teeth.materials, flanks, plan, assemblies)
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
    """QUANTITIES that are known of one pose, (t,) each, in SI units. Raises FacegearError."""
    known = {
        STIFFNESS: _stiffness(design, posed),
        "ste_peak_to_peak_m": 1e-6 * posed.by_torque["ste_peak_to_peak_um"].to_numpy(),
        "pressure_pa": 1e6 * posed.by_torque["pressure_mpa"].to_numpy(),
        RADIUS: 1e-3 * posed.by_torque["path_radius_mm"].to_numpy(),
    }
    torques = posed.by_torque["torque_n_m"].to_numpy()
    for body, flank in zip(BODIES, flanks, strict=True):
        if flank.gauges is not None:
            largest = largest_tension(passing(body, flank, posed.loads))
            known[f"{body}_root_pa"] = np.array([largest(float(torque)) for torque in torques])
    return {name: known[name] for name in QUANTITIES if name in known and (known[name] > 0.0).all()}


def _stiffness(design: PairDesign, posed: PosedContact) -> Array:
    """Mean average stiffness (t,), from where flanks that go on beyond their ends would touch."""
    table = posed.ltca
    unloaded = 1e-6 * table["unloaded_ste_um"]
    exact = contact_at(PairNumbers.of_design(design), posed.errors)
    if exact is not None and without_modifications(design):
        unloaded = -exact.transmission_error
    force = table["torque_n_m"] / design.pinion_base_radius
    approach = 1e-6 * table["ste_um"] - unloaded
    if not (approach > 0.0).all():
        where = f"offset {1e6 * posed.errors.offset:.4g} um"
        raise FacegearError(f"pose_surface: there is no stiffness at {where}, as the teeth interfere")
    stiffness = force / approach
    return np.asarray(stiffness.groupby(table["torque_n_m"]).mean())


def node_table(nodes: Nodes, values: Mapping[str, Array], offsets: list[float]) -> pd.DataFrame:
    """One row a node."""
    angle, path, torque = np.meshgrid(nodes.angles, nodes.paths, nodes.torques, indexing="ij")
    known = {
        "shaft_angle_error_deg": np.degrees(angle).ravel(),
        "offset_um": np.repeat(1e6 * np.array(offsets), len(nodes.torques)),
        "unloaded_path_mm": 1e3 * path.ravel(),
        "torque_n_m": torque.ravel(),
    }
    return pd.DataFrame({**known, **{name: part.ravel() for name, part in values.items()}})


def error_table(surface: PoseSurface) -> pd.DataFrame:
    """What the surface misses at nodes that are left out, a row a quantity and coordinate."""
    rows = [
        (name, over, float(np.abs(missed).max()), float(np.sqrt(np.mean(missed**2))))
        for name in surface.values
        for over, missed in surface.left_out(name).items()
    ]
    return pd.DataFrame(rows, columns=["quantity", "left_out", "largest", "rms"])
