"""Teeth to start from: the highest ones without undercut or interference; spur ones can be rated."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import product
from math import atan, ceil, cos, radians, sin, tan
from typing import Any

import numpy as np

from facegear.errors import ConfigError, FacegearError, GeometryError, NotConverged
from facegear.new_machine.wishes import ToothWishes
from facegear.teeth.analysis import PairAnalysis, analyse, section_contact_ratio
from facegear.teeth.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.limits import face_range, radius_limits
from facegear.teeth.pitch_line import path_middles, pitch_line_radius, pitch_line_y
from facegear.teeth.placement import mirror_teeth
from facegear.teeth.validate import check, check_shaper

HEIGHTS = tuple(1.0 - 0.05 * step for step in range(11))
"""Addendum of the pinion in modules, tried from the full height of a standard tooth down to half of it."""
LOWER_GEAR_TIPS = (0.0, 0.1, 0.2)
"""Reductions of the gear's addendum below the pinion's, in modules, to clear the pinion's fillet."""
ROOT_CLEARANCES = (0.25, 0.35)
"""Dedendum of the pinion's rack beyond the addendum, in modules."""
RACK_TIPS = (0.2, 0.1)
"""Tip radius of the pinion's rack, in modules: larger ones make a rounder fillet."""
SHAPER_CLEARANCE = 0.25
"""Addendum of the shaper beyond that of the pinion, in modules."""
SHAPER_ROUNDING = 0.1
"""Tip rounding of the shaper, in modules: without one the gear's fillet has a corner and cannot be rated."""
MORE_SHAPER_TEETH = (3, 2, 1)
"""Teeth of the shaper beyond the pinion's, as preferred: more localise the contact, fewer spread it."""
SHIFT_STEP = 0.01
"""A profile shift is rounded up to a multiple of this many modules."""
THINNING = 0.04
"""Normal backlash in modules, within the usual 0.03 to 0.05."""
WIDEST = 8.0
"""Widest face that is chosen, in modules."""
NARROWEST = 2.0
"""Narrowest face that is chosen, in modules."""
FREE_ENDS = 0.1
"""Part of the allowed range of radii that the face leaves free at either end."""
SMALLEST_GAP = 0.003
"""Smallest gap beside the contact, in modules: some 10 um at 3 mm, what teeth give way under load."""
CONTACT_RATIO = 1.05
"""Smallest contact ratio of a pair that is chosen."""
POSITIONS = 16
"""Positions in a pitch at which gaps are looked for."""
PLACEMENTS = 3
"""Times that a face is placed: the place of the middle moves the limits of tapered teeth by some 1 % of the
face, which the second time makes negligible."""
MAX_ANALYSES = 40
"""Largest number of teeth whose gaps are computed, 0.2 s each."""


@dataclass(frozen=True)
class ChosenTeeth:
    """Teeth that mesh freely: the design, the radii (m) that limit its face, and its analysis."""

    design: PairDesign
    face_limits: tuple[float, float]
    analysis: PairAnalysis


@dataclass
class _Refusals:
    """Reasons for which candidates were refused, and how often each occurred."""

    counts: dict[str, int] = field(default_factory=dict)
    best_ratio: float = 0.0

    def add(self, reason: str) -> None:
        """Count one more candidate that was refused for this reason."""
        self.counts[reason] = self.counts.get(reason, 0) + 1

    @property
    def most_frequent(self) -> str:
        """Reason for which most candidates were refused."""
        return max(self.counts, key=lambda reason: self.counts[reason])


@lru_cache(maxsize=64)
def choose_teeth(wishes: ToothWishes, more_shaper_teeth: int = MORE_SHAPER_TEETH[0]) -> ChosenTeeth:
    """Return the highest teeth without undercut and interference that meet all wishes.

    Candidates are tried from standard height downwards. Of each height, teeth with the gear's tips
    lowered and with deeper pinion roots follow. The profile shift is the smallest one without undercut.
    The first candidate is taken whose contact ratio is at least CONTACT_RATIO and whose smallest gap
    beside the contact is at least SMALLEST_GAP modules. The search ends after MAX_ANALYSES analyses of
    gaps.

    Parameters
    ----------
    wishes : ToothWishes
        Values that a user gave; None leaves a choice.
    more_shaper_teeth : int
        Teeth of the shaper beyond those of the pinion, where the wishes have no number of shaper teeth.

    Returns
    -------
    ChosenTeeth
        Design of the pair, radii (m) between which its face may lie, and its analysis.

    Raises
    ------
    ConfigError
        For tooth numbers, module or pressure angle that no pair can have; where no candidate meets the
        wishes, with the reason that refused most candidates.
    """
    _require_numbers(wishes)
    refusals = _Refusals()
    analyses = 0
    for candidate in _candidates(wishes, more_shaper_teeth):
        try:
            design, face_limits = _place_face(candidate, wishes)
        except GeometryError as error:
            refusals.add(str(error))
            continue
        ratio = _contact_ratio(design)
        refusals.best_ratio = max(refusals.best_ratio, ratio)
        if ratio < CONTACT_RATIO:
            refusals.add("contact ratio")
            continue
        analyses += 1
        try:
            analysis = analyse(design, POSITIONS)
        except (GeometryError, NotConverged) as error:
            refusals.add(str(error))
            continue
        smallest = (analysis.interference or analysis.smallest).gap
        if smallest >= SMALLEST_GAP * design.module:
            return ChosenTeeth(design, face_limits, analysis)
        refusals.add("gap")
        if analyses == MAX_ANALYSES:
            break
    raise _no_teeth(wishes, refusals)


def _no_teeth(wishes: ToothWishes, refusals: _Refusals) -> FacegearError:
    """Return the error for wishes that no candidate meets, with a reason.

    The reason is interference if any candidate had it, else too small a contact ratio, else the most
    frequent one.
    """
    if "gap" in refusals.counts:
        reason = "the teeth of every candidate interfere; a larger pressure angle or more pinion teeth help"
    elif "contact ratio" in refusals.counts:
        reason = (
            f"the contact ratio is {refusals.best_ratio:.2f} at most, below {CONTACT_RATIO}; "
            "more pinion teeth or a smaller pressure angle help"
        )
    else:
        reason = refusals.most_frequent
    return FacegearError(
        f"no teeth for {wishes.pinion_teeth}/{wishes.face_gear_teeth} at {wishes.pressure_angle_deg:g} deg "
        f"with these wishes: {reason}"
    )


def _require_numbers(wishes: ToothWishes) -> None:
    """Raise ConfigError for tooth numbers, module or pressure angle out of range."""
    if not 5 <= wishes.pinion_teeth <= 500:
        raise ConfigError("pinion_teeth", wishes.pinion_teeth, "from 5 to 500")
    if not wishes.pinion_teeth < wishes.face_gear_teeth <= 2000:
        requirement = f"more than the pinion's {wishes.pinion_teeth}, at most 2000"
        raise ConfigError("face_gear_teeth", wishes.face_gear_teeth, requirement)
    if not 0.1 <= wishes.module_mm <= 100.0:
        raise ConfigError("module_mm", wishes.module_mm, "from 0.1 to 100")
    if not 10.0 <= wishes.pressure_angle_deg <= 40.0:
        raise ConfigError("pressure_angle_deg", wishes.pressure_angle_deg, "from 10 to 40")


def _contact_ratio(design: PairDesign) -> float:
    """Return the contact ratio of the flank that has the smaller one."""
    pairs = {design, mirror_teeth(design)}
    return min(section_contact_ratio(pair) for pair in pairs)


def _candidates(wishes: ToothWishes, more_shaper_teeth: int) -> Iterator[PairDesign]:
    """Yield designs of the teeth in the order in which they are tried, the highest teeth first.

    Each wish that is given takes the place of the choices. Widths and radii of the face are placeholders
    of one module, which `_place_face` replaces.
    """
    module = 1e-3 * wishes.module_mm
    thinning = THINNING * module if wishes.thinning_um is None else 1e-6 * wishes.thinning_um
    heights = _one_or(wishes.pinion_addendum_modules, HEIGHTS)
    coast = wishes.coast_pressure_angle_deg
    for height, clearance, rack_tip, lower in product(heights, ROOT_CLEARANCES, RACK_TIPS, LOWER_GEAR_TIPS):
        dedendum = _given_or(wishes.pinion_dedendum_modules, height + clearance)
        rack_tip = _given_or(wishes.rack_tip_radius_modules, rack_tip)
        shift = _given_or(wishes.profile_shift_modules, _smallest_shift(wishes, dedendum, rack_tip))
        pinion = PinionGeometry(
            teeth=wishes.pinion_teeth,
            width=module,
            addendum=module * height,
            dedendum=module * dedendum,
            rack_tip_radius=module * rack_tip,
            bore_radius=1e-3 * module,
            profile_shift=module * shift,
            thinning=thinning,
        )
        gear = FaceGearGeometry(
            teeth=wishes.face_gear_teeth,
            inner_radius=module,
            outer_radius=module,
            addendum=module * _given_or(wishes.gear_addendum_modules, height - lower),
            rim_thickness=3.0 * module,
        )
        shaper = Shaper(
            wishes.shaper_teeth or wishes.pinion_teeth + more_shaper_teeth,
            module * _given_or(wishes.shaper_addendum_modules, height + SHAPER_CLEARANCE),
            module * _given_or(wishes.shaper_tip_rounding_modules, SHAPER_ROUNDING),
        )
        yield PairDesign(
            module,
            radians(wishes.pressure_angle_deg),
            pinion,
            gear,
            shaper,
            helix_angle=radians(wishes.helix_angle_deg),
            taper_angle=radians(wishes.taper_angle_deg),
            shaft_angle=radians(wishes.shaft_angle_deg),
            offset=1e-3 * wishes.offset_mm,
            coast_pressure_angle=None if coast in (None, wishes.pressure_angle_deg) else radians(coast),
        )


def is_spur(wishes: ToothWishes) -> bool:
    """Whether the wished teeth are spur teeth with equal flanks, at 90 degrees and without offset.

    Parameters
    ----------
    wishes : ToothWishes
        Values that a user gave.

    Returns
    -------
    bool
        True if so.
    """
    angles = (wishes.helix_angle_deg, wishes.taper_angle_deg, wishes.offset_mm)
    has_equal_flanks = wishes.coast_pressure_angle_deg in (None, wishes.pressure_angle_deg)
    return angles == (0.0, 0.0, 0.0) and wishes.shaft_angle_deg == 90.0 and has_equal_flanks


def _smallest_shift(wishes: ToothWishes, dedendum: float, rack_tip: float) -> float:
    """Return the smallest profile shift, not below 0, at which the rack undercuts no flank of the pinion.

    Shift, `dedendum` and tip radius `rack_tip` of the rack are in modules; the shift is rounded up to
    SHIFT_STEP. That of tapered teeth holds at the thinner end of the widest face.
    """
    helix, taper = radians(wishes.helix_angle_deg), radians(wishes.taper_angle_deg)
    radius = 0.5 * wishes.pinion_teeth / cos(helix)
    thinner_end = (0.5 * WIDEST + 1.0) * abs(tan(taper))
    least = []
    for side, angle_deg in (
        (1, wishes.pressure_angle_deg),
        (-1, wishes.coast_pressure_angle_deg or wishes.pressure_angle_deg),
    ):
        angle = radians(angle_deg)
        transverse = atan(tan(angle) * cos(taper) / cos(helix) + side * tan(helix) * sin(taper))
        sharp = dedendum - rack_tip * (1.0 - sin(angle)) / cos(taper)
        least.append(sharp - radius * sin(transverse) ** 2 + thinner_end)
    return max(0.0, SHIFT_STEP * ceil(round(max(least) / SHIFT_STEP, 9)))


def _place_face(design: PairDesign, wishes: ToothWishes) -> tuple[PairDesign, tuple[float, float]]:
    """Return the design with its face as near to the path of contact as the limits allow, and these limits,
    m.

    The face is up to WIDEST modules wide and leaves FREE_ENDS of the allowed range free at either end.
    Radii that the user gave go before. The pinion is a module wider at either end. Raises GeometryError
    where the teeth cannot exist or less than NARROWEST modules are left. The middle of a pinion that is not
    spur is that of the gear's face on the pitch line, which moves the limits of tapered teeth: the face is
    placed again.
    """
    module = design.module
    middle = float(np.mean(path_middles(design.family)))
    centre = 0.5 * module * design.face_gear.teeth
    if not design.is_spur:
        centre = float(pitch_line_radius(design.family, middle))
        design = replace(design, pinion=replace(design.pinion, middle=middle))
    check_shaper(design)
    for _ in range(1 if design.is_spur else PLACEMENTS):
        limits = face_range(design, radius_limits(design))
        _require_face(limits.outer - limits.inner, module, str(limits))
        ends = _face_ends(centre, (limits.inner, limits.outer), module, wishes)
        design = _with_face(design, ends)
    check(design)
    return design, (limits.inner, limits.outer)


def _with_face(design: PairDesign, ends: tuple[float, float]) -> PairDesign:
    """Return the design with radii (m) of the gear's face; the pinion's is a module wider at either end."""
    gear = replace(design.face_gear, inner_radius=ends[0], outer_radius=ends[1])
    if design.is_spur:
        pinion = replace(design.pinion, width=ends[1] - ends[0] + 2.0 * design.module)
        return replace(design, face_gear=gear, pinion=pinion)
    first, last = (float(end) for end in pitch_line_y(design.family, ends))
    width, middle = last - first + 2.0 * design.module, 0.5 * (first + last)
    return replace(design, face_gear=gear, pinion=replace(design.pinion, width=width, middle=middle))


def _require_face(radial_range: float, module: float, limits_text: str) -> None:
    """Raise GeometryError where less than NARROWEST modules of face are left of a range of radii (m)."""
    width = min((1.0 - 2.0 * FREE_ENDS) * radial_range, WIDEST * module)
    if width < NARROWEST * module:
        requirement = f"a face of {NARROWEST:g} modules: {limits_text}"
        raise GeometryError("face_gear", round(width / module, 3), requirement)


def _face_ends(
    centre: float, limits: tuple[float, float], module: float, wishes: ToothWishes
) -> tuple[float, float]:
    """Return the radii (m) of a face as near to `centre` (m) as the limits (m) allow, the user's first."""
    radial_range = limits[1] - limits[0]
    free = FREE_ENDS * radial_range
    width = min(radial_range - 2.0 * free, WIDEST * module)
    inner = min(max(centre - 0.5 * width, limits[0] + free), limits[1] - free - width)
    outer = inner + width
    if wishes.inner_radius_mm is not None:
        inner = 1e-3 * wishes.inner_radius_mm
        outer = min(inner + width, limits[1] - free)
    if wishes.outer_radius_mm is not None:
        outer = 1e-3 * wishes.outer_radius_mm
        if wishes.inner_radius_mm is None:
            inner = max(outer - width, limits[0] + free)
    return inner, outer


def _given_or(wish: float | None, choice: float) -> float:
    """Return the user's value, or the choice where none is given."""
    return choice if wish is None else wish


def _one_or(wish: float | None, choices: tuple[float, ...]) -> tuple[float, ...]:
    """Return the user's value alone, or all choices where none is given."""
    return choices if wish is None else (wish,)


def chosen_keys(teeth: ChosenTeeth) -> dict[str, Any]:
    """Return the numbers of chosen teeth under the names of the wishes, rounded as a config writes them.

    Parameters
    ----------
    teeth : ChosenTeeth
        Teeth of `choose_teeth`.

    Returns
    -------
    dict[str, Any]
        Values by the names of ToothWishes and `pinion_width_mm`, in modules, mm or um as the names say.
    """
    design = teeth.design
    module, pinion, gear, shaper = design.module, design.pinion, design.face_gear, design.shaper
    return {
        "profile_shift_modules": round(pinion.profile_shift / module, 6),
        "pinion_addendum_modules": round(pinion.addendum / module, 6),
        "pinion_dedendum_modules": round(pinion.dedendum / module, 6),
        "rack_tip_radius_modules": round(pinion.rack_tip_radius / module, 6),
        "gear_addendum_modules": round(gear.addendum / module, 6),
        "shaper_teeth": shaper.teeth,
        "shaper_addendum_modules": round(shaper.addendum / module, 6),
        "shaper_tip_rounding_modules": round(shaper.tip_rounding / module, 6),
        "thinning_um": round(1e6 * pinion.thinning, 3),
        "inner_radius_mm": round(1e3 * gear.inner_radius, 4),
        "outer_radius_mm": round(1e3 * gear.outer_radius, 4),
        "pinion_width_mm": round(1e3 * pinion.width, 4),
        **({} if pinion.middle is None else {"pinion_middle_mm": round(1e3 * pinion.middle, 4)}),
    }
