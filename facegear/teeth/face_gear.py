"""The face gear's flank that the pinion drives, in the terms of the shaper's roll angle.

Everything is for the left flank of tooth 0 in the gear body frame (see `design`), seen in a mirror x -> -x,
where it stands on the right. th is the roll angle of the shaper's involute, psi = phi_s + th + th_os the
slope of the common normal. The closed forms are those of `generated_flank`; source of the spur limit: Litvin
and Fuentes 2004, chapter 18.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.design import PairDesign, as_cut
from facegear.teeth.generated_flank import GearFlank, gear_flank


def shaper_numbers(design: PairDesign) -> tuple[float, float, float, float]:
    """Return the four numbers of the shaper that the kernel of rays takes.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    tuple[float, float, float, float]
        Base radius r_b (m), ratio m2s, half space angle th_os (rad) and lift (m).
    """
    return (
        design.shaper_base_radius,
        design.shaper_ratio,
        design.shaper_half_space_angle,
        design.shaper_lift,
    )


def flank_point(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> Array:
    """Compute points of the right flank in the gear's body frame; roll and slope are broadcast together.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    roll : (...) array_like
        Roll angle th, rad.
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
        Roll angle th, rad.
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
        Roll angle th, rad.
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


def local_pressure_angle(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute the local pressure angle a_L with cos a_L = m N2 cos a0 / (2 L).

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius L, m.

    Returns
    -------
    (...) array
        rad.
    """
    return np.arccos(design.gear_base_radius / np.asarray(radius, float))


def psi_at(design: PairDesign, radius: ArrayLike, roll: ArrayLike) -> Array:
    """Find the slope psi of the flank point with a given roll on the cylinder of a gear radius, by Newton.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    roll : (...) array_like
        Roll angle th, rad.

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


def tip_edge(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute points of the unmodified flank's tip edge, where it meets the tip plane.

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
    return flank_point(design, *roll_and_psi_at_height(design, radius, design.gear_tip_plane))


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
    roll, psi = roll_and_psi_at_height(design, radius, design.gear_tip_plane)
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
    roll = design.shaper_rounding_roll
    return float(design.shaper_half_space_angle + design.shaper_tip_roll - np.arctan(roll))


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
