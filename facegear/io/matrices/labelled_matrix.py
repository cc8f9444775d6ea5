"""Square matrices whose rows carry the node and the direction that a finite-element program gives them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any
from warnings import catch_warnings, simplefilter

import numpy as np
import scipy

from facegear.arrays import Array, Integers
from facegear.errors import plain_reason
from facegear.number_format import count_noun

DIRECTIONS = 6
"""Directions of a node: motion along x, y, z, then rotation about x, y, z, numbered from 1."""


class MatrixFault(Exception):
    """Reason why a matrix cannot be used; the text is one line that follows the file's name."""


@dataclass(frozen=True, eq=False)
class LabelledMatrix:
    """A square matrix and what its rows are.

    Attributes
    ----------
    node : (n,)
        Node of each row; 0 for a mode.
    direction : (n,)
        1 to 6 of a node; the number of a mode, from 1.
    matrix : sparse array (n, n)
        Entries in the units of the file.
    """

    node: Integers
    direction: Integers
    matrix: Any

    def __post_init__(self) -> None:
        if self.matrix.shape != (self.node.size, self.node.size):
            rows, columns = self.matrix.shape
            raise MatrixFault(
                f"it has {rows} rows and {columns} columns, but {count_noun(self.node.size, 'dof')}"
            )
        is_node = self.node != 0
        wrong = is_node & ((self.direction < 1) | (self.direction > DIRECTIONS))
        if wrong.any():
            first = int(np.argmax(wrong))
            raise MatrixFault(
                f"node {self.node[first]} has dof {self.direction[first]}; 1 to 3 are motions along, 4 to 6 "
                "rotations about x, y, z"
            )
        rows = np.stack([self.node, self.direction], axis=1)
        unique, counts = np.unique(rows, axis=0, return_counts=True)
        if (counts > 1).any():
            node, direction = unique[np.argmax(counts > 1)]
            raise MatrixFault(f"dof {direction} of node {node} stands twice")
        if not np.isfinite(self.matrix.data).all():
            raise MatrixFault("it holds an entry that is not a finite number")

    @property
    def size(self) -> int:
        """Number n of rows."""
        return int(self.node.size)

    def in_order_of(self, reference: "LabelledMatrix") -> Any:
        """Return the matrix with the rows of the reference, in its order.

        Rows that this matrix lacks are zero, as those of motions without mass.

        Parameters
        ----------
        reference : LabelledMatrix
            The matrix whose rows count.

        Returns
        -------
        sparse array (n, n)
            In the units of this file.

        Raises
        ------
        MatrixFault
            If this matrix has a row that the reference lacks.
        """
        if np.array_equal(self.node, reference.node) and np.array_equal(self.direction, reference.direction):
            return self.matrix
        number_of_row = {
            row: number for number, row in enumerate(zip(reference.node, reference.direction, strict=True))
        }
        at = np.array(
            [number_of_row.get(row, -1) for row in zip(self.node, self.direction, strict=True)], np.int64
        )
        if (at < 0).any():
            first = int(np.argmax(at < 0))
            raise MatrixFault(
                f"it has dof {self.direction[first]} of node {self.node[first]}, which the stiffness lacks"
            )
        coordinates = self.matrix.tocoo()
        return scipy.sparse.csc_array(
            (coordinates.data, (at[coordinates.row], at[coordinates.col])),
            shape=(reference.size, reference.size),
        )


def from_entries(
    rows: Integers, columns: Integers, values: Array, triangle: bool | None = None
) -> tuple[Integers, Integers, Any]:
    """Build a symmetric matrix from entries whose rows and columns are named `8 * node + direction`.

    Parameters
    ----------
    rows, columns : (entries,) array of int
        Names of rows and columns.
    values : (entries,) array
        Entries, any unit.
    triangle : bool or None
        Whether the file holds one triangle; None to tell from the entries, as no file that holds both has
        an entry without its mirror image.

    Returns
    -------
    tuple of two arrays and a sparse array
        Node and direction of each row, (n,), in rising order; the matrix (n, n).
    """
    names, number = np.unique(np.concatenate([rows, columns]), return_inverse=True)
    row, column = np.split(number.ravel(), 2)
    node, direction = names // 8, names % 8
    return node, direction, symmetric(row, column, values, names.size, triangle)


def symmetric(row: Integers, column: Integers, values: Array, size: int, triangle: bool | None = None) -> Any:
    """Build a matrix from entries that hold one triangle or all of it.

    Parameters
    ----------
    row, column : (entries,) array of int
        Indices from 0.
    values : (entries,) array
        Entries, any unit.
    size : int
        Number n of rows.
    triangle : bool or None
        As in `from_entries`.

    Returns
    -------
    sparse array (n, n)
        One triangle is mirrored.
    """
    matrix = scipy.sparse.coo_array((values, (row, column)), shape=(size, size)).tocsc()
    if triangle is None:
        pattern = scipy.sparse.coo_array((np.ones(row.size), (row, column)), shape=(size, size)).tocsr()
        pattern.setdiag(0.0)
        triangle = not pattern.multiply(pattern.T).count_nonzero()
    if not triangle:
        return matrix
    return (matrix + matrix.T - scipy.sparse.diags_array(matrix.diagonal())).tocsc()


def read_lines(path: Path) -> list[str]:
    """Return the lines of a text file.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    list of str
        Lines without their ends.

    Raises
    ------
    MatrixFault
        If it is missing, empty or not text.
    """
    try:
        lines = path.read_text("utf-8-sig").splitlines()
    except FileNotFoundError:
        raise MatrixFault("no such file") from None
    except UnicodeDecodeError:
        raise MatrixFault("it is not text in UTF-8") from None
    except OSError as error:
        raise MatrixFault(f"it cannot be read ({plain_reason(error)})") from None
    if not any(line.strip() for line in lines):
        raise MatrixFault("it is empty")
    return lines


def read_numbers(path: Path, columns: int, separator: str | None = None) -> Array:
    """Return lines of as many numbers each.

    Parameters
    ----------
    path : Path
        The file.
    columns : int
        Numbers in a line; 0 for as many as the first line has.
    separator : str or None
        Text between two numbers; None for blanks.

    Returns
    -------
    (lines, columns) array
        The numbers, any unit.

    Raises
    ------
    MatrixFault
        For a file that cannot be read, or a line that holds something else.
    """
    if not path.is_file():
        raise MatrixFault("no such file")
    if not path.stat().st_size:
        raise MatrixFault("it is empty")
    try:
        with catch_warnings():
            simplefilter("ignore", UserWarning)  # of numpy, on a file without numbers
            numbers = np.loadtxt(path, delimiter=separator, ndmin=2, encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        raise MatrixFault(f"it is not a table of numbers ({_short(error)})") from None
    if numbers.size == 0:
        raise MatrixFault("it is empty")
    if columns and numbers.shape[1] != columns:
        raise MatrixFault(f"it must have {columns} numbers in a line")
    return numbers


def _short(error: Exception) -> str:
    """Return the first line of an error's text, at most 120 letters."""
    return str(error).splitlines()[0][:120]
