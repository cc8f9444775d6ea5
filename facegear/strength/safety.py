"""Safety of a flank and a root: bisection over the load, bending limits, Hertz stress."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi, sqrt, tan

import numpy as np

from facegear.arrays import Array
from facegear.errors import FacegearError
from facegear.quantities import BODIES
from facegear.strength.materials import BendingLimits, FlankDuty, Life, MaterialCard, PittingLimits, damage
from facegear.strength.root_form import (
    STRESS_CORRECTION_REFERENCE,
    RootForm,
    SpurGear,
    contact_ratio_factor,
    elasticity_factor,
    mean_stress_factor,
    relative_notch_sensitivity,
    relative_surface_factor,
    root_form,
    size_factor,
)
from facegear.strength.root_stress import RootStress, down_the_fillet
from facegear.teeth.design import PairDesign

Stress = Callable[[float], float]
"""Stress (Pa) at a torque (N m) on the pinion."""
HALVINGS = 60
"""Number of bisections of the safety, whose bracket 1e-4 to 1e4 they narrow to rounding error."""


@dataclass(frozen=True)
class RatedBody:
    """Limits of the pinions or of the face gears, and the roughness Rz (m) of their fillets."""

    card: MaterialCard
    root_roughness: float

    def limits(self) -> tuple[PittingLimits, BendingLimits]:
        """Return the limits of pitting and bending.

        Returns
        -------
        tuple[PittingLimits, BendingLimits]
            Limits of pitting and of bending.

        Raises
        ------
        FacegearError
            Naming the card if it lacks either.
        """
        if self.card.pitting is None or self.card.bending is None:
            raise FacegearError(f"card {self.card.name!r} lacks limits of pitting or bending")
        return self.card.pitting, self.card.bending


@dataclass(frozen=True)
class RatingRequest:
    """Inputs of a rating.

    Attributes
    ----------
    bodies
        Limits and roughness by gear, `pinion` and `face_gear`.
    duty
        Loads of the flanks of all gears.
    time
        Time of the whole duty cycle, s.
    min_bending, min_pitting
        Required safeties, dimensionless.
    """

    bodies: Mapping[str, RatedBody]
    duty: tuple[FlankDuty, ...]
    time: float
    min_bending: float
    min_pitting: float


def safety(stress: Array, cycles: Array, allowed_stress: float, life: Life) -> float:
    """Solve for the factor on all stresses at which Miner's sum over all loads reaches 1, by bisection.

    Parameters
    ----------
    stress : (n,) array
        Stress of each load, Pa.
    cycles : (n,) array
        Number of cycles of each load.
    allowed_stress : float
        Stress that may be repeated for ever before life factors, Pa.
    life : Life
        Life factors of the material.

    Returns
    -------
    float
        Safety factor, within 1e-4 to 1e4.
    """
    low, high = 1e-4, 1e4
    for _ in range(HALVINGS):
        middle = sqrt(low * high)
        if damage(middle * stress, cycles, allowed_stress, life).sum() > 1.0:
            high = middle
        else:
            low = middle
    return low


def reversal(root: RootStress, duty: FlankDuty) -> float:
    """Return the stress ratio R of a turn at the place of the largest tension, in the bin of the largest
    load.

    The place is on the fillet below the rated flank. Compression comes from the loads of the other flank;
    where it has none stress is taken to rise from 0, and R is 0.

    Parameters
    ----------
    root : RootStress
        Root stress of the rated gear.
    duty : FlankDuty
        Loads of the rated flank.

    Returns
    -------
    float
        Smallest over largest stress, dimensionless; negative where stress swings.
    """
    worst = int(np.argmax(np.where(duty.cycles > 0.0, duty.torque, 0.0)))
    opposite_torque = duty.opposite[duty.bins[worst]]
    if opposite_torque == 0.0:
        return 0.0
    tension, compression = (
        down_the_fillet(root.at_torque(torque)) for torque in (duty.torque[worst], opposite_torque)
    )
    high = tension[:, 0].max(axis=0)
    down, along = np.unravel_index(np.argmax(high), high.shape)
    return float(
        min(tension[:, 0, down, along].min(), compression[:, 1, down, along].min()) / high[down, along]
    )


def permissible_bending(
    design: PairDesign, body: RatedBody, notch_parameter: float | None, ratio: float
) -> float:
    """Return the root stress that may be repeated for ever, before life factors.

    sigma_F lim Y_ST Y_delta rel T Y_R rel T Y_X Y_M. Without a notch parameter (the face gear, for which the
    standard has none) Y_delta rel T is 1. Y_M takes Y_S = 2.

    Parameters
    ----------
    design : PairDesign
        The pair.
    body : RatedBody
        Limits and roughness of the body.
    notch_parameter : float or None
        Notch parameter q_s, dimensionless; None for the face gear.
    ratio : float
        Smallest over largest stress of a turn, dimensionless.

    Returns
    -------
    float
        Stress, Pa.

    Raises
    ------
    FacegearError
        Naming the value that the card lacks.
    """
    _, limits = body.limits()
    notch = 1.0
    if notch_parameter is not None:
        if limits.slip_layer is None:
            raise FacegearError(f"card {body.card.name!r} lacks bending.slip_layer_mm")
        notch = relative_notch_sensitivity(limits.slip_layer, notch_parameter)
    mean = 1.0
    if ratio < 0.0:
        if limits.mean_stress is None:
            raise FacegearError(f"card {body.card.name!r} lacks bending.mean_stress")
        constant, slope = limits.mean_stress
        mean = mean_stress_factor(ratio, constant - slope * STRESS_CORRECTION_REFERENCE)
    surface = relative_surface_factor(body.root_roughness)
    return limits.limit * STRESS_CORRECTION_REFERENCE * notch * surface * size_factor(design.module) * mean


def pinion_form(design: PairDesign, contact_ratio: float) -> RootForm:
    """Return the root section of the pinion for a load at the outer point of single contact.

    The gear is taken as a rack: the roll angle there is that of the tip less (contact_ratio - 1) pitches.

    Parameters
    ----------
    design : PairDesign
        The pair.
    contact_ratio : float
        Contact ratio, dimensionless.

    Returns
    -------
    RootForm
        Root section after ISO 6336-3.
    """
    part, m = design.pinion, design.module
    spur = SpurGear(
        teeth=part.teeth,
        module=m,
        pressure_angle=design.pressure_angle,
        profile_shift=part.profile_shift / m,
        tip_radius=design.pinion_tip_radius,
        width=_width(design),
        rack_addendum=part.dedendum / m,
        rack_tip_radius=part.rack_tip_radius / m,
    )
    roll = design.pinion_tip_roll - (contact_ratio - 1.0) * 2.0 * pi / part.teeth
    return root_form(spur, design.pinion_base_radius * sqrt(1.0 + roll**2))


def standard_bending(design: PairDesign, form: RootForm) -> Stress:
    """Return the root stress F_t Y_F Y_S / (b m) with the whole load on one tooth, evenly along the
    narrower face b.

    F_t is the torque over the pinion's pitch radius, m the module.

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
    scale = form.form_factor * form.stress_correction / (_width(design) * design.module)
    return lambda torque: torque / design.pinion_pitch_radius * scale


def hertz_stress(design: PairDesign, contact_ratio: float, request: RatingRequest) -> dict[str, Stress]:
    """Return the contact stress of ISO 6336-2 on each body, the gear's flank taken as a rack's.

    Z_E Z_epsilon sqrt(F / (b R)), F the force along the line of action, b the narrower face and R the
    pinion's radius of curvature at the pitch point. The pinion is judged at its inner point of single
    contact where that is worse.

    Parameters
    ----------
    design : PairDesign
        The pair.
    contact_ratio : float
        Contact ratio, dimensionless.
    request : RatingRequest
        Gives the materials of both bodies.

    Returns
    -------
    dict[str, Stress]
        Stress (Pa) at a torque (N m) on the pinion, by body (`pinion`, `face_gear`).

    Raises
    ------
    FacegearError
        If the inner point of single contact lies below the base circle.
    """
    cards = [request.bodies[name].card for name in BODIES]
    first, second = ((card.young_modulus, card.poisson_ratio) for card in cards)
    base, pitch = design.pinion_base_radius, tan(design.pressure_angle)
    inner = design.pinion_tip_roll - 2.0 * pi / design.pinion.teeth
    factor = elasticity_factor(first, second) * contact_ratio_factor(contact_ratio)

    def at(roll: float) -> Stress:
        """Return the function from torque (N m) to contact stress (Pa) at a roll angle (rad) of the
        pinion.
        """
        return lambda torque: factor * sqrt(torque / (base * _width(design)) / (base * roll))

    if inner <= 0.0:
        raise FacegearError(
            "strength: the pinion's inner point of single contact must lie above its base circle"
        )
    return {"pinion": at(min(inner, pitch)), "face_gear": at(pitch)}


def _width(design: PairDesign) -> float:
    """Return the common face width of both gears, m."""
    gear = design.face_gear
    return min(design.pinion.width, gear.outer_radius - gear.inner_radius)
