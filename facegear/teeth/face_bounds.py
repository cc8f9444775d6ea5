"""Gear radii between which the face of teeth of any kind may lie: cause, flank, and the key that helps."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from facegear.arrays import Array
from facegear.errors import GeometryError, NotConverged
from facegear.teeth.family_limits import FlankStart, family_limits, root_land, tip_land
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.helicoid import pinion_land, shaper_land
from facegear.teeth.tooth_family import SIDES, ToothFamily

FLANK_NAMES = {1: "drive", -1: "coast"}
"""Names of flanks by their sign."""
REMEDIES = {
    "undercut": "a larger pressure_angle_deg or a smaller shaper.addendum_modules",
    "no height": "a larger pressure_angle_deg or face_gear.addendum_modules",
    "turns back": "a larger pressure_angle_deg",
    "start of the involute": "a smaller face_gear.addendum_modules or a larger pressure_angle_deg",
    "pointed tips": "a smaller face_gear.addendum_modules or pressure_angle_deg",
    "no root land": "a smaller shaper.addendum_modules or shaper.tip_rounding_modules",
    "pointed pinion": "a smaller pinion.addendum_modules",
}
"""Keys of section `tooth_pair` whose change moves a limit away, by what limits the face."""
SAMPLES = 97
"""Radii at which lands are looked at before the place where one vanishes is refined."""
FARTHEST = 1.6
"""Radius over that of the path up to which the outer limit is looked for."""
ROUNDING = 1e-12
"""Absolute tolerance (m) of radii at which lands vanish."""
SAME_RADIUS = 1e-12
"""Relative difference of two radii that is rounding."""
NO_LAND = -1.0
"""Width (m) that stands for a land where there is no flank."""


def pitch_line_y(family: ToothFamily, radius: ArrayLike) -> Array:
    """Compute where the pinion's pitch line, nearest to the gear, passes a gear radius.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (...) array
        Place y along the pinion's axis, m; nan for a radius below the offset.
    """
    motion, radius = family.motion, np.asarray(radius, float)
    with np.errstate(invalid="ignore"):
        level = np.sqrt((radius - family.offset) * (radius + family.offset))
    return (level + family.pinion_pitch_radius * motion.cosine) / motion.sine


def pitch_line_radius(family: ToothFamily, y: ArrayLike) -> Array:
    """Compute the gear radius at a place of the pinion's pitch line: the inverse of `pitch_line_y`.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    y : (...) array_like
        Place y along the pinion's axis, m.

    Returns
    -------
    (...) array
        Gear radius, m.
    """
    motion = family.motion
    level = np.asarray(y, float) * motion.sine - family.pinion_pitch_radius * motion.cosine
    return np.hypot(family.offset, level)


def path_middles(family: ToothFamily) -> tuple[float, float]:
    """Compute where the paths of contact of both flanks meet the pinion's pitch line, without errors.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears; the place of its face does not matter.

    Returns
    -------
    tuple of float
        Places y along the pinion's axis of drive and coast flank, m.
    """
    motion, middles = family.motion, []
    for side in SIDES:
        helicoid = gear_flank(family, side).shaper
        slope = helicoid.pressure_angle
        normal_x = side * helicoid.cosine * np.cos(slope)
        normal_y = helicoid.sine * motion.sine - helicoid.cosine * np.sin(slope) * motion.cosine
        level = family.gear_pitch_radius + family.offset * normal_y / normal_x
        middles.append(float((level + family.pinion_pitch_radius * motion.cosine) / motion.sine))
    return middles[0], middles[1]


@dataclass(frozen=True)
class FaceBounds:
    """Gear radii (m) between which a face may lie, and what limits it.

    inner_cause, outer_cause: keys of REMEDIES. inner_side: sign of the flank that decides the inner one, 0
    where both do. starts: limits of drive and coast flank alone.
    """

    inner: float
    outer: float
    inner_cause: str
    outer_cause: str
    inner_side: int
    starts: tuple[FlankStart, FlankStart]

    def __str__(self) -> str:
        """Return the range in mm with both causes, as an error message tells it."""
        flank = self.inner_cause
        if self.inner_side:
            flank += f" of the {FLANK_NAMES[self.inner_side]} flank"
        return f"between {1e3 * self.inner:.3f} ({flank}) and {1e3 * self.outer:.3f} ({self.outer_cause})"

    def lines(self) -> list[str]:
        """List the limits of both flanks and the outer one, each with the key that moves it away.

        Returns
        -------
        list of str
            Three lines: drive flank, coast flank, and the outer limit; radii in mm.
        """
        lines = []
        for side, start in zip(SIDES, self.starts, strict=True):
            radius, cause = start.limit
            lines.append(f"{FLANK_NAMES[side]} flank: from {1e3 * radius:.3f} ({cause}); {_help(cause)}")
        outer = f"up to {1e3 * self.outer:.3f} ({self.outer_cause}); {_help(self.outer_cause)}"
        return [*lines, f"both flanks: {outer}"]


def _help(cause: str) -> str:
    """Return in words which key moves a limit away, by its cause."""
    return f"{REMEDIES[cause]} helps"


@lru_cache(maxsize=64)
def face_bounds(family: ToothFamily, thinnest: float, overhang: float = 0.0) -> FaceBounds:
    """Compute between which gear radii teeth have sound flanks and lands.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears; of its face only the middle counts, at which the profile shift is given.
    thinnest : float
        Thinnest permitted land of gear, pinion and shaper, m.
    overhang : float
        Length (m) by which the pinion's face reaches beyond that of the gear at either end.

    Returns
    -------
    FaceBounds
        The range that holds the radius of the path of contact, else the nearest one.

    Raises
    ------
    GeometryError
        Where no radius has sound flanks and lands.
    """
    limits = family_limits(family)
    inner, cause, side = limits.inner
    if min(start.limit[0] for start in limits.starts) > inner * (1.0 - SAME_RADIUS):
        side = 0
    path = float(pitch_line_radius(family, np.mean(path_middles(family))))
    radii = np.linspace(inner * (1.0 + 1e-9), max(FARTHEST * path, 1.01 * inner), SAMPLES)
    left = _land_left(family, radii, thinnest, overhang)
    is_sound = (np.stack(list(left.values())) > 0.0).all(axis=0)
    if not is_sound.any():
        worst = min(left, key=lambda land: float(left[land].max()))
        key, addendum = {
            "pointed tips": ("face_gear", family.gear_addendum),
            "no root land": ("shaper", family.shaper_addendum),
            "pointed pinion": ("pinion", family.pinion_addendum),
        }[worst]
        value = round(addendum / family.rack.normal_module, 6)
        raise GeometryError(f"{key}.addendum_modules", value, f"less: {worst} at every radius")
    nearest = int(np.flatnonzero(is_sound)[np.argmin(np.abs(radii[is_sound] - path))])
    thin = np.flatnonzero(~is_sound)
    before, after = thin[thin < nearest], thin[thin > nearest]
    outer, outer_cause = float(radii[-1]), "pointed tips"
    if before.size:
        ends = radii[before[-1]], radii[before[-1] + 1]
        (inner, cause), side = _vanishing(family, ends, thinnest, overhang), 0
    if after.size:
        outer, outer_cause = _vanishing(family, (radii[after[0]], radii[after[0] - 1]), thinnest, overhang)
    return FaceBounds(inner, outer, cause, outer_cause, side, limits.starts)


def _vanishing(
    family: ToothFamily, ends: tuple[float, float], thinnest: float, overhang: float
) -> tuple[float, str]:
    """Return the radius (m) at which a land becomes too thin, and which, between a radius where it is and one
    where none is (m); that of the last of them on the way to the sound radius.
    """
    thin, sound = ends
    left = _land_left(family, np.array([thin]), thinnest, overhang)
    vanishing_radii = [
        (
            float(
                brentq(
                    lambda radius, cause=cause: float(
                        _land_left(family, np.array([radius]), thinnest, overhang)[cause][0]
                    ),
                    thin,
                    sound,
                    xtol=ROUNDING,
                )
            ),
            cause,
        )
        for cause, margin in left.items()
        if margin[0] <= 0.0
    ]
    return min(vanishing_radii, key=lambda limit: abs(limit[0] - sound))


def _land_left(family: ToothFamily, radii: Array, thinnest: float, overhang: float) -> dict[str, Array]:
    """Return by cause the widths (m) of the lands at gear radii (n,) (m), less the thinnest permitted (m)."""
    y_middle = pitch_line_y(family, radii)
    ends = [y_middle - overhang, y_middle + overhang]
    lands = {
        "pointed tips": tip_land(family, radii),
        "no root land": np.minimum(
            _root_lands(family, radii), np.min([shaper_land(family, y) for y in ends], axis=0)
        ),
        "pointed pinion": np.min([pinion_land(family, y) for y in ends], axis=0),
    }
    return {cause: np.where(np.isnan(land), NO_LAND, land) - thinnest for cause, land in lands.items()}


def _root_lands(family: ToothFamily, radii: Array) -> Array:
    """Return the gear's root lands (n,) at radii (n,), m; nan where the shaper's tip does not reach."""
    try:
        return root_land(family, radii)
    except NotConverged:
        pass
    lands = np.full(len(radii), np.nan)
    for row, radius in enumerate(radii):
        try:
            lands[row] = root_land(family, radius)
        except NotConverged:
            continue
    return lands
