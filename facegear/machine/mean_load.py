"""Tangents of rolling bearings at the mean load of their machine, for modes and motion."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from facegear.arrays import Array
from facegear.bearings.shaft import RollingShaft, ShaftState, follow_pinion
from facegear.machine.casing_coordinates import casing_motion
from facegear.machine.drive_line import DriveLine
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.flanks import NO_LOAD
from facegear.machine.layout import Layout
from facegear.machine.machine import Machine
from facegear.machine.rolling_seats import body_on_tangent, rolling_seat
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import mean_equilibrium
from facegear.machine.supports import has_rolling_bearings
from facegear.rigid_body import MOTIONS


def at_mean_load(machine: Machine) -> Machine:
    """Return the machine with its rolling bearings linearised at the equilibrium under its mean torques.

    Parameters
    ----------
    machine : Machine
        With rolling bearings linearised anywhere, or without any.

    Returns
    -------
    Machine
        The same object where it has no rolling bearings.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    if not has_rolling_bearings(machine.drive_line):
        return machine
    assert machine.drive_line is not None
    at = mean_equilibrium(at_rest(machine))
    states = {}
    for pinion, loads in at.shafts.items():
        shaft = machine.drive_line.seats[pinion].rolling
        assert shaft is not None
        size = max(1.0, float(at.flank_forces.max()), float(np.abs(machine.forces).max()))
        is_loose = float(np.abs(loads.forces).max()) <= NO_LOAD * size
        seats = np.zeros((len(shaft.supports), MOTIONS))
        if machine.casing is not None and any(machine.casing.bearing_seats.get(pinion, ())):
            rest = machine.casing.without_modes()
            motion = casing_motion(at_rest(machine).linear, at.displacements[0])
            seats = (rest.ring_motions(pinion) @ motion).reshape(seats.shape)
        states[pinion] = _state(shaft, loads.pinion[0], seats, is_loose)
    return with_states(machine, states)


def _state(shaft: RollingShaft, pinion: Array, seats: Array, is_loose: bool) -> ShaftState:
    """Return the state of a shaft where its pinion's middle moves by (5,), and its seats by (bearings, 5), m
    and rad.

    A shaft that is loose in its clearances may stand anywhere in them, also where it just touches and
    rounding decides its stiffness: it is taken where it was assembled if it carries nothing there.
    """
    if is_loose:
        at_assembly = follow_pinion(shaft, np.zeros(MOTIONS), np.zeros_like(seats))
        if not at_assembly.forces.any():
            return at_assembly
    return follow_pinion(shaft, pinion, seats)


def with_states(machine: Machine, states: Mapping[int, ShaftState]) -> Machine:
    """Return the machine with rolling bearings linearised at given states.

    Parameters
    ----------
    machine : Machine
        The machine.
    states : mapping of int to ShaftState
        States of the shafts by the numbers of their pinions.

    Returns
    -------
    Machine
        With the tangents in its layout, drive line and gears that bend.
    """
    line = machine.drive_line
    assert line is not None
    pinions, seats = list(machine.layout.pinions), dict(line.seats)
    for number, state in states.items():
        pinions[number] = replace(pinions[number], body=body_on_tangent(pinions[number].body, state))
        rolling = line.seats[number].rolling
        assert rolling is not None
        seats[number] = rolling_seat(rolling, state, line.seats[number].tilt_inertia)
    return _in_layout(machine, replace(machine.layout, pinions=tuple(pinions)), replace(line, seats=seats))


def _in_layout(machine: Machine, layout: Layout, line: DriveLine) -> Machine:
    """Return the machine with another layout and drive line, the layout set in line and elastic gears."""
    bodies = machine.bodies
    return replace(
        machine,
        layout=layout,
        drive_line=replace(line, layout=layout),
        bodies=replace(bodies, layout=layout) if isinstance(bodies, ElasticGears) else bodies,
    )
