"""The face gear's flank and fillet in closed form: envelope of the shaper, and locus of its tip edge.

Everything is for the right flank of tooth 0 in the gear body frame (see `design`); the left flank its mirror
image x -> -x. th is the roll angle of the shaper's involute, psi = phi_s + th + th_os the slope of the common
normal. Source: shaper-generated face gears (Litvin and Fuentes, Gear Geometry and Applied Theory, ch. 18),
with the contact condition solved for the axial coordinate: q = r_b / (m2s cos psi).
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from facegear.errors import NotConverged
from facegear.geometry import closed_forms
from facegear.geometry.design import PairDesign

Array = NDArray[np.float64]

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
    return _stacked(*closed_forms.flank_normal(ratio, space, *_together(roll, psi)))


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


@lru_cache(maxsize=16)
def tip_roll(design: PairDesign) -> "scipy.interpolate.CubicSpline":
    """th (rad) of the flank's tip edge by gear radius (m)."""
    gear = design.face_gear
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 65)
    return scipy.interpolate.CubicSpline(
        radius, roll_and_psi_at_height(design, radius, design.gear_tip_plane)[0]
    )


def _newton(residual: Callable[[Array], tuple[Array, Array]], psi: Array, size: Array, where: str) -> Array:
    """The root near psi of a difference of numbers of a `size`, exact near a fold before psi is."""
    for _ in range(60):
        value, slope = residual(psi)
        step = np.clip(value / slope, -0.1, 0.1)
        psi = psi - step
        if np.all(np.abs(step) < 1e-14):
            return psi
        if not np.all(np.isfinite(psi)):
            break
    if np.all(np.isfinite(psi)) and np.all((np.abs(step) < 1e-12) | (np.abs(value) <= ROUNDING * size)):
        return psi
    raise NotConverged("geometry", where, "60 Newton steps on psi")


def edge_start(design: PairDesign) -> float:
    """chi_0 (rad): where the shaper's tip edge stands from the vertical at phi_s = 0."""
    return design.shaper_half_space_angle + design.shaper_tip_roll - np.arctan(design.shaper_tip_roll)


def fillet_section(design: PairDesign, radius: ArrayLike, chi: ArrayLike) -> tuple[Array, Array]:
    """Gear angle (rad) and z (m) of the fillet at a gear radius (m) and the edge's angle chi (rad).

    chi is taken from the vertical, from `fillet_end` to 0, where the fillet touches the root plane.
    """
    x, y, z = _fillet_frame(design, chi, radius)[:3]
    return np.arctan2(x, y), z


def fillet_end(design: PairDesign, radius: ArrayLike) -> Array:
    """chi (rad) where fillet and flank meet at a gear radius (m)."""
    return psi_at(design, radius, design.shaper_tip_roll) - np.arctan(design.shaper_tip_roll)


def fillet_frame(design: PairDesign, chi: ArrayLike, radius: ArrayLike) -> tuple[Array, Array, Array]:
    """Point (..., 3) of the fillet and its exact derivatives with respect to chi and gear radius."""
    frame = _fillet_frame(design, chi, radius)
    return _stacked(*frame[:3]), _stacked(*frame[3:6]), _stacked(*frame[6:])


def _fillet_frame(design: PairDesign, chi: ArrayLike, radius: ArrayLike) -> tuple[Array, ...]:
    numbers = design.shaper_tip_radius, design.shaper_ratio, design.shaper_lift, edge_start(design)
    return closed_forms.fillet_frame(*numbers, *_together(chi, radius))


def fillet_normal(design: PairDesign, radius: ArrayLike, chi: ArrayLike) -> Array:
    """Outward unit normal (..., 3) of the fillet."""
    _, along_chi, along_radius = fillet_frame(design, chi, radius)
    normal = np.cross(along_chi, along_radius)
    normal *= np.sign(normal[..., 2:3])
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def root_half_angle(design: PairDesign) -> float:
    """Gear angle (rad) from the end of the fillet to the middle of the space; negative if they overlap."""
    return np.pi / design.face_gear.teeth - design.shaper_ratio * edge_start(design)


def cylindrical(radius: ArrayLike, beta: ArrayLike, z: ArrayLike) -> Array:
    """Points (..., 3) of the gear body frame from gear radius, gear angle and height."""
    x, y, z = np.broadcast_arrays(radius * np.sin(beta), radius * np.cos(beta), z)
    return np.stack([x, y, z], axis=-1)
