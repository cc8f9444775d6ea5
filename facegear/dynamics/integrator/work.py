"""Scratch space of the kernels."""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.lanes import LANES, aligned
from facegear.dynamics.integrator.roots import MAX_DEPTH, bernstein_matrix

Array = NDArray[np.float64]
ABREAST = 3 * LANES
"""Tangents moved side by side: as many vectors as the registers hold with what they are multiplied by."""


class RingSeries(NamedTuple):
    """Series of the bearings with play, (rows, rings): place, its tangent, r^2 and its powers, forces, their
    slopes; reciprocal (rings,) of r^2 where a ring presses, else 0.
    """

    x: Array
    y: Array
    dx: Array
    dy: Array
    square: Array
    reciprocal: Array
    inverse: Array
    cube: Array
    force_x: Array
    force_y: Array
    product: Array
    slope_xx: Array
    slope_xy: Array
    slope_yy: Array


class Work(NamedTuple):
    """Scratch space for one thread and one order p: coefficient tables have one row for each power of s.

    edge, active, acting, state, side, at_edge, at_parting describe the contact of each mesh during the step:
    side is the state as a number for vectors, active and acting are zero where a contact that may only push
    transmits nothing, at_parting says where its force is zero at the start of the step. powers (rows,
    harmonics) holds the Taylor coefficients of cos(j s) (even rows) and sin(j s) (odd rows) at 0; parts and
    kinds are used by Fourier series. bernstein holds the deflections' Bernstein coefficients over the step,
    least and most their bounds. block, block_deflection (rows, coordinates or meshes times ABREAST) and
    block_force: of tangents side by side. nodes: of the rule that integrates products of polynomials. rings:
    None without play. Tables that hang on sizes alone (powers, conversion, nodes) are shared and only read.
    """

    order: int
    y: Array
    deflection: Array
    stiffness: Array
    error: Array
    load: Array
    force: Array
    edge: Array
    active: Array
    acting: Array
    state: NDArray[np.int64]
    at_edge: NDArray[np.int64]
    side: Array
    at_parting: NDArray[np.int64]
    powers: Array
    parts: Array
    kinds: Array
    polynomial: Array
    scaled: Array
    bernstein: Array
    conversion: Array
    conversion_less: Array
    subdivision: Array
    tangent: Array
    tangent_deflection: Array
    block: Array
    block_deflection: Array
    block_force: Array
    zero_error: Array
    zero_load: Array
    sample: Array
    was_acting: Array
    least: Array
    most: Array
    nodes: Array
    rings: RingSeries | None


def make_work(packed: Packed, order: int) -> Work:
    """Allocate scratch space."""
    n, m = packed.mesh_jacobian.shape
    rows = order + 1
    harmonics = max(len(packed.stiffness), len(packed.error), len(packed.load))
    widest = max(packed.stiffness.shape[2], packed.error.shape[2])
    return Work(
        order=order,
        y=aligned(rows, n),
        deflection=aligned(rows, m),
        stiffness=aligned(rows, m),
        error=aligned(rows, m),
        load=aligned(rows, n),
        force=aligned(m),
        edge=aligned(m),
        active=aligned(m),
        acting=aligned(m),
        state=np.zeros(m, dtype=np.int64),
        at_edge=np.zeros(m, dtype=np.int64),
        side=aligned(m),
        at_parting=np.zeros(m, dtype=np.int64),
        powers=_powers(harmonics, rows),
        parts=aligned(2, harmonics, LANES),
        kinds=aligned(rows * widest),
        polynomial=aligned(rows),
        scaled=aligned(rows, m),
        bernstein=aligned(rows, m),
        conversion=bernstein_matrix(order),
        conversion_less=bernstein_matrix(order - 1),
        subdivision=aligned(MAX_DEPTH + 2, rows),
        tangent=aligned(rows, n),
        tangent_deflection=aligned(rows, m),
        block=aligned(rows, packed.n * ABREAST),
        block_deflection=aligned(rows, packed.m * ABREAST),
        block_force=aligned(packed.m * ABREAST),
        zero_error=aligned(rows, m),
        zero_load=aligned(rows, n),
        sample=aligned(n),
        was_acting=aligned(m),
        least=aligned(m),
        most=aligned(m),
        nodes=_gauss(order // 4 + 1),
        rings=_ring_series(rows, packed.rings.play.size) if packed.rings else None,
    )


def _ring_series(rows: int, wide: int) -> RingSeries:
    tables = {name: aligned(rows, wide) for name in RingSeries._fields}
    return RingSeries(**{**tables, "reciprocal": aligned(wide)})


@cache
def _gauss(count: int) -> Array:
    """Nodes and weights of Gauss's rule on [0, 1], shape (2, count)."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return np.array([0.5 + 0.5 * nodes, 0.5 * weights])


@cache
def _powers(harmonics: int, rows: int) -> Array:
    """j^i / i! with the signs of the cosine's and the sine's series, shape (rows, harmonics)."""
    table = np.ones((rows, harmonics))
    j = np.arange(harmonics)
    for i in range(1, rows):
        table[i] = table[i - 1] * j / i * (-1.0 if i % 2 == 0 else 1.0)
    return table
