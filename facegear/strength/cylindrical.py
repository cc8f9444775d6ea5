"""A pair as the standard for cylindrical gears sees it: the pinion in its normal section, the gear a rack.

The standard rates a helical pinion by a virtual spur gear in the normal section, whose pitch radius is the
radius of curvature that the pitch cylinder has across the teeth, and by factors of helix and overlap (ISO
6336-2 and ISO 6336-3, both of 2006). Its contact ratio is that of the transverse section. Other kinds of
teeth have no form in it (`unknown_to_standard`); for these only the notch of the pinion's root is taken, from
the same virtual gear in the middle of the face.
"""

from math import pi, sin, sqrt, tan

from facegear.errors import FacegearError
from facegear.quantities import BODIES
from facegear.strength.root_form import (
    RootForm,
    SpurGear,
    contact_ratio_factor,
    elasticity_factor,
    helix_angle_factors,
    root_form,
)
from facegear.strength.safety import RatingRequest, Stress
from facegear.teeth.design import PairDesign


def unknown_to_standard(design: PairDesign) -> str:
    """Say why ISO 6336 has no form for a pair.

    Parameters
    ----------
    design : PairDesign
        The pair.

    Returns
    -------
    str
        What the standard does not know, empty for spur and helical teeth at right angles without offset.
    """
    drive, coast = design.pressure_angles
    kinds = {
        "tapered teeth": design.taper_angle != 0.0,
        "two pressure angles": drive != coast,
        "a pinion with offset": design.offset != 0.0,
        "another shaft angle than 90 degrees": design.shaft_angle != pi / 2,
    }
    return " and ".join(kind for kind, is_there in kinds.items() if is_there)


def overlap_ratio(design: PairDesign) -> float:
    """Compute the overlap ratio of the common face: its width over the axial pitch.

    Parameters
    ----------
    design : PairDesign
        The pair.

    Returns
    -------
    float
        Overlap ratio, dimensionless; 0 without a helix.
    """
    return _width(design) * sin(abs(design.helix_angle)) / (pi * design.module)


def virtual_pinion(design: PairDesign) -> SpurGear:
    """Return the virtual spur gear of the pinion in the normal section, for its drive flank.

    Its number of teeth is that of the pinion over cos^2(base helix) cos(helix); tip and root stand as far
    from its pitch circle as those of the pinion do in the middle of its face. A spur pinion is its own
    virtual gear.

    Parameters
    ----------
    design : PairDesign
        The pair.

    Returns
    -------
    SpurGear
        The virtual gear, its tip where the involute ends.
    """
    part, m = design.pinion, design.module
    base_cosine = design.family.pinion_flanks[0].cosine
    teeth = part.teeth * (design.transverse_module / m) / base_cosine**2
    tip = design.pinion_tip_radius - part.tip_chamfer - design.pinion_pitch_radius
    return SpurGear(
        teeth=teeth,
        module=m,
        pressure_angle=design.pressure_angle,
        profile_shift=part.profile_shift / m,
        tip_radius=0.5 * m * teeth + tip,
        width=_width(design),
        rack_addendum=part.dedendum / m,
        rack_tip_radius=part.rack_tip_radius / m,
    )


def pinion_notch(design: PairDesign) -> float:
    """Compute the notch parameter q_s of the pinion's root below its drive flank.

    Parameters
    ----------
    design : PairDesign
        Pair of any kind.

    Returns
    -------
    float
        q_s of the virtual pinion, dimensionless. It does not depend on where the load acts.
    """
    gear = virtual_pinion(design)
    return root_form(gear, gear.tip_radius).notch_parameter


def pinion_form(design: PairDesign, contact_ratio: float) -> RootForm:
    """Return the root section of the virtual pinion for a load at the outer point of single contact.

    The gear is taken as a rack: the roll angle there is that of the tip less (virtual contact ratio - 1)
    pitches.

    Parameters
    ----------
    design : PairDesign
        The pair.
    contact_ratio : float
        Transverse contact ratio, dimensionless.

    Returns
    -------
    RootForm
        Root section after ISO 6336-3.
    """
    gear = virtual_pinion(design)
    virtual_ratio = contact_ratio / design.family.pinion_flanks[0].cosine ** 2
    tip_roll = sqrt((gear.tip_radius / gear.base_radius) ** 2 - 1.0)
    roll = tip_roll - (virtual_ratio - 1.0) * 2.0 * pi / gear.teeth
    return root_form(gear, gear.base_radius * sqrt(1.0 + roll**2))


def standard_bending(design: PairDesign, form: RootForm) -> Stress:
    """Return the root stress F_t Y_F Y_S Y_beta / (b m_n) with the whole load on one tooth, evenly along the
    narrower face b.

    F_t is the torque over the pinion's pitch radius, m_n the normal module.

    Parameters
    ----------
    design : PairDesign
        The pair.
    form : RootForm
        Root section of the pinion.

    Returns
    -------
    Stress
        Function from torque (N m) on the pinion to stress (Pa).
    """
    helix, _ = helix_angle_factors(design.helix_angle, overlap_ratio(design))
    scale = form.form_factor * form.stress_correction * helix / (_width(design) * design.module)
    return lambda torque: torque / design.pinion_pitch_radius * scale


def hertz_stress(design: PairDesign, contact_ratio: float, request: RatingRequest) -> dict[str, Stress]:
    """Return the contact stress of ISO 6336-2 on each body, the gear's flank taken as a rack's.

    Z_E Z_epsilon Z_beta sqrt(F cos(base helix) / (b R)), F the force in the transverse section along the
    line of action, b the narrower face and R the pinion's radius of curvature in that section at the pitch
    point. The pinion is judged at its inner point of single contact where that is worse, less so with a
    growing overlap ratio, and not at all from an overlap ratio of 1 on (Z_B).

    Parameters
    ----------
    design : PairDesign
        The pair.
    contact_ratio : float
        Transverse contact ratio, dimensionless.
    request : RatingRequest
        Gives the materials of both bodies.

    Returns
    -------
    dict[str, Stress]
        Stress (Pa) at a torque (N m) on the pinion, by body (`pinion`, `face_gear`).

    Raises
    ------
    FacegearError
        If the inner point of single contact counts and lies below the base circle.
    """
    cards = [request.bodies[name].card for name in BODIES]
    first, second = ((card.young_modulus, card.poisson_ratio) for card in cards)
    base, pitch = design.pinion_base_radius, tan(design.transverse_pressure_angle)
    overlap = overlap_ratio(design)
    _, helix = helix_angle_factors(design.helix_angle, overlap)
    factor = elasticity_factor(first, second) * contact_ratio_factor(contact_ratio, overlap) * helix
    cosine = design.family.pinion_flanks[0].cosine
    inner_factor = 1.0
    if overlap < 1.0:
        inner = design.pinion_tip_roll - 2.0 * pi / design.pinion.teeth
        if inner <= 0.0:
            raise FacegearError(
                "strength: the pinion's inner point of single contact must lie above its base circle"
            )
        inner_factor += max(sqrt(pitch / inner) - 1.0, 0.0) * (1.0 - overlap)

    def stress(torque: float) -> float:
        """Return the contact stress (Pa) at the pitch point for a torque (N m) on the pinion."""
        return factor * sqrt(torque * cosine / (base * _width(design)) / (base * pitch))

    return {"pinion": lambda torque: inner_factor * stress(torque), "face_gear": stress}


def _width(design: PairDesign) -> float:
    """Return the common face width of both gears, m."""
    gear = design.face_gear
    return min(design.pinion.width, gear.outer_radius - gear.inner_radius)
