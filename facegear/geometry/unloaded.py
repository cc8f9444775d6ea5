"""Unloaded contact of the pair: where the flanks touch, the transmission error, the other pairs' gaps."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.errors import NotConverged
from facegear.geometry import pinion
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion_surface import SurfacePoints, flank_points
from facegear.geometry.placement import conjugate_angle
from facegear.geometry.separation import separation

Array = NDArray[np.float64]

PAIRS = np.arange(-2, 3)
"""Tooth numbers looked at: at phi1 within half a pitch of zero no other pair can touch."""


@dataclass(frozen=True)
class UnloadedContact:
    """Flank contact at p pinion angles.

    phi1, phi2: (p,) rad. transmission_error: (p,) m, (phi2 - phi1 N1 / N2) r_b2, along the line of action.
    tooth: (p,) number of the touching pair. gap, roll, y: (p, 5) for the pairs -2..2 the smallest separation
    (m) and where it is on the pinion (rad, m); inf and nan where a pair does not face each other.
    """

    phi1: Array
    phi2: Array
    transmission_error: Array
    tooth: NDArray[np.int64]
    gap: Array
    roll: Array
    y: Array

    @property
    def path(self) -> tuple[Array, Array]:
        """Roll angle (rad) and y (m) of the touching point, (p,)."""
        rows = np.arange(len(self.phi1))
        column = np.searchsorted(PAIRS, self.tooth)
        return self.roll[rows, column], self.y[rows, column]


def unloaded_contact(design: PairDesign, phi1: ArrayLike) -> UnloadedContact:
    """Turn the gear against the drive side of the pinion until the flanks just touch, for every phi1 (rad).

    Flank against flank only, edges of both included; what fillets and tips do then is `clearance`'s.
    Raises NotConverged where no pair of flanks faces each other or the touch is not found to 1e-14 m.
    """
    phi1 = np.atleast_1d(np.asarray(phi1, float))
    conjugate = conjugate_angle(design, phi1)
    phi2 = conjugate - design.pinion.thinning / 2 / design.gear_base_radius
    roll, y, size = _coarse(design, phi1, phi2)
    levels = 16
    for _ in range(12):
        gap, roll, y = _zoom(design, phi1, phi2, roll, y, size, levels)
        smallest = gap.min(axis=1)
        if not np.all(np.isfinite(smallest)):
            where = f"phi1 = {phi1[~np.isfinite(smallest)][0]:.6f} rad"
            raise NotConverged("unloaded contact", where, "tooth pairs -2..2: no flanks face each other")
        if np.max(np.abs(smallest)) < 1e-14:
            error = (phi2 - conjugate) * design.gear_base_radius
            return UnloadedContact(phi1, phi2, error, PAIRS[np.argmin(gap, axis=1)], gap, roll, y)
        phi2 -= smallest / design.gear_base_radius
        # a turn by d moves the touching point by at most some d L: look again around the last one
        size = np.minimum(size, np.array([1e-3, 1e-4]))
    raise NotConverged(
        "unloaded contact", f"residual gap {np.max(np.abs(smallest)):.1e} m", "12 turns of the gear"
    )


def pair_gaps(design: PairDesign, phi1: ArrayLike, phi2: ArrayLike) -> tuple[Array, Array, Array]:
    """Smallest flank separation (m) of the pairs -2..2 at given angles, its roll (rad) and y (m): (p, 5)."""
    phi1, phi2 = np.atleast_1d(np.asarray(phi1, float)), np.atleast_1d(np.asarray(phi2, float))
    roll, y, size = _coarse(design, phi1, phi2)
    return _zoom(design, phi1, phi2, roll, y, size, 16)


def _bounds(design: PairDesign) -> tuple[Array, Array]:
    half = design.pinion.width / 2
    low = np.array([pinion.junction_roll(design), design.mean_radius - half])
    return low, np.array([design.pinion_tip_roll, design.mean_radius + half])


def _gaps(design: PairDesign, points: SurfacePoints, phi1: Array, phi2: Array) -> Array:
    tooth = np.broadcast_to(PAIRS, (len(phi1), len(PAIRS))).ravel()
    turns = np.repeat(phi1, len(PAIRS)), np.repeat(phi2, len(PAIRS))
    return separation(design, points, *turns, tooth).gap


def _coarse(design: PairDesign, phi1: Array, phi2: Array) -> tuple[Array, Array, Array]:
    """Smallest gaps on a grid over the whole flank: roll and y (p, 5), and the grid's spacing."""
    low, high = _bounds(design)
    face = design.face_gear
    edge = 1e-9
    first = max(low[1], face.inner_radius - 0.02 * design.module)
    last = min(high[1], face.outer_radius + edge)
    rolls, ys = np.linspace(low[0], high[0], 15), np.linspace(first, last, 15)
    roll, y = (part.ravel() for part in np.meshgrid(rolls, ys, indexing="ij"))
    gap = _gaps(design, flank_points(design, roll, y), phi1, phi2)
    best = np.argmin(gap, axis=1)
    shape = (len(phi1), len(PAIRS))
    return roll[best].reshape(shape), y[best].reshape(shape), np.array([rolls[1] - rolls[0], ys[1] - ys[0]])


def _zoom(
    design: PairDesign, phi1: Array, phi2: Array, roll: Array, y: Array, size: Array, levels: int
) -> tuple[Array, Array, Array]:
    """Follow each pair's smallest gap down a ladder of shrinking 5 x 5 grids kept on the flank."""
    low, high = _bounds(design)
    steps = np.linspace(-1, 1, 5)
    a, b = (part.ravel() for part in np.meshgrid(steps, steps, indexing="ij"))
    shape = roll.shape
    roll, y = roll.reshape(-1, 1), y.reshape(-1, 1)
    rows = np.arange(len(roll))
    for level in range(levels):
        width = size * 0.55**level
        rolls = np.clip(roll + a * width[0], low[0], high[0])
        ys = np.clip(y + b * width[1], low[1], high[1])
        gap = _gaps(design, flank_points(design, rolls, ys), phi1, phi2)
        best = np.argmin(gap, axis=1)
        roll, y = rolls[rows, best][:, None], ys[rows, best][:, None]
    gap = gap[rows, best].reshape(shape)
    facing = np.isfinite(gap)
    return gap, np.where(facing, roll.reshape(shape), np.nan), np.where(facing, y.reshape(shape), np.nan)
