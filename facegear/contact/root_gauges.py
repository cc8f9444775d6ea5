"""Gauges on both fillets of a tooth, and the error of root stress on its mesh.

Error of root stress on a tooth's mesh, measured in plane strain against a mesh several times finer. A section
of the tooth with its neighbours is loaded by line forces at several heights of the flank. The error of the
section's mesh is taken for the error of the body's mesh: the two agree within 0.3 % on the paper's pinion
(docs/explanation/strength.md). The error includes neither the transfer of loads to the nodes nor the distance
of planes along the face.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import CubicSpline
from skfem import Basis, ElementQuad2, MeshQuad2

from facegear.arrays import Array, Integers
from facegear.contact.bodies.elements import element_stiffness
from facegear.contact.bodies.surface import Gauges, gauge_coordinates, gauges_on
from facegear.contact.teeth import LOADED_SIDE
from facegear.sparse.matrices import solve_sparse
from facegear.teeth.curvature import smallest_radius
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_quality import hex_mesh
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.tooth_mesh import FeTooth

Builder = Callable[[PairDesign, MeshSizes], FeTooth]

HEIGHTS = (0.05, 0.25, 0.5, 0.75, 0.9)
"""Heights of the loads on the flank, 0 at its tip end to 1 at its root end."""
FINER, FINER_INSIDE = 6.0, 4.0
"""Factors by which the reference mesh is finer, at the surface and inside."""
ACROSS_RADIUS = 0.5
"""Largest element size of the reference mesh over the fillet's smallest radius."""
FINE = 8
"""Points a gauge at which a maximum down the fillet is searched."""
TEETH = {"pinion": 5, "face_gear": 3}
"""Number of teeth in the section of each body, its ends free: two more change the error by less than a
thirtieth."""
QUAD = np.array([0, 2, 8, 6, 1, 5, 7, 3, 4])
"""Nodes of a quadrilateral, i + 3 j, in the order of `ElementQuad2`."""


@dataclass(frozen=True, eq=False)
class SectionErrors:
    """Relative error of the largest tension (n,), never negative, in planes at `along` (n,) m."""

    along: Array
    error: Array

    def at(self, along: Array) -> Array:
        """Interpolate the error linearly between the planes.

        Parameters
        ----------
        along : (b,) array
            Positions along the face, m.

        Returns
        -------
        (b,) array
            Error, relative.
        """
        return np.interp(along, self.along, self.error)


def section_errors(
    design: PairDesign, body: str, build: Builder, sizes: MeshSizes, material: Material
) -> SectionErrors:
    """Estimate the relative root-stress error of a body's mesh, by plane sections of the mesh and of a
    finer one.

    It is the largest abs(tension / reference - 1) of line loads at HEIGHTS, in the middle plane of the
    pinion or in five planes of the gear: both meshes are built with two elements along the face for it.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    body : str
        `pinion` or `face_gear`.
    build : Builder
        Function that makes the tooth's mesh from design and sizes.
    sizes : MeshSizes
        Element sizes of the mesh.
    material : Material
        Of the body.

    Returns
    -------
    SectionErrors
        Relative error by position along the face, m.
    """
    finest = min(sizes.profile / FINER, ACROSS_RADIUS * smallest_radius(design, body))
    full_width = {"width": np.inf}
    body_tooth = build(design, replace(sizes, **full_width))
    finer = build(design, MeshSizes(finest, np.inf, sizes.thickness / FINER_INSIDE))
    count = body_tooth.surfaces["fillet_right"].nodes.shape[1]
    planes = (count // 2,) if body == "pinion" else range(count)
    error, along = [], []
    for plane in planes:
        tension, reference = (_tensions(tooth, plane, material) for tooth in (body_tooth, finer))
        error.append(np.abs(tension / reference - 1.0).max())
        along.append(_section(body_tooth, plane)[1])
    return SectionErrors(np.array(along), np.array(error))


def _section(tooth: FeTooth, plane: int) -> tuple[Array, float]:
    """Return the points (n, 2) of one plane of a tooth, m, and its position along the face, m.

    A pinion's plane has points (x, z) at the position y. A gear's plane is a cylinder, laid flat: points
    (radius times angle from the tooth's middle, z) at the radius.
    """
    count = int(np.ptp(tooth.surfaces["fillet_right"].nodes[0, :2]))
    points = tooth.nodes[count * plane : count * (plane + 1)]
    if tooth.body == "pinion":
        return points[:, [0, 2]], float(points[0, 1])
    radius = float(np.hypot(points[0, 0], points[0, 1]))
    angle = np.arctan2(points[:, 0], points[:, 1])
    return np.stack([radius * angle, points[:, 2]], axis=1), radius


def _beside(tooth: FeTooth, points: Array, pitches: int, radius: float) -> Array:
    """Return the points (n, 2), m, of the tooth that is `pitches` further, of a plane as `_section` gives
    it.

    A pinion's points are rotated, a gear's are shifted along the first axis by `radius` (m) times the
    angle.
    """
    angle = pitches * tooth.pitch
    if tooth.body == "face_gear":
        return points + np.array([radius * angle, 0.0])
    points_3d = np.stack([points[:, 0], np.zeros(len(points)), points[:, 1]], axis=1)
    return tooth.rotated(points_3d, angle)[:, [0, 2]]


def _tensions(tooth: FeTooth, plane: int, material: Material) -> Array:
    """Return the largest tension (5,), Pa, of the fillet below the loaded flank for line loads of 1 N/m
    at HEIGHTS.

    Plane strain in plane number `plane` of the mesh, with TEETH teeth in a row and bore or rim back
    fixed. The flank of the middle tooth that meshes when the pinion drives is loaded along its inward normal.
    """
    points, at = _section(tooth, plane)
    count = len(points)
    quads = tooth.hexes[(tooth.hexes < 3 * count).all(axis=1), :9]
    teeth = TEETH[tooth.body]
    tooth_offsets = range(-(teeth // 2), teeth // 2 + 1)
    copies = np.concatenate([_beside(tooth, points, pitches, at) for pitches in tooth_offsets])
    number = _merge_nodes(tooth, count, teeth)
    nodes = np.empty((number.max() + 1, 2))
    nodes[number] = copies
    cells = number[np.concatenate([quads + count * copy for copy in range(teeth)])]
    back = tooth.faces["bore" if tooth.body == "pinion" else "rim_back"]
    fixed_nodes = number[(np.unique(back[back < count]) + count * np.arange(teeth)[:, None]).ravel()]
    tooth_nodes = number[count * (teeth // 2) :][:count]
    side = LOADED_SIDE[tooth.body]
    flank, fillet = (
        tooth_nodes[tooth.surfaces[f"{name}_{side}"].nodes[:, 0]] for name in ("flank", "fillet")
    )
    inwards = -1.0 if side == "right" else 1.0
    loads = np.zeros((nodes.size, len(HEIGHTS)))
    for column, height in enumerate(HEIGHTS):
        _push(loads[:, column].reshape(nodes.shape), nodes, flank, height, inwards)
    free = np.setdiff1d(np.arange(nodes.size), 2 * fixed_nodes[:, None] + np.arange(2))
    displacements = np.zeros_like(loads)
    displacements[free] = solve_sparse(_stiffness(nodes, cells, material)[free][:, free].tocsr(), loads[free])
    return np.array(
        [_tension(field.reshape(nodes.shape)[fillet], nodes[fillet], material) for field in displacements.T]
    )


def _merge_nodes(tooth: FeTooth, count: int, teeth: int) -> Integers:
    """Number the nodes of `teeth` copies of a section of `count` nodes; nodes on shared cuts have one
    number.

    Return the number of each node (teeth count,), copy by copy from the left.
    """
    left, right = (cut[cut < count] for cut in (tooth.cut_left, tooth.cut_right))
    number = np.arange(teeth * count)
    for copy in range(1, teeth):
        number[copy * count + left] = number[(copy - 1) * count + right]
    return np.unique(number, return_inverse=True)[1].astype(np.int64)


def _stiffness(nodes: Array, cells: Integers, material: Material) -> sp.csr_matrix:
    """Return the plane-strain stiffness (2 n, 2 n), Pa, of 9-node quadrilaterals (m, 9) on nodes (n, 2),
    m.

    Nodes of a quadrilateral are given as i + 3 j. Dof 2 k + i is displacement i of node k.
    """
    members = cells[:, QUAD]
    mesh = MeshQuad2(np.ascontiguousarray(nodes.T), np.ascontiguousarray(members.T))
    blocks = element_stiffness(Basis(mesh, ElementQuad2(), intorder=4, disable_doflocs=True), material)
    dof = (2 * members[:, :, None] + np.arange(2)).reshape(len(cells), -1)
    rows, columns = np.broadcast_arrays(dof[:, :, None], dof[:, None, :])
    shape = (nodes.size, nodes.size)
    return sp.coo_matrix((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsr()


def _lagrange(x: float) -> tuple[Array, Array]:
    """Values (3,) and slopes (3,) at x of the quadratic shape functions of a line element with nodes at
    -1, 0 and 1.
    """
    values = np.array([0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)])
    return values, np.array([x - 0.5, -2.0 * x, x + 0.5])


def _push(load: Array, nodes: Array, flank: Integers, height: float, inwards: float) -> None:
    """Add a force of 1 N/m into the tooth, along the inward normal of a flank, to `load` (n, 2), in place.

    `nodes` (n, 2): positions, m; `flank`: nodes of the flank from tip to root; `height`: where the force
    acts, 0 at the flank's tip end to 1 at its root end; `inwards`: sign of the normal's first component. The
    force is spread by the element's quadratic functions.
    """
    station = height * (flank.size - 1)
    first = min(2 * int(station // 2), flank.size - 3)
    members = flank[first : first + 3]
    values, slopes = _lagrange(station - first - 1.0)
    along = slopes @ nodes[members]
    normal = np.array([along[1], -along[0]]) / np.linalg.norm(along)
    normal *= inwards * np.sign(normal[0])
    load[members] += values[:, None] * normal


def _tension(displacement: Array, points: Array, material: Material) -> float:
    """Return the largest stress (Pa) along a fillet, tension positive, at its surface in plane strain.

    `displacement`, m, and `points`, m, (n, 2) are those of the fillet's nodes, two an element. Stress is
    taken at two Gauss points an element, and its largest value on a cubic spline through them.
    """
    stiff = material.young_modulus / (1.0 - material.poisson_ratio**2)
    stress = []
    for station in gauge_coordinates(len(points)):
        first = 2 * int(station // 2)
        slopes = _lagrange(station - first - 1.0)[1]
        along, moves = slopes @ points[first : first + 3], slopes @ displacement[first : first + 3]
        stress.append(stiff * float(along @ moves) / float(along @ along))
    kind = CubicSpline(np.arange(len(stress)), stress)
    return float(kind(np.linspace(0.0, len(stress) - 1.0, FINE * len(stress))).max())


@dataclass(frozen=True, eq=False)
class RootGauges:
    """Gauges (2, a, b) on the fillets of a tooth: below the loaded flank, then below the other one.

    a down the fillet, b along the face. `position` (2, a, b, 3) m and unit vectors `across` (2, a, b, 3) down
    the fillet, in the body frame with the tooth in the middle. `error` (b,): relative error of the largest
    stress at each place along the face that the mesh is measured to make (`section_errors`).
    """

    position: Array
    across: Array
    error: Array

    def along(self, body: str) -> Array:
        """Return the position of the gauges along the face.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`.

        Returns
        -------
        (b,) array
            m: y along the pinion's axis, or radius of the gear.
        """
        x, y = self.position[..., 0], self.position[..., 1]
        return np.asarray((y if body == "pinion" else np.hypot(x, y)).mean(axis=(0, 1)))

    @property
    def tangent_angle(self) -> Array:
        """Angle (rad), (2, a, b), between the fillet's tangent and the tooth's middle plane."""
        return np.arctan2(np.abs(self.across[..., 0]), np.abs(self.across[..., 2]))


def fillet_sides(body: str) -> tuple[str, str]:
    """Return the sides of a tooth's fillets: below the flank loaded when the pinion drives, then below the
    other.

    Parameters
    ----------
    body : str
        `pinion` or `face_gear`.

    Returns
    -------
    tuple[str, str]
        `left` and `right` in this order.
    """
    return (LOADED_SIDE[body], "left" if LOADED_SIDE[body] == "right" else "right")


def root_gauges(
    tooth: FeTooth, material: Material, errors: SectionErrors | None = None
) -> tuple[RootGauges, sp.csr_matrix]:
    """Place gauges on both fillets of a tooth, and compute the matrix from displacements to their
    readings.

    A gauge reads the normal stress (Pa, tension positive) down the fillet, across its lines, with the
    surface in plane stress.

    Parameters
    ----------
    tooth : FeTooth
        Mesh of the tooth.
    material : Material
        Of the tooth.
    errors : SectionErrors, optional
        Errors of its mesh; None where they are not measured, which gives nan.

    Returns
    -------
    tuple[RootGauges, sp.csr_matrix]
        Gauges, and their readings (g, 3 n) by the displacements of the elastic body's n nodes, Pa/m;
        gauge (fillet, i, j) of (2, a, b) is row (fillet a + i) b + j.
    """
    mesh, number = hex_mesh(tooth.nodes, tooth.hexes)
    fillets: list[Gauges] = [
        gauges_on(mesh.doflocs.T, number[tooth.surfaces[f"fillet_{side}"].nodes], material)
        for side in fillet_sides(tooth.body)
    ]
    position = np.stack([fillet.position for fillet in fillets])
    gauges = RootGauges(
        position=position,
        across=np.stack([fillet.across for fillet in fillets]),
        error=np.full(position.shape[2], np.nan),
    )
    if errors is not None:
        gauges = replace(gauges, error=errors.at(gauges.along(tooth.body)))
    return gauges, sp.vstack([fillet.normal for fillet in fillets], format="csr")
