"""Mesh forces of the running machine in every bin of the duty cycle, and what its teeth meet of them."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import lcm
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.config.base import parse
from facegear.config.dynamics import Accuracy, settings
from facegear.config.lumped_model import at_mesh_torque
from facegear.config.machines import wired_machine
from facegear.config.strength import Strength
from facegear.dynamics.following import FORGOTTEN, follow
from facegear.dynamics.motion import Motion, Settings
from facegear.dynamics.steady_state.simulate import build_model, simulate
from facegear.errors import ConfigError
from facegear.geometry.flank_errors import FLANKS
from facegear.load_sharing.even_shares import even_shares
from facegear.load_sharing.hunting import hunting_length
from facegear.progress import Progress
from facegear.stages.outcome import Outcome
from facegear.strength.columns import DUTY_LOAD_COLUMNS, DUTY_SPECTRUM_COLUMNS
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
    turning: the cycles are those of the hunting cycle, each with its own teeth.
    """

    layout: Layout
    even_shares: Array
    forces: Array
    turning: bool
    motion: str
    settled: bool


def duty_loads(
    harmonics: pd.DataFrame,
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    accuracy: Mapping[str, Any],
    strength: Mapping[str, Any] | None,
    friction: pd.DataFrame | None = None,
) -> Outcome:
    """`duty_loads` and `duty_spectrum` (tables) from the machine's motion in every bin.

    K_gamma is the largest mean of a mesh cycle over the mesh's nominal even share of the bin's load, K_v the
    largest force over that mean. Raises ConfigError without section strength, NotConverged naming the speed.
    """
    if strength is None:
        raise ConfigError("strength", None, "given for the loads of its duty cycle")
    section, known = parse(Strength, strength), settings(parse(Accuracy, accuracy))
    progress, loads, spectrum = Progress("duty cycle", len(section.duty)), [], []
    for number, one in enumerate(section.duty, start=1):
        loaded = at_mesh_torque(transmission, one.torque_n_m)
        machine = wired_machine(loaded, teeth, harmonics, friction=friction)
        history = _history(machine, one.speed_rpm, known)
        place = (number, one.torque_n_m, one.speed_rpm)
        loads += [(*place, *row) for row in _load_rows(history)]
        spectrum += [(number, *row) for row in _spectrum_rows(history)]
        progress.step()
    content = {
        "duty_loads": pd.DataFrame(loads, columns=list(DUTY_LOAD_COLUMNS)),
        "duty_spectrum": pd.DataFrame(spectrum, columns=list(DUTY_SPECTRUM_COLUMNS)),
    }
    return Outcome(content, _summary(content["duty_loads"]))


def _history(machine: Machine, speed_rpm: float, known: Settings) -> History:
    """A machine whose runouts turn is followed through its hunting cycle, any other to its steady state."""
    model, cycles, even = build_model(machine), hunting_length(machine), even_shares(machine)
    layout, flanks = machine.layout, 2 * len(machine.layout.meshes)
    if layout.is_geometric and cycles > 1:
        run = follow(model, speed_rpm, 0, cycles, POSITIONS, known)
        kept = run.memory <= FORGOTTEN
        forces = run.flank_forces.reshape(-1, POSITIONS, flanks)
        return History(layout, even, forces, True, "followed" if kept else "depends on its past", kept)
    found = simulate(model, speed_rpm, known)
    both = np.concatenate([np.maximum(found.forces, 0.0), np.maximum(-found.forces, 0.0)], axis=1)
    forces = both.reshape(found.periods, found.per_period, flanks)
    return History(layout, even, forces, False, found.label, found.motion is not Motion.NOT_SETTLED)


def _load_rows(history: History) -> Iterator[tuple[Any, ...]]:
    layout, largest = history.layout, history.forces.max(axis=(0, 1))
    means = history.forces.mean(axis=1)
    for flank in np.flatnonzero(largest > NO_LOAD * largest.max()):
        side, mesh = divmod(int(flank), len(layout.meshes))
        most = float(means[:, flank].max())
        yield (
            *(layout.mesh_names[mesh], FLANKS[side]),
            *(float(means[:, flank].mean()), float(largest[flank])),
            *(most / history.even_shares[mesh], float(largest[flank]) / most),
            *(history.motion, history.settled),
        )


def _spectrum_rows(history: History) -> Iterator[tuple[Any, ...]]:
    """Body, gear, flank, mesh, share and force of every class of passages."""
    layout, passages = history.layout, passage_forces(history.forces)
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
                for share, level in classes(force):
                    if level > floor:
                        yield name, gear, flank, layout.mesh_names[mesh], share, level


def _summary(table: pd.DataFrame) -> str:
    worst = table.loc[table["largest_force_n"].idxmax()]
    where = f"{worst['mesh']} in bin {worst['bin']} of {worst['torque_n_m']:g} N m"
    factors = f"K_gamma {worst['mesh_load_factor']:.3f}, K_v {worst['dynamic_factor']:.3f}"
    told = f"largest force {worst['largest_force_n']:.0f} N, {where}: {factors}"
    loose = ", ".join(str(number) for number in table.loc[~table["settled"], "bin"].unique())
    return f"{told}; bins without a settled motion: {loose}" if loose else told
