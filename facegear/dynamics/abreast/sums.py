"""Integrals and extremes of each motion that runs side by side, by the rules of the single integrator."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.abreast.functions import Wide
from facegear.dynamics.abreast.kernel import called, inlined
from facegear.dynamics.abreast.lanes import Lanes
from facegear.dynamics.abreast.rows import Structure
from facegear.dynamics.abreast.switches import put_down
from facegear.dynamics.abreast.taylor import values
from facegear.dynamics.abreast.wide import (
    divide,
    load,
    positive_lanes,
    splat,
    store,
    subtract,
    where_positive,
)
from facegear.dynamics.integrator.sums import LOOKS, TURNS
from facegear.machine_code.lanes import take
from facegear.machine_code.records import Record
from facegear.machine_code.vectors import add, larger, magnitude, multiply, multiply_add, smaller


@Record.register
class ManySums(NamedTuple):
    """What is added up of each machine of a queue, in B batches of its periods; B = 0: nothing.

    The first dimension is the machine; else as the single integrator's Sums, and fractions (3, m) of the
    phase spent open, on the drive and on the back flank, rad.
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
    fractions: Array


def many_sums(machines: int, n: int, m: int, batches: int) -> ManySums:
    """Room for the sums of machines."""
    counted = machines if batches else 0
    return ManySums(
        origin=np.zeros((counted, n)),
        level=np.zeros((counted, m)),
        coordinates=np.zeros((counted, batches, n)),
        products=np.zeros((counted, batches, n, n)),
        deflections=np.zeros((counted, batches, m)),
        squared=np.zeros((counted, batches, m)),
        forces=np.zeros((counted, 2, m)),
        minimum=np.zeros((counted, m)),
        maximum=np.zeros((counted, m)),
        pull=np.zeros((counted, m)),
        fractions=np.zeros((counted, 3, m)),
    )


@called
def add_step(shape: Structure, lanes: Lanes) -> None:
    """Add the steps of all lanes."""
    length = load(lanes.length, 0)
    _start(shape, lanes)
    for node in range(lanes.nodes.shape[1]):
        ahead = multiply(length, splat(lanes.nodes[0, node]))
        weight = multiply(length, splat(lanes.nodes[1, node]))
        store(lanes.ahead, 0, ahead)
        values(shape, lanes)
        _keep_coordinates(shape, lanes, node, weight)
        _add_contacts(shape, lanes, ahead, weight)
    _add_products(shape, lanes)
    # Flanks are pulled most where they part, at the end of a step.
    _add_contacts(shape, lanes, length, splat(0.0))
    for m in range(shape.m):
        _add_fractions(shape, lanes, m, length)
        _add_extremes(shape, lanes, m)


@inlined
def _start(shape: Structure, lanes: Lanes) -> None:
    """Count from where a motion starts, so that squares keep their digits."""
    fresh, tally = load(lanes.fresh, 0), lanes.tally
    if positive_lanes(fresh) == 0:
        return
    for k in range(shape.n):
        store(tally.origin, k, where_positive(fresh, load(lanes.y, k), load(tally.origin, k)))
    for m in range(shape.m):
        start = add(load(lanes.deflection, m), load(lanes.edge, m))
        store(tally.level, m, where_positive(fresh, start, load(tally.level, m)))


@inlined
def _keep_coordinates(shape: Structure, lanes: Lanes, node: int, weight: Wide) -> None:
    """Keep the coordinates at a node, from their origin, and the same times its weight."""
    tally, n = lanes.tally, shape.n
    for k in range(n):
        off = subtract(load(lanes.sample, k), load(tally.origin, k))
        heavy = multiply(weight, off)
        store(tally.off, node * n + k, off)
        store(tally.heavy, node * n + k, heavy)
        store(tally.coordinates, k, add(load(tally.coordinates, k), heavy))


@inlined
def _add_products(shape: Structure, lanes: Lanes) -> None:
    """Add what the coordinates kept at all nodes give, each product read and written once."""
    tally, n, pair = lanes.tally, shape.n, 0
    for k in range(n):
        for other in range(k, n):
            total = load(tally.products, pair)
            for node in range(lanes.nodes.shape[1]):
                total = multiply_add(
                    load(tally.heavy, node * n + k), load(tally.off, node * n + other), total
                )
            store(tally.products, pair, total)
            pair += 1


@inlined
def _add_contacts(shape: Structure, lanes: Lanes, ahead: Wide, weight: Wide) -> None:
    tally, count = lanes.tally, shape.m
    for kind in range(shape.law_kinds):
        stiffness = splat(0.0)
        for i in range(lanes.order, -1, -1):
            stiffness = multiply_add(stiffness, ahead, load(lanes.law, i * shape.law_kinds + kind))
        store(tally.stiffness, kind, stiffness)
    for m in range(count):
        deflection, rate = splat(0.0), splat(0.0)
        for i in range(lanes.order, -1, -1):
            rate = multiply_add(rate, ahead, deflection)
            deflection = multiply_add(deflection, ahead, load(lanes.deflection, i * count + m))
        elastic = multiply(load(tally.stiffness, take(shape.law_kind, m)), deflection)
        side = load(lanes.side, m)
        push = multiply_add(load(lanes.acting, m), rate, multiply(load(lanes.active, m), elastic))
        store(tally.pull, m, smaller(load(tally.pull, m), multiply(side, push)))
        off = subtract(add(deflection, load(lanes.edge, m)), load(tally.level, m))
        pushed = multiply(magnitude(side), elastic)
        store(tally.deflections, m, multiply_add(weight, off, load(tally.deflections, m)))
        store(tally.squared, m, multiply_add(multiply(weight, off), off, load(tally.squared, m)))
        store(tally.forces, m, multiply_add(weight, pushed, load(tally.forces, m)))
        size = multiply_add(weight, magnitude(pushed), load(tally.forces, count + m))
        store(tally.forces, count + m, size)


@inlined
def _add_fractions(shape: Structure, lanes: Lanes, m: int, length: Wide) -> None:
    parts, count, none, side = lanes.tally.fractions, shape.m, splat(0.0), load(lanes.side, m)
    drive = where_positive(side, length, none)
    back = where_positive(subtract(none, side), length, none)
    store(parts, m, add(load(parts, m), subtract(length, add(drive, back))))
    store(parts, count + m, add(load(parts, count + m), drive))
    store(parts, 2 * count + m, add(load(parts, 2 * count + m), back))


@inlined
def _add_extremes(shape: Structure, lanes: Lanes, m: int) -> None:
    """Extremes of a deflection; its terms say where it may reach past those known."""
    tally, edge, none = lanes.tally, load(lanes.edge, m), splat(0.0)
    put_down(shape, lanes, m)
    top = add(load(lanes.scaled, 0), edge)
    bottom = top
    for i in range(1, lanes.order + 1):
        top = add(top, larger(load(lanes.scaled, i), none))
        bottom = add(bottom, smaller(load(lanes.scaled, i), none))
    known = load(tally.maximum, m)
    if positive_lanes(subtract(top, known)) != 0:
        store(tally.maximum, m, larger(known, add(edge, _maximum(lanes, splat(1.0)))))
    known = load(tally.minimum, m)
    if positive_lanes(subtract(known, bottom)) != 0:
        store(tally.minimum, m, smaller(known, subtract(edge, _maximum(lanes, splat(-1.0)))))


@inlined
def _maximum(lanes: Lanes, sign: Wide) -> Wide:
    """Largest values over the step of sign times the polynomials in `scaled`: the best of a few points, then
    Newton's method on the slope between their neighbours.
    """
    best, at = splat(-1e300), splat(0.0)
    for look in range(LOOKS + 1):
        t, value = splat(look / LOOKS), splat(0.0)
        for i in range(lanes.order, -1, -1):
            value = multiply_add(value, t, multiply(sign, load(lanes.scaled, i)))
        at = where_positive(subtract(value, best), t, at)
        best = larger(best, value)
    low = larger(splat(0.0), subtract(at, splat(1.0 / LOOKS)))
    high = smaller(splat(1.0), add(at, splat(1.0 / LOOKS)))
    bends = splat(1.0)
    for _ in range(TURNS):
        value, slope, bend = splat(0.0), splat(0.0), splat(0.0)
        for i in range(lanes.order, -1, -1):
            bend = multiply_add(bend, at, multiply(splat(2.0), slope))
            slope = multiply_add(slope, at, value)
            value = multiply_add(value, at, multiply(sign, load(lanes.scaled, i)))
        best = where_positive(bends, larger(best, value), best)
        bends = where_positive(subtract(splat(0.0), bend), bends, splat(0.0))
        following = smaller(larger(subtract(at, divide(slope, bend)), low), high)
        at = where_positive(bends, following, at)
    return best


@inlined
def clear_batch(shape: Structure, lanes: Lanes, lane: int) -> None:
    """Start the next batch of a lane."""
    tally = lanes.tally
    for k in range(shape.n):
        tally.coordinates[k, lane] = 0.0
    for pair in range(tally.products.shape[0]):
        tally.products[pair, lane] = 0.0
    for m in range(shape.m):
        tally.deflections[m, lane] = 0.0
        tally.squared[m, lane] = 0.0


@inlined
def clear(shape: Structure, lanes: Lanes, lane: int) -> None:
    """Start the sums of a lane's next machine."""
    tally = lanes.tally
    clear_batch(shape, lanes, lane)
    for m in range(shape.m):
        for i in range(2):
            tally.forces[i, m, lane] = 0.0
        for i in range(3):
            tally.fractions[i, m, lane] = 0.0
        tally.minimum[m, lane] = np.inf
        tally.maximum[m, lane] = -np.inf
        tally.pull[m, lane] = 0.0


@inlined
def keep_batch(shape: Structure, lanes: Lanes, sums: ManySums, lane: int, batch: int) -> None:
    """Write a batch that a lane has run through, and start the next."""
    tally, number, pair = lanes.tally, lanes.number[lane], 0
    for k in range(shape.n):
        sums.coordinates[number, batch, k] = tally.coordinates[k, lane]
        for other in range(k, shape.n):
            sums.products[number, batch, k, other] = tally.products[pair, lane]
            pair += 1
    for m in range(shape.m):
        sums.deflections[number, batch, m] = tally.deflections[m, lane]
        sums.squared[number, batch, m] = tally.squared[m, lane]
    clear_batch(shape, lanes, lane)


@inlined
def keep_whole(shape: Structure, lanes: Lanes, sums: ManySums, lane: int) -> None:
    """Write what a lane has added up over all periods of its machine."""
    tally, number = lanes.tally, lanes.number[lane]
    for k in range(shape.n):
        sums.origin[number, k] = tally.origin[k, lane]
    for m in range(shape.m):
        sums.level[number, m] = tally.level[m, lane]
        sums.minimum[number, m] = tally.minimum[m, lane]
        sums.maximum[number, m] = tally.maximum[m, lane]
        sums.pull[number, m] = tally.pull[m, lane]
        for i in range(2):
            sums.forces[number, i, m] = tally.forces[i, m, lane]
        for i in range(3):
            sums.fractions[number, i, m] = tally.fractions[i, m, lane]
