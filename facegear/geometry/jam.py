"""How far the gear can turn between both sides of the teeth, fillets, tips and lands included."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.geometry.analysis import PairAnalysis
from facegear.geometry.clearance import TOOTH_NUMBERS, gear_points
from facegear.geometry.design import PairDesign
from facegear.geometry.outline import pinion_outline, signed_distance
from facegear.geometry.placement import mirrored, to_pinion_section
from facegear.geometry.unloaded import UnloadedContact

TURN = 1e-6
"""Turn of the gear (rad) that levers are taken over."""
TOUCH = 1e-7
"""Depth (m) below which bodies touch."""
FREES = 0.05
"""Least sine between a turn and a surface by which turning takes a point out of the other gear."""


@dataclass(frozen=True)
class Jam:
    """Two bodies that cannot be where both sides' flanks allow: `depth` (m) along the line of action.

    It is infinite where no turn takes one body out of the other.
    """

    depth: float
    phi1: float


def jam(design: PairDesign, analysis: PairAnalysis) -> Jam | None:
    """Where over a pitch least room is left, if none is; to first order in the depth of interference.

    The gear may turn from where drive flanks touch to where back flanks touch, by the backlash; parts that
    reach into the other gear there take the turn that clears them from it, on both sides.
    """
    if analysis.interference is None:
        return None
    drive, back = analysis.drive, analysis.back
    other = turn_to_clear(mirrored(design), back)[::-1]
    room = analysis.backlash - turn_to_clear(design, drive) - other
    worst = int(np.argmin(room))
    return Jam(-float(room[worst]), float(drive.phi1[worst])) if room[worst] < 0 else None


def turn_to_clear(design: PairDesign, touching: UnloadedContact) -> Array:
    """Turn of the gear times r_b2 (m, shape (p,)) that takes its drive side out of the pinion where the drive
    flanks touch; 0 where nothing interferes, inf where a part has to move across the turn.
    """
    outline, needed = pinion_outline(design), np.zeros(len(touching.phi1))
    for points in gear_points(design).values():
        here, after = (
            to_pinion_section(design, touching.phi1, touching.phi2 + turn, TOOTH_NUMBERS).points(points)
            for turn in (0.0, TURN)
        )
        distance, nearest = signed_distance(design, outline, here, 0.5 * design.module)
        moved = np.sum((after - here)[..., :2] * outline.normals[nearest], axis=-1)
        lever = moved / (TURN * design.gear_base_radius)
        turn = np.where(lever > FREES, -distance / np.maximum(lever, FREES), np.inf)
        turn = np.where(distance < -TOUCH, turn, 0.0)
        needed = np.maximum(needed, turn.max(axis=(1, 2)))
    return needed
