"""Write solids made of patches: STEP (B-spline surfaces through every point) and STL (triangles)."""

import os
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from scipy.interpolate import make_interp_spline

from facegear.arrays import Array
from facegear.errors import NotConverged, extras_named
from facegear.io.atomic import atomic_path
from facegear.number_format import count_noun

with extras_named():
    import gmsh
    import meshio

from facegear.errors import extras_named

with extras_named():
    import gmsh


DEGREE = 3
"""Degree of the B-spline surfaces: cubic, so that curvature is continuous."""
NANOMETRES = 6
"""Decimals of a coordinate in mm that a triangle's corners are rounded to, so that equal ones are equal."""
PRODUCT = re.compile(r"\bPRODUCT\(\s*'(?:[^']|'')*'\s*,\s*'(?:[^']|'')*'")
"""A product's identifier and name in a STEP file (ISO 10303-21), which OpenCASCADE fills with its own."""
SEWN = 1e-6
"""Largest gap in mm that is sewn up; patches meet to rounding."""


def write_stl(path: str | Path, corners: Array) -> None:
    """Write triangles as a binary STL file in mm, corners rounded to the nanometre.

    Parameters
    ----------
    path : str or Path
        File to write.
    corners : (n, 3, 3) array
        Corners of each triangle, m.
    """
    points, cells = np.unique(
        np.round(1e3 * corners, NANOMETRES).reshape(-1, 3) + 0.0, axis=0, return_inverse=True
    )
    mesh = meshio.Mesh(points, [("triangle", cells.reshape(-1, 3))])
    with atomic_path(path) as temporary:
        meshio.write(temporary, mesh, file_format="stl", binary=True)


def write_step(path: str | Path, patches: Sequence[Array], name: str) -> float:
    """Write one solid in mm that is sewn of a bicubic B-spline surface through each patch.

    Parameters
    ----------
    path : str or Path
        File to write.
    patches : sequence of (n, m, 3) arrays
        Points of each patch, m; the patches close around the solid.
    name : str
        Name of the solid, which is the file's only product: ASCII without apostrophes.

    Returns
    -------
    float
        Volume of the solid as OpenCASCADE integrates it, to a relative error of about 2e-5, m^3.

    Raises
    ------
    NotConverged
        If the patches do not close.
    """
    with gmsh_session(name):
        gmsh.option.setNumber("Geometry.ToleranceBoolean", SEWN)
        gmsh.option.setString("Geometry.OCCSTEPModelName", name)
        gmsh.option.setString("Geometry.OCCSTEPOriginatingSystem", "facegear")
        tags = [_surface(1e3 * patch) for patch in patches]
        loop = gmsh.model.occ.addSurfaceLoop(tags, sewing=True)
        solid = gmsh.model.occ.addVolume([loop])
        gmsh.model.occ.remove([(2, tag) for tag in tags], recursive=True)
        gmsh.model.occ.synchronize()
        volume = abs(gmsh.model.occ.getMass(3, solid)) * 1e-9
        sides = [len(gmsh.model.getAdjacencies(1, edge)[0]) for _, edge in gmsh.model.getEntities(1)]
        if set(sides) != {2}:
            failure = f"{count_noun(len(patches), 'patch does', 'patches do')} not close"
            raise NotConverged("STEP", name, failure)
        with atomic_path(path) as temporary:
            with _silent():
                gmsh.write(str(temporary))
            step_text, count = _with_product(temporary.read_text(encoding="ascii"), name)
            if count != 1:
                raise NotConverged("STEP", name, f"{count_noun(count, 'product')} in place of one solid")
            temporary.write_text(step_text, encoding="ascii")
        return volume


def _with_product(content: str, name: str) -> tuple[str, int]:
    """Return the text of a STEP file with the name of every product replaced, and the number of products."""
    return PRODUCT.subn(lambda _: f"PRODUCT('{name}','{name}'", content)


@contextmanager
def _silent() -> Iterator[None]:
    """Discard what is written to file descriptor 1 (OpenCASCADE prints past Python) within the context."""
    sys.stdout.flush()
    standard_output = os.dup(1)
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(standard_output, 1)
        os.close(standard_output)


def _surface(points: Array) -> int:
    """Add to gmsh the bicubic B-spline surface through a grid of points (n, m, 3) in mm; return its tag.

    Parameters are evenly spaced, and the degree falls where there are fewer than four points along an axis.
    """
    poles, knots, degrees = points, [], []
    for axis in (0, 1):
        count = points.shape[axis]
        degree = min(DEGREE, count - 1)
        spline = make_interp_spline(np.linspace(0.0, 1.0, count), poles, k=degree, axis=axis)
        poles = np.moveaxis(spline.c, 0, axis)
        knots.append(np.unique(spline.t, return_counts=True))
        degrees.append(degree)
    tags = [gmsh.model.occ.addPoint(*pole) for pole in poles.transpose(1, 0, 2).reshape(-1, 3)]
    (knots_u, times_u), (knots_v, times_v) = knots
    surface = gmsh.model.occ.addBSplineSurface(
        tags,
        poles.shape[0],
        degreeU=degrees[0],
        degreeV=degrees[1],
        knotsU=knots_u,
        knotsV=knots_v,
        multiplicitiesU=times_u,
        multiplicitiesV=times_v,
    )
    gmsh.model.occ.remove([(0, tag) for tag in tags])  # poles are no points of the solid
    return surface


VARIABLE = "PETSC_OPTIONS"
"""Environment variable that PETSc reads its options from."""
NO_HANDLERS = "-no_signal_handler"
"""Option by which PETSc leaves signals alone."""


@contextmanager
def gmsh_session(name: str) -> Iterator[None]:
    """Open a session of gmsh with one empty model. gmsh is global: one session at a time.

    PETSc, which gmsh brings, takes over signals when it starts and leaves them at the system's default when
    it ends: a broken pipe would then kill the process, and faulthandler be silent. An environment variable
    tells it not to.

    Parameters
    ----------
    name : str
        Name of the model.

    Yields
    ------
    None
        Once, while the session is open.
    """
    with _asked_of_petsc():
        gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.add(name)
        yield
    finally:
        gmsh.finalize()


@contextmanager
def _asked_of_petsc() -> Iterator[None]:
    """Set the environment variable by which PETSc leaves signals alone, and restore it at the end."""
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = f"{before or ''} {NO_HANDLERS}".strip()
    try:
        yield
    finally:
        if before is None:
            del os.environ[VARIABLE]
        else:
            os.environ[VARIABLE] = before
