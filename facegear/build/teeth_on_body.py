"""Where the teeth of a face gear stand on its body, and the edge of its section that carries them.

Height 0 is the plane on which the contact analysis clamps the teeth: the rim's thickness below the lowest
place of the root. Root and tip rise or fall across the face of tapered teeth, and where the axes do not cross
at 90 degrees.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin

import numpy as np

from facegear.arrays import Array
from facegear.build.tooth_pair import ToothPair, pair
from facegear.errors import InvalidInput
from facegear.parts import section as shapes
from facegear.teeth import face_gear, face_gear_fillet
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import pair_at

ON_LINE = 1e-9
"""Distance (m) up to which a corner counts as lying on a line: rounding."""


@dataclass(frozen=True)
class TeethOnBody:
    """Heights of the teeth over the plane on which the contact analysis clamps them, m.

    Attributes
    ----------
    inner_radius, outer_radius
        Ends of the face, m.
    roots, tips
        Heights of root and tip at both ends, inner end first.
    pitch_height
        Height of the plane in which the meshes roll: through the pitch circle of the pinion.
    """

    inner_radius: float
    outer_radius: float
    roots: tuple[float, float]
    tips: tuple[float, float]
    pitch_height: float

    @property
    def slope(self) -> float:
        """Rise of the root for each metre outwards."""
        return (self.roots[1] - self.roots[0]) / (self.outer_radius - self.inner_radius)

    def root_at(self, radius: float) -> float:
        """Return the height of the line through the roots at both ends.

        Parameters
        ----------
        radius : float
            Distance from the axis, m.

        Returns
        -------
        float
            m.
        """
        return self.roots[0] + self.slope * (radius - self.inner_radius)

    @cached_property
    def layer(self) -> shapes.Layer:
        """Teeth as a layer between roots and tips, as deep as they are on the mean."""
        back, front = 0.5 * sum(self.roots), 0.5 * sum(self.tips)
        return shapes.Layer(self.inner_radius, self.outer_radius, back, front, slope=self.slope)


def teeth_on_body(teeth: ToothPair, side: str = "upper") -> TeethOnBody:
    """Return the heights of the teeth of a face gear.

    Parameters
    ----------
    teeth : ToothPair
        Section `tooth_pair` of the config, with bodies.
    side : str
        Which face gear: `lower` or `upper`.

    Returns
    -------
    TeethOnBody
        SI units.
    """
    gear = teeth.face_gear
    assert gear is not None and teeth.shaper is not None and teeth.pinion is not None
    ends = 1e-3 * gear.inner_radius_mm, 1e-3 * gear.outer_radius_mm
    design = pair_at(pair(teeth).design, side, "drive")
    if design.taper_angle == 0.0 and design.shaft_angle == pi / 2:
        top = 1e-3 * gear.rim_thickness_mm
        datum = 1e-3 * (gear.rim_thickness_mm + teeth.module_mm * teeth.shaper.addendum_modules)
        tip = datum + 1e-3 * teeth.module_mm * gear.addendum_modules
        return TeethOnBody(*ends, (top, top), (tip, tip), datum + design.pinion.profile_shift)
    return _inclined(design)


def _inclined(design: PairDesign) -> TeethOnBody:
    """Return the heights of teeth whose root is a cone, or whose pinion's axis leans."""
    gear = design.face_gear
    ends = np.array([gear.inner_radius, gear.outer_radius])
    back = face_gear_fillet.back_height(design)
    roots = face_gear_fillet.root_height(design, ends) - back
    tips = face_gear.tip_height(design, ends) - back
    angle = design.shaft_angle
    pitch = -(design.gear_pitch_radius * cos(angle) + design.pinion_pitch_radius) / sin(angle)
    (root, outer_root), (tip, outer_tip) = roots.tolist(), tips.tolist()
    return TeethOnBody(
        gear.inner_radius, gear.outer_radius, (root, outer_root), (tip, outer_tip), pitch - back
    )


def require_teeth_on_rim(shape: shapes.Section, on_body: TeethOnBody) -> None:
    """Require that an edge of the cross-section carries all teeth, with their rim solid below it.

    Parameters
    ----------
    shape : shapes.Section
        Cross-section in SI units.
    on_body : TeethOnBody
        Heights of the teeth.

    Raises
    ------
    InvalidInput
        If no edge along the roots covers the radii of the teeth, or the rim below them has a gap down to
        height 0.
    """
    inner, outer = shape.teeth
    first, last = (1e3 * height for height in on_body.roots)
    if first == last:
        words = f"such that it has an edge at height {first:g} mm from {1e3 * inner:g} to {1e3 * outer:g} mm"
    else:
        words = (
            f"such that it has an edge from radius {1e3 * inner:g} and height {first:.9g} mm "
            f"to {1e3 * outer:g} and {last:.9g} mm"
        )
    r, height = shape.edges[:, :, 0], shape.edges[:, :, 1]
    is_along = np.abs(height - (on_body.roots[0] + on_body.slope * (r - inner))).max(axis=1) < ON_LINE
    covers = (r.min(axis=1) < inner + ON_LINE) & (r.max(axis=1) > outer - ON_LINE)
    radii_mm: Sequence[float] = (1e3 * shape.corners[:, 0]).round(6).tolist()
    if not (is_along & covers).any():
        requirement = f"{words}, on which the teeth stand"
        raise InvalidInput("inner radius of the rim", [min(radii_mm), max(radii_mm)], requirement)
    if crosses_rectangle(shape.edges, inner, outer, 0.0, min(on_body.roots)):
        raise InvalidInput("corners of the section", "a gap below the teeth", f"{words}, solid to height 0")


def crosses_rectangle(edges: Array, inner: float, outer: float, back: float, front: float) -> bool:
    """Whether an edge runs through the inside of a rectangle; its border, within ON_LINE, does not count.

    Parameters
    ----------
    edges : (edges, 2, 2) array
        Distance from the axis and height (m) of both ends of each edge.
    inner : float
        Smallest distance of the rectangle from the axis, m.
    outer : float
        Largest distance of the rectangle from the axis, m.
    back : float
        Smallest height of the rectangle, m.
    front : float
        Largest height of the rectangle, m.

    Returns
    -------
    bool
        True if at least one edge does.
    """
    low, high = np.array([inner, back]) + ON_LINE, np.array([outer, front]) - ON_LINE
    first, way = edges[:, 0], edges[:, 1] - edges[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        to_low, to_high = (low - first) / way, (high - first) / way
    still = way == 0.0
    inside = (first > low) & (first < high)
    enter = np.where(still, np.where(inside, 0.0, np.inf), np.minimum(to_low, to_high)).max(axis=1)
    leave = np.where(still, np.where(inside, 1.0, -np.inf), np.maximum(to_low, to_high)).min(axis=1)
    return bool((np.maximum(enter, 0.0) < np.minimum(leave, 1.0)).any())
