"""Smallest gap between the whole teeth over a pitch, fillets, tips and lands included: finds interference.

Points of the gear's tooth (tip edge, flank, fillet, root land) are brought into the pinion's section, and the
signed distance to the tooth outline is taken; negative means that the gear stands inside the pinion.
"""

from dataclasses import dataclass
from math import copysign, inf, pi

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.geometry import face_gear
from facegear.geometry.design import PairDesign
from facegear.geometry.gear_modifications import fillet_as_made, flank_as_made
from facegear.geometry.outline import PINION_PARTS, pinion_outline, signed_distance
from facegear.geometry.placement import mirror_design, to_pinion_section

TOOTH_NUMBERS = np.arange(-2.0, 3.0)


@dataclass(frozen=True)
class Gap:
    """A smallest gap between two parts of the teeth, negative where they interfere, and where it is.

    gap: shortest distance (m). approach: the turn of the gear that closes it, times r_b2 (m), that is along
    the line of action, comparable with the transmission error. radius: gear radius (m); phi1 in rad.
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
        Gap by (pinion part, gear part).
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
                    lever = _lever(pair, spot, outline.normals[nearest[at]])
                    approach = gap * design.gear_base_radius / lever if lever else copysign(inf, gap)
                    radius = float(np.hypot(*points[point, :2]))
                    gaps[key] = Gap(gap, approach, *key, radius, float(phi1[row]), side)
    return gaps


def _lever(design: PairDesign, spot: tuple[Array, Array, Array, Array], normal: Array) -> float:
    """Change of the distance along `normal` per turn of the gear (m/rad)."""
    points, phi1, phi2, teeth = spot
    step = 1e-6
    after, before = (
        to_pinion_section(design, phi1, phi2 + turn, teeth).points(points) for turn in (step, -step)
    )
    return float((after - before).ravel()[:2] @ normal) / (2 * step)


def gear_points(design: PairDesign) -> dict[str, Array]:
    """Return points of the gear's left side in the body frame of its tooth 0.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    dict of (n, 3) arrays
        Points by part, m.
    """
    face = design.face_gear
    radius = np.linspace(face.inner_radius, face.outer_radius, 27)[None, :]
    top, psi = face_gear.roll_and_psi_at_height(design, radius, design.gear_tip_plane)
    roll = top + np.linspace(0, 1, 12)[1:, None] * (design.shaper_tip_roll - top)
    slopes = face_gear.fillet_slopes(design, radius, np.linspace(0, 1, 12)[:, None])
    half_pitch = pi / face.teeth
    land = np.linspace(half_pitch - face_gear.root_half_angle(design), half_pitch, 4)[:, None]
    points = {
        "tip edge": flank_as_made(design, top, psi),
        "flank": flank_as_made(design, roll, face_gear.psi_at(design, radius, roll)),
        "fillet": fillet_as_made(design, radius, slopes),
        "root land": face_gear.cylindrical(radius, land, design.gear_root_plane),
    }
    return {name: part.reshape(-1, 3) * [-1, 1, 1] for name, part in points.items()}
