"""Tooth form and stress correction of a spur gear's root after ISO 6336-3, method B."""

from dataclasses import dataclass
from math import acos, cos, pi, sin, sqrt, tan

from facegear.errors import NotConverged
from facegear.geometry.design import involute
from facegear.strength.spur import SpurGear

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
    """Return Y_S, stated for 1 <= q_s < 8.

    Parameters
    ----------
    slenderness : float
        L = s_Fn / h_Fe, dimensionless.
    notch_parameter : float
        q_s, dimensionless.

    Returns
    -------
    float
        Y_S, dimensionless.
    """
    exponent = 1.0 / (1.21 + 2.3 / slenderness)
    return float((1.2 + 0.13 * slenderness) * notch_parameter**exponent)


def _tangent_angle(g: float, h: float, teeth: int) -> float:
    angle = pi / 6.0
    for _ in range(ITERATIONS):
        next_angle = 2.0 * g / teeth * tan(angle) - h
        if abs(next_angle - angle) < 1e-15:
            return next_angle
        angle = next_angle
    raise NotConverged("strength", f"root form of {teeth} teeth", f"{ITERATIONS} iterations")
