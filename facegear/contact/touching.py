"""Contact of all pairs of teeth at a position under all torques, compiled as one: what may touch, the strip
that can be expected to, its influence and solution, and the check of the rest.

A load at a hat moves all hats away from the other gear, so that only hats whose gap a rigid turn would close
can touch. Most of those do not: the bodies give way around the strip that does. The influence matrix of the
strip alone is many times cheaper, and one product shows whether the rest stays clear.
"""

from pathlib import Path
from typing import NamedTuple

from facegear.arrays import Array, Integers, Mask
from facegear.contact import (
    active_set,
    averages,
    bonded,
    both_sides,
    displacement,
    influence,
    spreading,
    strip_of_hats,
)
from facegear.contact.active_set import solved
from facegear.contact.averages import HatPoints, Hats, Rows, closing, rows_of
from facegear.contact.bodies import surface
from facegear.contact.displacement import Loads
from facegear.contact.displacement import displacement as displaced
from facegear.contact.influence import Surface
from facegear.contact.influence import influence as influence_of
from facegear.contact.spreading import composed, spread
from facegear.contact.strip_of_hats import Strip, expected, turns_of
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import cube, integers, marked, marks, numbers, table, taken
from facegear.machine_code.records import Record

SOURCES = (
    Path(active_set.__file__),
    Path(averages.__file__),
    Path(bonded.__file__),
    Path(both_sides.__file__),
    Path(displacement.__file__),
    Path(influence.__file__),
    Path(spreading.__file__),
    Path(strip_of_hats.__file__),
    Path(surface.__file__),
    *picked.SOURCES,
)
compiled, called = compiler(*SOURCES), for_callers(forceinline=False)


@Record.register
class Cover(NamedTuple):
    """Which hats there are, as `closing` takes them: the area (n,) m2 to be covered of each, the number of
    the `first` of the pinion's nodes, the `shape` of their lattice, and where the flanks of both gears end.
    """

    min_area: Array
    first: int
    shape: tuple[int, int]
    flank_ends: tuple[float, float]


@Record.register
class Facing(NamedTuple):
    """Points of the pairs `teeth` (p,) of a position that face each other; each pair's begin at `starts`
    (p + 1,).
    """

    points: HatPoints
    starts: Integers
    teeth: Integers


class Touching(NamedTuple):
    """Contact under torques (t,), the largest first.

    `teeth` (p,) numbers of the pairs; rotation, slope, residual, steps (t,) as in `ContactSolution`; steps 0
    where there is no solution. `candidates`: how many hats the turn closes; `forward` how many of them can
    carry the torque; `sought` among how many the solution is; overlap: turn (rad) that would part the teeth
    where they stand in each other. Of the m hats that are loaded by any torque: `hats`, and the force (t, m)
    N. Loads (t, p, n) N of pairs on the nodes of both surfaces before refinement.
    """

    teeth: Integers
    rotation: Array
    slope: Array
    residual: Array
    steps: Integers
    candidates: int
    forward: int
    sought: int
    overlap: float
    hats: Hats
    force: Array
    on_pinion: Array
    on_gear: Array


@compiled
def touching(
    facing: Facing,
    cover: Cover,
    surfaces: tuple[Surface, Surface],
    torques: Array,
    limit: float,
    strip: Strip,
    coupled: bool,
    limits: tuple[int, float],
) -> Touching:
    """Contact of hats that a turn by `limit` (rad) closes, under torques (t,) N m, the largest first.

    If the first torque turns further, only its rotation is of use. `limits`: steps and tolerance of the
    active set.
    """
    hats = closing(
        facing.points, facing.starts, cover.min_area, cover.first, cover.shape, cover.flank_ends, limit
    )
    at = facing.points.pinion, facing.points.gear
    own, column_min = turns_of(hats, cover.shape[1], facing.teeth.size)
    gap, arm, width = hats.gap, hats.lever_arm, strip.width
    keep = expected(own, column_min, strip.gap * limit, width)
    for i in range(gap.size if strip.near.size else 0):
        keep[i] |= strip.near[hats.pair[i], hats.node[i]]
    forward, overlap, longest = 0, 0.0, 0.0
    drives = False
    for i in range(gap.size):
        longest = max(longest, abs(arm[i]))
        if arm[i] > 0.0:
            forward += 1
            overlap = max(overlap, -gap[i] / arm[i])
            drives |= keep[i]
    for i in range(0 if drives else gap.size):
        keep[i] = True
    count, cases = torques.size, integers(gap.size, 0)
    rotation, slope, residual = numbers(count, 0.0), numbers(count, 0.0), numbers(count, 0.0)
    steps, tried = integers(count, 0), forward > 0
    which, force = integers(0, 0), table(count, 0)
    ends = integers(facing.teeth.size + 1, 0)
    every = spread(hats.rows, at[0], surfaces[0].faces), spread(hats.rows, at[1], surfaces[1].faces)
    loads = _loads(every, marks(gap.size, False), surfaces)
    while tried:
        which = marked(keep)
        ends = _ends(taken(hats.pair, which), facing.teeth.size)
        loads = _loads(every, keep, surfaces)
        matrix = influence_of(ends, facing.teeth, surfaces, loads[0], loads[1], coupled)
        force, begin = table(count, which.size), strip.begin * limit
        start = taken(expected(own, column_min, begin, strip.start_width), which)
        apart, levers = taken(gap, which), taken(arm, which)
        for t in range(count):
            steps[t], forces, rotation[t], slope[t], residual[t], change = solved(
                matrix, apart, levers, torques[t], start, limits
            )
            following = torques[min(t + 1, count - 1)] - torques[t]
            for i in range(which.size):
                force[t, i] = forces[i]
                start[i] = forces[i] + following * change[i] > 0.0
            tried = steps[t] > 0 and not rotation[0] > limit
            if not tried:
                break
        if not tried:
            break
        for i in range(gap.size):
            cases[i] = 0
            for t in range(0 if keep[i] else count):
                if gap[i] < rotation[t] * arm[i]:
                    cases[i] = t + 1
        others = marked(cases)
        if not others.size:
            break
        asked = others, _ends(taken(hats.pair, others), facing.teeth.size), taken(cases, others)
        moved = displaced(asked, every, surfaces, facing.teeth, (ends, loads), force, coupled)
        tried = False
        for number, hat in enumerate(others):
            inside = 0.0
            for t in range(cases[hat]):
                distance = gap[hat] + moved[number, t] - rotation[t] * arm[hat]
                part = -distance / (abs(rotation[t]) * longest)
                inside, residual[t] = max(inside, part), max(residual[t], part)
            keep[hat] = inside > limits[1]
            tried |= keep[hat]
        if tried:
            width *= strip.wider
            wider = expected(own, column_min, strip.gap * limit, width)
            for hat in others:
                keep[hat] |= wider[hat]
    carriers = _loaded(force)
    chosen = taken(which, carriers)
    carrying = Hats(
        taken(hats.pair, chosen),
        taken(hats.node, chosen),
        taken(gap, chosen),
        taken(arm, chosen),
        taken(hats.fillet, chosen),
        hats.rows,
    )
    return Touching(
        facing.teeth.copy(),
        rotation,
        slope,
        residual,
        steps,
        gap.size,
        forward,
        which.size,
        overlap,
        carrying,
        _columns(force, carriers),
        _on_nodes(loads[1][0], ends, force, surfaces[0]),
        _on_nodes(loads[1][1], ends, force, surfaces[1]),
    )


@called
def _ends(pair: Integers, pairs: int) -> Integers:
    """Where those of each pair end (p + 1,), 0 first, among hats whose pair (n,) rises."""
    ends = integers(pairs + 1, 0)
    for number in pair:
        ends[number + 1] += 1
    for number in range(pairs):
        ends[number + 1] += ends[number]
    return ends


@called
def _loaded(force: Array) -> Integers:
    """The hats that carry any of the forces (t, n) N."""
    on_any = marks(force.shape[1], False)
    for t in range(force.shape[0]):
        for i in range(on_any.size):
            on_any[i] |= force[t, i] > 0.0
    return marked(on_any)


@called
def _columns(values: Array, chosen: Integers) -> Array:
    result = table(values.shape[0], chosen.size)
    for t in range(values.shape[0]):
        for i in range(chosen.size):
            result[t, i] = values[t, chosen[i]]
    return result


@called
def _loads(every: tuple[Rows, Rows], keep: Mask, surfaces: tuple[Surface, Surface]) -> Loads:
    """Of the hats that are kept, among the loads of all on the nodes of both surfaces."""
    pinion, gear = surfaces
    fine = rows_of(*every[0], keep), rows_of(*every[1], keep)
    return fine, (
        composed(fine[0], pinion.interpolation, pinion.others.shape[1]),
        composed(fine[1], gear.interpolation, gear.others.shape[1]),
    )


@called
def _on_nodes(loads: Rows, ends: Integers, force: Array, body: Surface) -> Array:
    """Forces (t, p, n) N of pairs on nodes by forces (t, m) on hats."""
    pointer, index, weight = loads
    total = cube(force.shape[0], ends.size - 1, body.others.shape[1])
    for pair in range(ends.size - 1):
        for i in range(ends[pair], ends[pair + 1]):
            for t in range(force.shape[0]):
                if force[t, i] != 0.0:
                    for k in range(pointer[i], pointer[i + 1]):
                        total[t, pair, index[k]] += weight[k] * force[t, i]
    return total
