"""Number of elements in the mesh of a section, estimated before it is made."""

import numpy as np

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.gear_body.section import thinnest

ACROSS = 2
"""Elements across the thinnest wall."""
LARGEST = 6_000
"""Elements that a section may take, those at its corners left out."""


def require_meshable(corners: Array, across: int = ACROSS) -> None:
    """Raise InvalidInput for a section so thin that its mesh would have more elements than LARGEST.

    Parameters
    ----------
    corners : (n, 2) array
        Corners of the section, m.
    across : int
        Number of elements across the thinnest wall.
    """
    size = thinnest(corners) / across
    next_corners = np.roll(corners, -1, axis=0)
    area = abs(0.5 * float(np.sum(corners[:, 0] * next_corners[:, 1] - corners[:, 1] * next_corners[:, 0])))
    if area > LARGEST * size**2:
        min_thickness_mm = 1e3 * across * np.sqrt(area / LARGEST)
        requirement = (
            f"at least {min_thickness_mm:.3g} mm beside an area of {1e6 * area:.4g} mm2, to be meshed"
        )
        raise InvalidInput("thinnest wall of the section", float(f"{1e3 * size * across:.4g}"), requirement)
