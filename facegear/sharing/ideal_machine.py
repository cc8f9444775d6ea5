"""The closed forms for a machine that is not ideal: what they predict, and why they may not hold.

References
----------
Singh 2010 for idlers; docs/explanation/theory.md for the loop through inputs and idlers.
"""

import numpy as np

from facegear.arrays import Array
from facegear.machine.flank_errors import constant_errors
from facegear.machine.layout import Role
from facegear.machine.machine import Machine
from facegear.sharing.closed_form import SplitMachine, k_gamma_samples
from facegear.sharing.groups import GroupKind, LoadGroup, MapOptions
from facegear.sharing.mapped_machine import MappedMachine, groups_of_kind
from facegear.sharing.path_changes import JUDGED_LEVEL, draws

TOLERANCE = 1e-6
"""Relative difference of stiffnesses, angles or radii below which they count as equal."""
IDLERS = (Role.IDLER, Role.TAIL)
"""Roles of the pinions that pass power from one gear to the other."""


def loop_factor(mapped: MappedMachine, group: LoadGroup) -> float:
    """Compute K_gamma of an input by the loop formula (`SplitMachine.input_k_gamma`), without errors.

    Parameters
    ----------
    mapped : MappedMachine
        The machine; its mean stiffnesses, loads and backlash are put into the formula.
    group : LoadGroup
        Meshes of an input.

    Returns
    -------
    float
        Mesh load factor of the harder loaded mesh, dimensionless; nan without idlers or loaded meshes.
    """
    form = split_machine(mapped, group)
    idlers = groups_of_kind(mapped.machine, GroupKind.IDLERS)
    if form is None or not idlers:
        return float("nan")
    return form.input_k_gamma(mapped.bearing(group), mapped.bearing(idlers[0]))


def split_machine(mapped: MappedMachine, group: LoadGroup) -> SplitMachine | None:
    """Return the ideal machine of equal inputs and idlers that is nearest to this one.

    Its mesh stiffness, input force and backlash are the means of the group's meshes.

    Parameters
    ----------
    mapped : MappedMachine
        The machine.
    group : LoadGroup
        Meshes of an input.

    Returns
    -------
    SplitMachine or None
        None without idlers, without inputs, or where no mesh of the group's pinion is loaded.
    """
    layout, idlers = mapped.machine.layout, groups_of_kind(mapped.machine, GroupKind.IDLERS)
    inputs = sum(pinion.role is Role.INPUT for pinion in layout.pinions)
    spring = mapped.group_spring(group)
    if not idlers or not inputs or not np.isfinite(spring):
        return None
    path = mapped.path_wrenches(idlers[0])
    return SplitMachine(
        inputs,
        len(idlers[0].meshes),
        mapped.load(group),
        spring,
        mapped.backlash(group),
        mapped.idler_push(idlers[0]) / path.arm,
        mapped.input_push(group),
        path.meshes / path.arm**2,
    )


def predicted_factor(
    mapped: MappedMachine, group: LoadGroup, options: MapOptions, freedom: float | None = None
) -> float:
    """Predict K_gamma of a group from the closed forms alone.

    Parameters
    ----------
    mapped : MappedMachine
        Its stiffnesses, backlash and torques count; nothing of its statics but the stiffness of its meshes
        and, for an input, its load.
    group : LoadGroup
        Meshes of an input, or idlers.
    options : MapOptions
        Deviations of the errors, number of samples and seed.
    freedom : float or None
        `plane_freedom` (0..1) to use instead of that of the gears' bearings; None: that of the bearings.

    Returns
    -------
    float
        Dimensionless: the loop formula for an input, the percentile JUDGED_LEVEL for idlers; nan where
        there is no closed form, as for a gear that floats while inputs guide it.
    """
    if freedom is not None and groups_of_kind(mapped.machine, GroupKind.INPUTS):
        return float("nan")
    if group.kind is GroupKind.INPUTS:
        return loop_factor(mapped, group)
    even = float(mapped.even(group).sum())
    load = _closed_load(mapped, group, even)
    deviation = mapped.deviation(group, options)
    number = mapped.path_stiffness(group) * deviation / load if load > 0.0 else np.nan
    free = mapped.freedom(group) if freedom is None else freedom
    samples = k_gamma_samples(number, draws(group, options), free)
    return load / even * float(np.percentile(samples, JUDGED_LEVEL))


def _closed_load(mapped: MappedMachine, group: LoadGroup, even: float) -> float:
    """Return the load of all idlers together by the loop formula, N; `even`, their nominal load (N),
    without inputs.
    """
    inputs = groups_of_kind(mapped.machine, GroupKind.INPUTS)
    form = split_machine(mapped, inputs[0]) if inputs else None
    if form is None:
        return even
    alone = form.idler_force(mapped.bearing(inputs[0]), mapped.bearing(group))
    return len(group.meshes) * alone / mapped.path_wrenches(group).arm


def departures(machine: Machine) -> list[str]:
    """List in words why the closed form of idlers may not hold for a machine.

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
    stiffness = machine.mean_flank_stiffness[2 * [i in pinions for i, _ in layout.meshes]]
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
    """Return (largest - smallest value) over the largest magnitude, dimensionless; 0 for no values."""
    return float(np.ptp(values) / np.abs(values).max()) if np.size(values) else 0.0
