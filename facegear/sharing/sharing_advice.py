"""Advice on load sharing: what each change of a machine would buy, in closed form and by statics.

References
----------
Singh 2010 for idlers; docs/explanation/theory.md for the loop through inputs and idlers.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.machine.layout import Role
from facegear.machine.machine import Machine
from facegear.number_format import format_number
from facegear.sharing.groups import GroupKind, LoadGroup, MapOptions, split_groups
from facegear.sharing.ideal_machine import IDLERS, predicted_factor
from facegear.sharing.mapped_machine import MappedMachine, groups_of_kind
from facegear.sharing.path_changes import floated, judged_factor, with_scaled_backlash, with_scaled_bearings
from facegear.sharing.sharing_map import AS_GIVEN, FLOATING, floating_machine

SOFTER, STIFFER = 0.5, 2.0
"""Factors of a change that is tried, as a designer may reach them by another bearing or tolerance."""
ADVICE_COLUMNS = (
    *("group", "kind", "change", "from_to", "k_gamma", "found", "gain", "predicted_gain"),
    *("worst", "worst_found"),
)
"""Columns of the table of advice."""


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


def _is_loaded(mapped: MappedMachine, group: LoadGroup) -> bool:
    """Tell whether a group carries a load (without drawn errors) and all its meshes have a nominal even
    share.
    """
    return bool(np.isfinite(mapped.even(group)).all()) and mapped.load(group) > 0.0


def _changes(machine: Machine, options: MapOptions) -> Iterator[Change]:
    """Yield the changes of the machine to try, each with its words, the changed machine and tolerances.

    Bearings of inputs or idlers softer (SOFTER) and stiffer (STIFFER), face gears that float, half the
    backlash, and half of each deviation of the idlers; those that do not apply are left out.
    """
    mapped = MappedMachine(machine)
    idlers, inputs = groups_of_kind(machine, GroupKind.IDLERS), groups_of_kind(machine, GroupKind.INPUTS)
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
    if (half := float(machine.half_backlash.mean())) > 0.0:
        new_machine = MappedMachine(with_scaled_backlash(machine, SOFTER))
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
