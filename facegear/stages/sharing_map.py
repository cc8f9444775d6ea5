"""Map of load sharing, the machine's place on it, and what changes of the machine would buy."""

from collections.abc import Sequence
from math import isclose

import pandas as pd

from facegear.config.machines import MachineInputs
from facegear.config.sharing_map import SharingMap, map_options
from facegear.config.transmission import Transmission
from facegear.load_sharing.groups import GroupKind
from facegear.load_sharing.ideal_machine import departures
from facegear.load_sharing.sharing_advice import advice
from facegear.load_sharing.sharing_map import idler_curves, input_curves, map_points
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine

BEYOND = 1.2
"""Largest number on the curves over the largest of the machine's own."""
SHORTEST = 0.1
"""Largest number on the curves where the machine's own are smaller still."""


def sharing_map(
    inputs: MachineInputs,
    sharing_map: SharingMap | None,
    torques: Sequence[float],
) -> Outcome:
    """Compute the map of load sharing of the machine at rest.

    Parameters
    ----------
    inputs : MachineInputs
        Inputs of a machine with geometric meshes and two face gears.
    sharing_map : SharingMap or None
        Deviations and points; None for their defaults.
    torques : sequence of float
        Torques of an input in each of its meshes that the duty cycle has, N m; none without one.

    Returns
    -------
    Outcome
        Tables `curves`, `inputs`, `points`, `advice`, `reasons`. Raises NotConverged.
    """
    section, transmission = sharing_map or SharingMap(), inputs.transmission
    options, nominal = map_options(section), inputs.build()
    machines = {_torque(transmission, nominal): nominal}
    if transmission.torque.per_input_n_m != 0.0:
        for torque in torques:
            whole = torque * len(transmission.face_gears)
            if not any(isclose(whole, mapped) for mapped in machines):
                machines[whole] = inputs.at_torque(torque).build()
    points = map_points(sorted(machines.items()), options)
    largest = {
        kind: section.largest_number or max(BEYOND * _largest(points, kind), SHORTEST)
        for kind in (GroupKind.IDLERS, GroupKind.INPUTS)
    }
    content = {
        "curves": idler_curves(nominal, options, largest[GroupKind.IDLERS]),
        "inputs": input_curves(nominal, options, largest[GroupKind.INPUTS]),
        "points": points,
        "advice": (advice_table := advice(nominal, options)),
        "reasons": pd.DataFrame({"reason": departures(nominal)}, dtype=str),
    }
    return Outcome(content, _summary(advice_table))


def _torque(transmission: Transmission, machine: Machine) -> float:
    """Torque of an input, or of the first face gear of a machine without inputs, N m."""
    torque = abs(transmission.torque.per_input_n_m)
    return torque or float(abs(machine.torques[len(machine.layout.pinions)]))


def _largest(points: pd.DataFrame, kind: GroupKind) -> float:
    return (
        float(points.loc[points["kind"] == kind.value, "number"].max())
        if kind.value in set(points["kind"])
        else 0.0
    )


def _summary(advice_table: pd.DataFrame) -> str:
    if advice_table.empty:
        return "no group carries a load to share"
    row = advice_table.loc[advice_table["worst_found"].idxmin()]
    before, after = row["worst"], row["worst_found"]
    if after >= before:
        return f"largest K_gamma {before:.3f}, which no change that was tried lowers"
    return f"largest K_gamma {before:.3f}, {after:.3f} by this change: {row['change']} ({row['from_to']})"
