"""Meshes for other programs: node orders, named faces, gmsh, ParaView, Abaqus and CalculiX."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import gmsh
import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.arrays import Array
from facegear.io import meshes
from facegear.io.atomic import atomic_path
from facegear.io.cad import gmsh_session
from facegear.teeth.mesh_quality import scaled_jacobians, volume
from facegear.teeth.tooth_mesh import SectorMesh

_CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
"""Places of the corners of a 27-node element, in half edges along its axes."""
_RING = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)]
"""Places of the nodes on lower and upper edges."""
_UPRIGHT = [(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
"""Places of the nodes on upright edges."""
_GMSH_EDGES = [
    *[(1, 0, 0), (0, 1, 0), (0, 0, 1), (2, 1, 0), (2, 0, 1), (1, 2, 0)],
    *[(2, 2, 1), (0, 2, 1), (1, 0, 2), (0, 1, 2), (2, 1, 2), (1, 2, 2)],
]
"""Places of the nodes on edges in gmsh's order."""
_GMSH_FACES = [(1, 1, 0), (1, 0, 1), (0, 1, 1), (2, 1, 1), (1, 2, 1), (1, 1, 2)]
"""Places of the nodes on faces in gmsh's order."""
_VTK_FACES = [(0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1), (1, 1, 0), (1, 1, 2)]
"""Places of the nodes on faces in VTK's order."""


def _index(positions: list[tuple[int, int, int]]) -> np.ndarray:
    """Return the numbers of nodes in a 27-node element by their places along its three axes."""
    return np.array([i + 3 * j + 9 * k for i, j, k in positions])


GMSH27 = _index([*_CORNERS, *_GMSH_EDGES, *_GMSH_FACES, (1, 1, 1)])
"""Number of each of gmsh's 27 nodes in this package's order."""
VTK27 = _index([*_CORNERS, *_RING, *_UPRIGHT, *_VTK_FACES, (1, 1, 1)])
"""Number of each of VTK's 27 nodes in this package's order."""
SERENDIPITY20 = _index([*_CORNERS, *_RING, *_UPRIGHT])
"""The 20 nodes of VTK's quadratic hexahedron and of C3D20 in Abaqus and CalculiX."""
QUAD9 = np.array([0, 2, 8, 6, 1, 5, 7, 3, 4])
"""Quadrilateral of nine nodes of gmsh and VTK, from i + 3 j."""

FACES = {
    "S1": _index([(1, 1, 0)])[0],
    "S2": _index([(1, 1, 2)])[0],
    "S3": _index([(1, 0, 1)])[0],
    "S4": _index([(2, 1, 1)])[0],
    "S5": _index([(1, 2, 1)])[0],
    "S6": _index([(0, 1, 1)])[0],
}
"""Abaqus names of the faces, by the lexicographic index of the face's middle node."""


def element_faces(sector: SectorMesh, name: str) -> list[tuple[int, str]]:
    """Return the element and its Abaqus side of every face of a group.

    Parameters
    ----------
    sector : SectorMesh
        Mesh of the teeth.
    name : str
        Name of the group.

    Returns
    -------
    list[tuple[int, str]]
        Index of the element, from 0, and side S1..S6, in the order of `sector.faces(name)`.

    Raises
    ------
    KeyError
        For an unknown group.
    """
    middle = sector.faces(name)[:, 4]
    sides = sector.hexes[:, list(FACES.values())]
    order = np.argsort(sides.ravel(), kind="stable")
    index = order[np.searchsorted(sides.ravel(), middle, sorter=order)]
    labels = list(FACES)
    return [(int(at // 6), labels[at % 6]) for at in index]


HEXAHEDRON_27, QUADRANGLE_9 = 12, 10
"""Numbers of gmsh's types of elements."""


@contextmanager
def gmsh_model(sector: SectorMesh) -> Iterator[NDArray[np.uint64]]:
    """Open a gmsh session that holds the sector, for a `with` statement; it ends with the statement.

    Parameters
    ----------
    sector : SectorMesh
        Mesh of the teeth.

    Yields
    ------
    (elements,) array of int
        Tags of its hexahedra.
    """
    with gmsh_session(sector.tooth.body):
        yield _fill(sector)


def _fill(sector: SectorMesh) -> NDArray[np.uint64]:
    """Give nodes, elements and named groups of faces of a sector to gmsh; return the tags of the elements."""
    names = [name for name in sector.tooth.faces if len(sector.faces(name))]
    for number in range(1, len(names) + 1):
        gmsh.model.addDiscreteEntity(2, number)
    gmsh.model.addDiscreteEntity(3, 1, list(range(1, len(names) + 1)))
    tags = np.arange(1, len(sector.nodes) + 1)
    gmsh.model.mesh.addNodes(3, 1, tags, sector.nodes.ravel())
    elements = np.arange(1, len(sector.hexes) + 1, dtype=np.uint64)
    hexes = sector.hexes[:, GMSH27] + 1
    gmsh.model.mesh.addElementsByType(1, HEXAHEDRON_27, elements, hexes.ravel())
    gmsh.model.setPhysicalName(3, gmsh.model.addPhysicalGroup(3, [1]), sector.tooth.body)
    for number, name in enumerate(names, 1):
        faces = sector.faces(name)[:, QUAD9] + 1
        gmsh.model.mesh.addElementsByType(number, QUADRANGLE_9, [], faces.ravel())
        gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, [number]), name)
    return elements


def write_msh(sector: SectorMesh, path: Path) -> Array:
    """Write the sector as .msh 4.1 (binary).

    Parameters
    ----------
    sector : SectorMesh
        Mesh of the teeth.
    path : Path
        File to write.

    Returns
    -------
    (elements,) array
        gmsh's minSICN of every hexahedron, dimensionless.
    """
    with gmsh_model(sector) as elements:
        quality = gmsh.model.mesh.getElementQualities(elements, "minSICN")
        gmsh.option.setNumber("Mesh.Binary", 1)
        gmsh.write(str(path))
    return np.asarray(quality)


QUANTILES = (0.0, 0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)
"""Quantiles of the mesh quality that a report lists."""


def write_files(sector: SectorMesh, msh: Path, vtu: Path, inp: Path) -> pd.DataFrame:
    """Write the sector in three formats.

    Parameters
    ----------
    sector : SectorMesh
        Mesh of the teeth.
    msh : Path
        File for gmsh.
    vtu : Path
        File for ParaView.
    inp : Path
        File for Abaqus and CalculiX.

    Returns
    -------
    pd.DataFrame
        Rows of the body in quality.csv, see `quality_table`.
    """
    with atomic_path(msh) as temporary:
        condition = write_msh(sector, temporary)
    jacobian = scaled_jacobians(sector.nodes, sector.hexes)
    meshes.write_vtu(
        vtu,
        sector.nodes,
        {"hexahedron27": sector.hexes[:, VTK27]},
        cell_data={"scaled_jacobian": [jacobian], "min_sicn": [condition]},
    )
    names = [name for name in sector.tooth.faces if len(sector.faces(name))]
    meshes.write_inp(
        inp,
        f"{sector.tooth.body}: {len(sector.tooth_nodes)} of {sector.tooth.teeth} teeth",
        sector.nodes,
        sector.hexes[:, SERENDIPITY20],
        {name: np.unique(sector.faces(name)) for name in names},
        {f"{name}_surface": element_faces(sector, name) for name in names},
    )
    return quality_table(sector, jacobian, condition)


def quality_table(sector: SectorMesh, jacobian: Array, condition: Array) -> pd.DataFrame:
    """Tabulate counts, volume, and quality by quantile.

    Parameters
    ----------
    sector : SectorMesh
        Mesh of the teeth.
    jacobian : (elements,) array
        Scaled Jacobians, dimensionless.
    condition : (elements,) array
        gmsh's minSICN, dimensionless.

    Returns
    -------
    pd.DataFrame
        Columns body, quantity, statistic and value.
    """
    body, serendipity = sector.tooth.body, np.unique(sector.hexes[:, SERENDIPITY20])
    rows = [
        (body, "teeth", "count", len(sector.tooth_nodes)),
        (body, "elements", "count", len(sector.hexes)),
        (body, "nodes", "count", len(sector.nodes)),
        (body, "serendipity_dof", "count", 3 * len(serendipity)),
        (body, "volume_mm3", "sum", 1e9 * volume(sector.nodes, sector.hexes)),
    ]
    for name, values in (("scaled_jacobian", jacobian), ("min_sicn", condition)):
        rows += [(body, name, f"quantile_{q:g}", float(np.quantile(values, q))) for q in QUANTILES]
    return pd.DataFrame(rows, columns=["body", "quantity", "statistic", "value"])
