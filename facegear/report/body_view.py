"""Mode shapes of face gears that bend in three dimensions, for the report's viewer."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Array, Integers
from facegear.report.page import View, encode_array
from facegear.report.pair_view import COLOURS

TURN_DEG, PIECES = 5.0, 100
"""A point of the outline is drawn where it turns by more, and otherwise at that many even distances."""
LARGEST_CODE = 32767
"""What the largest motion of a mode is stored as."""
SWING = 0.08
"""Largest motion drawn at first, in the outer radius."""
FACTOR = 2.5
"""How many times that a reader may ask for."""


def body_view(modes: pd.DataFrame, shapes: Mapping[str, AnyArray]) -> View | None:
    """Outline of each gear turned about its axis, with the motions of its first modes; none without modes.

    `modes` and `shapes` are those of stage gear_bodies. Gears that are alike are shown once. Lengths in mm.
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
    """Nodes along the outline of a mesh of quadrilaterals (cells, 4), in order."""
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
    """Return the nodes along an outline at its corners, and enough between them."""
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
