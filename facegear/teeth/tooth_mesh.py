"""One tooth of either body as 27-node hexahedra on the exact surface, to be repeated around the gear."""

from dataclasses import dataclass
from math import pi

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.errors import GeometryError
from facegear.teeth.design import PairDesign
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.placement import body_rotation
from facegear.teeth.section_mesh import SectionPlan, plan_section, section_nodes, segment_fractions
from facegear.teeth.section_outline import LEFT, RIGHT, Outline


@dataclass(frozen=True)
class SurfaceGrid:
    """Nodes of a flank or fillet, (n_profile, n_width), tip to root and along the width, mid nodes included.

    u, v are the parameters of the exact surface: pinion flank: roll angle (rad) and y (m); pinion fillet:
    gamma (rad) and y; gear flank: roll th and psi (rad); gear fillet: psi (rad), gear radius (m). On the
    drive side (pinion right, gear left) they are those of the functions of the design, on the other side
    those of the functions of its `placement.mirror_teeth`. Every second node in each direction, from the
    first, is a corner.
    """

    nodes: Integers
    u: Array
    v: Array


@dataclass(frozen=True)
class FeTooth:
    """Tooth 0 with its share of the body, from cut face to cut face, in the frame of `facegear.teeth.design`.

    Attributes
    ----------
    body, teeth
        Which body, and its number of teeth.
    nodes : (N, 3)
        m.
    hexes : (M, 27)
        Node i + 3 j + 9 k at local (i/2, j/2, k/2), right handed; the eight corners are `hexes[:, CORNERS]`.
    faces
        Named (F, 9) boundary faces, node i + 3 j, normals outward: flank_left/right, fillet_left/right,
        root_land_left/right, tip, end_inner, end_outer, cut_left/right and bore or rim_back.
    surfaces
        flank_left/right and fillet_left/right as grids.
    cut_left, cut_right
        cut_left[i] turned by one pitch is cut_right[i].
    """

    body: str
    teeth: int
    nodes: Array
    hexes: Integers
    faces: dict[str, Integers]
    surfaces: dict[str, SurfaceGrid]
    cut_left: Integers
    cut_right: Integers

    @property
    def pitch(self) -> float:
        """Angular pitch (rad)."""
        return 2 * pi / self.teeth

    def rotated(self, points: Array, angle: float) -> Array:
        """Rotate points or vectors about the body's axis by an angle.

        Parameters
        ----------
        points : (..., 3) array
            m, or any unit.
        angle : float
            rad, positive as in `facegear.teeth.design`.

        Returns
        -------
        (..., 3) array
            Same unit.
        """
        return points @ body_rotation(self.body, angle).T


CORNERS = np.array([0, 2, 6, 8, 18, 20, 24, 26])
"""Columns of `hexes` of the corners (i, j, k) = (0,0,0), (1,0,0), (0,1,0), (1,1,0), (0,0,1), ..."""


def pinion_tooth(design: PairDesign, sizes: MeshSizes) -> FeTooth:
    """Build the mesh of one pinion tooth, section by section across its axis.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    sizes : MeshSizes
        Element sizes.

    Returns
    -------
    FeTooth
        Mesh of the tooth.
    """
    half = design.pinion.width / 2
    return _tooth(design, "pinion", sizes, design.middle - half, design.middle + half)


def gear_tooth(design: PairDesign, sizes: MeshSizes) -> FeTooth:
    """Build the mesh of one face gear tooth from the inner to the outer cylinder.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    sizes : MeshSizes
        Element sizes.

    Returns
    -------
    FeTooth
        Mesh of the tooth.
    """
    return _tooth(design, "face_gear", sizes, design.face_gear.inner_radius, design.face_gear.outer_radius)


def _tooth(design: PairDesign, body: str, sizes: MeshSizes, start: float, end: float) -> FeTooth:
    """Build the finite elements of one tooth of a body between two ends (m: y of the pinion, gear radius)."""
    layers = max(2, round((end - start) / sizes.width))
    outline = Outline(design, body, np.linspace(start, end, 2 * layers + 1))
    plan = plan_section(outline, sizes)
    half = plan.half
    (angle, height), (left_angle, left_height) = _both_halves(outline, plan)

    wall, _ = half.columns
    on_axis = ((half.t == 1) & (half.sigma <= wall)) | ((half.t > 1) & (half.sigma == wall))
    mirror = np.arange(len(half.t))
    mirror[~on_axis] = len(half.t) + np.arange(np.count_nonzero(~on_axis))
    angle = np.concatenate([angle, -left_angle[~on_axis]])
    height = np.concatenate([height, left_height[~on_axis]])
    points = outline.cartesian(angle, height)

    # sigma down the flank, t inwards, width along y: right handed for the gear's right half (x, z) only
    right, left = half.quads, mirror[_transpose_grid(half.quads)]
    if body == "pinion":
        right, left = _transpose_grid(right), mirror[half.quads]
    quads = np.concatenate([right, left])
    count = len(angle)
    hexes = _extruded(quads, layers, count)
    nodes = points.transpose(1, 0, 2).reshape(-1, 3)

    teeth = design.pinion.teeth if body == "pinion" else design.face_gear.teeth
    edges = _boundary_edges(plan, mirror, "bore" if body == "pinion" else "rim_back")
    centre = nodes[hexes[:, 13]]
    faces = {name: _extruded_edges(edge, layers, count) for name, edge in edges.items()}
    faces["end_inner"], faces["end_outer"] = quads.copy(), quads + 2 * layers * count
    owners = {"end_inner": centre[: len(quads)], "end_outer": centre[-len(quads) :]}
    faces = {name: _outward(nodes, face, owners.get(name), centre, hexes) for name, face in faces.items()}
    cut = np.flatnonzero(half.sigma == half.sigma.max())
    planes = count * np.arange(2 * layers + 1)
    return FeTooth(
        body=body,
        teeth=teeth,
        nodes=nodes,
        hexes=hexes,
        faces=faces,
        surfaces=_surfaces(outline, plan, mirror, planes),
        cut_left=(mirror[cut][:, None] + planes).ravel(),
        cut_right=(cut[:, None] + planes).ravel(),
    )


def _both_halves(outline: Outline, plan: SectionPlan) -> list[tuple[Array, Array]]:
    """Return angle (rad) and height (m), (nodes, planes), of the right and the left half section, each in
    the frame in which it stands on the right; computed once where both are mirror images.
    """
    right = section_nodes(outline, plan, RIGHT)
    return [right, right if outline.design.is_symmetric else section_nodes(outline, plan, LEFT)]


def _transpose_grid(quads: Integers) -> Integers:
    """Exchange the two local axes of nine-node quadrilaterals (n, 9), which reverses their normals."""
    return quads.reshape(-1, 3, 3).transpose(0, 2, 1).reshape(-1, 9)


def _extruded(quads: Integers, layers: int, count: int) -> Integers:
    """Return 27-node elements (layers n, 27) from quadrilaterals (n, 9) of a section of `count` nodes."""
    offsets = count * (2 * np.arange(layers)[:, None] + np.arange(3))
    return (quads[None, :, None, :] + offsets[:, None, :, None]).reshape(-1, 27)


def _extruded_edges(edges: Integers, layers: int, count: int) -> Integers:
    """Return quadrilaterals (layers n, 9) from edges (n, 3) of a section of `count` nodes."""
    offsets = count * (2 * np.arange(layers)[:, None] + np.arange(3))
    return (edges[None, :, None, :] + offsets[:, None, :, None]).reshape(-1, 9)


def _boundary_edges(plan: SectionPlan, mirror: Integers, back: str) -> dict[str, Integers]:
    """Return boundary edges (n, 3) of the whole section by group: `flank_right`, `tip`, ... and `back`.

    `mirror` gives the left node of each node of the right half.
    """
    half = plan.half
    sides = half.quads[:, [[0, 1, 2], [0, 3, 6], [6, 7, 8], [2, 5, 8]]].reshape(-1, 3)
    sigma, t = half.sigma[sides], half.t[sides]
    last = half.sigma.max()

    def between(name: str) -> Mask:
        """Return the mask of edges at the surface within a segment of the outline."""
        low, high = plan.breaks[name]
        return (t == 0).all(axis=1) & (sigma >= low - 1e-12).all(axis=1) & (sigma <= high + 1e-12).all(axis=1)

    halves = {
        "flank": between("flank"),
        "fillet": between("fillet_upper") | between("fillet_lower"),
        "root_land": between("root_land"),
        "cut": (sigma == last).all(axis=1),
    }
    groups = {f"{name}_right": sides[mask] for name, mask in halves.items()}
    groups |= {f"{name}_left": mirror[sides[mask]] for name, mask in halves.items()}
    directions = {"tip": (sigma == 0).all(axis=1) | between("chamfer"), back: (t == 2).all(axis=1)}
    return groups | {n: np.concatenate([sides[mask], mirror[sides[mask]]]) for n, mask in directions.items()}


def _outward(nodes: Array, faces: Integers, owner: Array | None, centre: Array, hexes: Integers) -> Integers:
    """Return faces (n, 9), turned over where needed so that their normals point out of their element.

    owner: centres (n, 3) of these elements, m, if known; None looks for them by the faces' middle nodes among
    `hexes`, whose centres (m, 3) are `centre`.
    """
    if owner is None:
        face_of = {int(node): i for i, node in enumerate(faces[:, 4])}
        rows, columns = np.nonzero(np.isin(hexes[:, [4, 10, 12, 14, 16, 22]], faces[:, 4]))
        owner = np.empty((len(faces), 3))
        for row, column in zip(rows, columns, strict=True):
            owner[face_of[int(hexes[row, [4, 10, 12, 14, 16, 22][column]])]] = centre[row]
    along, across = nodes[faces[:, 5]] - nodes[faces[:, 3]], nodes[faces[:, 7]] - nodes[faces[:, 1]]
    out = np.sum(np.cross(along, across) * (nodes[faces[:, 4]] - owner), axis=1) > 0
    return np.where(out[:, None], faces, _transpose_grid(faces))


def _surfaces(
    outline: Outline, plan: SectionPlan, mirror: Integers, planes: Integers
) -> dict[str, SurfaceGrid]:
    """Return the grids of nodes on flank and fillet of both sides with their surface parameters.

    `mirror`: left node of each right one; `planes`: what is added to a section's node for each plane.
    """
    half = plan.half
    surface = np.flatnonzero(half.t == 0)
    surface = surface[np.argsort(half.sigma[surface])]
    fractions = segment_fractions(plan, half.sigma[surface])
    grids = {}
    for name in ("flank", "fillet"):
        on, fraction = fractions[name]
        section = surface[on]
        for number, side, numbers in ((RIGHT, "right", section), (LEFT, "left", mirror[section])):
            exact = outline.sides[number]
            parameters = exact.flank_parameters if name == "flank" else exact.fillet_parameters
            grids[f"{name}_{side}"] = SurfaceGrid(numbers[:, None] + planes, *parameters(fraction))
    return grids


@dataclass(frozen=True)
class SectorMesh:
    """Merged copies of one tooth in the body frame.

    nodes: (N, 3) m; hexes: (M, 27) ordered as in `FeTooth`, tooth after tooth.
    tooth_nodes: (n_teeth, nodes of one tooth) global node of each copy's node; tooth j stands at j pitches.
    first: index j of the first tooth; closed: whether the sector is the full ring.
    """

    tooth: FeTooth
    nodes: Array
    hexes: Integers
    tooth_nodes: Integers
    first: int
    is_closed: bool

    def faces(self, name: str) -> Integers:
        """Return the boundary faces of a group over all teeth; cut faces only where the sector ends.

        Parameters
        ----------
        name : str
            Name of the group, see `FeTooth.faces`.

        Returns
        -------
        (F, 9) array of int
            Nodes of each face.

        Raises
        ------
        KeyError
            For a group that the tooth does not have.
        """
        if name in ("cut_left", "cut_right"):
            if self.is_closed:
                return np.empty((0, 9), dtype=np.int64)
            return self.tooth_nodes[0 if name == "cut_left" else -1][self.tooth.faces[name]]
        return self.tooth_nodes[:, self.tooth.faces[name]].reshape(-1, 9)


def sector(tooth: FeTooth, n_teeth: int, first: int = 0) -> SectorMesh:
    """Join teeth first .. first + n_teeth - 1 with shared nodes on the cuts; the full ring closes on itself.

    Parameters
    ----------
    tooth : FeTooth
        Mesh of a tooth.
    n_teeth : int
        Number of teeth.
    first : int
        Index of the first tooth.

    Returns
    -------
    SectorMesh
        Joined teeth in the body frame, tooth j turned by j pitches.

    Raises
    ------
    GeometryError
        When n_teeth is not within 1 .. number of teeth.
    """
    if not 1 <= n_teeth <= tooth.teeth:
        raise GeometryError("teeth in the sector", n_teeth, f"between 1 and {tooth.teeth}")
    is_closed = n_teeth == tooth.teeth
    count = len(tooth.nodes)
    is_new_node = np.ones(count, dtype=bool)
    is_new_node[tooth.cut_left] = False
    new = int(np.count_nonzero(is_new_node))

    tooth_nodes = np.empty((n_teeth, count), dtype=np.int64)
    tooth_nodes[0] = np.arange(count)
    for j in range(1, n_teeth):
        tooth_nodes[j, is_new_node] = count + (j - 1) * new + np.arange(new)
        tooth_nodes[j, tooth.cut_left] = tooth_nodes[j - 1, tooth.cut_right]
    total = count + (n_teeth - 1) * new
    if is_closed and n_teeth > 1:
        renumber = np.arange(total)
        renumber[tooth_nodes[-1, tooth.cut_right]] = tooth_nodes[0, tooth.cut_left]
        kept_nodes = np.unique(renumber)
        tooth_nodes = np.searchsorted(kept_nodes, renumber[tooth_nodes])
        total = len(kept_nodes)

    nodes = np.empty((total, 3))
    for j in range(n_teeth - 1, -1, -1):
        nodes[tooth_nodes[j]] = tooth.rotated(tooth.nodes, (first + j) * tooth.pitch)
    return SectorMesh(
        tooth=tooth,
        nodes=nodes,
        hexes=tooth_nodes[:, tooth.hexes].reshape(-1, 27),
        tooth_nodes=tooth_nodes,
        first=first,
        is_closed=is_closed,
    )
