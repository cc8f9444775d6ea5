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
from facegear.teeth import face_gear, pinion
from facegear.teeth.design import PairDesign
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.modifications import fillet_as_made, flank_as_made
from facegear.teeth.placement import body_rotation, mirror_teeth
from facegear.teeth.section_outline import Outline
from facegear.teeth.surfaces import fillet_points, flank_points
from facegear.teeth.tooth_sides import GearSide, PinionSide, cylindrical, polar


@dataclass(frozen=True, eq=False)
class HalfTooth:
    """One half of tooth 0 from the middle of its land to the middle of the space, in the frame in which it
    stands on the right.

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
    halves = _pinion_halves if body == "pinion" else _gear_halves
    right, left = halves(design, profile, width)
    tooth = [*_sides(right), *(mirror_patch(part) for part in _sides(left))]
    patches = [rotate_points(part, body, 2 * pi * n / whole) for n in numbers(count) for part in tooth]
    if count < whole:
        first, last = (2 * pi * n / whole for n in (numbers(count)[0] - 1, numbers(count)[-1]))
        # the same triangles at both ends, so that their chords cancel in the volume
        end = _cut(right)
        patches += [rotate_points(end, body, last), rotate_points(end.transpose(1, 0, 2), body, first)]
    return patches


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


def _pinion_halves(design: PairDesign, profile: int, width: int) -> tuple[HalfTooth, HalfTooth]:
    """Return the right and the left half of a pinion tooth: land, chamfer, flank, fillet, root land, and
    their base at the bore.
    """
    half, few = design.pinion.width / 2, (profile - 1) // 4 + 1
    y = np.linspace(design.middle - half, design.middle + half, width)
    right, left = design, mirror_teeth(design)
    sides = [_pinion_side(right, y, profile)]
    sides.append(sides[0] if left == right else _pinion_side(left, y, profile))
    tips, roots = ([_polar_lines(side[end][end]) for side in sides] for end in (0, -1))
    pitch = np.array([pi / design.pinion.teeth, 0.0, 0.0])
    halves = []
    for number, side in enumerate(sides):
        land = _lines(_halfway(tips, number), tips[number], few, side[0][0])
        root = _lines(_halfway(roots, number) + pitch, roots[number], few, side[-1][-1])[::-1]
        surface = [land, *side, root]
        base = [_onto_bore(patch, design.pinion.bore_radius) for patch in surface]
        halves.append(HalfTooth(surface, base, -1.0))
    return halves[0], halves[1]


def _pinion_side(design: PairDesign, y: Array, profile: int) -> list[Array]:
    """Return the patches of the right side at places y (width,), m: chamfer, flank and fillet."""
    side = PinionSide(design.family, y)
    flank = [
        flank_points(design, np.linspace(top, bottom, profile), y).position
        for top, bottom in pairwise(_roll_bounds(design, side))
    ]
    gamma = np.linspace(side.surface.helicoid.pressure_angle, pi / 2, profile)[:, None]
    patches = [*flank, fillet_points(design, gamma, y).position]
    if design.pinion.tip_chamfer > 0:
        angle = side.flank(np.zeros(1))[0][0] - design.pinion.tip_chamfer / side.tip_height
        corner = pinion.cartesian(side.tip_height, angle, y)
        patches.insert(0, _between(corner, flank[0][0], (profile - 1) // 4 + 1))
    return patches


def _roll_bounds(design: PairDesign, side: PinionSide) -> list[Array]:
    """Return the roll angles (width,), rad, from tip to fillet, between which the right flank has no kink by
    reliefs.
    """
    top, bottom = side.roll_ends

    def kinks(relief: Relief) -> list[float]:
        """Return where a relief begins and ends, as roll angles (rad) from its end of the flank."""
        lengths = [relief.start, relief.start + relief.length] if relief.amount else []
        return [length / design.pinion_base_radius for length in lengths]

    lines = [top - kink for kink in kinks(design.pinion.tip_relief)]
    lines += [bottom + kink for kink in kinks(design.pinion.root_relief)]
    inside = [line for line in lines if ((bottom < line) & (line < top)).all()]
    different = {line.tobytes(): line for line in inside}.values()
    return [top, *np.sort(np.array([*different]).reshape(-1, top.size), axis=0)[::-1], bottom]


def _polar_lines(points: Array) -> Array:
    """Return angle (rad), radius and y (m), (n, 3), of points of the pinion (n, 3), m."""
    return np.stack([*polar(points), points[:, 1]], axis=-1)


def _halfway(lines: Sequence[Array], number: int) -> Array:
    """Return the line (n, 3) between the right and the left side's `lines`, each with angles in its own
    frame, in the frame of side `number`.
    """
    return (lines[number] + lines[1 - number] * np.array([-1.0, 1.0, 1.0])) / 2


def _lines(start: Array, end: Array, count: int, last: Array) -> Array:
    """Return points (count, n, 3) of the pinion, m, between angle, radius and y `start` and `end` (n, 3),
    the `last` ones (n, 3) given.
    """
    fraction = np.linspace(0.0, 1.0, count)[:, None, None]
    angle, radius, y = np.moveaxis(start + fraction * (end - start), -1, 0)
    points = pinion.cartesian(radius, angle, y)
    points[-1] = last
    return points


def _between(start: Array, end: Array, count: int) -> Array:
    """Return points (count, n, 3) on straight lines from `start` to `end`, (n, 3) each, m."""
    fraction = np.linspace(0.0, 1.0, count)[:, None, None]
    points = start + fraction * (end - start)
    points[-1] = end
    return points


def _onto_bore(points: Array, bore: float) -> Array:
    """Project points (..., 3), m, radially onto a cylinder of radius `bore` (m) about the pinion's axis."""
    angle, _ = polar(points)
    return pinion.cartesian(bore, angle, points[..., 1])


def _gear_halves(design: PairDesign, profile: int, width: int) -> tuple[HalfTooth, HalfTooth]:
    """Return the right and the left half of a gear tooth: land, flank, fillet, root land, and their base on
    the back plane.
    """
    gear, step = design.face_gear, np.linspace(0.0, 1.0, (profile - 1) // 4 + 1)[:, None]
    radius = np.linspace(gear.inner_radius, gear.outer_radius, width)
    outline = Outline(design, "face_gear", radius)
    right, left = mirror_teeth(design), design
    sides = [_gear_side(right, radius, profile)]
    sides.append(sides[0] if left == right else _gear_side(left, radius, profile))
    tips, roots = ([cylindrical(side[end][end])[0] for side in sides] for end in (0, -1))
    flat, back = np.array([1.0, 1.0, 0.0]), np.array([0.0, 0.0, outline.back_height])
    halves = []
    for number, (flank, fillet) in enumerate(sides):
        (tip, other_tip), (last, other_last) = (
            (angles[number], angles[1 - number]) for angles in (tips, roots)
        )
        middle, cut = (tip - other_tip) / 2, (last - other_last) / 2 + pi / gear.teeth
        land = face_gear.cylindrical(radius, middle + step * (tip - middle), outline.tip_height)
        root = face_gear.cylindrical(radius, last + step * (cut - last), outline.root_height)
        land[-1], root[0] = flank[0], fillet[-1]
        surface = [land, flank, fillet, root]
        halves.append(HalfTooth(surface, [patch * flat + back for patch in surface], 1.0))
    return halves[0], halves[1]


def _gear_side(design: PairDesign, radius: Array, profile: int) -> tuple[Array, Array]:
    """Return the patches of flank and fillet of the left side at gear radii (width,), m, in the mirror in
    which it stands on the right.
    """
    side, fraction = GearSide(design.mirror_family, radius), np.linspace(0.0, 1.0, profile)
    flank = flank_as_made(design, *side.flank_parameters(fraction))
    start, end = side.slope_ends
    fillet = fillet_as_made(design, radius, start + fraction[:, None] * (end - start))
    fillet[0] = flank[-1]
    return flank, fillet


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
