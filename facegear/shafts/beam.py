"""Round shafts that bend, shear and stretch (Timoshenko).

Motions of a point are x, y, z, tilt_x, tilt_y, with z along the shaft: right-handed rotations, so that
without shear dx/dz = tilt_y and dy/dz = -tilt_x.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.rigid_body import MOTIONS, carry_motion


@dataclass(frozen=True)
class Elasticity:
    """Young's modulus (Pa) and Poisson's ratio."""

    young: float
    poisson: float

    @property
    def shear(self) -> float:
        """Shear modulus, Pa."""
        return self.young / (2.0 * (1.0 + self.poisson))


@dataclass(frozen=True)
class Segment:
    """A piece of shaft between two steps: length, diameter and bore, m."""

    length: float
    diameter: float
    bore: float = 0.0

    def __post_init__(self) -> None:
        for name in ("length", "diameter"):
            if (value := getattr(self, name)) <= 0.0:
                raise InvalidInput(f"{name} of a shaft's segment", value, "above 0 m")
        if not 0.0 <= self.bore < self.diameter:
            requirement = f"from 0 to below the diameter of {self.diameter:g} m"
            raise InvalidInput("bore of a shaft's segment", self.bore, requirement)

    @property
    def area(self) -> float:
        """Area of the cross-section, m2."""
        return 0.25 * np.pi * (self.diameter**2 - self.bore**2)

    @property
    def second_moment(self) -> float:
        """Second moment of the cross-section about a diameter, m4; the polar one is twice that."""
        return np.pi / 64.0 * (self.diameter**4 - self.bore**4)

    def shear_coefficient(self, poisson: float) -> float:
        """Return the shear coefficient of hollow circles (Cowper 1966); 6 (1 + nu) / (7 + 6 nu) for a solid
        one.

        Parameters
        ----------
        poisson : float
            Poisson's ratio nu.

        Returns
        -------
        float
            Shear coefficient, dimensionless.
        """
        hollow = (self.bore / self.diameter) ** 2
        squared = (1.0 + hollow) ** 2
        below = (7.0 + 6.0 * poisson) * squared + (20.0 + 12.0 * poisson) * hollow
        return 6.0 * (1.0 + poisson) * squared / below

    def torsional_stiffness(self, material: Elasticity) -> float:
        """Return the torsional stiffness.

        Parameters
        ----------
        material : Elasticity
            Elasticity of the shaft.

        Returns
        -------
        float
            N m/rad.
        """
        return material.shear * 2.0 * self.second_moment / self.length


def section_flexibility(segment: Segment, material: Elasticity) -> Array:
    """Return the strains x, y, z, tilt_x, tilt_y of a cross-section for each m of length, by its loads.

    Parameters
    ----------
    segment : Segment
        The segment.
    material : Elasticity
        Its elasticity.

    Returns
    -------
    (5,) array
        1/N and 1/(N m2).
    """
    shear = segment.shear_coefficient(material.poisson) * material.shear * segment.area
    bending = material.young * segment.second_moment
    return 1.0 / np.array([shear, shear, material.young * segment.area, bending, bending])


def clamped_compliance(segments: Sequence[Segment], material: Elasticity, at: Array) -> Array:
    """Return the motion at each distance by a load at each, of a shaft clamped at its beginning.

    Virtual work: the integral of the strains of all sections that both distances leave behind, which is a
    polynomial of second degree between two steps; Simpson's rule is exact.

    Parameters
    ----------
    segments : Sequence of Segment
        Segments from the clamped end on.
    material : Elasticity
        Their elasticity.
    at : (n,) array
        Distances from the clamped end, m.

    Returns
    -------
    (n, n, 5, 5) array
        m/N, rad/N, m/(N m) and rad/(N m).
    """
    compliance = np.zeros((at.size, at.size, MOTIONS, MOTIONS))
    distances: list[float] = at.tolist()
    begin = 0.0
    for segment in segments:
        flexibility = section_flexibility(segment, material)
        for (i, motion_position), (j, load_position) in product(enumerate(distances), enumerate(distances)):
            end = min(begin + segment.length, motion_position, load_position)
            if end > begin:
                for section, weight in ((begin, 1.0), (0.5 * (begin + end), 4.0), (end, 1.0)):
                    strained = flexibility[:, None] * carry_motion(load_position - section).T
                    compliance[i, j] += (
                        weight / 6.0 * (end - begin) * carry_motion(motion_position - section) @ strained
                    )
        begin += segment.length
    return compliance
