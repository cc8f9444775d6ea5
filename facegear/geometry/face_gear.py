"""The face gear's flank and fillet in closed form: envelopes of the shaper's involute and of its tip.

Everything is for the right flank of tooth 0 in the gear body frame (see `design`); the left flank its mirror
image x -> -x. th is the roll angle of the shaper's involute, psi = phi_s + th + th_os the slope of the common
normal. Source: shaper-generated face gears (Litvin and Fuentes 2004, chapter 18),
with the contact condition solved for the axial coordinate: q = r_b / (m2s cos psi). A tip rounded about a
centre at R_c, which stands chi from the vertical, generates with the same slope psi where
q = R_c cos(chi - psi) / (m2s cos psi); a sharp tip edge is the rounding of radius zero.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.geometry import closed_forms
from facegear.geometry.design import PairDesign
from facegear.geometry.generated import generated

ROUNDING = 16 * np.finfo(float).eps


def shaper_numbers(design: PairDesign) -> tuple[float, float, float, float]:
    """(r_b, m2s, th_os, lift) of the shaper."""
    return (
        design.shaper_base_radius,
        design.shaper_ratio,
        design.shaper_half_space_angle,
        design.shaper_lift,
    )


def flank_point(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> Array:
    """Points (..., 3) in m at roll th and normal slope psi (rad), broadcast together."""
    return _stacked(*_flank_frame(design, roll, psi)[:3])


def flank_normal(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> Array:
    """Outward unit normals (..., 3)."""
    _, ratio, space, _ = shaper_numbers(design)
    roll, psi = _together(roll, psi)
    return _stacked(*closed_forms.normal(ratio * (psi - roll - space), psi))


def flank_tangents(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> tuple[Array, Array]:
    """Exact derivatives (..., 3) of the position with respect to th and psi (m/rad)."""
    frame = _flank_frame(design, roll, psi)
    return _stacked(*frame[3:6]), _stacked(*frame[6:])


def _flank_frame(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> tuple[Array, ...]:
    return closed_forms.flank_frame(*shaper_numbers(design), *_together(roll, psi))


def _together(first: ArrayLike, second: ArrayLike) -> tuple[Array, Array]:
    both = np.broadcast_arrays(np.asarray(first, float), np.asarray(second, float))
    return both[0], both[1]


def _stacked(x: Array, y: Array, z: Array) -> Array:
    return np.stack([x, y, z], axis=-1)


def local_pressure_angle(design: PairDesign, radius: ArrayLike) -> Array:
    """a_L (rad) with cos a_L = m N2 cos a0 / (2 L) at gear radius L (m)."""
    return np.arccos(design.gear_base_radius / np.asarray(radius, float))


def psi_at(design: PairDesign, radius: ArrayLike, roll: ArrayLike) -> Array:
    """psi (rad) of the flank point with roll th on the cylinder of gear radius `radius` (m).

    Raises NotConverged where the cylinder does not cut the flank there.
    """
    base, ratio, _, _ = shaper_numbers(design)
    radius, roll = _together(radius, roll)

    def residual(psi: Array) -> tuple[Array, Array]:
        return closed_forms.radius_at_roll(base, ratio, radius, roll, psi)

    return _newton(residual, local_pressure_angle(design, radius), radius**2, "psi at a gear radius")


def roll_and_psi_at_height(design: PairDesign, radius: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
    """th and psi (rad) of the flank at gear radius `radius` and height `z` (m).

    Raises NotConverged where the cylinder does not cut the flank there.
    """
    base, ratio, _, lift = shaper_numbers(design)
    radius, z = _together(radius, z)
    height = (lift - z) / base

    def residual(psi: Array) -> tuple[Array, Array]:
        return closed_forms.radius_at_height(base, ratio, radius, height, psi)

    psi = _newton(residual, local_pressure_angle(design, radius), radius**2, "flank at a height")
    return closed_forms.roll_at_height(height, psi), psi


def tip_edge(design: PairDesign, radius: ArrayLike) -> Array:
    """Points (..., 3) of the flank's tip edge at gear radii (m)."""
    return flank_point(design, *roll_and_psi_at_height(design, radius, design.gear_tip_plane))


@dataclass(frozen=True, eq=False)
class TipEdge:
    """The flank's tip edge, as it is generated: th and gear angle (rad) by gear radius (m)."""

    roll: "scipy.interpolate.CubicSpline"
    angle: "scipy.interpolate.CubicSpline"


def tip_edge_by_radius(design: PairDesign) -> TipEdge:
    """That of a design: many that have one gear share it."""
    return _tip_edge_by_radius(generated(design))


@lru_cache(maxsize=16)
def _tip_edge_by_radius(design: PairDesign) -> TipEdge:
    gear = design.face_gear
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 65)
    roll, psi = roll_and_psi_at_height(design, radius, design.gear_tip_plane)
    point = flank_point(design, roll, psi)
    angle = np.arctan2(point[:, 0], point[:, 1])
    return TipEdge(*(scipy.interpolate.CubicSpline(radius, values) for values in (roll, angle)))


def _newton(residual: Callable[[Array], tuple[Array, Array]], near: Array, size: Array, where: str) -> Array:
    """The root near `near` (rad or m) of a difference of numbers of a `size`, exact near a fold before it is.

    Raises NotConverged.
    """
    at = near
    for _ in range(60):
        value, slope = residual(at)
        step = np.clip(value / slope, -0.1, 0.1)
        at = at - step
        if np.all(np.abs(step) < 1e-14):
            return at
        if not np.all(np.isfinite(at)):
            break
    if np.all(np.isfinite(at)) and np.all((np.abs(step) < 1e-12) | (np.abs(value) <= ROUNDING * size)):
        return at
    raise NotConverged("geometry", where, "60 Newton steps")


def edge_start(design: PairDesign) -> float:
    """chi_0 (rad): where the centre of the shaper's tip rounding stands from the vertical at phi_s = 0."""
    roll = design.shaper_rounding_roll
    return float(design.shaper_half_space_angle + design.shaper_tip_roll - np.arctan(roll))


def fillet_section(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> tuple[Array, Array]:
    """Gear angle (rad) and z (m) of the fillet at a gear radius (m) and slope psi (rad) of its normal.

    psi runs from `fillet_start` to pi/2, where the fillet touches the root plane.
    """
    x, y, z = closed_forms.fillet_frame(*tip_numbers(design), psi, fillet_q(design, radius, psi))[:3]
    return np.arctan2(x, y), z


def fillet_q(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """Where (m) along its axis the shaper generates the fillet's point at a gear radius (m) and slope psi."""
    radius, psi = _together(radius, psi)

    def residual(q: Array) -> tuple[Array, Array]:
        x, y, _, _, _, _, x_q, y_q, _ = closed_forms.fillet_frame(*tip_numbers(design), psi, q)
        return x * x + y * y - radius * radius, 2 * (x * x_q + y * y_q)

    return _newton(residual, radius, radius**2, "fillet at a gear radius")


def tip_numbers(design: PairDesign) -> tuple[float, float, float, float, float]:
    """What `closed_forms.fillet_frame` takes of the shaper: centre, rounding, m2s, lift and chi_0."""
    centre, rounding = design.shaper_rounding_centre, design.shaper.tip_rounding
    return centre, rounding, design.shaper_ratio, design.shaper_lift, edge_start(design)


def fillet_start(design: PairDesign, radius: ArrayLike) -> Array:
    """psi (rad) where flank and fillet meet at a gear radius (m)."""
    return psi_at(design, radius, design.shaper_tip_roll)


def fillet_slopes(design: PairDesign, radius: ArrayLike, fraction: ArrayLike) -> Array:
    """psi (rad) at a share of the fillet's turn at a gear radius (m): 0 at the flank, 1 at the root."""
    start = fillet_start(design, radius)
    return start + np.asarray(fraction, float) * (np.pi / 2 - start)


def fillet_fraction(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """The inverse of `fillet_slopes`."""
    start = fillet_start(design, radius)
    return (np.asarray(psi, float) - start) / (np.pi / 2 - start)


def fillet_normal(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """Outward unit normal (..., 3) of the fillet."""
    centre, _, ratio, _, start = tip_numbers(design)
    psi = np.asarray(psi, float)
    chi = psi - np.arccos(ratio * fillet_q(design, radius, psi) * np.cos(psi) / centre)
    return _stacked(*closed_forms.normal(ratio * (chi - start), psi))


def root_half_angle(design: PairDesign) -> float:
    """Gear angle (rad) from the end of the fillet to the middle of the space; negative if they overlap."""
    return np.pi / design.face_gear.teeth - design.shaper_ratio * edge_start(design)


def cylindrical(radius: ArrayLike, beta: ArrayLike, z: ArrayLike) -> Array:
    """Points (..., 3) of the gear body frame from gear radius, gear angle and height."""
    x, y, z = np.broadcast_arrays(radius * np.sin(beta), radius * np.cos(beta), z)
    return np.stack([x, y, z], axis=-1)
