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
from facegear.teeth.design import PairDesign, as_cut
from facegear.teeth.generated_fillet import gear_fillet
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.tooth_family import ToothFamily

SAMPLES = 25
"""Points of the sampled flank each way."""
FILLET_HEIGHTS = 17
"""Places of the fillet from which searches begin, as the kernel has them."""
SAFETY, ROUNDING = 4.0, 1e-12
"""Factor by which the tip edge may be farther from its parabola than at any sample, and rounding (rad)."""
RIGHT = -1
"""Sign of the flank that stands on the right of the gear's tooth."""


class Shaper(NamedTuple):
    """The shaper and its place against the gear, as the kernel of rays takes them (m, rad).

    base: radius of its base cylinder. ratio: its tooth number over the gear's. phase: angle from the middle
    of its space to the involute's start, at `middle`. sine: of its base helix, signed. middle: y of the
    section that other numbers are for. lift, offset: of its axis. taper: growth of its tip's radius with y.
    tip_centre, tip_rounding: distance of its tip rounding's centre from its axis, and that rounding's radius.
    """

    base: float
    ratio: float
    phase: float
    sine: float
    middle: float
    lift: float
    offset: float
    shaft_sine: float
    """Sine of the shaft angle."""
    shaft_cosine: float
    """Cosine of the shaft angle."""
    taper: float
    tip_centre: float
    tip_rounding: float


class Guess(NamedTuple):
    """Where searches on a side begin, by the distance r (m) from a gear `radius` and the depth d (m) below
    the tip. `roll` and `psi` (6,), rad, are the factors of 1, r, d, r squared, r d and d squared, for d up to
    `depth`.
    """

    radius: float
    depth: float
    roll: Array
    psi: Array
    edge: Array
    """Factors (3,) of the tip edge's gear angle (rad), of rising powers of r."""
    edge_error: float
    """Larger than any error of that angle, rad."""
    fillet: Array
    """Depths (FILLET_HEIGHTS,), m, at even steps of the fillet's angle at the radius."""


class Side(NamedTuple):
    """A right side of the tooth: the shaper that generates it, and where searches on it begin."""

    shaper: Shaper
    guess: Guess


class Line(NamedTuple):
    """A straight line: `height` (m) at the origin, and `slope`."""

    height: float
    slope: float


class Blank(NamedTuple):
    """Numbers of the gear as the kernel of rays takes them (`facegear/_kernels/src/flanks/blank.hpp`).

    flank: the side that is looked at. back: the other side, seen in a mirror. inner, outer: radii of the face
    (m). tip, root: heights of the lands over gear radii. pitch: of teeth (rad). module: normal module (m).
    """

    flank: Side
    back: Side
    inner: float
    outer: float
    tip: Line
    root: Line
    root_bulge: float
    """Largest distance (m) of the root land from its line: 0 where it is a plane or a cone."""
    pitch: float
    module: float
    middle: Line
    """x of the tooth's middle over y, m."""
    aside: float
    """Largest distance along x from the tooth's middle, m, of points looked at."""
    fillet_top: float
    """Height (m) over the tip that no point of the fillet exceeds; negative."""


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
    family, back_family = design.mirror_family, design.family
    flank, back = _flank_sample(family), _flank_sample(back_family)
    tip, radii = Line(float(family.gear_tip.height(0.0)), family.gear_tip.slope), flank.radii
    fillet = gear_fillet(family, RIGHT)
    bottom = fillet.y_at(radii, 1.0)
    depths = fillet.generate(bottom, fillet.last_angle(bottom)).position[:, 2]
    slope = float((depths[-1] - depths[0]) / (radii[-1] - radii[0]))
    root = Line(float(depths[0] - slope * radii[0]), slope)
    right, left = (sample.points.reshape(SAMPLES, SAMPLES, 3).mean(axis=1) for sample in (flank, back))
    x, y = (right[:, 0] - left[:, 0]) / 2, (right[:, 1] + left[:, 1]) / 2
    lean = float((x[-1] - x[0]) / (y[-1] - y[0]))
    middle = Line(float(x[0] - lean * y[0]), lean)
    starts = flank.points.reshape(SAMPLES, SAMPLES, 3)[:, -1, 2]
    blank = Blank(
        flank=_side(family, flank),
        back=_side(back_family, back),
        inner=family.inner_radius,
        outer=family.outer_radius,
        tip=tip,
        root=root,
        root_bulge=float(np.abs(depths - root.height - root.slope * radii).max()),
        pitch=2 * pi / family.gear_teeth,
        module=design.module,
        middle=middle,
        aside=3 * design.module + float(np.abs(x - middle.height - middle.slope * y).max()),
        fillet_top=float((starts - tip.height - tip.slope * radii).max()) + 0.01 * design.module,
    )
    return blank, flank


def _side(family: ToothFamily, sample: FlankSample) -> Side:
    """Return the numbers of the right side of a family's gear, whose flank is sampled."""
    flank, fillet = gear_flank(family, RIGHT), gear_fillet(family, RIGHT)
    shaper, motion = flank.shaper, flank.motion
    numbers = Shaper(
        base=shaper.base_radius,
        ratio=motion.ratio,
        phase=shaper.phase,
        sine=shaper.sine,
        middle=shaper.middle,
        lift=flank.lift,
        offset=motion.offset,
        shaft_sine=motion.sine,
        shaft_cosine=motion.cosine,
        taper=fillet.taper,
        tip_centre=fillet.centre_radius,
        tip_rounding=fillet.rounding,
    )
    return Side(numbers, _guess(family, sample))


def _guess(family: ToothFamily, sample: FlankSample) -> Guess:
    """Return where searches on a family's right side begin, whose flank is sampled."""
    points, fillet = sample.points, gear_fillet(family, RIGHT)
    radius = np.hypot(points[:, 0], points[:, 1])
    center, depth = radius.mean(), family.gear_tip.height(radius) - points[:, 2]
    along, down = (radius - center) / center, depth / center
    terms = np.stack([np.ones_like(along), along, down, along**2, along * down, down**2], axis=-1)
    powers = np.array([0.0, 1.0, 1.0, 2.0, 2.0, 2.0])
    roll, psi = (np.linalg.lstsq(terms, values)[0] / center**powers for values in (sample.rolls, sample.psis))
    angle, on_edge = np.arctan2(points[::SAMPLES, 0], points[::SAMPLES, 1]), terms[::SAMPLES, [0, 1, 3]]
    edge = np.linalg.lstsq(on_edge, angle)[0]
    parts = np.linspace(0.0, 1.0, FILLET_HEIGHTS)
    y = fillet.y_at(center, parts)
    heights = fillet.generate(y, parts * fillet.last_angle(y)).position[:, 2]
    return Guess(
        radius=float(center),
        depth=float(depth.max()),
        roll=roll,
        psi=psi,
        edge=edge / center ** np.arange(3.0),
        edge_error=SAFETY * float(np.abs(on_edge @ edge - angle).max()) + ROUNDING,
        fillet=float(family.gear_tip.height(center)) - heights,
    )


def _flank_sample(family: ToothFamily) -> FlankSample:
    """Sample the right flank of a family's gear on SAMPLES x SAMPLES points, gear radius by height, where
    searches along rays begin.
    """
    flank, fillet = gear_flank(family, RIGHT), gear_fillet(family, RIGHT)
    radius = np.linspace(family.inner_radius, family.outer_radius, SAMPLES)
    bottom = fillet.generate(fillet.y_at(radius, 0.0), 0.0).position[:, 2]
    top, share = family.gear_tip.height(radius), np.linspace(0, 1, SAMPLES)
    psi, s = flank.parameters_at(radius[:, None], top[:, None] + share * (bottom - top)[:, None])
    points = flank.point(psi, s)
    inner = np.zeros((SAMPLES, SAMPLES), bool)
    inner[2:-2, 2:-2] = True
    along, across = (np.linalg.norm(np.diff(points, axis=axis), axis=-1).max() for axis in (0, 1))
    return FlankSample(
        points=points.reshape(-1, 3),
        normals=flank.normal(psi, s).reshape(-1, 3),
        rolls=(s / flank.shaper.base_radius).ravel(),
        psis=psi.ravel(),
        inner=inner.ravel(),
        spacing=float(np.hypot(across, along)),
        radii=radius,
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
