"""Quick estimates of what a machine to start from will do."""

from collections.abc import Iterator
from math import pi, sqrt, tan

import numpy as np
from scipy.optimize import brentq

from facegear.config.base import parse
from facegear.config.strength import Strength, rating_request
from facegear.geometry.analysis import path_curvatures
from facegear.geometry.design import PairDesign
from facegear.number_format import count_noun, format_number
from facegear.strength.rating import hertz_stress, permissible_bending, pinion_form, standard_bending
from facegear.transmission.loaded_modes import vibrating_machine
from facegear.variants.split_bearings import (
    LARGEST_K_GAMMA,
    Bearings,
    Split,
    smallest_torque,
)
from facegear.variants.starting_draft import SPEEDS, STIFFNESS, Draft
from facegear.variants.wish_limits import RADIAL

RESONANCES = 3
"""Number of resonances that are printed."""


def estimate_lines(draft: Draft, bearings: Bearings, split: Split, mesh_torque: float) -> Iterator[str]:
    """Estimate ratio, power, load sharing, safety and resonances.

    Parameters
    ----------
    draft : Draft
        The machine.
    bearings : Bearings
        Radial stiffness, N/m.
    split : Split
        How it shares its load.
    mesh_torque : float
        Torque on a pinion of the hardest loaded mesh, N m.

    Returns
    -------
    iterator of str
        A line each, with units.
    """
    wishes = draft.wishes
    ratio = wishes.face_gear_teeth / wishes.pinion_teeth
    power = wishes.pinions * wishes.torque_n_m * wishes.speed_rpm * pi / 30e3
    yield (
        f"ratio {_text(ratio)}, {_text(power)} kW from {count_noun(wishes.pinions, 'input')}, "
        f"mesh frequency {_text(wishes.pinion_teeth * wishes.speed_rpm / 60)} Hz, "
        f"contact ratio {draft.teeth.analysis.contact_ratio:.3g}"
    )
    if wishes.idlers:
        low, high = split.idlers
        # A single idler shares its load with none.
        idlers = f", {low:.3g} to {high:.3g} of idlers" if np.isfinite(low) else ""
        yield (
            f"K_gamma {split.inputs:.3g} of inputs{idlers}; largest load of a "
            f"path over the mean of its group {split.group_ratio:.3g} (estimated with the errors written)"
        )
        if split.excess > 1.0:
            yield _poor_split(draft, bearings)
    bending, pitting = _safeties(draft, mesh_torque)
    yield (
        f"safety of the pinion against bending {bending:.3g}, against pitting {pitting:.3g} at "
        f"{_text(mesh_torque)} N m a mesh (standard for cylindrical gears, crowning of the flanks, "
        "endurance limit)"
    )
    yield _resonances(draft, bearings)


def _poor_split(draft: Draft, bearings: Bearings) -> str:
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


def _safeties(draft: Draft, mesh_torque: float) -> tuple[float, float]:
    design, ratio = draft.teeth.design, draft.teeth.analysis.contact_ratio
    values = draft.values_of_config["strength"]
    request = rating_request(parse(Strength, values), design)
    form = pinion_form(design, ratio)
    permissible = permissible_bending(design, request.bodies["pinion"], form.notch_parameter, 0.0)
    pitting, _ = request.bodies["pinion"].limits()
    stress = hertz_stress(design, ratio, request)["pinion"](mesh_torque)
    stress *= sqrt(load_concentration(design, mesh_torque))
    return permissible / standard_bending(design, form)(mesh_torque), pitting.limit / stress


def load_concentration(design: PairDesign, mesh_torque: float) -> float:
    """Estimate the largest line load of a pair over its mean along the face.

    A shaper with more teeth than the pinion crowns the flanks against each other: beside the path of contact
    they part by half the smaller relative curvature times the distance squared. The face carries the load as
    independent strips with the mesh stiffness of the standard.

    Parameters
    ----------
    design : PairDesign
        The pair.
    mesh_torque : float
        Torque on the pinion, N m, that one pair of teeth carries.

    Returns
    -------
    float
        Dimensionless; 1 for flanks without crowning.
    """
    gear, path = design.face_gear, 0.5 * design.module * design.face_gear.teeth
    inner, outer = gear.inner_radius - path, gear.outer_radius - path
    roll, _, curvatures, _ = path_curvatures(design)
    curvature = float(curvatures[np.abs(roll - tan(design.pressure_angle)).argmin()])
    if curvature <= 0.0:
        return 1.0
    approach_of_force = mesh_torque / design.pinion_base_radius / STIFFNESS
    nearest = min(max(0.0, inner), outer)
    first_touch = 0.5 * curvature * nearest**2

    def excess(approach: float) -> float:
        reach = sqrt(2.0 * approach / curvature)
        start, end = max(inner, -reach), min(outer, reach)
        return approach * (end - start) - curvature * (end**3 - start**3) / 6.0 - approach_of_force

    whole_face = approach_of_force / (outer - inner) + 0.5 * curvature * max(inner**2, outer**2)
    approach = brentq(excess, first_touch, whole_face)
    return float((approach - first_touch) * (outer - inner) / approach_of_force)


def _resonances(draft: Draft, bearings: Bearings) -> str:
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
    return format_number(number, 4, group_digits=False)
