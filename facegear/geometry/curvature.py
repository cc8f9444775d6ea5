"""Principal relative curvatures of pinion and face gear where they touch."""

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.geometry import face_gear, pinion
from facegear.geometry.design import PairDesign
from facegear.geometry.deviations import derivative
from facegear.geometry.gear_modifications import crowned


def relative_curvatures(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> tuple[Array, Array, Array]:
    """Larger and smaller relative curvature (1/m), and the contact line's slope (rad) to the pinion axis.

    At the gear flank point (th, psi) of the nominal assembly, convex counted positive. The pinion's radius of
    curvature on the same normal is r_b th - lift sin psi: exact for N_s = N1 everywhere, for N_s > N1 on the
    contact path, where psi is the pressure angle.
    """
    roll, psi = np.broadcast_arrays(np.asarray(roll, float), np.asarray(psi, float))
    base, ratio, space, lift = face_gear.shaper_numbers(design)
    turn = ratio * (psi - roll - space)
    c, s = np.cos(turn), np.sin(turn)
    profile = np.stack([np.sin(psi) * c, np.sin(psi) * s, -np.cos(psi)], axis=-1)
    axial = np.stack([-s, c, np.zeros_like(turn)], axis=-1)
    nominal = 1 / (base * roll - lift * np.sin(psi)), 0.0, 0.0
    return _principal(design, roll, psi, profile, axial, nominal)


def opposite_curvatures(
    design: PairDesign,
    pinion_place: tuple[ArrayLike, ArrayLike],
    roll: ArrayLike,
    psi: ArrayLike,
    to_gear: Array,
) -> tuple[Array, Array, Array]:
    """The same in any assembly: pinion point at roll (rad) and y (m) opposite the gear flank point (th, psi).

    `to_gear` (..., 3, 3) turns directions of the pinion's body frame into those of the gear's flank, see
    `placement.to_left_flank`. Crownings of the gear and deviations of both count; modifications of the
    pinion, whose curvature is far smaller, are left out.
    """
    pinion_roll, y, roll, psi = np.broadcast_arrays(
        *(np.asarray(part, float) for part in (*pinion_place, roll, psi))
    )
    nx, nz = pinion.involute_normal(design, pinion_roll)
    tangent = np.stack([-nz, np.zeros_like(nx), nx], axis=-1)
    profile = np.einsum("...ij,...j->...i", to_gear, tangent)
    axial = np.broadcast_to(to_gear[..., :, 1], profile.shape)
    across, along, twist = crowned(design, face_gear.flank_point(design, roll, psi))
    own = _pinion_deviation(design, pinion_roll, y)
    added = 1 / (design.pinion_base_radius * pinion_roll) + across * profile[..., 2] ** 2 + own[0]
    # depth below the gear's tip plane and roll both fall along the profile's tangent
    twisted = -profile[..., 2] * twist + own[2]
    return _principal(design, roll, psi, profile, axial, (added, along + own[1], twisted))


def _pinion_deviation(design: PairDesign, roll: Array, y: Array) -> tuple[Array, Array, Array]:
    """Curvatures (1/m) that deviations of the pinion add, convex positive: across the profile, where its arc
    grows by r_b th dth, along the axis, and their twist.
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
    added: tuple[Array, Array | float, Array | float],
) -> tuple[Array, Array, Array]:
    """From the gear's shape operator (exact derivatives) in the directions of the pinion's tangents.

    added: curvatures (1/m) in these directions, and their twist, that the gear's nominal flank does not have,
    the pinion's among them.
    """
    _, ratio, space, _ = face_gear.shaper_numbers(design)
    turn = ratio * (psi - roll - space)
    c, s = np.cos(turn), np.sin(turn)
    around = np.stack([-np.cos(psi) * s, np.cos(psi) * c, np.zeros_like(turn)], axis=-1)
    normal_psi = np.stack([-np.sin(psi) * c, -np.sin(psi) * s, np.cos(psi)], axis=-1) + ratio * around
    tangents = np.stack(face_gear.flank_tangents(design, roll, psi), axis=-1)
    changes = np.stack([-ratio * around, normal_psi], axis=-1)
    basis = np.stack([profile, axial], axis=-2)
    shape = (basis @ changes) @ np.linalg.inv(basis @ tangents)
    shape = (shape + np.swapaxes(shape, -1, -2)) / 2
    shape[..., 0, 0] += added[0]
    shape[..., 1, 1] += added[1]
    shape[..., 0, 1] += added[2]
    shape[..., 1, 0] += added[2]
    values, vectors = np.linalg.eigh(shape)
    order = np.argsort(np.abs(values), axis=-1)
    small, large = (np.take_along_axis(values, order[..., i : i + 1], -1)[..., 0] for i in (0, 1))
    line = np.take_along_axis(vectors, order[..., None, :1], -1)[..., 0]
    return large, small, np.arctan(line[..., 0] / line[..., 1])
