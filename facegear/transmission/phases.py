"""Phase of each mesh, equation (7) and the half turn between the two meshes of a pinion."""

from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from facegear.transmission.layout import Layout, Side


class PhaseConvention(StrEnum):
    """`geometric`: the half turn counts for every pinion; `printed`: for the first only, equation (11)."""

    GEOMETRIC = "geometric"
    PRINTED = "printed"


def mesh_phases(layout: Layout, convention: PhaseConvention) -> NDArray[np.float64]:
    """Lag of each mesh's stiffness behind the reference, in mesh periods within [0, 1), shape (meshes,)."""
    half_turn = 0.5 * layout.pinion_teeth
    phases = np.empty(len(layout.meshes))
    for row, (i, g) in enumerate(layout.meshes):
        lag = layout.pinions[i].pitches
        if layout.gears[g].side is Side.LOWER and (convention is PhaseConvention.GEOMETRIC or i == 0):
            lag += half_turn
        phases[row] = np.mod(lag, 1.0)
    return phases
