"""Relative curvatures of pinion and face gear where they touch, and radii of their fillets."""

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth import face_gear, pinion
from facegear.teeth.design import PairDesign
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.limits import sharpest_fillet_radius
from facegear.teeth.modifications import added_curvatures, derivative
from facegear.teeth.tooth_family import stack_vectors, turn_about_axis
from facegear.teeth.tooth_sides import GearSide, PinionSide


def relative_curvatures(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> tuple[Array, Array, Array]:
    """Compute principal relative curvatures (the pinion's plus the gear's) at a point of the gear flank,
    in the nominal assembly, convex counted positive.

    The pinion's radius of curvature on the same normal is r_b th - lift sin psi: exact for N_s = N1
    everywhere, for N_s > N1 on the contact path, where psi is the pressure angle.

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
    tuple of (...) arrays
        Relative curvature of larger and of smaller magnitude, 1/m, and the angle of the contact line, the
        smaller one's direction, from the pinion's axis, rad.
    """
    roll, psi = np.broadcast_arrays(np.asarray(roll, float), np.asarray(psi, float))
    base, flank = design.shaper_base_radius, gear_flank(design.mirror_family, -1)
    turn = flank.turn(psi, base * roll, design.mean_radius)
    profile = turn_about_axis(turn, stack_vectors(np.sin(psi), 0.0, -np.cos(psi)))
    axial = turn_about_axis(turn, np.broadcast_to([0.0, 1.0, 0.0], profile.shape))
    nominal = 1 / (base * roll - design.shaper_lift * np.sin(psi)), 0.0, 0.0
    return _principal(design, roll, psi, profile, axial, nominal)


def opposite_curvatures(
    design: PairDesign,
    pinion_place: tuple[ArrayLike, ArrayLike],
    roll: ArrayLike,
    psi: ArrayLike,
    to_gear: Array,
) -> tuple[Array, Array, Array]:
    """Compute principal relative curvatures of a pinion point and the opposite gear flank point, in any
    assembly.

    Crownings of the gear and deviations of both count; modifications of the pinion, whose curvature is far
    smaller, are left out.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    pinion_place : tuple of (...) array_like
        Roll (rad) and y (m) on the pinion.
    roll : (...) array_like
        Roll angle th on the gear, rad.
    psi : (...) array_like
        Slope of the normal on the gear, rad.
    to_gear : (..., 3, 3) array
        Rotation from the pinion's body frame to that of the gear's flank, dimensionless, see
        `placement.to_left_flank`.

    Returns
    -------
    tuple of (...) arrays
        As those of `relative_curvatures`: larger, smaller (1/m) and angle of the contact line (rad).
    """
    pinion_roll, y, roll, psi = np.broadcast_arrays(
        *(np.asarray(part, float) for part in (*pinion_place, roll, psi))
    )
    nx, nz = pinion.involute_normal(design, pinion_roll)
    tangent = np.stack([-nz, np.zeros_like(nx), nx], axis=-1)
    profile = np.einsum("...ij,...j->...i", to_gear, tangent)
    axial = np.broadcast_to(to_gear[..., :, 1], profile.shape)
    across, along, twist = added_curvatures(design, face_gear.flank_point(design, roll, psi))
    own_curvatures = _pinion_deviation(design, pinion_roll, y)
    curvature = (
        1 / (design.pinion_base_radius * pinion_roll) + across * profile[..., 2] ** 2 + own_curvatures[0]
    )
    # depth below the gear's tip plane and roll both fall along the profile's tangent
    total_twist = -profile[..., 2] * twist + own_curvatures[2]
    return _principal(design, roll, psi, profile, axial, (curvature, along + own_curvatures[1], total_twist))


def _pinion_deviation(design: PairDesign, roll: Array, y: Array) -> tuple[Array, Array, Array]:
    """Return the curvatures (1/m), convex positive, that deviations of the pinion add at roll (rad) and y
    (m).

    They are across the profile, where its arc grows by r_b th dth, along the axis, and their twist.
    """
    grid, at = design.pinion.flanks.right, pinion.deviation_place(design, roll, y)
    slope = derivative(grid, *at, (0, 1)) / (design.pinion_base_radius * roll**3)
    across = slope - derivative(grid, *at, (0, 2)) / roll**2
    return across, -derivative(grid, *at, (2, 0)), derivative(grid, *at, (1, 1)) / roll


def _principal(
    design: PairDesign,
    roll: Array,
    psi: Array,
    profile: Array,
    axial: Array,
    extra_curvatures: tuple[Array, Array | float, Array | float],
) -> tuple[Array, Array, Array]:
    """Return principal relative curvatures from the gear's shape operator in the pinion's tangent directions.

    profile, axial: these unit tangents (..., 3) in the gear's body frame, across and along the pinion's
    tooth. extra_curvatures: curvatures (1/m) in these directions, and their twist, that the gear's
    nominal flank does not have, the pinion's among them. Results: as of `relative_curvatures`.
    """
    flank, length = gear_flank(design.mirror_family, -1), design.shaper_base_radius * roll
    tangents = np.stack(flank.tangents(psi, length), axis=-1)
    changes = np.stack(flank.normal_tangents(psi, length), axis=-1)
    basis = np.stack([profile, axial], axis=-2)
    shape = (basis @ changes) @ np.linalg.inv(basis @ tangents)
    shape = (shape + np.swapaxes(shape, -1, -2)) / 2
    shape[..., 0, 0] += extra_curvatures[0]
    shape[..., 1, 1] += extra_curvatures[1]
    shape[..., 0, 1] += extra_curvatures[2]
    shape[..., 1, 0] += extra_curvatures[2]
    values, vectors = np.linalg.eigh(shape)
    order = np.argsort(np.abs(values), axis=-1)
    small, large = (np.take_along_axis(values, order[..., i : i + 1], -1)[..., 0] for i in (0, 1))
    line = np.take_along_axis(vectors, order[..., None, :1], -1)[..., 0]
    return large, small, np.arctan(line[..., 0] / line[..., 1])


SAMPLES = 401
"""Points of a section, evenly in its parameter."""
RADII = 9
"""Sections of a gear whose sharpest fillet has no closed form; the ends are sharpest on most faces."""


def smallest_radius(design: PairDesign, body: str) -> float:
    """Compute the smallest radius of curvature of the pinion's fillet section, or of the gear's over its
    face.

    It is taken from sampled points of both sides' fillets; the gear's sections are at both ends and where the
    fillet is sharpest, or evenly over the face of teeth that are not spur.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    body : str
        `pinion` or `face_gear`.

    Returns
    -------
    float
        m.
    """
    families = (design.family,) if design.is_symmetric else (design.family, design.mirror_family)
    parts, radii = np.linspace(0.0, 1.0, SAMPLES), []
    for family in families:
        if body == "pinion":
            ends = design.middle + design.pinion.width / 2 * np.array([-1.0, 1.0])
            planes = ends if design.taper_angle else np.array([design.middle])
            angle, radius = PinionSide(family, planes).fillet_section(parts)
            across, height = radius * np.sin(angle), radius * np.cos(angle)
        else:
            face = design.face_gear.inner_radius, design.face_gear.outer_radius
            sharpest = np.clip(sharpest_fillet_radius(design), *face)
            planes = np.array([*face, sharpest]) if design.is_spur else np.linspace(*face, RADII)
            angle, height = GearSide(family, planes).fillet_section(parts)
            across = planes * angle
        radii += [_sharpest(*plane) for plane in zip(across.T, height.T, strict=True)]
    # points coincide in the corner that a sharp edge leaves at one radius, where there is no number
    return float(np.nanmin(radii))


def _sharpest(x: np.ndarray, z: np.ndarray) -> float:
    """Return the smallest radius of curvature (m) of a plane curve by points x, z (n,), m, its ends left
    out.
    """
    dx, dz = np.gradient(x), np.gradient(z)
    with np.errstate(invalid="ignore"):
        bend = np.abs(dx * np.gradient(dz) - dz * np.gradient(dx)) / np.hypot(dx, dz) ** 3
    return float(1.0 / bend[2:-2].max())
