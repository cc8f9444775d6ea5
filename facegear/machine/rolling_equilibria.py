"""Equilibria of a machine whose shafts stand on rolling bearings, from a guess by their tangents."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from facegear.arrays import Array
from facegear.bearings.shaft import ShaftState
from facegear.bearings.shaft_element import ShaftElement
from facegear.machine.block_statics import StaticBlocks, has_kernel, settle_all, static_blocks
from facegear.machine.casing_coordinates import casing_start
from facegear.machine.dense_statics import Contacts, dense_equilibrium
from facegear.machine.layout import DOF_PER_BODY
from facegear.machine.machine import Machine
from facegear.machine.rolling_statics import (
    TOLERANCE,
    RollingProblem,
    find_states,
    imbalance,
)
from facegear.machine.supports import outer_tangent, shaft_elements
from facegear.meshing.law import MeshLaw


@dataclass(frozen=True, eq=False)
class ShaftLoads:
    """A shaft on rolling bearings at K equilibria.

    Attributes
    ----------
    pinion : (K, 5)
        Motions of the pinion's middle, m and rad.
    rings, forces : (K, bearings, 5)
        Motions of the inner rings against the outer ones, m and rad, and loads of the shaft on its bearings,
        N and N m.
    """

    pinion: Array
    rings: Array
    forces: Array


@dataclass(frozen=True, eq=False)
class RollingEquilibria:
    """Equilibria at K positions.

    Attributes
    ----------
    displacements : (K, n)
        m and rad.
    flanks : (K, F)
        Forces of the flanks, N.
    shafts : mapping of int to ShaftLoads
        Shafts on rolling bearings by the numbers of their pinions.
    loads : (K, n)
        Loads on these shafts by the coordinates that move them, N and N m.
    imbalance, rounding : (K,)
        Largest force out of balance and the part that rounding of bearings explains, N.
    """

    displacements: Array
    flanks: Array
    shafts: Mapping[int, ShaftLoads]
    loads: Array
    imbalance: Array
    rounding: Array


def rolling_equilibria(machine: Machine, law: MeshLaw, cycles: Array, gaps: Array) -> RollingEquilibria:
    """Find equilibria of a machine with rolling bearings.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.
    law : MeshLaw
        Law of the F flanks.
    cycles : (K,) array
        Positions at which the law is taken, mesh periods.
    gaps : (K, F) array
        Deflections at which flanks touch, m.

    Returns
    -------
    RollingEquilibria
        m, rad and N; whether forces balance is for the caller to check.
    """
    assert machine.drive_line is not None
    linear = machine.linear_without_rolling
    first = 0 if machine.casing is None else casing_start(linear)
    elements = dict(shaft_elements(machine.drive_line, machine.casing, first))
    problem = RollingProblem(linear, law, cycles, gaps, tuple(elements.values()))
    states = find_states(problem, *_guess(machine, elements, law, cycles, gaps))
    loads, shafts = np.zeros_like(states.coordinates), {}
    for number, (pinion, element) in enumerate(elements.items()):
        response = states.responses[number]
        loads[:, element.at] += response.gradient[:, : element.at.size]
        motion = element.motion(states.coordinates[:, element.at], states.inner[number])
        shafts[pinion] = ShaftLoads(motion, response.rings, response.forces)
    rounding = np.sum([response.rounding for response in states.responses], axis=0)
    return RollingEquilibria(
        states.coordinates, states.flanks, shafts, loads, imbalance(problem, states), rounding
    )


def _guess(
    machine: Machine, elements: Mapping[int, ShaftElement], law: MeshLaw, cycles: Array, gaps: Array
) -> tuple[Array, list[Array]]:
    """Return coordinates (K, n) and inner coordinates (K, m) of each shaft by the bearings' tangents."""
    line, law_at_positions = machine.drive_line, law.statics_law(cycles)
    assert line is not None
    blocks = _blocks(machine)
    if blocks is not None and has_kernel(law_at_positions):
        start = np.zeros(blocks.coordinates.size)
        solution, _, _ = settle_all(blocks.springs, law_at_positions, gaps, TOLERANCE, start)
        layout_displacements = blocks.displacements(solution)
        coordinates = line.extend_displacements(machine.lumped_model, layout_displacements)
    else:
        linear, gap = machine.linear, gaps[0]
        never = np.full(gap.size, -np.inf)
        contacts = Contacts(law.at_phase(float(cycles[0])), 0.0 * gap, never, gap)
        displacement = dense_equilibrium(linear, contacts, linear.lengths)[0]
        coordinates = np.repeat(displacement[None], len(cycles), axis=0)
    inner = []
    for pinion, element in elements.items():
        state = line.seats[pinion].state
        assert state is not None
        if machine.casing is not None:
            inner.append(np.repeat(element.start(state)[1][None], len(cycles), axis=0))
            continue
        outer, inner_of_shaft = _follow(element, state, coordinates[:, element.at])
        coordinates[:, element.at] = outer
        inner.append(inner_of_shaft)
    return coordinates, inner


def _follow(element: ShaftElement, state: ShaftState, outer: Array) -> tuple[Array, Array]:
    """Return outer (K, k) and inner (K, m) coordinates of a shaft by its tangent at a state, where x and y
    of the outer ones are given and all others carry no load.
    """
    outer_start, inner_start = element.start(state)
    response = element.respond(outer_start[None], inner_start[None])
    matrix, gradient = response.matrix[0], response.gradient[0]
    across, free = np.arange(2), np.arange(2, gradient.size)
    arms = np.concatenate(
        [np.ones(1), np.full(element.at.size - 3, element.inner_arms[0]), element.inner_arms]
    )
    scaled_matrix = matrix[np.ix_(free, free)] / np.outer(arms, arms)
    inverse = np.linalg.pinv(scaled_matrix, rcond=1e-9, hermitian=True) / np.outer(arms, arms)
    change = outer[:, :2] - outer_start[:2]
    rest = -(gradient[free] + change @ matrix[np.ix_(across, free)]) @ inverse.T
    whole = np.concatenate([outer_start, inner_start]) + np.concatenate([change, rest], axis=1)
    return whole[:, : element.at.size], whole[:, element.at.size :]


@lru_cache(maxsize=8)
def _blocks(machine: Machine) -> StaticBlocks | None:
    """Return the compiled problem of a machine with the tangents of its rolling bearings, None where the
    compiled solver does not apply.
    """
    line = machine.drive_line
    assert line is not None
    if machine.casing is not None:
        return None
    blocks = static_blocks(replace(machine, drive_line=None))
    if blocks is None:
        return None
    bearing, loads = blocks.springs.pinion_bearing.copy(), blocks.springs.loads.copy()
    for pinion in line.rolling:
        state = line.seats[pinion].state
        assert state is not None
        tangent, force = outer_tangent(state, 2)
        bearing[pinion] = tangent[0, 0], tangent[0, 1], tangent[1, 1]
        at = np.isin(blocks.coordinates, DOF_PER_BODY * pinion + np.arange(2))
        loads[at] += tangent @ state.pinion[:2] - force
    return replace(blocks, springs=blocks.springs._replace(pinion_bearing=bearing, loads=loads))
