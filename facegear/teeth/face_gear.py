"""The face gear's flank that the pinion drives, by roll and slope of its normals.

Everything is for the left flank of tooth 0 in the gear body frame (see `design`), seen in a mirror x -> -x,
where it stands on the right. psi is the slope of the common normal, th the distance along it from the
shaper's base cylinder over the radius of that cylinder: of spur teeth the roll angle of the shaper's
involute. The closed forms are those of `generated_flank`; source of the spur limit: Litvin and Fuentes 2004,
chapter 18. The gear's right flank, as it is, is the one that `placement.mirror_teeth` has here.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.design import PairDesign, as_cut
from facegear.teeth.generated_fillet import gear_fillet
from facegear.teeth.generated_flank import GearFlank, gear_flank

PLACE_STEPS, LARGEST_STEP = 12, 0.2
"""Newton steps, and the largest of them (rad), of a slope that guides a search and need not be exact."""
PLACE_SLOPES = (1e-3, 1.4)
"""Slopes (rad) between which normals of sound flanks lie, for the same."""


def flank_point(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> Array:
    """Compute points of the right flank in the gear's body frame; roll and slope are broadcast together.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    roll : (...) array_like
        Distance th along the normal over the shaper's base radius, rad.
    psi : (...) array_like
        Slope of the normal, rad.

    Returns
    -------
    (..., 3) array
        m.
    """
    return _flank(design).point(psi, design.shaper_base_radius * np.asarray(roll, float))


def flank_normal(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> Array:
    """Compute unit normals of the right flank in the gear's body frame, out of the tooth.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    roll : (...) array_like
        Distance th along the normal over the shaper's base radius, rad.
    psi : (...) array_like
        Slope of the normal, rad.

    Returns
    -------
    (..., 3) array
        Unit vectors, dimensionless.
    """
    return _flank(design).normal(psi, design.shaper_base_radius * np.asarray(roll, float))


def flank_tangents(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> tuple[Array, Array]:
    """Compute the exact derivatives of the position on the flank.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    roll : (...) array_like
        Distance th along the normal over the shaper's base radius, rad.
    psi : (...) array_like
        Slope of the normal, rad.

    Returns
    -------
    tuple of (..., 3) arrays
        Derivatives with respect to th and to psi, m/rad.
    """
    base = design.shaper_base_radius
    by_psi, by_length = _flank(design).tangents(psi, base * np.asarray(roll, float))
    return base * by_length, by_psi


def _flank(design: PairDesign) -> GearFlank:
    """Return the gear's left (drive) flank in the mirror x -> -x as a surface of `generated_flank`."""
    return gear_flank(design.mirror_family, -1)


def tip_height(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute the height of the gear's tip surface, a plane or a cone about its axis.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (...) array
        z, m.
    """
    return design.family.gear_tip.height(radius)


def pitch_depth(design: PairDesign) -> float:
    """Compute how far the gear's datum surface, which the rack's datum plane rolls on, lies below its tip.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        Distance along the gear's axis, m, the same at every radius: the addendum of gears with a flat tip.
    """
    motion = design.family.motion
    return design.face_gear.addendum / (motion.sine - design.family.taper * motion.cosine)


def slope_at_place(design: PairDesign, y: ArrayLike, roll: ArrayLike) -> Array:
    """Find the slope of the normals on which the gear's flank is generated at a place along the pinion.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    y : (...) array_like
        Place along the pinion's axis, m; of spur teeth more than the gear's base radius.
    roll : (...) array_like
        Distance th from the shaper's base cylinder over its radius, rad.

    Returns
    -------
    (...) array
        psi, rad; of spur teeth arccos(m N2 cos a0 / (2 y)).
    """
    flank = _flank(design)
    y, s = np.asarray(y, float), design.shaper_base_radius * np.asarray(roll, float)
    if flank.shaper.sine == 0.0 and flank.motion.cosine == 0.0:
        return np.arccos(design.gear_base_radius / y)
    psi = np.broadcast_to(flank.shaper.pressure_angle, np.broadcast_shapes(y.shape, s.shape))
    for _ in range(PLACE_STEPS):
        lines = flank.lines(psi)
        step = (lines.y + flank.shaper.sine * s - y) / lines.y_slope
        psi = np.clip(psi - np.clip(step, -LARGEST_STEP, LARGEST_STEP), *PLACE_SLOPES)
    return psi


def psi_at(design: PairDesign, radius: ArrayLike, roll: ArrayLike) -> Array:
    """Find the slope psi of the flank point with a given roll on the cylinder of a gear radius, by Newton.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    roll : (...) array_like
        Distance th along the normal over the shaper's base radius, rad.

    Returns
    -------
    (...) array
        rad.

    Raises
    ------
    NotConverged
        Where the cylinder does not cut the flank there.
    """
    return _flank(design).slope_at(radius, design.shaper_base_radius * np.asarray(roll, float))


def roll_and_psi_at_height(design: PairDesign, radius: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
    """Find roll and slope of the flank point at a gear radius and a height z, by Newton's method.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    z : (...) array_like
        Height, m.

    Returns
    -------
    tuple of (...) arrays
        th and psi, rad.

    Raises
    ------
    NotConverged
        Where the cylinder does not cut the flank there.
    """
    psi, length = _flank(design).parameters_at(radius, z)
    return length / design.shaper_base_radius, psi


def end_parameters(design: PairDesign, radius: ArrayLike) -> tuple[Array, Array]:
    """Find roll and slope where the flank ends at the fillet: where the shaper's tip or rounding leaves it.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    tuple of (...) arrays
        th and psi, rad.

    Raises
    ------
    NotConverged
        Where the flank's end does not reach the radius.
    """
    if design.taper_angle == 0.0 and design.is_symmetric:
        psi = psi_at(design, radius, design.shaper_tip_roll)
        return np.full(psi.shape, design.shaper_tip_roll), psi
    fillet = gear_fillet(design.mirror_family, -1)
    y = fillet.y_at(radius, 0.0)
    shaper, base = fillet.shaper, fillet.shaper.base_radius
    centre = fillet.centre_radius + (y - shaper.middle) * fillet.taper
    s = np.sqrt(centre**2 - base**2) / shaper.cosine + fillet.rounding
    return s / base, fillet.generate(y, 0.0).psi


def tip_parameters(design: PairDesign, radius: ArrayLike) -> tuple[Array, Array]:
    """Find roll and slope where the flank meets the tip surface.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    tuple of (...) arrays
        th and psi, rad.

    Raises
    ------
    NotConverged
        Where the flank does not reach the tip surface.
    """
    return roll_and_psi_at_height(design, radius, tip_height(design, radius))


def tip_edge(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute points of the unmodified flank's tip edge, where it meets the tip surface.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (..., 3) array
        m.
    """
    return flank_point(design, *tip_parameters(design, radius))


@dataclass(frozen=True, eq=False)
class TipEdge:
    """The right flank's tip edge, as generated: splines of th and of gear angle from the tooth's middle
    (rad) by gear radius (m).
    """

    roll: "scipy.interpolate.CubicSpline"
    angle: "scipy.interpolate.CubicSpline"


def tip_edge_by_radius(design: PairDesign) -> TipEdge:
    """Return the tip edge of a design; designs with the same gear share it.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    TipEdge
        Splines of th and gear angle (rad) over gear radius (m).
    """
    return _tip_edge_by_radius(as_cut(design))


@lru_cache(maxsize=16)
def _tip_edge_by_radius(design: PairDesign) -> TipEdge:
    """Return cubic splines through 65 exact points of the tip edge of a pair by `as_cut`; cached."""
    gear = design.face_gear
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 65)
    roll, psi = tip_parameters(design, radius)
    point = flank_point(design, roll, psi)
    angle = np.arctan2(point[:, 0], point[:, 1])
    return TipEdge(*(scipy.interpolate.CubicSpline(radius, values) for values in (roll, angle)))


def edge_start(design: PairDesign) -> float:
    """Compute chi_0, the angle about the shaper's axis of its tip rounding's centre from the vertical at
    phi_s = 0.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        rad.
    """
    roll, flank = design.shaper_rounding_roll, design.family.shaper_flanks[0]
    inwards = design.shaper.tip_rounding / (flank.base_radius * flank.cosine)
    return float(design.shaper_half_space_angle + (roll + inwards) - np.arctan(roll))


def cylindrical(radius: ArrayLike, beta: ArrayLike, z: ArrayLike) -> Array:
    """Convert cylindrical coordinates to points of the gear body frame.

    Parameters
    ----------
    radius : (...) array_like
        Gear radius, m.
    beta : (...) array_like
        Gear angle from +y towards +x, rad.
    z : (...) array_like
        Height, m.

    Returns
    -------
    (..., 3) array
        m.
    """
    x, y, z = np.broadcast_arrays(radius * np.sin(beta), radius * np.cos(beta), z)
    return np.stack([x, y, z], axis=-1)
