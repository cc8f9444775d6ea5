"""Can the teeth be brought together: pinions that bridge two face gears fit at some angles only.

A pinion between two counter-facing gears of N teeth sets how far their teeth are turned against each other.
Pinions i and j set the same if 2 (P_i - P_j) is an integer, P their angles in pitches; what is left over is a
misfit between the two meshes of a pinion, which the backlash of both takes up or the machine cannot be built.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Mask
from facegear.by_content import kept_by_content
from facegear.machine.imperfections import Imperfections
from facegear.machine.layout import Layout

ANGLE_ROUNDING = 1e-3
"""Misfit in pitches that counts as an angle given with few digits (three decimals of a degree)."""


@dataclass(frozen=True, eq=False)
class Assembly:
    """Misfit of each pinion where it bridges both gears, all (pinions,).

    Attributes
    ----------
    misfit
        m along the line of action: how far the teeth of its lower mesh stand ahead of the gear's, with
        the upper mesh in place and the lower gear at the middle of the range in which most pinions fit;
        positive closes the drive flank.
    clearance
        m, misfit to either side that half the backlash of both meshes and the bearing's clearance take
        up; infinite with one gear.
    fits
        Whether it can be mounted together with the others.
    below, above
        The nearest angles without misfit, in pitches of the face gear; the pinion's own with one gear.
    """

    misfit: Array
    clearance: Array
    fits: Mask
    below: Array
    above: Array


def assembly(
    layout: Layout,
    half_backlash: Array,
    clocking: Array | None = None,
    errors: Imperfections | None = None,
) -> Assembly:
    """Check whether all pinions can be assembled.

    With one face gear nothing has to fit.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    half_backlash : (meshes,) array
        Half the backlash of each mesh, m.
    clocking : (pinions,) array or None
        Lower rim ahead of the upper, pitches; 0 if None.
    errors : Imperfections or None
        Imperfections whose constant errors count as misfit, and whose bearing clearance counts as clearance.

    Returns
    -------
    Assembly
        One entry for each pinion, m and pitches.
    """
    rim_clocking = np.zeros(len(layout.pinions)) if clocking is None else clocking
    if errors is None:
        return _without_errors(layout, half_backlash, rim_clocking)
    return _assembly(layout, half_backlash, rim_clocking, errors)


@kept_by_content(4)
def _without_errors(layout: Layout, half_backlash: Array, clocking: Array) -> Assembly:
    """Compute the assembly without manufacturing errors; equal arguments share the result."""
    return _assembly(layout, half_backlash, clocking, None)


def _assembly(
    layout: Layout, half_backlash: Array, clocking: Array, errors: Imperfections | None
) -> Assembly:
    """Compute `assembly` for given clocking (pinions,), in pitches; half_backlash (meshes,), m.

    The reference is the pinion with whose teeth those of most others agree within their play. Pinions
    that agree with it fit if one position of the lower gear suits all of them (`_all_together`).
    """
    count = len(layout.pinions)
    pitches = np.array([pinion.pitches for pinion in layout.pinions])
    if len(layout.gears) < 2:
        zeros = np.zeros(count)
        return Assembly(zeros, np.full(count, np.inf), np.ones(count, bool), pitches, pitches)
    clearance = half_backlash.reshape(len(layout.gears), count).sum(axis=0) * _play(layout)
    ahead = clocking - 2.0 * pitches
    if errors is not None:
        lower, upper = np.split(errors.error, 2)
        below, above = (_tangential_part(layout, gear) for gear in (0, 1))
        ahead = ahead + (upper - lower - errors.positions @ (above - below)) / layout.base_pitch
        clearance = clearance + np.hypot(*(above - below)[:2]) * errors.bearing_clearance
    reach = clearance / layout.base_pitch + 0.5 * ANGLE_ROUNDING
    together = np.abs(_wrap_pitches(ahead[:, None] - ahead)) <= reach[:, None] + reach
    hardest = int(np.argmax(together.sum(axis=1)))
    left = _wrap_pitches(ahead - ahead[hardest])
    low, high = left[together[hardest]].min(), left[together[hardest]].max()
    fits = _all_together(left, reach, together[hardest])
    middle = 0.5 * (low + high)
    near = np.floor(2.0 * (pitches - 0.5 * (clocking - ahead[hardest])))
    steps = 0.5 * (clocking - ahead[hardest] + near)
    return Assembly((left - middle) * layout.base_pitch, clearance, fits, steps, steps + 0.5)


def interference_depths(layout: Layout, half_backlash: Array, errors: Imperfections) -> Array:
    """Return how much deeper a pinion stands in each mesh than backlash and clearance allow.

    It is the part of the flanks' normals that both share times (shift of the pinion's bearing along it, less
    its clearance), less half the backlash.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    half_backlash : (meshes,) array
        Half the backlash of each mesh, m.
    errors : Imperfections
        Positions of the pinions' bearings and their clearance.

    Returns
    -------
    (meshes,) array
        m along the line of action; positive where both flanks of a tooth would be pressed with the
        machine at rest.
    """
    depths = []
    for gear in range(len(layout.gears)):
        drive, back = layout.flank_frames[gear]
        common_part = 0.5 * (np.array(drive.normal) + np.array(back.normal) / layout.back_arm)
        size = float(np.hypot(*common_part[:2]))
        direction = common_part / size
        depths.append(size * (errors.positions @ direction - errors.bearing_clearance))
    return np.asarray(np.concatenate(depths) - half_backlash * _play(layout))


def _tangential_part(layout: Layout, gear: int) -> Array:
    """Return by how much a pinion's motion along its x, y, z turns its place between both flanks of a gear's
    tooth, along the drive flank's line of action, (3,), m/m.
    """
    drive, back = layout.flank_frames[gear]
    return 0.5 * (np.array(drive.normal) - np.array(back.normal) / layout.back_arm)


def _play(layout: Layout) -> float:
    """Return the mean of what half the backlash of both flanks is along the drive flank's line of action: 1
    where both have one pressure angle.
    """
    return 0.5 * (1.0 + 1.0 / layout.back_arm)


def _wrap_pitches(pitches: Array) -> Array:
    """Return pitches less their nearest whole number, within -0.5 to 0.5, of the same shape."""
    return pitches - np.round(pitches)


def _all_together(left: Array, reach: Array, candidates: Mask) -> Mask:
    """Return which candidates (pinions,) can mesh at one common position of the lower gear.

    left, reach (pinions,): misfit and play of each pinion, in pitches; it meshes where the gear stands
    within left +- reach. Candidates are added by rising abs(left) as long as all intervals have a point in
    common.
    """
    fits = np.zeros(left.size, bool)
    low, high = -np.inf, np.inf
    outwards = np.argsort(np.abs(left)).tolist()
    bounds = (left - reach).tolist(), (left + reach).tolist()
    for i in outwards:
        below, above = max(low, bounds[0][i]), min(high, bounds[1][i])
        if candidates[i] and below <= above:
            fits[i], low, high = True, below, above
    return fits
