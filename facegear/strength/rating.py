"""Safety and life of both gears under a duty cycle: bending from root stress, pitting from line contact."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi, sqrt, tan

import numpy as np
from numpy.typing import NDArray

from facegear.errors import FacegearError
from facegear.geometry.design import PairDesign
from facegear.strength.factors import (
    STRESS_CORRECTION_REFERENCE,
    contact_ratio_factor,
    elasticity_factor,
    mean_stress_factor,
    relative_notch_sensitivity,
    relative_surface_factor,
    size_factor,
)
from facegear.strength.fatigue import damage
from facegear.strength.materials import BendingLimits, Life, MaterialCard, PittingLimits
from facegear.strength.root_form import RootForm, root_form
from facegear.strength.root_stress import RootStress, down_the_fillet
from facegear.strength.spur import SpurGear

Array = NDArray[np.float64]
Stress = Callable[[float], float]
"""Stress (Pa) at a torque (N m) on the pinion."""
HALVINGS = 60


@dataclass(frozen=True)
class DutyBin:
    """Torque (N m) on the pinion with all load factors, its speed (turns a second) and time (s)."""

    torque: float
    speed: float
    time: float


@dataclass(frozen=True)
class RatedBody:
    """Limits, roughness Rz (m) of the fillet, and how the teeth of one gear are loaded."""

    card: MaterialCard
    root_roughness: float
    cycles_per_turn: int
    both_ways: bool

    def limits(self) -> tuple[PittingLimits, BendingLimits]:
        """Raises FacegearError naming what the card lacks."""
        if self.card.pitting is None or self.card.bending is None:
            raise FacegearError(f"card {self.card.name!r} lacks limits of pitting or bending")
        return self.card.pitting, self.card.bending


@dataclass(frozen=True)
class RatingRequest:
    """What a rating is asked for; bodies `pinion` and `face_gear`."""

    bodies: Mapping[str, RatedBody]
    duty: tuple[DutyBin, ...]
    least_bending: float
    least_pitting: float


@dataclass(frozen=True, eq=False)
class Rated:
    """One way in which a gear may fail.

    `stress` (n,) Pa, `cycles` (n,) and `damage` (n,) by bin; `allowed` (Pa): stress that may be repeated for
    ever before life factors, which `limit` gives; `safety`: by how much all stresses may rise until Miner's
    sum is 1; `life`: of the duty cycle in seconds.
    """

    body: str
    failure: str
    method: str
    stress: Array
    cycles: Array
    allowed: float
    limit: Life
    damage: Array
    safety: float
    required: float
    life: float

    @property
    def verdict(self) -> str:
        """green: as safe as required; amber: lasts the duty cycle; red: does not."""
        return "green" if self.safety >= self.required else "amber" if self.safety >= 1.0 else "red"


def rate(
    design: PairDesign, contact_ratio: float, roots: Mapping[str, RootStress], request: RatingRequest
) -> list[Rated]:
    """Bending and pitting of both gears, and the pinion's bending after the cylindrical standard.

    `contact_ratio` that of the section of the pitch point; `roots` the root stress of both bodies.
    """
    found = []
    form = pinion_form(design, contact_ratio)
    pitting = hertz_stress(design, contact_ratio, request)
    for name, body in request.bodies.items():
        _, limits = body.limits()
        notch = form.notch_parameter if name == "pinion" else None
        allowed = permissible_bending(design, body, notch, reversal(roots[name]) if body.both_ways else 0.0)
        ways = {"finite elements": largest_tension(roots[name])}
        if name == "pinion":
            ways["ISO 6336-3"] = standard_bending(design, form)
        for method, stress in ways.items():
            found.append(_rated(design, request, name, "bending", method, stress, allowed, limits.life))
        limit, _ = body.limits()
        stress = pitting[name]
        found.append(_rated(design, request, name, "pitting", "ISO 6336-2", stress, limit.limit, limit.life))
    return found


def _rated(
    design: PairDesign,
    request: RatingRequest,
    body: str,
    failure: str,
    method: str,
    stress: Stress,
    allowed: float,
    life: Life,
) -> Rated:
    ratio = 1.0 if body == "pinion" else design.pinion.teeth / design.face_gear.teeth
    turns = ratio * request.bodies[body].cycles_per_turn
    by_bin = np.array([stress(one.torque) for one in request.duty])
    cycles = np.array([turns * one.speed * one.time for one in request.duty])
    harm = damage(by_bin, cycles, allowed, life)
    time, total = sum(one.time for one in request.duty), float(harm.sum())
    return Rated(
        body=body,
        failure=failure,
        method=method,
        stress=by_bin,
        cycles=cycles,
        allowed=allowed,
        limit=life,
        damage=harm,
        safety=safety(by_bin, cycles, allowed, life),
        required=request.least_bending if failure == "bending" else request.least_pitting,
        life=time / total if total > 0.0 else np.inf,
    )


def safety(stress: Array, cycles: Array, allowed: float, life: Life) -> float:
    """Factor on all stresses (n,) at which Miner's sum over the bins reaches 1."""
    low, high = 1e-4, 1e4
    for _ in range(HALVINGS):
        middle = sqrt(low * high)
        if damage(middle * stress, cycles, allowed, life).sum() > 1.0:
            high = middle
        else:
            low = middle
    return low


def largest_tension(root: RootStress) -> Stress:
    """Largest stress on either fillet over the passage and the face."""
    return lambda torque: float(down_the_fillet(root.at_torque(torque)).max())


def reversal(root: RootStress) -> float:
    """Smallest over largest stress at the worst place where both flanks are loaded alike, one at a time."""
    stress = down_the_fillet(root.stress[-1])
    high, low = stress.max(axis=0), stress.min(axis=0)
    down, along = np.unravel_index(np.argmax(high[0]), high[0].shape)
    return float(min(low[0, down, along], low[1, down, along]) / high[0, down, along])


def permissible_bending(
    design: PairDesign, body: RatedBody, notch_parameter: float | None, ratio: float
) -> float:
    """Root stress (Pa) that may be repeated for ever, before life factors.

    sigma_F lim Y_ST Y_delta rel T Y_R rel T Y_X Y_M. Without a notch parameter (the face gear, for which the
    standard has none) Y_delta rel T is 1. `ratio` of smallest to largest stress; Y_M takes Y_S = 2.
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
    """Root section of the pinion for a load at the outer point of single contact with the gear as a rack."""
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
    """F_t Y_F Y_S / (b m) with the whole load on one tooth, evenly along the narrower face."""
    scale = form.form_factor * form.stress_correction / (_width(design) * design.module)
    return lambda torque: torque / design.pinion_pitch_radius * scale


def hertz_stress(design: PairDesign, contact_ratio: float, request: RatingRequest) -> dict[str, Stress]:
    """Contact stress of the standard on each body, the gear's flank taken as a rack's.

    The pinion is judged at its inner point of single contact where that is worse than the pitch point.
    """
    cards = [request.bodies[name].card for name in ("pinion", "face_gear")]
    first, second = ((card.young_modulus, card.poisson_ratio) for card in cards)
    base, pitch = design.pinion_base_radius, tan(design.pressure_angle)
    inner = design.pinion_tip_roll - 2.0 * pi / design.pinion.teeth
    factor = elasticity_factor(first, second) * contact_ratio_factor(contact_ratio)

    def at(roll: float) -> Stress:
        return lambda torque: factor * sqrt(torque / (base * _width(design)) / (base * roll))

    if inner <= 0.0:
        raise FacegearError("the pinion's inner point of single contact lies below its base circle")
    return {"pinion": at(min(inner, pitch)), "face_gear": at(pitch)}


def _width(design: PairDesign) -> float:
    gear = design.face_gear
    return min(design.pinion.width, gear.outer_radius - gear.inner_radius)
