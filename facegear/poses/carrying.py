"""The pairs whose drive flanks the carrying flanks of a machine at its pose are."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Integers
from facegear.geometry.design import PairDesign
from facegear.geometry.flank_errors import FLANKS, GEARS, pair_at
from facegear.poses.fixed_point import OperatingPose

ERROR_TOLERANCE = 1e-9
"""Errors (m, rad) that differ by less are the same."""


@dataclass(frozen=True, eq=False)
class CarryingPairs:
    """Different pairs of a machine.

    Attributes
    ----------
    designs
        Each pair, its assembly that of the pose.
    torques
        What each carries on the pinion, N m; 0 where none does.
    numbers : (m,)
        Which of them the carrying flank of each mesh is, the drive flank where none carries.
    """

    designs: list[PairDesign]
    torques: list[float]
    numbers: Integers


def carrying_pairs(result: OperatingPose, design: PairDesign) -> CarryingPairs:
    """Of a converged pose and the design as assembled."""
    designs: list[PairDesign] = []
    torques: list[float] = []
    number_of_key: dict[tuple[object, ...], int] = {}
    numbers = []
    for mesh, force in enumerate(result.forces.tolist()):
        back, torque = force < 0.0, float(result.torque[mesh])
        errors = result.poses.errors(mesh, back)
        parts = (errors.offset, errors.shaft_angle_error, errors.axial_shift)
        key = (back, *(round(part / ERROR_TOLERANCE) for part in parts), f"{torque:.9g}")
        if key not in number_of_key:
            number_of_key[key] = len(designs)
            designs.append(replace(pair_at(design, GEARS[0], FLANKS[back]), assembly=errors))
            torques.append(torque)
        numbers.append(number_of_key[key])
    return CarryingPairs(designs, torques, np.array(numbers))
