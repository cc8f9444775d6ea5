"""Analysis of a pair: limits, contact path on both flanks, backlash, smallest gaps and jamming."""

from dataclasses import dataclass, replace
from math import isfinite, pi, sin, tan

import numpy as np

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.teeth import face_gear, pinion
from facegear.teeth.bounded_contact import ContactPath, contact_path
from facegear.teeth.clearance import (
    TOOTH_NUMBERS,
    Gap,
    gear_points,
    pinion_outline,
    signed_distance,
    smallest_gaps,
)
from facegear.teeth.curvature import relative_curvatures
from facegear.teeth.design import PairDesign
from facegear.teeth.family_contact import contact_line
from facegear.teeth.limits import RadiusLimits
from facegear.teeth.opposite import is_prismatic
from facegear.teeth.placement import conjugate_angle, mirror_design, pinion_angle, to_pinion_section
from facegear.teeth.unloaded_contact import UnloadedContact, unloaded_contact
from facegear.teeth.validate import check

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
    backlash = (-back.phi2[::-1] - drive.phi2) * design.gear_normal_arm
    gaps = _gaps_of_both(design, drive, back)
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


def _gaps_of_both(
    design: PairDesign, drive: UnloadedContact, back: UnloadedContact
) -> dict[tuple[str, str], Gap]:
    """Return smallest gaps by (pinion part, gear part) where the drive flanks touch, and of teeth whose coast
    flanks are others also where those touch.
    """
    gaps = _refined_gaps(design, drive)
    if design.is_symmetric:
        return gaps
    names = {"drive": "back", "back": "drive"}
    for key, gap in _refined_gaps(mirror_design(design), back).items():
        if key not in gaps or gap.gap < gaps[key].gap:
            gaps[key] = replace(gap, side=names[gap.side], phi1=-gap.phi1)
    return gaps


def _refined_gaps(design: PairDesign, drive: UnloadedContact) -> dict[tuple[str, str], Gap]:
    """Return smallest gaps by (pinion part, gear part) at the positions of `drive` and at 17 finer ones
    around that with the smallest gap of parts that ought not to touch.
    """
    gaps = smallest_gaps(design, drive.phi1, drive.phi2)
    irregular_gaps = [gap for parts, gap in gaps.items() if parts not in REGULAR_CONTACTS]
    worst = min(irregular_gaps, key=lambda gap: gap.gap).phi1
    step = drive.phi1[1] - drive.phi1[0]
    phi1 = worst + np.linspace(-step, step, 17)
    error = np.interp(phi1, drive.phi1, drive.transmission_error, period=2 * pi / design.pinion.teeth)
    phi2 = conjugate_angle(design, phi1) + error / design.gear_normal_arm
    finer = smallest_gaps(design, phi1, phi2)
    return {key: min(gap, finer.get(key, gap), key=lambda g: g.gap) for key, gap in gaps.items()}


def section_contact_ratio(design: PairDesign) -> float:
    """Compute the unloaded contact ratio of the nominal assembly.

    From the gear's tip (or where the pinion's involute begins) to the pinion's tip (or where the gear's
    flank ends), over the base pitch. Of spur teeth it is that of the section at m N2 / 2, where the local
    pressure angle is the nominal one, and ends of the face do not count; of other teeth that of the contact
    path within both faces, which moves along them.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        Contact ratio, dimensionless; negative where the path misses a flank.

    Raises
    ------
    NotConverged
        Where the flanks have no line of contact.
    """
    return transverse_contact_ratio(design) if design.is_spur else nominal_path(design).contact_ratio


def transverse_contact_ratio(design: PairDesign) -> float:
    """Compute the contact ratio in the pinion's transverse section at the radius m_t N2 / 2, where the gear
    rolls on the pinion as a rack does: by that section's pressure angle, whatever the face.

    Parameters
    ----------
    design : PairDesign
        Pair of spur or helical gears whose axes cross at a right angle.

    Returns
    -------
    float
        Transverse contact ratio of the drive flanks, dimensionless.
    """
    start, end = _section_ends(design)
    return (start + end) / (2 * pi * design.pinion_base_radius / design.pinion.teeth)


def nominal_path(design: PairDesign) -> ContactPath:
    """Return the path of unloaded contact of the unmodified drive flanks in the nominal assembly.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    ContactPath
        The line of contact and its ends.

    Raises
    ------
    NotConverged
        Where the flanks have no line of contact.
    """
    line = contact_line(design.family, 1)
    if line is None:
        raise NotConverged("unloaded contact", "the nominal assembly", "a line of contact")
    return contact_path(design.family, line)


def _section_ends(design: PairDesign) -> tuple[float, float]:
    """Return lengths of contact (m) of a spur or helical pair before and after the pitch point, in its
    transverse section there.
    """
    angle, base = design.transverse_pressure_angle, design.pinion_base_radius
    shaper_tip = design.shaper_base_radius * design.shaper_tip_roll * design.family.shaper_flanks[0].cosine
    tip = min(base * design.pinion_tip_roll, shaper_tip - design.shaper_lift * sin(angle))
    end = tip - base * tan(angle)
    junction = float(pinion.junction_roll(design, design.middle))
    return min(_rolling_depth(design) / sin(angle), base * (tan(angle) - junction)), end


def _rolling_depth(design: PairDesign) -> float:
    """Return by how much the gear's tip lies above the pinion's rolling line, m."""
    return float(face_gear.tip_height(design, design.gear_pitch_radius)) + design.pinion_pitch_radius


def path_curvatures(design: PairDesign) -> tuple[Array, Array, Array, Array]:
    """Compute relative curvatures at 33 points along the nominal path, see `relative_curvatures`.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    tuple of (33,) arrays
        Pinion roll, rad, larger and smaller curvature, 1/m, and slope of the contact line against the
        pinion's generator, rad.
    """
    if not design.is_spur:
        path = nominal_path(design)
        s = np.linspace(path.first, path.last, 33)
        length = path.line.helicoid.cosine * (s + path.line.pinion_lead)
        return length / design.pinion_base_radius, *path.line.curvatures(s)
    angle, base = design.pressure_angle, design.pinion_base_radius
    first = tan(angle) - _rolling_depth(design) / sin(angle) / base
    first = max(first, float(pinion.junction_roll(design, design.middle)))
    roll = np.linspace(first, design.pinion_tip_roll, 33)
    shaper_roll = (base * roll + design.shaper_lift * sin(angle)) / design.shaper_base_radius
    return roll, *relative_curvatures(design, shaper_roll, angle)


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
    """Find whether the bodies jam over a pitch, and where deepest; to first order in the depth of
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
    """Compute how far the gear must turn on from where drive flanks touch until its drive side is out of
    the pinion.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    contact : UnloadedContact
        Unloaded contact at p angles.

    Returns
    -------
    (p,) array
        Turn times `PairDesign.gear_normal_arm`, m, at least 0; 0 where nothing interferes, inf where a part
        has to move across the turn.
    """
    outline, largest_turn = pinion_outline(design), np.zeros(len(contact.phi1))
    for points in gear_points(design).values():
        section, after = (
            to_pinion_section(design, contact.phi1, contact.phi2 + turn, TOOTH_NUMBERS).points(points)
            for turn in (0.0, TURN)
        )
        distance, nearest = signed_distance(design, outline, section, 0.5 * design.module)
        if is_prismatic(design):
            displacement = np.sum((after - section)[..., :2] * outline.normals[nearest], axis=-1)
        else:
            reach = np.where(np.isfinite(distance), distance, 0.0)
            displacement = signed_distance(design, outline, after, 0.5 * design.module)[0] - reach
        is_deep = distance < -TOUCH  # elsewhere distances may be infinite
        lever = displacement[is_deep] / (TURN * design.gear_normal_arm)
        turn = np.zeros(distance.shape)
        turn[is_deep] = np.where(lever > FREES, -distance[is_deep] / np.maximum(lever, FREES), np.inf)
        largest_turn = np.maximum(largest_turn, turn.max(axis=(1, 2)))
    return largest_turn


def jam_in_words(analysis: PairAnalysis, stuck: Jam) -> str:
    """Say where and how deep bodies jam.

    Parameters
    ----------
    analysis : PairAnalysis
        Analysis of the pair, with an interference.
    stuck : Jam
        Least room over a pitch.

    Returns
    -------
    str
        Depth, um, gear radius, mm, and the parts that meet.
    """
    gap = analysis.interference
    assert gap is not None
    depth = f"by {1e6 * stuck.depth:.1f} um along the line of action"
    return (
        f"tooth_pair: the bodies jam {depth if isfinite(stuck.depth) else 'at every turn'}: at gear radius "
        f"{1e3 * gap.radius:.1f} mm the gear's {gap.gear_part} stands {-1e6 * gap.gap:.1f} um deep in the "
        f"pinion's {gap.pinion_part}, and the backlash leaves no room for that"
    )


def summary_in_words(analysis: PairAnalysis) -> str:
    """Say contact ratio, backlash and smallest gap.

    Parameters
    ----------
    analysis : PairAnalysis
        Analysis of the pair.

    Returns
    -------
    str
        The numbers, lengths in um.
    """
    gap = analysis.interference or analysis.smallest
    verdict = "interference" if analysis.interference else "smallest gap"
    return (
        f"contact ratio {analysis.contact_ratio:.3f}, backlash {1e6 * analysis.backlash.min():.1f} um, "
        f"{verdict} {1e6 * gap.gap:.1f} um (gear {gap.gear_part} against pinion {gap.pinion_part}, "
        f"gear radius {1e3 * gap.radius:.1f} mm)"
    )
