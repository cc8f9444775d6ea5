"""Writing of mesh files; the only module that uses meshio."""

from collections.abc import Mapping
from pathlib import Path

import meshio

from facegear.arrays import Array, Integers
from facegear.io.atomic import atomic_path


def write_vtu(
    path: str | Path,
    nodes: Array,
    cells: Mapping[str, Integers],
    point_data: Mapping[str, Array] | None = None,
    cell_data: Mapping[str, list[Array]] | None = None,
) -> None:
    """Write a mesh with fields as a .vtu file for ParaView.

    Parameters
    ----------
    path : str or Path
        File to write.
    nodes : (N, 3) array
        Coordinates, in any unit.
    cells : mapping of str to (M, nodes of a cell) array of int
        Node indices by meshio's name of the cell type, in VTK's node order.
    point_data : mapping of str to (N, ...) array or None
        Field values at the nodes by name, in any unit.
    cell_data : mapping of str to list of arrays or None
        Field values of the cells by name: one array (M, ...) for each type of `cells`, in any unit.
    """
    mesh = meshio.Mesh(nodes, list(cells.items()), point_data=point_data, cell_data=cell_data)
    with atomic_path(path) as temporary:
        meshio.write(temporary, mesh, file_format="vtu", binary=True, compression=None)
