"""Advice on load sharing: what each change of a machine would buy, in closed form and by statics.

References
----------
Singh 2010 for idlers; docs/explanation/theory.md for the loop through inputs and idlers.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.load_sharing.closed_form import k_gamma_samples
from facegear.load_sharing.groups import GroupKind, LoadGroup, split_groups
from facegear.load_sharing.path_changes import floated, with_half_backlash, with_scaled_bearings
from facegear.load_sharing.sharing_map import (
    AS_GIVEN,
    FLOATING,
    JUDGED_LEVEL,
    LEVELS,
    MapOptions,
    MappedMachine,
    draws,
    floating_machine,
    group_levels,
    idler_groups,
    input_groups,
    loop_factor,
    split_machine,
)
from facegear.number_format import format_number
from facegear.transmission.flanks import constant_errors
from facegear.transmission.layout import Role
from facegear.transmission.machine import Machine

SOFTER, STIFFER = 0.5, 2.0
"""Factors of a change that is tried, as a designer may reach them by another bearing or tolerance."""
TOLERANCE = 1e-6
"""Relative difference of stiffnesses, angles or radii below which they count as equal."""
ADVICE_COLUMNS = (
    *("group", "kind", "change", "from_to", "k_gamma", "found", "gain", "predicted_gain"),
    *("worst", "worst_found"),
)
IDLERS = (Role.IDLER, Role.TAIL)


@dataclass(frozen=True, eq=False)
class Change:
    """One change of a machine.

    Attributes
    ----------
    words : str
        What to do, in the imperative.
    from_to : str
        The quantity before and after, with its unit.
    machine : MappedMachine
        The changed machine.
    options : MapOptions
        The changed tolerances.
    freedom : float or None
        `plane_freedom` of the closed form where the change sets it; None: that of the bearings.
    """

    words: str
    from_to: str
    machine: MappedMachine
    options: MapOptions
    freedom: float | None = None


def advice(machine: Machine, options: MapOptions) -> pd.DataFrame:
    """Try changes of bearings, floating gears and tolerances, each by the statics of the changed machine.

    Parameters
    ----------
    machine : Machine
        Under the torque that the advice is for.
    options : MapOptions
        Deviations and samples.

    Returns
    -------
    pd.DataFrame
        ADVICE_COLUMNS, one row a change and group, the largest gain of each group first. k_gamma and found
        are the percentile JUDGED_LEVEL of idlers, or the value of an input, before and after, gain their
        difference; predicted_gain is that of the closed forms alone, nan where there is none. worst and
        worst_found: the largest of all groups before and after, by which the machine as a whole is judged.
        Raises NotConverged.
    """
    mapped, rows = MappedMachine(machine), []
    groups = [group for group in split_groups(machine.layout) if _is_loaded(mapped, group)]
    before = {group.name: judged_factor(mapped, group, options) for group in groups}
    closed_before = {group.name: predicted_factor(mapped, group, options) for group in groups}
    for change in _changes(machine, options):
        after = {group.name: judged_factor(change.machine, group, change.options) for group in groups}
        for group in groups:
            closed_after = predicted_factor(change.machine, group, change.options, change.freedom)
            now, factor_after = before[group.name], after[group.name]
            key = (group.name, group.kind.value, change.words, change.from_to)
            worst = max(before.values()), max(after.values())
            gains = now - factor_after, closed_before[group.name] - closed_after
            rows.append((*key, now, factor_after, *gains, *worst))
    table = pd.DataFrame(rows, columns=list(ADVICE_COLUMNS))
    order = {group.name: number for number, group in enumerate(groups)}
    return table.sort_values(
        ["group", "gain"],
        key=lambda values: values.map(order) if values.name == "group" else -values,
        kind="stable",
        ignore_index=True,
    )


def judged_factor(mapped: MappedMachine, group: LoadGroup, options: MapOptions) -> float:
    """Return K_gamma of a group by statics, as advice judges it.

    Parameters
    ----------
    mapped : MappedMachine
        The machine.
    group : LoadGroup
        Meshes of an input, or idlers.
    options : MapOptions
        Deviations and samples.

    Returns
    -------
    float
        The percentile JUDGED_LEVEL of idlers, the value of an input; dimensionless. Raises NotConverged.
    """
    deviation = options.deviation(mapped.machine.layout.pressure_angle)
    return group_levels(mapped, group, deviation, options)[LEVELS.index(JUDGED_LEVEL)]


def predicted_factor(
    mapped: MappedMachine, group: LoadGroup, options: MapOptions, freedom: float | None = None
) -> float:
    """Predict K_gamma of a group from the closed forms alone.

    Parameters
    ----------
    mapped : MappedMachine
        Its stiffnesses, backlash and torques count; nothing of its statics but the stiffness of its meshes.
    group : LoadGroup
        Meshes of an input, or idlers.
    options : MapOptions
        Deviations and samples.
    freedom : float or None
        `plane_freedom`, where it is not that of the bearings.

    Returns
    -------
    float
        Dimensionless: the loop formula for an input, the percentile JUDGED_LEVEL for idlers; nan where
        there is no closed form, as for a gear that floats while inputs guide it.
    """
    if freedom is not None and input_groups(mapped.machine):
        return float("nan")
    if group.kind is GroupKind.INPUTS:
        return loop_factor(mapped, group)
    even = float(mapped.even(group).sum())
    load = _closed_load(mapped, group, even)
    angle = mapped.machine.layout.pressure_angle
    number = mapped.path_stiffness(group) * options.deviation(angle) / load if load > 0.0 else np.nan
    free = mapped.freedom(group) if freedom is None else freedom
    samples = k_gamma_samples(number, draws(group, options), free)
    return load / even * float(np.percentile(samples, JUDGED_LEVEL))


def _closed_load(mapped: MappedMachine, group: LoadGroup, even: float) -> float:
    """Load of all idlers by the loop formula, N; their nominal load without inputs."""
    inputs = input_groups(mapped.machine)
    form = split_machine(mapped, inputs[0]) if inputs else None
    if form is None:
        return even
    alone = form.idler_force(mapped.bearing(inputs[0]), mapped.bearing(group))
    return len(group.meshes) * alone


def _is_loaded(mapped: MappedMachine, group: LoadGroup) -> bool:
    return bool(np.isfinite(mapped.even(group)).all()) and mapped.load(group) > 0.0


def _changes(machine: Machine, options: MapOptions) -> Iterator[Change]:
    """Changes of bearings, of floating gears, of tolerances."""
    mapped = MappedMachine(machine)
    idlers, inputs = idler_groups(machine), input_groups(machine)
    for groups, roles, name in ((inputs, (Role.INPUT,), "inputs"), (idlers, IDLERS, "idlers")):
        for factor, verb in ((SOFTER, "halve"), (STIFFER, "double")):
            if groups:
                now = mapped.bearing(groups[0])
                words = f"{verb} the radial stiffness of the bearings of the {name}"
                new_machine = MappedMachine(with_scaled_bearings(machine, roles, factor))
                yield Change(
                    words,
                    f"{format_number(1e-6 * now)} to {format_number(1e-6 * factor * now)} N/um",
                    new_machine,
                    options,
                )
    for floating, sides in FLOATING.items():
        if floating == AS_GIVEN or not idlers or floating_machine(machine, idlers[0], floating) is None:
            continue
        words = "let both face gears float" if len(sides) > 1 else f"let the {floating} face gear float"
        stiffness = min(gear.body.bearing[0] for gear in machine.layout.gears if gear.side in sides)
        floating_gear = MappedMachine(floated(machine, sides))
        from_to = f"{format_number(1e-6 * stiffness)} to 0 N/um in its plane"
        yield Change(words, from_to, floating_gear, options, 1.0)
    if (half := float(machine.half_backlashes.mean())) > 0.0:
        new_machine = MappedMachine(with_half_backlash(machine, SOFTER * half))
        yield Change(
            "halve the backlash of all meshes",
            f"{2e6 * half:.3g} to {1e6 * half:.3g} um",
            new_machine,
            options,
        )
    for now, tighter, words in (
        (
            options.mesh_error,
            replace(options, mesh_error=SOFTER * options.mesh_error),
            "halve the deviations of the idlers' meshes",
        ),
        (
            options.position,
            replace(options, position=SOFTER * options.position),
            "halve the deviations of the idlers' positions",
        ),
    ):
        if idlers and now > 0.0:
            yield Change(words, f"{1e6 * now:.3g} to {1e6 * SOFTER * now:.3g} um", mapped, tighter)


def departures(machine: Machine) -> list[str]:
    """Say why the closed form of idlers may not hold.

    Parameters
    ----------
    machine : Machine
        With geometric meshes and two face gears.

    Returns
    -------
    list of str
        One sentence part for each difference from equal paths; empty for the ideal machine.
    """
    layout, flaws = machine.layout, machine.imperfections
    pinions = [i for i, pinion in enumerate(layout.pinions) if pinion.role in IDLERS]
    stiffness = machine.mean_stiffness[[i in pinions for i, _ in layout.meshes]]
    angles = np.sort(np.mod(layout.angles[pinions], 2.0 * np.pi))
    gaps = np.diff(np.append(angles, angles[:1] + 2.0 * np.pi))
    bearings = np.array([layout.pinions[i].body.bearing[:2] for i in pinions])
    tilts = any(gear.body.tilt is not None for gear in layout.gears) or machine.bodies is not None
    constant = constant_errors(machine)
    checks: tuple[tuple[bool, str], ...] = (
        (bool(np.abs(machine.torques[pinions]).max(initial=0.0) > 0.0), "an idler has a torque of its own"),
        (_spread(gaps) > TOLERANCE, "the idlers stand at uneven angles, which matters where a gear moves"),
        (_spread(stiffness) > TOLERANCE, "the meshes of the idlers differ in stiffness"),
        (not machine.constant_stiffness, "the stiffness of the meshes depends on their load"),
        (_spread(bearings) > TOLERANCE, "the bearings of the idlers differ"),
        (bool(flaws.bearing_clearance.any()), "bearings have clearance"),
        (len(pinions) < len(layout.pinions), "inputs guide a gear that moves, and close the loop"),
        (tilts, "face gears tilt or bend"),
        (bool(np.abs(constant).max(initial=0.0) > 0.0), "single parts have errors of their own"),
    )
    return [words for applies, words in checks if applies]


def _spread(values: Array) -> float:
    """Relative difference of the largest and the smallest."""
    return float(np.ptp(values) / np.abs(values).max()) if np.size(values) else 0.0
