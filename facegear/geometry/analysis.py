"""All geometry of a pair in one result: limits, contact path on both flanks, backlash, smallest gaps."""

from dataclasses import dataclass
from math import pi, sin, tan

import numpy as np

from facegear.arrays import Array
from facegear.geometry import pinion
from facegear.geometry.clearance import Gap, smallest_gaps
from facegear.geometry.curvature import relative_curvatures
from facegear.geometry.design import PairDesign
from facegear.geometry.limits import RadiusLimits
from facegear.geometry.placement import conjugate_angle, mirror_design, pinion_angle
from facegear.geometry.unloaded import UnloadedContact, unloaded_contact
from facegear.geometry.validate import check

REGULAR_CONTACTS = {("flank", "flank"), ("flank", "tip edge"), ("tip land", "flank")}
"""Pairs of parts (pinion, gear) that touch in regular contact: flanks, and flanks with tip edges."""


@dataclass(frozen=True)
class PairAnalysis:
    """drive, back: unloaded contact of both sides (angles of the back side are those of the mirrored pair).

    backlash: (p,) m along the line of action. gaps: smallest gap by (pinion part, gear part).
    interference: the deepest one, or None. smallest: the smallest gap between parts that ought not to touch.
    """

    limits: RadiusLimits
    contact_ratio: float
    drive: UnloadedContact
    back: UnloadedContact
    backlash: Array
    gaps: dict[tuple[str, str], Gap]
    interference: Gap | None
    smallest: Gap


def analyse(design: PairDesign, positions: int = 32, tolerance: float = 1e-7) -> PairAnalysis:
    """Analyse the pair at even angles of one pitch, centred on zero.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    positions : int
        Number of angles.
    tolerance : float
        Depth above which a part that reaches into the other gear counts as interference, m.

    Returns
    -------
    PairAnalysis
        All geometry, in m and rad.

    Raises
    ------
    GeometryError
        For a design that cannot exist.
    NotConverged
        Where contact is not found.
    """
    limits = check(design)
    phi1 = pinion_angle(design, (np.arange(positions) + 0.5) / positions)
    drive = unloaded_contact(design, phi1)
    back = drive if design == mirror_design(design) else unloaded_contact(mirror_design(design), phi1)
    # the back side of phi1 is the mirrored pair at -phi1: positions are symmetric, so it is the reversed list
    backlash = (-back.phi2[::-1] - drive.phi2) * design.gear_base_radius
    gaps = _refined_gaps(design, drive)
    deepest = min(gaps.values(), key=lambda gap: gap.gap)
    irregular_gaps = [gap for parts, gap in gaps.items() if parts not in REGULAR_CONTACTS]
    interference = deepest if deepest.gap < -tolerance else None
    return PairAnalysis(
        limits=limits,
        contact_ratio=section_contact_ratio(design),
        drive=drive,
        back=back,
        backlash=backlash,
        gaps=gaps,
        interference=interference,
        smallest=min(irregular_gaps, key=lambda gap: gap.gap),
    )


def _refined_gaps(design: PairDesign, drive: UnloadedContact) -> dict[tuple[str, str], Gap]:
    """Smallest gaps at the positions of `drive` and at finer ones around the most critical of them."""
    gaps = smallest_gaps(design, drive.phi1, drive.phi2)
    irregular_gaps = [gap for parts, gap in gaps.items() if parts not in REGULAR_CONTACTS]
    worst = min(irregular_gaps, key=lambda gap: gap.gap).phi1
    step = drive.phi1[1] - drive.phi1[0]
    phi1 = worst + np.linspace(-step, step, 17)
    error = np.interp(phi1, drive.phi1, drive.transmission_error, period=2 * pi / design.pinion.teeth)
    phi2 = conjugate_angle(design, phi1) + error / design.gear_base_radius
    finer = smallest_gaps(design, phi1, phi2)
    return {key: min(gap, finer.get(key, gap), key=lambda g: g.gap) for key, gap in gaps.items()}


def section_contact_ratio(design: PairDesign) -> float:
    """Compute the unloaded contact ratio of the nominal assembly in the section of the pitch point path.

    From the gear's tip (or where the pinion's involute begins) to the pinion's tip (or where the gear's
    flank ends), over the base pitch; the section at m N2 / 2 where the local pressure angle is the nominal
    one.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        Contact ratio, dimensionless.
    """
    angle, base = design.pressure_angle, design.pinion_base_radius
    tip = min(
        base * design.pinion_tip_roll,
        design.shaper_base_radius * design.shaper_tip_roll - design.shaper_lift * sin(angle),
    )
    end = tip - base * tan(angle)
    rolling = design.gear_tip_plane + design.pinion_pitch_radius
    start = min(rolling / sin(angle), base * (tan(angle) - pinion.junction_roll(design)))
    return (start + end) / (2 * pi * base / design.pinion.teeth)


def path_curvatures(design: PairDesign) -> tuple[Array, Array, Array, Array]:
    """Compute relative curvatures at 33 points along the nominal path, see `relative_curvatures`.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    tuple of (33,) arrays
        Pinion roll, rad, larger and smaller curvature, 1/m, and slope of the contact line, rad.
    """
    angle, base = design.pressure_angle, design.pinion_base_radius
    rolling = design.gear_tip_plane + design.pinion_pitch_radius
    first = max(tan(angle) - rolling / sin(angle) / base, pinion.junction_roll(design))
    roll = np.linspace(first, design.pinion_tip_roll, 33)
    shaper_roll = (base * roll + design.shaper_lift * sin(angle)) / design.shaper_base_radius
    return roll, *relative_curvatures(design, shaper_roll, angle)
