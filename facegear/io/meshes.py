"""Write mesh files: vtu for ParaView, and input decks of Abaqus and CalculiX (inp)."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TextIO

import meshio
import numpy as np

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


NODE = "%d, %.12e, %.12e, %.12e\n"
"""Format of a node's line: label and coordinates, m; 13 digits, as CalculiX reads at most 20 characters."""
ELEMENT = f"{', '.join(['%d'] * 11)},\n{', '.join(['%d'] * 10)}\n"
"""Format of the two lines of a C3D20 element: its label and 20 nodes."""


def write_inp(
    path: str | Path,
    title: str,
    nodes: Array,
    elements: Integers,
    node_sets: Mapping[str, Integers],
    surfaces: Mapping[str, Sequence[tuple[int, str]]],
) -> None:
    """Write a mesh of C3D20 elements as an input deck.

    Nodes that no element uses are left out; labels are index + 1. Lengths are in m, so that a modulus must be
    given in Pa. CalculiX reads at most 20 characters a number.

    Parameters
    ----------
    path : str or Path
        File to write.
    title : str
        Heading of the deck.
    nodes : (N, 3) array
        Coordinates, m.
    elements : (M, 20) array of int
        Indices of the nodes of each element.
    node_sets : mapping of str to (K,) array of int
        Node indices of each named set.
    surfaces : mapping of str to sequence of (int, str)
        Element index and face, S1 to S6, of each facet of a named surface.
    """
    used_nodes = np.unique(elements)
    with atomic_path(path) as temporary, open(temporary, "w", encoding="ascii") as stream:
        stream.write(f"*HEADING\n{title}; lengths in m\n*NODE, NSET=ALL_NODES\n")
        _rows(stream, NODE, np.column_stack([used_nodes + 1, nodes[used_nodes]]))
        stream.write("*ELEMENT, TYPE=C3D20, ELSET=BODY\n")
        _rows(stream, ELEMENT, np.column_stack([np.arange(1, len(elements) + 1), elements + 1]))
        for name, members in node_sets.items():
            stream.write(f"*NSET, NSET={name.upper()}\n")
            _list(stream, np.intersect1d(members, used_nodes) + 1)
        for name, faces in surfaces.items():
            stream.write(f"*SURFACE, NAME={name.upper()}, TYPE=ELEMENT\n")
            stream.writelines(f"{element + 1}, {side}\n" for element, side in faces)


def _rows(stream: TextIO, line: str, table: Array | Integers) -> None:
    """Write each row of a table with the format `line`, which has a place for each column, to the stream."""
    stream.write(line * len(table) % tuple(table.ravel().tolist()))


def _list(stream: TextIO, labels: Integers) -> None:
    """Write labels, separated by commas, in lines of twelve to the stream."""
    for start in range(0, len(labels), 12):
        stream.write(", ".join(map(str, labels[start : start + 12].tolist())) + "\n")
