"""Load sharing of split-torque machines in closed form: idlers between two face gears, and inputs on both.

All meshes have the same constant stiffness and geometric kinematics, all paths carry load on their working
flanks, and the face gears sit on rigid bearings, or one of them floats.

References
----------
A. Singh, "Load sharing behavior in epicyclic gears: physical explanation and generalized formulation",
Mechanism and Machine Theory 45 (2010); docs/theory.md for the loop through inputs and idlers.
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
        """Radial stiffness of an input's bearing, N/m, at which an input has this K_gamma without errors.

        Infinite where even a rigid bearing shares better, 0 where no bearing is soft enough.
        """
        loop = self._loop(idler_bearing)
        gap = self.backlash * self.mesh_stiffness / self.input_force
        softness = (loop + gap) / (k_gamma - 1.0) - loop
        if softness <= 1.0:
            return float("inf")
        return 2.0 * self.mesh_stiffness / (softness - 1.0)

    def idler_force(self, input_bearing: float, idler_bearing: float) -> float:
        """Mean force of each of the two meshes of an idler, N, without errors."""
        lower = 0.5 * self.input_force * (2.0 - self.input_k_gamma(input_bearing, idler_bearing))
        return lower * self.inputs / self.idlers

    def path_stiffness(self, idler_bearing: float) -> float:
        """Stiffness k_e of the path through an idler, N/m: two meshes and the bearing in series."""
        cosine = np.cos(self.pressure_angle)
        return float(1.0 / (2.0 / self.mesh_stiffness + 4.0 * cosine**2 / idler_bearing))

    def _loop(self, idler_bearing: float) -> float:
        """Misfit that the idlers add to the loop, over the force of an input's lower mesh."""
        bending = 2.0 * self.mesh_stiffness * np.cos(self.pressure_angle) ** 2 / idler_bearing
        return float(self.inputs / self.idlers * (1.0 + bending))

    def _softness(self, input_bearing: float) -> float:
        return 1.0 + 2.0 * self.mesh_stiffness / input_bearing


def path_forces(total: float, stiffness: float, errors: Array, floating: bool) -> Array:
    """Forces of equal paths that share a load, all of them closed.

    Parameters
    ----------
    total : float
        Sum W of all forces, N.
    stiffness : float
        Stiffness k_e of each path, N/m.
    errors : (paths,) array
        How late each path is along the line of action, m; the paths stand evenly around the gear.
    floating : bool
        Whether one of the two central members moves freely in its plane.

    Returns
    -------
    (paths,) array
        Force of each path, N.
    """
    count = len(errors)
    angles = 2.0 * np.pi * np.arange(count) / count
    coupling = count * np.eye(count) - 1.0
    if floating:
        coupling -= 2.0 * np.cos(angles[:, None] - angles)
    return total / count - stiffness / count * (coupling @ np.asarray(errors, dtype=float))
