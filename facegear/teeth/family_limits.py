"""Radial limits of a face of any family: where each flank begins, where the tooth points, where lands vanish.

The end of a flank, where the shaper's tip leaves it, is followed inwards until the flank is singular
(undercut), it reaches the tip surface (no height), or its radius turns back. The tip's points must besides be
cut by the shaper's involute, which begins at its base cylinder.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, minimize_scalar

from facegear.arrays import Array
from facegear.errors import GeometryError
from facegear.teeth.generated_fillet import flank_end, gear_fillet
from facegear.teeth.generated_flank import GearFlank, gear_flank
from facegear.teeth.helicoid import pinion_land, shaper_land
from facegear.teeth.tooth_family import SIDES, ToothFamily, dot

SAMPLES = 256
"""Slopes at which the end of a flank is looked at before a limit is refined; 0.4 degrees apart."""
STEEPEST = 1.45
"""Largest slope (rad) that is looked at: the gear's radius grows without end towards 90 degrees."""
FLATTEST = -0.4
"""Smallest slope (rad) that is looked at: sound flanks have positive slopes, helical ones nearly so."""
ROUNDING = 1e-15
"""Absolute tolerance of roots, m or rad."""
POINTING_SAMPLES = 64
"""Radii at which the tip land is looked at before pointing is refined."""
FARTHEST = 1.6
"""Radius over the face's outer radius up to which pointing is looked for."""


@dataclass(frozen=True)
class FlankStart:
    """Smallest gear radius (m) of a flank and the reason: `undercut`, `no height` or `turns back`.

    involute: gear radius (m) at which the shaper's involute begins on the tip surface, nan where it has
    begun everywhere.
    """

    radius: float
    reason: str
    involute: float

    @property
    def limit(self) -> tuple[float, str]:
        """The larger of both radii (m), and its reason."""
        if self.involute > self.radius:
            return self.involute, "start of the involute"
        return self.radius, self.reason


@dataclass(frozen=True)
class FamilyLimits:
    """Gear radii (m) between which a face may lie.

    starts: limits of drive and coast flank. pointing: where both flanks meet on the tip surface, inf where
    they do not within the radii looked at.
    """

    starts: tuple[FlankStart, FlankStart]
    pointing: float

    @cached_property
    def inner(self) -> tuple[float, str, int]:
        """Smallest radius (m) at which a face may begin, the reason, and the sign of the flank that
        decides.
        """
        radii = [start.limit[0] for start in self.starts]
        first = int(np.argmax(radii))
        return radii[first], self.starts[first].limit[1], SIDES[first]


@lru_cache(maxsize=64)
def family_limits(family: ToothFamily) -> FamilyLimits:
    """Compute the gear radii between which the face may lie, by `flank_start` and `pointing_radius`.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears; the width of its face is not used but for how far out pointing is looked for.

    Returns
    -------
    FamilyLimits
        Radii in m.

    Raises
    ------
    GeometryError
        Where the shaper's tip generates no flank at all.
    """
    starts = flank_start(family, 1), flank_start(family, -1)
    return FamilyLimits(starts, pointing_radius(family, max(start.limit[0] for start in starts)))


def flank_start(family: ToothFamily, side: int) -> FlankStart:
    """Compute the smallest gear radius of a flank and what limits it.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank: +1 drive, -1 coast.

    Returns
    -------
    FlankStart
        Radius in m.

    Raises
    ------
    GeometryError
        Where the shaper's tip generates no sound flank below the tip surface.
    """
    flank = gear_flank(family, side)

    def measures(psi: ArrayLike) -> tuple[Array, Array]:
        """Return the gear radius (m) of the flank's end at slopes (...), and two measures (2, ...) that
        are positive on a sound flank: `soundness` (m2/rad) and height left below the tip surface (m).
        """
        s = flank_end(family, side, psi)
        lines = flank.lines(psi)
        point = lines.foot + s[..., None] * lines.normal
        radius = np.hypot(point[..., 0], point[..., 1])
        sound = soundness(flank, psi, s)
        return radius, np.stack([sound, family.gear_tip.height(radius) - point[..., 2]])

    psi = np.linspace(STEEPEST, FLATTEST, SAMPLES)
    with np.errstate(invalid="ignore"):
        radius, sound = measures(psi)
    growth = np.gradient(radius, psi)
    is_sound = (sound > 0.0).all(axis=0) & (growth > 0.0) & np.isfinite(radius)
    near = np.flatnonzero(is_sound & (radius <= family.outer_radius))
    outside = np.flatnonzero(is_sound & (radius > family.outer_radius))
    start = near[0] if near.size else (outside[-1] if outside.size else None)
    if start is None:
        allowed_text = "such that the shaper's tip leaves a sound flank below the gear's tip"
        raise GeometryError("shaper addendum", round(family.shaper_addendum, 9), allowed_text)
    ends = np.flatnonzero(~is_sound[start:])
    involute = _involute_start(family, side)
    if not ends.size:
        return FlankStart(float(radius[-1]), "turns back", involute)
    first, last = psi[start + ends[0]], psi[start + ends[0] - 1]
    candidates = []
    for number, reason in enumerate(("undercut", "no height")):
        if measures(first)[1][number] <= 0.0:
            root = brentq(lambda at, row=number: float(measures(at)[1][row]), first, last, xtol=ROUNDING)
            candidates.append((float(measures(root)[0]), reason))
    if candidates:
        return FlankStart(*max(candidates), involute)
    outer = psi[max(start + ends[0] - 2, 0)]
    lowest = minimize_scalar(
        lambda at: float(measures(at)[0]), bounds=(first, outer), method="bounded", options={"xatol": 1e-12}
    )
    return FlankStart(float(lowest.fun), "turns back", involute)


def singular_quadratic(flank: GearFlank, psi: ArrayLike) -> tuple[Array, Array, Array]:
    """Return the coefficients of the quadratic in s that vanishes on the singular line (undercut) of a flank.

    Parameters
    ----------
    flank : GearFlank
        Flank of the gear.
    psi : (...) array_like
        Slope of the normal, rad.

    Returns
    -------
    tuple of (...) arrays
        Coefficients of s squared (1/rad), of s (m/rad), and without s (m2/rad).
    """
    lines = flank.lines(psi)
    foot, normal, foot_psi, normal_psi = lines.foot, lines.normal, lines.foot_slope, lines.normal_slope
    along = dot(normal, foot)
    along_psi = dot(normal_psi, foot) + dot(normal, foot_psi)
    linear = foot_psi[..., 2] + normal_psi[..., 2] * along - normal[..., 2] * along_psi
    return normal_psi[..., 2], linear, foot_psi[..., 2] * along - normal[..., 2] * dot(foot, foot_psi)


def soundness(flank: GearFlank, psi: ArrayLike, s: ArrayLike) -> Array:
    """Return the quadratic of `singular_quadratic`, its sign such that it is positive on a sound flank.

    Parameters
    ----------
    flank : GearFlank
        Flank of the gear.
    psi : (...) array_like
        Slope of the normal, rad.
    s : (...) array_like
        Distance along the normal, m.

    Returns
    -------
    (...) array
        m2/rad.
    """

    def quadratic(psi: ArrayLike, s: ArrayLike) -> Array:
        """Return the quadratic at psi (rad) and s (m), m2/rad."""
        square, linear, constant = singular_quadratic(flank, psi)
        return (square * np.asarray(s, float) + linear) * s + constant

    return quadratic(psi, s) * np.sign(quadratic(flank.shaper.pressure_angle, flank.pitch_distance))


def _involute_start(family: ToothFamily, side: int) -> float:
    """Return the largest gear radius (m) at which the start of the shaper's involute (s = 0) cuts a sound
    place of the tip surface; nan if there is none.
    """
    flank, tip = gear_flank(family, side), family.gear_tip

    def below(psi: ArrayLike) -> Array:
        """Return how far (m) the feet s = 0 of lines with slopes psi lie below the tip surface."""
        foot = flank.lines(psi).foot
        return tip.height(np.hypot(foot[..., 0], foot[..., 1])) - foot[..., 2]

    psi = np.linspace(STEEPEST, 1e-9, SAMPLES)
    depth = below(psi)
    # outside an inner limit feet lie above the tip surface; far out they may fall below it again
    changes = np.flatnonzero((depth[:-1] < 0.0) & (depth[1:] >= 0.0))
    radii = []
    for change in changes:
        root = brentq(lambda at: float(below(at)), psi[change + 1], psi[change], xtol=ROUNDING)
        foot = flank.lines(root).foot
        if soundness(flank, root, 0.0) > 0.0:
            radii.append(float(np.hypot(foot[0], foot[1])))
    return max(radii, default=float("nan"))


def tip_land(family: ToothFamily, radius: ArrayLike) -> Array:
    """Compute the width of the gear's tip land, the arc between both flanks on the tip surface.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (...) array
        Arc, m, negative beyond pointing; nan where a flank does not reach the tip surface.
    """
    radius = np.asarray(radius, float)
    angles = []
    for side in SIDES:
        flank = gear_flank(family, side)
        psi, s = flank.search(radius, family.gear_tip.height(radius))
        point = flank.point(psi, s)
        angles.append(np.arctan2(point[..., 0], point[..., 1]))
    return radius * (angles[1] - angles[0])


def root_land(family: ToothFamily, radius: ArrayLike) -> Array:
    """Compute the width of the gear's root land.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (...) array
        Arc between the lowest places of both fillets of a space, m.

    Raises
    ------
    NotConverged
        Where the shaper's tip does not reach the radius.
    """
    radius, angles = np.asarray(radius, float), []
    for side in SIDES:
        fillet = gear_fillet(family, side)
        point = fillet.point(fillet.y_at(radius, 1.0), 1.0)
        angles.append(np.arctan2(point[..., 0], point[..., 1]))
    return radius * (2 * np.pi / family.gear_teeth - (angles[1] - angles[0]))


def pointing_radius(family: ToothFamily, inner: float) -> float:
    """Compute the gear radius at which both flanks meet on the tip surface.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    inner : float
        Radius from which on it is looked for, m.

    Returns
    -------
    float
        m; inf where the tip land does not vanish up to `FARTHEST` times the outer radius.
    """
    radius = np.linspace(
        inner * (1.0 + 1e-9), max(FARTHEST * family.outer_radius, 1.01 * inner), POINTING_SAMPLES
    )
    land = tip_land(family, radius)
    without_land = np.flatnonzero(~(land > 0.0))
    if not without_land.size:
        return float("inf")
    first = int(without_land[0])
    if first == 0:
        return float(radius[0])
    if np.isnan(land[first]):
        return float("nan")
    return float(
        brentq(lambda at: float(tip_land(family, at)), radius[first - 1], radius[first], xtol=ROUNDING)
    )


def check_family(family: ToothFamily, thinnest: float = 0.0) -> FamilyLimits:
    """Compute the limits; raise for a family whose face lies beyond them or whose lands are too thin.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    thinnest : float
        Thinnest permitted land, m.

    Returns
    -------
    FamilyLimits
        Radii in m.

    Raises
    ------
    GeometryError
        With the part, its dimension (m) and the limit that it breaks.
    """
    limits = family_limits(family)
    inner, reason, side = limits.inner
    name = "drive" if side > 0 else "coast"
    if family.inner_radius < inner:
        allowed_text = f"at least {1e3 * inner:.3f} mm ({reason} of the {name} flank)"
        raise GeometryError("inner radius of the face", round(family.inner_radius, 9), allowed_text)
    if not family.outer_radius < limits.pointing:
        allowed_text = f"less than {1e3 * limits.pointing:.3f} mm, where the teeth are pointed"
        raise GeometryError("outer radius of the face", round(family.outer_radius, 9), allowed_text)
    ends = family.middle + family.width / 2 * np.array([-1.0, 1.0])
    radii = np.array([family.inner_radius, family.outer_radius])
    lands = (
        ("tip land of the face gear", tip_land(family, radii)),
        ("tip land of the pinion", pinion_land(family, ends)),
        ("tip land of the shaper", shaper_land(family, ends)),
        ("root land of the face gear", root_land(family, radii)),
    )
    for land_text, widths in lands:
        worst = float(np.min(np.where(np.isnan(widths), -np.inf, widths)))
        if not worst > thinnest:
            raise GeometryError(land_text, round(worst, 9), f"above {1e3 * thinnest:.3f} mm at both ends")
    return limits
