"""Loss in the mesh from the contact forces and the sliding velocities where they act."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from facegear.arrays import Array, Arrays, Integers, Mask
from facegear.lubrication.kinematics import pinion_pose, slip, spins, surface_normals
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import pinion_angle

Numbers = float | Array


@dataclass(frozen=True, eq=False)
class HatSlip:
    """Force and sliding velocity of every loaded hat of every contact, all (m,) unless stated.

    `torque` (N m on the pinion), `position` 0..1 of a pitch, `tooth` pair, `plane` of the lattice across the
    pinion's axis, `force` (N) along the normal. `point` (m, 3) m and `normal` (m, 3) in the mesh frame.
    `velocity` (m, 3): sliding of the pinion over the gear at 1 rad/s, in m; `normal_velocity` (m,) m: the
    part of the relative velocity along the normal.
    """

    torque: Array
    position: Array
    tooth: Integers
    plane: Integers
    force: Array
    point: Array
    normal: Array
    velocity: Array
    normal_velocity: Array

    @property
    def sliding(self) -> Array:
        """Magnitude (m,) of the sliding velocity of each hat at 1 rad/s of the pinion, m."""
        return np.linalg.norm(self.velocity, axis=-1)


def hat_slip(design: PairDesign, arrays: Arrays) -> HatSlip:
    """Collect the forces of stored contacts at their nodes, with the sliding velocities there.

    Each loaded node of the pinion's lattice is a hat (basis function of the contact force). Its force
    carries the whole torque with the others; the smoothed line loads carry 1 to 2 % less.

    Parameters
    ----------
    design : PairDesign
        Geometry of the pair.
    arrays : Arrays
        Arrays PRESSURE_ARRAYS of `facegear.contact.pattern`; one entry a loaded node, torque and position.

    Returns
    -------
    HatSlip
        Forces (N) and velocities at 1 rad/s of the pinion (m), in the mesh frame, of m hats.
    """
    node, tooth, position = arrays["node"], arrays["tooth"], arrays["position"]
    nodes = arrays["point_m"]
    normals = surface_normals(design, nodes)
    stages, of = np.unique(np.stack([position, tooth], axis=1), axis=0, return_inverse=True)
    motions = pinion_pose(design, pinion_angle(design, stages[:, 0]), stages[:, 1])
    matrix, shift = motions.matrix[of.ravel()], motions.shift[of.ravel()]
    point = np.einsum("mij,mj->mi", matrix, nodes[node]) + shift
    normal = np.einsum("mij,mj->mi", matrix, normals[node])
    velocity, normal_velocity = slip(*spins(design), point, normal)
    return HatSlip(
        torque=arrays["torque_n_m"],
        position=position,
        tooth=tooth,
        plane=node % int(arrays["shape"][1]),
        force=arrays["force_n"],
        point=point,
        normal=normal,
        velocity=velocity,
        normal_velocity=normal_velocity,
    )


@dataclass(frozen=True, eq=False)
class LossFactors:
    """H_V at t torques (N m) and p positions of a pitch, `at` (t, p): loss over mu T w."""

    torques: Array
    positions: Array
    at: Array

    @property
    def mean(self) -> Array:
        """Loss factor of each torque (t,), the mean over the evenly spaced positions of a pitch."""
        return self.at.mean(axis=1)


def loss_factors(hats: HatSlip) -> LossFactors:
    """Compute the loss factor H_V = sum of f abs(v) / (T w) over the hats at each torque and position.

    The loss of the mesh is then mu H_V T w at a constant friction coefficient mu, with the pinion's
    torque T and speed w.

    Parameters
    ----------
    hats : HatSlip
        Normal forces f (N) and sliding velocities v at w = 1 rad/s (m).

    Returns
    -------
    LossFactors
        Loss factors (t, p), torques and positions rising.
    """
    torques, row = np.unique(hats.torque, return_inverse=True)
    positions, column = np.unique(hats.position, return_inverse=True)
    sums = np.zeros((torques.size, positions.size))
    np.add.at(sums, (row, column), hats.force * hats.sliding)
    return LossFactors(torques, positions, sums / torques[:, None])


@dataclass(frozen=True, eq=False)
class OverTorque:
    """Quantity known at t torques (N m), between them monotone in the logarithm of the torque.

    `values` (t,), or (t, ...) of many quantities. Outside the torques each keeps the value of the nearest;
    `within` says where it is known.
    """

    torques: Array
    values: Array

    def at(self, torque: Numbers) -> Array:
        """Interpolate the quantity at other torques: monotone cubics (PCHIP) in the logarithm of the
        torque.

        Parameters
        ----------
        torque : Numbers
            Torques of any shape, N m. Their magnitude counts; outside the known torques, and so at 0, the
            value at the nearest one is kept.

        Returns
        -------
        (torques..., ...) array
            Values in their own unit, the shape of the torques first.
        """
        clipped_torque = np.clip(np.abs(np.asarray(torque, float)), self.torques[0], self.torques[-1])
        if self.torques.size == 1:
            return np.broadcast_to(self.values[0], (*clipped_torque.shape, *self.values.shape[1:]))
        return PchipInterpolator(np.log(self.torques), self.values)(np.log(clipped_torque))

    def within(self, torque: Numbers) -> Mask:
        """Whether magnitudes of torques lie between the smallest and the largest of `torques`, ends included.

        Parameters
        ----------
        torque : Numbers
            Torques of any shape and sign, N m.

        Returns
        -------
        (torques...) array of bool
            True where the quantity is known, False where `at` keeps the value of the nearest torque.
        """
        size = np.abs(np.asarray(torque, float))
        return (size >= self.torques[0] * (1 - 1e-12)) & (size <= self.torques[-1] * (1 + 1e-12))


def monotone_at(nodes: Array, values: Array, at: Array) -> Array:
    """Interpolate n tables, each at one point, by monotone cubics (Fritsch and Butland 1984).

    It gives the numbers of SciPy's PchipInterpolator, whose set-up for every call takes longer than all
    else that a sample of tolerances needs for its friction.

    Parameters
    ----------
    nodes : (t,) array
        Rising nodes, t > 1, any unit.
    values : (..., n, t) array
        Tables over the nodes, any unit.
    at : (n,) array
        Point of each table within the nodes, in the unit of the nodes.

    Returns
    -------
    (..., n) array
        Values in the unit of the tables.
    """
    steps = np.diff(nodes)
    rises = np.diff(values) / steps
    slopes = _slopes(steps, rises)
    left = np.clip(np.searchsorted(nodes, at, side="right") - 1, 0, steps.size - 1)
    columns = np.arange(at.size)
    step, part = steps[left], (at - nodes[left]) / steps[left]
    first, last = (values[..., columns, left + offset] for offset in (0, 1))
    left_slope, right_slope = (step * slopes[..., columns, left + offset] for offset in (0, 1))
    back = 1.0 - part
    start = back**2 * ((1.0 + 2.0 * part) * first + part * left_slope)
    return start + part**2 * ((3.0 - 2.0 * part) * last - back * right_slope)


def _slopes(steps: Array, rises: Array) -> Array:
    """Return the slopes (..., t) of the monotone interpolant at its t nodes.

    `steps` (t - 1,) are the distances of the nodes, `rises` (..., t - 1) the slopes of the chords.
    Inside, the slope is the weighted harmonic mean of both chords, 0 where they differ in sign; with two
    nodes it is the chord's.
    """
    slopes = np.zeros((*rises.shape[:-1], steps.size + 1))
    if steps.size == 1:
        slopes[...] = rises
        return slopes
    before, after = rises[..., :-1], rises[..., 1:]
    weights = 2 * steps[1:] + steps[:-1], steps[1:] + 2 * steps[:-1]
    same_sign = before * after > 0.0
    safe = np.where(same_sign, before, 1.0), np.where(same_sign, after, 1.0)
    means = (weights[0] + weights[1]) / (weights[0] / safe[0] + weights[1] / safe[1])
    slopes[..., 1:-1] = np.where(same_sign, means, 0.0)
    slopes[..., 0] = _end(steps[0], steps[1], rises[..., 0], rises[..., 1])
    slopes[..., -1] = _end(steps[-1], steps[-2], rises[..., -1], rises[..., -2])
    return slopes


def _end(step: float, beside: float, rise: Array, rise_beside: Array) -> Array:
    """Return the slope at an end node from a parabola through three points, limited so that the curve is
    monotone.

    `step` and `rise` are distance and slope of the chord at the end, `beside` and `rise_beside`
    those of the next chord.
    """
    slope = ((2 * step + beside) * rise - step * rise_beside) / (step + beside)
    overshoots = (np.sign(rise) != np.sign(rise_beside)) & (np.abs(slope) > 3 * np.abs(rise))
    return np.where(np.sign(slope) != np.sign(rise), 0.0, np.where(overshoots, 3 * rise, slope))
