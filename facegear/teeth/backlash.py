"""Backlash of a pair as assembled, before anything is meshed."""

from functools import lru_cache

import numpy as np

from facegear.teeth.conjugate import exact_contact
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.placement import mirror_design, pinion_angle

POSITIONS = 4
"""Number of positions of a pitch at which backlash is searched; without assembly errors it is constant."""


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
    """Return the smallest play, m, of the drive and back flank over a pitch, by a search over the flanks."""
    # Imported here: a start reads configs, most of them without the errors that need compiled geometry.
    from facegear.teeth.unloaded_contact import unloaded_motion

    positions = (np.arange(POSITIONS) + 0.5) / POSITIONS
    phi1 = pinion_angle(design, positions)
    if beside:
        unloaded_motion(design, pinion_angle(design, np.union1d(positions, beside)))
    drive, _ = unloaded_motion(design, phi1)
    back = drive if design == mirror_design(design) else unloaded_motion(mirror_design(design), phi1)[0]
    return float(((-back[::-1] - drive) * design.gear_base_radius).min())
