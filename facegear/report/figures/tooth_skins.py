"""Surfaces of teeth of every kind for the drawing of a pair in mesh: both flanks of pinion and gear."""

from collections.abc import Mapping
from math import cos, pi, sin
from typing import Any

import numpy as np

from facegear.arrays import Array

COAST = "coast_"
"""Beginning of the names of arrays that hold the coast flanks, where these are no mirror images."""


def coast_array(flanks: Mapping[str, Array], name: str) -> Array:
    """Return an array of the coast flank, in the mirror in which it is a drive flank.

    Parameters
    ----------
    flanks : mapping of (...) arrays
        Arrays of `geometry/flanks.npz`, m.
    name : str
        Name of the array of the drive flank, such as `gear_flank`.

    Returns
    -------
    (...) array
        The array of the coast flank, m; that of the drive flank where both are mirror images.
    """
    return flanks.get(f"{COAST}{name}", flanks[name])


def spur_pinion_skin(flanks: Mapping[str, Array], bore: float) -> list[Array]:
    """Return the surface of a spur pinion's tooth and its inner end.

    Parameters
    ----------
    flanks : mapping of (...) arrays
        Arrays of `geometry/flanks.npz`, m.
    bore : float
        Radius of the bore, m.

    Returns
    -------
    list of (n, 2, 3) arrays
        Grids in the body frame, m, from the middle of a space to the next: surface, and end down to the bore.
    """
    half = flanks["pinion_section"][::8]
    section = np.concatenate([half[::-1], half * [-1, 1]])
    first, last = flanks["pinion_flank"][0, [0, -1], 1]
    outer = np.insert(section * [1, -1], 1, first, axis=1)
    inner = np.insert(
        bore * section / np.linalg.norm(section, axis=1, keepdims=True) * [1, -1], 1, first, axis=1
    )
    return [np.stack([outer, outer + [0, last - first, 0]], axis=1), np.stack([outer, inner], axis=1)]


def spur_gear_skin(flanks: Mapping[str, Array], teeth: int) -> list[Array]:
    """Return the surface of a gear tooth for a spur pinion and its inner end.

    Parameters
    ----------
    flanks : mapping of (...) arrays
        Arrays of `geometry/flanks.npz`, m.
    teeth : int
        Number of teeth.

    Returns
    -------
    list of (n, m, 3) arrays
        Grids in the body frame, m, from the middle of a space to the next: surface, and end down to its foot.
    """
    right = np.concatenate([flanks["gear_flank"][::4, ::8], flanks["gear_fillet"][::4, ::8]])
    radius = np.hypot(right[0, :, 0], right[0, :, 1])
    middle = np.stack([radius * np.sin(pi / teeth), radius * np.cos(pi / teeth), right[-1, :, 2]], axis=-1)
    right = np.concatenate([right, middle[None]])
    surface = np.concatenate([right[::-1], right * [-1, 1, 1]])
    below = surface[:, 0].copy()
    below[:, 2] = 1.15 * surface[..., 2].min()
    return [surface, np.stack([surface[:, 0], below], axis=1)]


def pinion_skin(flanks: Mapping[str, Array], teeth: int, bore: float) -> list[Array]:
    """Return the surface of a pinion tooth and its inner end.

    Parameters
    ----------
    flanks : mapping of (...) arrays
        Arrays of `geometry/flanks.npz`, m.
    teeth : int
        Number of teeth.
    bore : float
        Radius of the bore, m.

    Returns
    -------
    list of (n, m, 3) arrays
        Grids in the body frame, m: from one root to the next along the face, and the inner end down to the
        bore.
    """
    right = np.concatenate([flanks["pinion_flank"], flanks["pinion_fillet"][1:]])
    coast = [coast_array(flanks, f"pinion_{part}") for part in ("flank", "fillet")]
    left = np.concatenate([coast[0], coast[1][1:]]) * [-1, 1, 1]
    surface = np.concatenate([left[::-1], right, turned_pinion(left[-1:], 2 * pi / teeth)])
    end = surface[:, 0]
    inner = end * [1, 0, 1]
    inner = bore * inner / np.linalg.norm(inner, axis=1, keepdims=True) + end * [0, 1, 0]
    return [surface, np.stack([end, inner], axis=1)]


def gear_skin(flanks: Mapping[str, Array], teeth: int) -> list[Array]:
    """Return the surface of a face gear's tooth and its inner end.

    Parameters
    ----------
    flanks : mapping of (...) arrays
        Arrays of `geometry/flanks.npz`, m.
    teeth : int
        Number of teeth.

    Returns
    -------
    list of (n, m, 3) arrays
        Grids in the body frame, m: from one root to the next along the face, and the inner end down to its
        foot.
    """
    left = np.concatenate([flanks["gear_flank"], flanks["gear_fillet"][1:]]) * [-1, 1, 1]
    right = np.concatenate([coast_array(flanks, "gear_flank"), coast_array(flanks, "gear_fillet")[1:]])
    surface = np.concatenate([left[::-1], right, turned_gear(left[-1:], 2 * pi / teeth)])
    below = surface[:, 0].copy()
    below[:, 2] = 1.15 * surface[..., 2].min()
    return [surface, np.stack([surface[:, 0], below], axis=1)]


def turned_pinion(points: Array, angle: float) -> Array:
    """Rotate points about the pinion's axis, y, by an angle that moves +x towards +z.

    Parameters
    ----------
    points : (..., 3) array
        m.
    angle : float
        rad.

    Returns
    -------
    (..., 3) array
        m.
    """
    c, s = cos(angle), sin(angle)
    return points @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]).T


def turned_gear(points: Array, angle: float) -> Array:
    """Rotate points about the gear's axis, z, by an angle that moves +y towards +x.

    Parameters
    ----------
    points : (..., 3) array
        m.
    angle : float
        rad.

    Returns
    -------
    (..., 3) array
        m.
    """
    c, s = cos(angle), sin(angle)
    return points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]).T


def place_pinion(points: Array, design: Mapping[str, Any]) -> Array:
    """Move points of the pinion to its place in the gear's frame.

    Parameters
    ----------
    points : (..., 3) array
        Points in the pinion's body frame: x, place along the axis, and height above it, m.
    design : mapping
        Entry `design_si` of the record of the tooth geometry: shaft angle (rad) and offset (m).

    Returns
    -------
    (..., 3) array
        Points in the mesh frame, m.
    """
    angle = design["shaft_angle"]
    sine, cosine = sin(angle), 0.0 if angle == pi / 2 else cos(angle)
    basis = np.array([[1.0, 0.0, 0.0], [0.0, sine, -cosine], [0.0, cosine, sine]])
    return points @ basis + [design["offset"], 0.0, 0.0]
