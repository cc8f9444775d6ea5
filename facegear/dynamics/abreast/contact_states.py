"""Contact state of every mesh in every lane, by the rules of the single integrator."""

from facegear.arrays import Array
from facegear.dynamics.abreast.kernel import inlined
from facegear.dynamics.abreast.lanes import Lanes
from facegear.dynamics.abreast.rows import LOWER, MESH_DAMPING, SCALE, UPPER, Structure
from facegear.dynamics.abreast.wide import WIDTH, load, splat, store, subtract, where_positive
from facegear.dynamics.integrator.contact_states import BRIEFEST, EDGE, LATEST, SHORTEST, STILL
from facegear.machine_code.vectors import magnitude, multiply, multiply_add


@inlined
def find_states(shape: Structure, lanes: Lanes) -> None:
    """Contact states from deflection and, on an edge, its direction of motion."""
    values, offsets = lanes.values, shape.offsets
    rest = multiply(splat(EDGE), load(values, offsets[SCALE]))
    plus, none, minus = splat(1.0), splat(0.0), splat(-1.0)
    for m in range(shape.m):
        lower, upper = load(values, offsets[LOWER] + m), load(values, offsets[UPPER] + m)
        deflection, rate = load(lanes.deflection, m), load(lanes.deflection, shape.m + m)
        margin = multiply_add(splat(BRIEFEST), magnitude(rate), rest)
        over, under = subtract(deflection, upper), subtract(lower, deflection)
        off_upper, off_lower = subtract(magnitude(over), margin), subtract(magnitude(under), margin)
        beyond = where_positive(over, plus, where_positive(under, minus, none))
        back = where_positive(subtract(none, rate), minus, none)
        drive = where_positive(rate, plus, none)
        side = where_positive(off_upper, where_positive(off_lower, beyond, back), drive)
        level = where_positive(off_upper, where_positive(off_lower, none, minus), plus)
        clearance = subtract(upper, lower)
        side = where_positive(clearance, side, plus)
        store(lanes.level, m, where_positive(clearance, level, none))
        _take_side(shape, lanes, m, side)


@inlined
def _take_side(shape: Structure, lanes: Lanes, m: int, side: object) -> None:
    """Give contact m its sides, and what follows from them; its deflection then counts from the edge."""
    values, none = lanes.values, splat(0.0)
    damping = load(values, shape.offsets[MESH_DAMPING] + m)
    active = magnitude(side)
    store(lanes.side, m, side)
    store(lanes.active, m, active)
    store(lanes.acting, m, damping if shape.damping_when_open else multiply(active, damping))
    lower, upper = load(values, shape.offsets[LOWER] + m), load(values, shape.offsets[UPPER] + m)
    edge = where_positive(side, upper, where_positive(subtract(none, side), lower, none))
    store(lanes.edge, m, edge)
    store(lanes.deflection, m, subtract(load(lanes.deflection, m), edge))


@inlined
def correct_states(shape: Structure, lanes: Lanes) -> bool:
    """Where a mesh stands on an edge with hardly any speed, its deflection a little later decides; True if a
    state changed.
    """
    changed = False
    for m in range(shape.m):
        for lane in range(WIDTH):
            level = lanes.level[m, lane]
            if level == 0.0:
                continue
            still = STILL * lanes.values[shape.offsets[SCALE], lane]
            ahead = SHORTEST
            soon = _rise(lanes.deflection, m, lane, ahead)
            while ahead < LATEST and abs(soon) <= still:
                ahead *= 1e2
                soon = _rise(lanes.deflection, m, lane, ahead)
            wanted = level if soon * level > 0.0 else 0.0
            if wanted != lanes.side[m, lane]:
                _change_side(shape, lanes, m, lane, wanted)
                changed = True
    return changed


@inlined
def _rise(deflection: Array, m: int, lane: int, ahead: float) -> float:
    """Mean rate of a deflection from now until `ahead` (rad), to third order."""
    bend = deflection[2, m, lane] + ahead * deflection[3, m, lane]
    return deflection[1, m, lane] + ahead * bend


@inlined
def _change_side(shape: Structure, lanes: Lanes, m: int, lane: int, side: float) -> None:
    values, offsets = lanes.values, shape.offsets
    damping = values[offsets[MESH_DAMPING] + m, lane]
    edge = 0.0
    if side > 0.0:
        edge = values[offsets[UPPER] + m, lane]
    elif side < 0.0:
        edge = values[offsets[LOWER] + m, lane]
    lanes.side[m, lane], lanes.active[m, lane] = side, abs(side)
    lanes.acting[m, lane] = damping if shape.damping_when_open else abs(side) * damping
    lanes.deflection[0, m, lane] += lanes.edge[m, lane] - edge
    lanes.edge[m, lane] = edge
