"""Teeth of a pair, or of a whole machine, as a binary glTF scene: metres, the gears' axis upwards."""

from collections.abc import Sequence
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np

from facegear.arrays import Array
from facegear.errors import extras_named
from facegear.io.atomic import atomic_path
from facegear.quantities import BODIES, Body
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.placement import body_rotation, rotation
from facegear.teeth.solids import solid, triangles

PROFILE, WIDTH = 9, 5
"""Points of every patch along the profile and the width."""
COLOURS: dict[Body, tuple[int, ...]] = {"pinion": (208, 140, 60, 255), "face_gear": (110, 130, 150, 255)}
UPWARDS = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
"""From our frame, whose z is the gears' axis, to that of glTF, whose y points upwards."""


def write_gltf(
    path: str | Path, design: PairDesign, pinions: Sequence[tuple[str, float]], sides: Sequence[str]
) -> Path:
    """Write whole gears, modifications included, in mesh; returns the path.

    `pinions`: name and distribution angle (rad) of each; `sides`: of upper, lower, the face gears. Assembly
    errors are left out. Raises MissingExtra where trimesh is not installed.
    """
    with extras_named():
        import trimesh  # a library of the extra `exchange`

    path, plain = Path(path), replace(design, assembly=AssemblyErrors())
    scene = trimesh.Scene()
    placements = [(f"{side} face gear", BODIES[1], gear_transform(plain, side)) for side in sides]
    placements += [(name, BODIES[0], pinion_transform(plain, angle)) for name, angle in pinions]
    for name, body, transform in placements:
        if body not in scene.geometry:
            corners = _corners(plain, body)  # once, however many of them there are
            shape = trimesh.Trimesh(corners, np.arange(len(corners)).reshape(-1, 3))
            shape.merge_vertices(digits_vertex=9)
            shape.visual.face_colors = COLOURS[body]
            scene.geometry[body] = shape
        scene.graph.update(name, matrix=UPWARDS @ transform, geometry=body)
    with atomic_path(path) as temporary:
        temporary.write_bytes(scene.export(file_type="glb"))
    return path


def _corners(design: PairDesign, body: Body) -> Array:
    """Corners of the triangles of a body, three rows each, in metres."""
    return triangles(solid(design, body, None, PROFILE, WIDTH)).reshape(-1, 3)


def pinion_transform(design: PairDesign, angle: float) -> Array:
    """Matrix (4, 4) from the pinion's body frame to that of the upper gear, at a distribution angle (rad).

    The pinion stands as the teeth of the gear at that angle ask for: as if the gear had turned by it.
    """
    teeth = design.pinion.teeth
    transform = _about_axis(angle)
    transform[:3, :3] @= body_rotation("pinion", angle * design.face_gear.teeth / teeth - pi / teeth)
    return transform


def gear_transform(design: PairDesign, side: str) -> Array:
    """Matrix (4, 4) of a face gear. The lower one is the upper one turned half round the pinion's axis.

    With an odd number of the pinion's teeth its tooth stands where the upper one has a space.
    """
    if side == "upper":
        return np.eye(4)
    transform = np.eye(4)
    half_turn = rotation(np.array([0.0, 1.0, 0.0]), pi)
    shift = pi / design.face_gear.teeth if design.pinion.teeth % 2 else 0.0
    transform[:3, :3] = half_turn @ body_rotation("face_gear", shift)
    return transform


def _about_axis(angle: float) -> Array:
    transform = np.eye(4)
    transform[:3, :3] = rotation(np.array([0.0, 0.0, 1.0]), angle)
    return transform
