"""Where the flanks of pairs of all kinds of teeth touch without load."""

import numpy as np

from facegear.arrays import Array
from facegear.teeth.design import PairDesign
from facegear.teeth.family_contact import ContactLine, contact_line
from facegear.teeth.helicoid import PinionFlank
from facegear.teeth.surfaces import SurfacePoints

MIRROR = np.array([-1.0, 1.0, 1.0])
"""Factors of coordinates in a mirror x -> -x."""


def pinion_points(design: PairDesign, length: Array, y: Array) -> SurfacePoints:
    """Return points (...) of the pinion's drive flank as generated, by length of roll and y (m)."""
    flank = PinionFlank(design.family.pinion_flanks[0])
    return SurfacePoints(flank.point(length, y), flank.normal(length, y))


def unloaded_line(design: PairDesign) -> ContactLine | None:
    """Return the line on which the drive flanks of a design touch as assembled."""
    errors = design.assembly
    return contact_line(design.family, 1, errors)


def contact_angles(line: ContactLine, s: Array) -> tuple[Array, Array, Array, Array]:
    """Return length of roll and y (m) on the pinion where points s (n,) of a line touch, and the angles of
    pinion and gear (rad) then, all (n,).
    """
    helicoid, y = line.helicoid, line.pinion_y(s)
    length = (s + line.pinion_lead) * helicoid.cosine
    rolled_angle = (length + helicoid.lead * (y - helicoid.middle)) / helicoid.base_radius
    phi1 = helicoid.side * (rolled_angle - line.pinion_slope - helicoid.phase)
    return length, y, phi1, line.motion.ratio * (phi1 + line.transmission_error / line.base_pitch)
