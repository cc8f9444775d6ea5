"""The face gear's flank and fillet in closed form: envelope of the shaper, and locus of its tip edge.

Everything is for the right flank of tooth 0 in the gear body frame (see `design`); the left flank its mirror
image x -> -x. th is the roll angle of the shaper's involute, psi = phi_s + th + th_os the slope of the common
normal. Source: shaper-generated face gears (Litvin and Fuentes, Gear Geometry and Applied Theory, ch. 18),
with the contact condition solved for the axial coordinate: q = r_b / (m2s cos psi).
"""

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from facegear.errors import NotConverged
from facegear.geometry.design import PairDesign

Array = NDArray[np.float64]


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
    base, ratio, space, lift = shaper_numbers(design)
    roll, psi = np.broadcast_arrays(np.asarray(roll, float), np.asarray(psi, float))
    turn = ratio * (psi - roll - space)
    p = base * (np.sin(psi) - roll * np.cos(psi))
    q = base / (ratio * np.cos(psi))
    x = p * np.cos(turn) - q * np.sin(turn)
    y = p * np.sin(turn) + q * np.cos(turn)
    return np.stack([x, y, lift - base * (np.cos(psi) + roll * np.sin(psi))], axis=-1)


def flank_normal(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> Array:
    """Outward unit normals (..., 3)."""
    _, ratio, space, _ = shaper_numbers(design)
    roll, psi = np.broadcast_arrays(np.asarray(roll, float), np.asarray(psi, float))
    turn = ratio * (psi - roll - space)
    return np.stack([np.cos(psi) * np.cos(turn), np.cos(psi) * np.sin(turn), np.sin(psi)], axis=-1)


def flank_tangents(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> tuple[Array, Array]:
    """Exact derivatives (..., 3) of the position with respect to th and psi (m/rad)."""
    base, ratio, space, _ = shaper_numbers(design)
    roll, psi = np.broadcast_arrays(np.asarray(roll, float), np.asarray(psi, float))
    turn = ratio * (psi - roll - space)
    cos_turn, sin_turn = np.cos(turn), np.sin(turn)
    p = base * (np.sin(psi) - roll * np.cos(psi))
    q = base / (ratio * np.cos(psi))
    across = np.stack([-p * sin_turn - q * cos_turn, p * cos_turn - q * sin_turn, np.zeros_like(p)], axis=-1)
    p_psi, q_psi = base * (np.cos(psi) + roll * np.sin(psi)), q * np.tan(psi)
    along_roll = np.stack([-cos_turn * np.cos(psi), -sin_turn * np.cos(psi), -np.sin(psi)], axis=-1) * base
    along_psi = np.stack(
        [
            p_psi * cos_turn - q_psi * sin_turn,
            p_psi * sin_turn + q_psi * cos_turn,
            base * (np.sin(psi) - roll * np.cos(psi)),
        ],
        axis=-1,
    )
    return along_roll - ratio * across, along_psi + ratio * across


def local_pressure_angle(design: PairDesign, radius: ArrayLike) -> Array:
    """a_L (rad) with cos a_L = m N2 cos a0 / (2 L) at gear radius L (m)."""
    return np.arccos(design.gear_base_radius / np.asarray(radius, float))


def psi_at(design: PairDesign, radius: ArrayLike, roll: ArrayLike) -> Array:
    """psi (rad) of the flank point with roll th on the cylinder of gear radius `radius` (m).

    Raises NotConverged where the cylinder does not cut the flank there.
    """
    base, ratio, _, _ = shaper_numbers(design)
    radius, roll = np.broadcast_arrays(np.asarray(radius, float), np.asarray(roll, float))

    def residual(psi):
        p, q = base * (np.sin(psi) - roll * np.cos(psi)), base / (ratio * np.cos(psi))
        slope = 2 * p * base * (np.cos(psi) + roll * np.sin(psi)) + 2 * q * q * np.tan(psi)
        return p * p + q * q - radius**2, slope

    return _newton(residual, local_pressure_angle(design, radius), "psi at a gear radius")


def roll_and_psi_at_height(design: PairDesign, radius: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
    """th and psi (rad) of the flank at gear radius `radius` and height `z` (m).

    Raises NotConverged where the cylinder does not cut the flank there.
    """
    base, ratio, _, lift = shaper_numbers(design)
    radius, z = np.broadcast_arrays(np.asarray(radius, float), np.asarray(z, float))
    height = (lift - z) / base

    def residual(psi):
        p, q = base * (1 - height * np.cos(psi)) / np.sin(psi), base / (ratio * np.cos(psi))
        p_psi = base * (height - np.cos(psi)) / np.sin(psi) ** 2
        return p * p + q * q - radius**2, 2 * p * p_psi + 2 * q * q * np.tan(psi)

    psi = _newton(residual, local_pressure_angle(design, radius), "flank at a height")
    return (height - np.cos(psi)) / np.sin(psi), psi


def tip_edge(design: PairDesign, radius: ArrayLike) -> Array:
    """Points (..., 3) of the flank's tip edge at gear radii (m)."""
    return flank_point(design, *roll_and_psi_at_height(design, radius, design.gear_tip_plane))


@lru_cache(maxsize=16)
def tip_roll(design: PairDesign) -> CubicSpline:
    """th (rad) of the flank's tip edge by gear radius (m)."""
    gear = design.face_gear
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 65)
    return CubicSpline(radius, roll_and_psi_at_height(design, radius, design.gear_tip_plane)[0])


def _newton(residual, psi: Array, where: str) -> Array:
    for _ in range(60):
        value, slope = residual(psi)
        step = np.clip(value / slope, -0.1, 0.1)
        psi = psi - step
        if np.all(np.abs(step) < 1e-14):
            return psi
        if not np.all(np.isfinite(psi)):
            break
    if np.all(np.isfinite(psi)) and np.all(np.abs(step) < 1e-12):
        return psi
    raise NotConverged("geometry", where, "60 Newton steps on psi")


def edge_start(design: PairDesign) -> float:
    """chi_0 (rad): where the shaper's tip edge stands from the vertical at phi_s = 0."""
    return design.shaper_half_space_angle + design.shaper_tip_roll - np.arctan(design.shaper_tip_roll)


def fillet_section(design: PairDesign, radius: ArrayLike, chi: ArrayLike) -> tuple[Array, Array]:
    """Gear angle (rad) and z (m) of the fillet at a gear radius (m) and the edge's angle chi (rad).

    chi is taken from the vertical, from `fillet_end` to 0, where the fillet touches the root plane.
    """
    chi = np.asarray(chi, float)
    tip, edge = design.shaper_tip_radius, design.shaper_tip_radius * np.sin(chi)
    beta = np.arcsin(edge / np.asarray(radius, float)) - design.shaper_ratio * (chi - edge_start(design))
    return beta, design.shaper_lift - tip * np.cos(chi)


def fillet_end(design: PairDesign, radius: ArrayLike) -> Array:
    """chi (rad) where fillet and flank meet at a gear radius (m)."""
    return psi_at(design, radius, design.shaper_tip_roll) - np.arctan(design.shaper_tip_roll)


def fillet_frame(design: PairDesign, chi: ArrayLike, radius: ArrayLike) -> tuple[Array, Array, Array]:
    """Point (..., 3) of the fillet and its exact derivatives with respect to chi and gear radius."""
    radius, chi = np.broadcast_arrays(np.asarray(radius, float), np.asarray(chi, float))
    tip, ratio = design.shaper_tip_radius, design.shaper_ratio
    edge = tip * np.sin(chi)
    beta, z = fillet_section(design, radius, chi)
    reach = np.sqrt(radius**2 - edge**2)
    beta_chi, beta_radius = tip * np.cos(chi) / reach - ratio, -edge / (radius * reach)
    radial = np.stack([np.sin(beta), np.cos(beta), np.zeros_like(beta)], axis=-1)
    around = np.stack([np.cos(beta), -np.sin(beta), np.zeros_like(beta)], axis=-1) * radius[..., None]
    up = np.stack([np.zeros_like(beta), np.zeros_like(beta), np.ones_like(beta)], axis=-1)
    along_chi = around * beta_chi[..., None] + up * edge[..., None]
    along_radius = radial + around * beta_radius[..., None]
    return radial * radius[..., None] + up * z[..., None], along_chi, along_radius


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
