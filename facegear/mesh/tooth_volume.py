"""Fraction of the ring between root land and tip plane that the teeth of a face gear fill."""

import numpy as np

from facegear.geometry.design import PairDesign
from facegear.mesh.outline import Outline

PLANES, POINTS = 8, 129


def tooth_fill(design: PairDesign) -> tuple[float, float]:
    """Compute how much of the ring between their root land, tip plane and ends the teeth fill.

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
