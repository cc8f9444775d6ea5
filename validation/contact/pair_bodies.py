"""One tooth of each gear with its part of the body, cut out: the pair that every program is given.

The cut faces are held as the bore and the rim's back are, so that a tooth stands on a rigid neighbourhood.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.bodies.surface import gauges_on
from facegear.contact.gear_flank import BUILDERS
from facegear.contact.pressure import KERNEL
from facegear.contact.root_gauges import fillet_sides
from facegear.contact.teeth import LOADED_SIDE, contact_side
from facegear.strength.root_stress import down_the_fillet
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.placement import to_pinion_section
from facegear.teeth.tooth_mesh import FeTooth
from validation.contact.kratos import TwoBodies
from validation.contact.sector_model import angles_at
from validation.contact.stress_peer import ENDS

Body = Literal["pinion", "face_gear"]
FIXED_FACES = {
    "pinion": ("bore", "cut_left", "cut_right"),
    "face_gear": ("rim_back", "cut_left", "cut_right"),
}
"""Groups of faces that supports hold; the pinion's turn as one about its axis."""
REACH = 2.0
"""Largest gap of the faces that Kratos may close, in ways of the pinion's support along the normal. The edges
of the other body would cut faces farther away: slivers that make its condensed equations ill-conditioned."""
MIDDLE = 1 / 3
"""Part of the contact line at each end where pressures are not compared: there they rise towards the edge of
the pinion's face, which no element can give."""
ROUNDING = 1e-9
"""Part of the pinion's face by which a plane may lie outside."""
RING = ((0, 0), (1, 0), (1, 1), (0, 1))
"""Corners of a square cell in their order round it."""
OCTANTS = tuple((i, j, k) for k in (0, 1) for j in (0, 1) for i in (0, 1))
"""First corners of the eight cells that a 27-node hexahedron is cut into."""


@dataclass(frozen=True)
class PairBodies:
    """Pair at a position (0..1 of a pitch), meshed in `sizes`."""

    design: PairDesign
    sizes: MeshSizes
    materials: tuple[Material, Material]
    position: float

    @cached_property
    def teeth(self) -> dict[str, FeTooth]:
        return {body: build(self.design, self.sizes) for body, build in BUILDERS.items()}

    @property
    def angles(self) -> tuple[float, float]:
        """Angles of the unloaded pinion and gear, rad."""
        return angles_at(self.design, self.position)

    def node_positions(self, body: str) -> Array:
        """Return the nodes of a body in the pinion's frame, about whose y axis it turns.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`.

        Returns
        -------
        (n, 3) array
            Positions, m.
        """
        nodes = self.teeth[body].nodes
        if body == "pinion":
            return nodes
        phi1, phi2 = (np.array([angle]) for angle in self.angles)
        x, minus_z, y = to_pinion_section(self.design, phi1, phi2, np.zeros(1)).points(nodes)[0, 0].T
        return np.stack([x, y, -minus_z], axis=1)

    def linear(self, turn: float) -> TwoBodies:
        """Cut each 27-node hexahedron into eight of 8 nodes, and rotate the pinion's support.

        Parameters
        ----------
        turn : float
            Rotation of the support, rad.

        Returns
        -------
        TwoBodies
            Both bodies, in mm.
        """
        pinion, gear = self.teeth.values()
        count = len(pinion.nodes)
        nodes = 1e3 * np.concatenate([self.node_positions(body) for body in self.teeth])
        support_displacement = np.full(nodes.shape, np.nan)
        support_displacement[count + held_nodes(gear)] = 0.0
        rotating_nodes = held_nodes(pinion)
        x, _, z = nodes[rotating_nodes].T
        support_displacement[rotating_nodes] = np.stack([-turn * z, np.zeros_like(x), turn * x], axis=1)
        return TwoBodies(
            nodes=nodes,
            cubes=(_cut_cubes(pinion.hexes), count + _cut_cubes(gear.hexes)),
            faces=(_cut_faces(self.close_faces(turn)), count + _cut_faces(contact_faces(gear))),
            support_displacement=support_displacement,
            materials=self.materials,
        )

    def close_faces(self, turn: float) -> Integers:
        """Return the faces of the pinion that can touch under a rotation of its support.

        A node nearer to the gear than REACH times the way along the normal, in the unloaded pair, makes its
        face one of them.

        Parameters
        ----------
        turn : float
            Rotation of the support, rad.

        Returns
        -------
        (f, 9) array of int
            Indices of the nodes of each face.
        """
        pinion, gear = self.teeth.values()
        faces, points = contact_faces(pinion), self.node_positions("pinion")
        gear_points = self.node_positions("face_gear")[np.unique(contact_faces(gear))]
        normal = np.cross(
            points[faces[:, 5]] - points[faces[:, 3]], points[faces[:, 7]] - points[faces[:, 1]]
        )
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        way = np.stack([_nearest(gear_points, points[face]) - points[face] for face in faces])
        gap = np.einsum("fnk,fk->fn", way, normal)
        return np.asarray(faces[gap.min(axis=1) < REACH * turn * self.design.normal_arm])

    def root_stress(self, body: str, displacement: Array) -> float:
        """Return the largest tension down the fillet below the loaded flank; the ends of the face are left
        out.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`.
        displacement : (n, 3) array
            Displacements of the body in the pinion's frame, m.

        Returns
        -------
        float
            Stress, Pa.
        """
        tooth = self.teeth[body]
        grid = tooth.surfaces[f"fillet_{fillet_sides(tooth.body)[0]}"].nodes
        material = self.materials[list(self.teeth).index(body)]
        gauges = gauges_on(self.node_positions(body), grid, material)
        stress = (gauges.normal @ displacement.ravel()).reshape(gauges.position.shape[:2])
        return largest_inside(stress, along(body, gauges_on(tooth.nodes, grid, material).position))

    def is_in_middle(self, y: Array) -> Mask:
        """Mark the places along the pinion's axis at least MIDDLE of the contact line from both of its ends.

        The pinion's face is the narrower one, so that the line runs over all of it.

        Parameters
        ----------
        y : (...) array
            Places, m.

        Returns
        -------
        (...) array of bool
            True in the middle.
        """
        reach = (0.5 - MIDDLE + ROUNDING) * self.design.pinion.width
        return np.asarray(np.abs(y - self.design.middle) < reach)

    def largest_pressure(self, pressure: Array) -> float:
        """Return the largest pressure on the pinion's flank in the middle of the contact line, the tip edge
        left out.

        Of each plane its peak, averaged with its neighbours' as line loads are in
        `facegear.contact.pressure`: nodes in the corners and in the middle of a quadratic element alternate.

        Parameters
        ----------
        pressure : (n,) array
            Pressure of the nodes, Pa; nan where a program has no node.

        Returns
        -------
        float
            Pressure, Pa.
        """
        tooth = self.teeth["pinion"]
        grid = tooth.surfaces[f"flank_{LOADED_SIDE['pinion']}"].nodes[2:]
        points = tooth.nodes[grid]
        inside = self.is_in_middle(points[..., 1].mean(axis=0))
        way = np.linalg.norm(np.diff(points, axis=0, prepend=points[:1]), axis=-1).cumsum(axis=0)
        peaks = [peak_pressure(*plane) for plane in zip(way.T, pressure[grid].T, strict=True)]
        return float(np.convolve(peaks, KERNEL, "same")[inside].max())

    def contact_nodes(self) -> Array:
        """Return the positions of the nodes of the pinion that can touch.

        Returns
        -------
        (nu, nv, 3) array
            Positions, m.
        """
        tooth = self.teeth["pinion"]
        return np.asarray(tooth.nodes[contact_side(self.design, tooth).nodes])

    def path(self, pressure: Array) -> float:
        """Return the middle along the pinion's axis of the forces of a pressure at its nodes.

        Parameters
        ----------
        pressure : (n,) array
            Pressure of the nodes, Pa.

        Returns
        -------
        float
            Position, m.
        """
        points = self.contact_nodes()
        down, beside = (np.asarray(np.gradient(points, axis=axis)) for axis in (0, 1))
        areas = np.linalg.norm(np.cross(down, beside), axis=-1)
        at = contact_side(self.design, self.teeth["pinion"]).nodes
        return float(np.average(points[..., 1], weights=areas * pressure[at]))


def contact_faces(tooth: FeTooth) -> Integers:
    """Return the faces of flank and fillet that can touch.

    Parameters
    ----------
    tooth : FeTooth
        Mesh of the tooth.

    Returns
    -------
    (f, 9) array of int
        Indices of the nodes of each face.
    """
    side = LOADED_SIDE[tooth.body]
    return np.concatenate([tooth.faces[f"{name}_{side}"] for name in ("flank", "fillet")])


def peak_pressure(at: Array, pressure: Array) -> float:
    """Return the largest pressure of a plane across the strip of contact, between its nodes, too.

    In Hertz's contact the square of the pressure is a parabola: that through the largest node and its
    neighbours has its peak between them. Where a neighbour carries nothing, the largest node is returned.

    Parameters
    ----------
    at : (n,) array
        Places of the nodes across the strip, growing, m.
    pressure : (n,) array
        Pressure of the nodes, Pa; nan where a program has none.

    Returns
    -------
    float
        Pressure, Pa; 0 where no node carries any.
    """
    at, pressure = at[~np.isnan(pressure)], pressure[~np.isnan(pressure)]
    largest = int(np.argmax(pressure))
    three = slice(max(largest - 1, 0), largest + 2)
    if np.count_nonzero(pressure[three] > 0.0) < 3:
        return float(pressure[largest])
    curve, slope, middle = np.polyfit(at[three] - at[largest], pressure[three] ** 2, 2)
    return float(np.sqrt(middle - slope**2 / (4.0 * curve)))


def _nearest(points: Array, targets: Array) -> Array:
    """Return the point (m, 3), m, of many (n, 3) that is nearest to each target (m, 3)."""
    distance = np.linalg.norm(targets[:, None] - points, axis=-1)
    return np.asarray(points[np.argmin(distance, axis=1)])


def held_nodes(tooth: FeTooth) -> Integers:
    """Return the nodes that supports hold.

    Parameters
    ----------
    tooth : FeTooth
        Mesh of the tooth.

    Returns
    -------
    (n,) array of int
        Indices of the nodes.
    """
    return np.unique(np.concatenate([tooth.faces[name].ravel() for name in FIXED_FACES[tooth.body]]))


def along(body: str, points: Array) -> Array:
    """Return the position of points along the face.

    Parameters
    ----------
    body : str
        `pinion` or `face_gear`.
    points : (..., 3) array
        Points in the body's own frame, m.

    Returns
    -------
    (...) array
        Positions, m.
    """
    return points[..., 1] if body == "pinion" else np.hypot(points[..., 0], points[..., 1])


def largest_inside(stress: Array, at: Array) -> float:
    """Return the largest stress down a fillet, the ends of the face left out.

    Parameters
    ----------
    stress : (a, b) array
        Stress, Pa.
    at : (a, b) array
        Positions along the face, m.

    Returns
    -------
    float
        Stress, Pa.
    """
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
