"""Error of root stress from the distance of planes along the face, by a mesh with twice that distance.

A section of the tooth shows what the mesh misses across the profile (`facegear.contact.section_error`). It
does not show how contact is spread over the planes along the face, nor how they follow the stress to a sharp
end.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from facegear.arrays import Array
from facegear.contact.gear_flank import GearFlank
from facegear.contact.ltca import loaded_contact
from facegear.contact.nodal_loads import load_arrays
from facegear.contact.options import ContactPlan
from facegear.contact.pair import contact_model, gear_flank
from facegear.geometry.bodies import BODIES, Body
from facegear.geometry.design import Material, PairDesign
from facegear.mesh.sizes import MeshSizes
from facegear.strength.passage import passing
from facegear.strength.root_stress import RootStress, down_the_fillet

ORDER, SAFETY = 2.0, 1.25
"""Power of the distance that the error goes with, and factor of the grid convergence index (Roache 1994)."""
NEAR = 0.9
"""Part of the largest stress from which on a place along the face counts: the largest may lie there."""


def coarser_roots(
    design: PairDesign,
    materials: Mapping[Body, Material],
    sizes: MeshSizes,
    plan: ContactPlan,
    roots: Mapping[Body, RootStress],
) -> dict[Body, RootStress]:
    """Solve root stress with twice the distance of planes along the face.

    At the smallest and the largest torque, and the positions where stress is largest at either.

    Parameters
    ----------
    design : PairDesign
        The pair that is in contact.
    materials : Mapping[Body, Material]
        Material of each body.
    sizes : MeshSizes
        Mesh sizes that `roots` are from.
    plan : ContactPlan
        Contact analysis that `roots` are from.
    roots : Mapping[Body, RootStress]
        Root stress of each body.

    Returns
    -------
    dict[Body, RootStress]
        Root stress of each body by the coarser mesh.

    Raises
    ------
    NotConverged
        Where the contact of the coarser mesh is not solved.
    """
    wide = replace(sizes, width=2.0 * sizes.width)
    flanks: dict[Body, GearFlank] = {
        body: gear_flank(design, body, wide, materials[body], plan, section=False) for body in BODIES
    }
    torques = sorted({float(ends) for root in roots.values() for ends in root.torques[[0, -1]]})
    positions = sorted({position for root in roots.values() for position in _worst_positions(root)})
    model = contact_model(design, flanks["pinion"], flanks["face_gear"])
    results = loaded_contact(model, positions, torques, plan.options)
    loads = load_arrays([results], np.zeros((2, 2), dtype=np.int64))
    return {body: passing(body, flank, loads) for body, flank in flanks.items()}


def face_error(root: RootStress, coarser: RootStress) -> float:
    """Estimate the relative error of the largest tension by Richardson's rule.

    The difference at the places where stress is near its largest counts, not that of the largest values:
    these lie at gauges, which stand elsewhere on another mesh, and may agree by chance.

    Parameters
    ----------
    root : RootStress
        Root stress by the mesh whose error is estimated.
    coarser : RootStress
        Root stress with twice the distance of planes along the face.

    Returns
    -------
    float
        Error, relative; nan where the face has too few elements for planes twice as far apart.
    """
    if coarser.along.size >= root.along.size:
        return float("nan")
    within = np.isin(_positions(root), _positions(coarser))
    largest = 0.0
    for row, torque in enumerate(coarser.torques):
        at = int(np.argmin(np.abs(root.torques - torque)))
        fine = _along_face(root.stress[at, within])
        coarse = np.interp(root.along, coarser.along, _along_face(coarser.stress[row]))
        inside = (root.along >= coarser.along[0]) & (root.along <= coarser.along[-1])
        near = (fine >= NEAR * fine.max()) & inside
        largest = max(largest, float(np.abs(coarse - fine).max(where=near, initial=0.0) / fine.max()))
    return SAFETY * largest / (2.0**ORDER - 1.0)


def _along_face(stress: Array) -> Array:
    """Largest tension (b,) below the loaded flank of stress (n, 2, a, b) over a passage."""
    return np.asarray(down_the_fillet(stress[:, 0]).max(axis=(0, 1)))


def _positions(root: RootStress) -> Array:
    """Position (n,) in the pitch of each place of the passage."""
    return np.round(root.passage % 1.0, 9)


def _worst_positions(root: RootStress) -> set[float]:
    """Positions in the pitch where tension is largest at the smallest and at the largest torque."""
    worst = {int(root.stress[row, :, 0].max(axis=(1, 2)).argmax()) for row in (0, -1)}
    return {float(_positions(root)[index]) for index in worst}
