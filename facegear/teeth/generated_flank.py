"""The face gear's flank for the whole family, in closed form.

For a slope psi of the normal the equation of meshing of shaper and gear is linear in the place along the
pinion's axis, so that all contacts with this slope lie on one straight line in space, their common normal.
The flank is that line, laid off by s from the shaper's base cylinder and turned into the gear's body frame.
Derived for this project; spur teeth are a limit (Litvin and Fuentes 2004, chapter 18). Symbols as in
`tooth_family`; the turn of a point is that of the gear since the shaper generated it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import cos, sin, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array, Mask
from facegear.errors import NotConverged
from facegear.teeth.tooth_family import (
    Helicoid,
    RelativeMotion,
    ToothFamily,
    across_axis,
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
SURE = 1e-9
"""Residual over the squared radius above which no place counts as found, however steep the residual is."""
ACCURATE = 1e-12
"""Largest Newton step of psi (rad) with which a point counts as found."""
EXACT = np.finfo(float).eps
"""Relative residual that ends Newton's method where steps stay above `CLOSE` by rounding."""
ROUNDING = 16 * np.finfo(float).eps
"""Relative residual that counts as zero where steps cannot shrink any further, near a fold."""


@dataclass(frozen=True, eq=False)
class NormalLines:
    """Lines of contact of shaper and gear in the mesh frame, one a slope psi, and their derivatives by psi.

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
        """Turn of the gear per length s along the normal, rad/m, signed as the flank."""
        shaper = self.shaper
        return shaper.side * self.motion.ratio / (shaper.cosine * shaper.base_radius)

    def lines(self, psi: ArrayLike) -> NormalLines:
        """Return the lines in space on which shaper and gear touch with given slopes of the normal.

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
        """Return the angle by which the gear has turned since the shaper generated a point.

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
        """Compute points of the flank in the body frame, in closed form.

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
        psi, s = np.asarray(u, float), np.asarray(v, float)
        parts = self.line_components(np.cos(psi), np.sin(psi))
        turn = self.turn(psi, s, parts[12])
        c, sine = np.cos(turn), np.sin(turn)
        x, y = parts[0] + s * parts[6], parts[1] + s * parts[7]
        return stack_vectors(x * c - y * sine, x * sine + y * c, parts[2] + s * parts[8])

    def normal(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute unit normals of the flank in the body frame, out of the gear's tooth.

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
        """Compute the exact derivatives of `point`.

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
        """Compute the exact derivatives of `normal`.

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

    def parameters_at(self, radius: ArrayLike, height: ArrayLike) -> tuple[Array, Array]:
        """Find the parameters of the flank's point at a gear radius and a height, by Newton's method in psi.

        Parameters
        ----------
        radius : (...) array_like
            Gear radius, m.
        height : (...) array_like
            Height z, m.

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
        psi, s = self.search(radius, height)
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
            Slopes to start from, rad; by default those of spur teeth.

        Returns
        -------
        tuple of (...) arrays
            psi, rad, and s, m.
        """
        radius, height = np.broadcast_arrays(np.asarray(radius, float), np.asarray(height, float))
        near = self._spur_slope(radius) if near is None else near
        start = np.broadcast_to(np.asarray(near, float), radius.shape)
        psi, s = self._sound_place(start, radius, height)
        for shift in FURTHER_STARTS:
            rows = np.isnan(psi)
            if not rows.any():
                break
            retry_psi, retry_s = self._sound_place(start[rows] + shift, radius[rows], height[rows])
            psi, s = psi.copy(), s.copy()
            psi[rows], s[rows] = retry_psi, retry_s
        return psi, s

    def slope_at(self, radius: ArrayLike, s: ArrayLike) -> Array:
        """Find the slope psi of the flank's point with a gear radius and a distance s along the normal.

        Parameters
        ----------
        radius : (...) array_like
            Gear radius, m.
        s : (...) array_like
            Distance along the normal, m.

        Returns
        -------
        (...) array
            psi, rad.

        Raises
        ------
        NotConverged
            Where no normal reaches the radius at this distance.
        """
        radius, s = np.broadcast_arrays(np.asarray(radius, float), np.asarray(s, float))

        def residual(parts: tuple[Array, ...]) -> tuple[Array, Array]:
            """Return the excess of the squared radius (m2) at the given s, and its slope by psi."""
            return _radius_residual(parts, radius, s, 0.0)

        psi, _, is_found = self._newton(self._spur_slope(radius), radius, residual)
        if not np.all(is_found):
            raise NotConverged("geometry", "slope at a gear radius", f"{STEPS} Newton steps")
        return psi

    def growth_at_height(self, psi: float, height: float) -> tuple[float, float, float]:
        """Return where the line of a slope reaches a height, and how fast the radius grows there.

        Parameters
        ----------
        psi : float
            Slope of the normal, rad.
        height : float
            Height z, m.

        Returns
        -------
        tuple of float
            Distance s along the normal, m; gear radius, m; derivative of its square by psi, m2/rad, which
            vanishes on the singular line.
        """
        parts = self.line_components(cos(psi), sin(psi))
        s, s_psi = _distance_at(parts, height)
        square, slope = _radius_residual(parts, 0.0, s, s_psi)
        return s, sqrt(square), slope

    def _spur_slope(self, radius: Array) -> Array:
        """Return the slope (rad) of spur teeth on the pitch line, from which searches start."""
        return np.arccos(np.clip(self.shaper.base_radius / self.motion.ratio / radius, -1.0, FLATTEST))

    def _sound_place(self, start: Array, radius: Array, height: Array) -> tuple[Array, Array]:
        """Return psi and s (n,) at radii and heights (n,) from starts of psi; nan if no root is on the
        sound side.
        """

        def residual(parts: tuple[Array, ...]) -> tuple[Array, Array]:
            """Return the excess of the squared radius (m2) at the given height, and its slope by psi."""
            return _radius_residual(parts, radius, *_distance_at(parts, height))

        psi, slope, is_found = self._newton(start, radius, residual)
        # at one height the radius grows with the slope on one side of the singular line only
        is_found = is_found & (slope * self._growth_sign > 0.0)
        s = _distance_at(self.line_components(np.cos(psi), np.sin(psi)), height)[0]
        return np.where(is_found, psi, np.nan), np.where(is_found, s, np.nan)

    def _newton(
        self, start: Array, radius: Array, residual: Callable[[tuple[Array, ...]], tuple[Array, Array]]
    ) -> tuple[Array, Array, Mask]:
        """Return psi (n,), the residual's slope (m2/rad) there, and whether each is a root; psi stays in
        SLOPES.
        """
        psi = np.asarray(start, float)
        for _ in range(STEPS):
            value, slope = residual(self.line_components(np.cos(psi), np.sin(psi)))
            with np.errstate(divide="ignore", invalid="ignore"):
                step = np.clip(value / slope, -LARGEST_STEP, LARGEST_STEP)
            step = np.where(np.isfinite(step), step, 0.0)
            psi = np.clip(psi - step, *SLOPES)
            if np.all((np.abs(step) < CLOSE) | (np.abs(value) <= EXACT * radius**2)):
                break
        # where the normal is upright s has no bound, and a slope without bound would let any place pass
        step_limit = np.minimum(ACCURATE * np.abs(slope), SURE * radius**2)
        return psi, slope, np.abs(value) <= np.maximum(ROUNDING * radius**2, step_limit)

    @cached_property
    def _growth_sign(self) -> float:
        """Sign of d radius / d psi at constant height on the pitch line, which all sound places share."""
        angle = self.shaper.pressure_angle
        parts = self.line_components(np.cos(angle), np.sin(angle))
        height = parts[2] + self.pitch_distance * parts[8]
        return float(np.sign(_radius_residual(parts, 0.0, *_distance_at(parts, height))[1]))

    @property
    def pitch_distance(self) -> float:
        """Distance s (m) at which the normal of the nominal slope meets the shaper's pitch line."""
        return self.shaper.pitch_radius * float(np.sin(self.shaper.pressure_angle)) / self.shaper.cosine

    def _turn_by_psi(self, lines: NormalLines) -> Array:
        """Return the derivative of the turn by psi (...), dimensionless."""
        return self.rise * self.shaper.sine * lines.y_slope - self.shaper.side * self.motion.ratio

    def _unturned_tangents(self, lines: NormalLines, s: Array) -> tuple[Array, Array]:
        """Return the tangents (..., 3) by psi (m/rad) and by s, before they are turned to the body frame."""
        around = across_axis(lines.foot + s[..., None] * lines.normal)
        by_psi = lines.foot_slope + s[..., None] * lines.normal_slope
        return by_psi + self._turn_by_psi(lines)[..., None] * around, lines.normal + self.rise * around


def _distance_at(parts: tuple[Numbers, ...], height: Numbers) -> tuple[Numbers, Numbers]:
    """Return s (m) at which lines of `line_components` reach a height z, and d s / d psi at that height."""
    s = (height - parts[2]) / parts[8]
    return s, -(parts[5] + s * parts[11]) / parts[8]


def _radius_residual(
    parts: tuple[Numbers, ...], radius: Numbers, s: Numbers, s_psi: Numbers
) -> tuple[Numbers, Numbers]:
    """Return x^2 + y^2 - radius^2 (m2) of lines at s, and its derivative by psi, s changing by `s_psi`."""
    x, y = parts[0] + s * parts[6], parts[1] + s * parts[7]
    x_psi = parts[3] + s * parts[9] + s_psi * parts[6]
    y_psi = parts[4] + s * parts[10] + s_psi * parts[7]
    return x * x + y * y - radius * radius, 2 * (x * x_psi + y * y_psi)


@lru_cache(maxsize=256)
def gear_flank(family: ToothFamily, side: int) -> GearFlank:
    """Return the flank of the gear that the family's shaper generates.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank: +1 drive, -1 coast.

    Returns
    -------
    GearFlank
        The flank.
    """
    return GearFlank(family.shaper_flanks[0 if side > 0 else 1], family.cutting_motion, family.lift)
