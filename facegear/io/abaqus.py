"""Write a mesh as an Abaqus / CalculiX input deck (.inp)."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TextIO

import numpy as np

from facegear.arrays import Array, Integers
from facegear.io.atomic import atomic_path

NODE = "%d, %.12e, %.12e, %.12e\n"
ELEMENT = f"{', '.join(['%d'] * 11)},\n{', '.join(['%d'] * 10)}\n"


def write(
    path: str | Path,
    title: str,
    nodes: Array,
    elements: Integers,
    node_sets: Mapping[str, Integers],
    surfaces: Mapping[str, Sequence[tuple[int, str]]],
) -> None:
    """Nodes (N, 3) in m, C3D20 elements (M, 20) of node indices, sets of node indices.

    surfaces: named lists of (element index, face S1..S6). Nodes that no element uses are left out; labels are
    index + 1. Lengths are in m, so a modulus belongs in Pa. CalculiX reads at most 20 characters a number.
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
    """A line for each row of a table, all of them formatted at once."""
    stream.write(line * len(table) % tuple(table.ravel().tolist()))


def _list(stream: TextIO, labels: Integers) -> None:
    for start in range(0, len(labels), 12):
        stream.write(", ".join(map(str, labels[start : start + 12].tolist())) + "\n")
