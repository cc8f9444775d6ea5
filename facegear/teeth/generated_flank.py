"""The face gear's flank for the whole family, in closed form.

For a slope psi of the normal the equation of meshing of shaper and gear is linear in the place along the
pinion's axis, so that all contacts with this slope lie on one straight line in space, their common normal.
The flank is that line, laid off by s from the shaper's base cylinder and turned into the gear's body frame.
Derived for this project; spur teeth are a limit (Litvin and Fuentes 2004, chapter 18). Symbols as in
`tooth_family`; the turn of a point is that of the gear since the shaper generated it.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.teeth.tooth_family import (
    Helicoid,
    RelativeMotion,
    ToothFamily,
    across_axis,
    dot,
    stack_vectors,
    turn_about_axis,
)

Numbers = Any
"""A single number, or an array of them."""
STEPS = 60
"""Newton steps before a point counts as not found; ten are enough away from folds."""
LARGEST_STEP = 0.1
"""Largest step of psi (rad), well below the distance of both solutions at a place of the flank."""
CLOSE = 1e-14
"""Step of psi (rad) that ends Newton's method: rounding of psi itself."""
SLOPES = (-1.2, 1.5)
"""Slopes psi (rad) between which a place is looked for; sound flanks lie well inside."""
FLATTEST = float(np.cos(0.05))
"""Cosine of the smallest slope from which a search starts, inside the gear's base radius."""
FURTHER_STARTS = (-0.15, 0.2, -0.35)
"""Shifts (rad) of the start where a search ended beyond the singular line, as it does near the inner end of
helical flanks, whose slopes differ from those of spur teeth that it starts from."""
ACCURATE = 1e-12
"""Largest Newton step of psi (rad) with which a point counts as found."""
ROUNDING = 16 * np.finfo(float).eps
"""Relative residual that counts as zero where steps cannot shrink any further, near a fold."""


@dataclass(frozen=True, eq=False)
class NormalLines:
    """Lines of contact of shaper and gear, one for each slope, and their derivatives by the slope.

    foot, foot_slope: place (..., 3) on the shaper's base cylinder (m) and its derivative (m/rad). normal,
    normal_slope: direction from pinion to gear (..., 3) and its derivative. y, y_slope: place of the foot
    along the pinion's axis (...), m, and its derivative, m/rad.
    """

    foot: Array
    foot_slope: Array
    normal: Array
    normal_slope: Array
    y: Array
    y_slope: Array


@dataclass(frozen=True)
class GearFlank:
    """Flank of gear tooth 0 (drive: left, coast: right) in the body frame, with parameters psi and s.

    psi is the slope of the normal (rad), s the distance (m) along it from the shaper's base cylinder.
    """

    shaper: Helicoid
    motion: RelativeMotion
    lift: float

    @cached_property
    def rise(self) -> float:
        """Turn of the gear per length along the normal, rad/m."""
        shaper = self.shaper
        return shaper.side * self.motion.ratio / (shaper.cosine * shaper.base_radius)

    def lines(self, psi: ArrayLike) -> NormalLines:
        """Return the lines of contact of given slopes.

        Parameters
        ----------
        psi : (...) array_like
            Slope of the normal, rad.

        Returns
        -------
        NormalLines
            Lines in m and rad.
        """
        psi = np.asarray(psi, float)
        parts = self.line_components(np.cos(psi), np.sin(psi))
        foot, foot_psi, normal, normal_psi = (
            stack_vectors(*parts[first : first + 3]) for first in (0, 3, 6, 9)
        )
        return NormalLines(foot, foot_psi, normal, normal_psi, parts[12], parts[13])

    def line_components(self, cosine: Numbers, sine: Numbers) -> tuple[Numbers, ...]:
        """Return the components of the lines of contact, for single numbers as for arrays.

        Parameters
        ----------
        cosine : Numbers
            Cosine of the slope psi.
        sine : Numbers
            Sine of the slope psi.

        Returns
        -------
        tuple
            Three components each of foot (m), its slope (m/rad), normal and its slope; y (m) and its slope.
        """
        side, base, c, s = self.shaper.side, self.shaper.base_radius, cosine, sine
        eta, across = self.shaper.sine, self.shaper.cosine
        gamma_s, gamma_c = self.motion.sine, self.motion.cosine
        x, x_psi = self.motion.offset - side * base * s, -side * base * c
        w, w_psi = self.lift - base * c, base * s
        n_y, n_y_psi = eta * gamma_s - across * gamma_c * s, -across * gamma_c * c
        upper = side * base * across / self.motion.ratio + n_y * x
        lower = side * across * c
        y = (upper / lower - w * gamma_c) / gamma_s
        y_psi = ((n_y_psi * x + n_y * x_psi + upper * s / c) / lower - w_psi * gamma_c) / gamma_s
        return (
            *(x, y * gamma_s + w * gamma_c, w * gamma_s - y * gamma_c),
            *(x_psi, y_psi * gamma_s + w_psi * gamma_c, w_psi * gamma_s - y_psi * gamma_c),
            *(lower, n_y, -eta * gamma_c - across * gamma_s * s),
            *(-side * across * s, n_y_psi, -across * gamma_s * c),
            *(y, y_psi),
        )

    def turn(self, psi: ArrayLike, s: ArrayLike, y: ArrayLike) -> Array:
        """Return the gear's turn since a point was generated.

        Parameters
        ----------
        psi : (...) array_like
            Slope of the normal, rad.
        s : (...) array_like
            Distance along the normal, m.
        y : (...) array_like
            Place of the line's foot along the pinion's axis (`NormalLines.y`), m.

        Returns
        -------
        (...) array
            rad.
        """
        shaper = self.shaper
        rolled_angle = np.asarray(s, float) + shaper.sine * (np.asarray(y, float) - shaper.middle)
        return self.rise * rolled_angle - shaper.side * self.motion.ratio * (
            np.asarray(psi, float) + shaper.phase
        )

    def point(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute points of the flank.

        Parameters
        ----------
        u : (...) array_like
            Slope psi, rad.
        v : (...) array_like
            Distance s along the normal, m.

        Returns
        -------
        (..., 3) array
            m.
        """
        lines, s = self.lines(u), np.asarray(v, float)
        return turn_about_axis(self.turn(u, s, lines.y), lines.foot + s[..., None] * lines.normal)

    def normal(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute outward unit normals of the flank.

        Parameters
        ----------
        u : (...) array_like
            Slope psi, rad.
        v : (...) array_like
            Distance s along the normal, m.

        Returns
        -------
        (..., 3) array
            Unit vectors, dimensionless.
        """
        lines = self.lines(u)
        return -turn_about_axis(self.turn(u, v, lines.y), lines.normal)

    def tangents(self, u: ArrayLike, v: ArrayLike) -> tuple[Array, Array]:
        """Compute the derivatives of the points.

        Parameters
        ----------
        u : (...) array_like
            Slope psi, rad.
        v : (...) array_like
            Distance s along the normal, m.

        Returns
        -------
        tuple of (..., 3) arrays
            Derivatives by psi, m/rad, and by s, dimensionless.
        """
        lines, s = self.lines(u), np.asarray(v, float)
        turn = self.turn(u, s, lines.y)
        by_psi, by_s = self._unturned_tangents(lines, s)
        return turn_about_axis(turn, by_psi), turn_about_axis(turn, by_s)

    def normal_tangents(self, u: ArrayLike, v: ArrayLike) -> tuple[Array, Array]:
        """Compute the derivatives of the outward unit normals.

        Parameters
        ----------
        u : (...) array_like
            Slope psi, rad.
        v : (...) array_like
            Distance s along the normal, m.

        Returns
        -------
        tuple of (..., 3) arrays
            Derivatives by psi, 1/rad, and by s, 1/m.
        """
        lines = self.lines(u)
        turn = self.turn(u, v, lines.y)
        around = across_axis(lines.normal)
        by_psi = lines.normal_slope + self._turn_by_psi(lines)[..., None] * around
        return -turn_about_axis(turn, by_psi), -turn_about_axis(turn, self.rise * around)

    def singularity(self, psi: ArrayLike, s: ArrayLike) -> Array:
        """Return the quadratic of s that vanishes where the flank is singular.

        Parameters
        ----------
        psi : (...) array_like
            Slope of the normal, rad.
        s : (...) array_like
            Distance along the normal, m.

        Returns
        -------
        (...) array
            m2/rad; its sign is the same on all of a sound flank.
        """
        square, linear, constant = self.singular_quadratic(psi)
        s = np.asarray(s, float)
        return (square * s + linear) * s + constant

    def singular_quadratic(self, psi: ArrayLike) -> tuple[Array, Array, Array]:
        """Return the coefficients of the singular line's quadratic in s.

        Parameters
        ----------
        psi : (...) array_like
            Slope of the normal, rad.

        Returns
        -------
        tuple of (...) arrays
            Coefficients of s squared (1/rad), of s (m/rad), and without s (m2/rad).
        """
        lines = self.lines(psi)
        foot, normal, foot_psi, normal_psi = lines.foot, lines.normal, lines.foot_slope, lines.normal_slope
        along = dot(normal, foot)
        along_psi = dot(normal_psi, foot) + dot(normal, foot_psi)
        square = normal_psi[..., 2]
        linear = foot_psi[..., 2] + normal_psi[..., 2] * along - normal[..., 2] * along_psi
        return square, linear, foot_psi[..., 2] * along - normal[..., 2] * dot(foot, foot_psi)

    def parameters_at(
        self, radius: ArrayLike, height: ArrayLike, near: ArrayLike | None = None
    ) -> tuple[Array, Array]:
        """Find the parameters of the flank at a gear radius and a height.

        Parameters
        ----------
        radius : (...) array_like
            Gear radius, m.
        height : (...) array_like
            Height z, m.
        near : (...) array_like, optional
            Slopes to start from, rad.

        Returns
        -------
        tuple of (...) arrays
            psi, rad, and s, m.

        Raises
        ------
        NotConverged
            Where the flank has no such place, or only beyond its singular line.
        """
        radius, height = np.broadcast_arrays(np.asarray(radius, float), np.asarray(height, float))
        psi, s = self.search(radius, height, near)
        if not np.all(np.isfinite(psi)):
            index = np.argmax(~np.isfinite(psi).ravel())
            place_text = f"{1e3 * radius.flat[index]:.3f} mm from the axis"
            raise NotConverged("geometry", f"flank at a height, {place_text}", f"{STEPS} Newton steps")
        return psi, s

    def search(self, radius: Array, height: Array, near: ArrayLike | None = None) -> tuple[Array, Array]:
        """Find the parameters of the flank as `parameters_at` does, nan where there is no such place.

        Parameters
        ----------
        radius : (...) array
            Gear radius, m.
        height : (...) array
            Height z, m.
        near : (...) array_like, optional
            Slopes to start from, rad.

        Returns
        -------
        tuple of (...) arrays
            psi, rad, and s, m.
        """
        radius, height = np.broadcast_arrays(np.asarray(radius, float), np.asarray(height, float))
        if near is None:
            near = np.arccos(np.clip(self.shaper.base_radius / self.motion.ratio / radius, -1.0, FLATTEST))
        start = np.broadcast_to(np.asarray(near, float), radius.shape)
        psi, s = self._newton(start, radius, height)
        for shift in FURTHER_STARTS:
            rows = np.isnan(psi)
            if not rows.any():
                break
            retry_psi, retry_s = self._newton(start[rows] + shift, radius[rows], height[rows])
            psi, s = psi.copy(), s.copy()
            psi[rows], s[rows] = retry_psi, retry_s
        return psi, s

    def _newton(self, start: Array, radius: Array, height: Array) -> tuple[Array, Array]:
        """Return psi and s at radii and heights by Newton's method, nan where it ends elsewhere."""
        psi, is_close = np.asarray(start, float), np.zeros(radius.shape, bool)
        for _ in range(STEPS):
            s, residual, slope = _radius_residual(self.lines(psi), radius, height)
            with np.errstate(divide="ignore", invalid="ignore"):
                step = np.clip(residual / slope, -LARGEST_STEP, LARGEST_STEP)
            step = np.where(is_close | ~np.isfinite(step), 0.0, step)
            is_close = is_close | (np.abs(step) < CLOSE)
            if is_close.all():
                break
            psi = np.clip(psi - step, *SLOPES)
        s, residual, slope = _radius_residual(self.lines(psi), radius, height)
        is_found = np.abs(residual) <= np.maximum(ROUNDING * radius**2, ACCURATE * np.abs(slope))
        is_found &= np.sign(self.singularity(psi, s)) == self.sound_sign
        return np.where(is_found, psi, np.nan), np.where(is_found, s, np.nan)

    @cached_property
    def sound_sign(self) -> float:
        """Sign of `singularity` on the flank: that at the pressure angle, on the pitch line."""
        angle = self.shaper.pressure_angle
        length = self.shaper.pitch_radius * np.sin(angle) / self.shaper.cosine
        return float(np.sign(self.singularity(angle, length)))

    def _turn_by_psi(self, lines: NormalLines) -> Array:
        return self.rise * self.shaper.sine * lines.y_slope - self.shaper.side * self.motion.ratio

    def _unturned_tangents(self, lines: NormalLines, s: Array) -> tuple[Array, Array]:
        around = across_axis(lines.foot + s[..., None] * lines.normal)
        by_psi = lines.foot_slope + s[..., None] * lines.normal_slope
        return by_psi + self._turn_by_psi(lines)[..., None] * around, lines.normal + self.rise * around


def _radius_residual(lines: NormalLines, radius: Array, height: Array) -> tuple[Array, Array, Array]:
    """Return s at the height, by how much the squared radius is too large there, and its derivative."""
    foot, normal = lines.foot, lines.normal
    s = (height - foot[..., 2]) / normal[..., 2]
    s_psi = -(lines.foot_slope[..., 2] + s * lines.normal_slope[..., 2]) / normal[..., 2]
    plane = foot[..., :2] + s[..., None] * normal[..., :2]
    plane_psi = lines.foot_slope[..., :2] + s[..., None] * lines.normal_slope[..., :2]
    plane_psi = plane_psi + s_psi[..., None] * normal[..., :2]
    return s, dot(plane, plane) - radius * radius, 2 * dot(plane, plane_psi)


@lru_cache(maxsize=256)
def gear_flank(family: ToothFamily, side: int) -> GearFlank:
    """Return a flank of the gear of a family.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank.

    Returns
    -------
    GearFlank
        The flank.
    """
    return GearFlank(family.shaper_flanks[0 if side > 0 else 1], family.cutting_motion, family.lift)


def flank_end(family: ToothFamily, side: int, psi: ArrayLike) -> Array:
    """Compute where the flank ends: at the shaper's tip edge or where its tip rounding begins.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank.
    psi : (...) array_like
        Slope of the normal, rad.

    Returns
    -------
    (...) array
        Distance s along the normal, m; nan where the shaper's tip stays inside its base cylinder.
    """
    flank, taper = gear_flank(family, side), family.taper
    y, shaper = flank.lines(psi).y, flank.shaper
    radius = family.rounding_centre + (y - family.middle) * taper
    return tip_distance(shaper, radius, taper) + family.shaper_tip_rounding


def tip_distance(helicoid: Helicoid, radius: ArrayLike, taper: float) -> Array:
    """Compute the distance along a normal at which a helicoid reaches a tip cone.

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
