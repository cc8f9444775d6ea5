"""Loss in the mesh from the contact forces and the sliding velocities where they act."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from facegear.arrays import Array, Arrays, Integers, Mask
from facegear.geometry.design import PairDesign
from facegear.geometry.placement import pinion_angle
from facegear.lubrication.kinematics import slip, spins, standing, surface_normals

Numbers = float | Array


@dataclass(frozen=True, eq=False)
class HatSlip:
    """Every loaded hat of every contact, all (m,) unless stated.

    `torque` (N m on the pinion), `position` 0..1 of a pitch, `tooth` pair, `plane` of the lattice across the
    pinion's axis, `force` (N) along the normal. `point` (m, 3) m and `normal` (m, 3) in the mesh frame.
    `velocity` (m, 3): sliding of the pinion over the gear at 1 rad/s, in m; `closing` (m,) m: the part of
    the relative velocity along the normal.
    """

    torque: Array
    position: Array
    tooth: Integers
    plane: Integers
    force: Array
    point: Array
    normal: Array
    velocity: Array
    closing: Array

    @property
    def sliding(self) -> Array:
        """Magnitude of the sliding velocity at 1 rad/s, (m,), m."""
        return np.linalg.norm(self.velocity, axis=-1)


def hat_slip(design: PairDesign, arrays: Arrays) -> HatSlip:
    """Of the forces in arrays as PRESSURE_ARRAYS (see `facegear.contact.columns`).

    The forces carry the whole torque; the smoothed line loads carry 1 to 2 % less.
    """
    node, tooth, position = arrays["node"], arrays["tooth"], arrays["position"]
    nodes = arrays["point_m"]
    normals = surface_normals(design, nodes)
    stages, of = np.unique(np.stack([position, tooth], axis=1), axis=0, return_inverse=True)
    motions = standing(design, pinion_angle(design, stages[:, 0]), stages[:, 1])
    matrix, shift = motions.matrix[of.ravel()], motions.shift[of.ravel()]
    point = np.einsum("mij,mj->mi", matrix, nodes[node]) + shift
    normal = np.einsum("mij,mj->mi", matrix, normals[node])
    velocity, closing = slip(*spins(design), point, normal)
    return HatSlip(
        torque=arrays["torque_n_m"],
        position=position,
        tooth=tooth,
        plane=node % int(arrays["shape"][1]),
        force=arrays["force_n"],
        point=point,
        normal=normal,
        velocity=velocity,
        closing=closing,
    )


@dataclass(frozen=True, eq=False)
class LossFactors:
    """H_V at t torques (N m) and p positions of a pitch, `at` (t, p): loss over mu T w."""

    torques: Array
    positions: Array
    at: Array

    @property
    def mean(self) -> Array:
        """Over the positions of a pitch, which are spread evenly, (t,)."""
        return self.at.mean(axis=1)


def loss_factors(hats: HatSlip) -> LossFactors:
    """Sum of `f |v| / (T w)` of every contact."""
    torques, row = np.unique(hats.torque, return_inverse=True)
    positions, column = np.unique(hats.position, return_inverse=True)
    summed = np.zeros((torques.size, positions.size))
    np.add.at(summed, (row, column), hats.force * hats.sliding)
    return LossFactors(torques, positions, summed / torques[:, None])


@dataclass(frozen=True, eq=False)
class OverTorque:
    """A quantity known at t torques (N m), between them monotone in the logarithm of the torque.

    `values` (t,), or (t, ...) of many quantities. Outside the torques each keeps the value of the nearest;
    `within` says where it is known.
    """

    torques: Array
    values: Array

    def at(self, torque: Numbers) -> Array:
        """Values at torques of any shape, that shape first; a torque of 0 counts as the smallest."""
        asked = np.clip(np.abs(np.asarray(torque, float)), self.torques[0], self.torques[-1])
        if self.torques.size == 1:
            return np.broadcast_to(self.values[0], (*asked.shape, *self.values.shape[1:]))
        return PchipInterpolator(np.log(self.torques), self.values)(np.log(asked))

    def within(self, torque: Numbers) -> Mask:
        """Whether torques of any shape lie between the smallest and the largest."""
        asked = np.abs(np.asarray(torque, float))
        return (asked >= self.torques[0] * (1 - 1e-12)) & (asked <= self.torques[-1] * (1 + 1e-12))
