"""Safety of a flank and a root: bisection over the load, and bending limits."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np

from facegear.arrays import Array
from facegear.errors import FacegearError
from facegear.strength.materials import BendingLimits, FlankDuty, Life, MaterialCard, PittingLimits, damage
from facegear.strength.root_form import (
    STRESS_CORRECTION_REFERENCE,
    mean_stress_factor,
    relative_notch_sensitivity,
    relative_surface_factor,
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


def reversal(root: RootStress, duty: FlankDuty, opposite: Sequence[RootStress] = ()) -> float:
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
    opposite : Sequence[RootStress]
        Root stress of the same gear by each contact of its other flank, whose gauges are those of `root` in
        a mirror with the fillets exchanged; the worst counts. Empty where the other flank's contacts are
        the mirror image of the rated ones.

    Returns
    -------
    float
        Smallest over largest stress, dimensionless; negative where stress swings.
    """
    worst = int(np.argmax(np.where(duty.cycles > 0.0, duty.torque, 0.0)))
    opposite_torque = duty.opposite[duty.bins[worst]]
    if opposite_torque == 0.0:
        return 0.0
    tension = down_the_fillet(root.at_torque(duty.torque[worst]))[:, 0]
    high = tension.max(axis=0)
    down, along = np.unravel_index(np.argmax(high), high.shape)
    low = [
        down_the_fillet(contact.at_torque(opposite_torque))[:, 1, down, along].min()
        for contact in opposite or (root,)
    ]
    return float(min(tension[:, down, along].min(), *low) / high[down, along])


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
