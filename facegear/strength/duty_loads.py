"""Mesh forces of a machine in one bin of its duty cycle, and the largest force of each passage."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import lcm
from typing import Any

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine.flank_errors import teeth_in_mesh
from facegear.machine.flanks import NO_LOAD
from facegear.machine.layout import Layout
from facegear.machine.machine import Machine
from facegear.motion.between_samples import located_by_cycle
from facegear.motion.hunting_motion import MEMORY_LIMIT, follow
from facegear.motion.plan import Motion, Settings
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.sharing.even_shares import even_shares
from facegear.sharing.hunting import hunting_length
from facegear.teeth.placement import FLANKS

CLASSES = 16
"""Classes of equal share into which the passages of a tooth through a mesh are sorted."""
STEEP = 10.0
"""Power of the force by which the hardest loaded tooth is chosen, about the slope of an S-N curve."""


def passage_forces(largest: Array) -> Array:
    """Return the largest force during each passage of a tooth: of a mesh cycle and the one after it.

    A tooth is in mesh for about two mesh cycles; the last one is followed by the first.

    Parameters
    ----------
    largest : (cycles, flanks) array
        Largest force of each mesh cycle on each flank, N, not negative.

    Returns
    -------
    (cycles, flanks) array
        Largest force of each passage, by the cycle in which it begins, N.
    """
    return np.maximum(largest, np.roll(largest, -1, axis=0))


def hardest_tooth(passages: Array, tooth_numbers: Integers) -> list[Array]:
    """Return the forces that the hardest loaded tooth of a body meets in each of its meshes.

    The sum of the forces over all meshes to the power STEEP decides which tooth that is.

    Parameters
    ----------
    passages : (cycles, meshes) array
        Force of the passage that begins with each mesh cycle, on one flank, N.
    tooth_numbers : (cycles, meshes) array of int
        Index of the body's tooth that is in mesh.

    Returns
    -------
    list of (n,) array
        Forces of that tooth's passages through each mesh, N.
    """
    scale = passages.max()
    harm = np.bincount(
        tooth_numbers.ravel(), weights=(passages / scale if scale > 0.0 else passages).ravel() ** STEEP
    )
    worst = int(np.argmax(harm))
    return [column[teeth == worst] for column, teeth in zip(passages.T, tooth_numbers.T, strict=True)]


def classes(forces: Array) -> Iterator[tuple[float, float]]:
    """Sort the passages of one flank into classes, from the largest to the smallest force.

    Each class has the largest force of its passages, so that its damage is never less than theirs.

    Parameters
    ----------
    forces : (n,) array
        Force of each passage, N.

    Yields
    ------
    float, float
        Share of the passages, 0 to 1, and force, N.
    """
    sorted_forces = np.sort(forces)[::-1]
    for part in np.array_split(sorted_forces, min(CLASSES, np.unique(sorted_forces).size)):
        yield part.size / sorted_forces.size, float(part[0])


POSITIONS = 64
"""Samples of a mesh cycle while runouts turn."""


@dataclass(frozen=True, eq=False)
class History:
    """Mesh forces of a motion over its cycles.

    Attributes
    ----------
    layout
        Layout of the machine.
    even_shares : (meshes,)
        Nominal even share of each mesh, N.
    forces : (cycles, positions, 2 meshes)
        Forces on the flanks, drive flanks first, N.
    largest : (cycles, flanks)
        Largest force of each cycle, located between the positions, N.
    turning
        Whether the cycles are those of the hunting cycle, each with its own teeth.
    motion
        Label of the motion.
    is_settled
        Whether the motion is steady; of a followed motion, whether its start is forgotten.
    """

    layout: Layout
    even_shares: Array
    forces: Array
    largest: Array
    turning: bool
    motion: str
    is_settled: bool


def history_of(machine: Machine, speed_rpm: float, settings: Settings) -> History:
    """Compute the mesh forces of a machine at a speed.

    A machine whose runouts turn is followed through its hunting cycle, any other to its steady state.

    Parameters
    ----------
    machine : Machine
        The machine under the torque of the bin.
    speed_rpm : float
        Speed of the pinion, rpm.
    settings : Settings
        Settings of the integration.

    Returns
    -------
    History
        Forces of all flanks.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    model, cycles, even = build_model(machine), hunting_length(machine), even_shares(machine)
    layout, flanks = machine.layout, 2 * len(machine.layout.meshes)
    if layout.kinematics.flanks_apart and cycles > 1:
        run = follow(model, speed_rpm, 0, cycles, POSITIONS, settings)
        is_independent = run.memory <= MEMORY_LIMIT
        forces = run.flank_forces.reshape(-1, POSITIONS, flanks)
        motion = "followed" if is_independent else "depends on its past"
        return History(layout, even, forces, located_by_cycle(forces, False), True, motion, is_independent)
    response = simulate(model, speed_rpm, settings)
    flank_forces = np.concatenate(
        [np.maximum(response.forces, 0.0), np.maximum(-response.forces, 0.0)], axis=1
    )
    forces = flank_forces.reshape(response.periods, response.per_period, flanks)
    largest = located_by_cycle(forces, response.motion is Motion.PERIODIC)
    is_settled = response.motion is not Motion.NOT_SETTLED
    return History(layout, even, forces, largest, False, response.label, is_settled)


def load_rows(history: History) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of DUTY_LOAD_COLUMNS after the bin's load: every flank of a mesh that carries any.

    K_gamma is the largest mean of a mesh cycle over the mesh's nominal even share, K_v the largest force over
    that mean.

    Parameters
    ----------
    history : History
        Forces of the machine in the bin.

    Yields
    ------
    tuple
        Values of the columns from `mesh` on.
    """
    layout, largest = history.layout, history.largest.max(axis=0)
    means = history.forces.mean(axis=1)
    for flank in np.flatnonzero(largest > NO_LOAD * largest.max()):
        side, mesh = divmod(int(flank), len(layout.meshes))
        max_force = float(means[:, flank].max())
        yield (
            *(layout.mesh_names[mesh], FLANKS[side]),
            *(float(means[:, flank].mean()), float(largest[flank])),
            *(max_force / history.even_shares[mesh], float(largest[flank]) / max_force),
            *(history.motion, history.is_settled),
        )


def spectrum_rows(history: History) -> Iterator[tuple[Any, ...]]:
    """Yield body, gear, flank, mesh, fraction and force (N) of every class of passages.

    Where runouts turn, the classes are those of the hardest loaded tooth, over all cycles until the same
    two teeth meet again; otherwise those of all passages. Forces up to NO_LOAD of the largest are left
    out.

    Parameters
    ----------
    history : History
        Forces of the machine in the bin.

    Yields
    ------
    tuple
        Values of DUTY_SPECTRUM_COLUMNS after `bin`.
    """
    layout, passages = history.layout, passage_forces(history.largest)
    pinions, floor = len(layout.pinions), NO_LOAD * passages.max()
    if history.turning:  # on to where the same two teeth meet again
        passages = np.tile(passages, (lcm(layout.pinion_teeth, layout.gear_teeth) // len(passages), 1))
    cycles = np.arange(len(passages), dtype=float)
    tooth_positions = np.array([teeth_in_mesh(layout, mesh, cycles) for mesh in range(len(layout.meshes))])
    for body, name in enumerate(layout.body_names):
        gear, teeth = ("pinion", layout.pinion_teeth) if body < pinions else ("face_gear", layout.gear_teeth)
        meshes = [mesh for mesh, (i, g) in enumerate(layout.meshes) if body in (i, pinions + g)]
        numbers = np.floor(tooth_positions[meshes, int(gear == "face_gear")]).T.astype(np.int64) % teeth
        for side, flank in enumerate(FLANKS):
            mine = passages[:, [side * len(layout.meshes) + mesh for mesh in meshes]]
            forces = hardest_tooth(mine, numbers) if history.turning else list(mine.T)
            for mesh, force in zip(meshes, forces, strict=True):
                for fraction, level in classes(force):
                    if level > floor:
                        yield name, gear, flank, layout.mesh_names[mesh], fraction, level
