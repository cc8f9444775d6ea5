"""Static equilibria of any linear model at many positions, in dense algebra."""

import numpy as np

from facegear.arrays import Array
from facegear.machine.dense_statics import Contacts, dense_equilibrium
from facegear.machine.linear_model import LinearModel
from facegear.machine.rolling_statics import TOLERANCE, RollingProblem, find_states, imbalance
from facegear.meshing.law import MeshLaw


def solve_one_by_one(linear: LinearModel, law: MeshLaw, cycles: Array, gaps: Array) -> tuple[Array, Array]:
    """Compute static equilibria at many positions, one after the other, by `dense_equilibrium`.

    Parameters
    ----------
    linear : LinearModel
        Bodies, bearings and loads.
    law : MeshLaw
        Law of the flanks.
    cycles : (K,) array
        Positions, mesh periods.
    gaps : (K, flanks) array
        Deflections at which flanks touch, m.

    Returns
    -------
    pair of arrays
        Displacements (K, n), m and rad, and flank forces (K, flanks), N.
    """
    never = np.full(gaps.shape[1], -np.inf)
    solutions = [
        dense_equilibrium(linear, Contacts(law.at_phase(at), 0.0 * gap, never, gap), linear.lengths)
        for at, gap in zip(cycles, gaps, strict=True)
    ]
    displacements, _, forces = (np.array(parts) for parts in zip(*solutions, strict=True))
    return displacements, forces


def solve_together(linear: LinearModel, law: MeshLaw, cycles: Array, gaps: Array) -> tuple[Array, Array]:
    """Compute what `solve_one_by_one` does by steps of all positions together.

    Positions that stay out of balance are left to `dense_equilibrium`.

    Parameters
    ----------
    linear : LinearModel
        Bodies, bearings and loads.
    law : MeshLaw
        Law of the flanks.
    cycles : (K,) array
        Positions, mesh periods.
    gaps : (K, flanks) array
        Deflections at which flanks touch, m.

    Returns
    -------
    pair of arrays
        Displacements (K, n), m and rad, and flank forces (K, flanks), N.
    """
    problem = RollingProblem(linear, law, cycles, gaps, ())
    states = find_states(problem, np.zeros((cycles.size, linear.size)), [])
    open_at = np.flatnonzero(imbalance(problem, states) > TOLERANCE * states.size + states.rounding)
    if open_at.size:
        parts = solve_one_by_one(linear, law, cycles[open_at], gaps[open_at])
        states.coordinates[open_at], states.flanks[open_at] = parts
    return states.coordinates, states.flanks
