"""Quadrilaterals that fill the section of a gear body, made by gmsh."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.errors import InvalidInput, extras_named
from facegear.io.cad import gmsh_session
from facegear.parts.section import Section, thinnest
from facegear.parts.wheel import ACROSS, require_meshable

with extras_named():
    import gmsh

CORNER = 100.0
"""Factor by which the elements at a reentrant corner are smaller."""
ROUNDING_ANGLE = np.radians(8.0)
"""Angle below which a reentrant corner belongs to a rounded line and needs no smaller elements."""
REACH = 2.0
"""Distance from a reentrant corner, in elements, at which they have their whole size."""
MERGE_DISTANCE = 1e-9
"""Distance (m) below which gmsh takes two points for one."""
QUADRANGLE = 3
"""Number of the quadrilateral with four nodes among gmsh's element types."""


@dataclass(frozen=True, eq=False)
class BodyMesh:
    """Mesh of a section with straight-sided quadrilaterals.

    Attributes
    ----------
    nodes : (n, 2)
        r and height, m.
    quads : (e, 4)
        Nodes at the corners of each quadrilateral, going round.
    in_layer : (e,)
        Whether each belongs to the layer of teeth.
    """

    nodes: Array
    quads: Integers
    in_layer: Mask


def element_size(section: Section, across: int = ACROSS) -> float:
    """Return the size of the elements: the thinnest wall of the section over `across`.

    Parameters
    ----------
    section : Section
        The section.
    across : int
        Number of elements across the thinnest wall.

    Returns
    -------
    float
        m.
    """
    return thinnest(section.corners) / across


def body_mesh(section: Section, across: int = ACROSS, finer: float = CORNER) -> BodyMesh:
    """Mesh a section.

    A line of element edges runs along height 0 between the radii of the teeth.

    Parameters
    ----------
    section : Section
        The section.
    across : int
        Number of elements across the thinnest wall.
    finer : float
        Factor by which elements are smaller at reentrant corners, dimensionless.

    Returns
    -------
    BodyMesh
        Nodes in m.

    Raises
    ------
    InvalidInput
        If the section cannot be meshed.
    """
    require_meshable(section.corners, across)
    with gmsh_session("gear body"):
        gmsh.option.setNumber("Geometry.Tolerance", MERGE_DISTANCE)
        body, layer = _surfaces(section)
        _sizes(section, element_size(section, across), finer)
        gmsh.option.setNumber("Mesh.RecombineAll", 1)
        gmsh.option.setNumber("Mesh.Algorithm", 8)
        gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 1)
        gmsh.model.mesh.generate(2)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        position = np.zeros(int(tags.max()) + 1, np.int64)
        position[tags] = np.arange(tags.size)
        parts = [[_quads(surface) for surface in surfaces] for surfaces in (body, layer)]
    quads = position[np.concatenate([quads for part in parts for quads in part])]
    in_layer = np.repeat([False, True], [sum(len(quads) for quads in part) for part in parts])
    used_nodes, quads = np.unique(quads, return_inverse=True)
    return BodyMesh(coordinates.reshape(-1, 3)[used_nodes, :2], quads.reshape(-1, 4), in_layer)


def _surfaces(section: Section) -> tuple[list[int], list[int]]:
    """Add the section to gmsh, cut along height 0 between the radii of the teeth.

    Returns the tags of the surfaces of the body, and of the layer of teeth (empty without one).
    """
    solids = [(2, _polygon(section.corners))]
    if section.layer is not None:
        solids.append((2, _polygon(section.layer.corners)))
    inner, outer = section.teeth
    ends = [gmsh.model.occ.addPoint(r, 0.0, 0.0) for r in (inner, outer)]
    line = (1, gmsh.model.occ.addLine(*ends))
    _, fragments = gmsh.model.occ.fragment(solids, [line])
    gmsh.model.occ.synchronize()
    surfaces = [[tag for dimension, tag in part if dimension == 2] for part in fragments[: len(solids)]]
    return surfaces[0], surfaces[1] if len(surfaces) > 1 else []


def _polygon(corners: Array) -> int:
    """Add a polygon of corners (n, 2), r and height in m, to gmsh and return the tag of its surface."""
    points = [gmsh.model.occ.addPoint(r, height, 0.0) for r, height in corners]
    lines = [
        gmsh.model.occ.addLine(first, last)
        for first, last in zip(points, [*points[1:], points[0]], strict=True)
    ]
    return int(gmsh.model.occ.addPlaneSurface([gmsh.model.occ.addCurveLoop(lines)]))


def _sizes(section: Section, size: float, finer: float) -> None:
    """Set gmsh's element sizes: twice `size` (m), and smaller by the factor `finer` at reentrant corners.

    They are twice as large as wanted, because each element is then divided into four.
    """
    for name in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{name}", 0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 2.0 * size)
    corners = reentrant(section.corners)
    if not corners.size:
        return
    points = [
        tag
        for _, tag in gmsh.model.getEntities(0)
        if np.linalg.norm(corners - gmsh.model.getValue(0, tag, [])[:2], axis=1).min() < MERGE_DISTANCE
    ]
    distance = gmsh.model.mesh.field.add("Distance")
    gmsh.model.mesh.field.setNumbers(distance, "PointsList", points)
    field = gmsh.model.mesh.field.add("Threshold")
    for name, value in (
        ("InField", distance),
        ("SizeMin", 2.0 * size / finer),
        ("SizeMax", 2.0 * size),
        ("DistMin", 0.0),
        ("DistMax", REACH * size),
    ):
        gmsh.model.mesh.field.setNumber(field, name, value)
    gmsh.model.mesh.field.setAsBackgroundMesh(field)


def reentrant(corners: Array) -> Array:
    """Return the corners at which the inner angle of a polygon exceeds half a turn by ROUNDING_ANGLE.

    Parameters
    ----------
    corners : (n, 2) array
        Corners of an anticlockwise polygon, m.

    Returns
    -------
    (m, 2) array
        m.
    """
    before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return corners[np.arctan2(cross, np.sum(before * after, axis=1)) < -ROUNDING_ANGLE]


def _quads(surface: int) -> Integers:
    """Return gmsh's node tags (e, 4) of the quadrilaterals of a surface with a given tag; raise
    InvalidInput if it has other elements.
    """
    types, _, nodes = gmsh.model.mesh.getElements(2, surface)
    if list(types) != [QUADRANGLE]:
        raise InvalidInput("corners of the section", "no mesh of quadrilaterals", "a simpler section")
    return np.asarray(nodes[0], np.int64).reshape(-1, 4)
