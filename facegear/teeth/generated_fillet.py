"""The face gear's fillet for the whole family: the envelope of the shaper's tip edge, sharp or rounded.

The tip rounding is a ball that runs along the shaper's tooth; a sharp edge is a ball of radius zero. Its
normals are square to the way of its centre, so that a point of the tool's rounding is named by y of the
centre and by the angle Delta of its normal from that of the flank, in the transverse section. With A and B
the components of the centre along that normal and across it, the equation of meshing becomes
K1 cos psi + K2 sin psi = K0 for the slope psi of the normal. Delta runs from 0 at the flank to the place
where B vanishes, the lowest at its gear radius. Derived for this project; the spur fillet is a limit.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize_scalar

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.helicoid import tip_distance
from facegear.teeth.tooth_family import (
    Helicoid,
    RelativeMotion,
    ToothFamily,
    across_axis,
    dot,
    turn_about_axis,
)

STEPS = 60
"""Newton steps before a gear radius counts as not reached; five are enough for teeth that can be cut."""
CLOSE = 1e-15
"""Newton step (m) that ends the search: rounding of a length of 0.1 m is some 1.4e-17 m."""
LARGEST_TURN = 0.3
"""Largest step of Delta (rad), a fraction of the fillet's whole turn."""
QUADRATIC = 1e-8
"""Newton step (m and rad) after which the next one is below rounding."""
SAMPLES = 257
"""Points of a section among which the smallest radius of curvature is looked for before it is refined."""


@dataclass(frozen=True, eq=False)
class FilletPoints:
    """Points (..., 3) of a fillet in the mesh frame as they are generated (m), with unit normals (..., 3).

    psi: slope of the normal in the shaper's transverse section (...), rad. turn: of the gear since they were
    generated (...), rad. slopes: derivatives of position, normal, psi and turn by y and by Delta, in pairs.
    """

    position: Array
    normal: Array
    psi: Array
    turn: Array
    position_slopes: tuple[Array, Array]
    normal_slopes: tuple[Array, Array]
    psi_slopes: tuple[Array, Array]
    turn_slopes: tuple[Array, Array]


@dataclass(frozen=True)
class GearFillet:
    """Fillet beside a flank of gear tooth 0 in the body frame, with parameters y and part.

    y: place (m) of the ball's centre along the pinion's axis. part: 0 at the flank, 1 at the lowest place.
    centre_radius: of the ball's centre from the shaper's axis at the y of the middle of its face, m.
    """

    shaper: Helicoid
    motion: RelativeMotion
    lift: float
    centre_radius: float
    rounding: float
    taper: float

    def last_angle(self, y: ArrayLike) -> Array:
        """Return the largest Delta: the angle of the lowest place's normal from the flank's.

        Parameters
        ----------
        y : (...) array_like
            Place of the ball's centre, m.

        Returns
        -------
        (...) array
            Delta, rad.
        """
        return np.arctan2(self.shaper.base_radius, self._roll(np.asarray(y, float))[0])

    def generate(self, y: ArrayLike, angle: ArrayLike) -> FilletPoints:
        """Compute points of the fillet as they are generated, in the mesh frame, and all derivatives.

        Parameters
        ----------
        y : (...) array_like
            Place of the ball's centre, m.
        angle : (...) array_like
            Angle Delta of the normal, rad.

        Returns
        -------
        FilletPoints
            Points in m and rad.
        """
        y, angle = np.broadcast_arrays(np.asarray(y, float), np.asarray(angle, float))
        side, lead, base = self.shaper.side, self.shaper.lead, self.shaper.base_radius
        gamma_s, gamma_c = self.motion.sine, self.motion.cosine
        ratio, offset = self.motion.ratio, side * self.motion.offset
        roll, roll_y = self._roll(y)
        c, s = np.cos(angle), np.sin(angle)
        a, b = roll * c + base * s, base * c - roll * s
        a_y, b_y = roll_y * c, -roll_y * s
        centre = self.centre_radius + (y - self.shaper.middle) * self.taper
        advance = (centre * self.taper + roll * lead) / base
        advance_y = (self.taper**2 + roll_y * lead) / base
        tilt, tilt_y, tilt_angle = lead * c - s * advance, -s * advance_y, -lead * s - c * advance
        k1 = y * gamma_s + self.lift * gamma_c - a * tilt * gamma_s
        k2 = b * tilt * gamma_s + offset * gamma_c
        k0 = b * (1.0 / ratio + gamma_c) + offset * tilt * gamma_s
        k1_y = gamma_s * (1.0 - a_y * tilt - a * tilt_y)
        k1_angle = -gamma_s * (b * tilt + a * tilt_angle)
        k2_y, k2_angle = (b_y * tilt + b * tilt_y) * gamma_s, (b * tilt_angle - a * tilt) * gamma_s
        k0_y = b_y * (1.0 / ratio + gamma_c) + offset * tilt_y * gamma_s
        k0_angle = -a * (1.0 / ratio + gamma_c) + offset * tilt_angle * gamma_s
        with np.errstate(invalid="ignore"):
            psi = np.arctan2(k2, k1) + np.arccos(k0 / np.hypot(k1, k2))
        cp, sp = np.cos(psi), np.sin(psi)
        steep = k1 * sp - k2 * cp
        psi_y = (k1_y * cp + k2_y * sp - k0_y) / steep
        psi_angle = (k1_angle * cp + k2_angle * sp - k0_angle) / steep
        # the section's point and the normal, in the basis of the normal's direction there and square to it
        level, level_tilt = 1.0 / np.sqrt(1.0 + tilt**2), -tilt / np.sqrt(1.0 + tilt**2) ** 3
        along, along_tilt = tilt * level, level + tilt * level_tilt
        rounding = self.rounding
        position = self._components(a + rounding * level, b, y + rounding * along, psi)
        position = position + np.array([self.motion.offset, self.lift * gamma_c, self.lift * gamma_s])
        normal = self._components(level, 0.0, along, psi)
        slopes = []
        for a_i, b_i, y_i, tilt_i, psi_i in (
            (a_y, b_y, 1.0, tilt_y, psi_y),
            (b, -a, 0.0, tilt_angle, psi_angle),
        ):
            level_i, along_i = level_tilt * tilt_i, along_tilt * tilt_i
            outer, outer_i = a + rounding * level, a_i + rounding * level_i
            point_slope = self._components(
                outer_i - b * psi_i, b_i + outer * psi_i, y_i + rounding * along_i, psi
            )
            slopes.append((point_slope, self._components(level_i, level * psi_i, along_i, psi)))
        phase = self.shaper.phase - rounding / (base * self.shaper.cosine)
        rolled_angle = (roll + lead * (y - self.shaper.middle)) / base
        turn = side * ratio * (rolled_angle - phase - psi + angle)
        turn_slopes = side * ratio * ((roll_y + lead) / base - psi_y), side * ratio * (1.0 - psi_angle)
        return FilletPoints(
            position=position,
            normal=normal,
            psi=psi,
            turn=turn,
            position_slopes=(slopes[0][0], slopes[1][0]),
            normal_slopes=(slopes[0][1], slopes[1][1]),
            psi_slopes=(psi_y, psi_angle),
            turn_slopes=turn_slopes,
        )

    def point(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute points of the fillet in the gear's body frame.

        Parameters
        ----------
        u : (...) array_like
            Place y of the ball's centre, m.
        v : (...) array_like
            Part of the way from the flank (0) to the lowest place (1).

        Returns
        -------
        (..., 3) array
            m.
        """
        points = self._at(u, v)
        return turn_about_axis(points.turn, points.position)

    def normal(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute outward unit normals of the fillet.

        Parameters
        ----------
        u : (...) array_like
            Place y of the ball's centre, m.
        v : (...) array_like
            Part of the way from the flank (0) to the lowest place (1).

        Returns
        -------
        (..., 3) array
            Unit vectors, dimensionless.
        """
        points = self._at(u, v)
        return -turn_about_axis(points.turn, points.normal)

    def tangents(self, u: ArrayLike, v: ArrayLike) -> tuple[Array, Array]:
        """Compute the exact derivatives of `point`.

        Parameters
        ----------
        u : (...) array_like
            Place y of the ball's centre, m.
        v : (...) array_like
            Part of the way from the flank (0) to the lowest place (1).

        Returns
        -------
        tuple of (..., 3) arrays
            Derivatives by y, dimensionless, and by the part, m.
        """
        u, v = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
        points = self._at(u, v)
        by_y, by_angle = (turn_about_axis(points.turn, part) for part in self._unturned_tangents(points))
        roll, roll_y = self._roll(u)
        base = self.shaper.base_radius
        last_y = -base * roll_y / (roll**2 + base**2)
        return by_y + (v * last_y)[..., None] * by_angle, self.last_angle(u)[..., None] * by_angle

    def y_at(self, radius: ArrayLike, part: ArrayLike) -> Array:
        """Find the parameter y of the fillet's point at a gear radius and a part, by Newton's method.

        Parameters
        ----------
        radius : (...) array_like
            Gear radius, m.
        part : (...) array_like
            Part of the way from the flank (0) to the lowest place (1).

        Returns
        -------
        (...) array
            y, m.

        Raises
        ------
        NotConverged
            Where the fillet does not reach the radius.
        """
        radius, part = np.broadcast_arrays(np.asarray(radius, float), np.asarray(part, float))
        y = (radius + (self.centre_radius - self.lift) * self.motion.cosine) / self.motion.sine
        step = np.full(radius.shape, np.inf)
        for _ in range(STEPS):
            points = self._at(y, part)
            by_y, by_angle = self._unturned_tangents(points)
            roll, roll_y = self._roll(y)
            last_y = -self.shaper.base_radius * roll_y / (roll**2 + self.shaper.base_radius**2)
            way = by_y + (part * last_y)[..., None] * by_angle
            plane = points.position[..., :2]
            residual = dot(plane, plane) - radius**2
            step = np.clip(residual / (2 * dot(plane, way[..., :2])), -0.2 * radius, 0.2 * radius)
            y = y - step
            if np.all(np.abs(step) < CLOSE * 8):
                return y
            if not np.all(np.isfinite(y)):
                break
        if np.all(np.abs(step) < 1e-12):
            return y
        raise NotConverged("geometry", "fillet at a gear radius", f"{STEPS} Newton steps")

    def at_slope(self, radius: ArrayLike, psi: ArrayLike) -> FilletPoints:
        """Find points of the fillet by gear radius and slope of the normal, by Newton's method.

        Parameters
        ----------
        radius : (...) array_like
            Gear radius, m.
        psi : (...) array_like
            Slope of the normal in the shaper's transverse section, rad.

        Returns
        -------
        FilletPoints
            Points in m and rad.

        Raises
        ------
        NotConverged
            Where the fillet has no such point.
        """
        radius, psi = np.broadcast_arrays(np.asarray(radius, float), np.asarray(psi, float))
        y = (radius + (self.centre_radius - self.lift) * self.motion.cosine) / self.motion.sine
        first = self.shaper.pressure_angle
        angle = np.clip((psi - first) / (np.pi / 2 - first), 0.0, 1.0) * self.last_angle(y)
        for _ in range(STEPS):
            points = self.generate(y, angle)
            plane = points.position[..., :2]
            far, steep = dot(plane, plane) - radius**2, points.psi - psi
            far_y, far_angle = (2 * dot(plane, part[..., :2]) for part in points.position_slopes)
            steep_y, steep_angle = points.psi_slopes
            scale = far_y * steep_angle - far_angle * steep_y
            y_step = (far * steep_angle - far_angle * steep) / scale
            angle_step = (far_y * steep - far * steep_y) / scale
            y = y - np.clip(y_step, -0.2 * radius, 0.2 * radius)
            angle = angle - np.clip(angle_step, -LARGEST_TURN, LARGEST_TURN)
            largest = np.max(np.abs(y_step)) + np.max(np.abs(angle_step))
            if not largest > QUADRATIC:
                break
        if not largest <= QUADRATIC:
            raise NotConverged("geometry", "fillet at a gear radius", f"{STEPS} Newton steps")
        return self.generate(y, angle)

    def curvatures(self, y: ArrayLike, part: ArrayLike) -> Array:
        """Compute the principal curvatures of the fillet.

        Parameters
        ----------
        y : (...) array_like
            Place of the ball's centre, m.
        part : (...) array_like
            Part of the way from the flank (0) to the lowest place (1).

        Returns
        -------
        (..., 2) array
            Curvatures, 1/m, in rising order, with sign; inf at the corner that a sharp edge leaves.
        """
        points = self._at(y, part)
        tangents = np.stack(self._unturned_tangents(points), axis=-2)
        around = across_axis(points.normal)
        changes = np.stack(
            [
                slope + turn[..., None] * around
                for slope, turn in zip(points.normal_slopes, points.turn_slopes, strict=True)
            ],
            axis=-2,
        )
        first = tangents @ np.swapaxes(tangents, -1, -2)
        second = changes @ np.swapaxes(tangents, -1, -2)
        cross, area = (second[..., 0, 1] + second[..., 1, 0]) / 2, np.linalg.det(first)
        mean = first[..., 0, 0] * second[..., 1, 1] + first[..., 1, 1] * second[..., 0, 0]
        mean = mean / 2 - first[..., 0, 1] * cross
        bend = second[..., 0, 0] * second[..., 1, 1] - cross**2
        apart = np.sqrt(np.maximum(mean**2 - bend * area, 0.0))
        with np.errstate(divide="ignore", invalid="ignore"):
            curvatures = np.stack([mean - apart, mean + apart], axis=-1) / area[..., None]
        return np.where(np.isnan(curvatures), np.inf, curvatures)

    def smallest_radius(self, radius: float) -> float:
        """Compute the smallest principal radius of curvature of the fillet at a gear radius.

        Parameters
        ----------
        radius : float
            Gear radius, m.

        Returns
        -------
        float
            m.
        """

        def sharpness(part: ArrayLike) -> Array:
            """Return the largest magnitude of curvature (1/m) at parts (...) of the section."""
            return np.abs(self.curvatures(self.y_at(radius, part), part)).max(axis=-1)

        parts = np.linspace(0.0, 1.0, SAMPLES)
        sharp = sharpness(parts)
        best = int(np.argmax(sharp))
        if np.isinf(sharp[best]):
            return 0.0
        low, high = parts[max(best - 1, 0)], parts[min(best + 1, SAMPLES - 1)]
        solution = minimize_scalar(
            lambda part: -float(sharpness(part)),
            bounds=(low, high),
            method="bounded",
            options={"xatol": 1e-9},
        )
        return 1.0 / max(float(-solution.fun), float(sharp[best]))

    def _at(self, y: ArrayLike, part: ArrayLike) -> FilletPoints:
        """Return `generate` at the part (0 to 1) of the largest Delta."""
        return self.generate(y, np.asarray(part, float) * self.last_angle(y))

    def _roll(self, y: Array) -> tuple[Array, Array]:
        """Return the length of roll (m) of the ball's centre, sqrt(radius^2 - r_b^2), and its slope by y."""
        centre = self.centre_radius + (y - self.shaper.middle) * self.taper
        with np.errstate(invalid="ignore"):
            roll = np.sqrt(centre**2 - self.shaper.base_radius**2)
        return roll, centre * self.taper / roll

    def _components(self, normal: Array, square: Array | float, along: Array, psi: Array) -> Array:
        """Return mesh-frame vectors (..., 3) from parts along the normal in the section, square to it,
        and along a.
        """
        cp, sp, side = np.cos(psi), np.sin(psi), self.shaper.side
        x, u = side * (normal * cp - square * sp), -(normal * sp + square * cp)
        gamma_s, gamma_c = self.motion.sine, self.motion.cosine
        return np.stack([x, along * gamma_s + u * gamma_c, u * gamma_s - along * gamma_c], axis=-1)

    def _unturned_tangents(self, points: FilletPoints) -> tuple[Array, Array]:
        """Return tangents (..., 3) by y and by Delta (m/rad), before they are turned to the body frame."""
        around = across_axis(points.position)
        first, second = (
            slope + turn[..., None] * around
            for slope, turn in zip(points.position_slopes, points.turn_slopes, strict=True)
        )
        return first, second


@lru_cache(maxsize=256)
def gear_fillet(family: ToothFamily, side: int) -> GearFillet:
    """Return the fillet that the shaper's tip cuts beside a flank of the gear.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank: +1 drive, -1 coast.

    Returns
    -------
    GearFillet
        The fillet.
    """
    shaper = family.shaper_flanks[0 if side > 0 else 1]
    motion = family.cutting_motion
    return GearFillet(
        shaper, motion, family.lift, family.rounding_centre, family.shaper_tip_rounding, family.taper
    )


def flank_end(family: ToothFamily, side: int, psi: ArrayLike) -> Array:
    """Compute s where the gear's flank ends: at the shaper's tip edge or where its tip rounding begins.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank: +1 drive, -1 coast.
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
