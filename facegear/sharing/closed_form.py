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
    idler_push : float
        Force that both meshes of an idler put on its bearing over the force of one, dimensionless: twice the
        cosine of the pressure angle of spur teeth.
    input_push : float
        Half the force on the bearing of an input by the difference of its two mesh forces, over that
        difference, dimensionless.
    idler_meshes : float
        Compliance of both meshes of an idler over that of two meshes with its force, dimensionless.
    """

    inputs: int
    idlers: int
    input_force: float
    mesh_stiffness: float
    backlash: float
    idler_push: float
    input_push: float = 1.0
    idler_meshes: float = 1.0

    def input_k_gamma(self, input_bearing: float, idler_bearing: float) -> float:
        """Compute the mesh load factor of the harder loaded mesh (upper gear) of an input, without errors.

        min(1 + (loop + gap) / (softness + loop), 2) with gap = backlash * mesh stiffness / input force,
        `_loop` and `_softness`. The idlers' compliance and the backlash delay the lower mesh.

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
        """Return the radial stiffness of an input's bearing at which K_gamma is a given one:
        `input_k_gamma` inverted.

        Parameters
        ----------
        k_gamma : float
            Wanted mesh load factor of the harder loaded mesh of an input, above 1, dimensionless.
        idler_bearing : float
            Radial stiffness of the bearing of an idler, N/m.

        Returns
        -------
        float
            N/m. Infinite where even a rigid bearing shares better.
        """
        loop = self._loop(idler_bearing)
        gap = self.backlash * self.mesh_stiffness / self.input_force
        softness = (loop + gap) / (k_gamma - 1.0) - loop
        if softness <= 1.0:
            return float("inf")
        return 2.0 * self.mesh_stiffness * self.input_push**2 / (softness - 1.0)

    def idler_force(self, input_bearing: float, idler_bearing: float) -> float:
        """Return the force of each of the two meshes of an idler, without errors.

        It is the lower mesh force of an input (what `input_k_gamma` leaves) times inputs over idlers.

        Parameters
        ----------
        input_bearing : float
            Radial stiffness of the bearing of an input, N/m.
        idler_bearing : float
            Radial stiffness of the bearing of an idler, N/m.

        Returns
        -------
        float
            Force along the line of action, N.
        """
        lower = 0.5 * self.input_force * (2.0 - self.input_k_gamma(input_bearing, idler_bearing))
        return lower * self.inputs / self.idlers

    def path_stiffness(self, idler_bearing: float) -> float:
        """Return the stiffness k_e of the path through an idler: two meshes and the bearing in series.

        1 / (2 / mesh stiffness + push^2 / bearing stiffness), push that of an idler.

        Parameters
        ----------
        idler_bearing : float
            Radial stiffness of the bearing of an idler, N/m.

        Returns
        -------
        float
            Force between the gears over their approach along the line of action, N/m.
        """
        meshes = 2.0 * self.idler_meshes / self.mesh_stiffness
        return float(1.0 / (meshes + self.idler_push**2 / idler_bearing))

    def _loop(self, idler_bearing: float) -> float:
        """Return the compliance that the idlers add to the loop of an input's two meshes, times the mesh
        stiffness.

        It is inputs/idlers (1 + push^2 k / 2 bearing): misfit over the force of the input's lower mesh,
        dimensionless. `idler_bearing` is the radial stiffness of an idler's bearing, N/m.
        """
        bending = 0.5 * self.mesh_stiffness * self.idler_push**2 / idler_bearing
        return float(self.inputs / self.idlers * (self.idler_meshes + bending))

    def _softness(self, input_bearing: float) -> float:
        """Return 1 + 2 k push^2 / bearing: compliance of an input's mesh with its bearing, over that of the
        mesh alone.

        `input_bearing` is the radial stiffness of an input's bearing, N/m; k is the mesh stiffness.
        """
        return 1.0 + 2.0 * self.mesh_stiffness * self.input_push**2 / input_bearing


def path_forces(total: float, stiffness: float, errors: Array, freedom: float) -> Array:
    """Compute the forces of equal, evenly spaced paths that share a load while all of them stay in contact.

    Each path carries W / N, less k_e times its lateness beyond the mean (Singh 2010). A central member that
    moves in its plane takes up the part of the lateness that goes once around the gear.

    Parameters
    ----------
    total : float
        Sum W of all forces, N.
    stiffness : float
        Stiffness k_e of each path, N/m.
    errors : (..., paths) array
        How late each path is along the line of action, m: a late path carries less. Paths stand evenly
        around the gear, in order of angle.
    freedom : float
        `plane_freedom`: 1 where one of the two central members moves freely in its plane, 0 where both are
        fixed.

    Returns
    -------
    (..., paths) array
        Force of each path, N. Values below 0 mean that the path would lose contact and the formula does
        not hold.
    """
    late = np.asarray(errors, dtype=float)
    count = late.shape[-1]
    angles = 2.0 * np.pi * np.arange(count) / count
    once = freedom * _sideways(count) * np.cos(angles[:, None] - angles)
    coupling = count * np.eye(count) - 1.0 - once
    return np.asarray(total / count - stiffness / count * (late @ coupling))


def plane_freedom(
    paths: int, stiffness: float, bearings: tuple[float, float], pushes: tuple[float, float]
) -> float:
    """Compute which part of a one-sided lateness of the paths the central members' motion in their planes
    takes up.

    Late paths on one side push the two members apart sideways, against both of their bearings in series.
    The result is c / (1 + c), c being the bearings' compliance times the paths' sideways stiffness.

    Parameters
    ----------
    paths : int
        Number of equal paths, at least 2.
    stiffness : float
        Stiffness k_e of each path, N/m.
    bearings : (2,) tuple of float
        Radial stiffness of the bearing of each central member, N/m; 0: it floats.
    pushes : (2,) tuple of float
        Force of a path on each central member square to its axis, over the force of the path, dimensionless:
        the cosine of the pressure angle of spur teeth.

    Returns
    -------
    float
        Dimensionless: 1 where one member floats freely, 0 where both are fixed.
    """
    sideways = paths / _sideways(paths) * stiffness
    compliance = sum(
        sideways * push**2 / bearing if bearing > 0.0 else np.inf
        for bearing, push in zip(bearings, pushes, strict=True)
    )
    return float(1.0 if np.isinf(compliance) else compliance / (1.0 + compliance))


def _sideways(paths: int) -> int:
    """Return the number of directions (1 or 2) in which paths push a member sideways: two paths oppose
    each other and have one.
    """
    return min(paths - 1, 2)


def parting_number(paths: int, floating: bool) -> float:
    """Compute the number X_e = k_e e / W at which a path that alone is late by e loses contact.

    It is 1 / (N - 1), or 1 / (N - 3) with a floating member. e is in m, k_e the path stiffness, W the sum
    of forces.

    Parameters
    ----------
    paths : int
        Number N of equal paths.
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
    """Compute the standard deviation of N times the force of a path over W, for independent errors of the
    paths.

    X sqrt(N (N - 3)) where a member floats, X sqrt(N (N - 1)) where both are fixed; with intermediate
    freedom in between. It holds while all paths carry.

    Parameters
    ----------
    paths : int
        Number N of equal paths.
    number : float
        X = k_e times the standard deviation of the errors over W, dimensionless.
    freedom : float
        `plane_freedom`, dimensionless.

    Returns
    -------
    float
        Standard deviation, dimensionless; an even share is 1.
    """
    left = paths - 1.0 - _sideways(paths) * (1.0 - (1.0 - freedom) ** 2)
    return float(number * np.sqrt(paths * left))


def k_gamma_samples(number: Array | float, draws: Array, freedom: float) -> Array:
    """Compute the load factor of the hardest loaded path for drawn errors, by the closed form.

    It is 1 + c X, where c is N times the largest `path_forces` of the sample's errors at W = 0 and k_e = 1.

    Parameters
    ----------
    number : (...,) array or float
        X = k_e times the standard deviation of the errors over W, dimensionless.
    draws : (samples, paths) array
        Errors (late positive) over their standard deviation, dimensionless.
    freedom : float
        `plane_freedom`, dimensionless.

    Returns
    -------
    (..., samples) array
        Largest force of a path over W / N, for each number and sample. It holds while all paths carry.
    """
    count = draws.shape[1]
    uneven = count * path_forces(0.0, 1.0, draws, freedom).max(axis=1)
    return np.asarray(1.0 + np.multiply.outer(np.asarray(number), uneven))
