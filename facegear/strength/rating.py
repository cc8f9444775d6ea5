"""Safety and life of both gears under a duty cycle: bending from root stress, pitting from line contact."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite

import numpy as np

from facegear.arrays import Array
from facegear.contact.pattern import FILLET_CONTACT
from facegear.number_format import format_number
from facegear.strength.contact_pressure import ContactPressure
from facegear.strength.materials import BendingLimits, FlankDuty, Life, PittingLimits, damage, reliability
from facegear.strength.root_stress import RootStress, largest_tension
from facegear.strength.safety import (
    RatingRequest,
    Stress,
    hertz_stress,
    permissible_bending,
    pinion_form,
    reversal,
    safety,
    standard_bending,
)
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
        """Remarks on load that the stress leaves out: on tip edges (for pitting, from EDGE on) and in
        fillets.
        """
        caveats = []
        if self.failure == "pitting" and self.edge_load >= EDGE:
            caveats.append(f"tip edges carry {1e-3 * self.edge_load:.0f} N/mm, where pressure has no limit")
        if self.fillet_share >= FILLET_CONTACT:
            share = f"fillets carry up to {100 * self.fillet_share:.2g} % of the torque"
            caveats.append(f"{share}, kept out of pressure and root stress")
        return tuple(caveats)


@dataclass(frozen=True, eq=False)
class LoadStresses:
    """Largest `tension` in the fillets and largest `pressure` of each load of a flank, both (n,) Pa."""

    tension: Array
    pressure: Array


def rate(
    design: PairDesign,
    contact_ratio: float,
    roots: Mapping[str, RootStress],
    pressure: ContactPressure,
    request: RatingRequest,
    of_loads: LoadStresses | None = None,
) -> list[FailureRating]:
    """Rate bending and pitting of every loaded flank.

    Each is rated by the contact analysis and by the cylindrical standard: bending by `finite elements`
    and, for pinions, `ISO 6336-3`; pitting by `contact analysis` and `ISO 6336-2`. The standard alone
    judges pitting where no `pressure` away from edges is known.

    Parameters
    ----------
    design : PairDesign
        The pair.
    contact_ratio : float
        Contact ratio of the section of the pitch point, dimensionless.
    roots : Mapping[str, RootStress]
        Root stress of both bodies.
    pressure : ContactPressure
        Pressure on the flanks.
    request : RatingRequest
        Bodies, duty cycle and required safeties.
    of_loads : LoadStresses or None
        Stresses of the only flank of the request, if its contact pose differs between loads; they replace
        those that `roots` and `pressure` give by torque.

    Returns
    -------
    list[FailureRating]
        One for each flank, failure and method.
    """
    ratings = []
    form = pinion_form(design, contact_ratio)
    pitting = hertz_stress(design, contact_ratio, request)
    tension = {gear: largest_tension(root) for gear, root in roots.items()}
    for duty in request.duty:
        stresses = of_loads or LoadStresses(
            _stress_by_load(tension[duty.gear], duty), _stress_by_load(pressure.at, duty)
        )
        pitting_limits, bending_limits = request.bodies[duty.gear].limits()
        notch = form.notch_parameter if duty.gear == "pinion" else None
        ratio = reversal(roots[duty.gear], duty)
        allowed_stress = permissible_bending(design, request.bodies[duty.gear], notch, ratio)
        ways = {"finite elements": stresses.tension}
        if duty.gear == "pinion":
            ways["ISO 6336-3"] = _stress_by_load(standard_bending(design, form), duty)
        for method, stress in ways.items():
            ratings.append(
                _rate_failure(
                    request, duty, "bending", method, stress, allowed_stress, bending_limits, pressure
                )
            )
        ways = {"contact analysis": stresses.pressure} if pressure.is_known else {}
        allowed_stress = pitting_limits.limit
        for method, stress in (ways | {"ISO 6336-2": _stress_by_load(pitting[duty.gear], duty)}).items():
            ratings.append(
                _rate_failure(
                    request, duty, "pitting", method, stress, allowed_stress, pitting_limits, pressure
                )
            )
    return ratings


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
) -> FailureRating:
    """Rate one flank against one failure (`bending` or `pitting`) by one method: damage, safety and life.

    `by_load` (n,), Pa, is the stress of each load of `duty`; `allowed_stress`, Pa, that which may be
    repeated for ever before life factors. Life is the time of the duty cycle over Miner's sum.
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
    )
