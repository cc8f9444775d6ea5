"""Static condensation (Guyan 1965) and component modes (Craig and Bampton 1968) of a whole casing.

Interface rows b are six motions of every seat, foot and sensor that is an interface, each tied rigidly to its
nodes; all other rows i are inner ones:

    u_i = -K_ii^-1 K_ib u_b + Phi eta,   modes Phi with u_b = 0,   K_r = S^T K S,   M_r = S^T M S

Statics need the first part alone: with it K_r is exact, and modes carry no static load at the interfaces.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from facegear.arrays import Array, Integers
from facegear.casing.whole import WholeCasing, rigid_rows
from facegear.errors import InvalidInput, NotConverged

MOTIONS = 6
"""Motions of an interface: along x, y, z, then about x, y, z."""
DENSE = 400
"""Inner rows up to which all modes are computed by dense algebra; above, the lowest by Lanczos."""
SINGULAR = 1e-12
"""Smallest pivot over the largest, rows scaled to a unit diagonal, below which inner rows count as loose."""
MASSLESS = 1e-13
"""Square of the lowest frequency over that of a mode below which the mode counts as one without mass."""


@dataclass(frozen=True, eq=False)
class Interface:
    """Nodes that move with one point.

    - name: for messages and labels
    - nodes: numbers of the nodes that are tied rigidly to the point; one with six motions, or several
    - position (3,): the point, m, in the file's axes
    """

    name: str
    nodes: tuple[int, ...]
    position: Array


@dataclass(frozen=True, eq=False)
class Reduction:
    """A casing reduced to interfaces and modes: 6 rows an interface, then k modes; SI units, file's axes.

    Attributes
    ----------
    stiffness, mass : (n, n)
        n = 6 interfaces + k.
    damping : (n, n) or None
        N s/m, where the file has damping.
    frequencies : (k,)
        Of the modes with all interfaces held, Hz.
    sensors : (sensors, n)
        Motion of sensors along their directions, m/m.
    """

    stiffness: Array
    mass: Array
    damping: Array | None
    frequencies: Array
    sensors: Array


def reduce_casing(
    casing: WholeCasing,
    interfaces: Sequence[Interface],
    mode_count: int,
    sensors: Sequence[tuple[int, Array]] = (),
) -> Reduction:
    """Reduce a casing to interfaces and its lowest modes with these held.

    Parameters
    ----------
    casing : WholeCasing
        The casing.
    interfaces : sequence of Interface
        Seats and feet.
    mode_count : int
        Number of modes, dimensionless; all there are where they are fewer.
    sensors : sequence of tuple of int and (3,) array
        Node and direction of each sensor, in the file's axes.

    Returns
    -------
    Reduction
        SI units.

    Raises
    ------
    InvalidInput
        For interfaces that no node meets, or a stiffness that does not hold the inner rows.
    NotConverged
        If the modes are not found.
    """
    tie, inner = interface_rows(casing, interfaces)
    bound = np.setdiff1d(np.arange(casing.size), inner)
    stiffness, mass, damping = casing.stiffness, casing.mass, casing.damping
    shape = np.zeros((casing.size, tie.shape[1]))
    shape[bound] = tie[bound]
    frequencies, modes = np.zeros(0), np.zeros((inner.size, 0))
    if inner.size:
        factor = _Factor(stiffness[inner][:, inner])
        shape[inner] = -factor.solve(np.asarray(stiffness[inner] @ shape))
        if mode_count and mass.nnz:
            frequencies, modes = _fixed_modes(factor, mass[inner][:, inner], mode_count)
    shape = np.hstack([shape, np.zeros((casing.size, frequencies.size))])
    shape[inner, tie.shape[1] :] = modes
    reduced_stiffness = _congruent(stiffness, shape)
    # Inner rows are in balance under motions of the interfaces: modes and interfaces do not couple.
    first = tie.shape[1]
    reduced_stiffness[:first, first:] = reduced_stiffness[first:, :first] = 0.0
    reduced_stiffness[first:, first:] = np.diag((2.0 * np.pi * frequencies) ** 2)
    return Reduction(
        stiffness=reduced_stiffness,
        mass=_congruent(mass, shape),
        damping=None if damping is None else _congruent(damping, shape),
        frequencies=frequencies,
        sensors=np.array([_sensor_row(casing, node, along, shape) for node, along in sensors]).reshape(
            len(sensors), shape.shape[1]
        ),
    )


def interface_rows(casing: WholeCasing, interfaces: Sequence[Interface]) -> tuple[Array, Integers]:
    """Return how rows follow the interfaces, and which rows are inner ones.

    Parameters
    ----------
    casing : WholeCasing
        The casing.
    interfaces : sequence of Interface
        Seats and feet.

    Returns
    -------
    tuple of (n, 6 interfaces) array and array of int
        Motions of all rows by those of the interfaces, zero for inner rows; indices of inner rows.

    Raises
    ------
    InvalidInput
        If a node has no rows or belongs to two interfaces, or an interface would be free to turn.
    """
    tie = np.zeros((casing.size, MOTIONS * len(interfaces)))
    owner: dict[int, str] = {}
    for number, interface in enumerate(interfaces):
        at = slice(MOTIONS * number, MOTIONS * (number + 1))
        for node in interface.nodes:
            rows = casing.rows_of_node.get(node)
            if rows is None:
                raise InvalidInput(
                    interface.name, node, "a node that has rows in the stiffness of the casing"
                )
            if node in owner:
                raise InvalidInput(interface.name, node, f"a node that does not belong to {owner[node]}, too")
            owner[node] = interface.name
            directions = np.array(list(rows))
            arms = np.tile(casing.position_of_node[node] - interface.position, (directions.size, 1))
            tie[list(rows.values()), at] = rigid_rows(arms, directions)
        block = tie[:, at]
        scale = np.array([1.0, 1.0, 1.0, *3 * (1.0 / casing.extent,)])
        values = np.linalg.svd(block[block.any(axis=1)] * scale, compute_uv=False)
        if values.size < MOTIONS or values[-1] < 1e-6 * values[0]:
            condition = "nodes that take all six motions: one with rotations, or a patch of three or more"
            raise InvalidInput(interface.name, list(interface.nodes)[:10], condition)
    bound = {row for node in owner for row in casing.rows_of_node[node].values()}
    return tie, np.setdiff1d(np.arange(casing.size), np.array(sorted(bound), np.int64))


class _Factor:
    """Sparse factors of the inner stiffness (m, m), rows scaled to a unit diagonal."""

    def __init__(self, matrix: Any) -> None:
        diagonal = matrix.diagonal()
        if not (diagonal > 0.0).all():
            raise _loose(f"{diagonal.min():.3g} on its diagonal")
        self.matrix = matrix.tocsc()
        self.scale = 1.0 / np.sqrt(diagonal)
        scaling = scipy.sparse.diags_array(self.scale)
        unit = (scaling @ self.matrix @ scaling).tocsc()
        try:
            # No pivoting keeps the symmetric order, so that the pivots have the signs of the eigenvalues.
            self.factor = scipy.sparse.linalg.splu(
                unit,
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True, "Equil": False},
            )
        except RuntimeError:
            raise _loose("singular") from None
        pivots = self.factor.U.diagonal()
        if not pivots.min() > SINGULAR:
            raise _loose(f"smallest pivot {pivots.min():.3g} of the largest")

    def solve(self, load: Array) -> Array:
        """Return the motions (m, k) or (m,) of inner rows by loads on them, with one step of refinement."""
        motion = self._apply(load)
        return motion + self._apply(load - self.matrix @ motion)

    def _apply(self, load: Array) -> Array:
        """Return the motions by the factors alone."""
        scale = self.scale if load.ndim == 1 else self.scale[:, None]
        return np.asarray(scale * self.factor.solve(scale * load))


def _loose(value: str) -> InvalidInput:
    """Return the error for inner rows that no stiffness holds, or with a negative one."""
    condition = "such that it holds every row between seats and feet: no loose part"
    return InvalidInput("stiffness of the casing", value, condition)


def _fixed_modes(factor: _Factor, mass: Any, count: int) -> tuple[Array, Array]:
    """Return frequencies (k,), Hz, and shapes (m, k) of unit mass of the lowest modes with interfaces
    held.
    """
    size = mass.shape[0]
    if size <= DENSE or count >= size // 2:
        frequencies, shapes = own_modes(factor.matrix.toarray(), mass.toarray())
        return frequencies[:count], _with_sign(shapes[:, :count])
    operator = scipy.sparse.linalg.LinearOperator((size, size), matvec=factor.solve, dtype=float)
    start = np.random.default_rng(0).standard_normal(size)
    try:
        values, shapes = scipy.sparse.linalg.eigsh(
            factor.matrix, count, mass, sigma=0.0, OPinv=operator, v0=start
        )
    except scipy.sparse.linalg.ArpackError as error:
        raise NotConverged("modes of the casing", f"{count} modes", str(error)[:120]) from None
    order = np.argsort(values)
    values, shapes = values[order], shapes[:, order]
    masses = np.einsum("mk,mk->k", shapes, mass @ shapes)
    return np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi), _with_sign(shapes / np.sqrt(masses))


def _with_sign(shapes: Array) -> Array:
    """Return shapes (m, k) whose largest entry is positive, so that equal files give equal shapes."""
    largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=0)[None], axis=0)
    return np.asarray(shapes * np.sign(largest))


def own_modes(stiffness: Array, mass: Array) -> tuple[Array, Array]:
    """Return the modes of a held body whose mass matrix may be singular.

    K x = w^2 M x is solved as M x = (1 / w^2) K x, as K is positive definite and M need not be. Motions
    without mass follow the others statically and have no mode.

    Parameters
    ----------
    stiffness, mass : (n, n) array
        SI units.

    Returns
    -------
    tuple of (k,) array and (n, k) array
        Frequencies in Hz, rising, and shapes of unit mass.
    """
    inverse, shapes = scipy.linalg.eigh(mass, stiffness)
    inverse, shapes = inverse[::-1], shapes[:, ::-1]
    has_mass = inverse > MASSLESS * max(inverse.max(initial=0.0), 0.0)
    values = np.sqrt(1.0 / inverse[has_mass])
    return values / (2.0 * np.pi), shapes[:, has_mass] * values


def _congruent(matrix: Any, shape: Array) -> Array:
    """Return shape^T matrix shape, symmetric to the last bit."""
    product = shape.T @ (matrix @ shape)
    return np.asarray(0.5 * (product + product.T))


def _sensor_row(casing: WholeCasing, node: int, along: Array, shape: Array) -> Array:
    """Return the motion of a node along a direction by all coordinates of a reduction, (n,), m."""
    rows: Mapping[int, int] = casing.rows_of_node.get(node, {})
    if not {1, 2, 3} <= set(rows):
        raise InvalidInput(
            "sensor of the casing", node, "a node that moves along x, y and z in its stiffness"
        )
    unit = np.asarray(along, float) / np.linalg.norm(along)
    return np.asarray(unit @ shape[[rows[1], rows[2], rows[3]]])
