"""Ball and roller bearings by their inner dimensions, and the springs that they are for the kernels.

Motions are those of the inner ring against the outer one at the middle of the rolling elements: x, y, z,
tilt_x, tilt_y. Element j stands at psi_j = first_element + 2 pi j / Z, counted from x towards y. Energy,
force and stiffness are those of this cage, or means over its places within the angle of one element.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy

from facegear.arrays import Array
from facegear.bearings.point_contact import PointContact, touch_groove
from facegear.errors import InvalidInput

STEEL_YOUNG, STEEL_POISSON, STEEL_DENSITY = 207e9, 0.3, 7850.0
"""Young's modulus (Pa), Poisson's ratio and density (kg/m3) of bearing steel."""
SLICE_STIFFNESS = 35948e6
"""Stiffness of steel rollers over length^(8/9), both contacts together, N/m^2: 35 948 N/mm^2 of ISO/TS 16281,
which is the same number in m as the exponents 8/9 and 10/9 add up to 2."""
LINE_EXPONENT = 10.0 / 9.0
"""Exponent of the load of a slice by its approach (ISO/TS 16281)."""
CYLINDRICAL_DROP, TAPERED_DROP, LONG_ROLLER_DROP = 0.00035, 0.00045, 0.0005
"""Factors of the logarithmic profile over the diameter (ISO/TS 16281). The one of tapered rollers was read in
a public program."""
LONG_ROLLER = 2.5
"""Length over diameter from which a cylindrical roller has a straight middle (ISO/TS 16281)."""


class BallSprings(NamedTuple):
    """Numbers of a ball bearing for `facegear/_kernels/src/bearings/balls.hpp`; m, N, N/m^1.5 and J.

    Stiffness and centrifugal force are divided by the number of places of the cage, m.

    Attributes
    ----------
    cosine, sine : (Z m,)
        Of the angle psi of each ball in each place of the cage, from x towards y.
    arm, height
        Radius, and z from the plane of the balls, of the centre of curvature of the inner groove.
    rest_radial, rest_axial
        Vector from the outer to the inner groove's centre, the ring at rest.
    inner_length, outer_length
        From a groove's centre to the ball's centre at first touch.
    inner_stiffness, outer_stiffness, stiffness
        Of single contacts, and of both in series.
    centrifugal, free_energy
        Radial force on a ball, and energy, which kernels subtract, of a ball on the outer ring alone.
    """

    cosine: Array
    sine: Array
    arm: float
    height: float
    rest_radial: float
    rest_axial: float
    inner_length: float
    outer_length: float
    inner_stiffness: float
    outer_stiffness: float
    stiffness: float
    centrifugal: float
    free_energy: float


class RollerSprings(NamedTuple):
    """Numbers of a roller bearing for `facegear/_kernels/src/bearings/rollers.hpp`; m, N, N/m^(10/9) and J.

    Stiffness and centrifugal force are divided by the number of places of the cage, m.

    Attributes
    ----------
    cosine, sine : (Z m,)
        Of the angle psi of each roller in each place of the cage, from x towards y.
    positions, drops : (n,)
        Middle of each slice along the roller, and drop of the profile of one contact there.
    radius
        Of the circle of the rollers' middles.
    normal_radial, normal_axial
        Unit vector of the load on rollers by the inner ring: motion along it presses them.
    direction
        `RollingBearing.direction`.
    clearance, stiffness
        Half of the diametral clearance along the normal; stiffness of a slice, both contacts in series.
    centrifugal, free_position, free_energy
        Force on a roller along the normal, and its position and energy (`RollerBearing._free_roller`).
    """

    cosine: Array
    sine: Array
    positions: Array
    drops: Array
    radius: float
    normal_radial: float
    normal_axial: float
    direction: float
    clearance: float
    stiffness: float
    centrifugal: float
    free_position: float
    free_energy: float


@dataclass(frozen=True)
class RollingBearing:
    """Dimensions that ball and roller bearings have; m, rad, Pa, kg/m3 and rad/s.

    Attributes
    ----------
    elements
        Number of rolling elements Z.
    element_diameter, pitch_diameter
        Diameter of the elements, and of the circle of their middles.
    contact_angle
        Nominal angle of contact; 0 of deep groove ball and cylindrical roller bearings.
    direction
        1 where thrust along +z loads the bearing, -1 where thrust along -z does. It has no effect without
        contact angle.
    clearance
        Diametral clearance in operation; negative where elements are pressed in.
    first_element
        Angle of the first element from x towards y.
    cage_places
        Number of places of the cage over which the bearing is averaged, evenly spaced over the angle of one
        element from `first_element` on; 1: the elements stand as they are given.
    speed
        Speed of the inner ring for centrifugal forces, the outer ring at rest; 0 leaves them out.
    young, poisson, density
        Of rings and elements.
    """

    elements: int
    element_diameter: float
    pitch_diameter: float
    contact_angle: float = 0.0
    direction: int = 1
    clearance: float = 0.0
    first_element: float = 0.0
    cage_places: int = 1
    speed: float = 0.0
    young: float = STEEL_YOUNG
    poisson: float = STEEL_POISSON
    density: float = STEEL_DENSITY

    def __post_init__(self) -> None:
        """Raise InvalidInput for dimensions that no bearing has."""
        if self.elements < 2:
            raise InvalidInput("number of rolling elements", self.elements, "at least 2")
        if self.cage_places < 1:
            raise InvalidInput("places of a bearing's cage", self.cage_places, "at least 1")
        if self.direction not in (1, -1):
            raise InvalidInput("direction of a bearing's thrust", self.direction, "1 or -1")
        for name in ("element_diameter", "young", "density"):
            if not 0.0 < getattr(self, name) < np.inf:
                quantity = f"{name.replace('_', ' ')} of a rolling bearing"
                raise InvalidInput(quantity, getattr(self, name), "above 0")
        if not 0.0 <= self.contact_angle < 0.5 * np.pi:
            raise InvalidInput("contact angle of a bearing", self.contact_angle, "from 0 to below pi/2 rad")
        # Neighbours touch where the chord between their middles is their diameter.
        least = self.element_diameter / np.sin(np.pi / self.elements)
        if not least <= self.pitch_diameter < np.inf:
            requirement = f"at least {least:.6g} m, or its {self.elements} elements overlap"
            raise InvalidInput("pitch diameter of a bearing", self.pitch_diameter, requirement)
        if not -self.element_diameter < self.clearance < self.element_diameter:
            raise InvalidInput("clearance of a bearing", self.clearance, "smaller than its elements")

    @property
    def angles(self) -> Array:
        """Angle of each element in each place of the cage from x towards y, (Z m,), rad."""
        count = self.elements * self.cage_places
        return self.first_element + 2.0 * np.pi * np.arange(count) / count

    @property
    def pitch_ratio(self) -> float:
        """gamma: element diameter times the cosine of the contact angle over the pitch diameter."""
        return float(self.element_diameter * np.cos(self.contact_angle) / self.pitch_diameter)

    @property
    def modulus(self) -> float:
        """E / (1 - nu^2) of rings and elements, Pa."""
        return self.young / (1.0 - self.poisson**2)

    def centrifugal_force(self, volume: float) -> float:
        """Return the outward centrifugal force on an element, m r w^2 at the speed w of a cage that rolls.

        Parameters
        ----------
        volume : float
            Volume of the element, m3.

        Returns
        -------
        float
            N, at least 0; 0 where `speed` is 0.
        """
        cage_speed = 0.5 * self.speed * (1.0 - self.pitch_ratio)
        return self.density * volume * 0.5 * self.pitch_diameter * cage_speed**2


@dataclass(frozen=True)
class BallBearing(RollingBearing):
    """Deep groove or angular contact ball bearing of one row.

    Without contact angle the ball has the clearance in the middle of both grooves and carries thrust both
    ways. With one, balls just touch where clearance is 0 and nothing moves.

    Attributes
    ----------
    groove_ratio_inner, groove_ratio_outer
        Radius of each groove over the diameter of the ball.
    """

    groove_ratio_inner: float = 0.52
    groove_ratio_outer: float = 0.52

    def __post_init__(self) -> None:
        """Raise InvalidInput for dimensions that no ball bearing has."""
        super().__post_init__()
        for name in ("groove_ratio_inner", "groove_ratio_outer"):
            if not 0.501 <= getattr(self, name) <= 1.0:
                raise InvalidInput(name.replace("_", " "), getattr(self, name), "from 0.501 to 1")
        largest = 2.0 * self.groove_distance * np.cos(self.contact_angle)
        if self.clearance >= largest:
            requirement = f"below {largest:.6g} m, where both grooves are round the ball's middle"
            raise InvalidInput("clearance of a ball bearing", self.clearance, requirement)

    @property
    def groove_distance(self) -> float:
        """Distance of both grooves' centres where the ball just touches, m."""
        return (self.groove_ratio_inner + self.groove_ratio_outer - 1.0) * self.element_diameter

    @cached_property
    def contacts(self) -> tuple[PointContact, PointContact]:
        """Hertzian contacts of a ball with inner and outer groove, in this order, without load."""
        gamma, ball = self.pitch_ratio, self.element_diameter
        return (
            touch_groove(ball, self.groove_ratio_inner, gamma / (1.0 - gamma), self.modulus),
            touch_groove(ball, self.groove_ratio_outer, -gamma / (1.0 + gamma), self.modulus),
        )

    @cached_property
    def springs(self) -> BallSprings:
        """Numbers that the kernels in `facegear._kernels.bearings` take for this bearing."""
        ball, (inner, outer) = self.element_diameter, self.contacts
        cosine, sine = np.cos(self.contact_angle), self.direction * np.sin(self.contact_angle)
        inner_length = (self.groove_ratio_inner - 0.5) * ball
        outer_length = (self.groove_ratio_outer - 0.5) * ball
        force = self.centrifugal_force(np.pi / 6.0 * ball**3)
        approach = (force / outer.stiffness) ** (2.0 / 3.0)
        share = 1.0 / self.cage_places
        in_series = (inner.stiffness ** (-2 / 3) + outer.stiffness ** (-2 / 3)) ** -1.5
        return BallSprings(
            cosine=np.cos(self.angles),
            sine=np.sin(self.angles),
            arm=0.5 * self.pitch_diameter + inner_length * cosine,
            height=inner_length * sine,
            rest_radial=self.groove_distance * cosine - 0.5 * self.clearance,
            rest_axial=self.groove_distance * sine,
            inner_length=inner_length,
            outer_length=outer_length,
            inner_stiffness=share * inner.stiffness,
            outer_stiffness=share * outer.stiffness,
            stiffness=share * in_series,
            centrifugal=share * force,
            free_energy=-share * force * (outer_length + 0.6 * approach),
        )

    def stiffness_at(self, load: float) -> float:
        """Return d load / d approach of one ball, contacts in series, by which motions are scaled.

        Parameters
        ----------
        load : float
            Load of the ball, N; no centrifugal force is counted.

        Returns
        -------
        float
            N/m.
        """
        whole = self.cage_places * self.springs.stiffness
        return 1.5 * whole ** (2.0 / 3.0) * load ** (1.0 / 3.0)


@dataclass(frozen=True, kw_only=True)
class RollerBearing(RollingBearing):
    """Cylindrical roller bearing, or tapered roller bearing by its contact angle, of one row.

    Flanges carry nothing: a cylindrical roller bearing has no stiffness along z.

    Attributes
    ----------
    effective_length
        Length of a roller that carries, m.
    slices, has_profile
        Number of slices n; whether rollers have a logarithmic profile, otherwise they are straight.
    """

    effective_length: float
    slices: int = 41
    has_profile: bool = True

    def __post_init__(self) -> None:
        """Raise InvalidInput for dimensions that no roller bearing has."""
        super().__post_init__()
        if not 0.0 < self.effective_length < np.inf:
            raise InvalidInput("effective length of a roller", self.effective_length, "above 0 m")
        if self.slices < 2:
            raise InvalidInput("slices of a roller", self.slices, "at least 2")

    @property
    def positions(self) -> Array:
        """Middle of each slice from the middle of the roller, (n,), m."""
        return self.effective_length * ((np.arange(self.slices) + 0.5) / self.slices - 0.5)

    @property
    def drops(self) -> Array:
        """Depth of the logarithmic profile below a cylinder at each slice, (n,), m; 0 without profile."""
        if not self.has_profile:
            return np.zeros(self.slices)
        diameter, length = self.element_diameter, self.effective_length
        distance, factor = 2.0 * np.abs(self.positions), CYLINDRICAL_DROP
        if self.contact_angle > 0.0:
            factor = TAPERED_DROP
        elif length > LONG_ROLLER * diameter:
            factor = LONG_ROLLER_DROP
            distance = np.maximum(distance - (length - LONG_ROLLER * diameter), 0.0)
            length = LONG_ROLLER * diameter
        return -factor * diameter * np.log1p(-((distance / length) ** 2))

    @property
    def slice_stiffness(self) -> float:
        """Load of a slice over (approach of the rings)^(10/9), both contacts in series, N/m^(10/9)."""
        return SLICE_STIFFNESS * self.effective_length ** (8.0 / 9.0) / self.slices

    @cached_property
    def springs(self) -> RollerSprings:
        """Numbers that the kernels in `facegear._kernels.bearings` take for this bearing."""
        cosine, sine = np.cos(self.contact_angle), self.direction * np.sin(self.contact_angle)
        volume = 0.25 * np.pi * self.element_diameter**2 * self.effective_length
        force = float(self.centrifugal_force(volume) * cosine)
        position, energy = self._free_roller(force)
        share = 1.0 / self.cage_places
        return RollerSprings(
            cosine=np.cos(self.angles),
            sine=np.sin(self.angles),
            positions=self.positions,
            drops=self.drops,
            radius=0.5 * self.pitch_diameter,
            normal_radial=float(cosine),
            normal_axial=float(sine),
            direction=float(self.direction),
            clearance=0.5 * self.clearance * float(cosine),
            stiffness=share * self.slice_stiffness,
            centrifugal=share * force,
            free_position=position,
            free_energy=share * energy,
        )

    def _free_roller(self, force: float) -> tuple[float, float]:
        """Return approach to the outer ring (m) and energy (J) of a roller that a force (N) alone presses."""
        if force == 0.0:
            return 0.0, 0.0
        stiffness, drops = self.slice_stiffness * 2.0**LINE_EXPONENT, self.drops

        def slice_loads(position: float) -> Array:
            """Return the load of each slice (n,), N, at an approach (m) of roller and outer ring."""
            return np.asarray(stiffness * np.maximum(position - drops, 0.0) ** LINE_EXPONENT)

        furthest = float(drops.max() + (force / (stiffness * self.slices)) ** (1.0 / LINE_EXPONENT))
        position = float(
            scipy.optimize.brentq(
                lambda at: slice_loads(at).sum() - force, 0.0, furthest, xtol=1e-18, rtol=1e-15
            )
        )
        approaches = np.maximum(position - drops, 0.0)
        energy = float(9.0 / 19.0 * slice_loads(position) @ approaches)
        return position, energy - force * position

    def stiffness_at(self, load: float) -> float:
        """Return d load / d approach of a straight roller, contacts in series, by which motions are scaled.

        Parameters
        ----------
        load : float
            Load of the roller, N.

        Returns
        -------
        float
            N/m.
        """
        total = self.slice_stiffness * self.slices
        return LINE_EXPONENT * total**0.9 * load**0.1


AnyBearing = BallBearing | RollerBearing
"""A rolling bearing of either kind."""


def thrown_stiffness(bearing: AnyBearing) -> float:
    """Return the stiffness of all elements under their centrifugal force, by which positions are rounded.

    Parameters
    ----------
    bearing : BallBearing or RollerBearing
        The bearing.

    Returns
    -------
    float
        N/m; 0 at rest.
    """
    force = bearing.cage_places * bearing.springs.centrifugal
    return bearing.elements * bearing.stiffness_at(force)
