"""The casing as a finite-element program gives it: matrices, rows and nodes, in SI units, and what refuses
it.

A file says nothing about its units, whether one triangle is all, or whether rows belong to the nodes that are
listed. Rigid motions tell: a casing that is free must not resist them, and its mass follows from them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from facegear.arrays import AnyArray, Array, Integers
from facegear.errors import InvalidInput
from facegear.io.matrices.labelled_matrix import LabelledMatrix, MatrixFault
from facegear.number_format import count_noun

SYMMETRIC = 1e-8
"""Skew part of a matrix over its size up to which it counts as rounding."""
FREE = 1e-6
"""Force by a rigid motion over the size of the stiffness up to which a casing counts as free.

A file with ten digits gives 1e-10, coordinates in another unit than the rotations 0.1 or more."""
LOOSE = 1e-9
"""Stiffness of feet against a rigid motion over the largest up to which they do not hold it."""
LIGHTEST, HEAVIEST = 4.0, 2e4
"""Mass over the cube of the largest extent, kg/m3, beyond which the unit of a casing is doubted.

A frame of thin walls has 20, a solid block of steel 7850."""
UNEVEN = 0.01
"""Difference of masses along x, y and z over their mean from which rows are told to be in the wrong order."""
UNITS = {"mm_t_s": 1e3, "si": 1.0}
"""Length units of a metre by the names of systems of units; forces are N in both."""
UNIT_FACTOR = 1e3
"""Factor between masses in t and kg."""


@dataclass(frozen=True, eq=False)
class WholeCasing:
    """Matrices of a casing over n rows, in SI units and the file's axes.

    Attributes
    ----------
    node, direction : (n,)
        What each row is, as in `LabelledMatrix`.
    stiffness, mass : sparse array (n, n)
        N/m, N, N m and kg, kg m, kg m2.
    damping : sparse array (n, n) or None
        N s/m; None where none is given.
    numbers : (nodes,)
        Numbers of the nodes whose place is known.
    positions : (nodes, 3)
        Their positions, m.
    patches : list of str
        Name of the patch that each of these nodes belongs to, empty for none.
    """

    node: Integers
    direction: Integers
    stiffness: Any
    mass: Any
    damping: Any
    numbers: Integers
    positions: Array
    patches: Sequence[str]

    @property
    def size(self) -> int:
        """Number n of rows."""
        return int(self.node.size)

    @cached_property
    def rows_of_node(self) -> dict[int, dict[int, int]]:
        """Row of each direction of each node: `rows_of_node[node][direction]`."""
        rows: dict[int, dict[int, int]] = {}
        for row, (node, direction) in enumerate(
            zip(self.node.tolist(), self.direction.tolist(), strict=True)
        ):
            if node:
                rows.setdefault(node, {})[direction] = row
        return rows

    @cached_property
    def position_of_node(self) -> dict[int, Array]:
        """Place of each node, m."""
        return dict(zip(self.numbers.tolist(), self.positions, strict=True))

    def rigid_motions(self, about: Array) -> Array:
        """Return the motions of all rows by the six rigid motions of the casing about a point.

        Parameters
        ----------
        about : (3,) array
            The point, m.

        Returns
        -------
        (n, 6) array
            m and rad for a unit of motion along or rotation about x, y, z; 0 in rows of modes.
        """
        motions = np.zeros((self.size, 6))
        is_node = self.node != 0
        positions = np.array([self.position_of_node[int(node)] for node in self.node[is_node]])
        motions[is_node] = rigid_rows(positions - about, self.direction[is_node])
        return motions

    def scale(self, length: float) -> Array:
        """Return what one metre of each row is: 1 for motions along, 1 / length for rotations and modes.

        Parameters
        ----------
        length : float
            Length that turns rotations into motions, m.

        Returns
        -------
        (n,) array
            m/m and rad/m.
        """
        return np.where((self.node != 0) & (self.direction <= 3), 1.0, 1.0 / length)

    @property
    def extent(self) -> float:
        """Largest extent of the nodes along an axis, m; 1 for a single node."""
        node_positions = [self.position_of_node[node] for node in self.rows_of_node]
        return float(np.ptp(node_positions, axis=0).max(initial=0.0)) or 1.0

    @cached_property
    def rigid_mass(self) -> Array:
        """Mass matrix of the six rigid motions about the mean of the nodes, (6, 6), kg, kg m and kg m2."""
        motions = self.rigid_motions(np.mean(list(self.position_of_node.values()), axis=0))
        return np.asarray(motions.T @ (self.mass @ motions))

    @property
    def total_mass(self) -> float:
        """Mass, kg: the mean over motions along x, y and z."""
        return float(np.trace(self.rigid_mass[:3, :3])) / 3.0

    def rigid_force(self) -> float:
        """Return the largest force that resists a rigid motion, over the largest entry of the stiffness.

        Rotations are scaled by the extent of the nodes.

        Returns
        -------
        float
            Rounding for a casing that is free; dimensionless.
        """
        length = self.extent
        scale = self.scale(length)
        motions = self.rigid_motions(np.mean(list(self.position_of_node.values()), axis=0))
        motions[:, 3:] /= length
        forces = scale[:, None] * (self.stiffness @ motions)
        return float(np.abs(forces).max() / (_largest(self.stiffness, scale) or 1.0))


def rigid_rows(positions: Array, directions: Integers) -> Array:
    """Return motions of rows by the rigid motions of a body about the origin.

    Parameters
    ----------
    positions : (rows, 3) array
        Place of the node of each row, m.
    directions : (rows,) array of int
        Direction of each row, 1 to 6.

    Returns
    -------
    (rows, 6) array
        m and rad for a unit of motion along or rotation about x, y, z: [1, -(d x)].
    """
    x, y, z = positions.T
    zeros = np.zeros_like(x)
    around = np.stack(
        [np.stack([zeros, z, -y], 1), np.stack([-z, zeros, x], 1), np.stack([y, -x, zeros], 1)], axis=1
    )
    whole = np.zeros((len(positions), 6, 6))
    whole[:, :3, :3] = whole[:, 3:, 3:] = np.eye(3)
    whole[:, :3, 3:] = around
    return np.asarray(whole[np.arange(len(positions)), directions - 1])


def whole_casing(
    stiffness: LabelledMatrix,
    mass: LabelledMatrix | None,
    damping: LabelledMatrix | None,
    nodes: tuple[Integers, Array, Sequence[str]],
    units: str,
) -> WholeCasing:
    """Bring the matrices of files to SI units and one order of rows.

    Parameters
    ----------
    stiffness : LabelledMatrix
        Stiffness in the units of the file.
    mass, damping : LabelledMatrix or None
        None for none: a casing without mass, or with a damping ratio.
    nodes : tuple of (nodes,) array, (nodes, 3) array and sequence of str
        Numbers, coordinates in mm and patches of the nodes.
    units : str
        `mm_t_s` or `si`.

    Returns
    -------
    WholeCasing
        SI units.

    Raises
    ------
    InvalidInput
        For matrices that are not symmetric, rows that do not fit, or nodes without a place.
    """
    per_metre = UNITS[units]
    scale = np.where((stiffness.node != 0) & (stiffness.direction <= 3), per_metre, 1.0)
    # Energy in N mm is 1e-3 J; that of masses in t and mm, too.
    joules = 1.0 / per_metre
    matrices = {}
    for quantity, file_matrix in (("stiffness", stiffness), ("mass", mass), ("damping", damping)):
        if file_matrix is None:
            continue
        try:
            matrix = file_matrix.in_order_of(stiffness)
        except MatrixFault as fault:
            raise InvalidInput(
                f"{quantity} of the casing", "rows", f"those of its stiffness: {fault}"
            ) from None
        matrices[quantity] = _require_symmetric(quantity, _scale_rows(matrix, scale) * joules)
    numbers, coordinates, patches = nodes
    absent_nodes = np.setdiff1d(stiffness.node[stiffness.node != 0], numbers)
    if absent_nodes.size:
        condition = f"with node {absent_nodes[0]}, which has rows in its stiffness"
        raise InvalidInput("nodes of the casing", count_noun(numbers.size, "node"), condition)
    has_rows = np.isin(numbers, stiffness.node)
    empty = scipy.sparse.csc_array((stiffness.size, stiffness.size))
    return WholeCasing(
        stiffness.node,
        stiffness.direction,
        matrices["stiffness"],
        matrices.get("mass", empty),
        matrices.get("damping"),
        numbers[has_rows],
        1e-3 * coordinates[has_rows],
        [patch for patch, has_row in zip(patches, has_rows, strict=True) if has_row],
    )


def require_free(casing: WholeCasing) -> None:
    """Refuse a casing that resists rigid motions although its feet are mounted by the config.

    Parameters
    ----------
    casing : WholeCasing
        The casing.

    Raises
    ------
    InvalidInput
        If a rigid motion meets more force than FREE of the largest entry.
    """
    if (force := casing.rigid_force()) > FREE:
        condition = (
            f"free of its feet: rigid motions meet {force:.1e} of its largest entry, above {FREE:g}. Are "
            "feet clamped in the file already, nodes in another unit or order than the rows, bearings part "
            "of the matrix, or seats in axes of their own?"
        )
        raise InvalidInput("stiffness of the casing", count_noun(casing.size, "row"), condition)


def require_held(casing: WholeCasing, feet: Sequence[tuple[Array, Array | None]]) -> None:
    """Refuse a free casing whose feet do not hold it.

    Parameters
    ----------
    casing : WholeCasing
        The casing.
    feet : sequence of tuple of (3,) array and (6,) array or None
        Place (m) and springs (N/m and N m/rad) of each foot; None for one that is held.

    Raises
    ------
    InvalidInput
        If a rigid motion meets no force.
    """
    if any(springs is None for _, springs in feet) or casing.rigid_force() > FREE:
        return
    about = np.mean(list(casing.position_of_node.values()), axis=0)
    stiffness, length = np.zeros((6, 6)), casing.extent
    for position, springs in feet:
        motions = rigid_rows(np.tile(position - about, (6, 1)), np.arange(1, 7))
        stiffness += motions.T @ np.diag(springs if springs is not None else np.zeros(6)) @ motions
    scale = np.array([1.0, 1.0, 1.0, *3 * (1.0 / length,)])
    values = np.linalg.eigvalsh(stiffness * np.outer(scale, scale))
    loose = int((values <= LOOSE * values[-1]).sum())
    if loose:
        value = f"{count_noun(loose, 'free motion')}"
        raise InvalidInput("feet of the casing", value, "such that they hold the casing")


def require_mass(casing: WholeCasing, mass: float | None) -> None:
    """Refuse a mass that is off by the factor of a wrong unit.

    Parameters
    ----------
    casing : WholeCasing
        The casing.
    mass : float or None
        Mass of the casing as the user knows it, kg; None to compare with the space that it fills.

    Raises
    ------
    InvalidInput
        For a mass off by 1e3 or 1e-3, with the likely unit, or by more than a tenth of a given mass; where
        it differs along x, y and z, for the order of its rows.
    """
    if not casing.mass.nnz:
        return
    total = casing.total_mass
    if not total > 0.0:
        raise InvalidInput("mass of the casing", f"{total:.4g} kg", "above 0 kg along x, y and z")
    low, high = (
        (0.9 * mass, 1.1 * mass) if mass else (LIGHTEST * casing.extent**3, HEAVIEST * casing.extent**3)
    )
    if low <= total <= high:
        return
    parts = np.diagonal(casing.rigid_mass)[:3]
    if not mass and np.ptp(parts) > UNEVEN * total:
        value = ", ".join(f"{part:.4g}" for part in parts) + " kg along x, y, z"
        condition = "equal along x, y and z: are its rows in another order than the dofs?"
        raise InvalidInput("mass of the casing", value, condition)
    for factor, unit in ((UNIT_FACTOR, "mm_t_s"), (1.0 / UNIT_FACTOR, "si")):
        if low <= total * factor <= high:
            requirement = f"{total * factor:.4g} kg, as with units {unit}; is that the unit of its matrices?"
            raise InvalidInput("mass of the casing", f"{total:.4g} kg", requirement)
    requirement = f"from {low:.4g} to {high:.4g} kg" + ("" if mass else " in the space that its nodes span")
    raise InvalidInput("mass of the casing", f"{total:.4g} kg", requirement)


def _scale_rows(matrix: Any, scale: Array) -> Any:
    """Return a sparse matrix with rows and columns multiplied by `scale` (n,)."""
    diagonal = scipy.sparse.diags_array(scale)
    return (diagonal @ matrix @ diagonal).tocsc()


def _largest(matrix: Any, scale: AnyArray) -> float:
    """Return the largest entry of a sparse matrix in size, rows and columns multiplied by `scale`."""
    return float(np.abs(_scale_rows(matrix, scale).data).max(initial=0.0))


def _require_symmetric(quantity: str, matrix: Any) -> Any:
    """Return the symmetric part of a matrix; refuse a skew part above SYMMETRIC of its size."""
    skew = (matrix - matrix.T).tocoo()
    size = np.sqrt(np.abs(matrix.diagonal()))
    excess = np.abs(skew.data) > SYMMETRIC * size[skew.row] * size[skew.col]
    if excess.any():
        row = int(skew.row[np.argmax(excess)])
        column = int(skew.col[np.argmax(excess)])
        entries = (
            f"{matrix[row, column]:.6g} and {matrix[column, row]:.6g} in rows {row + 1} and {column + 1}"
        )
        condition = f"symmetric to {SYMMETRIC:g}: is one triangle of it missing?"
        raise InvalidInput(f"{quantity} of the casing", entries, condition)
    return (0.5 * (matrix + matrix.T)).tocsc()
