"""Shafts on rolling bearings in a machine: its coordinates that move their rings, and their tangents.

A tangent is a stiffness and a constant load, so that modes and motion see a linear bearing that carries the
mean load where it stands under it.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from facegear.arrays import Array
from facegear.bearings.shaft import ShaftState
from facegear.bearings.shaft_element import ShaftElement
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


def shaft_elements(line: DriveLine) -> Iterator[tuple[int, ShaftElement]]:
    """Yield the shafts on rolling bearings, by rising number of their pinion.

    Parameters
    ----------
    line : DriveLine
        The drive line.

    Yields
    ------
    tuple of int and ShaftElement
        Number of the pinion in the layout, and the shaft as an element of the machine.
    """
    for pinion in line.rolling:
        shaft, at = line.seats[pinion].rolling, line.motions(pinion)
        assert shaft is not None
        yield pinion, ShaftElement(shaft, at, shaft.rigid[:, : at.size], np.arange(MOTIONS))


def add_tangents(model: LinearModel, line: DriveLine | None) -> LinearModel:
    """Return the model with the tangents of the rolling bearings in stiffness and forces.

    A pinion that does not tilt has the tangent for loads without moments.

    Parameters
    ----------
    model : LinearModel
        Model without the rolling bearings.
    line : DriveLine or None
        Drive line, each of whose rolling shafts has a state.

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
        tangent, force = outer_tangent(state, at.size)
        stiffness[np.ix_(at, at)] += tangent
        loads[at] += tangent @ state.pinion[: at.size] - force
    return replace(model, stiffness=stiffness, forces=model.forces + loads, tangent_loads=loads)


def outer_tangent(state: ShaftState, count: int) -> tuple[Array, Array]:
    """Return the tangent by the first motions of a pinion, the others eliminated without load.

    Parameters
    ----------
    state : ShaftState
        State of the shaft.
    count : int
        Number of motions that remain, of x, y, z, tilt_x and tilt_y.

    Returns
    -------
    (count, count) array, (count,) array
        Stiffness, and load at the state's motions of the remaining ones; N/m, N/rad, N m/rad, N and N m.
    """
    matrix, load = state.stiffness[:MOTIONS, :MOTIONS], state.pinion_load
    outer, inner = slice(count), slice(count, MOTIONS)
    if count == MOTIONS:
        return matrix, load
    arms = _arms(matrix)[inner]
    block = matrix[inner, inner] / np.outer(arms, arms)
    columns = np.concatenate([matrix[inner, outer], load[inner, None]], axis=1) / arms[:, None]
    eliminated = matrix[outer, inner] / arms @ np.linalg.pinv(block, rcond=LOOSE, hermitian=True) @ columns
    tangent = matrix[outer, outer] - eliminated[:, :-1]
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
