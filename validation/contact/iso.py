"""Mesh stiffness of spur gears by ISO 6336-1 method B, to stand beside computed ones: a band of some 20 %."""

from math import pi, tan

from facegear.teeth.design import PairDesign
from facegear.teeth.pinion import junction_roll


def single_stiffness(first: PairDesign, second: PairDesign) -> float:
    """Return the theoretical single stiffness c'_th times 0.8 (C_B = C_R = 1).

    Solid steel gears; q' by the standard's polynomial in the tooth numbers and profile shifts.

    Parameters
    ----------
    first, second : PairDesign
        Both gears.

    Returns
    -------
    float
        Stiffness per width, N/m per m.
    """
    (z1, x1), (z2, x2) = (
        (gear.pinion.teeth, gear.pinion.profile_shift / gear.module) for gear in (first, second)
    )
    q = 0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1
    q += -0.00193 * x2 - 0.24188 * x2 / z2 + 0.00529 * x1**2 + 0.00182 * x2**2
    return 0.8e9 / q


def mesh_stiffness(first: PairDesign, second: PairDesign) -> float:
    """Return c_gamma = c' (0.75 eps_alpha + 0.25).

    Parameters
    ----------
    first, second : PairDesign
        Both gears.

    Returns
    -------
    float
        Stiffness per width, N/m per m.
    """
    return single_stiffness(first, second) * (0.75 * contact_ratio(first, second) + 0.25)


def contact_ratio(first: PairDesign, second: PairDesign) -> float:
    """Return the transverse contact ratio at the standard centre distance, cut off where an involute ends.

    Parameters
    ----------
    first, second : PairDesign
        Both gears.

    Returns
    -------
    float
        Contact ratio, dimensionless.
    """
    total = 0.0
    for gear, mating_gear in ((first, second), (second, first)):
        pitch = gear.pinion_base_radius * tan(gear.pressure_angle)
        reach = gear.pinion_base_radius * gear.pinion_tip_roll - pitch
        other_pitch = mating_gear.pinion_base_radius * tan(mating_gear.pressure_angle)
        total += min(
            reach,
            other_pitch
            - mating_gear.pinion_base_radius * float(junction_roll(mating_gear, mating_gear.middle)),
        )
    return total / (2 * pi * first.pinion_base_radius / first.pinion.teeth)
