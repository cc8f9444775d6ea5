"""Shapes of flanks: reliefs, crownings and slopes that are given, and deviations on a grid; lengths in m."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from facegear.arrays import Array


@dataclass(frozen=True)
class Relief:
    """A flank modification removed along the normal: `amount` (m) over `length` (m) beyond `start` (m).

    Tip, root and end relief measure from an end of the flank inwards: the full amount holds within `start` of
    the end and falls linearly to zero over the next `length`. Crownings measure from a middle: nothing within
    `start`, then a parabola reaching `amount` after `length`. Across the pinion's profile lengths are roll
    lengths in the transverse section, across the gear's they are depths below the tip surface.
    """

    amount: float = 0.0
    start: float = 0.0
    length: float = 0.0


@dataclass(frozen=True)
class DeviationGrid:
    """Deviations (m) from a nominal flank on a grid of places, along its outward normal, material positive.

    face: of the pinion along its axis from the middle of the face outwards, of the face gear the radius (m);
    profile: of the pinion the transverse length of roll r_b th, of the face gear the depth below the tip
    surface along its axis (m); both rise. deviation: one row for each place along the face.
    """

    face: tuple[float, ...]
    profile: tuple[float, ...]
    deviation: tuple[tuple[float, ...], ...]

    @cached_property
    def zero(self) -> bool:
        """Whether the flank is as designed."""
        return not any(map(any, self.deviation))

    @cached_property
    def _hash(self) -> int:
        """Hash of the grid, computed once."""
        return hash((self.face, self.profile, self.deviation))

    def __hash__(self) -> int:
        """Return the hash of the grid, by which designs are keys of caches."""
        return self._hash


@dataclass(frozen=True)
class Flanks:
    """Deviations of both flanks of all teeth of a gear; None for a flank as it is designed."""

    right: DeviationGrid | None = None
    left: DeviationGrid | None = None

    @property
    def mirror_image(self) -> "Flanks":
        """Deviations of the gear seen in a mirror: left and right flank exchanged, values unchanged."""
        return Flanks(self.left, self.right)


@dataclass(frozen=True)
class GearModifications:
    """Modifications that take material off both flanks of the face gear along the normal; see
    `facegear.teeth.modifications`.

    lead_slope: amount (m) at the outer end of the face, added at the inner end. profile_slope: amount (m)
    at the tip surface, added as far below the datum surface. bias: amount (m) at the outer end of the tip,
    with the sign of the product of both.
    """

    tip_relief: Relief = field(default_factory=Relief)
    root_relief: Relief = field(default_factory=Relief)
    end_relief: Relief = field(default_factory=Relief)
    profile_crowning: Relief = field(default_factory=Relief)
    lead_crowning: Relief = field(default_factory=Relief)
    lead_slope: float = 0.0
    profile_slope: float = 0.0
    bias: float = 0.0


def linear(relief: Relief, from_end: Array) -> Array:
    """Compute the removed depth of a tip, root or end relief: `amount` at the end, falling linearly to 0.

    Parameters
    ----------
    relief : Relief
        Amount, start and length.
    from_end : (...) array
        Distance from the end, m.

    Returns
    -------
    (...) array
        m.
    """
    if relief.amount == 0:
        return 0.0 * from_end
    part = (relief.start + relief.length - from_end) / relief.length
    return relief.amount * np.minimum(np.maximum(part, 0.0), 1.0)


def parabola(relief: Relief, from_middle: Array) -> Array:
    """Compute the removed depth of a crowning, amount ((from_middle - start) / length)^2 beyond the start.

    Parameters
    ----------
    relief : Relief
        Amount, start and length.
    from_middle : (...) array
        Distance from the middle, m.

    Returns
    -------
    (...) array
        m.
    """
    if relief.amount == 0:
        return 0.0 * from_middle
    return relief.amount * np.maximum((from_middle - relief.start) / relief.length, 0.0) ** 2


def parabola_curvature(relief: Relief, from_middle: Array) -> Array:
    """Compute the second derivative of `parabola` by the distance.

    Parameters
    ----------
    relief : Relief
        Amount, start and length.
    from_middle : (...) array
        Distance from the middle, m.

    Returns
    -------
    (...) array
        1/m.
    """
    if relief.amount == 0:
        return np.zeros_like(from_middle)
    return np.where(from_middle > relief.start, 2.0 * relief.amount / relief.length**2, 0.0)
