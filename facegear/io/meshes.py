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
    """Write a .vtu for ParaView: nodes (N, 3), cells by meshio's type name in VTK's node order, fields."""
    mesh = meshio.Mesh(nodes, list(cells.items()), point_data=point_data, cell_data=cell_data)
    with atomic_path(path) as temporary:
        meshio.write(temporary, mesh, file_format="vtu", binary=True, compression=None)
