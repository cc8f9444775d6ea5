"""The outline of half a tooth section in (angle, height), on the exact surfaces of either body.

Height is the radius for the pinion and z for the gear, so that both sections read tip at the top. The outline
runs from the tip corner along chamfer, flank, fillet and root land to the cut.
"""

from dataclasses import dataclass
from math import pi

import numpy as np

from facegear.arrays import Array
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.design import PairDesign


@dataclass(frozen=True)
class Outline:
    """Points of an outline segment by segment, for every plane of the width.

    At fractions 0..1 of each segment, from tip to root: angle (rad, from the tooth's centre line) and height
    (m), of flank and fillet the surface parameters as well. body: `pinion` or `face_gear`.
    """

    design: PairDesign
    body: str
    planes: Array
    """y (m) of the pinion's planes, gear radii (m) of the gear's."""

    @property
    def half_pitch(self) -> float:
        """Half of the angular pitch of the body, rad."""
        teeth = self.design.pinion.teeth if self.body == "pinion" else self.design.face_gear.teeth
        return pi / teeth

    @property
    def tip_height(self) -> float:
        """Tip radius of the pinion, or height of the gear's tip plane, m."""
        return self.design.pinion_tip_radius if self.body == "pinion" else self.design.gear_tip_plane

    @property
    def root_height(self) -> float:
        """Root radius of the pinion, or height of the gear's root plane, m."""
        return self.design.pinion_root_radius if self.body == "pinion" else self.design.gear_root_plane

    @property
    def back_height(self) -> float:
        """Bore radius of the pinion, or height of the gear's back plane, m."""
        return self.design.pinion.bore_radius if self.body == "pinion" else self.design.gear_back_plane

    @property
    def has_chamfer(self) -> bool:
        """Whether the tip of the tooth has a chamfer."""
        return self.body == "pinion" and self.design.pinion.tip_chamfer > 0

    def flank_parameters(self, fraction: Array) -> tuple[Array, Array]:
        """Compute the parameters of the exact flank, evenly in roll (pinion: its square) from tip to fillet.

        Parameters
        ----------
        fraction : (n,) array
            Fractions of the segment, 0..1.

        Returns
        -------
        tuple of (n, planes) arrays
            Pinion: roll, rad, and y, m; gear: roll and psi, rad.
        """
        fraction = fraction[:, None]
        if self.body == "pinion":
            top, bottom = self.design.pinion_tip_roll, pinion.junction_roll(self.design, self.design.middle)
            roll = np.sqrt(top**2 + fraction * (bottom**2 - top**2))
            return _has_same_sections(roll, self.planes[None, :])
        radius = self.planes[None, :]
        start, _ = face_gear.roll_and_psi_at_height(self.design, radius, self.design.gear_tip_plane)
        roll = start + fraction * (self.design.shaper_tip_roll - start)
        return roll, face_gear.psi_at(self.design, radius, roll)

    def fillet_parameters(self, fraction: Array) -> tuple[Array, Array]:
        """Compute the parameters of the exact fillet, evenly along its length in the middle plane.

        Parameters
        ----------
        fraction : (n,) array
            Fractions of the segment, 0..1.

        Returns
        -------
        tuple of (n, planes) arrays
            Pinion: gamma, rad, and y, m; gear: psi, rad, and gear radius, m.
        """
        if self.body == "pinion":
            start = self.design.pressure_angle
            gamma = start + self._even(fraction) * (pi / 2 - start)
            return _has_same_sections(gamma[:, None], self.planes[None, :])
        slopes = face_gear_fillet.fillet_slopes(
            self.design, self.planes[None, :], self._even(fraction)[:, None]
        )
        return _has_same_sections(slopes, self.planes[None, :])

    def _even(self, fraction: Array) -> Array:
        """Return fractions (n,) of the fillet's parameter at fractions (n,) of its length in the middle
        plane.
        """
        grid = np.linspace(0, 1, 401)
        if self.body == "pinion":
            start = self.design.pressure_angle
            radius, angle = pinion.trochoid_point(
                self.design, start + grid * (pi / 2 - start), self.design.middle
            )
            x, h = radius * angle, radius
        else:
            middle = self.planes[len(self.planes) // 2]
            slopes = face_gear_fillet.fillet_slopes(self.design, middle, grid)
            angle, h = face_gear_fillet.fillet_section(self.design, middle, slopes)
            x = middle * angle
        length = np.concatenate([[0], np.cumsum(np.hypot(np.diff(x), np.diff(h)))])
        return np.interp(fraction, length / length[-1], grid)

    def points(self, segment: str, fraction: Array) -> tuple[Array, Array]:
        """Compute points of a segment of the right half tooth's outline.

        Parameters
        ----------
        segment : str
            `chamfer`, `flank`, `fillet` or `root_land`.
        fraction : (n,) array
            Fractions of the segment, 0..1.

        Returns
        -------
        tuple of (n, planes) arrays
            Angle, rad, and height, m.
        """
        if segment == "flank":
            return self._flank(fraction)
        if segment == "fillet":
            u, v = self.fillet_parameters(fraction)
            if self.body == "pinion":
                radius, angle = pinion.trochoid_point(self.design, u, v)
                return angle, radius
            return face_gear_fillet.fillet_section(self.design, v, u)
        fraction = np.broadcast_to(fraction[:, None], (len(fraction), len(self.planes)))
        if segment == "root_land":
            half = np.full(len(self.planes), pinion.root_half_angle(self.design))
            if self.body == "face_gear":
                half = face_gear_fillet.root_half_angle(self.design, self.planes)
            start = self.half_pitch - half
            angle = start + fraction * (self.half_pitch - start)
            return np.where(fraction == 1, self.half_pitch, angle), np.full_like(angle, self.root_height)
        angle, height = self._flank(np.zeros(1))
        tip = pinion.tip_half_angle(self.design, self.planes)
        return tip + fraction * (angle - tip), self.tip_height + fraction * (height - self.tip_height)

    def _flank(self, fraction: Array) -> tuple[Array, Array]:
        """Return angle (rad) and height (m), (n, planes), of flank points at fractions (n,) from tip to
        fillet.
        """
        u, v = self.flank_parameters(fraction)
        if self.body == "pinion":
            radius, angle = pinion.involute_point(self.design, u, v)
            return angle, radius
        point = face_gear.flank_point(self.design, u, v)
        return np.arctan2(point[..., 0], point[..., 1]), point[..., 2]

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


def _has_same_sections(u: Array, v: Array) -> tuple[Array, Array]:
    """Return both arrays broadcast to their common shape."""
    u, v = np.broadcast_arrays(u, v)
    return u, v


PLANES, POINTS = 8, 129
"""Numbers of Gauss points along the face and of points along the profile by which a tooth is integrated."""


def tooth_fill(design: PairDesign) -> tuple[float, float]:
    """Compute how much of the ring between root land, tip plane and ends the face gear's teeth fill.

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
    parts = [outline.points(name, np.linspace(0.0, 1.0, POINTS)) for name in ("flank", "fillet")]
    angle, height = (np.concatenate(values) for values in zip(*parts, strict=True))
    filled_share = (angle[1:] + angle[:-1]) / (2.0 * outline.half_pitch)
    above = (height - outline.root_height) / (outline.tip_height - outline.root_height)
    steps, middle = above[:-1] - above[1:], 0.5 * (above[1:] + above[:-1])
    part = weights * radius / (weights * radius).sum()
    volume, moment = ((filled_share * steps * factor).sum(axis=0) @ part for factor in (1.0, middle))
    return float(volume), float(moment / volume)
