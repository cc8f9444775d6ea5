"""Contact side of a tooth mesh: loaded surface, its exact points, and supports of the body."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact.bodies.elements import ROUNDING, ElasticBody
from facegear.contact.bodies.surface import interpolation
from facegear.contact.options import Refinement
from facegear.teeth import face_gear, face_gear_fillet
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_quality import hex_mesh
from facegear.teeth.placement import mirror_design
from facegear.teeth.surfaces import SurfacePoints, fillet_points, flank_points
from facegear.teeth.tooth_mesh import FeTooth

LOADED_SIDE = {"pinion": "right", "face_gear": "left"}
"""Sides in contact when the pinion drives towards +x; the opposite flanks are the loaded ones of
`mirror_design`, seen in its mirror."""

FILLET_MARGIN = 0.1
"""Modules of fillet kept as contact surface beyond what the other gear's tip can reach."""


@dataclass(frozen=True, eq=False)
class ContactSide:
    """Contact surface of a tooth: flank rows, then the fillet rows the other gear's tip can reach.

    nodes, u, v: (nu, nv) nodes of the mesh and parameters as in `facegear.teeth.tooth_mesh.SurfaceGrid`;
    `flank_rows` of the rows belong to the flank, the last of them shared with the fillet, whose parameter
    there is `junction` (nv,).
    """

    nodes: Integers
    u: Array
    v: Array
    flank_rows: int
    junction: Array

    @property
    def shape(self) -> tuple[int, int]:
        """Nodes across the profile and along the width, before refinement."""
        return self.nodes.shape


def contact_side(design: PairDesign, tooth: FeTooth, side: str | None = None) -> ContactSide:
    """Return the surface of a tooth that can touch: its flank and the fillet rows that the other gear's
    tip can reach, with FILLET_MARGIN.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    tooth : FeTooth
        Mesh of the tooth.
    side : str, optional
        `left` or `right`; None takes the flank loaded when the pinion drives.

    Returns
    -------
    ContactSide
        Nodes and parameters of the surface.
    """
    side = side or LOADED_SIDE[tooth.body]
    flank, fillet = (tooth.surfaces[f"{name}_{side}"] for name in ("flank", "fillet"))
    points = tooth.nodes[fillet.nodes]
    reached_height = _reached_height(design, tooth.body, points)
    is_touched = (reached_height[:-1:2] > -FILLET_MARGIN * design.module).any(axis=1)
    elements = int(np.flatnonzero(is_touched).max() + 1) if is_touched.any() else 0
    rows = slice(1, 2 * elements + 1)
    return ContactSide(
        nodes=np.concatenate([flank.nodes, fillet.nodes[rows]]),
        u=np.concatenate([flank.u, fillet.u[rows]]),
        v=np.concatenate([flank.v, fillet.v[rows]]),
        flank_rows=len(flank.nodes),
        junction=fillet.u[0],
    )


def _reached_height(design: PairDesign, body: str, points: Array) -> Array:
    """Return how far (m) fillet points (..., 3) of a tooth, in its body frame, stand above the place that the
    other gear's tip surface reaches on the pitch line; negative below.
    """
    family = design.family
    if body == "pinion":
        tip_reach = design.pinion_pitch_radius - design.face_gear.addendum + family.shift(points[..., 1])
        return np.asarray(np.hypot(points[..., 0], points[..., 2]) - tip_reach)
    radius = np.hypot(points[..., 0], points[..., 1])
    # the pinion's tip is a meridian as the gear's tip is, deeper by both addenda
    depth = family.gear_tip.depth + design.face_gear.addendum + design.pinion.addendum
    return np.asarray(points[..., 2] - replace(family.gear_tip, depth=depth).height(radius))


def elastic_tooth(
    design: PairDesign, tooth: FeTooth, material: Material, side: str | None = None
) -> tuple[ElasticBody, ContactSide]:
    """Return the tooth as an elastic body, bore or rim back clamped, and its contact surface.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    tooth : FeTooth
        Mesh of the tooth.
    material : Material
        Of the tooth.
    side : str, optional
        `left` or `right`; None takes the flank loaded when the pinion drives.

    Returns
    -------
    tuple[ElasticBody, ContactSide]
        Body and surface.
    """
    side = side or LOADED_SIDE[tooth.body]
    surface = contact_side(design, tooth, side)
    rows = surface.flank_rows
    if side != LOADED_SIDE[tooth.body]:
        design = mirror_design(design)
    if tooth.body == "pinion":
        flank = flank_points(design, surface.u[:rows], surface.v[:rows]).normal
        fillet = fillet_points(design, surface.u[rows:], surface.v[rows:]).normal
    else:
        flank = face_gear.flank_normal(design, surface.u[:rows], surface.v[:rows])
        fillet = face_gear_fillet.fillet_normal(design, surface.v[rows:], surface.u[rows:])
    normals = np.concatenate([flank, fillet])
    if side == "left":
        normals = normals * np.array([-1.0, 1.0, 1.0])
    mesh, number = hex_mesh(tooth.nodes, tooth.hexes)
    is_held = np.zeros(tooth.nodes.shape, dtype=bool)
    is_held[number[tooth.faces["bore" if tooth.body == "pinion" else "rim_back"]]] = True
    mirror = np.zeros(len(tooth.nodes), dtype=np.int64)
    mirror[number] = number[_mirror_nodes(tooth)]
    body = ElasticBody(
        mesh=mesh,
        material=material,
        flank=number[surface.nodes],
        normals=normals,
        is_held=is_held,
        left=number[tooth.cut_left],
        right=number[tooth.cut_right],
        turn=tooth.rotated(np.eye(3), tooth.pitch).T,
        mirror=mirror if is_mirrored_across(tooth, tooth) else mirror[:0],
    )
    return body, surface


def _mirror_nodes(tooth: FeTooth) -> Integers:
    """Return for each node (N,) the number of its image in the plane as far from the other end of the
    face.
    """
    planes = tooth.surfaces["flank_right"].nodes.shape[1]
    return np.arange(len(tooth.nodes)).reshape(planes, -1)[::-1].ravel()


def is_mirrored_across(tooth: FeTooth, second_tooth: FeTooth) -> bool:
    """Tell whether a tooth is another one in a mirror across the middle of the face.

    A pinion without modifications is its own image if its teeth are spur ones; if they are helical, its image
    has the other hand.

    Parameters
    ----------
    tooth, second_tooth : FeTooth
        Meshes of two teeth of the same body.

    Returns
    -------
    bool
        True where all nodes are images of each other to rounding.
    """
    if tooth.nodes.shape != second_tooth.nodes.shape or tooth.hexes.shape != second_tooth.hexes.shape:
        return False
    image = second_tooth.nodes * np.array([1.0, -1.0, 1.0])
    image[:, 1] += second_tooth.nodes[:, 1].min() + second_tooth.nodes[:, 1].max()
    apart = np.abs(tooth.nodes[_mirror_nodes(tooth)] - image).max()
    return bool(apart <= ROUNDING * np.abs(image).max())


def pinion_points(
    design: PairDesign, side: ContactSide, refinement: Refinement, lattice: Array
) -> SurfacePoints:
    """Compute exact points of the pinion's surface, modifications included.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    side : ContactSide
        Contact surface of the pinion.
    refinement : Refinement
        Relates the lattice to the nodes of `side`.
    lattice : (n, 2) array
        Refined lattice coordinates, dimensionless.

    Returns
    -------
    SurfacePoints
        Points and normals (n, 3), m.
    """
    coarse = lattice / np.array([refinement.profile, refinement.width])
    weights = interpolation(coarse, side.shape)
    gamma = side.u.copy()
    gamma[side.flank_rows - 1] = side.junction
    u, v, gamma = (weights @ part.ravel() for part in (side.u, side.v, gamma))
    on_flank = coarse[:, 0] <= side.flank_rows - 1
    position, normal = np.empty((2, len(lattice), 3))
    for rows, points in (
        (on_flank, flank_points(design, u[on_flank], v[on_flank])),
        (~on_flank, fillet_points(design, gamma[~on_flank], v[~on_flank])),
    ):
        position[rows], normal[rows] = points.position, points.normal
    return SurfacePoints(position, normal)
