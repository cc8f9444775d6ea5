"""Scratch space of the kernels."""

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.roots import MAX_DEPTH, bernstein_matrix
from facegear.dynamics.integrator.system import System
from facegear.machine_code.fourier import FourierScratch, fourier_scratch
from facegear.machine_code.memory import LANES, aligned, aligned_together
from facegear.machine_code.records import Record

ABREAST = 3 * LANES
"""Tangents moved side by side: as many vectors as the registers hold with what they are multiplied by."""


@Record.register
class RingSeries(NamedTuple):
    """Series of bearings with clearance (rows, rings): displacement, its tangent, r^2 and its powers, forces,
    their slopes; reciprocal (rings,) of r^2 where a ring presses, else 0.
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


@Record.register
class RubbingSeries(NamedTuple):
    """Series of friction: ratios (rows, forces of friction) and elastic forces (rows, flanks)."""

    ratios: Array
    forces: Array


@Record.register
class Pressing(NamedTuple):
    """Rows of every block that may hold a force: those of block b are rows[starts[b]:starts[b + 1]]."""

    starts: Integers
    rows: Integers


@Record.register
class Work(NamedTuple):
    """Scratch space for one thread and one order p: coefficient tables have one row for each power of s.

    edge, active, acting, state, side, at_level, at_parting describe the contact of each mesh during the step.
    edge is the deflection from which it is counted, state the piece of the law as facegear.mesh_law.terms
    counts it, side its sign as a number for vectors; active and acting are zero where a contact that may only
    push transmits nothing. at_level is 0 but for a mesh that stands where piece p (-p on the back flank)
    begins, at_parting says where the force is zero at the start of the step. law: the law's own series;
    fourier and per_kind are used by Fourier series. bernstein holds the deflections' Bernstein coefficients
    over the step, lower_bound and upper_bound their extremes. block, block_deflection (rows, coordinates or
    meshes times ABREAST) and block_force: of tangents side by side. nodes: of the rule that integrates
    products of polynomials. rings: None without bearing clearance; rubbing: None without friction. coupled:
    what the matrices of Packed.coupled are multiplied by; pressing: None without them. Tables that hang on
    sizes alone (conversion, nodes) are shared and only read.
    """

    order: int
    y: Array
    deflection: Array
    error: Array
    load: Array
    force: Array
    edge: Array
    active: Array
    acting: Array
    state: Integers
    at_level: Integers
    side: Array
    at_parting: Integers
    law: Any
    fourier: FourierScratch
    per_kind: Array
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
    lower_bound: Array
    upper_bound: Array
    nodes: Array
    rings: RingSeries | None
    rubbing: RubbingSeries | None
    coupled: Array
    pressing: Pressing | None


def sizes(system: System, packed: Packed) -> tuple[object, ...]:
    """What scratch space depends on beside the order: that of systems with the same ones may be shared."""
    rubbing, rings, coupled = packed.rubbing, packed.rings, packed.coupled
    return (
        (packed.n, packed.m, *packed.mesh_jacobian.shape),
        (packed.error.shape[2], _harmonics(system, packed)),
        type(system.law),
        rings and rings.clearance.size,
        rubbing and rubbing.ratios.shape,
        coupled and (coupled.blocks.starts.size, coupled.blocks.rows.size),
    )


def _harmonics(system: System, packed: Packed) -> int:
    """Harmonics and the mean of the longest series."""
    ratios = 0 if packed.rubbing is None else len(packed.rubbing.ratios)
    return max(system.law.harmonic_fractions.size, len(packed.error), len(packed.load), ratios)


def make_work(system: System, packed: Packed, order: int) -> Work:
    """Allocate scratch space."""
    n, m = packed.mesh_jacobian.shape
    rows = order + 1
    rubbing, harmonics = packed.rubbing, _harmonics(system, packed)
    by_coordinate, by_row = (rows, n), (rows, m)
    tables = aligned_together(
        {
            "y": by_coordinate,
            "deflection": by_row,
            "error": by_row,
            "load": by_coordinate,
            "force": (m,),
            "edge": (m,),
            "active": (m,),
            "acting": (m,),
            "side": (m,),
            "per_kind": (rows * packed.error.shape[2],),
            "polynomial": (rows,),
            "scaled": by_row,
            "bernstein": by_row,
            "subdivision": (MAX_DEPTH + 2, rows),
            "tangent": by_coordinate,
            "tangent_deflection": by_row,
            "block": (rows, packed.n * ABREAST),
            "block_deflection": (rows, packed.m * ABREAST),
            "block_force": (packed.m * ABREAST,),
            "zero_error": by_row,
            "zero_load": by_coordinate,
            "sample": (n,),
            "was_acting": (m,),
            "lower_bound": (m,),
            "upper_bound": (m,),
            "coupled": (2 * n,),
        }
    )
    return Work(
        order=order,
        state=np.zeros(m, dtype=np.int64),
        at_level=np.zeros(m, dtype=np.int64),
        at_parting=np.zeros(m, dtype=np.int64),
        law=system.law.series(rows, m),
        fourier=fourier_scratch(harmonics, rows),
        conversion=bernstein_matrix(order),
        conversion_less=bernstein_matrix(order - 1),
        nodes=_gauss(order // 4 + 1),
        rings=_ring_series(rows, packed.rings.clearance.size) if packed.rings else None,
        rubbing=RubbingSeries(aligned(rows, rubbing.ratios.shape[2]), aligned(rows, m)) if rubbing else None,
        pressing=_pressing(packed),
        **tables,
    )


def _pressing(packed: Packed) -> Pressing | None:
    if packed.coupled is None:
        return None
    blocks = packed.coupled.blocks
    return Pressing(np.zeros_like(blocks.starts), np.zeros_like(blocks.rows))


def _ring_series(rows: int, width: int) -> RingSeries:
    shapes: dict[str, tuple[int, ...]] = dict.fromkeys(RingSeries._fields, (rows, width))
    return RingSeries(**aligned_together({**shapes, "reciprocal": (width,)}))


@cache
def _gauss(count: int) -> Array:
    """Nodes and weights of Gauss's rule on [0, 1], shape (2, count)."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return np.array([0.5 + 0.5 * nodes, 0.5 * weights])
