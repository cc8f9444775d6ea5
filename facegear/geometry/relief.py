"""Flank modifications of the pinion: tip and root relief, lead crowning."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.geometry.design import PairDesign, Relief
from facegear.geometry.pinion import junction_roll


def removed(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> NDArray[np.float64]:
    """Material (m) taken off along the normal at roll angle `roll` (rad) and axial place `y` (m); broadcasts.

    Beyond the ends of the involute (in the fillet) the root relief keeps its full amount.
    """
    pinion, base = design.pinion, design.pinion_base_radius
    roll = np.asarray(roll, float)
    from_tip = base * (design.pinion_tip_roll - roll)
    from_root = base * (roll - junction_roll(design))
    from_middle = np.abs(np.asarray(y, float) - design.mean_radius)
    return (
        _linear(pinion.tip_relief, from_tip)
        + _linear(pinion.root_relief, from_root)
        + _parabola(pinion.lead_crowning, from_middle)
    )


def _linear(relief: Relief, from_end: NDArray[np.float64]) -> NDArray[np.float64]:
    if relief.amount == 0:
        return np.zeros_like(from_end)
    return relief.amount * np.clip((relief.start + relief.length - from_end) / relief.length, 0, 1)


def _parabola(relief: Relief, from_middle: NDArray[np.float64]) -> NDArray[np.float64]:
    if relief.amount == 0:
        return np.zeros_like(from_middle)
    return relief.amount * np.maximum((from_middle - relief.start) / relief.length, 0) ** 2
