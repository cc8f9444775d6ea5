"""Outline of the pinion's tooth, and the smallest gap between the whole teeth over a pitch.

Smallest gap between the whole teeth over a pitch, fillets, tips and lands included: finds interference.
Points of the gear's tooth (tip edge, flank, fillet, root land) are brought into the pinion's section, and the
signed distance to the tooth outline is taken; negative means that the gear stands inside the pinion. The
outline is that of the middle section: where a helix turns the sections or a taper changes them, points are
moved to it along the tooth, and the distance is then taken exactly from the surface that they are near.
"""

from dataclasses import dataclass
from math import copysign, inf, isfinite, pi

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from facegear.arrays import Array, Integers, Mask
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.design import PairDesign
from facegear.teeth.modifications import fillet_as_made, flank_as_made
from facegear.teeth.opposite import fillet_feet, flank_feet, is_prismatic, to_middle_section
from facegear.teeth.placement import mirror_design, to_pinion_section

PINION_PARTS = ("tip land", "chamfer", "flank", "fillet", "root land")
"""Parts of a pinion tooth, from tip to root."""
_MODIFIED_PARTS = [PINION_PARTS.index("flank"), PINION_PARTS.index("fillet")]
"""Indices of the parts that modifications change."""


REFINED_GAP = 0.15
"""Rough distance (modules) below which that from a fillet is taken exactly, where the pinion's sections
differ."""


@dataclass(frozen=True)
class PinionOutline:
    """The right half tooth from the middle of the tip land to the middle of the space, in the middle section.

    points, normals: (n, 2) in (x, -z); other_normals differ at the corners, where two parts meet. part: (n,)
    index in PINION_PARTS. roll: (n,) roll angle (rad) that modifications are taken at.
    """

    points: Array
    normals: Array
    other_normals: Array
    part: Integers
    roll: Array
    tree: cKDTree


def pinion_outline(design: PairDesign, density: int = 1200) -> PinionOutline:
    """Return the outline of half a tooth.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    density : int
        Number of points on the flank and on the fillet each; lands and chamfer have a twentieth.

    Returns
    -------
    PinionOutline
        Outline, m.
    """
    middle = design.middle
    edge, space = float(pinion.tip_half_angle(design, middle)), float(pinion.root_angle(design, middle))
    few = density // 20
    land = np.linspace(0, edge, few)
    top, bottom = design.pinion_tip_roll, float(pinion.junction_roll(design, middle))
    roll = np.sqrt(np.linspace(top**2, bottom**2, density))
    gamma = np.linspace(design.transverse_pressure_angle, pi / 2, density)
    root = np.linspace(space - pinion.root_half_angle(design), space, few)
    parts = {
        "tip land": (np.full(few, design.pinion_tip_radius), land, (np.sin(land), np.cos(land))),
        "flank": (
            *pinion.involute_point(design, roll, middle),
            _upright(pinion.involute_normal(design, roll, middle)),
        ),
        "fillet": (
            *pinion.trochoid_point(design, gamma, middle),
            _upright(pinion.trochoid_normal(design, gamma, middle)),
        ),
        "root land": (np.full(few, design.pinion_root_radius), root, (np.sin(root), np.cos(root))),
    }
    if design.pinion.tip_chamfer > 0:
        parts["chamfer"] = _chamfer(design, few)
    names = [name for name in PINION_PARTS if name in parts]
    points = [
        np.stack([parts[n][0] * np.sin(parts[n][1]), parts[n][0] * np.cos(parts[n][1])], 1) for n in names
    ]
    normals = [np.stack(parts[n][2], 1) for n in names]
    corner_normals = [normal.copy() for normal in normals]
    for before, after in zip(range(len(names) - 1), range(1, len(names)), strict=True):
        corner_normals[before][-1], corner_normals[after][0] = normals[after][0], normals[before][-1]
    sizes = [len(part) for part in points]
    numbers = np.repeat([PINION_PARTS.index(name) for name in names], sizes)
    rolls = np.full(sum(sizes), bottom)
    rolls[numbers == PINION_PARTS.index("flank")] = roll
    nodes = np.concatenate(points)
    return PinionOutline(
        points=nodes,
        normals=np.concatenate(normals),
        other_normals=np.concatenate(corner_normals),
        part=numbers,
        roll=rolls,
        tree=cKDTree(nodes),
    )


def _upright(normal: Array) -> tuple[Array, Array]:
    """Return the directions of normals (n, 3) in the section as (x, -z), as the outline has them."""
    length = np.hypot(normal[:, 0], normal[:, 2])
    return normal[:, 0] / length, -normal[:, 2] / length


def _chamfer(design: PairDesign, count: int) -> tuple[Array, Array, tuple[Array, Array]]:
    """Return radius (m), polar angle (rad) and outward normal (x, -z) at `count` points along the tip
    chamfer.
    """
    (r0, a0) = design.pinion_tip_radius, float(pinion.tip_half_angle(design, design.middle))
    flank_end = pinion.involute_point(design, design.pinion_tip_roll, design.middle)
    r1, a1 = (float(part) for part in flank_end)
    start, end = (np.array([r * np.sin(a), r * np.cos(a)]) for r, a in ((r0, a0), (r1, a1)))
    line = start + np.linspace(0, 1, count)[:, None] * (end - start)
    along = (end - start) / np.linalg.norm(end - start)
    normal = np.full(count, -along[1]), np.full(count, along[0])
    return np.hypot(line[:, 0], line[:, 1]), np.arctan2(line[:, 0], line[:, 1]), normal


def signed_distance(
    design: PairDesign, outline: PinionOutline, section: Array, search_radius: float
) -> tuple[Array, Integers]:
    """Compute the signed distance of points from the outline of a pinion tooth, modifications included.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    outline : PinionOutline
        Outline of the pinion.
    section : (..., 3) array
        Points, x, -z, y of the pinion's body frame, m.
    search_radius : float
        Distance up to which the outline is searched, m.

    Returns
    -------
    tuple of (...) arrays
        Distance, m, negative inside the tooth, inf beyond `search_radius` and the ends of the face; index
        of the nearest point of the outline.
    """
    flat = section[..., :2] if is_prismatic(design) else _to_middle(design, section)
    distance, nearest = outline.tree.query(flat, distance_upper_bound=search_radius)
    away = np.abs(section[..., 2] - design.middle) > design.pinion.width / 2
    far = ~np.isfinite(distance) | away
    nearest = np.where(far, 0, nearest)
    offset = flat - outline.points[nearest]
    normal = np.sum(offset * outline.normals[nearest], axis=-1)
    # a point at a convex corner is outside if it is outside either part
    normal = np.maximum(normal, np.sum(offset * outline.other_normals[nearest], axis=-1))
    along = np.sqrt(np.maximum(np.where(far, 0.0, distance) ** 2 - normal**2, 0.0))
    # on a smooth part the nearest vertex lies within a spacing: the normal part is the distance
    corner = (along > 0.02 * design.module) & (normal > 0)
    signed_length = np.where(corner, distance, normal)
    is_modified = np.isin(outline.part[nearest], _MODIFIED_PARTS)
    signed_length = signed_length + np.where(
        is_modified, pinion.removed_depth(design, outline.roll[nearest], section[..., 2]), 0.0
    )
    if not is_prismatic(design):
        _set_exact(design, outline, section, (signed_length, nearest), ~far & ~corner)
    return np.where(far, np.inf, signed_length), nearest


def _to_middle(design: PairDesign, section: Array) -> Array:
    """Return points (..., 3), x, -z, y in m, moved along the tooth to the middle section, (..., 2): turned by
    the flank's helix, and as far outwards as the taper brings the tip of their section.
    """
    flat = to_middle_section(design, section)
    growth = (section[..., 2] - design.middle) * design.family.taper
    return flat * (1.0 - growth / np.hypot(flat[..., 0], flat[..., 1]))[..., None]


def _set_exact(
    design: PairDesign, outline: PinionOutline, section: Array, rough: tuple[Array, Integers], near: Mask
) -> None:
    """Replace rough signed distances (m) by those along the surface's normal, in space, where `near`.

    rough: the distances (...) and the outline's nearest points (...) of points `section` (..., 3), x, -z, y.
    A point that lies beside another part than that of its nearest point gets the end of that part's outline.
    """
    signed_length, nearest = rough
    flank, fillet = (np.flatnonzero(outline.part == PINION_PARTS.index(name)) for name in ("flank", "fillet"))
    # beside the tip of its own section a point belongs to the flank, wherever the middle section's tip ends
    angle, tip = np.arctan2(section[..., 0], section[..., 1]), PINION_PARTS.index("tip land")
    beside = near & (outline.part[nearest] == tip) & (angle > pinion.tip_half_angle(design, section[..., 2]))
    nearest[beside] = flank[0]
    part, taper = outline.part[nearest], np.cos(design.taper_angle)
    for name, radius in (("tip land", pinion.tip_radius), ("root land", pinion.root_radius)):
        rows = near & (part == PINION_PARTS.index(name))
        ground = section[rows]
        signed_length[rows] = (np.hypot(ground[:, 0], ground[:, 1]) - radius(design, ground[:, 2])) * taper
    rows = np.nonzero(near & ((nearest >= flank[0]) & (nearest <= fillet[-1])))
    feet = flank_feet(design, section[rows])
    gap, at = np.where(np.isfinite(feet.gap), feet.gap, np.inf), nearest[rows]
    at = np.where(np.isfinite(gap), np.minimum(at, flank[-1]), at)
    is_low = (nearest[rows] > flank[-1]) | (~np.isfinite(gap) & (nearest[rows] > flank[len(flank) // 2]))
    is_low &= (signed_length[rows] < REFINED_GAP * design.module) & ~(gap < -REFINED_GAP * design.module)
    low = np.flatnonzero(is_low)
    ground = section[rows][low]
    angles = np.linspace(design.transverse_pressure_angle, pi / 2, len(fillet))
    start = angles[np.maximum(nearest[rows][low] - fillet[0], 0)]
    apart, slope, y = fillet_feet(design, ground[:, [0, 2, 1]] * [1.0, 1.0, -1.0], start)
    apart = apart + pinion.removed_depth(design, pinion.junction_roll(design, y), y)
    on = (
        np.isfinite(apart) & (slope >= angles[0]) & (slope <= angles[-1]) & (np.abs(apart) < np.abs(gap[low]))
    )
    gap[low[on]], at[low[on]] = apart[on], np.maximum(nearest[rows][low[on]], fillet[0])
    on_land = np.isfinite(apart) & (slope > angles[-1]) & ~np.isfinite(gap[low])
    land = np.hypot(ground[:, 0], ground[:, 1]) - pinion.root_radius(design, ground[:, 2])
    gap[low[on_land]], at[low[on_land]] = land[on_land] * taper, fillet[-1] + 1
    is_found = np.isfinite(gap)
    signed_length[rows] = np.where(is_found, gap, signed_length[rows])
    nearest[rows] = np.where(is_found, at, nearest[rows])


TOOTH_NUMBERS = np.arange(-2.0, 3.0)
"""Numbers of the teeth that may come near each other."""


@dataclass(frozen=True)
class Gap:
    """A smallest gap between two parts of the teeth, negative where they interfere, and where it is.

    gap: shortest distance (m). approach: the turn of the gear that closes it, times
    `PairDesign.gear_normal_arm` (m), that is along the line of action, comparable with the transmission
    error. radius: gear radius (m); phi1 in rad.
    """

    gap: float
    approach: float
    pinion_part: str
    gear_part: str
    radius: float
    phi1: float
    side: str


def smallest_gaps(design: PairDesign, phi1: ArrayLike, phi2: ArrayLike) -> dict[tuple[str, str], Gap]:
    """Compute the smallest gap of each pair of parts over the placements, on both sides of the teeth.

    Pairs of parts that never come within half a module are left out.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : (p,) array_like
        Pinion angle, rad.
    phi2 : (p,) array_like
        Gear angle, rad.

    Returns
    -------
    dict[tuple[str, str], Gap]
        Smallest gap by (pinion part, gear part), names of PINION_PARTS and keys of `gear_points`.
    """
    phi1, phi2 = np.atleast_1d(np.asarray(phi1, float)), np.atleast_1d(np.asarray(phi2, float))
    gaps: dict[tuple[str, str], Gap] = {}
    for side, pair, sign in (("drive", design, 1.0), ("back", mirror_design(design), -1.0)):
        turns = sign * phi1, sign * phi2
        outline = pinion_outline(pair)
        for gear_part, points in gear_points(pair).items():
            section = to_pinion_section(pair, *turns, TOOTH_NUMBERS).points(points)
            distance, nearest = signed_distance(pair, outline, section, 0.5 * design.module)
            for number, pinion_part in enumerate(PINION_PARTS):
                part_distance = np.where(outline.part[nearest] == number, distance, np.inf)
                row, tooth, point = at = np.unravel_index(np.argmin(part_distance), part_distance.shape)
                key, gap = (pinion_part, gear_part), float(part_distance[at])
                if gap < (gaps[key].gap if key in gaps else np.inf):
                    spot = (points[[point]], turns[0][[row]], turns[1][[row]], TOOTH_NUMBERS[[tooth]])
                    lever = _lever(pair, spot, outline, nearest[at])
                    approach = gap * pair.gear_normal_arm / lever if lever else copysign(inf, gap)
                    radius = float(np.hypot(*points[point, :2]))
                    gaps[key] = Gap(gap, approach, *key, radius, float(phi1[row]), side)
    return gaps


def _lever(
    design: PairDesign, spot: tuple[Array, Array, Array, Array], outline: PinionOutline, nearest: int
) -> float:
    """Return the way along the pinion's normal of a gear point per turn of the gear, m/rad.

    `spot`: the point (1, 3) in the gear's body frame, m, phi1 (1,), phi2 (1,), rad, and tooth number (1,).
    `nearest`: index of the outline's nearest point.
    """
    points, phi1, phi2, teeth = spot
    step = 1e-6
    after, before = (
        to_pinion_section(design, phi1, phi2 + turn, teeth).points(points) for turn in (step, -step)
    )
    if is_prismatic(design):
        return float((after - before).ravel()[:2] @ outline.normals[nearest]) / (2 * step)
    reach = 0.5 * design.module
    gaps = (signed_distance(design, outline, section, reach)[0] for section in (after, before))
    lever = float(next(gaps).ravel()[0] - next(gaps).ravel()[0]) / (2 * step)
    return lever if isfinite(lever) else 0.0


def gear_points(design: PairDesign) -> dict[str, Array]:
    """Return points of the gear's left side, as made, in the body frame of its tooth 0.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    dict of (n, 3) arrays
        Points, m, by part: `tip edge`, `flank`, `fillet` and `root land`.
    """
    face = design.face_gear
    radius = np.linspace(face.inner_radius, face.outer_radius, 27)[None, :]
    top, psi = face_gear.tip_parameters(design, radius)
    end, _ = face_gear.end_parameters(design, radius)
    roll = top + np.linspace(0, 1, 12)[1:, None] * (end - top)
    slopes = face_gear_fillet.fillet_slopes(design, radius, np.linspace(0, 1, 12)[:, None])
    middle = face_gear_fillet.root_land_middle(design, radius[0])
    half_land = face_gear_fillet.root_half_angle(design, radius[0])
    land = np.linspace(middle - half_land, middle, 4)
    points = {
        "tip edge": flank_as_made(design, top, psi),
        "flank": flank_as_made(design, roll, face_gear.psi_at(design, radius, roll)),
        "fillet": fillet_as_made(design, radius, slopes),
        "root land": face_gear.cylindrical(radius, land, face_gear_fillet.root_height(design, radius)),
    }
    return {name: part.reshape(-1, 3) * [-1, 1, 1] for name, part in points.items()}
