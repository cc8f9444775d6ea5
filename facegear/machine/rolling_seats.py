"""Seats and bodies of pinions on shafts with rolling bearings, by the tangent of the shaft."""

from dataclasses import replace

import numpy as np

from facegear.bearings.shaft import RollingShaft, ShaftState
from facegear.machine.drive_line import Seat
from facegear.machine.layout import Body
from facegear.machine.supports import condensed_state, outer_tangent


def rolling_seat(shaft: RollingShaft, state: ShaftState, tilt_inertia: float | None) -> Seat:
    """Return the seat of a pinion on a shaft with rolling bearings.

    Parameters
    ----------
    shaft : RollingShaft
        The shaft.
    state : ShaftState
        Where it is linearised.
    tilt_inertia : float or None
        Moment of inertia of the pinion about a diameter, kg m2; None if it does not tilt.

    Returns
    -------
    Seat
        With the tangent of the shaft.
    """
    return Seat(condensed_state(state), tilt_inertia, shaft, state)


def scaled_seat(seat: Seat, factor: float) -> Seat:
    """Return a seat on rolling bearings with all its stiffness multiplied by a factor.

    Parameters
    ----------
    seat : Seat
        With rolling bearings.
    factor : float
        On the stiffness of bearings and shaft, dimensionless.

    Returns
    -------
    Seat
        Linearised at the same motions.
    """
    shaft, state = seat.rolling, seat.state
    assert shaft is not None and state is not None
    new_state = replace(
        state,
        energy=factor * state.energy,
        bend=np.sqrt(factor) * state.bend,
        forces=factor * state.forces,
        pinion_load=factor * state.pinion_load,
        stiffness=factor * state.stiffness,
    )
    return rolling_seat(shaft.scale(factor), new_state, seat.tilt_inertia)


def body_on_tangent(body: Body, state: ShaftState) -> Body:
    """Return a pinion with the tangent of its shaft, for loads without moments, as bearing.

    Parameters
    ----------
    body : Body
        The pinion.
    state : ShaftState
        Where its shaft is linearised.

    Returns
    -------
    Body
        With bearing stiffness along x, y and z, and between x and y; N/m.
    """
    across, _ = outer_tangent(state, 2)
    along = 1.0 / float(condensed_state(state).compliance[2, 2])
    x, y, xy = float(across[0, 0]), float(across[1, 1]), float(across[0, 1])
    return replace(body, bearing=(x, y, along), bearing_xy=xy)
