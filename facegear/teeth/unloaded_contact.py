"""Unloaded contact of the pair: where the flanks touch, transmission error, backlash, other pairs' gaps."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array, Integers
from facegear.errors import NotConverged
from facegear.teeth.closest import PAIRS, closest
from facegear.teeth.conjugate import exact_contact
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.family_contact import NOMINAL, contact_line
from facegear.teeth.placement import conjugate_angle, mirror_design, pinion_angle
from facegear.teeth.tooth_family import ToothFamily

TOLERANCE = 1e-11
"""Largest gap (m) left where the flanks touch."""
FOLLOWED_MARGIN = 5e-6
"""Distance (m) above the smallest gap up to which the gap of another pair is followed, as a turn may close
it."""
ROUGH, UNEVEN = 1e-7, 0.2
"""Error (m) of gaps after the first grids, and the fraction of a turn by which it may close pairs
differently."""
MAX_TURNS = 100
"""Turns of the gear; where an edge touches each may leave half of the gap."""


@dataclass(frozen=True)
class UnloadedContact:
    """Flank contact at p pinion angles.

    Attributes
    ----------
    phi1, phi2
        (p,) rad.
    transmission_error
        (p,) m, (phi2 - phi1 N1 / N2) times `PairDesign.gear_normal_arm`, along the line of action.
    tooth
        (p,) number of the touching pair.
    gap, roll, y
        (p, 5) for the pairs -2..2 the smallest separation (m) and where it is on the pinion (rad, m); inf and
        nan where a pair does not face each other.
    """

    phi1: Array
    phi2: Array
    transmission_error: Array
    tooth: Integers
    gap: Array
    roll: Array
    y: Array

    @property
    def path(self) -> tuple[Array, Array]:
        """Roll angle (rad) and y (m), on the pinion, of the touching point of pair `tooth`, (p,)."""
        rows = np.arange(len(self.phi1))
        column = np.searchsorted(PAIRS, self.tooth)
        return self.roll[rows, column], self.y[rows, column]


def unloaded_contact(design: PairDesign, phi1: ArrayLike) -> UnloadedContact:
    """Turn the gear against the drive side of the pinion until the flanks just touch, for every pinion angle.

    Flanks touch flanks only, edges of both included; fillets and tips are the subject of `clearance`. The
    result is in closed form where `facegear.teeth.conjugate` has one, else by search.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : (p,) array_like
        Pinion angle, rad.

    Returns
    -------
    UnloadedContact
        Gear angle, transmission error, touching pair, and gaps of all pairs at p angles, in m and rad.

    Raises
    ------
    NotConverged
        Where no pair of flanks faces each other or the touch is not found to TOLERANCE.
    """
    exact = exact_contact(design)
    if exact is None:
        return searched_contact(design, phi1)
    phi1 = np.atleast_1d(np.asarray(phi1, float))
    phi2, error = unloaded_motion(design, phi1)
    nearest = closest(design, phi1, phi2)
    is_facing = np.isfinite(nearest.gap)
    roll, y = (np.where(is_facing, part, np.nan) for part in (nearest.roll, nearest.y))
    rows, column = np.arange(phi1.size), np.argmin(nearest.gap, axis=1)
    turn = phi1 + 2 * np.pi / design.pinion.teeth * PAIRS[column]
    roll_and_y = exact.pinion_place(design.family.pinion_flanks[0], turn)
    roll[rows, column], y[rows, column] = roll_and_y
    return UnloadedContact(phi1, phi2, error, PAIRS[column], nearest.gap, roll, y)


def unloaded_motion(design: PairDesign, phi1: ArrayLike) -> tuple[Array, Array]:
    """Compute gear angle and transmission error of `unloaded_contact` alone, in closed form where there
    is one.

    Results of a search are kept for later calls.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : (p,) array_like
        Pinion angle, rad.

    Returns
    -------
    tuple of (p,) arrays
        phi2, rad, and transmission error, m.

    Raises
    ------
    NotConverged
        As `unloaded_contact` does.
    """
    exact = exact_contact(design)
    if exact is None:
        motion_by_angle, angles = _searched_motion(design), np.atleast_1d(np.asarray(phi1, float)).tolist()
        if new := [angle for angle in angles if angle not in motion_by_angle]:
            contact = searched_contact(design, new, every_pair=False)
            motion = zip(contact.phi2.tolist(), contact.transmission_error.tolist(), strict=True)
            motion_by_angle.update(zip(new, motion, strict=True))
        phi2, error = np.array([motion_by_angle[angle] for angle in angles]).T
        return phi2, error
    conjugate = np.atleast_1d(conjugate_angle(design, phi1))
    error = np.full(conjugate.size, exact.transmission_error)
    return conjugate + error / design.gear_normal_arm, error


@lru_cache(maxsize=16)
def _searched_motion(design: PairDesign) -> dict[float, tuple[float, float]]:
    """Return the design's one dictionary of earlier searches, empty at first, which `unloaded_motion` fills:
    phi2 (rad) and transmission error (m) by phi1 (rad).
    """
    return {}


def searched_contact(design: PairDesign, phi1: ArrayLike, every_pair: bool = True) -> UnloadedContact:
    """Compute `unloaded_contact` by search, for flanks of any kind and edges.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : (p,) array_like
        Pinion angle, rad.
    every_pair : bool
        If False, gaps of pairs that cannot touch come from the first grids alone.

    Returns
    -------
    UnloadedContact
        Contact at p angles, in m and rad.

    Raises
    ------
    NotConverged
        As `unloaded_contact` does.
    """
    phi1 = np.atleast_1d(np.asarray(phi1, float))
    conjugate = conjugate_angle(design, phi1)
    initial_error = _first_error(design)
    phi2 = conjugate + initial_error / design.gear_normal_arm
    nearest = closest(design, phi1, phi2, margin=np.inf if every_pair else FOLLOWED_MARGIN)
    unfollowed_turn = np.zeros(len(phi1))
    for _ in range(MAX_TURNS):
        smallest = nearest.gap.min(axis=1)
        if not np.all(np.isfinite(smallest)):
            place_text = f"phi1 = {phi1[~np.isfinite(smallest)][0]:.6f} rad"
            raise NotConverged("unloaded contact", place_text, "tooth pairs -2..2: no flanks face each other")
        if np.max(np.abs(smallest)) < TOLERANCE and np.max(np.abs(unfollowed_turn)) > 1e-6:
            # only pairs about to touch were followed: look at all of them where the gear stands now
            margin = np.inf if every_pair else FOLLOWED_MARGIN + float(np.max(np.abs(unfollowed_turn)))
            nearest, unfollowed_turn = closest(design, phi1, phi2, nearest, margin), np.zeros(len(phi1))
            smallest = nearest.gap.min(axis=1)
        if np.max(np.abs(smallest)) < TOLERANCE:
            is_facing = np.isfinite(nearest.gap)
            phi2 = phi2 - smallest / design.gear_normal_arm
            return UnloadedContact(
                phi1=phi1,
                phi2=phi2,
                transmission_error=(phi2 - conjugate) * design.gear_normal_arm,
                tooth=PAIRS[np.argmin(nearest.gap, axis=1)],
                gap=nearest.gap - smallest[:, None],
                roll=np.where(is_facing, nearest.roll, np.nan),
                y=np.where(is_facing, nearest.y, np.nan),
            )
        phi2 = phi2 - smallest / design.gear_normal_arm
        # the turn opens or closes all pairs alike, those not followed too
        last_closest = replace(nearest, gap=nearest.gap - smallest[:, None])
        margin = FOLLOWED_MARGIN if every_pair else ROUGH + UNEVEN * float(np.max(np.abs(smallest)))
        nearest, unfollowed_turn = (
            closest(design, phi1, phi2, last_closest, margin),
            unfollowed_turn + smallest,
        )
    residual = np.max(np.abs(nearest.gap.min(axis=1)))
    raise NotConverged("unloaded contact", f"residual gap {residual:.1e} m", f"{MAX_TURNS} turns of the gear")


def _first_error(design: PairDesign) -> float:
    """Return the transmission error (m) of the nominal normal that assembly errors and thinning leave, to
    first order.
    """
    errors, flank = design.assembly, design.family.pinion_flanks[0]
    across, upright = flank.cosine * np.cos(flank.pressure_angle), flank.cosine * np.sin(flank.pressure_angle)
    motion = design.family.motion
    vertical = -flank.sine * motion.cosine - upright * motion.sine
    along = flank.sine * errors.pinion_axial
    return float(errors.offset * across + errors.gear_axial * vertical + along - design.pinion.thinning / 2)


POSITIONS = 4
"""Number of positions of a pitch at which backlash is searched; without assembly errors it is constant."""


@lru_cache(maxsize=256)
def normal_backlash(design: PairDesign, beside: tuple[float, ...] = ()) -> float:
    """Compute the backlash of the assembled pair along the drive flank's normal, smallest of a few positions
    of a pitch.

    It is the turn that the gear has from drive to back flank, times `PairDesign.gear_normal_arm`. Without
    assembly errors and deviations that of symmetric teeth is the thinning of the pinion's teeth.

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
        Play between drive and back flank along the line of action, m; negative where the pair jams.

    Raises
    ------
    NotConverged
        Where the flanks do not face each other.
    """
    is_nominal = design.assembly == NOMINAL and design.is_symmetric
    if is_nominal and not (design.deviates or design.with_swapped_flanks.deviates):
        return design.pinion.thinning
    back_pair = mirror_design(design)
    drive, back = exact_contact(design), exact_contact(back_pair)
    if drive is not None and back is not None:
        arms = design.gear_normal_arm, back_pair.gear_normal_arm
        if arms[0] == arms[1]:
            return -back.transmission_error - drive.transmission_error
        return -back.transmission_error / arms[1] * arms[0] - drive.transmission_error
    return _search_backlash(design, beside)


def _search_backlash(design: PairDesign, beside: tuple[float, ...]) -> float:
    """Return the smallest backlash (m) over POSITIONS of a pitch, by `unloaded_motion` of drive and back
    flanks.
    """
    positions = (np.arange(POSITIONS) + 0.5) / POSITIONS
    phi1 = pinion_angle(design, positions)
    if beside:
        unloaded_motion(design, pinion_angle(design, np.union1d(positions, beside)))
    drive, _ = unloaded_motion(design, phi1)
    back = drive if design == mirror_design(design) else unloaded_motion(mirror_design(design), phi1)[0]
    return float(((-back[::-1] - drive) * design.gear_normal_arm).min())


def gear_backlash(family: ToothFamily, errors: AssemblyErrors = NOMINAL) -> float | None:
    """Compute the backlash of the unmodified flanks in an assembly, in closed form; edges are left out.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    errors : AssemblyErrors
        Errors of assembly; none by default.

    Returns
    -------
    float, optional
        Arc of the gear at its pitch radius, m; None where a flank has no contact line.
    """
    angles = []
    for side in (-1, 1):
        line = contact_line(family, side, errors)
        if line is None:
            return None
        angles.append(line.transmission_error * family.motion.ratio / line.base_pitch)
    return (angles[0] - angles[1]) * family.gear_pitch_radius
