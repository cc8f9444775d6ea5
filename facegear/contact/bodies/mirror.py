"""Split of a body that is its own mirror image into two bodies of half the size.

Displacements that are even across the middle plane do not mix with those that are odd. Either kind is
known from the half before the plane, where it is held along the plane's normal or across it. An element
that the plane crosses counts half and is not cut, so that both halves together are the whole to rounding.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers, Mask
from facegear.contact.bodies.cellwise import Part
from facegear.contact.bodies.layer import TiedSystem

IMAGE = np.array([1.0, -1.0, 1.0])
"""Signs of a vector's mirror image."""
ON_THE_PLANE = 1e-6
"""Distance of an element's centre from the middle plane over the width of the body."""


@dataclass(frozen=True, eq=False)
class Half:
    """The half of a system before its middle plane, for even (`sign` 1) or odd (-1) displacements.

    `fold` (3n, 3h): displacements of all n masters by those of its h masters. `system` is the whole one where
    there is no such plane, with `sign` 0.
    """

    system: TiedSystem
    sign: float
    fold: sp.csr_matrix


def halves(system: TiedSystem) -> list[Half]:
    """Split a system that is its own mirror image into two halves.

    Parameters
    ----------
    system : TiedSystem
        The whole system.

    Returns
    -------
    list[Half]
        Even and odd half; one entry, the system itself, if it is not its own mirror image.
    """
    if not system.mirror.size:
        return [Half(system, 0.0, sp.eye(3 * len(system.points), format="csr"))]
    parts, centres = _before_the_plane(system)
    return [_half(replace(system, parts=parts, centres=centres), sign) for sign in (1.0, -1.0)]


def unfold_matrix(even: Array, odd: Array, shape: tuple[int, int], rows: bool = True) -> Array:
    """Return the matrix of the whole lattice from those of both halves.

    Parameters
    ----------
    even : (..., nu h, nu h) array
        Matrix of the even half, any unit.
    odd : (..., nu h, nu h) array
        Matrix of the odd half, same unit.
    shape : tuple[int, int]
        Lattice (nu, h) of a half.
    rows : bool
        Whether rows stand for nodes of the lattice, too; if not, the shapes are (..., g, nu h) and (...,
        g, nu nv).

    Returns
    -------
    (..., nu nv, nu nv) array
        Matrix, same unit.
    """
    across, half = shape
    whole, before, behind = 2 * half - 1, slice(0, half), slice(half, None)
    image = slice(half - 2, None, -1) if half > 1 else slice(0, 0)
    ends = (across, half, across, half) if rows else (even.shape[-2], 1, across, half)
    same_side, across_plane = (
        0.5 * combination.reshape(*even.shape[:-2], *ends) for combination in (even + odd, even - odd)
    )
    row_width = whole if rows else 1
    result = np.empty((*even.shape[:-2], ends[0], row_width, across, whole))
    for at, from_row in ((before, before), (behind, image)) if rows else ((before, before),):
        near, far = (same_side, across_plane) if at is before else (across_plane, same_side)
        result[..., at, :, before] = near[..., from_row, :, :]
        result[..., at, :, behind] = far[..., from_row, :, image]
    return result.reshape(*even.shape[:-2], -1, across * whole)


def _before_the_plane(system: TiedSystem) -> tuple[tuple[Part, ...], Array]:
    """Return elements before the middle plane, those on it with half weight, and the centres of
    their cells.
    """
    width = np.ptp(system.points[:, 1])
    plane = system.points[:, 1].min() + 0.5 * width
    selections = []
    for part in system.parts:
        along = part.rows[:, part.rows.shape[1] // 3 : 2 * part.rows.shape[1] // 3]
        beyond = (part.transformation @ system.points.ravel())[along].mean(axis=1) - plane
        members = np.flatnonzero(beyond <= ON_THE_PLANE * width)
        weights = np.where(beyond[members] < -ON_THE_PLANE * width, 1.0, 0.5)
        selections.append((part, members, weights))
    cells = np.unique(np.concatenate([part.cell[members] for part, members, _ in selections]))
    number = np.full(len(system.centres), -1)
    number[cells] = np.arange(cells.size)
    parts = tuple(
        part.select(members, weights, number[part.cell[members]]) for part, members, weights in selections
    )
    return parts, system.centres[cells]


def _half(system: TiedSystem, sign: float) -> Half:
    behind, count = system.mirror, len(system.points)
    on_plane = behind == np.arange(count)
    before = on_plane | (system.points[:, 1] < system.points[behind, 1])
    half_nodes = np.flatnonzero(before)
    number = np.full(count, -1)
    number[half_nodes] = np.arange(half_nodes.size)
    image = np.where(before, number, number[behind])
    is_held = system.is_held.copy()
    is_held[np.ix_(on_plane, [1] if sign > 0 else [0, 2])] = True
    values = np.where(before[:, None], 1.0, sign * IMAGE)
    columns = 3 * image[:, None] + np.arange(3)
    fold = sp.csr_matrix(
        (values.ravel(), columns.ravel(), np.arange(3 * count + 1)), shape=(3 * count, 3 * half_nodes.size)
    )
    nu, nv = system.surface.shape[:2]
    lattice = slice(0, nv // 2 + 1)
    loaded_rows, spread = _loaded_masters(system, before & ~(on_plane & (sign < 0)), image, sign)
    rows = np.arange(nu * nv).reshape(nu, nv)[:, lattice].ravel()
    half = TiedSystem(
        parts=tuple(part.seen_by(fold) for part in system.parts),
        points=system.points[half_nodes],
        is_held=is_held[half_nodes],
        coarse=np.where(system.coarse >= 0, np.where(before, number, -1)[system.coarse], -1),
        surface=system.surface[:, lattice],
        normals=system.normals[:, lattice],
        loaded_nodes=number[system.loaded_nodes[loaded_rows]],
        loaded_normals=system.loaded_normals[loaded_rows],
        spread=(system.spread[rows] @ spread).tocsr(),
        centres=system.centres,
        left=number[system.left[before[system.left]]],
        right=number[system.right[before[system.right]]],
        turn=system.turn,
        mirror=behind[:0],
    )
    return Half(half, sign, fold)


def _loaded_masters(
    system: TiedSystem, moves: Mask, image: Integers, sign: float
) -> tuple[Integers, sp.csr_matrix]:
    """Return the loaded masters that stay in a half, and the normal displacements of all masters by
    theirs.
    """
    stay = np.flatnonzero(moves[system.loaded_nodes])
    column = np.full(image.max() + 1, -1)
    column[image[system.loaded_nodes[stay]]] = np.arange(stay.size)
    at = column[image[system.loaded_nodes]]
    rows = np.flatnonzero(at >= 0)
    values = np.where(moves[system.loaded_nodes[rows]], 1.0, sign)
    return stay, sp.csr_matrix((values, (rows, at[rows])), shape=(system.loaded_nodes.size, stay.size))
