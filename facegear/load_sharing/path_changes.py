"""Machines that differ in what decides their load sharing: bearings, floating gears, backlash."""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from facegear.transmission.elastic_gears import ElasticGears
from facegear.transmission.layout import Layout, Role, Side
from facegear.transmission.machine import Machine

FREE = 0.1
"""Radial stiffness of the bearing of a face gear that floats, N/m: nothing beside meshes of 1e8 N/m, and
enough to place a gear that no mesh holds.
"""


def floated(machine: Machine, sides: Collection[Side]) -> Machine:
    """Let face gears move freely in their planes.

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
        On the radial stiffness, dimensionless.

    Returns
    -------
    Machine
        With these bearings; clearance and axial stiffness stay.
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
    if new_machine.drive_line is None:
        return new_machine
    return replace(new_machine, drive_line=new_machine.drive_line.without_shafts(numbers, new_machine.layout))


def with_half_backlash(machine: Machine, half: float) -> Machine:
    """Give every mesh the same backlash.

    Parameters
    ----------
    machine : Machine
        With backlash as it is.
    half : float
        Half the backlash from flank to flank, m.

    Returns
    -------
    Machine
        With this backlash.
    """
    return replace(machine, half_backlash=np.full(len(machine.layout.meshes), half))


def with_scaled_backlash(machine: Machine, factor: float) -> Machine:
    """Scale the backlash of every mesh, so that meshes that differ keep their proportion.

    Parameters
    ----------
    machine : Machine
        With backlash as it is.
    factor : float
        On the backlash, dimensionless.

    Returns
    -------
    Machine
        With this backlash.
    """
    return replace(machine, half_backlash=factor * machine.half_backlash)


def _with_layout(machine: Machine, layout: Layout) -> Machine:
    """The machine with the same bodies on other bearings."""
    line, bodies = machine.drive_line, machine.bodies
    return replace(
        machine,
        layout=layout,
        drive_line=line and replace(line, layout=layout),
        bodies=replace(bodies, layout=layout) if isinstance(bodies, ElasticGears) else bodies,
    )
