"""Pairs of gears whose drive flanks are the loaded flanks of a machine at its pose."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Integers
from facegear.geometry.design import PairDesign
from facegear.geometry.flank_errors import FLANKS, GEARS, pair_at
from facegear.poses.fixed_point import OperatingPose

ERROR_TOLERANCE = 1e-9
"""Difference of errors (m, rad) below which they count as the same."""


@dataclass(frozen=True, eq=False)
class CarryingPairs:
    """Different pairs of a machine.

    Attributes
    ----------
    designs
        Each pair, its assembly that of the pose.
    torques
        Torque of each on the pinion, N m; 0 where it carries none.
    numbers : (m,)
        Index of the pair of the carrying flank of each mesh, of the drive flank where none carries.
    """

    designs: list[PairDesign]
    torques: list[float]
    numbers: Integers


def carrying_pairs(result: OperatingPose, design: PairDesign) -> CarryingPairs:
    """Return the different pairs of a machine at a converged pose.

    Parameters
    ----------
    result : OperatingPose
        Converged pose.
    design : PairDesign
        Design as assembled.

    Returns
    -------
    CarryingPairs
        Torques in N m.
    """
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
