"""The face gear's numbers and a sample of its flank, as the kernel of rays takes them.

Rays cut with a tooth of the face gear: the first of its surfaces that is hit. All angles in rad, all lengths
in m, for the right side of tooth 0 in the gear's body frame.
"""

from functools import lru_cache
from math import pi
from typing import NamedTuple

import numpy as np

from facegear._kernels import flanks
from facegear.arrays import AnyArray, Array, Mask
from facegear.teeth import face_gear, face_gear_fillet
from facegear.teeth.design import PairDesign, as_cut

SAMPLES = 25
"""Points of the sampled flank each way."""


class Blank(NamedTuple):
    """Numbers of the gear as the kernel of rays takes them (`facegear/_kernels/src/flanks/blank.hpp`).

    base, ratio, space, lift: see `face_gear.shaper_numbers`; tip_centre, tip_rounding, edge_start: see
    `face_gear_fillet.tip_numbers`; tip_roll: where the shaper's involute ends (rad); inner, outer: radii
    of the face (m); tip_plane, root_plane: heights z (m); root_start: gear angle from the tooth's middle
    at which the root land begins (rad); pitch: angular pitch (rad).
    """

    base: float
    ratio: float
    space: float
    lift: float
    tip_centre: float
    tip_rounding: float
    tip_roll: float
    edge_start: float
    inner: float
    outer: float
    tip_plane: float
    root_plane: float
    root_start: float
    pitch: float
    aside: float
    """Largest distance from the tooth's middle plane, abs(x) in m, of points looked at."""
    fillet_top: float
    """Height (m) that no point of the fillet exceeds."""
    fillet_start: float
    """Slope psi (rad) that no normal of the fillet falls below."""


def blank(design: PairDesign) -> Blank:
    """Return the numbers of a design's face gear that the kernel of rays takes: shaper, radii, planes, edges.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    Blank
        Numbers in m and rad.
    """
    gear, pitch = design.face_gear, 2 * pi / design.face_gear.teeth
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 65)
    starts = face_gear_fillet.fillet_start(design, radius)
    tops = face_gear.flank_point(design, design.shaper_tip_roll, starts)[:, 2]
    base, ratio, space, lift = face_gear.shaper_numbers(design)
    centre, rounding, _, _, edge_start = face_gear_fillet.tip_numbers(design)
    return Blank(
        base=base,
        ratio=ratio,
        space=space,
        lift=lift,
        tip_centre=centre,
        tip_rounding=rounding,
        tip_roll=design.shaper_tip_roll,
        edge_start=edge_start,
        inner=gear.inner_radius,
        outer=gear.outer_radius,
        tip_plane=design.gear_tip_plane,
        root_plane=design.gear_root_plane,
        root_start=pitch / 2 - float(face_gear_fillet.root_half_angle(design, gear.inner_radius)),
        pitch=pitch,
        aside=3 * design.module,
        fillet_top=float(tops.max()) + 0.01 * design.module,
        fillet_start=float(starts.min()),
    )


class FlankSample(NamedTuple):
    """Points and normals (m, 3) of the flank, roll and psi (m,) rad there, `inner` (m,) those away from its
    edges, and the largest `spacing` (m) between neighbours. As many points stand at each of the gear `radii`
    (r,) m, one radius after the other.
    """

    points: Array
    normals: Array
    rolls: Array
    psis: Array
    inner: Mask
    spacing: float
    radii: Array


def gear_rays(design: PairDesign) -> tuple[Blank, FlankSample]:
    """Return a design's face gear, as it is generated, in the form that `facegear.teeth.rays.cut` takes.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    tuple[Blank, FlankSample]
        Numbers and sample of the flank.
    """
    return _of_generated(as_cut(design))


@lru_cache(maxsize=16)
def _of_generated(design: PairDesign) -> tuple[Blank, FlankSample]:
    """Return blank and sampled flank of a design without modifications and errors; cached by design."""
    return blank(design), _flank_sample(design)


def _flank_sample(design: PairDesign) -> FlankSample:
    """Sample the right flank on SAMPLES x SAMPLES points, gear radius by roll, from which searches along
    rays begin.
    """
    gear = design.face_gear
    radius = np.linspace(gear.inner_radius, gear.outer_radius, SAMPLES)[:, None]
    top, _ = face_gear.roll_and_psi_at_height(design, radius, design.gear_tip_plane)
    roll = top + np.linspace(0, 1, SAMPLES) * (design.shaper_tip_roll - top)
    psi = face_gear.psi_at(design, radius, roll)
    points = face_gear.flank_point(design, roll, psi)
    inner = np.zeros((SAMPLES, SAMPLES), bool)
    inner[2:-2, 2:-2] = True
    along, across = (np.linalg.norm(np.diff(points, axis=axis), axis=-1).max() for axis in (0, 1))
    return FlankSample(
        points=points.reshape(-1, 3),
        normals=face_gear.flank_normal(design, roll, psi).reshape(-1, 3),
        rolls=roll.ravel(),
        psis=psi.ravel(),
        inner=inner.ravel(),
        spacing=float(np.hypot(across, along)),
        radii=radius.ravel(),
    )


NO_PART, FLANK, FILLET, TIP_LAND, ROOT_LAND = range(5)
"""Part of the face gear that a ray meets first."""


def cut(
    blank: Blank, sample: FlankSample, starts: Array, ways: Array, search_radius: float
) -> tuple[list[AnyArray], int]:
    """Find the first surface of tooth 0 of the face gear that each ray meets, by Newton's method.

    Parameters
    ----------
    blank, sample
        The gear, as `gear_rays` makes them.
    starts : (n, 3)
        Where rays begin, m.
    ways : (n, 3)
        Their directions, unit vectors.
    search_radius
        How far (m) along them surfaces are looked for.

    Returns
    -------
    list of (n,)
        Fields of `Separation` in its order.
    int
        Number of rays close to a surface that could not be cut with it.
    """
    count = len(starts)
    numbers, part = np.empty((5, count)), np.empty(count, np.int8)
    lost_count = flanks.cut_rays(blank, sample, starts, ways, search_radius, numbers, part)
    gap, u, v, continued, radius = numbers
    return [gap, part, u, v, continued, radius], lost_count
