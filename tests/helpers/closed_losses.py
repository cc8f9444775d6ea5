"""Loss factors in closed form."""

from math import acos, pi, sin, sqrt, tan

from facegear.teeth.design import PairDesign


def section_loss_factor(design: PairDesign, radius: float) -> float:
    """H_V of the plane at a radius (m) of the face gear, load shared equally in double contact.

    The form of Ohlendorf for a rack, and the part of sliding along the pinion's axis: exact for N_s = N1 and
    no assembly errors, contact ratios between 1 and 2 and both parts of the path below a pitch.
    """
    ratio = design.pinion.teeth / design.face_gear.teeth
    cosine = design.pinion_base_radius / (ratio * radius)
    angle = acos(cosine)
    pitch = 2 * pi * design.pinion_base_radius / design.pinion.teeth
    recess = (design.pinion_tip_roll - tan(angle)) * design.pinion_base_radius / pitch
    approach = (design.family.gear_tip.height(design.gear_pitch_radius) + ratio * radius) / (
        sin(angle) * pitch
    )
    whole = recess + approach
    factor = 1 - whole + recess**2 + approach**2
    return sqrt(1 + (ratio * cosine) ** 2) * pi / design.pinion.teeth * factor


def spur_loss_factor(teeth: tuple[int, int], recess: float, approach: float) -> float:
    """H_V of Ohlendorf for a spur pair: contact ratios of the pinion's tip (recess) and of the wheel's."""
    ratio = teeth[1] / teeth[0]
    whole = recess + approach
    return pi * (ratio + 1) / (teeth[0] * ratio) * (1 - whole + recess**2 + approach**2)
