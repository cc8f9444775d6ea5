"""The pinion's surfaces for the whole family: involute helicoids, and the root cut by the rack's rounded tip.

All points are in the pinion's body frame (x, y, z), where tooth 0 stands on the half plane x = 0, z < 0. The
rack's tip rounding is a cylinder along the rack's tooth. Normals of its envelope are square to that
cylinder's axis and meet the pitch line, so that they are not in a transverse section where teeth are helical
or tapered. Source: Litvin and Fuentes 2004, chapter 10; the envelope of the tapered rack was derived
for this project.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import cos, pi, sin, tan

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.tooth_family import Helicoid, ToothFamily, stack_vectors


@dataclass(frozen=True)
class PinionFlank:
    """Flank of pinion tooth 0 (drive: right, coast: left), with parameters roll and y.

    roll: transverse length of roll (m), the distance from the base cylinder in a transverse section.
    """

    helicoid: Helicoid

    def slope(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute the slope psi of the normal against x in the transverse section.

        Parameters
        ----------
        u : (...) array_like
            Transverse length of roll, m.
        v : (...) array_like
            Place y along the axis, m.

        Returns
        -------
        (...) array
            rad.
        """
        helicoid = self.helicoid
        along = np.asarray(v, float) - helicoid.middle
        roll = np.asarray(u, float) + helicoid.lead * along
        return roll / helicoid.base_radius - helicoid.half_base_angle

    def point(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute points of the flank in the pinion's body frame.

        Parameters
        ----------
        u : (...) array_like
            Transverse length of roll, m.
        v : (...) array_like
            Place y along the axis, m.

        Returns
        -------
        (..., 3) array
            m.
        """
        psi, base, roll = self.slope(u, v), self.helicoid.base_radius, np.asarray(u, float)
        c, s = np.cos(psi), np.sin(psi)
        return stack_vectors(self.helicoid.side * (roll * c - base * s), v, -(base * c + roll * s))

    def normal(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute outward unit normals of the flank.

        Parameters
        ----------
        u : (...) array_like
            Transverse length of roll, m.
        v : (...) array_like
            Place y along the axis, m.

        Returns
        -------
        (..., 3) array
            Unit vectors, dimensionless.
        """
        psi, helicoid = self.slope(u, v), self.helicoid
        across = helicoid.cosine
        return stack_vectors(helicoid.side * across * np.cos(psi), helicoid.sine, -across * np.sin(psi))

    def tangents(self, u: ArrayLike, v: ArrayLike) -> tuple[Array, Array]:
        """Compute the exact derivatives of `point`.

        Parameters
        ----------
        u : (...) array_like
            Transverse length of roll, m.
        v : (...) array_like
            Place y along the axis, m.

        Returns
        -------
        tuple of (..., 3) arrays
            Derivatives by length of roll and by y, dimensionless.
        """
        psi, helicoid, roll = self.slope(u, v), self.helicoid, np.asarray(u, float)
        base, side = helicoid.base_radius, helicoid.side
        c, s = np.cos(psi), np.sin(psi)
        by_psi = -side * (roll * s + base * c), base * s - roll * c
        by_roll = stack_vectors(side * c + by_psi[0] / base, 0.0, by_psi[1] / base - s)
        twist = helicoid.lead / base
        return by_roll, stack_vectors(by_psi[0] * twist, 1.0, by_psi[1] * twist)


@dataclass(frozen=True)
class PinionFillet:
    """Root beside a flank of pinion tooth 0, with parameters gamma and y.

    gamma: slope (rad) of the normal against the rack's pitch line in the transverse projection, from the
    transverse pressure angle, at the flank, to pi / 2 at the bottom. rounding: of the rack's tip, m. depth,
    lateral: place of the rounding's axis in the middle section, below the pitch line and from the middle of
    the rack's tooth to the flank's own side (m).
    """

    helicoid: Helicoid
    teeth: int
    helix: float
    taper: float
    rounding: float
    depth: float
    lateral: float

    def point(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute points of the root in the pinion's body frame.

        Parameters
        ----------
        u : (...) array_like
            Slope gamma, rad.
        v : (...) array_like
            Place y along the axis, m.

        Returns
        -------
        (..., 3) array
            m.
        """
        direction, depth, turn = self._contact(u, v)
        x = -self.helicoid.side * depth / np.tan(u) - self.rounding * direction[0]
        below = self.helicoid.pitch_radius - depth + self.rounding * direction[2]
        c, s = np.cos(turn), np.sin(turn)
        return stack_vectors(x * c + below * s, v, x * s - below * c)

    def normal(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute outward unit normals of the root.

        Parameters
        ----------
        u : (...) array_like
            Slope gamma, rad.
        v : (...) array_like
            Place y along the axis, m.

        Returns
        -------
        (..., 3) array
            Unit vectors, dimensionless.
        """
        (x, along, up), _, turn = self._contact(u, v)
        c, s = np.cos(turn), np.sin(turn)
        return stack_vectors(x * c - up * s, along, x * s + up * c)

    def tangents(self, u: ArrayLike, v: ArrayLike) -> tuple[Array, Array]:
        """Compute the exact derivatives of `point`.

        Parameters
        ----------
        u : (...) array_like
            Slope gamma, rad.
        v : (...) array_like
            Place y along the axis, m.

        Returns
        -------
        tuple of (..., 3) arrays
            Derivatives by gamma, m/rad, and by y, dimensionless.
        """
        side, rounding, taper = self.helicoid.side, self.rounding, tan(self.taper)
        (x, along, up), depth, turn = self._contact(u, v)
        cotangent, sine = 1.0 / np.tan(u), np.sin(u)
        # along, x and up are v, side cot(gamma) and -1 over a common length
        spread = tan(self.helix) / cos(self.taper)
        bend = -1.0 / sine**2
        length_bend = side * bend * (x + along * spread)
        x_u = -up * (side * bend - x * length_bend)
        along_u = -up * (side * spread * bend - along * length_bend)
        up_u = up**2 * length_bend
        centre_u = rounding * along_u
        depth_u = -taper * centre_u
        plane_x = -side * depth * cotangent - rounding * x
        below = self.helicoid.pitch_radius - depth + rounding * up
        by_gamma = (
            -side * (depth_u * cotangent + depth * bend) - rounding * x_u,
            -depth_u + rounding * up_u,
            self._turn_slope(cotangent, depth_u, centre_u) + side * depth * bend / self.helicoid.pitch_radius,
        )
        by_y = side * taper * cotangent, taper, self._turn_slope(cotangent, -taper, 1.0)
        slopes = by_gamma, by_y
        c, s = np.cos(turn), np.sin(turn)
        tangents = [
            stack_vectors(
                x_i * c + below_i * s + turn_i * (below * c - plane_x * s),
                axial,
                x_i * s - below_i * c + turn_i * (plane_x * c + below * s),
            )
            for (x_i, below_i, turn_i), axial in zip(slopes, (0.0, 1.0), strict=True)
        ]
        return tangents[0], tangents[1]

    def _contact(self, u: ArrayLike, v: ArrayLike) -> tuple[tuple[Array, Array, Array], Array, Array]:
        """Return three arrays for slopes u and places v: the components along (x, a, u) of the outward
        normal, which meets the pitch line; the depth (m) of the rounding's axis below that line; and the
        turn (rad) from that position of the rack to the body frame.
        """
        side, taper = self.helicoid.side, tan(self.taper)
        cotangent = 1.0 / np.tan(np.asarray(u, float))
        along = -taper + side * tan(self.helix) / cos(self.taper) * cotangent
        length = np.sqrt(1.0 + cotangent**2 + along**2)
        direction = side * cotangent / length, along / length, -1.0 / length
        from_middle = np.asarray(v, float) + self.rounding * direction[1] - self.helicoid.middle
        depth = self.depth - from_middle * taper
        lateral = side * self.lateral + tan(self.helix) / cos(self.taper) * from_middle
        rolled_angle = (lateral - side * depth * cotangent) / self.helicoid.pitch_radius
        return direction, depth, side * (pi / self.teeth) - rolled_angle

    def _turn_slope(self, cotangent: Array, depth: Array | float, centre: Array | float) -> Array:
        """Return the change of the turn (rad) with changes of depth and of the centre's place y, other
        things equal.
        """
        lateral = tan(self.helix) / cos(self.taper) * centre
        return -(lateral - self.helicoid.side * depth * cotangent) / self.helicoid.pitch_radius


@lru_cache(maxsize=256)
def pinion_fillet(family: ToothFamily, side: int) -> PinionFillet:
    """Return the root that the rack's rounded tip cuts beside a flank of the pinion.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank: +1 drive, -1 coast.

    Returns
    -------
    PinionFillet
        The root.
    """
    rack, helicoid = family.rack, family.pinion_flanks[0 if side > 0 else 1]
    depth = family.pinion_dedendum - family.rack_tip_radius / cos(rack.taper_angle)
    across = cos(rack.pressure_angle(side)) * cos(rack.helix_angle)
    lateral = pi * rack.transverse_module / 4 + (family.thinning / 2 - family.rack_tip_radius) / across
    return PinionFillet(
        helicoid=helicoid,
        teeth=family.pinion_teeth,
        helix=rack.helix_angle,
        taper=rack.taper_angle,
        rounding=family.rack_tip_radius,
        depth=depth - family.profile_shift,
        lateral=lateral - depth * tan(helicoid.pressure_angle),
    )


def tip_distance(helicoid: Helicoid, radius: ArrayLike, taper: float) -> Array:
    """Compute the distance s from the base cylinder along a normal at which a helicoid reaches a tip cone.

    Parameters
    ----------
    helicoid : Helicoid
        Flank.
    radius : (...) array_like
        Radius of the cone in the section of the normal's foot, m.
    taper : float
        Growth of the radius per length of face, dimensionless.

    Returns
    -------
    (...) array
        s, m; nan where the cone lies inside the base cylinder.
    """
    radius = np.asarray(radius, float)
    growth = helicoid.sine * taper
    square = helicoid.cosine**2 - growth**2
    half = growth * radius
    with np.errstate(invalid="ignore"):
        root = np.sqrt(half**2 + square * (radius**2 - helicoid.base_radius**2))
    return (half + root) / square


def pinion_start(family: ToothFamily, side: int, y: ArrayLike) -> Array:
    """Compute where the pinion's involute begins: where the rack's tip rounding ends.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank: +1 drive, -1 coast.
    y : (...) array_like
        Place along the axis, m.

    Returns
    -------
    (...) array
        Transverse length of roll, m; negative where the rack undercuts the pinion.
    """
    rack, helicoid = family.rack, family.pinion_flanks[0 if side > 0 else 1]
    rounding = family.rack_tip_radius * (1.0 - sin(rack.pressure_angle(side))) / cos(rack.taper_angle)
    angle = helicoid.pressure_angle
    depth = family.pinion_dedendum - rounding - family.shift(y)
    return helicoid.pitch_radius * sin(angle) - depth / sin(angle)


def pinion_land(family: ToothFamily, y: ArrayLike) -> Array:
    """Compute the width of the pinion's tip land in a transverse section, chamfer not counted.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    y : (...) array_like
        Place along the axis, m.

    Returns
    -------
    (...) array
        Arc, m; negative for a pointed tooth.
    """
    radius = family.pinion_tip_radius + (np.asarray(y, float) - family.middle) * family.taper
    return _land(family.pinion_flanks, radius, y)


def shaper_land(family: ToothFamily, y: ArrayLike) -> Array:
    """Compute the width of the shaper's tip land, which cuts the gear's root land.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    y : (...) array_like
        Place along the axis, m.

    Returns
    -------
    (...) array
        Arc between the centres of both tip roundings, m; negative where they have passed each other.
    """
    radius = family.rounding_centre + (np.asarray(y, float) - family.middle) * family.taper
    rounding = family.shaper_tip_rounding
    inwards = sum(rounding / (helicoid.base_radius * helicoid.cosine) for helicoid in family.shaper_flanks)
    return _land(family.shaper_flanks, radius, y) - radius * inwards


def _land(flanks: tuple[Helicoid, Helicoid], radius: Array, y: ArrayLike) -> Array:
    """Return the arc (m) between the drive and coast flank of a tooth at radii and places y (...), m."""
    angle = np.zeros(np.shape(radius))
    for helicoid in flanks:
        along = np.asarray(y, float) - helicoid.middle
        with np.errstate(invalid="ignore"):
            roll = np.sqrt((radius / helicoid.base_radius) ** 2 - 1.0)
        start = helicoid.half_base_angle - helicoid.lead * along / helicoid.base_radius
        angle = angle + start - roll + np.arctan(roll)
    return radius * angle
