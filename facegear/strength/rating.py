"""Safety and life of both gears under a duty cycle: bending from root stress, pitting from line contact."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np

from facegear.arrays import Array
from facegear.contact.pattern import FILLET_CONTACT
from facegear.number_format import format_number
from facegear.strength.contact_pressure import ContactPressure
from facegear.strength.cylindrical import (
    hertz_stress,
    pinion_form,
    pinion_notch,
    standard_bending,
    unknown_to_standard,
)
from facegear.strength.materials import BendingLimits, FlankDuty, Life, PittingLimits, damage, reliability
from facegear.strength.root_stress import RootStress, largest_tension
from facegear.strength.safety import RatingRequest, Stress, permissible_bending, reversal, safety
from facegear.teeth.analysis import transverse_contact_ratio
from facegear.teeth.design import PairDesign

EDGE = 1e3
"""Line load on tip edges, N/m, below which it is neglected."""


@dataclass(frozen=True, eq=False)
class FailureRating:
    """Rating of one flank of a gear against one failure, by one method.

    Attributes
    ----------
    duty
        Loads of the flank, n of them.
    failure, method
        Pitting or bending, and how its stress was computed.
    stress : (n,)
        Stress of each load, Pa.
    allowed_stress
        Stress that may be repeated for ever before life factors, Pa.
    limit
        Life factors of the material.
    damage : (n,)
        Damage of each load.
    safety
        Factor on all stresses at which Miner's sum is 1.
    required_safety
        Minimum safety.
    life
        Life under the duty cycle, s.
    reliability
        Reliability at the end of the duty cycle: nan where the card has no Weibull shape (`has_shape`), or
        where
        no load does damage.
    has_shape
        Whether the card has a Weibull shape.
    edge_load
        Load on tip edges under the largest load, N/m.
    fillet_share
        The largest share of the torque that fillets carry under any load.
    without_standard
        Why there is no rating by ISO 6336 beside it; empty where there is one.
    """

    duty: FlankDuty
    failure: str
    method: str
    stress: Array
    allowed_stress: float
    limit: Life
    damage: Array
    safety: float
    required_safety: float
    life: float
    reliability: float
    has_shape: bool
    edge_load: float
    fillet_share: float
    without_standard: str

    @property
    def verdict(self) -> str:
        """green: as safe as required; red: less safe. `caveats` never change it."""
        return "green" if self.safety >= self.required_safety else "red"

    @property
    def reason(self) -> str:
        """Reason for red, empty if green: damage and life, or the safety with that required, or an
        immediate break.
        """
        if self.verdict == "green":
            return ""
        harm = float(self.damage.sum())
        if not isfinite(harm):
            return "the first load breaks the tooth"
        if harm <= 1.0:
            return f"safety {self.safety:.2f}, {self.required_safety:g} required"
        hours = self.life / 3600.0
        return f"damage {harm:.3g} in {format_number(harm * hours)} h, life {format_number(hours)} h"

    @property
    def caveats(self) -> tuple[str, ...]:
        """Remarks on load that the stress leaves out, on tip edges (for pitting, from EDGE on) and in
        fillets, and on a standard that has no form for the teeth.
        """
        caveats = []
        if self.failure == "pitting" and self.edge_load >= EDGE:
            caveats.append(f"tip edges carry {1e-3 * self.edge_load:.0f} N/mm, where pressure has no limit")
        if self.fillet_share >= FILLET_CONTACT:
            share = f"fillets carry up to {100 * self.fillet_share:.2g} % of the torque"
            caveats.append(f"{share}, kept out of pressure and root stress")
        if self.without_standard:
            caveats.append(f"not compared with ISO 6336, which does not know {self.without_standard}")
        return tuple(caveats)


@dataclass(frozen=True, eq=False)
class LoadStresses:
    """Largest `tension` in the fillets and largest `pressure` of each load of a flank, both (n,) Pa."""

    tension: Array
    pressure: Array


def rate(
    design: PairDesign,
    roots: Mapping[str, RootStress],
    pressure: ContactPressure,
    request: RatingRequest,
    of_loads: LoadStresses | None = None,
    opposite: Sequence[RootStress] = (),
) -> list[FailureRating]:
    """Rate bending and pitting of every loaded flank.

    Each is rated by the contact analysis and, where the cylindrical standard knows such teeth, by this:
    bending by `finite elements` and, for pinions, `ISO 6336-3`; pitting by `contact analysis` and `ISO
    6336-2`. The standard alone judges pitting where no `pressure` away from edges is known; where it does
    not know the teeth, pitting is not rated then.

    Parameters
    ----------
    design : PairDesign
        The pair whose drive flanks are rated.
    roots : Mapping[str, RootStress]
        Root stress of both bodies.
    pressure : ContactPressure
        Pressure on the flanks.
    request : RatingRequest
        Bodies, duty cycle and required safeties.
    of_loads : LoadStresses or None
        Stresses of the only flank of the request, if its contact pose differs between loads; they replace
        those that `roots` and `pressure` give by torque.
    opposite : Sequence[RootStress]
        Root stress of the only gear of the request by contacts of its other flank, as `reversal` takes it.

    Returns
    -------
    list[FailureRating]
        One for each flank, failure and method.
    """
    ratings: list[FailureRating] = []
    missing_kinds = unknown_to_standard(design)
    bending, pitting = (None, None) if missing_kinds else _standard_stresses(design, request)
    notch = pinion_notch(design)
    tension = {gear: largest_tension(root) for gear, root in roots.items()}
    for duty in request.duty:
        stresses = of_loads or LoadStresses(
            _stress_by_load(tension[duty.gear], duty), _stress_by_load(pressure.at, duty)
        )
        pitting_limits, bending_limits = request.bodies[duty.gear].limits()
        ratio = reversal(roots[duty.gear], duty, opposite)
        notch_here = notch if duty.gear == "pinion" else None
        allowed_stress = permissible_bending(design, request.bodies[duty.gear], notch_here, ratio)
        ways: list[tuple[str, str, Array, float, PittingLimits | BendingLimits]] = []
        ways.append(("bending", "finite elements", stresses.tension, allowed_stress, bending_limits))
        if duty.gear == "pinion" and bending is not None:
            stress = _stress_by_load(bending, duty)
            ways.append(("bending", "ISO 6336-3", stress, allowed_stress, bending_limits))
        if pressure.is_known:
            way = "pitting", "contact analysis", stresses.pressure, pitting_limits.limit, pitting_limits
            ways.append(way)
        if pitting is not None:
            stress = _stress_by_load(pitting[duty.gear], duty)
            ways.append(("pitting", "ISO 6336-2", stress, pitting_limits.limit, pitting_limits))
        ratings += [_rate_failure(request, duty, *way, pressure, missing_kinds) for way in ways]
    return ratings


def _standard_stresses(design: PairDesign, request: RatingRequest) -> tuple[Stress, dict[str, Stress]]:
    """Return the root stress of the pinion, and the contact stress of each body, by the standard, as
    functions of torque.
    """
    ratio = transverse_contact_ratio(design)
    return standard_bending(design, pinion_form(design, ratio)), hertz_stress(design, ratio, request)


def _stress_by_load(stress: Stress, duty: FlankDuty) -> Array:
    """Return the stress (n,), Pa, at the torque of each load of the flank."""
    return np.array([stress(torque) for torque in duty.torque])


def _rate_failure(
    request: RatingRequest,
    duty: FlankDuty,
    failure: str,
    method: str,
    by_load: Array,
    allowed_stress: float,
    limits: PittingLimits | BendingLimits,
    pressure: ContactPressure,
    without_standard: str,
) -> FailureRating:
    """Rate one flank against one failure (`bending` or `pitting`) by one method: damage, safety and life.

    `by_load` (n,), Pa, is the stress of each load of `duty`; `allowed_stress`, Pa, that which may be
    repeated for ever before life factors. Life is the time of the duty cycle over Miner's sum.
    `without_standard` says why the standard has no rating.
    """
    harm = damage(by_load, duty.cycles, allowed_stress, limits.life)
    total = float(harm.sum())
    loads = duty.torque[(duty.cycles > 0.0) & (duty.torque > 0.0)]
    return FailureRating(
        duty=duty,
        failure=failure,
        method=method,
        stress=by_load,
        allowed_stress=allowed_stress,
        limit=limits.life,
        damage=harm,
        safety=safety(by_load, duty.cycles, allowed_stress, limits.life),
        required_safety=request.min_bending if failure == "bending" else request.min_pitting,
        life=request.time / total if total > 0.0 else np.inf,
        reliability=reliability(total, limits.weibull_shape),
        has_shape=limits.weibull_shape is not None,
        edge_load=pressure.edge_at(duty.largest)[0],
        fillet_share=float(pressure.fillet_at(loads).max(initial=0.0)),
        without_standard=without_standard,
    )
