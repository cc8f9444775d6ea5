"""Scratch space of the kernels."""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.lanes import LANES
from facegear.dynamics.integrator.roots import MAX_DEPTH, bernstein_matrix

Array = NDArray[np.float64]


class Work(NamedTuple):
    """Scratch space for one thread and one order p: coefficient tables have one row for each power of s.

    edge, active, acting, state, at_edge describe the contact of each mesh during the step. powers (rows,
    harmonics) holds the Taylor coefficients of cos(j s) (even rows) and sin(j s) (odd rows) at 0; parts and
    kinds are used by Fourier series. bernstein holds the deflections' Bernstein coefficients over the step,
    least and most their bounds. nodes: of the rule that integrates products of polynomials. ring_x to
    ring_slope_yy: series of the bearings with play, place, tangent, r^2 and its powers, forces, their slopes.
    Tables that hang on sizes alone (powers, conversion, nodes) are shared and only read.
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
    zero_error: Array
    zero_load: Array
    sample: Array
    scratch: Array
    was_acting: Array
    least: Array
    most: Array
    nodes: Array
    ring_x: Array
    ring_y: Array
    ring_dx: Array
    ring_dy: Array
    ring_square: Array
    ring_reciprocal: Array
    ring_inverse: Array
    ring_cube: Array
    ring_force_x: Array
    ring_force_y: Array
    ring_product: Array
    ring_slope_xx: Array
    ring_slope_xy: Array
    ring_slope_yy: Array


def make_work(packed: Packed, order: int) -> Work:
    """Allocate scratch space."""
    n, m = packed.mesh_jacobian.shape
    rows = order + 1
    harmonics = max(len(packed.stiffness), len(packed.error), len(packed.load))
    rings = packed.ring_play.size
    widest = max(packed.stiffness.shape[2], packed.error.shape[2])
    return Work(
        order=order,
        y=np.zeros((rows, n)),
        deflection=np.zeros((rows, m)),
        stiffness=np.zeros((rows, m)),
        error=np.zeros((rows, m)),
        load=np.zeros((rows, n)),
        force=np.zeros(m),
        edge=np.zeros(m),
        active=np.zeros(m),
        acting=np.zeros(m),
        state=np.zeros(m, dtype=np.int64),
        at_edge=np.zeros(m, dtype=np.int64),
        powers=_powers(harmonics, rows),
        parts=np.zeros((2, harmonics, LANES)),
        kinds=np.zeros(rows * widest),
        polynomial=np.zeros(rows),
        scaled=np.zeros((rows, m)),
        bernstein=np.zeros((rows, m)),
        conversion=bernstein_matrix(order),
        conversion_less=bernstein_matrix(order - 1),
        subdivision=np.zeros((MAX_DEPTH + 2, rows)),
        tangent=np.zeros((rows, n)),
        tangent_deflection=np.zeros((rows, m)),
        zero_error=np.zeros((rows, m)),
        zero_load=np.zeros((rows, n)),
        sample=np.zeros(n),
        scratch=np.zeros(n),
        was_acting=np.zeros(m),
        least=np.zeros(m),
        most=np.zeros(m),
        nodes=_gauss(order // 4 + 1),
        ring_x=np.zeros((rows, rings)),
        ring_y=np.zeros((rows, rings)),
        ring_dx=np.zeros((rows, rings)),
        ring_dy=np.zeros((rows, rings)),
        ring_square=np.zeros((rows, rings)),
        ring_reciprocal=np.zeros(rings),
        ring_inverse=np.zeros((rows, rings)),
        ring_cube=np.zeros((rows, rings)),
        ring_force_x=np.zeros((rows, rings)),
        ring_force_y=np.zeros((rows, rings)),
        ring_product=np.zeros((rows, rings)),
        ring_slope_xx=np.zeros((rows, rings)),
        ring_slope_xy=np.zeros((rows, rings)),
        ring_slope_yy=np.zeros((rows, rings)),
    )


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
