"""Radial limits of a face gear's teeth: inner radius from undercut, outer radius from pointing.

Spur teeth take them from the same surfaces as all others (`family_range`), with brackets known beforehand.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, atan, cos, hypot, pi, sin, sqrt

from scipy.optimize import brentq, minimize_scalar

from facegear.errors import GeometryError, NotConverged
from facegear.teeth import face_gear, face_gear_fillet
from facegear.teeth.design import PairDesign
from facegear.teeth.family_limits import singular_quadratic
from facegear.teeth.family_range import design_limits, inner_reason, radii_with_lands
from facegear.teeth.generated_flank import gear_flank

ROUNDING = 1e-15
"""Absolute tolerance (m or rad) of roots: some thousand times less than a limit is printed with."""
THINNEST_LAND = 0.05
"""Thinnest tip or root land, in modules: less cannot be cut, nor meshed."""


@dataclass(frozen=True)
class FaceRange:
    """Gear radii (m) between which a face may lie, and what limits it on either side."""

    inner: float
    outer: float
    inner_reason: str
    outer_reason: str

    def __str__(self) -> str:
        """Return the range in mm with both reasons, as an error message tells it."""
        return (
            f"between {1e3 * self.inner:.3f} ({self.inner_reason}) and {1e3 * self.outer:.3f} "
            f"({self.outer_reason})"
        )


@dataclass(frozen=True)
class RadiusLimits:
    """Inner (undercut) and outer (pointing) gear radii in m, the second infinite where teeth are not pointed.

    outer_planar: of spur teeth the pointing radius with the section taken as a straight rack. inner_reason:
    what limits teeth that are not spur inside, with flank and helpful key.
    """

    inner: float
    outer: float
    outer_planar: float | None = None
    inner_reason: str = "undercut"


def radius_limits(design: PairDesign) -> RadiusLimits:
    """Compute inner (undercut) and outer (pointing) radius of the face for any shaper, addendum and
    pressure angle.

    Undercut: the singular line meets the end of the shaper's involute. Pointing: the two flanks meet on the
    tip surface. Teeth that are not spur are limited by either flank, and inside also by a flank's height and
    by the start of the shaper's involute.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    RadiusLimits
        Gear radii, m.

    Raises
    ------
    GeometryError
        If the flanks meet on the tip surface at every radius, or there is no flank at all.
    """
    if not design.is_spur:
        limits = design_limits(design)
        return RadiusLimits(limits.inner[0], limits.pointing, inner_reason=inner_reason(limits))
    return RadiusLimits(undercut_radius(design), *_pointing_radii(design))


def face_range(design: PairDesign, limits: RadiusLimits) -> FaceRange:
    """Compute between which radii teeth have a tip land, a root land and a fillet; the face's own radii do
    not enter.

    Tip lands are at least THINNEST_LAND wide, as fillets of spur teeth; root lands and fillets of others at
    least THINNEST_ROOT of `facegear.teeth.family_range`.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    limits : RadiusLimits
        Result of `radius_limits`.

    Returns
    -------
    FaceRange
        Gear radii, m.

    Raises
    ------
    GeometryError
        If there is no such place.
    """
    if not design.is_spur:
        lands = radii_with_lands(design, design_limits(design), THINNEST_LAND * design.module)
        start, last, start_reason, last_reason = lands
        return _wide_face(design, FaceRange(start, last, start_reason or limits.inner_reason, last_reason))
    tip_undercut = tip_plane_radius(design)
    inner, inner_reason = max((limits.inner, "undercut"), (tip_undercut * (1 + 1e-9), "tip undercut"))
    land = _radii_with_land(design, inner, limits.outer) if limits.outer > inner else None
    if land is None:
        raise _no_face(design, "the teeth are pointed where they are no longer undercut")
    if land[0] > inner:
        inner, inner_reason = land[0], "tips pointed further in"
    candidates = [(land[1], f"tips pointed at {1e3 * limits.outer:.3f}")]
    sharpest = sharpest_fillet_radius(design)
    if _fillet_left(design, sharpest) < 0:
        last = _last(_fillet_left, design, inner, sharpest)
        reason = "the shaper's tip leaves no fillet further out; a larger shaper.tip_rounding_modules does"
        candidates.append((last, reason))
    outer, outer_reason = min(candidates)
    return _wide_face(design, FaceRange(inner, outer, inner_reason, outer_reason))


def _wide_face(design: PairDesign, face: FaceRange) -> FaceRange:
    """Return a range if it leaves half a module of face, else raise GeometryError."""
    if face.outer - face.inner < 0.5 * design.module:
        raise _no_face(design, f"less than half a module of face is left {face}")
    return face


def _no_face(design: PairDesign, reason: str) -> GeometryError:
    """Return, not raise, the error of a design whose face has no width; it names the gear's addendum."""
    tip = round(design.face_gear.addendum / design.module, 6)
    return GeometryError("face_gear.addendum_modules", tip, f"less: {reason}")


def _radii_with_land(design: PairDesign, low: float, high: float) -> tuple[float, float] | None:
    """Return the smallest and largest radius (m) at which the tip land is wide enough; None if there is none.

    The land has one maximum: with many pinion teeth it also vanishes near the radius of tip undercut.
    """
    start, end = low * (1 + 1e-9), high * (1 - 1e-6)
    if end <= start:
        return None
    if _land_left(design, start) > 0:
        return low, _last(_land_left, design, low, high)
    widest = float(
        minimize_scalar(
            lambda radius: -_land_left(design, radius),
            bounds=(start, end),
            method="bounded",
            options={"xatol": 1e-3 * design.module},
        ).x
    )
    if _land_left(design, widest) <= 0:
        return None
    first = brentq(lambda radius: _land_left(design, radius), start, widest, xtol=ROUNDING)
    return float(first), _last(_land_left, design, widest, high)


def _last(margin: Callable[[PairDesign, float], float], design: PairDesign, low: float, high: float) -> float:
    """Return the largest radius in low .. high (m) at which a margin that falls outwards is still
    positive, `low` if there is none.
    """
    low, high = low * (1 + 1e-9), high * (1 - 1e-6)
    if high <= low or margin(design, low) <= 0:
        return low
    if margin(design, high) >= 0:
        return high
    return float(brentq(lambda radius: margin(design, radius), low, high, xtol=ROUNDING))


def _land_left(design: PairDesign, radius: float) -> float:
    """Return the width (m) of the tip land at a gear radius (m), less the thinnest allowed."""
    roll, psi = face_gear.tip_parameters(design, radius)
    return 2 * float(face_gear.flank_point(design, roll, psi)[..., 0]) - THINNEST_LAND * design.module


def sharpest_fillet_radius(design: PairDesign) -> float:
    """Compute the gear radius at which the centre of a spur shaper's tip rounding rolls on the gear's pitch
    surface.

    The tip turns about that centre and leaves nothing but its own rounding; a sharp one leaves a corner.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        m.
    """
    return design.shaper_rounding_centre / design.shaper_ratio


def _fillet_left(design: PairDesign, radius: float) -> float:
    """Return the length (m) of the fillet at a gear radius (m), less the shortest allowed, THINNEST_LAND
    modules.

    The length is the way of the rounding's centre and its arc.
    """
    psi = float(face_gear_fillet.fillet_start(design, radius))
    way = abs(psi - atan(design.shaper_rounding_roll)) * design.shaper_rounding_centre
    return way + (pi / 2 - psi) * design.shaper.tip_rounding - THINNEST_LAND * design.module


def undercut_radius(design: PairDesign) -> float:
    """Compute the smallest gear radius at which a spur shaper's tip does not cut into the flank.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        m.
    """
    flank, roll = gear_flank(design.mirror_family, -1), design.shaper_tip_roll
    end = design.shaper_base_radius * roll

    def singularity(psi: float) -> float:
        """Return the quadratic of `singular_quadratic` at the flank's end, m2/rad."""
        square, linear, constant = singular_quadratic(flank, psi)
        return float((square * end + linear) * end + constant)

    psi = brentq(singularity, 0.0, atan(roll), xtol=ROUNDING)
    point = flank.point(psi, end)
    return hypot(float(point[0]), float(point[1]))


def tip_plane_radius(design: PairDesign) -> float:
    """Compute the smallest gear radius at which the flank of spur teeth reaches the tip plane (the envelope
    turns back there).

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        m.
    """
    flank, height = gear_flank(design.mirror_family, -1), _tip_plane(design)
    psi = brentq(lambda at: flank.growth_at_height(at, height)[2], 1e-4, 1.0, xtol=ROUNDING)
    return flank.growth_at_height(psi, height)[1]


def _pointing_radii(design: PairDesign) -> tuple[float, float]:
    """Return the exact gear radius (m) at which both flanks meet on the tip plane, and the one by a
    straight rack.
    """
    space = design.shaper_half_space_angle
    tip_plane = _tip_plane(design)
    height = (design.shaper_lift - tip_plane) / design.shaper_base_radius

    def planar(psi: float) -> float:
        """Return a measure (rad) of a straight rack's tooth at a slope psi (rad), negative if its tip has
        a land.
        """
        return psi - height * sin(psi) - space

    flank = gear_flank(design.mirror_family, -1)

    def exact(psi: float) -> float:
        """Return x / y of the flank on the tip plane at a slope psi (rad), 0 where the tooth is pointed."""
        point = flank.point(psi, flank.growth_at_height(psi, tip_plane)[0])
        return float(point[0] / point[1])

    thickest = acos(1 / height) if height > 1 else 1e-6
    if planar(thickest) >= 0:
        tip = design.face_gear.addendum / design.module
        raise GeometryError(
            "face_gear.addendum_modules", round(tip, 6), "less: the tooth is pointed everywhere"
        )
    planar_psi = brentq(planar, thickest, pi / 2, xtol=ROUNDING)
    exact_psi = _root_near(exact, planar_psi)
    exact_radius = flank.growth_at_height(exact_psi, tip_plane)[1]
    return exact_radius, design.gear_base_radius / cos(planar_psi)


def _tip_plane(design: PairDesign) -> float:
    """Return the height (m) of a spur gear's flat tip."""
    return float(face_gear.tip_height(design, design.gear_pitch_radius))


def _root_near(function: Callable[[float], float], guess: float) -> float:
    """Return the root (rad) of a function near a guess (rad), by Brent's method in a bracket that grows.

    The guess is the planar limit, from which the exact one differs by some 0.03 %: a bracket grows around it.
    """
    width = 1e-3
    while width < 1.0:
        low, high = max(guess - width, 1e-3), min(guess + width, pi / 2 - 1e-6)
        if function(low) * function(high) <= 0:
            return float(brentq(function, low, high, xtol=ROUNDING))
        width *= 2
    raise NotConverged("geometry", "the pointing limit", f"brackets up to 1 rad around {guess:.4f} rad")


def pitch_line_radius(design: PairDesign, y: float) -> float:
    """Compute the gear radius at a place of the pitch line, which lies in the pinion's pitch cylinder.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    y : float
        Place along the pinion's axis, m.

    Returns
    -------
    float
        m; y itself where axes cross at 90 degrees.
    """
    motion = design.family.motion
    return hypot(y * motion.sine - design.pinion_pitch_radius * motion.cosine, design.offset)


def common_face(design: PairDesign) -> tuple[float, float]:
    """Compute the ends, along the pinion's axis, of the part of the pitch line that both faces cover.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    tuple[float, float]
        Inner and outer end y, m.
    """
    motion, face, half = design.family.motion, design.face_gear, design.pinion.width / 2
    first, last = (
        (sqrt(radius**2 - design.offset**2) + design.pinion_pitch_radius * motion.cosine) / motion.sine
        for radius in (face.inner_radius, face.outer_radius)
    )
    return max(first, design.middle - half), min(last, design.middle + half)
