"""Settings of the load-sharing stage."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class SpeedRange:
    """Evenly spaced speeds in rpm, both ends included."""

    first: float
    last: float
    points: int


@dataclass(frozen=True)
class SharingOptions:
    """Samples a cycle, cycles and starts averaged, size (m at mesh) and seed of the starts' disturbance.

    Then the confidence level, the speed of the quasi-static run (rpm), and the range of speeds looked over.
    """

    samples: int
    cycles: int
    starts: int
    spread: float
    seed: int
    confidence: float
    slow_rpm: float
    speeds: SpeedRange


@dataclass(frozen=True)
class MapOptions:
    """Deviations, samples and points of the load-sharing map.

    Attributes
    ----------
    mesh_error : float
        Standard deviation of the error of each mesh of an idler, m along the line of action.
    position : float
        Standard deviation of the tangential position of each idler, m.
    samples : int
        Machines drawn for each value of the number.
    points : int
        Values of the number on each curve.
    seed : int
        Of the draws.
    bearing_factors : (curves,) tuple of float
        Factors on the bearing stiffness of the inputs, one curve each, dimensionless.
    """

    mesh_error: float
    position: float
    samples: int
    points: int
    seed: int
    bearing_factors: tuple[float, ...]

    def deviation(self, pressure_angle: float) -> float:
        """Return the standard deviation of the lateness of a path, m.

        Parameters
        ----------
        pressure_angle : float
            Pressure angle, rad.

        Returns
        -------
        float
            Both meshes err independently; a pinion out of place by x makes its path late by 2 x cos a.
        """
        aside = 2.0 * np.cos(pressure_angle) * self.position
        return float(np.sqrt(2.0 * self.mesh_error**2 + aside**2))
