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
from facegear.teeth.placement import body_rotation, pair_at, rotation
from facegear.teeth.solids import solid, triangles

PROFILE, WIDTH = 9, 5
"""Points of every patch along the profile and the width."""
COLOURS: dict[Body, tuple[int, ...]] = {"pinion": (208, 140, 60, 255), "face_gear": (110, 130, 150, 255)}
"""Colour (red, green, blue, opacity; 0 to 255) of each body."""
UPWARDS = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
"""From our frame, whose z is the gears' axis, to that of glTF, whose y points upwards."""


def write_gltf(
    path: str | Path, design: PairDesign, pinions: Sequence[tuple[str, float]], sides: Sequence[str]
) -> Path:
    """Write whole gears in mesh, modifications included, as a binary glTF scene; assembly errors are left
    out.

    Each gear is placed in the frame of the upper gear, with z, the gears' axis, turned upwards (y of glTF).

    Parameters
    ----------
    path : str or Path
        File to write (.glb), lengths in m.
    design : PairDesign
        Pair of gears; all pinions have the same shape, and both face gears do unless an offset, or a shaft
        angle other than 90 degrees, makes the lower one another gear.
    pinions : sequence of (str, float)
        Name and distribution angle about the gears' axis, rad, of each pinion.
    sides : sequence of str
        Face gears to write: `upper`, `lower` or both.

    Returns
    -------
    Path
        The path.

    Raises
    ------
    MissingExtra
        If trimesh is not installed.
    """
    with extras_named():
        import trimesh  # a library of the extra `exchange`

    path, plain = Path(path), replace(design, assembly=AssemblyErrors())
    scene = trimesh.Scene()
    placements = []
    for side in sides:
        pair = pair_at(plain, side, "drive")
        shape_name = BODIES[1] if pair == plain else f"{side}_{BODIES[1]}"
        placements.append((f"{side} face gear", shape_name, BODIES[1], pair, gear_transform(plain, side)))
    placements += [
        (name, BODIES[0], BODIES[0], plain, pinion_transform(plain, angle)) for name, angle in pinions
    ]
    for name, shape_name, body, pair, transform in placements:
        if shape_name not in scene.geometry:
            corners = _corners(pair, body)  # once, however many of them there are
            shape = trimesh.Trimesh(corners, np.arange(len(corners)).reshape(-1, 3))
            shape.merge_vertices(digits_vertex=9)
            shape.visual.face_colors = COLOURS[body]
            scene.geometry[shape_name] = shape
        scene.graph.update(name, matrix=UPWARDS @ transform, geometry=shape_name)
    with atomic_path(path) as temporary:
        temporary.write_bytes(scene.export(file_type="glb"))
    return path


def _corners(design: PairDesign, body: Body) -> Array:
    """Return the corners of the triangles of a whole gear, (3 n, 3) m in its body frame, three rows a
    triangle.
    """
    return triangles(solid(design, body, None, PROFILE, WIDTH)).reshape(-1, 3)


def pinion_transform(design: PairDesign, angle: float) -> Array:
    """Return the transform from the pinion's body frame to the frame of the upper gear, in mesh at a
    distribution angle.

    The pinion is turned about its own axis as the gear ratio asks, laid onto its axis in the gear's frame,
    and moved round the gear's axis z by the angle.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    angle : float
        Distribution angle of the pinion about the gear's axis, rad.

    Returns
    -------
    (4, 4) array
        Homogeneous matrix for column vectors; rotations dimensionless, translations in m.
    """
    teeth = design.pinion.teeth
    transform = np.eye(4)
    spun = body_rotation("pinion", angle * design.face_gear.teeth / teeth - pi / teeth)
    transform[:3, :3] = design.family.motion.basis.T @ spun
    transform[0, 3] = design.offset
    return _about_axis(angle) @ transform


def gear_transform(design: PairDesign, side: str) -> Array:
    """Return the transform from a face gear's body frame to the frame of the upper gear.

    The lower gear stands in the frame turned by half a turn about y, where the pinion's axis, turned half
    round itself, is that of `placement.pair_at`. With an odd number of pinion teeth its tooth is where the
    upper gear has a space.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    side : str
        `upper` or `lower`.

    Returns
    -------
    (4, 4) array
        Homogeneous matrix; rotations dimensionless, translations in m.
    """
    if side == "upper":
        return np.eye(4)
    transform = np.eye(4)
    half_turn = rotation(np.array([0.0, 1.0, 0.0]), pi)
    shift = pi / design.face_gear.teeth if design.pinion.teeth % 2 else 0.0
    transform[:3, :3] = half_turn @ body_rotation("face_gear", shift)
    return transform


def _about_axis(angle: float) -> Array:
    """Return the homogeneous matrix (4, 4) of a rotation by an angle (rad) about the gear's axis z."""
    transform = np.eye(4)
    transform[:3, :3] = rotation(np.array([0.0, 0.0, 1.0]), angle)
    return transform
