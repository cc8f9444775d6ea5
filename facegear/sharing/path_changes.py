"""Machines that differ in what decides their load sharing, and drawn deviations of their paths."""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from facegear.arrays import Array
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.layout import Layout, Role, Side
from facegear.machine.machine import Machine
from facegear.machine.rolling_seats import scaled_seat
from facegear.sharing.groups import GroupKind, LoadGroup, MapOptions
from facegear.sharing.mapped_machine import MappedMachine

LEVELS = (50.0, 95.0, 99.0)
"""Percentiles of K_gamma in tables, %."""
JUDGED_LEVEL = 95.0
"""Percentile that advice is about, %."""


def draws(group: LoadGroup, options: MapOptions) -> Array:
    """Draw the lateness of the paths of a group from a standard normal distribution.

    Parameters
    ----------
    group : LoadGroup
        Idlers; only the number of their meshes counts.
    options : MapOptions
        Number of samples and seed, so that equal options give equal draws.

    Returns
    -------
    (samples, paths) array
        Independent lateness over its standard deviation, dimensionless.
    """
    random = np.random.default_rng(options.seed)
    return random.standard_normal((options.samples, len(group.meshes)))


def group_levels(
    mapped: MappedMachine, group: LoadGroup, deviation: float, options: MapOptions
) -> tuple[float, ...]:
    """Compute percentiles of K_gamma of a group over drawn errors, each sample by static equilibrium.

    Parameters
    ----------
    mapped : MappedMachine
        The machine.
    group : LoadGroup
        Meshes of an input, or idlers. Only idlers' paths get drawn errors.
    deviation : float
        Standard deviation of the lateness of a path, m along the line of action.
    options : MapOptions
        Number of samples and seed.

    Returns
    -------
    tuple of float
        Percentiles LEVELS (50, 95, 99 %) of the hardest loaded mesh, dimensionless; an input's one value is
        repeated. Raises NotConverged.
    """
    if group.kind is GroupKind.INPUTS:
        return (mapped.factor(group),) * len(LEVELS)
    forces = mapped.idler_forces(group, deviation * draws(group, options))
    return levels((forces / mapped.even(group)).max(axis=1))


def levels(factors: Array) -> tuple[float, ...]:
    """Return the percentiles LEVELS (50, 95, 99 %) of drawn values.

    Parameters
    ----------
    factors : (samples,) array
        Values in any unit.

    Returns
    -------
    tuple of float
        Three percentiles in the same unit.
    """
    return tuple(float(value) for value in np.percentile(factors, LEVELS))


def judged_factor(mapped: MappedMachine, group: LoadGroup, options: MapOptions) -> float:
    """Compute the K_gamma of a group, by statics, that advice compares before and after a change.

    Parameters
    ----------
    mapped : MappedMachine
        The machine.
    group : LoadGroup
        Meshes of an input, or idlers.
    options : MapOptions
        Deviations, number of samples and seed.

    Returns
    -------
    float
        For idlers the percentile JUDGED_LEVEL (95 %) over drawn errors, for an input its value without
        them; dimensionless. Raises NotConverged.
    """
    return group_levels(mapped, group, mapped.deviation(group, options), options)[LEVELS.index(JUDGED_LEVEL)]


FREE = 0.1
"""Radial stiffness of the bearing of a face gear that floats, N/m: nothing beside meshes of 1e8 N/m, and
enough to place a gear that no mesh holds.
"""


def floated(machine: Machine, sides: Collection[Side]) -> Machine:
    """Return a machine whose face gears move freely in their planes.

    Parameters
    ----------
    machine : Machine
        With bearings as they are.
    sides : collection of Side
        The gears that float.

    Returns
    -------
    Machine
        With radial bearing stiffness FREE there; along the axis and in tilt the gears are held as before.
    """
    gears = tuple(
        replace(gear, body=replace(gear.body, bearing=(FREE, FREE, gear.body.bearing[2]), bearing_xy=0.0))
        if gear.side in sides
        else gear
        for gear in machine.layout.gears
    )
    return _with_layout(machine, replace(machine.layout, gears=gears))


def with_scaled_bearings(machine: Machine, roles: Collection[Role], factor: float) -> Machine:
    """Scale the radial stiffness of the bearings of pinions.

    Parameters
    ----------
    machine : Machine
        With bearings as they are; a shaft counts by what it leaves of a bearing at rest.
    roles : collection of Role
        Pinions whose bearings change.
    factor : float
        On the radial stiffness, dimensionless; on all stiffness of shafts with rolling bearings.

    Returns
    -------
    Machine
        With these bearings; clearance and axial stiffness of springs stay.
    """
    if factor == 1.0:
        return machine
    numbers = {i for i, pinion in enumerate(machine.layout.pinions) if pinion.role in roles}
    pinions = list(machine.layout.pinions)
    for i in numbers:
        body = pinions[i].body
        x, y, z = body.bearing
        softer = replace(body, bearing=(factor * x, factor * y, z), bearing_xy=factor * body.bearing_xy)
        pinions[i] = replace(pinions[i], body=softer)
    new_machine = _with_layout(machine, replace(machine.layout, pinions=tuple(pinions)))
    line = new_machine.drive_line
    if line is None:
        return new_machine
    rolling = {i: seat for i, seat in line.seats.items() if i in numbers and seat.rolling is not None}
    springs = line.without_shafts(numbers, new_machine.layout)
    scaled_seats = {i: scaled_seat(seat, factor) for i, seat in rolling.items()}
    return replace(new_machine, drive_line=replace(springs, seats={**springs.seats, **scaled_seats}))


def with_half_backlash(machine: Machine, half: float) -> Machine:
    """Return a machine with the same half backlash at every mesh, whatever it was.

    Parameters
    ----------
    machine : Machine
        Its half backlashes are replaced.
    half : float
        Half the normal backlash from flank to flank, m.

    Returns
    -------
    Machine
        A changed copy.
    """
    return replace(machine, half_backlash=np.full(len(machine.layout.meshes), half))


def with_scaled_backlash(machine: Machine, factor: float) -> Machine:
    """Scale the backlash of every mesh, so that meshes that differ keep their proportion.

    Parameters
    ----------
    machine : Machine
        Its half backlashes are multiplied.
    factor : float
        Factor on the backlash, dimensionless.

    Returns
    -------
    Machine
        A changed copy.
    """
    return replace(machine, half_backlash=factor * machine.half_backlash)


def _with_layout(machine: Machine, layout: Layout) -> Machine:
    """Return the machine with another layout (other bearings), set in its drive line and elastic gears,
    too.
    """
    line, bodies = machine.drive_line, machine.bodies
    return replace(
        machine,
        layout=layout,
        drive_line=line and replace(line, layout=layout),
        bodies=replace(bodies, layout=layout) if isinstance(bodies, ElasticGears) else bodies,
    )
