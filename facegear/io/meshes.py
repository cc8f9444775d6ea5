"""Read and write mesh files; the only module that uses meshio."""

from collections.abc import Mapping
from pathlib import Path

import meshio
import numpy as np

from facegear.arrays import Array, Integers
from facegear.errors import CorruptFile
from facegear.io.atomic import atomic_path
from facegear.io.checksums import verify


def write_vtu(
    path: str | Path,
    nodes: Array,
    cells: Mapping[str, Integers],
    point_data: Mapping[str, Array] | None = None,
    cell_data: Mapping[str, list[Array]] | None = None,
) -> None:
    """Write a .vtu for ParaView: nodes (N, 3), cells by meshio's type name in VTK's node order, fields."""
    mesh = meshio.Mesh(nodes, list(cells.items()), point_data=point_data, cell_data=cell_data)
    with atomic_path(path) as temporary:
        meshio.write(temporary, mesh, file_format="vtu", binary=True, compression=None)


def read_msh(path: str | Path) -> tuple[Array, Integers, dict[str, Integers]]:
    """Nodes (N, 3), hexahedra (M, 27) in VTK's order, and the faces (F, 9) of every named group.

    Raises CorruptFile for a file that is altered, truncated or holds anything else.
    """
    verify(path)
    try:
        mesh = meshio.read(path, file_format="gmsh")
        hexes = mesh.cells_dict["hexahedron27"]
        faces = mesh.cells_dict["quad9"]
        group = mesh.cell_data_dict["gmsh:physical"]["quad9"]
        names = {int(tag): name for name, (tag, dimension) in mesh.field_data.items() if dimension == 2}
    except (Exception, SystemExit) as error:  # meshio has no error of its own for a file that ends early
        raise CorruptFile(path, f"not a readable mesh ({type(error).__name__})") from None
    if not np.isfinite(mesh.points).all():
        raise CorruptFile(path, "a node is not finite")
    return mesh.points, hexes, {name: faces[group == tag] for tag, name in names.items()}
