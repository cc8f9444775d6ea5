"""Between which gear radii a face of helical, tapered, offset or asymmetric teeth may lie, and which key
helps.

The limits are those of `family_limits`. Lands have to be as wide at every radius of the face as a tool can
make them: the tip land of the gear falls outwards, and with a taper its root land does.
"""

from collections.abc import Callable
from dataclasses import replace
from math import hypot, inf

import numpy as np
from scipy.optimize import brentq

from facegear.arrays import Array
from facegear.errors import GeometryError, NotConverged
from facegear.teeth.design import PairDesign, as_cut
from facegear.teeth.family_limits import (
    FARTHEST,
    ROUNDING,
    SIDES,
    FamilyLimits,
    family_limits,
    root_land,
    tip_land,
)
from facegear.teeth.generated_fillet import gear_fillet
from facegear.teeth.tooth_family import ToothFamily

THINNEST_ROOT = 0.01
"""Thinnest root land, and shortest fillet, of teeth that are not spur, in modules: a taper thins the land
towards one end of the face, where it may still be cut."""
SAMPLES = 33
"""Radii at which lands are looked at before a limit is refined, some 1 % apart."""
FILLET_POINTS = 33
"""Points by which the length of a fillet is measured."""
FLANK_NAMES = {1: "drive", -1: "coast"}
"""Names of the flanks by their sign."""
HELP = {
    "undercut": "a smaller shaper.addendum_modules",
    "no height": "a larger shaper.addendum_modules",
    "start of the involute": "a smaller face_gear.addendum_modules",
    "turns back": "a smaller face_gear.addendum_modules",
}
"""Changes that move the inner limit inwards, by its reason."""


def design_limits(design: PairDesign) -> FamilyLimits:
    """Compute the limits of a face about the pitch point, whatever radii the design's face has.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    FamilyLimits
        Gear radii, m.

    Raises
    ------
    GeometryError
        Where the shaper's tip generates no flank at all, by the key of its addendum.
    """
    family = _about_pitch_point(design)
    try:
        return family_limits(family)
    except GeometryError as error:
        addendum = round(design.shaper.addendum / design.module, 6)
        raise GeometryError("shaper.addendum_modules", addendum, str(error.requirement)) from error


def _about_pitch_point(design: PairDesign) -> ToothFamily:
    """Return the nominal teeth of a design with a face about the pitch point, to begin searches from."""
    family = as_cut(design).family
    radius = hypot(design.offset, design.gear_pitch_radius)
    return replace(family, inner_radius=0.9 * radius, outer_radius=1.1 * radius)


def inner_reason(limits: FamilyLimits) -> str:
    """Say which flank limits the face inside, by what, and which key helps.

    Parameters
    ----------
    limits : FamilyLimits
        Limits of the face.

    Returns
    -------
    str
        Reason, flank and key, and the other flank's limit in mm.
    """
    _, reason, side = limits.inner
    other_limit = limits.starts[SIDES.index(-side)].limit
    return (
        f"{reason} of the {FLANK_NAMES[side]} flank, {HELP[reason]} helps; {other_limit[1]} of the "
        f"{FLANK_NAMES[-side]} flank at {1e3 * other_limit[0]:.3f}"
    )


def radii_with_lands(
    design: PairDesign, limits: FamilyLimits, thinnest_tip: float
) -> tuple[float, float, str | None, str]:
    """Compute the gear radii between which all lands of the gear are wide enough.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    limits : FamilyLimits
        Its limits by `design_limits`.
    thinnest_tip : float
        Thinnest tip land, m.

    Returns
    -------
    tuple
        Smallest and largest radius, m; why the first lies outside the inner limit, None where it does not;
        what limits the second.

    Raises
    ------
    GeometryError
        Where no radius has a tip land.
    """
    family, inner = _about_pitch_point(design), limits.inner[0] * (1 + 1e-9)
    last = min(limits.pointing * (1 - 1e-9), max(FARTHEST * family.outer_radius, 1.01 * inner))
    radius = np.linspace(inner, last, SAMPLES)

    def tip_left(at: Array) -> Array:
        """Return the width of the tip land at radii (n,), m, less the thinnest."""
        land = tip_land(family, at) - thinnest_tip
        return np.where(np.isnan(land), -inf, land)

    left = tip_left(radius)
    if not (left > 0.0).any():
        addendum = round(design.face_gear.addendum / design.module, 6)
        requirement = "less: the teeth are pointed where they are no longer undercut"
        raise GeometryError("face_gear.addendum_modules", addendum, requirement)
    first = int(np.argmax(left > 0.0))
    start, start_reason = radius[0], None
    if first > 0:
        start = _crossing(tip_left, radius[first], radius[first - 1])
        start_reason = "tips pointed further in"
    ends = np.flatnonzero(left[first:] <= 0.0)
    outer, reason = radius[-1], f"{FARTHEST:g} times the pitch point's radius, the farthest that is looked at"
    if ends.size:
        outer = _crossing(tip_left, radius[first + ends[0] - 1], radius[first + ends[0]])
        reason = "tips pointed, a smaller face_gear.addendum_modules helps"
        if np.isfinite(limits.pointing):
            reason = (
                f"tips pointed at {1e3 * limits.pointing:.3f}, a smaller face_gear.addendum_modules helps"
            )
    least = THINNEST_ROOT * design.module
    roots = (
        (lambda at: _root_left(family, at, least), "root land vanishes", "a smaller shaper.addendum_modules"),
        (
            lambda at: _fillet_left(family, at, least),
            "no fillet left",
            "a larger shaper.tip_rounding_modules",
        ),
    )
    for root_left, words, key in roots:
        radii = np.linspace(start, outer, SAMPLES)
        without_land = np.flatnonzero(~(root_left(radii) > 0.0))
        if without_land.size:
            outer = _crossing(root_left, radii[max(without_land[0] - 1, 0)], radii[without_land[0]])
            reason = f"{words}, {key} helps"
    return float(start), float(outer), start_reason, reason


def _crossing(left: Callable[[Array], Array], inside: float, outside: float) -> float:
    """Return the radius (m) between one with a land and one without at which it vanishes."""
    if not np.isfinite(left(np.array([outside]))[0]):
        # beyond the end of a flank there is no width: the land ends where the flank does
        for _ in range(50):
            middle = (inside + outside) / 2
            inside, outside = (middle, outside) if left(np.array([middle]))[0] > 0.0 else (inside, middle)
        return inside
    if inside == outside:
        return inside
    return float(brentq(lambda at: float(left(np.array([at]))[0]), inside, outside, xtol=ROUNDING))


def _root_left(family: ToothFamily, radius: Array, thinnest: float) -> Array:
    """Return the width of the root land at radii (n,), m, less the thinnest (m); -inf where there is none."""
    try:
        land = root_land(family, radius) - thinnest
    except NotConverged:
        if radius.size == 1:
            return np.array([-inf])
        return np.concatenate([_root_left(family, at, thinnest) for at in radius[:, None]])
    return np.where(np.isnan(land), -inf, land)


def _fillet_left(family: ToothFamily, radius: Array, shortest: float) -> Array:
    """Return the length of the shorter fillet at radii (n,), m, less the shortest allowed (m)."""
    part, lengths = np.linspace(0.0, 1.0, FILLET_POINTS)[:, None], []
    for side in SIDES:
        fillet = gear_fillet(family, side)
        try:
            points = fillet.point(fillet.y_at(radius, part), part)
        except NotConverged:
            if radius.size == 1:
                return np.array([-inf])
            return np.concatenate([_fillet_left(family, at, shortest) for at in radius[:, None]])
        lengths.append(np.linalg.norm(np.diff(points, axis=0), axis=-1).sum(axis=0))
    return np.min(lengths, axis=0) - shortest
