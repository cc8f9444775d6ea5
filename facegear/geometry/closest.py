"""Closest points of pinion and gear flanks: the smallest separation of every tooth pair."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.geometry import face_gear, pinion
from facegear.geometry.curvature import relative_curvatures
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion_surface import flank_points
from facegear.geometry.separation import separation

PAIRS = np.arange(-2, 3)
"""Tooth numbers looked at: at phi1 within half a pitch of zero no other pair can touch."""

_GRID = np.array([(a, b) for a in np.linspace(-1, 1, 5) for b in np.linspace(-1, 1, 5)])
_SHRINK, _MAX_STEPS = 0.55, 60


@dataclass(frozen=True)
class Closest:
    """Smallest separation (m) of the pairs -2..2 and where on the pinion: roll (rad) and y (m), all (p, 5).

    inf where a pair does not face each other; roll and y are then only where the search ended.
    """

    gap: Array
    roll: Array
    y: Array


def closest(
    design: PairDesign, phi1: Array, phi2: Array, near: Closest | None = None, margin: float = np.inf
) -> Closest:
    """Search the flanks of all pairs at p placements (rad), from a coarse grid or around a `near` result.

    Pairs whose `near` gap exceeds the smallest by more than `margin` (m) keep their `near` values.
    """
    size, levels = np.array([1e-3, 1e-4]), 16
    if near is None:
        (near, size), levels = _coarse(design, phi1, phi2), 10
    chosen = (near.gap <= near.gap.min(axis=1, keepdims=True) + margin).ravel()
    turns = np.repeat(phi1, len(PAIRS))[chosen], np.repeat(phi2, len(PAIRS))[chosen]
    rows = _Rows(*turns, np.tile(PAIRS, len(phi1))[chosen].astype(float))
    parts = [part.ravel().copy() for part in (near.gap, near.roll, near.y)]
    refined = _search(design, rows, parts[1][chosen], parts[2][chosen], size, levels)
    for part, values in zip(parts, refined, strict=True):
        part[chosen] = values
    return Closest(*(part.reshape(near.roll.shape) for part in parts))


@dataclass(frozen=True)
class _Rows:
    phi1: Array
    phi2: Array
    tooth: Array


def bounds(design: PairDesign) -> tuple[Array, Array]:
    """Lower and upper ends of (roll, y) on the pinion's flank."""
    half = design.pinion.width / 2
    low = np.array([pinion.junction_roll(design), design.mean_radius - half])
    return low, np.array([design.pinion_tip_roll, design.mean_radius + half])


def _coarse(design: PairDesign, phi1: Array, phi2: Array) -> tuple[Closest, Array]:
    low, high = bounds(design)
    face = design.face_gear
    first, last = max(low[1], face.inner_radius - 0.02 * design.module), min(high[1], face.outer_radius)
    rolls, ys = np.linspace(low[0], high[0], 15), np.linspace(first, last, 15)
    roll, y = (part.ravel() for part in np.meshgrid(rolls, ys, indexing="ij"))
    tooth = np.tile(PAIRS, len(phi1))
    turns = np.repeat(phi1, len(PAIRS)), np.repeat(phi2, len(PAIRS))
    gap = separation(design, flank_points(design, roll, y), *turns, tooth).gap
    best = np.argmin(gap, axis=1)
    shape = (len(phi1), len(PAIRS))
    near = Closest(gap.min(axis=1).reshape(shape), roll[best].reshape(shape), y[best].reshape(shape))
    return near, np.array([rolls[1] - rolls[0], ys[1] - ys[0]])


def _search(
    design: PairDesign, rows: _Rows, roll: Array, y: Array, size: Array, levels: int
) -> tuple[Array, Array, Array]:
    """Walk 5 x 5 grids to the minimum, shrinking them when their middle part holds it.

    The grids lean along the contact line, as the gap is a narrow and flat valley in its direction.
    """
    low, high = bounds(design)
    width = np.tile(size, (len(roll), 1))
    gap, roll, y = np.full(len(roll), np.inf), roll.copy(), y.copy()
    active = np.arange(len(roll))
    for _ in range(_MAX_STEPS):
        w = width[active]
        lean = _contact_line(design, roll[active], y[active])
        across, along = _GRID[:, 0] * w[:, :1], _GRID[:, 1] * w[:, 1:]
        rolls = np.clip(roll[active, None] + across + lean[:, None] * along, low[0], high[0])
        ys = np.clip(y[active, None] + along, low[1], high[1])
        turns = rows.phi1[active], rows.phi2[active], rows.tooth[active]
        gaps = separation(design, flank_points(design, rolls, ys), *turns).gap
        at, best = np.arange(len(active)), np.argmin(gaps, axis=1)
        min_gap = gaps[at, best]
        gained = min_gap < gap[active] - 1e-13
        border = (np.abs(_GRID[best]) == 1) & gained[:, None] & np.isfinite(min_gap)[:, None]
        gap[active] = min_gap
        roll[active], y[active] = rolls[at, best], ys[at, best]
        width[active] *= np.where(border, 1.5, _SHRINK)
        active = active[np.any(width[active] > size * _SHRINK**levels, axis=1)]
        if len(active) == 0:
            break
    return _polish(design, rows, gap, roll, y)


def _polish(design: PairDesign, rows: _Rows, gap: Array, roll: Array, y: Array) -> tuple[Array, Array, Array]:
    """One Newton step from a 3 x 3 stencil where the minimum lies inside the flank."""
    step = np.array([2e-4, 1e-4])
    a, b = (part.ravel() for part in np.meshgrid([-1, 0, 1], [-1, 0, 1], indexing="ij"))
    turns = rows.phi1, rows.phi2, rows.tooth
    rolls, ys = roll[:, None] + a * step[0], y[:, None] + b * step[1]
    g = separation(design, flank_points(design, rolls, ys), *turns).gap.reshape(-1, 3, 3)
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = (g[:, 2, 1] - g[:, 0, 1]) / 2, (g[:, 1, 2] - g[:, 1, 0]) / 2
        bend = g[:, 2, 1] - 2 * g[:, 1, 1] + g[:, 0, 1], g[:, 1, 2] - 2 * g[:, 1, 1] + g[:, 1, 0]
        twist = (g[:, 2, 2] - g[:, 2, 0] - g[:, 0, 2] + g[:, 0, 0]) / 4
        det = bend[0] * bend[1] - twist**2
        across = (twist * slope[1] - bend[1] * slope[0]) / det
        along = (twist * slope[0] - bend[0] * slope[1]) / det
    low, high = bounds(design)
    new_roll, new_y = roll + across * step[0], y + along * step[1]
    good = (det > 0) & (np.hypot(across, along) < 20) & (new_roll > low[0]) & (new_roll < high[0])
    good &= (new_y > low[1]) & (new_y < high[1])
    new_roll, new_y = np.where(good, new_roll, roll), np.where(good, new_y, y)
    new = separation(design, flank_points(design, new_roll[:, None], new_y[:, None]), *turns).gap[:, 0]
    better = good & (new < gap)
    return np.where(better, new, gap), np.where(better, new_roll, roll), np.where(better, new_y, y)


def _contact_line(design: PairDesign, roll: Array, y: Array) -> Array:
    """Slope d roll / d y (rad/m) of the contact line of the nominal pair."""
    psi = face_gear.local_pressure_angle(design, np.maximum(y, 1.001 * design.gear_base_radius))
    length = design.pinion_base_radius * roll
    shaper_roll = (length + design.shaper_lift * np.sin(psi)) / design.shaper_base_radius
    _, _, slope = relative_curvatures(design, shaper_roll, psi)
    return np.tan(slope) / np.maximum(length, 1e-2 * design.module)
