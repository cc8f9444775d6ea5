"""Load sharing of split-torque machines in closed form: idlers between two face gears, and inputs on both.

All meshes have the same constant stiffness and geometric kinematics, all paths carry load on their working
flanks, and the face gears sit on rigid bearings, or one of them floats.

References
----------
Singh 2010 for idlers; docs/explanation/theory.md for the loop through inputs and idlers.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array


@dataclass(frozen=True)
class SplitMachine:
    """Equal inputs and equal idlers between two face gears.

    Attributes
    ----------
    inputs, idlers : int
        Number of pinions of each kind.
    input_force : float
        Torque of an input over its base radius: the sum of its two mesh forces, N.
    mesh_stiffness : float
        Stiffness of every mesh, N/m.
    backlash : float
        Normal backlash of every mesh from flank to flank, m.
    pressure_angle : float
        Pressure angle, rad.
    """

    inputs: int
    idlers: int
    input_force: float
    mesh_stiffness: float
    backlash: float
    pressure_angle: float

    def input_k_gamma(self, input_bearing: float, idler_bearing: float) -> float:
        """Mesh load factor of the harder loaded mesh of an input, without errors.

        Parameters
        ----------
        input_bearing, idler_bearing : float
            Radial stiffness of the bearing of an input and of an idler, N/m.

        Returns
        -------
        float
            Force of the upper mesh over half of `input_force`; 2 where the lower mesh carries nothing.
        """
        loop = self._loop(idler_bearing)
        gap = self.backlash * self.mesh_stiffness / self.input_force
        return float(min(1.0 + (loop + gap) / (self._softness(input_bearing) + loop), 2.0))

    def input_bearing_for(self, k_gamma: float, idler_bearing: float) -> float:
        """Return the radial stiffness of an input's bearing at which an input has a given K_gamma without
        errors.

        Parameters
        ----------
        k_gamma : float
            Mesh load factor of the harder loaded mesh of an input, dimensionless.
        idler_bearing : float
            Radial stiffness of the bearing of an idler, N/m.

        Returns
        -------
        float
            N/m. Infinite where even a rigid bearing shares better, 0 where no bearing is soft enough.
        """
        loop = self._loop(idler_bearing)
        gap = self.backlash * self.mesh_stiffness / self.input_force
        softness = (loop + gap) / (k_gamma - 1.0) - loop
        if softness <= 1.0:
            return float("inf")
        return 2.0 * self.mesh_stiffness / (softness - 1.0)

    def idler_force(self, input_bearing: float, idler_bearing: float) -> float:
        """Return the mean force of each of the two meshes of an idler, without errors.

        Parameters
        ----------
        input_bearing : float
            Radial stiffness of the bearing of an input, N/m.
        idler_bearing : float
            Radial stiffness of the bearing of an idler, N/m.

        Returns
        -------
        float
            N.
        """
        lower = 0.5 * self.input_force * (2.0 - self.input_k_gamma(input_bearing, idler_bearing))
        return lower * self.inputs / self.idlers

    def path_stiffness(self, idler_bearing: float) -> float:
        """Return the stiffness k_e of the path through an idler: two meshes and the bearing in series.

        Parameters
        ----------
        idler_bearing : float
            Radial stiffness of the bearing of an idler, N/m.

        Returns
        -------
        float
            N/m.
        """
        cosine = np.cos(self.pressure_angle)
        return float(1.0 / (2.0 / self.mesh_stiffness + 4.0 * cosine**2 / idler_bearing))

    def _loop(self, idler_bearing: float) -> float:
        """Return the misfit that the idlers add to the loop of an input's two meshes, over the force of its
        lower mesh.
        """
        bending = 2.0 * self.mesh_stiffness * np.cos(self.pressure_angle) ** 2 / idler_bearing
        return float(self.inputs / self.idlers * (1.0 + bending))

    def _softness(self, input_bearing: float) -> float:
        """Return by which factor the bearings of the inputs soften their meshes, dimensionless."""
        return 1.0 + 2.0 * self.mesh_stiffness / input_bearing


def path_forces(total: float, stiffness: float, errors: Array, freedom: float) -> Array:
    """Forces of equal paths that share a load, all of them closed.

    Parameters
    ----------
    total : float
        Sum W of all forces, N.
    stiffness : float
        Stiffness k_e of each path, N/m.
    errors : (..., paths) array
        How late each path is along the line of action, m; the paths stand evenly around the gear.
    freedom : float
        `plane_freedom`: 1 where one of the two central members moves freely in its plane, 0 where both are
        held.

    Returns
    -------
    (..., paths) array
        Force of each path, N.
    """
    late = np.asarray(errors, dtype=float)
    count = late.shape[-1]
    angles = 2.0 * np.pi * np.arange(count) / count
    once = freedom * _sideways(count) * np.cos(angles[:, None] - angles)
    coupling = count * np.eye(count) - 1.0 - once
    return np.asarray(total / count - stiffness / count * (late @ coupling))


def plane_freedom(
    paths: int, stiffness: float, bearings: tuple[float, float], pressure_angle: float
) -> float:
    """Part of a one-sided lateness of the paths that the central members' motion in their planes takes up.

    Late paths on one side push the two members apart sideways, against both of their bearings in series.

    Parameters
    ----------
    paths : int
        Number of equal paths.
    stiffness : float
        Stiffness k_e of each path, N/m.
    bearings : (2,) tuple of float
        Radial stiffness of the bearing of each central member, N/m.
    pressure_angle : float
        Pressure angle, rad.

    Returns
    -------
    float
        Dimensionless: 1 where one member floats freely, 0 where both are held.
    """
    sideways = paths / _sideways(paths) * stiffness * np.cos(pressure_angle) ** 2
    compliance = sum(sideways / bearing if bearing > 0.0 else np.inf for bearing in bearings)
    return float(1.0 if np.isinf(compliance) else compliance / (1.0 + compliance))


def _sideways(paths: int) -> int:
    """Directions in which paths push a member sideways: two, but one where two paths oppose each other."""
    return min(paths - 1, 2)


def parting_number(paths: int, floating: bool) -> float:
    """Number X_e = k_e e / W at which a path that alone is late by e loses contact.

    Parameters
    ----------
    paths : int
        Number of equal paths.
    floating : bool
        Whether one of the two central members moves freely in its plane.

    Returns
    -------
    float
        Dimensionless; infinite where a floating member lets up to three paths share evenly.
    """
    free = paths - (3 if floating else 1)
    return 1.0 / free if free > 0 else float("inf")


def share_deviation(paths: int, number: float, freedom: float) -> float:
    """Standard deviation of paths times the force of a path over W, of independent errors; dimensionless.

    Parameters
    ----------
    paths : int
        Number of equal paths.
    number : float
        X = k_e times the standard deviation of the errors over W, dimensionless.
    freedom : float
        `plane_freedom`, dimensionless.

    Returns
    -------
    float
        X sqrt(N (N - 3)) where a member floats, X sqrt(N (N - 1)) where both are held, while all paths carry.
    """
    left = paths - 1.0 - _sideways(paths) * (1.0 - (1.0 - freedom) ** 2)
    return float(number * np.sqrt(paths * left))


def k_gamma_samples(number: Array | float, draws: Array, freedom: float) -> Array:
    """Load factor of the hardest loaded path for drawn errors, dimensionless.

    Parameters
    ----------
    number : (...,) array or float
        X = k_e times the standard deviation of the errors over W, dimensionless.
    draws : (samples, paths) array
        Errors over their standard deviation, dimensionless.
    freedom : float
        `plane_freedom`, dimensionless.

    Returns
    -------
    (..., samples) array
        1 + c X with c of each sample. It holds while all paths carry.
    """
    count = draws.shape[1]
    uneven = count * path_forces(0.0, 1.0, draws, freedom).max(axis=1)
    return np.asarray(1.0 + np.multiply.outer(np.asarray(number), uneven))
