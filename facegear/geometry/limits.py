"""Where a face gear's teeth can exist: inner radius from undercut, outer radius from pointing."""

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, atan, cos, hypot, pi, sin, sqrt, tan

from scipy.optimize import brentq, minimize_scalar

from facegear.errors import GeometryError, NotConverged
from facegear.geometry.design import PairDesign


@dataclass(frozen=True)
class RadiusLimits:
    """Inner (undercut) and outer (pointing) gear radii in m; planar: the section taken as a straight rack."""

    inner: float
    outer: float
    outer_planar: float


def radius_limits(design: PairDesign) -> RadiusLimits:
    """Limits of the face width for any shaper, addendum and pressure angle.

    Undercut: the singular line th = (tan psi / 2)(1 + sqrt(1 + 4 / (m2s cos psi)^2)) meets the shaper's tip.
    Pointing: the two flanks meet on the tip plane. Raises GeometryError if they do so at every radius.
    """
    return RadiusLimits(undercut_radius(design), *_pointing_radii(design))


def undercut_radius(design: PairDesign) -> float:
    """Smallest gear radius (m) that the shaper's tip does not cut into the flank."""
    base, ratio, roll = design.shaper_base_radius, design.shaper_ratio, design.shaper_tip_roll

    def margin(psi: float) -> float:
        return tan(psi) / 2 * (1 + sqrt(1 + 4 / (ratio * cos(psi)) ** 2)) - roll

    psi = brentq(margin, 0.0, atan(roll), xtol=1e-15)
    return hypot(base * (sin(psi) - roll * cos(psi)), base / (ratio * cos(psi)))


def tip_plane_radius(design: PairDesign) -> float:
    """Smallest gear radius (m) at which the flank reaches the tip plane (the envelope turns back there)."""
    base, ratio = design.shaper_base_radius, design.shaper_ratio
    height = (design.shaper_lift - design.gear_tip_plane) / base

    def radius(psi: float) -> float:
        return hypot(base * (1 - height * cos(psi)) / sin(psi), base / (ratio * cos(psi)))

    return float(minimize_scalar(radius, bounds=(1e-4, 1.0), method="bounded", options={"xatol": 1e-10}).fun)


def _pointing_radii(design: PairDesign) -> tuple[float, float]:
    base, ratio, space = design.shaper_base_radius, design.shaper_ratio, design.shaper_half_space_angle
    height = (design.shaper_lift - design.gear_tip_plane) / base

    def planar(psi: float) -> float:
        return psi - height * sin(psi) - space

    def exact(psi: float) -> float:
        roll = (height - cos(psi)) / sin(psi)
        return atan(ratio * cos(psi) * (sin(psi) - roll * cos(psi))) - ratio * (psi - roll - space)

    thickest = acos(1 / height) if height > 1 else 1e-6
    if planar(thickest) >= 0:
        tip = design.face_gear.addendum / design.module
        raise GeometryError(
            "face_gear.addendum_modules", round(tip, 6), "less: the tooth is pointed everywhere"
        )
    planar_psi = brentq(planar, thickest, pi / 2, xtol=1e-15)
    exact_psi = _root_near(exact, planar_psi)
    roll = (height - cos(exact_psi)) / sin(exact_psi)
    exact_radius = hypot(base * (sin(exact_psi) - roll * cos(exact_psi)), base / (ratio * cos(exact_psi)))
    return exact_radius, design.gear_base_radius / cos(planar_psi)


def _root_near(function: Callable[[float], float], guess: float) -> float:
    """The planar and the exact limit differ by some 0.03 %: a bracket that grows around the planar one."""
    width = 1e-3
    while width < 1.0:
        low, high = max(guess - width, 1e-3), min(guess + width, pi / 2 - 1e-6)
        if function(low) * function(high) <= 0:
            return brentq(function, low, high, xtol=1e-15)
        width *= 2
    raise NotConverged("geometry", "the pointing limit", f"brackets up to 1 rad around {guess:.4f} rad")
