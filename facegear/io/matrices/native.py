"""Matrices as tables of numbers with a list of dofs beside them, in csv, npz and Matrix Market."""

import csv
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from facegear.arrays import AnyArray, Array, Arrays, Integers
from facegear.io.matrices.labelled_matrix import LabelledMatrix, MatrixFault, read_lines, read_numbers

NPZ_NAMES = ("stiffness", "mass", "damping", "dofs", "nodes")
"""Arrays of an npz: matrices (n, n), rows `node, dof` (n, 2), lines `node, x, y, z` in mm (nodes, 4)."""
NODE_COLUMNS = ("node", "x_mm", "y_mm", "z_mm")
"""Columns of a list of nodes; `patch` may stand behind them."""


def read_csv(path: Path, dofs: tuple[Integers, Integers]) -> LabelledMatrix:
    """Read a matrix from a csv file of its rows.

    Parameters
    ----------
    path : Path
        The file: n lines of n numbers.
    dofs : pair of (n,) arrays of int
        Node and direction of each row.

    Returns
    -------
    LabelledMatrix
        The matrix.

    Raises
    ------
    MatrixFault
        For a file that is not valid.
    """
    return _whole(read_numbers(path, 0, ","), dofs)


def read_matrix_market(path: Path, dofs: tuple[Integers, Integers]) -> LabelledMatrix:
    """Read a matrix from a Matrix Market file.

    Parameters
    ----------
    path : Path
        The file; its first line says whether it holds one triangle.
    dofs : pair of (n,) arrays of int
        Node and direction of each row.

    Returns
    -------
    LabelledMatrix
        The matrix.

    Raises
    ------
    MatrixFault
        For a file that is not valid.
    """
    try:
        matrix = scipy.io.mmread(path)
    except (ValueError, OSError) as error:
        raise MatrixFault(f"it is no Matrix Market file ({str(error)[:120]})") from None
    return _whole(matrix, dofs)


def read_npz(path: Path) -> Arrays:
    """Read the arrays NPZ_NAMES of an npz file.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    mapping of arrays
        Those that the file holds.

    Raises
    ------
    MatrixFault
        For a file that is not valid, or holds another array.
    """
    try:
        archive = np.load(path)
        if not isinstance(archive, np.lib.npyio.NpzFile):
            raise MatrixFault("it holds a single array without a name, as np.save writes it; use np.savez")
        with archive as arrays:
            unknown_names = [name for name in arrays.files if name not in NPZ_NAMES]
            if unknown_names:
                raise MatrixFault(f"it holds {unknown_names[0]!r}; arrays may be {', '.join(NPZ_NAMES)}")
            return {name: np.asarray(arrays[name]) for name in arrays.files}
    except FileNotFoundError:
        raise MatrixFault("no such file") from None
    except (ValueError, OSError, EOFError, zipfile.BadZipFile, KeyError):
        raise MatrixFault("it is no npz file of numbers") from None


def npz_matrix(
    path: Path, quantity: str, dofs: tuple[Integers, Integers] | None = None
) -> LabelledMatrix | None:
    """Read a matrix from an npz file.

    Parameters
    ----------
    path : Path
        The file.
    quantity : str
        `stiffness`, `mass` or `damping`.
    dofs : pair of (n,) arrays of int, or None
        Node and direction of each row; None for those of the file.

    Returns
    -------
    LabelledMatrix or None
        The matrix; None where the file holds none of that name.

    Raises
    ------
    MatrixFault
        For a file that is not valid.
    """
    arrays = read_npz(path)
    if quantity not in arrays:
        return None
    if dofs is None:
        if "dofs" not in arrays:
            raise MatrixFault("it holds no array `dofs`: node and dof of each row")
        table = arrays["dofs"]
        if table.ndim != 2 or table.shape[1] != 2:
            raise MatrixFault(
                f"its array `dofs` has shape {table.shape}; it must have two columns, node and dof"
            )
        whole_numbers = _whole_numbers(table, "nodes and dofs")
        dofs = whole_numbers[:, 0], whole_numbers[:, 1]
    return _whole(arrays[quantity], dofs)


def read_dofs(path: Path) -> tuple[Integers, Integers]:
    """Return node and direction of each row from a csv file with the columns node and dof.

    Parameters
    ----------
    path : Path
        The file; rows of modes have node 0.

    Returns
    -------
    tuple of two (n,) arrays of int
        Node, and direction from 1.

    Raises
    ------
    MatrixFault
        For a file that is not valid.
    """
    lines = read_lines(path)
    header = [name.strip() for name in lines[0].split(",")]
    if header[:2] != ["node", "dof"]:
        raise MatrixFault(f"its first line must be `node,dof`, not {lines[0][:60]!r}")
    try:
        cells = [line.split(",") for line in lines[1:] if line.strip()]
        rows = np.array([(int(row[0]), int(row[1])) for row in cells], np.int64)
    except (ValueError, IndexError):
        raise MatrixFault("each line must hold two whole numbers, node and dof") from None
    if rows.size == 0:
        raise MatrixFault("it lists no dofs")
    return rows[:, 0], rows[:, 1]


def read_nodes(path: Path) -> tuple[Integers, Array, list[str]]:
    """Return numbers, coordinates and patches of nodes from a csv file, or from array `nodes` of an npz file.

    Parameters
    ----------
    path : Path
        The file, with columns NODE_COLUMNS and perhaps `patch`.

    Returns
    -------
    tuple of (nodes,) array of int, (nodes, 3) array and list of str
        Node numbers, coordinates in mm, and the patch of each node, empty for none.

    Raises
    ------
    MatrixFault
        For a file that is not valid, or a node that stands twice.
    """
    if path.suffix == ".npz":
        table = read_npz(path).get("nodes", np.zeros((0, 0)))
        if table.ndim != 2 or table.shape[1] != 4:
            raise MatrixFault("it must hold an array `nodes` of four columns: node, x, y, z in mm")
        numbers, patches = _real(table, "nodes"), [""] * len(table)
    else:
        rows = [row for row in csv.reader(read_lines(path)) if any(cell.strip() for cell in row)]
        header = [name.strip() for name in rows[0]]
        if tuple(header[:4]) != NODE_COLUMNS or header[4:] not in ([], ["patch"]):
            raise MatrixFault(f"its first line must be `{','.join(NODE_COLUMNS)}`, with or without `,patch`")
        try:
            numbers = np.array([[float(cell) for cell in row[:4]] for row in rows[1:]]).reshape(-1, 4)
        except ValueError:
            raise MatrixFault("nodes and coordinates must be numbers") from None
        patches = [row[4].strip() if len(row) > 4 else "" for row in rows[1:]]
    if not np.isfinite(numbers).all():
        raise MatrixFault("coordinates must be finite numbers")
    nodes = _whole_numbers(numbers[:, 0], "numbers of nodes")
    unique, counts = np.unique(nodes, return_counts=True)
    if (counts > 1).any():
        raise MatrixFault(f"node {unique[np.argmax(counts > 1)]} stands twice")
    return nodes, numbers[:, 1:], patches


def _real(array: AnyArray, quantity: str) -> Array:
    """Return an array as real numbers; refuse complex ones and texts by the word for what they are."""
    if array.dtype.kind not in "iuf":
        raise MatrixFault(f"{quantity} must be real numbers, not {array.dtype}")
    return np.asarray(array, float)


def _whole_numbers(array: AnyArray, quantity: str) -> Integers:
    """Return an array as whole numbers; refuse fractions, and numbers that are not finite."""
    numbers = _real(array, quantity)
    if not np.isfinite(numbers).all() or (numbers != np.floor(numbers)).any():
        raise MatrixFault(f"{quantity} must be whole numbers")
    return numbers.astype(np.int64)


def _whole(matrix: Any, dofs: tuple[Integers, Integers]) -> LabelledMatrix:
    """Return a matrix that is stored whole, with its rows."""
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1]:
        shape = " x ".join(map(str, matrix.shape)) or "of a single number"
        raise MatrixFault(f"it has shape {shape}; as many columns as rows are needed")
    if matrix.dtype.kind not in "iuf":
        raise MatrixFault(f"its entries must be real numbers, not {matrix.dtype}")
    return LabelledMatrix(*dofs, scipy.sparse.csc_array(matrix, dtype=float))
