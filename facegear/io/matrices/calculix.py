"""Matrices that CalculiX stores by `*FREQUENCY, SOLVER=MATRIXSTORAGE`: .sti, .mas and .dof."""

from pathlib import Path

import numpy as np

from facegear.arrays import Integers
from facegear.io.matrices.labelled_matrix import (
    LabelledMatrix,
    MatrixFault,
    read_lines,
    read_numbers,
    symmetric,
)
from facegear.number_format import count_noun

ENDINGS = {"stiffness": ".sti", "mass": ".mas"}
"""Endings of the files; damping is not stored."""


def read_stored(path: Path) -> LabelledMatrix:
    """Read a stored matrix, upper triangle, with the rows that the file `.dof` beside it names.

    Parameters
    ----------
    path : Path
        The file, `.sti` or `.mas`.

    Returns
    -------
    LabelledMatrix
        The matrix.

    Raises
    ------
    MatrixFault
        For a file that is missing or not valid.
    """
    node, direction = read_dofs(path.with_suffix(".dof"))
    entries = read_numbers(path, 3)
    row, column = entries[:, :2].astype(np.int64).T - 1
    if min(row.min(), column.min()) < 0 or max(row.max(), column.max()) >= node.size:
        last = max(row.max(), column.max()) + 1
        raise MatrixFault(f"it has row {last}, but {path.stem}.dof {count_noun(node.size, 'dof')}")
    is_stored = entries[:, 2] != 0.0
    triangle = bool((row <= column).all())
    return LabelledMatrix(
        node,
        direction,
        symmetric(row[is_stored], column[is_stored], entries[is_stored, 2], node.size, triangle or None),
    )


def read_dofs(path: Path) -> tuple[Integers, Integers]:
    """Return node and direction of each row from a file of lines `node.direction`.

    Parameters
    ----------
    path : Path
        The file, `.dof`.

    Returns
    -------
    tuple of two (n,) arrays of int
        Node, and direction from 1.

    Raises
    ------
    MatrixFault
        For a file that is missing or not valid.
    """
    try:
        labels = [line.strip().split(".") for line in read_lines(path) if line.strip()]
        node, direction = np.array(labels, np.int64).T
    except MatrixFault as fault:
        raise MatrixFault(f"{path.name}: {fault}") from None
    except ValueError:
        raise MatrixFault(f"{path.name}: its lines must be `node.direction`") from None
    return node, direction
