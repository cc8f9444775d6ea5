"""How far the gear can turn between both sides of the teeth, fillets, tips and lands included."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.geometry.analysis import PairAnalysis
from facegear.geometry.clearance import TOOTH_NUMBERS, gear_points
from facegear.geometry.design import PairDesign
from facegear.geometry.outline import pinion_outline, signed_distance
from facegear.geometry.placement import mirror_design, to_pinion_section
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
    """Find where over a pitch the least room is left, if none is; to first order in the depth of
    interference.

    The gear may turn from where drive flanks touch to where back flanks touch, by the backlash; parts that
    reach into the other gear there take the turn that clears them from it, on both sides.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    analysis : PairAnalysis
        Its geometry.

    Returns
    -------
    Jam, optional
        Depth, m, and pinion angle, rad; None where the bodies do not jam.
    """
    if analysis.interference is None:
        return None
    drive, back = analysis.drive, analysis.back
    back_turn = turn_to_clear(mirror_design(design), back)[::-1]
    free_turn = analysis.backlash - turn_to_clear(design, drive) - back_turn
    worst = int(np.argmin(free_turn))
    return Jam(-float(free_turn[worst]), float(drive.phi1[worst])) if free_turn[worst] < 0 else None


def turn_to_clear(design: PairDesign, contact: UnloadedContact) -> Array:
    """Compute the turn of the gear that takes its drive side out of the pinion where the drive flanks touch.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    contact : UnloadedContact
        Unloaded contact at p angles.

    Returns
    -------
    (p,) array
        Turn times r_b2, m; 0 where nothing interferes, inf where a part has to move across the turn.
    """
    outline, largest_turn = pinion_outline(design), np.zeros(len(contact.phi1))
    for points in gear_points(design).values():
        section, after = (
            to_pinion_section(design, contact.phi1, contact.phi2 + turn, TOOTH_NUMBERS).points(points)
            for turn in (0.0, TURN)
        )
        distance, nearest = signed_distance(design, outline, section, 0.5 * design.module)
        displacement = np.sum((after - section)[..., :2] * outline.normals[nearest], axis=-1)
        lever = displacement / (TURN * design.gear_base_radius)
        turn = np.where(lever > FREES, -distance / np.maximum(lever, FREES), np.inf)
        turn = np.where(distance < -TOUCH, turn, 0.0)
        largest_turn = np.maximum(largest_turn, turn.max(axis=(1, 2)))
    return largest_turn
