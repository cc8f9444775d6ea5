"""A system at one speed, packed for the compiled kernels, with time counted as mesh phase s in rad."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.system import System

Array = NDArray[np.float64]
LANES = 4
TAU = 2.0 * np.pi


class Packed(NamedTuple):
    """Arrays padded to whole SIMD lanes; padded meshes and coordinates are zero and stay at rest.

    directions (n, m) and transposed (m, n); squares and load over w^2, damping and mesh_damping over w,
    stiffness over w^2, so that derivatives are by s = w t.
    """

    n: int
    m: int
    directions: Array
    transposed: Array
    squares: Array
    damping: Array
    mesh_damping: Array
    lower: Array
    upper: Array
    stiffness: Array
    stiffness_kind: NDArray[np.int64]
    error: Array
    error_kind: NDArray[np.int64]
    load: Array
    breaks: Array
    pieces: Array
    weights: Array
    damping_when_open: bool
    scale: float


def pack(system: System, frequency: float) -> Packed:
    """Pack a system at an angular mesh frequency w in rad/s."""
    m, n = system.directions.shape
    wide_n, wide_m = -(-n // LANES) * LANES, -(-m // LANES) * LANES
    directions = np.zeros((wide_m, wide_n))
    directions[:m, :n] = system.directions
    breaks, pieces = _pieces(system)
    return Packed(
        n=n,
        m=m,
        directions=np.ascontiguousarray(directions.T),
        transposed=directions,
        squares=_padded(system.squares, wide_n) / frequency**2,
        damping=_padded(system.damping, wide_n) / frequency,
        mesh_damping=_padded(system.mesh_damping, wide_m) / frequency,
        lower=_padded(system.lower, wide_m),
        upper=_padded(system.upper, wide_m),
        stiffness=np.ascontiguousarray(system.stiffness) / frequency**2,
        stiffness_kind=_padded(system.stiffness_kind, wide_m),
        error=np.ascontiguousarray(system.error),
        error_kind=_padded(system.error_kind, wide_m),
        load=_padded(system.load, wide_n) / frequency**2,
        breaks=breaks,
        pieces=pieces / frequency**2,
        weights=np.abs(directions).max(axis=0),
        damping_when_open=system.damping_when_open,
        scale=system.scale,
    )


def _padded(values: NDArray, length: int) -> NDArray:
    wide = np.zeros((length, *values.shape[1:]), dtype=values.dtype)
    wide[: len(values)] = values
    return wide


def _pieces(system: System) -> tuple[Array, Array]:
    """Common breaks of all kinds of mesh in rad, and (kinds, pieces, degree + 1) coefficients in rad
    powers.
    """
    if not system.pieces:
        return np.zeros(0), np.zeros((0, 0, 0))
    breaks = np.unique(np.concatenate([piece.breaks for piece in system.pieces]))
    degree = max(piece.coefficients.shape[1] for piece in system.pieces)
    table = np.zeros((len(system.pieces), breaks.size - 1, degree))
    for row, piece in zip(table, system.pieces, strict=True):
        for target, start in zip(row, breaks[:-1], strict=True):
            source = int(np.searchsorted(piece.breaks, start, side="right")) - 1
            shifted = np.polynomial.Polynomial(piece.coefficients[source])(
                np.polynomial.Polynomial([start - piece.breaks[source], 1.0])
            )
            target[: shifted.coef.size] = shifted.coef / TAU ** np.arange(shifted.coef.size)
    return breaks * TAU, table
