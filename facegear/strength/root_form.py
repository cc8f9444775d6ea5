"""Form and influence factors of the cylindrical gear standard ISO 6336, for real and virtual spur gears."""

from dataclasses import dataclass
from math import acos, cos, pi, radians, sin, sqrt, tan

from facegear.errors import NotConverged
from facegear.teeth.design import involute


@dataclass(frozen=True)
class SpurGear:
    """One external spur gear cut by a rack, real or virtual.

    teeth: their number, no whole one where the gear is virtual. module (m), pressure_angle (rad) of the rack,
    profile_shift in modules, tip_radius and width in m; rack_addendum (h_fP, from the rack's datum line to
    its tip) and rack_tip_radius (rho_fP) of the cutting rack in modules.
    """

    teeth: float
    module: float
    pressure_angle: float
    profile_shift: float
    tip_radius: float
    width: float
    rack_addendum: float
    rack_tip_radius: float

    @property
    def base_radius(self) -> float:
        """Base radius, m."""
        return 0.5 * self.module * self.teeth * cos(self.pressure_angle)


STRESS_CORRECTION_REFERENCE = 2.0
"""Y_ST: stress correction of the reference gear for which the bending limits hold."""
REFERENCE_NOTCH = 2.5
"""q_sT of the reference gear."""
GRADIENT = 0.2
"""chi*_p (1/mm): relative stress gradient of a smooth, unnotched specimen."""


def elasticity_factor(first: tuple[float, float], second: tuple[float, float]) -> float:
    """Return the elasticity factor Z_E = sqrt(1 / (pi sum((1 - nu^2) / E))) of two bodies (ISO 6336-2).

    Parameters
    ----------
    first, second : tuple of float
        Young's modulus, Pa, and Poisson's ratio of each body.

    Returns
    -------
    float
        Z_E, Pa^0.5.
    """
    soft = sum((1.0 - nu**2) / young for young, nu in (first, second))
    return sqrt(1.0 / (pi * soft))


def contact_ratio_factor(contact_ratio: float, overlap_ratio: float = 0.0) -> float:
    """Return the contact ratio factor Z_epsilon (ISO 6336-2).

    sqrt((4 - contact_ratio) / 3) of spur gears; with a growing overlap ratio its square goes linearly to
    1 / contact_ratio, where it stays from an overlap ratio of 1 on.

    Parameters
    ----------
    contact_ratio : float
        Transverse contact ratio, dimensionless.
    overlap_ratio : float
        Overlap ratio, dimensionless.

    Returns
    -------
    float
        Z_epsilon, dimensionless.
    """
    overlap = min(overlap_ratio, 1.0)
    return sqrt((4.0 - contact_ratio) / 3.0 * (1.0 - overlap) + overlap / contact_ratio)


STEEPEST, DEGREES = radians(30.0), radians(120.0)
"""Helix angle (rad) from which on Y_beta falls no further, and the angle that it is counted in."""


def helix_angle_factors(helix_angle: float, overlap_ratio: float) -> tuple[float, float]:
    """Return the helix angle factors of bending and of pitting (ISO 6336-3:2006, ISO 6336-2:2006).

    Y_beta = 1 - overlap ratio * helix angle / 120 degrees, with an overlap ratio of 1 and a helix angle of 30
    degrees at most. Z_beta = 1 / sqrt(cos(helix angle)).

    Parameters
    ----------
    helix_angle : float
        On the reference cylinder, of either sign, rad.
    overlap_ratio : float
        Overlap ratio, dimensionless.

    Returns
    -------
    tuple[float, float]
        Y_beta and Z_beta, dimensionless.
    """
    bending = 1.0 - min(overlap_ratio, 1.0) * min(abs(helix_angle), STEEPEST) / DEGREES
    return bending, 1.0 / sqrt(cos(helix_angle))


def relative_notch_sensitivity(slip_layer: float, notch_parameter: float) -> float:
    """Return the relative notch sensitivity factor Y_delta rel T for the endurance limit (ISO 6336-3).

    It is n(q_s) / n(REFERENCE_NOTCH) with n(q) = 1 + sqrt(rho' chi*_p (1 + 2 q)), chi*_p = GRADIENT.

    Parameters
    ----------
    slip_layer : float
        Thickness rho' of the slip layer, m.
    notch_parameter : float
        Notch parameter q_s, dimensionless.

    Returns
    -------
    float
        Y_delta rel T, dimensionless.
    """
    thickness = 1e3 * slip_layer
    notch, reference = (
        1.0 + sqrt(thickness * GRADIENT * (1.0 + 2.0 * q)) for q in (notch_parameter, REFERENCE_NOTCH)
    )
    return notch / reference


def relative_surface_factor(roughness: float) -> float:
    """Return the relative surface factor Y_R rel T (ISO 6336-3) of through-hardened and case-carburised
    steel.

    It is 1.674 - 0.529 (Rz + 1)^0.1, Rz in um, and 1.12 below 1 um.

    Parameters
    ----------
    roughness : float
        Roughness Rz, m.

    Returns
    -------
    float
        Y_R rel T, dimensionless.
    """
    rz = 1e6 * roughness
    return 1.12 if rz < 1.0 else 1.674 - 0.529 * (rz + 1.0) ** 0.1


def size_factor(module: float) -> float:
    """Return the size factor Y_X (ISO 6336-3) of case-carburised steel for the bending limit.

    It is 1.05 - 0.01 per mm of module, within 0.8 to 1.

    Parameters
    ----------
    module : float
        Normal module, m.

    Returns
    -------
    float
        Y_X, dimensionless.
    """
    return min(1.0, max(0.8, 1.05 - 10.0 * module))


def mean_stress_factor(ratio: float, mean_stress: float) -> float:
    """Return Y_M, the factor on the endurance limit where the stress swings (ISO 6336-3, annex B).

    Y_M = 1 / (1 - R (1 - M) / (1 + M)) with R the ratio and M the mean stress ratio.

    Parameters
    ----------
    ratio : float
        Smallest over largest stress of a turn, dimensionless; 0 gives 1.
    mean_stress : float
        Mean stress ratio M of the material, dimensionless.

    Returns
    -------
    float
        Y_M, dimensionless.
    """
    slope = (1.0 - mean_stress) / (1.0 + mean_stress)
    return 1.0 / (1.0 - ratio * slope)


ITERATIONS = 200
"""Maximum number of fixed-point iterations for the angle of the 30 degree tangent."""


@dataclass(frozen=True)
class RootForm:
    """Root section of a spur tooth loaded at a radius.

    chord: width s_Fn (m) of the section where the fillet's tangent makes 30 degrees with the tooth's axis.
    lever_arm: bending moment arm h_Fe, m. fillet_radius: radius of curvature rho_F there, m. load_angle:
    alpha_Fen (rad) between the force and the normal of the tooth's axis. form_factor Y_F and
    stress_correction Y_S.
    """

    chord: float
    lever_arm: float
    fillet_radius: float
    load_angle: float
    form_factor: float
    stress_correction: float

    @property
    def notch_parameter(self) -> float:
        """q_s = s_Fn / (2 rho_F)."""
        return self.chord / (2.0 * self.fillet_radius)


def root_form(gear: SpurGear, load_radius: float) -> RootForm:
    """Compute the root section for a force on the flank (ISO 6336-3:2006, clauses 6.2 and 7.2, external spur
    gears).

    Parameters
    ----------
    gear : SpurGear
        The spur gear.
    load_radius : float
        Radius at which the force acts, m.

    Returns
    -------
    RootForm
        Root section.

    Raises
    ------
    NotConverged
        If the angle of the 30 degree tangent is not found.
    """
    m, z, a = gear.module, gear.teeth, gear.pressure_angle
    rho, h = gear.rack_tip_radius, gear.rack_addendum
    e = 0.25 * pi - h * tan(a) - (1.0 - sin(a)) * rho / cos(a)
    g = rho - h + gear.profile_shift
    theta = _tangent_angle(g, 2.0 / z * (0.5 * pi - e) - pi / 3.0, z)
    side = g / cos(theta) - rho
    chord = z * sin(pi / 3.0 - theta) + sqrt(3.0) * side
    fillet = rho + 2.0 * g**2 / (cos(theta) * (z * cos(theta) ** 2 - 2.0 * g))
    tip = acos(gear.base_radius / load_radius)
    half = (0.5 * pi + 2.0 * tan(a) * gear.profile_shift) / z + involute(a) - involute(tip)
    load_angle = tip - half
    reach = (cos(half) - sin(half) * tan(load_angle)) * 2.0 * load_radius / m
    lever = 0.5 * (reach - z * cos(pi / 3.0 - theta) - side)
    form = 6.0 * lever * cos(load_angle) / (chord**2 * cos(a))
    return RootForm(
        chord=m * chord,
        lever_arm=m * lever,
        fillet_radius=m * fillet,
        load_angle=load_angle,
        form_factor=form,
        stress_correction=stress_correction(chord / lever, chord / (2.0 * fillet)),
    )


def stress_correction(slenderness: float, notch_parameter: float) -> float:
    """Return the stress correction factor Y_S (ISO 6336-3), stated for 1 <= q_s < 8.

    Y_S = (1.2 + 0.13 L) q_s^(1 / (1.21 + 2.3 / L)).

    Parameters
    ----------
    slenderness : float
        L = s_Fn / h_Fe, dimensionless.
    notch_parameter : float
        q_s = s_Fn / (2 rho_F), dimensionless.

    Returns
    -------
    float
        Y_S, dimensionless.
    """
    exponent = 1.0 / (1.21 + 2.3 / slenderness)
    return float((1.2 + 0.13 * slenderness) * notch_parameter**exponent)


def _tangent_angle(g: float, h: float, teeth: float) -> float:
    """Solve theta = 2 g tan(theta) / teeth - h of ISO 6336-3 for the angle theta (rad), by fixed-point
    iteration.

    The standard calls g (rho_fP - h_fP + profile shift, in modules) and h (rad) G and H. Raise
    NotConverged after ITERATIONS.
    """
    angle = pi / 6.0
    for _ in range(ITERATIONS):
        next_angle = 2.0 * g / teeth * tan(angle) - h
        if abs(next_angle - angle) < 1e-15:
            return next_angle
        angle = next_angle
    raise NotConverged("strength", f"root form of {teeth:g} teeth", f"{ITERATIONS} iterations")
