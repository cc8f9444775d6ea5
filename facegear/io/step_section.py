"""Section of a gear body from a STEP file: a solid of revolution or its half section."""

from itertools import pairwise
from pathlib import Path

import numpy as np

from facegear.arrays import Array
from facegear.errors import extras_named
from facegear.io.cad import gmsh_session
from facegear.number_format import count_noun

with extras_named():
    import gmsh

CHORD = 0.01
"""Distance (mm) by which a straight edge may miss the curve that it stands for."""
TURN = np.radians(7.5)
"""Angle by which the edges of a curve may turn from one to the next."""
EQUAL = 1e-6
"""Distance (mm) below which two points are one."""
MAX_DIFFERENCE = 2e-5
"""Relative difference of areas, volumes and centres below which a solid is one of revolution: OpenCASCADE
integrates the area inside a circle to 6e-6.
"""
CUTS = (0.7, 2.9)
"""Angles (rad) about the axis at which a solid is cut."""
SMALLEST, LARGEST = 1.0, 1e4
"""Outer radius (mm) of a body that is read."""
LARGEST_FILE = 50_000_000
"""Bytes that are read at most."""
DECIMALS = 9
"""Decimals of a coordinate in mm."""


class StepFault(Exception):
    """Reason why a file cannot be used; the text is one line."""


def read_section(path: str | Path) -> list[tuple[float, float]]:
    """Read the outline of a gear body's section from a STEP file, a solid of revolution or its half
    section.

    The axis is that of z through the origin. A half section may lie in any half plane through it: r is the
    distance from the axis. The file names its own unit. Curves become straight edges within CHORD.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Returns
    -------
    list of tuple of float
        Corners (r, z) in mm, anticlockwise in the r-z plane from the one of smallest r, then z.

    Raises
    ------
    StepFault
        For anything but one solid of revolution or one face in such a half plane, with a bore.
    """
    _require_file(Path(path))
    with gmsh_session("section"):
        gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
        dimension, tag = _read_shape(path)
        points = _outline(tag) if dimension == 2 else _cut(tag)
    return [(float(r), float(z)) for r, z in _order_corners(points).round(DECIMALS)]


def _require_file(path: Path) -> None:
    """Raise StepFault for a path that is no file, or a file longer than LARGEST_FILE."""
    try:
        size = path.stat().st_size
    except (OSError, ValueError):
        raise StepFault("no such file") from None
    if not path.is_file():
        raise StepFault("it is not a file")
    if size > LARGEST_FILE:
        raise StepFault(f"it is longer than {LARGEST_FILE} bytes")


def _read_shape(path: str | Path) -> tuple[int, int]:
    """Import the file into gmsh; return dimension (2 face, 3 solid) and tag of its only shape, or raise
    StepFault.
    """
    try:
        shapes = gmsh.model.occ.importShapes(str(path), format="step")
    except Exception as error:  # the only class that gmsh raises
        raise StepFault(f"gmsh cannot read it ({' '.join(str(error).split())[:100]})") from None
    gmsh.model.occ.synchronize()
    if len(shapes) != 1 or shapes[0][0] not in (2, 3):
        raise StepFault(f"it holds {_count_shapes(shapes)}")
    return shapes[0]


def _count_shapes(shapes: list[tuple[int, int]]) -> str:
    """Say in words how many solids, faces, curves and points there are among (dimension, tag) pairs."""
    dimensions = [dimension for dimension, _ in shapes]
    names = {3: "solids", 2: "faces without a solid", 1: "curves", 0: "points"}
    counts = [f"{dimensions.count(key)} {name}" for key, name in names.items() if key in dimensions]
    return " and ".join(counts) or "no shape"


def _cut(solid: int) -> Array:
    """Cut a solid (gmsh tag) by two half planes, check that it is one of revolution, and return the first
    outline.

    The outline is (n, 2): distances r from the z axis and heights z, in mm.
    """
    occ = gmsh.model.occ
    low, high = np.reshape(occ.getBoundingBox(3, solid), (2, 3))
    reach = 1.1 * float(np.hypot(*np.maximum(-low, high)[:2]))
    _require_size(float(max(*high[:2], *-low[:2])))
    faces = []
    for angle in CUTS:
        plane = occ.addRectangle(0.0, 0.0, 0.0, reach, high[2] - low[2] + reach)
        occ.translate([(2, plane)], 0.0, low[2] - 0.5 * reach, 0.0)
        occ.rotate([(2, plane)], 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5 * np.pi)
        occ.rotate([(2, plane)], 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, angle)
        pieces, _ = occ.intersect([(2, plane)], [(3, solid)], removeTool=False)
        if len(pieces) != 1:
            raise StepFault(f"a half plane through its z axis cuts it in {count_noun(len(pieces), 'piece')}")
        faces.append(pieces[0][1])
    occ.synchronize()
    _require_revolution(solid, faces)
    return _outline(faces[0])


def _require_revolution(solid: int, faces: list[int]) -> None:
    """Raise StepFault unless a solid (gmsh tag) is one of revolution about z, by its two cuts `faces`
    (gmsh tags).

    Both cuts must be alike, the centre of mass on the axis, and the volume 2 pi times radius times area
    of a cut (Pappus), within MAX_DIFFERENCE.
    """
    occ = gmsh.model.occ
    cuts = []
    for face in faces:
        x, y, z = occ.getCenterOfMass(2, face)
        cuts.append((occ.getMass(2, face), float(np.hypot(x, y)), z))
    (area, radius, height), second_cut = cuts
    apart = np.hypot(second_cut[1] - radius, second_cut[2] - height)
    if abs(second_cut[0] - area) > MAX_DIFFERENCE * area or apart > MAX_DIFFERENCE * radius:
        raise StepFault("its body is not one of revolution about the z axis: two cuts differ")
    beside = float(np.hypot(*occ.getCenterOfMass(3, solid)[:2]))
    if beside > MAX_DIFFERENCE * radius:
        distance_text = f"its centre of mass lies {beside:.3g} mm beside the z axis"
        raise StepFault(f"its body is not one of revolution: {distance_text}")
    volume, around = occ.getMass(3, solid), 2.0 * np.pi * area * radius
    if abs(volume - around) > MAX_DIFFERENCE * around:
        volume_text = f"that of its section turned about the z axis {around:.7g} mm3"
        raise StepFault(f"its body is not one of revolution: its volume is {volume:.7g} mm3, {volume_text}")


def _outline(face: int) -> Array:
    """Return the corners (n, 2), r and z in mm, of the one closed line around a face (gmsh tag) in a half
    plane.

    StepFault is raised for a hole or an open line.
    """
    curves = {tag: _sample_curve(tag) for _, tag in gmsh.model.getBoundary([(2, face)], oriented=False)}
    first = next(iter(curves))
    line = [curves.pop(first)]
    while curves:
        near = {tag: np.linalg.norm(ends[[0, -1]] - line[-1][-1], axis=1) for tag, ends in curves.items()}
        tag = min(near, key=lambda tag: float(near[tag].min()))
        if near[tag].min() > EQUAL:
            raise StepFault("its section has a hole or an open line")
        next_part = curves.pop(tag)
        line.append(next_part if near[tag][0] <= near[tag][1] else next_part[::-1])
    if np.linalg.norm(line[-1][-1] - line[0][0]) > EQUAL:
        raise StepFault("its section has a hole or an open line")
    points = np.concatenate([part[:-1] for part in line])
    return _plane(points)


def _plane(points: Array) -> Array:
    """Convert points (n, 3) in one half plane through the z axis to (n, 2): distance r from the axis and
    z, in mm.

    StepFault is raised if they reach the axis or lie in no such half plane.
    """
    angles = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    r = np.hypot(points[:, 0], points[:, 1])
    _require_size(float(r.max()))
    if r.min() < EQUAL:
        raise StepFault("its body has no bore: the section reaches the z axis")
    if (r * np.abs(angles - angles[0])).max() > EQUAL:
        raise StepFault("its face lies in no half plane through the z axis")
    return np.stack([r, points[:, 2]], axis=1)


def _require_size(radius: float) -> None:
    """Raise StepFault for an outer radius (mm) outside SMALLEST..LARGEST, which shows a wrong unit."""
    if not SMALLEST <= radius <= LARGEST:
        bounds = f"{SMALLEST:g} to {LARGEST:g} mm are read"
        raise StepFault(f"its outer radius is {radius:.4g} mm by the unit of the file; {bounds}")


def _sample_curve(curve: int) -> Array:
    """Return points (n, 3), mm, along a curve (gmsh tag) from end to end, so many that straight edges are
    close to it.
    """
    (low,), (high,) = gmsh.model.getParametrizationBounds(1, curve)

    def points(count: int) -> Array:
        """Return the points (count + 1, 3), mm, at evenly spaced parameters of the curve."""
        parameters = np.linspace(low, high, count + 1)
        return np.reshape(gmsh.model.getValue(1, curve, parameters), (-1, 3))

    if gmsh.model.getType(1, curve) == "Line":
        return points(1)
    edges = 2
    while not _close(points(4 * edges)):
        edges += 1 + edges // 5
    return points(edges)


def _close(fine: Array) -> bool:
    """Tell whether straight edges through every fourth of points (4 n + 1, 3), mm, are close to the
    points between.

    Close: within CHORD, and no two successive edges differ by more than TURN in direction.
    """
    corners = fine[::4]
    ways = np.diff(corners, axis=0)
    lengths = np.linalg.norm(ways, axis=1)
    offsets = np.stack([fine[part::4] - corners[:-1] for part in (1, 2, 3)], axis=1)
    deviations = np.linalg.norm(np.cross(offsets, ways[:, None]), axis=2) / lengths[:, None]
    turns = [np.linalg.norm(np.cross(a, b)) for a, b in pairwise(ways / lengths[:, None])]
    return bool(deviations.max() <= CHORD and max(turns) <= np.sin(TURN))


def _order_corners(points: Array) -> Array:
    """Return the corners (r, z) of an outline (n, 2), without those on a straight line.

    They run anticlockwise from the one of smallest r, then smallest z.
    """
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    lengths = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    corners = points[np.abs(cross) > 1e-9 * lengths]
    r, z = corners.T
    next_corners = np.roll(corners, -1, axis=0)
    if np.sum(r * next_corners[:, 1] - z * next_corners[:, 0]) < 0.0:
        corners = corners[::-1]
    start = np.lexsort(corners.round(6).T[::-1])[0]
    return np.roll(corners, -start, axis=0)
