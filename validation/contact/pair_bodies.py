"""One tooth of each gear with its part of the body, cut out: the pair that every program is given.

The cut faces are held as the bore and the rim's back are, so that a tooth stands on a rigid neighbourhood.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact.bodies.gauges import gauges_on
from facegear.contact.pair import BUILDERS
from facegear.contact.root_gauges import fillet_sides
from facegear.contact.teeth import LOADED_SIDE, contact_side
from facegear.geometry.design import Material, PairDesign
from facegear.geometry.placement import to_pinion_section
from facegear.mesh.sizes import MeshSizes
from facegear.mesh.tooth import FeTooth
from facegear.strength.root_stress import down_the_fillet
from validation.contact.kratos import TwoBodies
from validation.contact.sector_model import angles_at
from validation.contact.stress_peer import ENDS

Body = Literal["pinion", "face_gear"]
HELD = {"pinion": ("bore", "cut_left", "cut_right"), "face_gear": ("rim_back", "cut_left", "cut_right")}
"""Groups of faces that supports hold; the pinion's turn as one about its axis."""
RING = ((0, 0), (1, 0), (1, 1), (0, 1))
OCTANTS = tuple((i, j, k) for k in (0, 1) for j in (0, 1) for i in (0, 1))


@dataclass(frozen=True)
class PairBodies:
    """A pair at a position (0..1 of a pitch), meshed in `sizes`."""

    design: PairDesign
    sizes: MeshSizes
    materials: tuple[Material, Material]
    position: float

    @cached_property
    def teeth(self) -> dict[str, FeTooth]:
        return {body: build(self.design, self.sizes) for body, build in BUILDERS.items()}

    @property
    def angles(self) -> tuple[float, float]:
        """Of the unloaded pinion and gear, rad."""
        return angles_at(self.design, self.position)

    def placed(self, body: str) -> Array:
        """Nodes (n, 3) of a body in the pinion's frame, whose y axis it turns about, m."""
        nodes = self.teeth[body].nodes
        if body == "pinion":
            return nodes
        phi1, phi2 = (np.array([angle]) for angle in self.angles)
        x, minus_z, y = to_pinion_section(self.design, phi1, phi2, np.zeros(1)).points(nodes)[0, 0].T
        return np.stack([x, y, -minus_z], axis=1)

    def linear(self, turn: float) -> TwoBodies:
        """Each 27-node hexahedron cut into eight of 8 nodes, the pinion's support turned by `turn` (rad)."""
        pinion, gear = self.teeth.values()
        count = len(pinion.nodes)
        nodes = 1e3 * np.concatenate([self.placed(body) for body in self.teeth])
        moved = np.full(nodes.shape, np.nan)
        moved[count + held_nodes(gear)] = 0.0
        turned = held_nodes(pinion)
        x, _, z = nodes[turned].T
        moved[turned] = np.stack([-turn * z, np.zeros_like(x), turn * x], axis=1)
        return TwoBodies(
            nodes=nodes,
            cubes=(_cut_cubes(pinion.hexes), count + _cut_cubes(gear.hexes)),
            faces=(_cut_faces(contact_faces(pinion)), count + _cut_faces(contact_faces(gear))),
            moved=moved,
            materials=self.materials,
        )

    def root_stress(self, body: str, displacement: Array) -> float:
        """Largest tension (Pa) down the fillet below the loaded flank, by displacements (n, 3) m of the body
        as placed; the ends of the face are left out.
        """
        tooth = self.teeth[body]
        grid = tooth.surfaces[f"fillet_{fillet_sides(tooth.body)[0]}"].nodes
        material = self.materials[list(self.teeth).index(body)]
        gauges = gauges_on(self.placed(body), grid, material)
        stress = (gauges.normal @ displacement.ravel()).reshape(gauges.position.shape[:2])
        return largest_inside(stress, along(body, gauges_on(tooth.nodes, grid, material).position))

    def largest_pressure(self, pressure: Array) -> float:
        """Largest value (n,) at the nodes of the pinion's flank, tip edge and ends of the face left out."""
        tooth = self.teeth["pinion"]
        grid = tooth.surfaces[f"flank_{LOADED_SIDE['pinion']}"].nodes[2:]
        at = along("pinion", tooth.nodes[grid])
        inside = np.abs(at - at.mean()) < (0.5 - ENDS) * np.ptp(at)
        return float(pressure[grid[inside]].max())

    def contact_nodes(self) -> Array:
        """Places (nu, nv, 3) of the nodes of the pinion that can touch, m."""
        tooth = self.teeth["pinion"]
        return np.asarray(tooth.nodes[contact_side(self.design, tooth).nodes])

    def path(self, pressure: Array) -> float:
        """Middle (m) along the pinion's axis of the forces of a pressure (n,) at its nodes."""
        points = self.contact_nodes()
        down, beside = (np.asarray(np.gradient(points, axis=axis)) for axis in (0, 1))
        areas = np.linalg.norm(np.cross(down, beside), axis=-1)
        at = contact_side(self.design, self.teeth["pinion"]).nodes
        return float(np.average(points[..., 1], weights=areas * pressure[at]))


def contact_faces(tooth: FeTooth) -> Integers:
    """Faces (f, 9) of flank and fillet that can touch."""
    side = LOADED_SIDE[tooth.body]
    return np.concatenate([tooth.faces[f"{name}_{side}"] for name in ("flank", "fillet")])


def held_nodes(tooth: FeTooth) -> Integers:
    return np.unique(np.concatenate([tooth.faces[name].ravel() for name in HELD[tooth.body]]))


def along(body: str, points: Array) -> Array:
    """Where points (..., 3) of a body's own frame stand along the face, m."""
    return points[..., 1] if body == "pinion" else np.hypot(points[..., 0], points[..., 1])


def largest_inside(stress: Array, at: Array) -> float:
    """Largest of stress (a, b) down a fillet, at places (a, b) along the face but at its ends."""
    along = at.mean(axis=0)
    inside = np.abs(along - along.mean()) < (0.5 - ENDS) * np.ptp(along)
    return float(down_the_fillet(stress).max(axis=0)[inside].max())


def _cut_cubes(hexes: Integers) -> Integers:
    """Nodes (8 m, 8) of the linear hexahedra that 27-node ones (m, 27) are cut into."""
    corners = [[(a + i) + 3 * (b + j) + 9 * (c + k) for k in (0, 1) for i, j in RING] for a, b, c in OCTANTS]
    return np.asarray(hexes[:, corners].reshape(-1, 8))


def _cut_faces(faces: Integers) -> Integers:
    """Nodes (4 f, 4) of the faces that 9-node ones (f, 9) are cut into."""
    corners = [[(a + i) + 3 * (b + j) for i, j in RING] for b in (0, 1) for a in (0, 1)]
    return np.asarray(faces[:, corners].reshape(-1, 4))
