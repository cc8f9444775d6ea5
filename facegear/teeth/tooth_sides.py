"""The lines of one side of a tooth of any family, section by section, on its exact surfaces.

Sections are planes across the pinion's axis and cylinders about the gear's. Their coordinates are the angle
about the body's axis, from the half plane of its reference tooth, and the height: the radius of the pinion, z
of the gear. Each side is described in the frame in which it stands on the right: the right side in that of
the body, the left side in its mirror x -> -x, by the family in that mirror.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np

from facegear.arrays import Array
from facegear.teeth.generated_fillet import GearFillet, flank_end, gear_fillet
from facegear.teeth.generated_flank import GearFlank, gear_flank
from facegear.teeth.helicoid import PinionFillet, PinionFlank, pinion_fillet, pinion_start
from facegear.teeth.tooth_family import ToothFamily, turn_about_axis

SAMPLES = 401
"""Points of a fillet along which its length is measured."""
COAST = -1
"""Sign of the flank that stands on the right of a gear tooth."""


@dataclass(frozen=True, eq=False)
class ToothSide(ABC):
    """One side of a tooth in n sections, in the frame in which it stands on the right.

    family: the pair's teeth in this frame. planes: places (n,) of the sections, m, y of the pinion's or gear
    radii of the gear's.
    """

    family: ToothFamily
    planes: Array

    @property
    @abstractmethod
    def tip_height(self) -> Array:
        """Height (n,) of the tip, m."""

    @property
    @abstractmethod
    def root_height(self) -> Array:
        """Height (n,) of the root land, m."""

    def flank_parameters(self, fraction: Array) -> tuple[Array, Array]:
        """Compute the parameters of the exact flank, evenly in roll (pinion: its square) from tip to fillet.

        Parameters
        ----------
        fraction : (k,) array
            Fractions of the flank, 0..1.

        Returns
        -------
        tuple of (k, n) arrays
            Pinion: roll angle, rad, and y, m; gear: roll angle and psi, rad.
        """
        return self._flank_place(fraction[:, None])

    def fillet_parameters(self, fraction: Array) -> tuple[Array, Array]:
        """Compute the parameters of the exact fillet, evenly along its length in the middle section.

        Parameters
        ----------
        fraction : (k,) array
            Fractions of the fillet, 0..1.

        Returns
        -------
        tuple of (k, n) arrays
            Pinion: gamma, rad, and y, m; gear: psi, rad, and gear radius, m.
        """
        return _same_shape(self._fillet_slope(np.interp(fraction, *self._lengths)), self.planes)

    def flank(self, fraction: Array) -> tuple[Array, Array]:
        """Compute points of the flank from tip to fillet.

        Parameters
        ----------
        fraction : (k,) array
            Fractions of the flank, 0..1.

        Returns
        -------
        tuple of (k, n) arrays
            Angle, rad, and height, m.
        """
        return self._flank_points(*self.flank_parameters(fraction))

    def fillet(self, fraction: Array) -> tuple[Array, Array]:
        """Compute points of the fillet from the flank to the root land.

        Parameters
        ----------
        fraction : (k,) array
            Fractions of the fillet, 0..1.

        Returns
        -------
        tuple of (k, n) arrays
            Angle, rad, and height, m.
        """
        return self.fillet_section(np.interp(fraction, *self._lengths))

    def fillet_section(self, part: Array) -> tuple[Array, Array]:
        """Compute points of the fillet evenly in the slope of its normal.

        Parameters
        ----------
        part : (k,) array
            Parts 0..1 of the slope's range, from the flank to the root land.

        Returns
        -------
        tuple of (k, n) arrays
            Angle, rad, and height, m.
        """
        return self._fillet_points(self._fillet_slope(part))

    @abstractmethod
    def _flank_place(self, fraction: Array) -> tuple[Array, Array]:
        """Return the parameters (k, n) of the flank at fractions (k, 1)."""

    @abstractmethod
    def _flank_points(self, u: Array, v: Array) -> tuple[Array, Array]:
        """Return angle (rad) and height (m) of flank points by their parameters, (k, n) each."""

    @abstractmethod
    def _fillet_points(self, slope: Array) -> tuple[Array, Array]:
        """Return angle (rad) and height (m), (k, n), of fillet points by slopes as of `_fillet_slope`."""

    @abstractmethod
    def _fillet_slope(self, part: Array) -> Array:
        """Return slopes of the fillet's normal, rad, (k, n) or (k, 1), at parts (k,) of their range."""

    @cached_property
    def _lengths(self) -> tuple[Array, Array]:
        """Fractions of the fillet's length in the middle section, and parts of the slope's range there."""
        grid, middle = np.linspace(0.0, 1.0, SAMPLES), self.planes[len(self.planes) // 2 :][:1]
        angle, height = (values[:, 0] for values in type(self)(self.family, middle).fillet_section(grid))
        across = angle * self._arm(middle[0], height)
        steps = np.hypot(np.diff(across), np.diff(height))
        length = np.concatenate([[0.0], np.cumsum(steps)])
        return length / length[-1], grid

    @abstractmethod
    def _arm(self, plane: float, height: Array) -> Array | float:
        """Return the radius (m) at which angles of a section are lengths."""


class PinionSide(ToothSide):
    """The side of a pinion tooth with the drive flank of a family, in planes across its axis."""

    @cached_property
    def surface(self) -> PinionFlank:
        """The flank."""
        return PinionFlank(self.family.pinion_flanks[0])

    @cached_property
    def root(self) -> PinionFillet:
        """The root beside the flank."""
        return pinion_fillet(self.family, 1)

    @cached_property
    def tip_height(self) -> Array:
        """Tip radius (n,), m."""
        return self.family.pinion_tip_radius + (self.planes - self.family.middle) * self.family.taper

    @cached_property
    def root_height(self) -> Array:
        """Root radius (n,), m."""
        family = self.family
        return family.pinion_pitch_radius - family.pinion_dedendum + family.shift(self.planes)

    @cached_property
    def roll_ends(self) -> tuple[Array, Array]:
        """Roll angles (n,), rad, where the involute ends at the tip or its chamfer, and at the root."""
        base = self.surface.helicoid.base_radius
        radius = self.tip_height - self.family.pinion_tip_chamfer
        top = np.sqrt(np.maximum((radius / base) ** 2 - 1.0, 0.0))
        return top, pinion_start(self.family, 1, self.planes) / base

    def _flank_place(self, fraction: Array) -> tuple[Array, Array]:
        top, bottom = self.roll_ends
        return _same_shape(np.sqrt(top**2 + fraction * (bottom**2 - top**2)), self.planes)

    def _flank_points(self, u: Array, v: Array) -> tuple[Array, Array]:
        return polar(self.surface.point(self.surface.helicoid.base_radius * u, v))

    def _fillet_points(self, slope: Array) -> tuple[Array, Array]:
        return polar(self.root.point(slope, self.planes))

    def _fillet_slope(self, part: Array) -> Array:
        start = self.surface.helicoid.pressure_angle
        return start + part[:, None] * (pi / 2 - start)

    def _arm(self, plane: float, height: Array) -> Array | float:
        return height


class GearSide(ToothSide):
    """The side of a gear tooth with the coast flank of a family, on cylinders about its axis."""

    @cached_property
    def surface(self) -> GearFlank:
        """The flank."""
        return gear_flank(self.family, COAST)

    @cached_property
    def root(self) -> GearFillet:
        """The fillet beside the flank."""
        return gear_fillet(self.family, COAST)

    @cached_property
    def tip_height(self) -> Array:
        """Height (n,) of the tip cone or plane, m."""
        return self.family.gear_tip.height(self.planes)

    @cached_property
    def root_height(self) -> Array:
        """Height (n,) of the root, the lowest place of the shaper's tip, m."""
        return self.root.point(self.root.y_at(self.planes, 1.0), 1.0)[..., 2]

    @cached_property
    def slope_ends(self) -> tuple[Array, Array]:
        """Slopes psi (n,), rad, of the normal where the fillet meets the flank, and at its lowest place."""
        root = self.root
        first, last = (root.y_at(self.planes, part) for part in (0.0, 1.0))
        return root.generate(first, 0.0).psi, root.generate(last, root.last_angle(last)).psi

    @cached_property
    def distance_ends(self) -> tuple[Array, Array]:
        """Distances s (n,), m, along the flank's normals where it ends at the tip and at the fillet."""
        _, top = self.surface.parameters_at(self.planes, self.tip_height)
        return top, flank_end(self.family, COAST, self.slope_ends[0])

    def _flank_place(self, fraction: Array) -> tuple[Array, Array]:
        top, end = self.distance_ends
        s = top + fraction * (end - top)
        return s / self.surface.shaper.base_radius, self.surface.slope_at(self.planes, s)

    def _flank_points(self, u: Array, v: Array) -> tuple[Array, Array]:
        return cylindrical(self.surface.point(v, self.surface.shaper.base_radius * u))

    def _fillet_points(self, slope: Array) -> tuple[Array, Array]:
        points = self.root.at_slope(self.planes, slope)
        return cylindrical(turn_about_axis(points.turn, points.position))

    def _fillet_slope(self, part: Array) -> Array:
        start, end = self.slope_ends
        return start + part[:, None] * (end - start)

    def _arm(self, plane: float, height: Array) -> Array | float:
        return plane


def polar(points: Array) -> tuple[Array, Array]:
    """Return angle and radius about the pinion's axis.

    Parameters
    ----------
    points : (..., 3) array
        In the pinion's body frame, m.

    Returns
    -------
    tuple of (...) arrays
        Angle from the half plane of tooth 0, rad, and radius, m.
    """
    return np.arctan2(points[..., 0], -points[..., 2]), np.hypot(points[..., 0], points[..., 2])


def cylindrical(points: Array) -> tuple[Array, Array]:
    """Return angle and height about the gear's axis.

    Parameters
    ----------
    points : (..., 3) array
        In the gear's body frame, m.

    Returns
    -------
    tuple of (...) arrays
        Angle from +y towards +x, rad, and z, m.
    """
    return np.arctan2(points[..., 0], points[..., 1]), points[..., 2]


def _same_shape(u: Array, v: Array) -> tuple[Array, Array]:
    """Return both arrays broadcast to their common shape."""
    u, v = np.broadcast_arrays(u, v)
    return u, v
