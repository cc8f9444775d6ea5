"""Shafts on rolling bearings in a machine: its coordinates that move their rings, and their tangents.

A tangent is a stiffness and a constant load, so that modes and motion see a linear bearing that carries the
mean load where it stands under it.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import scipy

from facegear.arrays import Array
from facegear.bearings.shaft import RollingShaft, ShaftState
from facegear.bearings.shaft_element import ShaftElement
from facegear.machine.casing import Casing
from facegear.machine.casing_coordinates import casing_start
from facegear.machine.drive_line import DriveLine
from facegear.machine.linear_model import LinearModel
from facegear.parts.shafts import CondensedShaft
from facegear.rigid_body import LOOSE, MOTIONS

LARGEST_COMPLIANCE = 1.0 / LOOSE
"""Compliance of a motion that loose bearings leave free, over that of the stiffest motion, dimensionless."""

LEAST_STIFFNESS = 1.0
"""Stiffest motion of a shaft that nothing holds, N/m, which gives it a finite compliance."""


def has_rolling_bearings(line: DriveLine | None) -> bool:
    """Return whether a pinion's shaft stands on rolling bearings.

    Parameters
    ----------
    line : DriveLine or None
        Drive line of the machine.

    Returns
    -------
    bool
        False without a drive line.
    """
    return line is not None and bool(line.rolling)


def shaft_elements(
    line: DriveLine, casing: Casing | None = None, first: int = 0
) -> Iterator[tuple[int, ShaftElement]]:
    """Yield the shafts on rolling bearings, by rising number of their pinion.

    Parameters
    ----------
    line : DriveLine
        The drive line.
    casing : Casing or None
        Casing whose seats carry outer rings; None where all stand still.
    first : int
        Index of the first coordinate of the casing among those of the machine.

    Yields
    ------
    tuple of int and ShaftElement
        Number of the pinion in the layout, and the shaft as an element of the machine.
    """
    for pinion in line.rolling:
        shaft, at = line.seats[pinion].rolling, line.motions(pinion)
        assert shaft is not None
        rows, count = shaft.rigid[:, : at.size], at.size
        if (seats := _ring_motions(casing, pinion)) is not None:
            seat_columns = np.flatnonzero(seats.any(axis=0))
            rows, at = np.hstack([rows, -seats[:, seat_columns]]), np.append(at, first + seat_columns)
        # Tilts of the pinion that are no coordinates are the first inner ones.
        motions = np.append(np.arange(count), at.size + np.arange(MOTIONS - count))
        yield pinion, ShaftElement(shaft, at, rows, motions)


def _ring_motions(casing: Casing | None, pinion: int) -> Array | None:
    """Return the motions (5 bearings, c) of a shaft's outer rings by the casing; None on the ground."""
    if casing is None or not any(casing.bearing_seats.get(pinion, ())):
        return None
    return casing.ring_motions(pinion)


def seats_at(shaft: RollingShaft, state: ShaftState) -> Array:
    """Return the motions of the seats at a state of a shaft.

    Parameters
    ----------
    shaft : RollingShaft
        The shaft.
    state : ShaftState
        Its state.

    Returns
    -------
    (5 bearings,) array
        m and rad.
    """
    offsets = np.concatenate([support.offset for support in shaft.supports])
    shaft_motions = shaft.rigid @ state.pinion + shaft.bending @ state.bend
    return np.asarray(shaft_motions + offsets - state.rings.ravel())


def add_tangents(model: LinearModel, line: DriveLine | None, casing: Casing | None = None) -> LinearModel:
    """Return the model with the tangents of the rolling bearings in stiffness and forces.

    A pinion that does not tilt has the tangent for loads without moments.

    Parameters
    ----------
    model : LinearModel
        Model without the rolling bearings.
    line : DriveLine or None
        Drive line, each of whose rolling shafts has a state.
    casing : Casing or None
        Casing whose seats carry outer rings; its coordinates stand in the model.

    Returns
    -------
    LinearModel
        The same model where there are no rolling bearings.
    """
    if line is None or not line.rolling:
        return model
    stiffness, loads = model.stiffness.copy(), np.zeros(model.size)
    for pinion in line.rolling:
        state, at = line.seats[pinion].state, line.motions(pinion)
        assert state is not None
        seats = _ring_motions(casing, pinion)
        tangent, force = outer_tangent(state, at.size, with_seats=seats is not None)
        motion, carry = state.pinion[: at.size], np.eye(at.size)
        if seats is not None:
            shaft, seat_columns = line.seats[pinion].rolling, np.flatnonzero(seats.any(axis=0))
            assert shaft is not None
            motion = np.append(motion, seats_at(shaft, state))
            carry = scipy.linalg.block_diag(carry, seats[:, seat_columns])
            at = np.append(at, casing_start(model) + seat_columns)
        stiffness[np.ix_(at, at)] += carry.T @ tangent @ carry
        loads[at] += carry.T @ (tangent @ motion - force)
    return replace(model, stiffness=stiffness, forces=model.forces + loads, tangent_loads=loads)


def outer_tangent(state: ShaftState, count: int, with_seats: bool = False) -> tuple[Array, Array]:
    """Return the tangent by the first motions of a pinion, the others eliminated without load.

    Parameters
    ----------
    state : ShaftState
        State of the shaft.
    count : int
        Number of motions that remain, of x, y, z, tilt_x and tilt_y.
    with_seats : bool
        Whether the motions of the seats (5 bearings) remain, too, behind those of the pinion.

    Returns
    -------
    (count, count) array, (count,) array
        Stiffness, and load at the state's motions of the remaining ones; N/m, N/rad, N m/rad, N and N m.
    """
    size = len(state.stiffness) if with_seats else MOTIONS
    matrix = state.stiffness[:size, :size]
    load = np.append(state.pinion_load, -state.forces.ravel()) if with_seats else state.pinion_load
    outer, inner = np.delete(np.arange(size), np.arange(count, MOTIONS)), np.arange(count, MOTIONS)
    if count == MOTIONS:
        return matrix, load
    arms = _arms(matrix[:MOTIONS, :MOTIONS])[inner]
    block = matrix[np.ix_(inner, inner)] / np.outer(arms, arms)
    columns = np.concatenate([matrix[np.ix_(inner, outer)], load[inner, None]], axis=1) / arms[:, None]
    inverse = np.linalg.pinv(block, rcond=LOOSE, hermitian=True)
    eliminated = matrix[np.ix_(outer, inner)] / arms @ inverse @ columns
    tangent = matrix[np.ix_(outer, outer)] - eliminated[:, :-1]
    return 0.5 * (tangent + tangent.T), load[outer] - eliminated[:, -1]


def condensed_state(state: ShaftState) -> CondensedShaft:
    """Return the tangent of a shaft's state as a shaft on springs.

    Motions that loose bearings leave free have LARGEST_COMPLIANCE.

    Parameters
    ----------
    state : ShaftState
        State of the shaft.

    Returns
    -------
    CondensedShaft
        Compliance (5, 5) of the pinion's middle, and changes of the bearings' loads by those of the
        pinion's.
    """
    matrix = state.stiffness[:MOTIONS, :MOTIONS]
    arms = _arms(matrix)
    values, vectors = np.linalg.eigh(matrix / np.outer(arms, arms))
    largest = max(float(values[-1]), LEAST_STIFFNESS)
    compliances = 1.0 / np.maximum(values, largest / LARGEST_COMPLIANCE)
    compliance = (vectors * compliances) @ vectors.T / np.outer(arms, arms)
    reactions = -state.stiffness[MOTIONS:, :MOTIONS].reshape(-1, MOTIONS, MOTIONS) @ compliance
    return CondensedShaft(compliance, reactions)


def _arms(matrix: Array) -> Array:
    """Return arms (5,), m, by which shifts and tilts of a stiffness (5, 5) compare: 1 thrice, and the
    root of its largest stiffness against tilts over that of shifts.
    """
    shift, tilt = np.diagonal(matrix)[:3].max(), np.diagonal(matrix)[3:].max()
    arm = np.sqrt(tilt / shift) if shift > 0.0 and tilt > 0.0 else 1.0
    return np.array([1.0, 1.0, 1.0, arm, arm])
