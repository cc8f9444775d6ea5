"""Integrals and extremes of the motion, taken from the step polynomials themselves.

Products of two polynomials are integrated by Gauss's rule with a quarter of the order's number of nodes and
one more, whose error lies below that of the step (a term that the rule misses is the square of one half way
to the last); extremes are the polynomials' own. So nothing depends on how densely the motion
is sampled.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.kernel import called, inlined
from facegear.dynamics.integrator.taylor import values
from facegear.dynamics.integrator.work import Work
from facegear.machine_code.lanes import (
    LANES,
    add,
    load,
    magnitude,
    multiply,
    multiply_add,
    smaller,
    splat,
    spread,
    store,
)
from facegear.machine_code.memory import aligned
from facegear.machine_code.records import Record
from facegear.mesh_law.terms import force_ahead

LOOKS = 8
"""Parts of a step between whose ends an extremum is looked for."""
TURNS = 4


@Record.register
class Sums(NamedTuple):
    """Integrals over the mesh phase, in B batches of whole periods; B = 0 leaves them out.

    Of meshes with two flanks the first `pairs` columns hold half the difference of the deflections of the two
    from their edges, and the difference of their forces.

    Attributes
    ----------
    origin : (n,)
        About which coordinates are taken.
    level : (m,)
        About which deflections are taken.
    coordinates : (B, n)
        Of y.
    products : (B, n, n)
        Of y y^T, of which the upper half is filled.
    deflections, squared : (B, m)
        Of the deflections and their squares.
    forces : (2, m)
        Elastic mesh force over w^2 and its magnitude.
    minimum, maximum : (m,)
        Extremes of the deflections.
    pull : (m,)
        The smallest force of spring and damper of a contact over w^2, negative where flanks are pulled
        together, zero where they never are, at the ends and inner nodes of the steps.
    """

    origin: Array
    level: Array
    coordinates: Array
    products: Array
    deflections: Array
    squared: Array
    forces: Array
    minimum: Array
    maximum: Array
    pull: Array


def make_sums(packed: Packed, batches: int) -> Sums:
    """Allocate sums; with no batches they take nothing and are shared."""
    m, n = packed.transposed.shape
    return _sums(m, n, batches) if batches else _no_sums(m, n)


@lru_cache(maxsize=16)
def _no_sums(m: int, n: int) -> Sums:
    return _sums(m, n, 0)


def _sums(m: int, n: int, batches: int) -> Sums:
    return Sums(
        origin=aligned(n),
        level=aligned(m),
        coordinates=aligned(batches, n),
        products=aligned(batches, n, n),
        deflections=aligned(batches, m),
        squared=aligned(batches, m),
        forces=aligned(2, m),
        minimum=np.full(m, np.inf),
        maximum=np.full(m, -np.inf),
        pull=aligned(m),
    )


@inlined
def start_sums(packed: Packed, work: Work, sums: Sums) -> None:
    """Count coordinates and deflections from where the motion starts, so that squares keep their digits."""
    for k in range(packed.n):
        sums.origin[k] = work.y[0, k]
    for m in range(packed.m):
        sums.level[m] = work.deflection[0, m] + work.edge[m]
    for m in range(packed.pairs):
        sums.level[m] = _between(packed, sums.level, sums.level, m)


@called
def add_step(packed: Packed, work: Work, length: float, sums: Sums, batch: int) -> None:
    """Add a step to the batch; work.scaled is used up."""
    for node in range(work.nodes.shape[1]):
        ahead, weight = length * work.nodes[0, node], length * work.nodes[1, node]
        values(work.y, work.order, ahead, work.sample)
        _add_coordinates(packed, work.sample, weight, sums, batch)
        _add_meshes(packed, work, ahead, weight, sums, batch)
    # Flanks are pulled most where they part, at the end of a step.
    _add_meshes(packed, work, length, 0.0, sums, batch)
    if packed.pairs > 0:
        _pair_extremes(packed, work, length, sums)
        return
    for m in range(packed.m):
        edge = work.edge[m]
        if work.upper_bound[m] + edge > sums.maximum[m]:
            maximum = edge + _maximum(work.deflection, work.order, m, length, 1.0)
            sums.maximum[m] = max(sums.maximum[m], maximum)
        if work.lower_bound[m] + edge < sums.minimum[m]:
            minimum = edge - _maximum(work.deflection, work.order, m, length, -1.0)
            sums.minimum[m] = min(sums.minimum[m], minimum)


@inlined
def _between(packed: Packed, drive: Array, back: Array, m: int) -> float:
    """Half of what the drive flank's deflection is above its edge less what the back flank's is."""
    other = m + packed.pairs
    return 0.5 * ((drive[m] - packed.upper[m]) - (back[other] - packed.upper[other]))


@inlined
def _pair_extremes(packed: Packed, work: Work, length: float, sums: Sums) -> None:
    """Extremes of meshes with two flanks; their polynomials go to work.scaled."""
    for m in range(packed.m):
        work.lower_bound[m] += work.edge[m]
        work.upper_bound[m] += work.edge[m]
        work.scaled[0, m] = work.deflection[0, m] + work.edge[m]
    for m in range(packed.pairs):
        for i in range(1, work.order + 1):
            work.scaled[i, m] = 0.5 * (work.deflection[i, m] - work.deflection[i, m + packed.pairs])
        work.scaled[0, m] = _between(packed, work.scaled[0], work.scaled[0], m)
        if _between(packed, work.upper_bound, work.lower_bound, m) > sums.maximum[m]:
            maximum = _maximum(work.scaled, work.order, m, length, 1.0)
            sums.maximum[m] = max(sums.maximum[m], maximum)
        if _between(packed, work.lower_bound, work.upper_bound, m) < sums.minimum[m]:
            minimum = -_maximum(work.scaled, work.order, m, length, -1.0)
            sums.minimum[m] = min(sums.minimum[m], minimum)


@inlined
def _add_coordinates(packed: Packed, y: Array, weight: float, sums: Sums, batch: int) -> None:
    n = packed.omega_squared.size
    minus, heavy = splat(-1.0), splat(weight)
    for c in range(0, n, LANES):
        off = multiply_add(minus, load(sums.origin, c), load(y, c))
        store(y, c, off)
        store(
            sums.coordinates, batch * n + c, multiply_add(heavy, off, load(sums.coordinates, batch * n + c))
        )
    for k in range(packed.n):
        factor = multiply(heavy, spread(y, k))
        row = (batch * n + k) * n
        for c in range(k // LANES * LANES, n, LANES):
            store(sums.products, row + c, multiply_add(factor, load(y, c), load(sums.products, row + c)))


@inlined
def _add_meshes(packed: Packed, work: Work, ahead: float, weight: float, sums: Sums, batch: int) -> None:
    width = work.edge.size
    step, heavy, minus = splat(ahead), splat(weight), splat(-1.0)
    value, force = work.scaled[0], work.force
    for c in range(0, width, LANES):
        deflection, rate = splat(0.0), splat(0.0)
        for i in range(work.order, -1, -1):
            rate = multiply_add(rate, step, deflection)
            deflection = multiply_add(deflection, step, load(work.deflection, i * width + c))
        store(value, c, add(deflection, load(work.edge, c)))
        elastic = force_ahead(packed.law, work.law, deflection, work.order, step, c)
        side = load(work.side, c)
        store(force, c, multiply(magnitude(side), elastic))
        push = multiply_add(load(work.acting, c), rate, multiply(load(work.active, c), elastic))
        store(sums.pull, c, smaller(load(sums.pull, c), multiply(side, push)))
    for m in range(packed.pairs):
        value[m] = _between(packed, value, value, m)
        force[m] -= force[m + packed.pairs]
    for c in range(0, width, LANES):
        off, pushed = multiply_add(minus, load(sums.level, c), load(value, c)), load(force, c)
        at = batch * width + c
        store(sums.deflections, at, multiply_add(heavy, off, load(sums.deflections, at)))
        store(sums.squared, at, multiply_add(multiply(heavy, off), off, load(sums.squared, at)))
        store(sums.forces, c, multiply_add(heavy, pushed, load(sums.forces, c)))
        store(sums.forces, width + c, multiply_add(heavy, magnitude(pushed), load(sums.forces, width + c)))


@inlined
def _maximum(table: Array, order: int, m: int, length: float, sign: float) -> float:
    """Largest value of sign times the polynomial in column m over a step: the best of a few points, then
    Newton's method on the slope between that point's neighbours.
    """
    best, at = -np.inf, 0.0
    for look in range(LOOKS + 1):
        t = length * look / LOOKS
        value = 0.0
        for i in range(order, -1, -1):
            value = value * t + sign * table[i, m]
        if value > best:
            best, at = value, t
    low, high = max(0.0, at - length / LOOKS), min(length, at + length / LOOKS)
    for _ in range(TURNS):
        value, slope, bend = 0.0, 0.0, 0.0
        for i in range(order, -1, -1):
            bend = bend * at + 2.0 * slope
            slope = slope * at + value
            value = value * at + sign * table[i, m]
        best = max(best, value)
        if not bend < 0.0:
            break
        at = min(max(at - slope / bend, low), high)
    return best
