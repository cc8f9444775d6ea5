"""The cross-section of a gear body: a polygon of distances r from the axis and heights zeta.

Heights count along the axis towards the teeth from the plane on which the contact analysis clamps them, so
that teeth and rim of the contact analysis stand at positive heights. Lengths in m.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.teeth.design import Material

GAUSS = np.polynomial.legendre.leggauss(4)
"""Points and weights of the Gauss rule with four points on [-1, 1]."""
OPPOSITE = 0.5
"""Cosine of the angle between the normals of two edges beyond which they bound a wall."""
COINCIDENCE = 1e-9
"""Distance (m) below which two points of a section coincide."""


@dataclass(frozen=True)
class Layer:
    """Teeth as a layer on the rim between two radii, from height `back` to `front` in their middle.

    Both faces rise by `slope` for each metre outwards.

    `density` and `hoop` are fractions of the body's density and of its Young's modulus round the axis,
    `shear` the fraction of the shear moduli that turn the teeth about their roots. At the roots the layer is
    denser than on the mean by the fraction `taper`, at the tips as much less dense.
    """

    inner_radius: float
    outer_radius: float
    back: float
    front: float
    density: float = 0.524
    hoop: float = 0.06
    shear: float = 0.15
    taper: float = 0.0
    slope: float = 0.0

    def density_at(self, r: Array, height: Array) -> Array:
        """Return the layer's fraction of the body's density at points, linear from the roots to the tips
        by `taper`.

        Parameters
        ----------
        r : array of any shape (...)
            Distances from the axis, m.
        height : array of the same shape (...)
            Heights, m.

        Returns
        -------
        array of the same shape (...)
            Relative to the body's density.
        """
        above = height - self.rise(r)
        return self.density * (1.0 + self.taper * (self.back + self.front - 2.0 * above) / self.depth)

    def rise(self, r: Array) -> Array:
        """Return how much higher both faces stand at some radii than in the middle.

        Parameters
        ----------
        r : array of any shape (...)
            Distances from the axis, m.

        Returns
        -------
        array of the same shape (...)
            m.
        """
        return np.asarray(self.slope * (r - 0.5 * (self.inner_radius + self.outer_radius)))

    @property
    def depth(self) -> float:
        """Thickness of the layer along the axis, from height `back` to `front`, m."""
        return self.front - self.back

    @property
    def corners(self) -> Array:
        """Corners of the layer, (4, 2): r and height, anticlockwise, m."""
        corners = rectangle(self.inner_radius, self.outer_radius, self.back, self.front)
        return corners + np.stack([np.zeros(4), self.rise(corners[:, 0])], axis=1)


@dataclass(frozen=True, eq=False)
class Section:
    """Section of a body with its material and its supports.

    Attributes
    ----------
    corners : (n, 2)
        r and height, anticlockwise (r to the right, height upwards), m.
    is_edge_held : (n,)
        Whether the edge from each corner to the next is held.
    teeth
        Inner and outer radius of the teeth, m.
    material
        Elasticity.
    density
        kg/m3.
    layer
        Teeth, None for a body without them.
    """

    corners: Array
    is_edge_held: tuple[bool, ...]
    teeth: tuple[float, float]
    material: Material
    density: float
    layer: Layer | None = None

    @property
    def edges(self) -> Array:
        """First and last point of each edge, (n, 2, 2): edge, point, r and height; m."""
        return np.stack([self.corners, np.roll(self.corners, -1, axis=0)], axis=1)


def rectangle(inner: float, outer: float, back: float, front: float) -> Array:
    """Return the corners of a rectangle.

    Parameters
    ----------
    inner : float
        Inner radius, m.
    outer : float
        Outer radius, m.
    back : float
        Height of its back, m.
    front : float
        Height of its front, m.

    Returns
    -------
    (4, 2) array
        r and height, anticlockwise, m.
    """
    return np.array([(inner, back), (outer, back), (outer, front), (inner, front)])


def distinct(corners: Array) -> Array:
    """Remove each corner that repeats the corner before it.

    Parameters
    ----------
    corners : (n, 2) array
        Corners of a polygon, m.

    Returns
    -------
    (k, 2) array
        m.
    """
    apart = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1) > COINCIDENCE
    return corners[apart]


def anticlockwise(corners: Array) -> Array:
    """Return a polygon in the sense in which r turns towards the height; it begins at the same corner.

    Parameters
    ----------
    corners : (n, 2) array
        Corners of the polygon, m.

    Returns
    -------
    (n, 2) array
        m.
    """
    return corners if _area(corners) > 0.0 else np.roll(corners[::-1], 1, axis=0)


def _area(corners: Array) -> float:
    """Return the signed area (m2) of a polygon of corners (n, 2), m, positive if they run anticlockwise."""
    next_corners = np.roll(corners, -1, axis=0)
    return float(0.5 * np.sum(corners[:, 0] * next_corners[:, 1] - corners[:, 1] * next_corners[:, 0]))


def require_simple(corners: Array) -> None:
    """Raise InvalidInput for a polygon that crosses or touches itself, or has no area.

    Parameters
    ----------
    corners : (n, 2) array
        Corners of the polygon, m.
    """
    count = len(corners)
    if count < 3:
        raise InvalidInput("corners of the section", count, "three points or more")
    ends = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
    for i, j in combinations(range(count), 2):
        if (j - i) % count == 1 or (i - j) % count == 1:
            continue
        if distance_between(ends[i], ends[j]) <= COINCIDENCE:
            requirement = f"a line that does not cross itself; edges {i + 1} and {j + 1} meet"
            raise InvalidInput("corners of the section", (1e3 * corners).round(6).tolist(), requirement)
    if abs(_area(corners)) < COINCIDENCE**2 or _folds(ends):
        requirement = "a line that does not fold back on itself"
        raise InvalidInput("corners of the section", (1e3 * corners).round(6).tolist(), requirement)


def _folds(ends: Array) -> bool:
    """Whether any edge lies on the edge before it, turned back; ends (n, 2, 2): first and last point of
    each edge, m.
    """
    ways = ends[:, 1] - ends[:, 0]
    next_edges = np.roll(ways, -1, axis=0)
    cross = ways[:, 0] * next_edges[:, 1] - ways[:, 1] * next_edges[:, 0]
    lengths = np.linalg.norm(ways, axis=1) * np.linalg.norm(next_edges, axis=1)
    return bool(((np.abs(cross) <= 1e-9 * lengths) & ((ways * next_edges).sum(axis=1) < 0.0)).any())


def distance_between(first: Array, second: Array) -> float:
    """Return the smallest distance of two straight edges.

    Parameters
    ----------
    first : (2, 2) array
        Ends of the first edge, m.
    second : (2, 2) array
        Ends of the second edge, m.

    Returns
    -------
    float
        m; 0 where they cross.
    """
    a, b = first[1] - first[0], second[1] - second[0]
    offset, cross = second[0] - first[0], a[0] * b[1] - a[1] * b[0]
    if cross != 0.0:
        along_first = (offset[0] * b[1] - offset[1] * b[0]) / cross
        along_second = (offset[0] * a[1] - offset[1] * a[0]) / cross
        if 0.0 <= along_first <= 1.0 and 0.0 <= along_second <= 1.0:
            return 0.0
    pairs = [(p, second) for p in first] + [(p, first) for p in second]
    return min(_from_edge(point, edge) for point, edge in pairs)


def _from_edge(point: Array, edge: Array) -> float:
    """Return the distance (m) of a point (2,) from a straight edge (2, 2) between its ends."""
    way = edge[1] - edge[0]
    fraction = np.clip(np.dot(point - edge[0], way) / np.dot(way, way), 0.0, 1.0)
    return float(np.linalg.norm(point - edge[0] - fraction * way))


def thinnest(corners: Array) -> float:
    """Return the smallest distance through the material between two edges that face away from each other: the
    thinnest wall of the section.

    Parameters
    ----------
    corners : (n, 2) array
        Corners of an anticlockwise polygon, m.

    Returns
    -------
    float
        m.
    """
    ends = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
    ways = ends[:, 1] - ends[:, 0]
    lengths = np.linalg.norm(ways, axis=1)
    outward = np.stack([ways[:, 1], -ways[:, 0]], axis=1) / lengths[:, None]
    middles = ends.mean(axis=1)
    walls = [
        distance_between(ends[i], ends[j])
        for i, j in combinations(range(len(ends)), 2)
        if outward[i] @ outward[j] < -OPPOSITE and (middles[j] - middles[i]) @ outward[i] < 0.0
    ]
    return min([*walls, float(lengths.max())])


def mass_properties(corners: Array, density: float) -> tuple[float, float, float, float]:
    """Return mass, moments of inertia and static moment of a full turn of a polygon.

    Exact: each edge makes a triangle with the origin, over which a form of degree d is 1 / (d + 2) of its
    integral along the edge times twice the area.

    Parameters
    ----------
    corners : (n, 2) array
        Corners of an anticlockwise polygon, m.
    density : float
        kg/m3.

    Returns
    -------
    tuple of four floats
        Mass (kg), moments of inertia (kg m2) about the axis and about a diameter at height 0, and the static
        moment, mass times the height of its centre (kg m).
    """
    first, last = corners, np.roll(corners, -1, axis=0)
    double = first[:, 0] * last[:, 1] - first[:, 1] * last[:, 0]
    points = 0.5 * (GAUSS[0] + 1.0)[:, None, None]
    r, height = np.moveaxis(first + points * (last - first), -1, 0)

    def integral(values: Array, degree: int) -> float:
        """Return the integral over the polygon of a form of a degree, given at the edges' points (points,
        edges).
        """
        return float(double @ (0.5 * GAUSS[1] @ values)) / (degree + 2)

    mass = 2.0 * np.pi * density * integral(r, 1)
    polar = 2.0 * np.pi * density * integral(r**3, 3)
    across = 0.5 * polar + 2.0 * np.pi * density * integral(r * height**2, 3)
    return mass, polar, across, 2.0 * np.pi * density * integral(r * height, 2)


def section_properties(section: Section) -> tuple[float, float, float, float]:
    """Return mass, moments of inertia and static moment as `mass_properties`, teeth included.

    The layer of teeth counts with its density, which falls linearly from roots to tips by its taper.

    Parameters
    ----------
    section : Section
        The section.

    Returns
    -------
    tuple of four floats
        Mass (kg), moments of inertia about the axis and about a diameter at height 0 (kg m2), and mass
        times the height of its centre (kg m).
    """
    properties = np.array(mass_properties(section.corners, section.density))
    if section.layer is not None:
        layer = section.layer
        properties += mass_properties(layer.corners, layer.density * section.density)
        area = np.pi * (layer.outer_radius**2 - layer.inner_radius**2)
        width = layer.outer_radius - layer.inner_radius
        heights = area * (layer.back + layer.front) / 6.0 + np.pi * layer.slope * width**3 / 18.0
        volume_moment = layer.depth**2 * heights
        properties[2] -= layer.taper * layer.density * section.density * volume_moment
        properties[3] -= layer.taper * layer.density * section.density * area * layer.depth**2 / 6.0
    return float(properties[0]), float(properties[1]), float(properties[2]), float(properties[3])


def inertia_about(section: Section, height: float) -> float:
    """Return the moment of inertia of a section's body about a diameter at a height, teeth included.

    Parameters
    ----------
    section : Section
        The section.
    height : float
        Height, m.

    Returns
    -------
    float
        kg m2.
    """
    mass, _, across, moment = section_properties(section)
    return across - 2.0 * height * moment + mass * height**2
