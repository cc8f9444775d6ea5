"""Matrices of Abaqus and CalculiX with the ending .mtx: entries by node and dof, and substructures."""

import re
from pathlib import Path

import numpy as np
import scipy

from facegear.io.matrices.labelled_matrix import (
    LabelledMatrix,
    MatrixFault,
    from_entries,
    read_lines,
    read_numbers,
)
from facegear.number_format import count_noun

COORDINATE_COLUMNS = 5
"""Numbers of a line: node, dof, node, dof, entry."""


def read_coordinates(path: Path) -> LabelledMatrix:
    """Read a matrix of lines `node, dof, node, dof, value`, one triangle or all of it.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    LabelledMatrix
        The matrix; nodes with negative numbers, which Abaqus gives to internal variables, are modes.

    Raises
    ------
    MatrixFault
        For a line that is not valid.
    """
    numbers = read_numbers(path, COORDINATE_COLUMNS, ",")
    labels = numbers[:, :4]
    if (labels != np.round(labels)).any():
        raise MatrixFault("nodes and dofs must be whole numbers")
    node = np.stack([labels[:, 0], labels[:, 2]]).astype(np.int64)
    direction = np.stack([labels[:, 1], labels[:, 3]]).astype(np.int64)
    is_internal = node < 0
    if ((direction < 1) | (direction > 6)).any():
        raise MatrixFault("dofs must be 1 to 6: motions along and rotations about x, y, z")
    # Internal variables stand behind all nodes, so that a single number names every row.
    names = np.where(is_internal, 8 * (node.max() + 1 - node), 8 * node + direction)
    behind = 8 * (int(node.max()) + 1)
    row_node, row_direction, matrix = from_entries(names[0], names[1], numbers[:, 4])
    is_mode = 8 * row_node >= behind
    return LabelledMatrix(
        np.where(is_mode, 0, row_node), np.where(is_mode, np.cumsum(is_mode), row_direction), matrix
    )


def read_substructure(path: Path, quantity: str) -> LabelledMatrix | None:
    """Read a matrix from `*USER ELEMENT` and `*MATRIX`: lower triangle by rows.

    Parameters
    ----------
    path : Path
        The file.
    quantity : str
        `stiffness`, `mass` or `damping`.

    Returns
    -------
    LabelledMatrix or None
        The matrix; None where the file holds none of that quantity.

    Raises
    ------
    MatrixFault
        For a file that is not valid.
    """
    lines = read_lines(path)
    nodes = _listed_nodes(lines)
    dofs: list[list[int]] = []
    values: list[float] | None = None
    type_name = {"stiffness": "STIFFNESS", "mass": "MASS", "damping": "VISCOUSDAMPING"}[quantity]
    state, positions = "", {1: 0}
    for line in lines:
        text = line.strip().upper().replace(" ", "")
        if text.startswith("**") or not text:
            continue
        if text.startswith("*"):
            state = ""
            if text.startswith("*USERELEMENT"):
                state = "dofs"
            elif text.startswith("*MATRIX") and f"TYPE={type_name}" in text:
                state, values = "values", []
            continue
        if state == "dofs":
            numbers = [int(number) for number in text.rstrip(",").split(",") if number]
            if dofs:
                positions[numbers[0]] = len(dofs)
                numbers = numbers[1:]
            dofs.append(numbers)
        elif state == "values" and values is not None:
            values += [_real(number) for number in text.split(",") if number]
    if values is None:
        return None
    if not nodes or not dofs:
        raise MatrixFault(
            "its nodes must stand in comments below `** ELEMENT NODES`, its dofs below *USER ELEMENT"
        )
    rows, current = [], dofs[0]
    for position, node in enumerate(nodes, start=1):
        current = dofs[positions[position]] if position in positions else current
        rows += [(node, direction) for direction in current]
    size = len(rows)
    if len(values) != size * (size + 1) // 2:
        count = size * (size + 1) // 2
        raise MatrixFault(
            f"its lower triangle must have {count} numbers for {count_noun(size, 'dof')}, not {len(values)}"
        )
    matrix = np.zeros((size, size))
    matrix[np.tril_indices(size)] = values
    matrix += np.tril(matrix, -1).T
    node, direction = np.array(rows, np.int64).T
    return LabelledMatrix(node, direction, scipy.sparse.csc_array(matrix))


def _listed_nodes(lines: list[str]) -> list[int]:
    """Return the nodes of a substructure from the comments below `** ELEMENT NODES`, in their order."""
    nodes: list[int] = []
    is_list = False
    for line in lines:
        text = line.strip()
        if is_list and re.fullmatch(r"\*\*[\s\d,]+", text):
            nodes += [int(number) for number in re.findall(r"\d+", text)]
            continue
        is_list = text.startswith("**") and "ELEMENT NODES" in text.upper()
    return nodes


def _real(text: str) -> float:
    """Return a number of a matrix."""
    try:
        return float(text.replace("D", "E"))
    except ValueError:
        raise MatrixFault(f"{text[:40]!r} is no number of a matrix") from None
