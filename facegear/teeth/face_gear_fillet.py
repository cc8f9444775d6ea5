"""The spur face gear's fillet: that of the family, by gear radius and slope of the normal.

A tip rounded about a centre that stands chi from the vertical generates with the slope psi where both fit the
equation of meshing, see `generated_fillet`; a sharp tip edge is the rounding of radius zero.
"""

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.design import PairDesign
from facegear.teeth.face_gear import edge_start, psi_at
from facegear.teeth.generated_fillet import gear_fillet
from facegear.teeth.tooth_family import turn_about_axis


def fillet_section(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> tuple[Array, Array]:
    """Find gear angle and height of the right side's fillet on a cylinder, by Newton's method.

    psi runs from `fillet_start` to pi/2, where the fillet touches the root plane.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    psi : (...) array_like
        Slope of the fillet's normal, rad.

    Returns
    -------
    tuple of (...) arrays
        Gear angle from the tooth's middle, rad, and z, m.
    """
    points = gear_fillet(design.mirror_family, -1).at_slope(radius, psi)
    position = turn_about_axis(points.turn, points.position)
    return np.arctan2(position[..., 0], position[..., 1]), position[..., 2]


def tip_numbers(design: PairDesign) -> tuple[float, float, float, float, float]:
    """Return the numbers of the shaper's tip that the kernels of rays take.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    tuple[float, float, float, float, float]
        Radius of the rounding's centre (m), rounding (m), ratio m2s, lift (m) and chi_0 (rad, `edge_start`).
    """
    centre, rounding = design.shaper_rounding_centre, design.shaper.tip_rounding
    return centre, rounding, design.shaper_ratio, design.shaper_lift, edge_start(design)


def fillet_start(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute the slope psi where flank and fillet meet.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (...) array
        rad.
    """
    return psi_at(design, radius, design.shaper_tip_roll)


def fillet_slopes(design: PairDesign, radius: ArrayLike, fraction: ArrayLike) -> Array:
    """Compute the slope psi at a fraction of the way from `fillet_start` to pi/2.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    fraction : (...) array_like
        Fraction, 0 at the flank, 1 at the root.

    Returns
    -------
    (...) array
        rad.
    """
    start = fillet_start(design, radius)
    return start + np.asarray(fraction, float) * (np.pi / 2 - start)


def fillet_fraction(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """Compute the fraction of the fillet's turn at a slope, the inverse of `fillet_slopes`.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    psi : (...) array_like
        Slope of the fillet's normal, rad.

    Returns
    -------
    (...) array
        Fraction, 0 at the flank, 1 at the root.
    """
    start = fillet_start(design, radius)
    return (np.asarray(psi, float) - start) / (np.pi / 2 - start)


def fillet_normal(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """Compute unit normals of the right side's fillet in the gear's body frame, out of the material.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    psi : (...) array_like
        Slope of the fillet's normal, rad.

    Returns
    -------
    (..., 3) array
        Unit vectors, dimensionless.
    """
    points = gear_fillet(design.mirror_family, -1).at_slope(radius, psi)
    return -turn_about_axis(points.turn, points.normal)


def root_half_angle(design: PairDesign) -> float:
    """Compute the gear angle from the end of the fillet to the middle of the space.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        rad; negative if the fillets overlap.
    """
    return np.pi / design.face_gear.teeth - design.shaper_ratio * edge_start(design)
