"""The outline of a tooth section in (angle, height), on the exact surfaces of either body.

Height is the radius for the pinion and z for the gear, so that both sections read tip at the top. The outline
of each side runs from the tip corner along chamfer, flank, fillet and root land to the cut, in the frame in
which the side stands on the right (see `tooth_sides`). Cuts stand in the middle of the spaces' root lands, a
whole pitch apart.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np

from facegear.arrays import Array
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.design import PairDesign
from facegear.teeth.tooth_sides import GearSide, PinionSide, ToothSide

RIGHT, LEFT = 0, 1
"""Numbers of the sides of a tooth."""
TOP, BOTTOM = np.zeros(1), np.ones(1)
"""Fractions of a segment at its end on the tip's and on the root's side."""


@dataclass(frozen=True)
class Outline:
    """Points of an outline segment by segment, for both sides and every plane of the width.

    At fractions 0..1 of each segment, from tip to root: angle (rad) and height (m), of flank and fillet the
    surface parameters as well. body: `pinion` or `face_gear`.
    """

    design: PairDesign
    body: str
    planes: Array
    """y (m) of the pinion's planes, gear radii (m) of the gear's."""

    @cached_property
    def sides(self) -> tuple[ToothSide, ToothSide]:
        """Right and left side; one object where they are mirror images."""
        build = PinionSide if self.body == "pinion" else GearSide
        right = build(self.design.family, self.planes)
        if self.design.is_symmetric:
            return right, right
        return right, build(self.design.mirror_family, self.planes)

    @property
    def different_sides(self) -> tuple[int, ...]:
        """Numbers of the sides that are no mirror images of each other: the right one alone, or both."""
        return (RIGHT,) if self.design.is_symmetric else (RIGHT, LEFT)

    @property
    def half_pitch(self) -> float:
        """Half of the angular pitch of the body, rad."""
        teeth = self.design.pinion.teeth if self.body == "pinion" else self.design.face_gear.teeth
        return pi / teeth

    @property
    def tip_height(self) -> Array:
        """Tip radius of the pinion, or height of the gear's tip, (planes,), m."""
        return self.sides[RIGHT].tip_height

    @property
    def root_height(self) -> Array:
        """Root radius of the pinion, or height of the gear's root land, (planes,), m."""
        return self.sides[RIGHT].root_height

    @cached_property
    def back_height(self) -> float:
        """Bore radius of the pinion, or height of the gear's back plane below its lowest root land, m."""
        if self.body == "pinion":
            return self.design.pinion.bore_radius
        return face_gear_fillet.back_height(self.design)

    @property
    def has_chamfer(self) -> bool:
        """Whether the tip of the tooth has a chamfer."""
        return self.body == "pinion" and self.design.pinion.tip_chamfer > 0

    def middle(self, side: int, segment: str, fraction: Array) -> Array:
        """Compute the angle halfway between both sides, at the same fraction of a segment.

        Parameters
        ----------
        side : int
            Number of the side in whose frame the angle counts, RIGHT or LEFT.
        segment : str
            `chamfer`, `flank` or `fillet`.
        fraction : (n,) array
            Fractions of the segment, 0..1.

        Returns
        -------
        (n, planes) array
            rad; 0 where both sides are mirror images.
        """
        if self.design.is_symmetric:
            return np.zeros((len(fraction), len(self.planes)))
        right, left = (self._surface(number, segment, fraction)[0] for number in (RIGHT, LEFT))
        return (right - left) / 2 if side == RIGHT else (left - right) / 2

    def points(self, side: int, segment: str, fraction: Array) -> tuple[Array, Array]:
        """Compute points of a segment of one side's outline.

        Parameters
        ----------
        side : int
            Number of the side, RIGHT or LEFT.
        segment : str
            `chamfer`, `flank`, `fillet` or `root_land`.
        fraction : (n,) array
            Fractions of the segment, 0..1.

        Returns
        -------
        tuple of (n, planes) arrays
            Angle, rad, in the frame in which the side stands on the right, and height, m.
        """
        if segment != "root_land":
            return self._surface(side, segment, fraction)
        start = self._surface(side, "fillet", BOTTOM)[0]
        cut = self.middle(side, "fillet", BOTTOM) + self.half_pitch
        steps = fraction[:, None]
        angle = np.where(steps == 1.0, cut, start + steps * (cut - start))
        return angle, np.broadcast_to(self.root_height, angle.shape)

    def _surface(self, side: int, segment: str, fraction: Array) -> tuple[Array, Array]:
        """Return angle (rad) and height (m), (n, planes), of chamfer, flank or fillet at fractions (n,)."""
        surfaces = self.sides[side]
        if segment == "flank":
            return surfaces.flank(fraction)
        if segment == "fillet":
            return surfaces.fillet(fraction)
        angle, height = surfaces.flank(TOP)
        tip = angle - self.design.pinion.tip_chamfer / self.tip_height
        steps = fraction[:, None]
        return tip + steps * (angle - tip), self.tip_height + steps * (height - self.tip_height)

    def cartesian(self, angle: Array, height: Array) -> Array:
        """Convert angle and height of the planes to points of the body frame.

        Parameters
        ----------
        angle : (..., planes) array
            rad.
        height : (..., planes) array
            m.

        Returns
        -------
        (..., planes, 3) array
            m.
        """
        if self.body == "pinion":
            return pinion.cartesian(height, angle, self.planes)
        return face_gear.cylindrical(self.planes, angle, height)


PLANES, POINTS = 8, 129
"""Numbers of Gauss points along the face and of points along the profile by which a tooth is integrated."""


def tooth_fill(design: PairDesign) -> tuple[float, float]:
    """Compute how much of the ring between root land, tip surface and ends the face gear's teeth fill.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    tuple[float, float]
        Volume of the teeth as a fraction of the ring, and height of their centre of mass over the root
        land as a fraction of their height.
    """
    gear = design.face_gear
    at, weights = np.polynomial.legendre.leggauss(PLANES)
    radius = 0.5 * (gear.inner_radius + gear.outer_radius + at * (gear.outer_radius - gear.inner_radius))
    outline = Outline(design, "face_gear", radius)
    depth, fractions = outline.tip_height - outline.root_height, np.linspace(0.0, 1.0, POINTS)
    part = weights * radius * depth
    part /= part.sum()
    volume, moment = 0.0, 0.0
    for side in outline.different_sides:
        segments = [outline.points(side, name, fractions) for name in ("flank", "fillet")]
        angle, height = (np.concatenate(values) for values in zip(*segments, strict=True))
        filled_share = (angle[1:] + angle[:-1]) / (2.0 * outline.half_pitch * len(outline.different_sides))
        above = (height - outline.root_height) / depth
        steps, middle = above[:-1] - above[1:], 0.5 * (above[1:] + above[:-1])
        side_volume, side_moment = (
            (filled_share * steps * factor).sum(axis=0) @ part for factor in (1.0, middle)
        )
        volume, moment = volume + side_volume, moment + side_moment
    return float(volume), float(moment / volume)
