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

    The pinion's radius of curvature is taken on the same normal: exact for N_s = N1 everywhere, for N_s > N1
    on the contact path, where psi is the pressure angle.

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
        smaller one's direction, from the pinion's generator, rad.
    """
    roll, psi = np.broadcast_arrays(np.asarray(roll, float), np.asarray(psi, float))
    flank, s = gear_flank(design.mirror_family, -1), design.shaper_base_radius * roll
    turn = flank.turn(psi, s, flank.lines(psi).y)
    eta, c, sine = flank.shaper.sine, np.cos(psi), np.sin(psi)
    # radially from the pinion's axis to the normal, and along its generator; the mirror reverses x
    profile = turn_about_axis(turn, stack_vectors(sine, 0.0, -c) @ flank.motion.basis)
    generator = stack_vectors(eta * c, flank.shaper.cosine, eta * sine) @ flank.motion.basis
    axial = turn_about_axis(turn, generator)
    nominal = 1 / (s - design.shaper_lift * sine / flank.shaper.cosine), 0.0, 0.0
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
    profile, axial, slopes = _pinion_directions(design, pinion_roll, y, to_gear)
    across, along, twist = added_curvatures(design, face_gear.flank_point(design, roll, psi))
    own_curvatures = _pinion_deviation(design, pinion_roll, y)
    # changes of gear radius and of depth below its tip per length along profile and generator
    (radial, axial_radial), (depth, axial_depth) = slopes
    length = design.pinion_base_radius * pinion_roll / design.family.pinion_flanks[0].cosine
    curvature = 1 / length + across * depth**2 + own_curvatures[0]
    curvature = curvature + 2 * twist * radial * depth + along * radial**2
    axial_curvature = along * axial_radial**2 + own_curvatures[1]
    axial_curvature = axial_curvature + 2 * twist * axial_radial * axial_depth + across * axial_depth**2
    total_twist = twist * depth * axial_radial + own_curvatures[2]
    total_twist = total_twist + twist * radial * axial_depth + along * radial * axial_radial
    total_twist = total_twist + across * depth * axial_depth
    return _principal(design, roll, psi, profile, axial, (curvature, axial_curvature, total_twist))


def _pinion_directions(
    design: PairDesign, roll: Array, y: Array, to_gear: Array
) -> tuple[Array, Array, tuple[tuple[Array, Array], tuple[Array, Array]]]:
    """Return the pinion's unit tangents (..., 3) across and along its tooth, at roll (rad) and y (m), in the
    gear's body frame, and the slopes of gear radius and of depth below the gear's tip along either tangent.

    The generator is the tangent along the tooth. Slopes are those of the nominal assembly in the plane of
    both axes, but for the depth across the tooth.
    """
    flank, motion = pinion.pinion_flank(design), design.family.motion
    helicoid = flank.helicoid
    psi = flank.slope(helicoid.base_radius * roll, y)
    c, sine = np.cos(psi), np.sin(psi)
    tangent = stack_vectors(sine, 0.0, c)
    generator = stack_vectors(-helicoid.sine * c, helicoid.cosine, helicoid.sine * sine)
    profile, axial = (np.einsum("...ij,...j->...i", to_gear, part) for part in (tangent, generator))
    tip_slope = design.family.gear_tip.slope
    # in mesh psi is the local pressure angle, whatever the turn of the pinion's body
    upright = np.sin(design.transverse_pressure_angle)
    radial = np.cos(design.transverse_pressure_angle) * motion.cosine
    axial_radial = helicoid.cosine * motion.sine + helicoid.sine * upright * motion.cosine
    axial_height = helicoid.sine * upright * motion.sine - helicoid.cosine * motion.cosine
    depths = tip_slope * radial - profile[..., 2], tip_slope * axial_radial - axial_height
    return profile, axial, ((radial, axial_radial), depths)


def _pinion_deviation(design: PairDesign, roll: Array, y: Array) -> tuple[Array, Array, Array]:
    """Return the curvatures (1/m), convex positive, that deviations of the pinion add at roll (rad) and y
    (m).

    They are across the profile, where its arc grows by r_b th dth, along the generator, on which the length
    of roll falls by the sine of the base helix, and their twist.
    """
    grid, at = design.pinion.flanks.right, pinion.deviation_place(design, roll, y)
    helicoid = design.family.pinion_flanks[0]
    eta, c, base = helicoid.sine, helicoid.cosine, helicoid.base_radius
    slope, bend = derivative(grid, *at, (0, 1)), derivative(grid, *at, (0, 2))
    across = slope / (base * roll**3) - bend / roll**2
    along, twist = -derivative(grid, *at, (2, 0)), derivative(grid, *at, (1, 1))
    if eta == 0.0:
        return across, along, twist / roll
    along = c**2 * along + 2 * c * eta * twist - eta**2 * bend
    return across, along, (c * twist - eta * bend) / roll + eta * slope / (base * roll**2)


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
