"""The energy of a mesh in contact over its pose: force, law and reactions come from one function.

Averaged over a mesh cycle, a mesh that is pressed in by x with its unloaded contact at y and an error g of
the shaft angle stores

    U(x, y, g) = max over F of [x F - G(F, y, g)],   G(F, y, g) = integral of F' / k(F', y, g) from 0 to F,

k the average stiffness of the surface. Then F = U_x, U_y = -G_y and U_g = -G_g, the latter at constant F.
With x = x(q) + closing(q), the exact unloaded contact gives the derivatives of x, y and g by all motions q of
the bodies, so that the reactions are -F x_q + G_y y_q + G_g g_q: the load moves the middle of the contact
away from y and turns the force. Below the smallest torque of the surface k goes on as the power of the load
that it has there, as in the contact of single points.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.poses.surface import PoseSurface

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(12)
"""Points and weights of Gauss's rule between two torques of the surface; the integrand is an exponential of a
cubic.
"""


@dataclass(frozen=True)
class MeshEnergy:
    """A mesh at a force (N), all averaged over the mesh cycle.

    Attributes
    ----------
    force
        Along the line of action, N.
    approach
        x, m.
    energy
        U, J.
    by_path
        G_y, J/m.
    by_angle
        G_g, J/rad.
    """

    force: float
    approach: float
    energy: float
    by_path: float
    by_angle: float

    def with_stiffness_factor(self, factor: float) -> "MeshEnergy":
        """Return the energy of teeth that are so many times as stiff, at the same force.

        Parameters
        ----------
        factor : float
            Factor on the stiffness, dimensionless.

        Returns
        -------
        MeshEnergy
            N, m and J.
        """
        scaled_parts = (part / factor for part in (self.approach, self.energy, self.by_path, self.by_angle))
        return MeshEnergy(self.force, *scaled_parts)


def mesh_energy(surface: PoseSurface, torque: float, path: float, angle: float) -> MeshEnergy:
    """Return the energy of a mesh under a torque.

    Parameters
    ----------
    surface : PoseSurface
        Contact over the pose.
    torque : float
        Torque on the pinion, N m.
    path : float
        Unloaded path, m.
    angle : float
        Error of the shaft angle, rad.

    Returns
    -------
    MeshEnergy
        N, m and J; zeros without a torque.
    """
    if torque <= 0.0:
        return MeshEnergy(0.0, 0.0, 0.0, 0.0, 0.0)
    base, knots = surface.pair.pinion_base_radius, np.log(surface.nodes.torques)
    stiffness_logs, last = surface.stiffness_logs(path, angle), float(np.log(torque))
    lightest = min(last, float(knots[0]))
    slope = stiffness_logs @ surface.torque_weights(knots[0], 1)
    logs = stiffness_logs[:, 0] + (lightest - knots[0]) * slope
    parts = _light(lightest, logs, slope)
    if last > knots[0]:
        parts += _above(surface, stiffness_logs, np.append(knots[knots < last], last))
        logs = stiffness_logs @ surface.torque_weights(last)
    complementary, by_path, by_angle = parts / base**2
    force = torque / base
    approach = force / float(np.exp(logs[0]))
    return MeshEnergy(force, approach, force * approach - complementary, float(by_path), float(by_angle))


def linear_energy(surface: PoseSurface, load: float, torque: float, path: float, angle: float) -> MeshEnergy:
    """Return the energy of a mesh whose stiffness does not depend on what it carries.

    Parameters
    ----------
    surface : PoseSurface
        Contact over the pose.
    load : float
        Torque on the pinion at which the stiffness is taken, N m.
    torque : float
        Torque on the pinion, N m.
    path : float
        Unloaded path, m.
    angle : float
        Error of the shaft angle, rad.

    Returns
    -------
    MeshEnergy
        N, m and J.
    """
    log, by_path, by_angle = surface.stiffness_logs(path, angle) @ surface.torque_weights(float(np.log(load)))
    force = torque / surface.pair.pinion_base_radius
    approach = force / float(np.exp(log))
    energy = 0.5 * force * approach
    return MeshEnergy(force, approach, energy, float(-energy * by_path), float(-energy * by_angle))


def _light(last: float, logs: Array, slope: Array) -> Array:
    """Return G and its derivatives (3,), for a base radius of 1 m, of loads up to the logarithm `last` of a
    torque.

    logs, slope (3,): logarithm of the stiffness there and its derivatives by path and angle, and their slopes
    over the logarithm of the torque.
    """
    whole = np.exp(2.0 * last - logs[0]) / (2.0 - slope[0])
    return np.asarray(whole * np.array([1.0, *(slope[1:] / (2.0 - slope[0]) - logs[1:])]))


def _above(surface: PoseSurface, stiffness_logs: Array, ends: Array) -> Array:
    """Return G and its derivatives (3,) of loads from the first to the last of logarithms `ends` of torques,
    between nodes.

    stiffness_logs: as `PoseSurface.stiffness_logs` has it.
    """
    half = 0.5 * np.diff(ends)[:, None]
    at = ends[:-1, None] + half * (POINTS + 1.0)
    log, by_path, by_angle = np.moveaxis(surface.torque_weights(at) @ stiffness_logs.T, -1, 0)
    weights = half * WEIGHTS * np.exp(2.0 * at - log)
    return np.array([weights.sum(), -(weights * by_path).sum(), -(weights * by_angle).sum()])
