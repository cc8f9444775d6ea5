"""The pair that each flank of each face gear is part of: its assembly errors, of a pinion displaced as the
config says, and its deviations.

The errors of a design are those that the upper gear's drive flank meets. The lower gear sees the same pinion
turned half round its axis: its offset and its tilt change sign, while a shift of a gear leads away from the
pinion on either side. The back flank is the drive flank of the pair in a mirror, whose offset changes sign;
what drives, turned half round, is the pinion's right flank again.
"""

from dataclasses import replace

import numpy as np

from facegear.arrays import Integers
from facegear.geometry.design import AssemblyErrors, PairDesign

GEARS = ("upper", "lower")
FLANKS = ("drive", "back")


def errors_at(errors: AssemblyErrors, gear: str, flank: str) -> AssemblyErrors:
    """Return the errors at a flank, as those of a drive flank.

    Parameters
    ----------
    errors : AssemblyErrors
        Errors at the upper gear's drive flank.
    gear : str
        `upper` or `lower`.
    flank : str
        `drive` or `back`.

    Returns
    -------
    AssemblyErrors
        Errors of the flank.
    """
    side = 1.0 if gear == "upper" else -1.0
    mirror = 1.0 if flank == "drive" else -1.0
    return replace(
        errors,
        offset=side * mirror * errors.offset,
        shaft_angle_error=side * errors.shaft_angle_error,
    )


def pair_at(design: PairDesign, gear: str, flank: str) -> PairDesign:
    """Return the pair whose drive flank is a flank of the upper or lower gear.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gear : str
        `upper` or `lower`.
    flank : str
        `drive` or `back`.

    Returns
    -------
    PairDesign
        The pair.
    """
    drive_design = design if flank == "drive" else design.with_swapped_flanks
    return replace(drive_design, assembly=errors_at(design.assembly, gear, flank))


def distinct_pairs(design: PairDesign) -> tuple[list[PairDesign], Integers]:
    """Return the different pairs of all flanks, the design first.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    tuple
        The pairs, and the number of each flank's pair, (gears, flanks).
    """
    pairs = [pair_at(design, gear, flank) for gear in GEARS for flank in FLANKS]
    different = list(dict.fromkeys(pairs))
    return different, np.array([different.index(pair) for pair in pairs]).reshape(len(GEARS), len(FLANKS))
