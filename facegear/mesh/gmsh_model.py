"""Hands a sector to gmsh as discrete entities: numbering, named groups, quality measures, the .msh file."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import gmsh
import numpy as np
from numpy.typing import NDArray

from facegear.arrays import Array
from facegear.io.gmsh_session import gmsh_session
from facegear.mesh.orderings import GMSH27, QUAD9
from facegear.mesh.sector import SectorMesh

HEXAHEDRON_27, QUADRANGLE_9 = 12, 10


@contextmanager
def gmsh_model(sector: SectorMesh) -> Iterator[NDArray[np.uint64]]:
    """Open a gmsh session that holds the sector.

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
