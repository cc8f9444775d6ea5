"""The face gear's fillet beside its drive flank, by gear radius and slope of the normal; and its root land.

Everything is for the left side of tooth 0 in the mirror of `face_gear`, where it stands on the right. psi is
the slope of the normal in the shaper's transverse section, see `generated_fillet`; a sharp tip edge is a
rounding of radius zero. The root land is what the shaper's tip surface leaves: a plane or cone about the
gear's axis, or with an offset a curved surface about it.
"""

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.design import PairDesign
from facegear.teeth.face_gear import edge_start, end_parameters
from facegear.teeth.generated_fillet import FilletPoints, gear_fillet
from facegear.teeth.placement import mirror_teeth
from facegear.teeth.tooth_family import turn_about_axis


def fillet_section(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> tuple[Array, Array]:
    """Find gear angle and height of the right side's fillet on a cylinder, by Newton's method.

    psi runs from `fillet_start` to `fillet_end`, where the fillet touches the root land.

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
    return end_parameters(design, radius)[1]


def fillet_end(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute the slope psi where the fillet touches the root land.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (...) array
        rad; pi/2 of spur teeth.
    """
    if design.is_spur:
        return np.full(np.shape(radius), np.pi / 2)
    return _lowest(design, radius).psi


def _lowest(design: PairDesign, radius: ArrayLike) -> FilletPoints:
    """Return the lowest points of the fillet at gear radii (...), m."""
    fillet = gear_fillet(design.mirror_family, -1)
    y = fillet.y_at(radius, 1.0)
    return fillet.generate(y, fillet.last_angle(y))


def root_edge(design: PairDesign, radius: ArrayLike) -> tuple[Array, Array]:
    """Compute where the fillet on the right side touches the root land.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    tuple of (...) arrays
        Gear angle from the tooth's middle, rad, and height of the root land, m.
    """
    if design.is_spur:
        angle = design.shaper_ratio * edge_start(design)
        shape = np.shape(radius)
        return np.full(shape, angle), np.full(shape, design.family.lift - design.shaper_tip_radius)
    points = _lowest(design, radius)
    position = turn_about_axis(points.turn, points.position)
    return np.arctan2(position[..., 0], position[..., 1]), position[..., 2]


def root_height(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute the height of the gear's root land, which the shaper's tip generates.

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
    return root_edge(design, radius)[1]


def back_height(design: PairDesign) -> float:
    """Compute the height of the flat back of the gear's rim: its thickness below the lowest place of the
    root.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        z, m.
    """
    gear = design.face_gear
    roots = root_height(design, np.array([gear.inner_radius, gear.outer_radius]))
    return float(roots.min()) - gear.rim_thickness


def root_land_middle(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute the gear angle of the middle of the root land on the right side of the tooth.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (...) array
        rad; pi / N2 of symmetric teeth.
    """
    half_pitch = np.pi / design.face_gear.teeth
    if design.is_symmetric:
        return np.full(np.shape(radius), half_pitch)
    first, last = root_edge(design, radius)[0], root_edge(mirror_teeth(design), radius)[0]
    return half_pitch + (first - last) / 2


def fillet_slopes(design: PairDesign, radius: ArrayLike, fraction: ArrayLike) -> Array:
    """Compute the slope psi at a fraction of the way from `fillet_start` to `fillet_end`.

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
    return start + np.asarray(fraction, float) * (fillet_end(design, radius) - start)


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
    return (np.asarray(psi, float) - start) / (fillet_end(design, radius) - start)


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


def root_half_angle(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute the gear angle from the end of the fillet to the middle of the space.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (...) array
        rad; negative if the fillets overlap.
    """
    return root_land_middle(design, radius) - root_edge(design, radius)[0]
