"""Load-sharing map: mesh load factors over the numbers that decide them, beside the closed form.

Idlers between two face gears share by X = k_e sigma / W: stiffness of a path, standard deviation of its
lateness, load of all paths. Inputs share by 2 b k / W: the backlash of the loop is a misfit between their two
meshes. Each computed value is that of the machine's own statics.

References
----------
Singh 2010 for the curves of idlers; docs/explanation/theory.md for the loop through inputs and idlers.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.machine.layout import Role, Side
from facegear.machine.machine import Machine
from facegear.sharing.closed_form import k_gamma_samples
from facegear.sharing.even_shares import even_shares
from facegear.sharing.groups import GroupKind, LoadGroup, MapOptions, split_groups
from facegear.sharing.ideal_machine import loop_factor
from facegear.sharing.mapped_machine import MappedMachine, groups_of_kind
from facegear.sharing.path_changes import (
    LEVELS,
    draws,
    floated,
    group_levels,
    levels,
    with_half_backlash,
    with_scaled_bearings,
)

AS_GIVEN = "as given"
"""Name of the curve of a machine whose gears float as given."""
FLOATING: dict[str, tuple[Side, ...]] = {
    AS_GIVEN: (),
    "upper": (Side.UPPER,),
    "lower": (Side.LOWER,),
    "both": (Side.LOWER, Side.UPPER),
}
"""Face gears that float on each curve of the idlers."""
WANDERS = 1e-3
"""Way of a floating gear in its plane, m, beyond which its meshes do not hold it: far more than backlash."""
PERCENT_COLUMNS = tuple(f"k_gamma_p{level:g}" for level in LEVELS)
"""Columns of percentiles of K_gamma."""
CLOSED_COLUMNS = tuple(f"closed_p{level:g}" for level in LEVELS)
"""Columns of percentiles of the closed form."""
CURVE_COLUMNS = ("group", "floating", "number", "all_carry", *PERCENT_COLUMNS, *CLOSED_COLUMNS)
"""Columns of the curves of idlers."""
INPUT_COLUMNS = ("group", "bearing_factor", "bearing_n_per_m", "number", "k_gamma", "closed")
"""Columns of the curves of inputs."""
POINT_COLUMNS = ("torque_n_m", "group", "kind", "load_n", "number", *PERCENT_COLUMNS)
"""Columns of the machine's points."""


def floating_machine(machine: Machine, group: LoadGroup, floating: str) -> MappedMachine | None:
    """Let face gears float in their planes; None where the meshes do not hold them there.

    Parameters
    ----------
    machine : Machine
        As it is given.
    group : LoadGroup
        Meshes that must still carry load.
    floating : str
        A key of FLOATING: "as given" (bearings as they are), "upper", "lower" or "both".

    Returns
    -------
    MappedMachine or None
        The machine with nearly no radial bearing stiffness (`path_changes.FREE`) of these gears. None
        where one moves by WANDERS or more, or the group is unloaded.
    """
    mapped = MappedMachine(floated(machine, FLOATING[floating]))
    if not FLOATING[floating]:
        return mapped
    layout, displacements = machine.layout, mapped.base.displacements[0]
    first = 4 * len(layout.pinions)
    ways = [np.hypot(*displacements[first + 4 * g : first + 4 * g + 2]) for g in range(len(layout.gears))]
    return mapped if max(ways) < WANDERS and mapped.load(group) > 0.0 else None


def idler_curves(machine: Machine, options: MapOptions, largest: float) -> pd.DataFrame:
    """Tabulate K_gamma of idlers over X = k_e sigma / W, by statics and closed form, for each way of
    floating the gears.

    The same drawn errors, scaled, serve all points.

    Parameters
    ----------
    machine : Machine
        With geometric meshes and two face gears.
    options : MapOptions
        Number of samples and of points, and seed.
    largest : float
        Largest X, dimensionless; the points are spread evenly from 0.

    Returns
    -------
    pd.DataFrame
        One row a group, floating gear and X, columns CURVE_COLUMNS: all_carry is the fraction of samples
        in which every path carries; k_gamma_p* are percentiles by statics, closed_p* those of the closed
        form, for the load that the group carries. Raises NotConverged.
    """
    rows: list[tuple[object, ...]] = []
    for group in groups_of_kind(machine, GroupKind.IDLERS):
        errors = draws(group, options)
        for floating in FLOATING:
            mapped = floating_machine(machine, group, floating)
            if mapped is None or not np.isfinite(mapped.even(group)).all() or mapped.load(group) <= 0.0:
                continue
            load, stiffness = mapped.load(group), mapped.path_stiffness(group)
            freedom = mapped.freedom(group) if floating == AS_GIVEN else 1.0
            carried_part = load / float(mapped.even(group).sum())
            for number in np.linspace(0.0, largest, options.points).tolist():
                forces = mapped.idler_forces(group, number * load / stiffness * errors)
                factors = (forces / mapped.even(group)).max(axis=1)
                exact = carried_part * k_gamma_samples(number, errors, freedom)
                all_carry = float((forces > 0.0).all(axis=1).mean())
                rows.append((group.name, floating, number, all_carry, *levels(factors), *levels(exact)))
    return pd.DataFrame(rows, columns=list(CURVE_COLUMNS))


def input_curves(machine: Machine, options: MapOptions, largest: float) -> pd.DataFrame:
    """Tabulate K_gamma of inputs over 2 b k / W (backlash times mesh stiffness over load), for some
    bearing stiffnesses.

    Parameters
    ----------
    machine : Machine
        With geometric meshes and two face gears.
    options : MapOptions
        Number of points, and factors on the stiffness of the inputs' bearings.
    largest : float
        Largest 2 b k / W, dimensionless; the points are spread evenly from 0 and reached by the backlash.

    Returns
    -------
    pd.DataFrame
        One row a factor, point and input, columns INPUT_COLUMNS; k_gamma is by statics, closed by the
        loop formula, nan without idlers. Raises NotConverged.
    """
    rows: list[tuple[object, ...]] = []
    groups = [
        group
        for group in groups_of_kind(machine, GroupKind.INPUTS)
        if np.isfinite(even_shares(machine)[group.meshes[0]])
    ]
    for factor in options.bearing_factors:
        base_machine = MappedMachine(with_scaled_bearings(machine, (Role.INPUT,), factor))
        for number in np.linspace(0.0, largest, options.points).tolist():
            for group in groups:
                load, spring = base_machine.load(group), base_machine.group_spring(group)
                if not np.isfinite(spring):
                    continue
                half = 0.5 * number * load / spring
                mapped = MappedMachine(with_half_backlash(base_machine.machine, half))
                key = (group.name, factor, base_machine.bearing(group), number)
                rows.append((*key, mapped.factor(group), loop_factor(mapped, group)))
    return pd.DataFrame(rows, columns=list(INPUT_COLUMNS))


def map_points(machines: Sequence[tuple[float, Machine]], options: MapOptions) -> pd.DataFrame:
    """Place the machine on the load-sharing map at each of its torques: its number and its K_gamma by
    statics.

    Parameters
    ----------
    machines : sequence of (float, Machine)
        Torque of an input, N m, and the machine under it.
    options : MapOptions
        Deviations of the errors, number of samples and seed.

    Returns
    -------
    pd.DataFrame
        One row a torque and group that is loaded, columns POINT_COLUMNS; an input has one value in all
        percentiles. Raises NotConverged.
    """
    rows: list[tuple[object, ...]] = []
    for torque, machine in machines:
        mapped = MappedMachine(machine)
        for group in split_groups(machine.layout):
            deviation = mapped.deviation(group, options)
            number = mapped.number(group, deviation)
            if not np.isfinite(number) or not np.isfinite(mapped.even(group)).all():
                continue
            factors = group_levels(mapped, group, deviation, options)
            rows.append((torque, group.name, group.kind.value, mapped.load(group), number, *factors))
    return pd.DataFrame(rows, columns=list(POINT_COLUMNS))
