"""A machine to start from, with quick estimates of what it will do."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from math import exp, log, pi, sqrt, tan

import numpy as np
from scipy.optimize import brentq

from facegear.build.strength import rating_request
from facegear.errors import FacegearError
from facegear.machine.loaded_modes import vibrating_machine
from facegear.new_machine.bearings import (
    LARGEST_K_GAMMA,
    Bearings,
    Split,
    choose_bearings,
    smallest_torque,
    split_of,
)
from facegear.new_machine.draft import SPEEDS, STIFFNESS, Draft
from facegear.new_machine.teeth import MORE_SHAPER_TEETH, choose_teeth, is_spur
from facegear.new_machine.wishes import RADIAL, MachineWishes, require_room, require_wishes
from facegear.number_format import count_noun, format_number
from facegear.schema.base import parse
from facegear.schema.strength import Strength
from facegear.strength.cylindrical import hertz_stress, pinion_form, standard_bending
from facegear.strength.root_form import contact_ratio_factor
from facegear.strength.safety import permissible_bending
from facegear.teeth.analysis import path_curvatures
from facegear.teeth.design import PairDesign
from facegear.teeth.flank_numbers import flank_numbers

RESONANCES = 3
"""Number of resonances that are printed."""
RESERVES = {"bending": 1.75, "pitting": 1.25}
"""Estimated safety over that of the report which is allowed for: largest of docs/measured/starters.csv."""
LEAST_PART = 1e-4
"""Smallest part of the torque that is searched for a safe one."""


def estimate_lines(draft: Draft, bearings: Bearings, split: Split, mesh_torque: float) -> Iterator[str]:
    """Yield lines of estimates: ratio and power, load sharing, safety, resonances, and advice where one
    is poor.

    Parameters
    ----------
    draft : Draft
        The machine without bearings.
    bearings : Bearings
        Radial stiffness of its bearings, N/m.
    split : Split
        How the machine with these bearings shares its load.
    mesh_torque : float
        Torque on the pinion by the most loaded mesh, N m.

    Returns
    -------
    iterator of str
        One line of text for each estimate, with units.
    """
    yield _power_line(draft)
    yield from _split_lines(draft, bearings, split)
    safeties = estimate_safeties(draft, mesh_torque)
    yield (
        f"safety of the pinion against bending {safeties.bending:.3g}, against pitting "
        f"{safeties.pitting:.3g} at {_text(mesh_torque)} N m a mesh (standard for cylindrical gears, "
        "crowning of the flanks, endurance limit)"
    )
    if safeties.spare < 1.0:
        yield _poor_safety(draft, mesh_torque, safeties)
    yield _resonances(draft, bearings)


def other_teeth_lines(draft: Draft, bearings: Bearings, split: Split, mesh_torque: float) -> Iterator[str]:
    """Yield lines of estimates of a machine whose teeth are not spur: power, forces and limits of the face,
    load sharing and resonances.

    Parameters
    ----------
    draft : Draft
        The machine without bearings.
    bearings : Bearings
        Radial stiffness of its bearings, N/m.
    split : Split
        How the machine with these bearings shares its load.
    mesh_torque : float
        Torque on the pinion by the most loaded mesh, N m.

    Returns
    -------
    iterator of str
        One line of text for each, with units.
    """
    design = draft.teeth.design
    yield _power_line(draft)
    for name, numbers in flank_numbers(design).items():
        axial, upward = (
            mesh_torque * numbers[f"{part}_force_per_torque_per_m"] for part in ("axial", "separating")
        )
        yield (
            f"{name} flank: contact ratio {numbers['contact_ratio']:.3g}, face from "
            f"{numbers['inner_limit_mm']:.4g} mm ({numbers['inner_cause']}); "
            f"at {_text(mesh_torque)} N m a mesh {_text(axial)} N outwards along the pinion's axis, "
            f"{_text(upward)} N away from the gear"
        )
    yield from _split_lines(draft, bearings, split)
    yield _resonances(draft, bearings)
    yield "not estimated for teeth that are not spur: safety, which the report computes from contact"


def _split_lines(draft: Draft, bearings: Bearings, split: Split) -> Iterator[str]:
    """Yield a line of load sharing and, where it is poor, what would help; none without idlers."""
    if not draft.wishes.idlers:
        return
    low, high = split.idlers
    # A single idler shares its load with none.
    idlers = f", {low:.3g} to {high:.3g} of idlers" if np.isfinite(low) else ""
    yield (
        f"K_gamma {split.inputs:.3g} of inputs{idlers}; largest load of a "
        f"path over the mean of its group {split.group_ratio:.3g} (estimated with the errors written)"
    )
    if split.excess > 1.0:
        yield _poor_split(draft, bearings)


def _power_line(draft: Draft) -> str:
    """Return the line with ratio, power, mesh frequency and contact ratio."""
    wishes = draft.wishes
    ratio = wishes.face_gear_teeth / wishes.pinion_teeth
    power = wishes.pinions * wishes.torque_n_m * wishes.speed_rpm * pi / 30e3
    return (
        f"ratio {_text(ratio)}, {_text(power)} kW from {count_noun(wishes.pinions, 'input')}, "
        f"mesh frequency {_text(wishes.pinion_teeth * wishes.speed_rpm / 60)} Hz, "
        f"contact ratio {draft.teeth.analysis.contact_ratio:.3g}"
    )


def _poor_split(draft: Draft, bearings: Bearings) -> str:
    """Return a line that says that the load is shared unevenly, with the load per area of face, and what
    would help.
    """
    wished_bearings = [name for name in RADIAL if getattr(draft.wishes, name) is not None]
    least = smallest_torque(draft.closed_form(), bearings, draft.wishes.torque_n_m)
    width = 1e-3 * (draft.outer - draft.inner)
    radius = 0.5e-3 * draft.wishes.module_mm * draft.wishes.pinion_teeth
    unit = 0.5e-6 * draft.wishes.torque_n_m / radius / (width * 1e-3 * draft.wishes.module_mm)
    better = (
        f"bearings as chosen without {' and '.join(wished_bearings)}"
        if wished_bearings
        else "more torque or less backlash"
        if least <= draft.wishes.torque_n_m
        else (f"at least {_text(least)} N m an input" if np.isfinite(least) else "less backlash")
    )
    return (
        f"load sharing is worse than K_gamma {LARGEST_K_GAMMA:g} at this load, "
        f"F_t/(b m) = {unit:.3g} MPa; nearest: {better}"
    )


@dataclass(frozen=True)
class Safeties:
    """Estimated safety of the pinion against bending and pitting, and what is required of both."""

    bending: float
    pitting: float
    required_bending: float
    required_pitting: float

    @property
    def spare(self) -> float:
        """Smaller one of `spare_bending` and `spare_pitting`; below 1 the rating of the report may fail."""
        return min(self.spare_bending, self.spare_pitting)

    @property
    def spare_bending(self) -> float:
        """Safety against bending over what is required and what the estimate may be too large by
        (RESERVES).
        """
        return self.bending / (RESERVES["bending"] * self.required_bending)

    @property
    def spare_pitting(self) -> float:
        """Safety against pitting over what is required and what the estimate may be too large by
        (RESERVES).
        """
        return self.pitting / (RESERVES["pitting"] * self.required_pitting)


def estimate_safeties(draft: Draft, mesh_torque: float) -> Safeties:
    """Estimate the pinion's safety against bending and pitting by the standard for cylindrical gears.

    The standard's contact ratio factor is left out: it is for a load that several pairs carry evenly
    along the face, and flanks with crowning carry the largest pressure while one pair is in contact.

    Parameters
    ----------
    draft : Draft
        The machine, of which teeth and section `strength` are taken.
    mesh_torque : float
        Torque on the pinion by its mesh, N m.

    Returns
    -------
    Safeties
        Safeties for the endurance limit, and those required, dimensionless.
    """
    design, ratio = draft.teeth.design, draft.teeth.analysis.contact_ratio
    request = rating_request(parse(Strength, draft.values_of_config["strength"]), design)
    form = pinion_form(design, ratio)
    permissible = permissible_bending(design, request.bodies["pinion"], form.notch_parameter, 0.0)
    pitting, _ = request.bodies["pinion"].limits()
    stress = hertz_stress(design, ratio, request)["pinion"](mesh_torque) / contact_ratio_factor(ratio)
    stress *= sqrt(load_concentration(design, mesh_torque))
    bending = permissible / standard_bending(design, form)(mesh_torque)
    return Safeties(bending, pitting.limit / stress, request.min_bending, request.min_pitting)


def _poor_safety(draft: Draft, mesh_torque: float, safeties: Safeties) -> str:
    """Return a line that names the safety without reserve and the input torque at which it would have
    one.

    The torque is found by root search over its logarithm, down to LEAST_PART of the present one; a larger
    module always helps.
    """

    def excess(logarithm: float) -> float:
        """Return the logarithm of the spare safety at a torque given as logarithm of its ratio to
        `mesh_torque`.
        """
        return log(estimate_safeties(draft, mesh_torque * exp(logarithm)).spare)

    nearest = "a larger module"
    if excess(log(LEAST_PART)) > 0.0:
        torque = draft.wishes.torque_n_m * exp(brentq(excess, log(LEAST_PART), 0.0))
        nearest = f"at most {format_number(torque, 3, group_digits=False)} N m an input, or {nearest}"
    kind, value, least = (
        ("bending", safeties.bending, safeties.required_bending)
        if safeties.spare_bending < safeties.spare_pitting
        else ("pitting", safeties.pitting, safeties.required_pitting)
    )
    return (
        f"a safety of {value:.3g} against {kind} leaves the rating without reserve ({least:g} required); "
        f"nearest: {nearest}"
    )


def load_concentration(design: PairDesign, mesh_torque: float) -> float:
    """Estimate the largest line load of a tooth pair along the face over its mean.

    A shaper with more teeth than the pinion crowns the flanks against each other: beside the path of
    contact they part by half the smaller relative curvature times the distance squared. The face carries
    the load as independent strips with the mesh stiffness of the standard.

    Parameters
    ----------
    design : PairDesign
        Geometry of the pair.
    mesh_torque : float
        Torque on the pinion, N m, that one pair of teeth carries.

    Returns
    -------
    float
        Ratio, dimensionless, at least 1; 1 for flanks without crowning.
    """
    gear, path = design.face_gear, 0.5 * design.module * design.face_gear.teeth
    inner, outer = gear.inner_radius - path, gear.outer_radius - path
    roll, _, curvatures, _ = path_curvatures(design)
    curvature = float(curvatures[np.abs(roll - tan(design.pressure_angle)).argmin()])
    if curvature <= 0.0:
        return 1.0
    approach_of_force = mesh_torque / design.normal_arm / STIFFNESS
    nearest = min(max(0.0, inner), outer)
    first_touch = 0.5 * curvature * nearest**2

    def excess(approach: float) -> float:
        """Return the load of the strips at an approach (m) less the given one, both over STIFFNESS, m2."""
        reach = sqrt(2.0 * approach / curvature)
        start, end = max(inner, -reach), min(outer, reach)
        return approach * (end - start) - curvature * (end**3 - start**3) / 6.0 - approach_of_force

    whole_face = approach_of_force / (outer - inner) + 0.5 * curvature * max(inner**2, outer**2)
    approach = brentq(excess, first_touch, whole_face)
    return float((approach - first_touch) * (outer - inner) / approach_of_force)


def _resonances(draft: Draft, bearings: Bearings) -> str:
    """Return a line with pinion speeds (rpm) at which the mesh frequency meets a natural frequency.

    Listed are at most RESONANCES between the ends of the sweep, from the lowest on; else the lowest of
    all.
    """
    wishes = draft.wishes
    slow, fast = (max(factor * wishes.speed_rpm, 1.0) for factor in SPEEDS)
    frequencies = np.unique(np.round(vibrating_machine(draft.machine(bearings)).modes.frequencies, 1))
    speeds = 60.0 * frequencies / wishes.pinion_teeth
    within = speeds[(speeds >= slow) & (speeds <= fast)]
    if not within.size:
        lowest = _text(speeds[speeds > 0.0].min())
        return (
            f"no resonance of the mesh frequency between {_text(slow)} and {_text(fast)} rpm; "
            f"the lowest of all is near {lowest} rpm"
        )
    near = ", ".join(_text(speed) for speed in within[:RESONANCES])
    return f"first {'resonance' if within.size == 1 else 'resonances'} of the mesh frequency near {near} rpm"


def _text(number: float) -> str:
    """Return a number as text with four significant digits."""
    return format_number(number, 4, group_digits=False)


LEAST_LOADED = 0.05
"""Part of the largest mesh load below which the contact analysis does not follow a mesh."""


@dataclass(frozen=True)
class FirstMachine:
    """A config as YAML text, and what to expect of the machine, one line each."""

    text: str
    expectations: tuple[str, ...]


def first_machine(wishes: MachineWishes) -> FirstMachine:
    """Choose all numbers of a machine that are not wished, and estimate what the machine will do.

    Where the safety is too small, shapers with fewer teeth are tried, which spread the contact.

    Parameters
    ----------
    wishes : MachineWishes
        Values that a user gave; None leaves a choice.

    Returns
    -------
    FirstMachine
        Config as YAML text with the reason of each choice, and one line for each estimate.

    Raises
    ------
    ConfigError
        For numbers that no machine can have, and teeth that do not exist, with the geometric reason.
    """
    require_wishes(wishes)
    require_room(wishes, choose_teeth(wishes.teeth).design)
    if not is_spur(wishes):
        candidate = _machine(Draft(wishes))
        expectations = other_teeth_lines(
            candidate.draft, candidate.bearings, candidate.split, candidate.loads[1]
        )
        return FirstMachine(candidate.draft.text(candidate.bearings, candidate.loads), tuple(expectations))
    best = _machine(Draft(wishes))
    if wishes.shaper_teeth is None:
        for more_shaper_teeth in MORE_SHAPER_TEETH[1:]:
            if best.spare[0] >= 1.0:
                break
            with suppress(FacegearError):
                best = max(
                    best, _machine(Draft(wishes, more_shaper_teeth)), key=lambda machine: machine.spare
                )
    return FirstMachine(
        best.draft.text(best.bearings, best.loads),
        tuple(estimate_lines(best.draft, best.bearings, best.split, best.loads[1])),
    )


@dataclass(frozen=True)
class _Machine:
    """A draft with its bearings, its load sharing and the torques (N m) of its meshes at rest."""

    draft: Draft
    bearings: Bearings
    split: Split
    loads: tuple[float, float]

    @cached_property
    def spare(self) -> tuple[float, float]:
        """`Safeties.spare` at the most loaded mesh, and `spare_pitting`, which the shaper changes, to
        compare machines.
        """
        safeties = estimate_safeties(self.draft, self.loads[1])
        return safeties.spare, safeties.spare_pitting


def _machine(draft: Draft) -> _Machine:
    """Choose the bearings of a draft and compute its load sharing and smallest and largest mesh torque.

    With idlers the bearings are chosen for an even split, else they are stiff. Meshes below LEAST_LOADED
    of the largest torque are left out of the smallest.
    """
    wishes = draft.wishes
    if wishes.idlers:
        bearing_wishes = (
            wishes.input_bearing_n_per_m,
            wishes.idler_bearing_n_per_m,
            wishes.gear_bearing_n_per_m,
        )
        choice = choose_bearings(draft.closed_form(), bearing_wishes, draft.machine)
        bearings, split = choice.bearings, choice.split
    else:
        bearings = draft.stiff_bearings()
        split = split_of(draft.machine(bearings))
    torques = split.mesh_torques
    largest = float(torques.max())
    return _Machine(draft, bearings, split, (float(torques[torques > LEAST_LOADED * largest].min()), largest))
