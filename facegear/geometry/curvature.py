"""Principal relative curvatures of pinion and face gear where they touch."""

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.geometry import face_gear, pinion
from facegear.geometry.design import PairDesign
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
    return _principal(design, roll, psi, profile, axial, 1 / (base * roll - lift * np.sin(psi)))


def opposite_curvatures(
    design: PairDesign, pinion_roll: ArrayLike, roll: ArrayLike, psi: ArrayLike, to_gear: Array
) -> tuple[Array, Array, Array]:
    """The same in any assembly: pinion point at `pinion_roll` (rad) opposite the gear flank point (th, psi).

    `to_gear` (..., 3, 3) turns directions of the pinion's body frame into those of the gear's flank, see
    `placement.to_left_flank`. Crownings of the gear count; modifications of the pinion, whose curvature is
    far smaller, are left out.
    """
    pinion_roll, roll, psi = np.broadcast_arrays(
        *(np.asarray(part, float) for part in (pinion_roll, roll, psi))
    )
    nx, nz = pinion.involute_normal(design, pinion_roll)
    tangent = np.stack([-nz, np.zeros_like(nx), nx], axis=-1)
    profile = np.einsum("...ij,...j->...i", to_gear, tangent)
    axial = np.broadcast_to(to_gear[..., :, 1], profile.shape)
    across, along = crowned(design, face_gear.flank_point(design, roll, psi))
    added = 1 / (design.pinion_base_radius * pinion_roll) + across * profile[..., 2] ** 2
    return _principal(design, roll, psi, profile, axial, added, along)


def _principal(
    design: PairDesign,
    roll: Array,
    psi: Array,
    profile: Array,
    axial: Array,
    across: Array,
    along: Array | float = 0.0,
) -> tuple[Array, Array, Array]:
    """From the gear's shape operator (exact derivatives) in the directions of the pinion's tangents.

    across, along: curvatures (1/m) in these directions that the gear's nominal flank does not have, the
    pinion's among them.
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
    shape[..., 0, 0] += across
    shape[..., 1, 1] += along
    values, vectors = np.linalg.eigh(shape)
    order = np.argsort(np.abs(values), axis=-1)
    small, large = (np.take_along_axis(values, order[..., i : i + 1], -1)[..., 0] for i in (0, 1))
    line = np.take_along_axis(vectors, order[..., None, :1], -1)[..., 0]
    return large, small, np.arctan(line[..., 0] / line[..., 1])
