"""Principal relative curvatures of pinion and face gear where they touch in the nominal assembly."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.geometry import face_gear
from facegear.geometry.design import PairDesign

Array = NDArray[np.float64]


def relative_curvatures(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> tuple[Array, Array, Array]:
    """Larger and smaller relative curvature (1/m), and the contact line's slope (rad) to the pinion axis.

    At the gear flank point (th, psi), convex counted positive. The pinion's radius of curvature on the same
    normal is r_b th - lift sin psi: exact for N_s = N1 everywhere, for N_s > N1 on the contact path, where
    psi is the pressure angle.
    The gear's shape operator comes from the exact derivatives of position and normal.
    """
    roll, psi = np.broadcast_arrays(np.asarray(roll, float), np.asarray(psi, float))
    base, ratio, space, lift = face_gear.shaper_numbers(design)
    turn = ratio * (psi - roll - space)
    c, s = np.cos(turn), np.sin(turn)
    zero = np.zeros_like(turn)
    profile = np.stack([np.sin(psi) * c, np.sin(psi) * s, -np.cos(psi)], axis=-1)
    axial = np.stack([-s, c, zero], axis=-1)

    around = np.stack([-np.cos(psi) * s, np.cos(psi) * c, zero], axis=-1)
    normal_psi = np.stack([-np.sin(psi) * c, -np.sin(psi) * s, np.cos(psi)], axis=-1) + ratio * around
    tangents = np.stack(face_gear.flank_tangents(design, roll, psi), axis=-1)
    changes = np.stack([-ratio * around, normal_psi], axis=-1)
    basis = np.stack([profile, axial], axis=-2)
    shape = (basis @ changes) @ np.linalg.inv(basis @ tangents)
    shape = (shape + np.swapaxes(shape, -1, -2)) / 2
    shape[..., 0, 0] += 1 / (base * roll - lift * np.sin(psi))
    values, vectors = np.linalg.eigh(shape)
    order = np.argsort(np.abs(values), axis=-1)
    small, large = (np.take_along_axis(values, order[..., i : i + 1], -1)[..., 0] for i in (0, 1))
    line = np.take_along_axis(vectors, order[..., None, :1], -1)[..., 0]
    return large, small, np.arctan(line[..., 0] / line[..., 1])
