"""Mesh forces of a machine in one bin of its duty cycle, and what its flanks and teeth meet of them."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import lcm
from typing import Any

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.between_samples import located_by_cycle
from facegear.dynamics.following import MEMORY_LIMIT, follow
from facegear.dynamics.motion import Motion, Settings
from facegear.dynamics.steady_state.simulate import build_model, simulate
from facegear.geometry.flank_errors import FLANKS
from facegear.load_sharing.even_shares import even_shares
from facegear.load_sharing.hunting import hunting_length
from facegear.strength.passage_loads import classes, hardest_tooth, passage_forces
from facegear.transmission.flanks import NO_LOAD, teeth_in_mesh
from facegear.transmission.layout import Layout
from facegear.transmission.machine import Machine

POSITIONS = 64
"""Samples of a mesh cycle while runouts turn."""


@dataclass(frozen=True, eq=False)
class History:
    """Forces (cycles, positions, 2 meshes) on the flanks of a motion, drive flanks first, N.

    even_shares (meshes,): nominal even share of each mesh, N.
    largest (cycles, flanks): largest force of each cycle, located between the positions, N.
    turning: the cycles are those of the hunting cycle, each with its own teeth.
    """

    layout: Layout
    even_shares: Array
    forces: Array
    largest: Array
    turning: bool
    motion: str
    settled: bool


def history_of(machine: Machine, speed_rpm: float, known: Settings) -> History:
    """A machine whose runouts turn is followed through its hunting cycle, any other to its steady state.

    Raises NotConverged naming the speed.
    """
    model, cycles, even = build_model(machine), hunting_length(machine), even_shares(machine)
    layout, flanks = machine.layout, 2 * len(machine.layout.meshes)
    if layout.kinematics.flanks_apart and cycles > 1:
        run = follow(model, speed_rpm, 0, cycles, POSITIONS, known)
        kept = run.memory <= MEMORY_LIMIT
        forces = run.flank_forces.reshape(-1, POSITIONS, flanks)
        motion = "followed" if kept else "depends on its past"
        return History(layout, even, forces, located_by_cycle(forces, False), True, motion, kept)
    response = simulate(model, speed_rpm, known)
    both = np.concatenate([np.maximum(response.forces, 0.0), np.maximum(-response.forces, 0.0)], axis=1)
    forces = both.reshape(response.periods, response.per_period, flanks)
    largest = located_by_cycle(forces, response.motion is Motion.PERIODIC)
    settled = response.motion is not Motion.NOT_SETTLED
    return History(layout, even, forces, largest, False, response.label, settled)


def load_rows(history: History) -> Iterator[tuple[Any, ...]]:
    """Rows of DUTY_LOAD_COLUMNS after the bin's load: every flank of a mesh that carries any.

    K_gamma is the largest mean of a mesh cycle over the mesh's nominal even share, K_v the largest force over
    that mean.
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
            *(history.motion, history.settled),
        )


def spectrum_rows(history: History) -> Iterator[tuple[Any, ...]]:
    """Body, gear, flank, mesh, fraction and force of every class of passages."""
    layout, passages = history.layout, passage_forces(history.largest)
    pinions, floor = len(layout.pinions), NO_LOAD * passages.max()
    if history.turning:  # on to where the same two teeth meet again
        passages = np.tile(passages, (lcm(layout.pinion_teeth, layout.gear_teeth) // len(passages), 1))
    cycles = np.arange(len(passages), dtype=float)
    met = np.array([teeth_in_mesh(layout, mesh, cycles) for mesh in range(len(layout.meshes))])
    for body, name in enumerate(layout.body_names):
        gear, teeth = ("pinion", layout.pinion_teeth) if body < pinions else ("face_gear", layout.gear_teeth)
        own = [mesh for mesh, (i, g) in enumerate(layout.meshes) if body in (i, pinions + g)]
        numbers = np.floor(met[own, int(gear == "face_gear")]).T.astype(np.int64) % teeth
        for side, flank in enumerate(FLANKS):
            mine = passages[:, [side * len(layout.meshes) + mesh for mesh in own]]
            forces = hardest_tooth(mine, numbers) if history.turning else list(mine.T)
            for mesh, force in zip(own, forces, strict=True):
                for fraction, level in classes(force):
                    if level > floor:
                        yield name, gear, flank, layout.mesh_names[mesh], fraction, level
