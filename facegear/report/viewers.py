"""The pair in mesh and mode shapes in three dimensions, for the viewers of the report."""

from collections.abc import Mapping
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Array, Arrays, Integers, Mask
from facegear.contact.pattern import EDGES, SHARES
from facegear.quantities import BODIES, Body
from facegear.report.page import View, encode_array
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.placement import RigidMotion, pinion_to_gear
from facegear.teeth.solids import solid, teeth_of

COLOURS = (
    *("#0d0887", "#4c02a1", "#7e03a8", "#a92395", "#cc4778"),
    *("#e56b5d", "#f89540", "#fdc527", "#f0f921"),
)
"""Matplotlib's plasma at nine even places."""
LINE = ("torque_n_m", "position", "tooth", "plane")
"""Keys that identify a line of contact and a place on it."""
PROFILE, WIDTH = 17, 7
"""Points of each drawn patch."""
SHOWN_GEAR_TEETH = 13
"""Number of gear teeth drawn around the mesh; more would only cost size of the page."""
QUANTITIES = (
    {
        "key": "pressure",
        "name": "pressure",
        "unit": "MPa",
        "help": "Largest pressure across each line of contact; grey where an edge carries the load",
    },
    {
        "key": "load",
        "name": "load",
        "unit": "N/mm",
        "help": "Load per millimetre of face width, edges included",
    },
)
"""Quantities that the colours may show."""
ROOT_STRESS = {
    "key": "root_stress",
    "name": "root stress",
    "unit": "MPa",
    "help": "Tension down the fillets; grey where they are pressed",
}
"""Quantity that the colours may also show where root stress was computed."""

FRICTION = (
    {
        "key": "loss",
        "name": "friction loss",
        "unit": "W/mm",
        "help": "Loss by friction per millimetre of the line of contact at the nominal speed, edges included",
    },
    {
        "key": "flash",
        "name": "flash temperature",
        "unit": "K",
        "help": "Flash temperature: largest across each line of contact; grey where an edge carries the load",
    },
)
"""Quantities that the colours may also show where friction was computed."""


def pair_view(
    design: PairDesign,
    loads: Arrays,
    ltca: pd.DataFrame,
    stress: Arrays | None = None,
    friction: Arrays | None = None,
) -> View:
    """Return the view of the pair at every solved position and torque, lengths in mm.

    Colours show pressure, load, friction loss or flash temperature of the line of contact at every loaded
    node's column of the flank, or the root stress. The scale ends at the largest value of each torque.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    loads : mapping of (...) arrays
        Arrays PRESSURE_ARRAYS of stage contact, SI units.
    ltca : DataFrame
        Table with LTCA_COLUMNS of stage contact.
    stress : mapping of (...) arrays or None
        Arrays ROOT_STRESS_ARRAYS, SI units, where root stress was computed.
    friction : mapping of (...) arrays or None
        Arrays LOCAL_ARRAYS of stage lubrication, SI units, where friction was computed.

    Returns
    -------
    View
        The view.
    """
    torques = np.unique(loads["torque_n_m"])
    positions = np.unique(loads["position"])
    stands = _pinion_stands(design)
    middle = np.array([[0.0, design.middle, -design.pinion_pitch_radius]])
    data = {
        "bodies": [_body(design, name, stress) for name in BODIES],
        "centre": (1e3 * stands.points(middle)[0]).tolist(),
        "size": 1e3 * (design.pinion_tip_radius + design.pinion.width),
        "lattice": {
            "shape": [int(n) for n in loads["shape"]],
            "points": encode_array(1e3 * loads["point_m"], np.float32),
        },
        "positions": positions.tolist(),
        "colours": COLOURS,
        "quantities": [
            *QUANTITIES,
            *(FRICTION if friction is not None else []),
            *([ROOT_STRESS] if stress is not None else []),
        ],
        "torques": [_torque(float(torque), loads, ltca, positions, stress, friction) for torque in torques],
    }
    quantities_text = (
        "pressure or load" if friction is None else "pressure, load, friction loss or flash temperature"
    )
    return View(
        data,
        f"The pair in mesh, turning through a pitch: drag to look around. Colours: {quantities_text} along "
        "each line of contact, drawn wider than it is, at the positions that were solved"
        + ("." if stress is None else "; or root stress."),
    )


def _pinion_stands(design: PairDesign) -> RigidMotion:
    """Return the motion from the frame of a pinion that turns about y to that of the gear, as designed."""
    half_pitch = pi / design.pinion.teeth
    return pinion_to_gear(replace(design, assembly=AssemblyErrors()), half_pitch, 0.0, 0.0)


def _body(design: PairDesign, name: Body, stress: Arrays | None) -> dict[str, Any]:
    """Return the drawn teeth of a body as plain values: number of all teeth, first and number of those
    shown, rotation of tooth 0 in pitches, matrix (row by row) and shift (mm) that put it in place, surface
    patches (mm, base64), and gauges in the fillets (None without stress).
    """
    stands = _pinion_stands(design) if name == "pinion" else RigidMotion(np.eye(3), np.zeros(3))
    teeth = teeth_of(design, name)
    tooth_count = teeth if name == "pinion" else min(teeth, SHOWN_GEAR_TEETH)
    return {
        "name": name,
        "teeth": teeth,
        "first": -(tooth_count // 2),
        "shown": tooth_count,
        "turn": -0.5 if name == "pinion" else 0.0,
        "matrix": stands.matrix.ravel().tolist(),
        "shift": (1e3 * stands.shift).tolist(),
        "patches": [
            {"shape": list(patch.shape[:2]), "points": encode_array(1e3 * patch, np.float32)}
            for patch in solid(design, name, 1, PROFILE, WIDTH)
        ],
        "fillets": None if stress is None else _fillets(stress, name),
    }


def _fillets(stress: Arrays, name: Body) -> dict[str, Any]:
    """Return the places (mm, base64) of the root gauges of one tooth with the shape of their grid, and
    the number of the first tooth of a passage. `stress`: ROOT_STRESS_ARRAYS, SI units.
    """
    position = stress[f"{name}_position_m"]
    return {
        "shape": list(position.shape[1:3]),
        "points": encode_array(1e3 * position, np.float32),
        "first": int(np.floor(stress[f"{name}_passage"][0])),
    }


def _tension(torque: float, stress: Arrays) -> dict[str, Array]:
    """Return by body the tension, MPa, at the gauges over a passage at a solved torque (N m);
    compression is 0.
    """
    row = int(np.flatnonzero(stress["torque_n_m"] == torque)[0])
    return {name: 1e-6 * np.maximum(stress[f"{name}_stress_pa"][row], 0.0) for name in BODIES}


def _torque(
    torque: float,
    loads: Arrays,
    ltca: pd.DataFrame,
    positions: AnyArray,
    stress: Arrays | None,
    friction: Arrays | None,
) -> dict[str, Any]:
    """Return the part of the view at one torque (N m) as plain values.

    These are the loaded nodes in the order of `positions` (pitches; `start`: where each one's nodes
    begin), coded values of each quantity with the largest one, tension at the gauges, and transmission
    error (µm) and load shares over the positions.
    """
    on = loads["torque_n_m"] == torque
    row = np.searchsorted(positions, loads["position"][on])
    order = np.argsort(row, kind="stable")
    values_by_name = {"pressure": line_pressure(loads, on)[order], "load": line_load(loads, on)[order]}
    if friction is not None:
        flash_temperature = np.where(friction["inside"] != 0, friction["flash_k"], np.nan)
        values_by_name["loss"] = of_lines(loads, on, friction, 1e-3 * friction["loss_w_per_m"])[order]
        values_by_name["flash"] = of_lines(loads, on, friction, flash_temperature)[order]
    rows = ltca[ltca["torque_n_m"] == torque].sort_values("position")
    top = {key: float(np.nanmax(values, initial=0.0)) for key, values in values_by_name.items()}
    tension = {} if stress is None else _tension(torque, stress)
    if tension:
        top[ROOT_STRESS["key"]] = max(float(arrays.max()) for arrays in tension.values())
    return {
        "torque_n_m": torque,
        "largest": top,
        "start": np.searchsorted(row[order], np.arange(positions.size + 1)).tolist(),
        "node": encode_array(loads["node"][on][order], np.uint16),
        "tooth": encode_array(loads["tooth"][on][order], np.int8),
        "values": {key: _parts(values, top[key]) for key, values in values_by_name.items()},
        "tension": {name: _parts(arrays, top[ROOT_STRESS["key"]]) for name, arrays in tension.items()},
        "error_um": rows["ste_um"].round(3).tolist(),
        "share": rows[list(SHARES)].round(4).to_numpy().tolist(),
    }


def line_pressure(loads: Arrays, on: Mask) -> Array:
    """Return the pressure at nodes: that of the line of contact in the node's column of the flank.

    Parameters
    ----------
    loads : mapping of (...) arrays
        Arrays PRESSURE_ARRAYS of stage contact, SI units.
    on : mask of shape (loaded nodes,)
        Nodes to return, of those in `loads`.

    Returns
    -------
    (chosen nodes,) array
        Pressure, MPa; nan in a fillet and where an edge carries the load.
    """
    inside = loads["line_where"] == EDGES.index("inside")
    pressure = np.where(inside, 1e-6 * loads["line_pressure_pa"], np.nan)
    return of_lines(loads, on, {key: loads[f"line_{key}"] for key in LINE}, pressure)


def of_lines(loads: Arrays, on: Mask, lines: Arrays, values: Array) -> Array:
    """Return at each chosen node the largest value of the lines of contact in its column of the flank.

    Parameters
    ----------
    loads : mapping of (...) arrays
        Arrays PRESSURE_ARRAYS of stage contact, SI units.
    on : mask of shape (loaded nodes,)
        Nodes to return, of those in `loads`.
    lines : mapping of (m,) arrays
        Torque, N m, position, tooth and plane of each value, under the names LINE; indices but for the
        torque.
    values : (m,) array
        Values along the lines, any unit.

    Returns
    -------
    (chosen nodes,) array
        Values in the same unit; nan in a fillet.
    """
    index = pd.MultiIndex.from_arrays([lines[key] for key in LINE], names=LINE)
    line_values = pd.Series(values, index).groupby(level=list(LINE)).max()
    columns = int(loads["shape"][1])
    nodes = [loads[key][on] for key in LINE[:-1]]
    at_nodes = line_values.reindex(
        pd.MultiIndex.from_arrays([*nodes, loads["node"][on] % columns])
    ).to_numpy()
    return np.where(loads["in_fillet"][on], np.nan, at_nodes)


def line_load(loads: Arrays, on: Mask) -> Array:
    """Return the load per width at nodes: all force on the node's column of the flank over the column's
    width.

    Parameters
    ----------
    loads : mapping of (...) arrays
        Arrays PRESSURE_ARRAYS of stage contact, SI units.
    on : mask of shape (loaded nodes,)
        Nodes to return, all at one torque: forces are summed by position, tooth and column.

    Returns
    -------
    (chosen nodes,) array
        Load at the node's position and torque, N/mm.
    """
    rows, columns = (int(n) for n in loads["shape"])
    y = 1e3 * loads["point_m"].reshape(rows, columns, 3)[0, :, 1]
    width = np.abs(np.gradient(y))
    width[[0, -1]] /= 2.0
    column = loads["node"][on] % columns
    frame = pd.DataFrame({name: loads[name][on] for name in ("position", "tooth", "force_n")})
    total = frame.groupby(["position", "tooth", column])["force_n"].transform("sum").to_numpy()
    return total / width[column]


def _parts(values: AnyArray, largest: float) -> str:
    """Encode values (...) as bytes in base64: 255ths of `largest`, rounded up; 0 where a value is nan."""
    return encode_array(np.nan_to_num(np.ceil(255 * values / (largest or 1.0))), np.uint8)


TURN_DEG, PIECES = 5.0, 100
"""A point of the outline is drawn where it turns by more, and otherwise at that many even distances."""
LARGEST_CODE = 32767
"""Integer that stores the largest motion of a mode."""
SWING = 0.08
"""Largest motion drawn at first, in the outer radius."""
FACTOR = 2.5
"""Largest motion that a reader may choose, as a multiple of SWING."""


def body_view(modes: pd.DataFrame, shapes: Mapping[str, AnyArray]) -> View | None:
    """Return the view of each gear's outline, turned about its axis, with the motions of its first modes.

    Equal gears are shown once. Lengths in mm.

    Parameters
    ----------
    modes : DataFrame
        Table `modes` of stage gear_bodies: gear, nodal_diameters, mode, frequency_hz.
    shapes : mapping of (...) arrays
        Arrays of stage gear_bodies (see `facegear.parts.body_tables.shape_arrays`); nodes in m.

    Returns
    -------
    View or None
        The view; None without modes.
    """
    gears: dict[str, dict[str, Any]] = {}
    for name in dict.fromkeys(modes["gear"]):
        gear_view = _gear(str(name), modes[modes["gear"] == name], shapes)
        equal_gear = next((key for key, other_gear in gears.items() if gear_view == other_gear), None)
        if equal_gear is not None:
            gear_view = gears.pop(equal_gear)
        gears[f"{equal_gear} and {name}" if equal_gear else str(name)] = gear_view
    mode_records = [{"gear": gear, **mode} for gear, body in gears.items() for mode in body["modes"]]
    if not mode_records:
        return None
    radius = max(body["radius"] for body in gears.values())
    data = {
        "gears": {gear: {"points": body["points"]} for gear, body in gears.items()},
        "modes": mode_records,
        "size": radius,
        "swing": SWING * radius,
        "factor": FACTOR,
        "colours": COLOURS,
    }
    return View(
        data,
        "Mode shapes of the face gear with its hub held: drag to look around. The motion is exaggerated; a "
        "mode has no size of its own. Travelling: one of the two waves that go round the gear in opposite "
        "directions; standing: both together. Teeth are drawn as the layer that stands for them.",
        kind="body",
    )


def _gear(gear: str, modes: pd.DataFrame, shapes: Mapping[str, AnyArray]) -> dict[str, Any]:
    """Return a gear's outline (mm, base64), its outer radius (mm), and its modes with displacements of
    the outline's nodes: 16-bit integers, LARGEST_CODE at the largest displacement of the mode.

    modes: its rows of table `modes`; shapes: arrays of stage gear_bodies.
    """
    nodes, quads = 1e3 * shapes[f"{gear}_nodes"], shapes[f"{gear}_quads"]
    outline = _thinned(nodes, boundary(quads))
    frequencies = modes.set_index(["nodal_diameters", "mode"])["frequency_hz"]
    mode_records = []
    for (order, number), shape in zip(shapes[f"{gear}_labels"], shapes[f"{gear}_shapes"], strict=True):
        displacements = shape[outline]
        coded = np.round(LARGEST_CODE * displacements / np.linalg.norm(displacements, axis=1).max())
        mode_records.append(
            {
                "order": int(order),
                "number": int(number),
                "frequency_hz": round(float(frequencies[int(order), int(number)]), 1),
                "shape": encode_array(coded, np.int16),
            }
        )
    return {
        "points": encode_array(nodes[outline], np.float32),
        "radius": float(nodes[:, 0].max()),
        "modes": mode_records,
    }


def boundary(quads: AnyArray) -> Integers:
    """Return the nodes along the outline of a mesh of quadrilaterals without holes, in order.

    Parameters
    ----------
    quads : (cells, 4) array of int
        Node indices of each quadrilateral.

    Returns
    -------
    (nodes,) array of int
        Indices of the nodes around the outline, each once.
    """
    edges = np.concatenate([quads[:, [k, (k + 1) % 4]] for k in range(4)])
    sides, counts = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    beside: dict[int, list[int]] = {}
    for first, second in sides[counts == 1].tolist():
        beside.setdefault(first, []).append(second)
        beside.setdefault(second, []).append(first)
    start = next(iter(beside))
    along, before = [start], -1
    while (node := next(neighbour for neighbour in beside[along[-1]] if neighbour != before)) != start:
        before = along[-1]
        along.append(node)
    return np.array(along)


def _thinned(nodes: Array, along: Integers) -> Integers:
    """Return the nodes of an outline at its corners, where it turns by more than TURN_DEG, and at about
    PIECES even distances between them. `nodes`: (n, 2) of the whole mesh, mm; `along`: indices around
    the outline.
    """
    positions = nodes[along]
    after = np.roll(positions, -1, axis=0) - positions
    steps = np.linalg.norm(after, axis=1)
    directions = np.unwrap(np.arctan2(after[:, 1], after[:, 0]))
    turns = np.abs(np.diff(directions, prepend=directions[-1]))
    is_corner = np.minimum(turns % (2.0 * np.pi), 2.0 * np.pi - turns % (2.0 * np.pi)) > np.radians(TURN_DEG)
    spacing, distance, kept_nodes = steps.sum() / PIECES, np.inf, []
    for number in range(along.size):
        if is_corner[number] or distance >= spacing:
            kept_nodes.append(number)
            distance = 0.0
        distance += steps[number]
    return along[np.array(kept_nodes)]
