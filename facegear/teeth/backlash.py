"""Backlash of a pair as assembled, before anything is meshed."""

from functools import lru_cache

import numpy as np

from facegear.teeth.conjugate import exact_contact
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.family_contact import PinionPose, contact_line
from facegear.teeth.placement import mirror_design, pinion_angle
from facegear.teeth.tooth_family import ToothFamily

POSITIONS = 4


@lru_cache(maxsize=256)
def normal_backlash(design: PairDesign, beside: tuple[float, ...] = ()) -> float:
    """Compute the backlash along the line of action, smallest of a few positions of a pitch.

    Without assembly errors and deviations it is the thinning of the pinion's teeth.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    beside : tuple[float, ...]
        Positions at which `unloaded_motion` of the pair will be needed, too, in pitches: one search finds
        both.

    Returns
    -------
    float
        m; negative where it jams.

    Raises
    ------
    NotConverged
        Where the flanks do not face each other.
    """
    if design.assembly == AssemblyErrors() and not (design.deviates or design.with_swapped_flanks.deviates):
        return design.pinion.thinning
    drive, back = exact_contact(design), exact_contact(mirror_design(design))
    if drive is not None and back is not None:
        return -back.transmission_error - drive.transmission_error
    return _search_backlash(design, beside)


def _search_backlash(design: PairDesign, beside: tuple[float, ...]) -> float:
    # Imported here: a start reads configs, most of them without the errors that need compiled geometry.
    from facegear.teeth.unloaded import unloaded_motion

    positions = (np.arange(POSITIONS) + 0.5) / POSITIONS
    phi1 = pinion_angle(design, positions)
    if beside:
        unloaded_motion(design, pinion_angle(design, np.union1d(positions, beside)))
    drive, _ = unloaded_motion(design, phi1)
    back = drive if design == mirror_design(design) else unloaded_motion(mirror_design(design), phi1)[0]
    return float(((-back[::-1] - drive) * design.gear_base_radius).min())


def gear_backlash(family: ToothFamily, pose: PinionPose | None = None) -> float | None:
    """Compute the backlash of the unmodified flanks in a pose.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    pose : PinionPose, optional
        Where the pinion stands; the nominal place if None.

    Returns
    -------
    float, optional
        Arc of the gear at its pitch radius, m; None where a flank has no contact line.
    """
    angles = []
    for side in (-1, 1):
        line = contact_line(family, side, pose)
        if line is None:
            return None
        angles.append(line.transmission_error * family.motion.ratio / line.base_pitch)
    return (angles[0] - angles[1]) * family.gear_pitch_radius
