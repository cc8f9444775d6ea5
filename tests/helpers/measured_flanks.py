"""Deviations of flanks for tests: fields sampled on grids, pairs that have them, and rays at such flanks."""

from dataclasses import replace

import numpy as np

from facegear.teeth import face_gear
from facegear.teeth.flank_shapes import DeviationGrid
from facegear.teeth.placement import to_left_flank
from facegear.teeth.separation import Separation, separation
from facegear.teeth.surfaces import SurfacePoints, flank_face

UM, MM = 1e-6, 1e-3


def sampled(design, body, field, places=(13, 9), deepest=1.0):
    """Values (m) of a field of face and profile (m) on a grid over a flank, or over a part of its depth."""
    face = flank_face(design, body)
    low, high = face.profile
    along, across = (
        np.linspace(*face.face, places[0]),
        np.linspace(low, low + deepest * (high - low), places[1]),
    )
    values = np.broadcast_to(field(along[:, None], across), places)
    return DeviationGrid(tuple(along), tuple(across), tuple(map(tuple, values.tolist())))


def with_grid(design, body, grid, flank=None):
    """The pair whose drive flank of a body, unless `flank` says another, deviates as the grid says."""
    flank = flank or {"pinion": "right", "face_gear": "left"}[body]
    own = getattr(design, body)
    return replace(design, **{body: replace(own, flanks=replace(own.flanks, **{flank: grid}))})


def constant(amount):
    return lambda face, profile: amount + 0.0 * face * profile


def place_on_pinion(design, radius, depth):
    """Face and profile (m) on the pinion that conjugate action brings to places of the gear's flank."""
    roll, psi = face_gear.roll_and_psi_at_height(design, radius, face_gear.tip_height(design, radius) - depth)
    y = design.gear_base_radius / np.cos(psi)
    length = design.shaper_base_radius * roll - design.shaper_lift * np.sin(psi)
    return y - design.mean_radius, length


def seen_from(design, displaced, normal, distance) -> Separation:
    """Intersect rays a little aslant to the normals (n, 3), like those of the pinion, with the gear's flank.

    The rays meet it at or near the points displaced (n, 3), from a distance (m) before them.
    """
    ways = -normal + 0.02 * np.array([1.0, -0.5, 1.0])
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    starts = displaced - distance * ways
    back = to_left_flank(design, 0.0, 0.0, 0).inverse()
    points = SurfacePoints(back.points(starts[None])[0], back.directions(ways[None])[0])
    return separation(design, points, 0.0, 0.0)
