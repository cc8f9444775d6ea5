"""Closed surfaces of whole teeth, fillets and bodies included, as patches of exact points.

A patch is a grid (profile, width, 3) of points in m in the body frame of its gear (see `design`); its normal,
first direction cross second, points outwards. Neighbouring patches share the points of their common edge.
Unlike the finite element bodies, teeth are not idealised: lands, chamfer, modifications and the deviations of
all teeth are those of the config, assembly errors are left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import pi

import numpy as np

from facegear.arrays import Array
from facegear.quantities import Body
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.design import PairDesign
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.modifications import fillet_as_made, flank_as_made
from facegear.teeth.placement import body_rotation
from facegear.teeth.surfaces import fillet_points, flank_points


@dataclass(frozen=True, eq=False)
class HalfTooth:
    """The right half of tooth 0 from the middle of its land to the middle of the space.

    `surface`: patches in that order; `base`: where each of them, ends in the body (bore or back).
    """

    surface: Sequence[Array]
    base: Sequence[Array]
    normal_sign: float
    """+1 if first direction cross second points out of the tooth on its surface."""


def solid(
    design: PairDesign, body: Body, teeth: int | None = None, profile: int = 17, width: int = 17
) -> list[Array]:
    """Return patches of a gear, or of a sector of teeth about tooth 0, which together enclose it.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    body : Body
        `pinion` or `face_gear`.
    teeth : int, optional
        Number of teeth of the sector; the whole gear if None.
    profile : int
        Points of every patch along the profile (of lands: a quarter).
    width : int
        Points of every patch along the width.

    Returns
    -------
    list of (profile, width, 3) arrays
        Points in the body frame, m, normals outwards.
    """
    whole = teeth_of(design, body)
    count = whole if teeth is None else teeth
    right, left = _halves(design, body, profile, width)
    tooth = [*_sides(right), *(mirror_patch(part) for part in _sides(left))]
    patches = [rotate_points(part, body, 2 * pi * n / whole) for n in numbers(count) for part in tooth]
    if count < whole:
        end, first, last = _cut(right), *(2 * pi * n / whole for n in (numbers(count)[0], numbers(count)[-1]))
        patches += [rotate_points(end, body, last), rotate_points(mirror_patch(end), body, first)]
    return patches


def _halves(design: PairDesign, body: Body, profile: int, width: int) -> tuple[HalfTooth, HalfTooth]:
    """Return the right half of a tooth, and the left half seen in a mirror x -> -x, with its own
    deviations.
    """
    if body == "pinion":
        return _pinion_half(design, profile, width), _pinion_half(design.with_swapped_flanks, profile, width)
    return _gear_half(design.with_swapped_flanks, profile, width), _gear_half(design, profile, width)


def teeth_of(design: PairDesign, body: Body) -> int:
    """Return the number of teeth of the whole gear.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    body : Body
        `pinion` or `face_gear`.

    Returns
    -------
    int
        Number of teeth.
    """
    return design.pinion.teeth if body == "pinion" else design.face_gear.teeth


def numbers(count: int) -> range:
    """Return the numbers of neighbouring teeth about tooth 0.

    Parameters
    ----------
    count : int
        Number of teeth.

    Returns
    -------
    range
        Numbers of the teeth, such as -1, 0, 1 for three.
    """
    return range(-(count // 2), count - count // 2)


def rotate_points(points: Array, body: Body, angle: float) -> Array:
    """Rotate points of a body about its axis.

    Parameters
    ----------
    points : (..., 3) array
        m.
    body : Body
        `pinion` or `face_gear`.
    angle : float
        rad, positive as in `design`.

    Returns
    -------
    (..., 3) array
        m.
    """
    return points @ body_rotation(body, angle).T


def mirror_patch(patch: Array) -> Array:
    """Return the left side's patch for one of the right side, normal outwards.

    Parameters
    ----------
    patch : (profile, width, 3) array
        m.

    Returns
    -------
    (profile, width, 3) array
        m.
    """
    return patch[::-1] * np.array([-1.0, 1.0, 1.0])


def _sides(half: HalfTooth) -> list[Array]:
    """Return the patches of half a tooth with normals outwards: for each part surface, base and both ends."""
    patches = []
    for surface, base in zip(half.surface, half.base, strict=True):
        first, last = (np.stack([surface[:, k], base[:, k]], axis=1) for k in (0, -1))
        patches += [surface, base[::-1], first[::-1], last]
    return patches if half.normal_sign > 0 else [patch[::-1] for patch in patches]


def _cut(half: HalfTooth) -> Array:
    """Return the patch (2, width, 3) through the middle of the tooth space on the right, normal outwards."""
    cut = np.stack([half.surface[-1][-1], half.base[-1][-1]], axis=1)
    return cut[::-1] if half.normal_sign > 0 else cut


def _pinion_half(design: PairDesign, profile: int, width: int) -> HalfTooth:
    """Return the right half of a pinion tooth: land, chamfer, flank, fillet, root land, and their base at
    the bore.
    """
    part, few = design.pinion, (profile - 1) // 4 + 1
    y = np.linspace(design.mean_radius - part.width / 2, design.mean_radius + part.width / 2, width)[None, :]
    bounds = _roll_bounds(design)
    flank = [
        flank_points(design, np.linspace(top, bottom, profile)[:, None], y).position
        for top, bottom in pairwise(bounds)
    ]
    gamma = np.linspace(design.pressure_angle, pi / 2, profile)[:, None]
    fillet = fillet_points(design, gamma, y).position
    tip = flank[0][0]
    lands = []
    if part.tip_chamfer > 0:
        corner = pinion.cartesian(design.pinion_tip_radius, pinion.tip_half_angle(design, y[0]), y[0])
        lands = [_between(corner, tip, few)]
        tip = corner
    land = _arc(np.zeros(width), tip, few)
    root = _arc(np.full(width, pi / part.teeth), fillet[-1], few)[::-1]
    surface = [land, *lands, *flank, fillet, root]
    return HalfTooth(surface, [_onto_bore(patch, part.bore_radius) for patch in surface], -1.0)


def _roll_bounds(design: PairDesign) -> list[float]:
    """Return the roll angles (rad), from tip to fillet, between which the pinion's flank has no kink by
    reliefs.
    """
    top, bottom = design.pinion_tip_roll, float(pinion.junction_roll(design, design.middle))

    def kinks(relief: Relief) -> list[float]:
        """Return where a relief begins and ends, as roll angles (rad) from its end of the flank."""
        lengths = [relief.start, relief.start + relief.length] if relief.amount else []
        return [length / design.pinion_base_radius for length in lengths]

    inside = [top - kink for kink in kinks(design.pinion.tip_relief)]
    inside += [bottom + kink for kink in kinks(design.pinion.root_relief)]
    return [top, *sorted({roll for roll in inside if bottom < roll < top}, reverse=True), bottom]


def _polar(points: Array) -> tuple[Array, Array]:
    """Return radius, m, and angle, rad, of points about the pinion's axis."""
    return np.hypot(points[..., 0], points[..., 2]), np.arctan2(points[..., 0], -points[..., 2])


def _arc(start: Array, end: Array, count: int) -> Array:
    """Return points (count, n, 3) on circles from polar angles `start` (n,) to the points `end` (n, 3)."""
    radius, angle = _polar(end)
    fraction = np.linspace(0.0, 1.0, count)[:, None]
    points = pinion.cartesian(radius, start + fraction * (angle - start), end[:, 1])
    points[-1] = end
    return points


def _between(start: Array, end: Array, count: int) -> Array:
    """Return points (count, n, 3) on straight lines from `start` to `end`, (n, 3) each, m."""
    fraction = np.linspace(0.0, 1.0, count)[:, None, None]
    points = start + fraction * (end - start)
    points[-1] = end
    return points


def _onto_bore(points: Array, bore: float) -> Array:
    """Project points (..., 3), m, radially onto a cylinder of radius `bore` (m) about the pinion's axis."""
    _, angle = _polar(points)
    return pinion.cartesian(bore, angle, points[..., 1])


def _gear_half(design: PairDesign, profile: int, width: int) -> HalfTooth:
    """Return the right half of a gear tooth: land, flank, fillet, root land, and their base on the back
    plane.
    """
    gear, few = design.face_gear, (profile - 1) // 4 + 1
    radius = np.linspace(gear.inner_radius, gear.outer_radius, width)[None, :]
    fraction = np.linspace(0.0, 1.0, profile)[:, None]
    top, _ = face_gear.roll_and_psi_at_height(design, radius, design.gear_tip_plane)
    roll = top + fraction * (design.shaper_tip_roll - top)
    flank = flank_as_made(design, roll, face_gear.psi_at(design, radius, roll))
    slopes = face_gear_fillet.fillet_slopes(design, radius, fraction)
    fillet = fillet_as_made(design, radius, slopes)
    fillet[0] = flank[-1]
    step = np.linspace(0.0, 1.0, few)[:, None]
    tip, last = (np.arctan2(line[:, 0], line[:, 1]) for line in (flank[0], fillet[-1]))
    land = face_gear.cylindrical(radius, step * tip, design.gear_tip_plane)
    root = face_gear.cylindrical(radius, last + step * (pi / gear.teeth - last), design.gear_root_plane)
    land[-1], root[0] = flank[0], fillet[-1]
    surface = [land, flank, fillet, root]
    flat = np.array([1.0, 1.0, 0.0])
    base = [patch * flat + [0.0, 0.0, design.gear_back_plane] for patch in surface]
    return HalfTooth(surface, base, 1.0)


def volume(patches: Sequence[Array]) -> float:
    """Compute the volume that the patches' triangles enclose.

    Parameters
    ----------
    patches : sequence of (profile, width, 3) arrays
        m.

    Returns
    -------
    float
        m3.
    """
    corners = triangles(patches)
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6.0


def triangles(patches: Sequence[Array]) -> Array:
    """Split every cell of the patches into two triangles, counterclockwise from outside.

    Parameters
    ----------
    patches : sequence of (profile, width, 3) arrays
        m.

    Returns
    -------
    (n, 3, 3) array
        Corners, m.
    """
    parts = []
    for patch in patches:
        a, b, c, d = patch[:-1, :-1], patch[1:, :-1], patch[1:, 1:], patch[:-1, 1:]
        parts += [np.stack(corners, axis=-2).reshape(-1, 3, 3) for corners in ((a, b, c), (a, c, d))]
    return np.concatenate(parts)
