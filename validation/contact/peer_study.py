"""CalculiX beside the chain: the same sector on the same mesh, the pinion turned by the same angle."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.interpolate import PchipInterpolator

from facegear.contact.gear_flank import BUILDERS
from facegear.contact.options import Refinement
from facegear.progress import Progress
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes, named_sizes
from validation.contact.calculix import run_deck, write_deck
from validation.contact.refinement_levels import CUTS
from validation.contact.sector_model import SectorPair, angles_at, sector_pair

TEETH = 5
"""Number of teeth of both sectors."""
LOADED_TEETH = (-1, 0, 1, 2)
"""Numbers of the teeth that may carry load."""
HAND_OVER = 0.0
POSITIONS = (HAND_OVER, 0.34, 0.67)
REFERENCE_LEVEL = "coarse_4x1x2"
"""Level that the errors of both are taken from."""
AMORTISED = 128
"""Solutions over which one compliance is shared: 32 positions at 4 loads."""
LOADS = (0.25, 0.5, 0.75, 1.0)
"""Torques solved at a position, parts of the one compared: `seconds` is the time for one of them."""
AROUND = tuple(np.linspace(0.85, 1.15, 13))
"""Torques, in parts of the one compared, between which the resolved sector's torque at a turn is read."""


def peer_study(
    design: PairDesign,
    levels: Mapping[str, tuple[MeshSizes, Sequence[float]]],
    materials: tuple[Material, Material],
    torque: float,
    folder: Path,
    threads: int,
) -> pd.DataFrame:
    """Compare the torque that both need for the turn our sector takes, with times (s) and memory (GB).

    CalculiX runs with either body's flank as the slave surface, a row each: its answer should not depend on
    it. `resolved_torque_n_m` is the torque of the same sector at that turn with its contact strip resolved,
    by our solver on REFERENCE_LEVEL; errors are taken from it. At a given turn torques differ by some 1.3
    times the difference of turns at a given torque (local over average stiffness). `seconds` is ours for one
    solution with its part of the compliances of both sectors, `calculix_seconds` one run.

    Parameters
    ----------
    design : PairDesign
        The pair.
    levels : Mapping[str, tuple[MeshSizes, Sequence[float]]]
        Mesh sizes and positions (fractions of a pitch) by level.
    materials : tuple[Material, Material]
        Materials of pinion and gear.
    torque : float
        Torque on the pinion, N m.
    folder : Path
        Folder of CalculiX's files.
    threads : int
        Number of threads of CalculiX.

    Returns
    -------
    DataFrame
        One row for each level, position and slave.

    Raises
    ------
    FacegearError
        If ccx is not installed or fails.
    """
    size, cuts = CUTS[REFERENCE_LEVEL]
    reference_pair = sector_pair(
        design, named_sizes(size, design.module), materials, TEETH, LOADED_TEETH, cuts
    )
    all_positions = {position for _, positions in levels.values() for position in positions}
    fine = {position: _torque_by_turn(reference_pair, position, torque) for position in all_positions}
    del reference_pair
    progress = Progress("CalculiX", sum(len(positions) for _, positions in levels.values()) * len(BUILDERS))
    rows = []
    for name, (sizes, positions) in levels.items():
        start = time.perf_counter()
        pair = sector_pair(design, sizes, materials, TEETH, LOADED_TEETH, Refinement())
        # one more solution makes what all positions share
        pair.solve(0.5, (1.0,))
        preparation = time.perf_counter() - start
        for position in positions:
            start = time.perf_counter()
            result = pair.solve(position, tuple(part * torque for part in LOADS))[-1]
            seconds = preparation / AMORTISED + (time.perf_counter() - start) / len(LOADS)
            turn = result.ste / design.normal_arm
            exact = float(fine[position](turn))
            for slave in BUILDERS:
                deck = folder / f"{name}_{round(100 * position):03d}_{slave}.inp"
                dof = write_deck(
                    deck, design, sizes, materials, TEETH, angles_at(design, position), turn, slave
                )
                peer = run_deck(deck, threads, dof)
                progress.step()
                rows.append(
                    {
                        "level": name,
                        "position": position,
                        "slave": slave,
                        "dof": dof,
                        "torque_n_m": torque,
                        "calculix_torque_n_m": peer.torque,
                        "resolved_torque_n_m": exact,
                        "difference_percent": 100 * (torque / peer.torque - 1),
                        "error_percent": 100 * (torque / exact - 1),
                        "calculix_error_percent": 100 * (peer.torque / exact - 1),
                        "seconds": seconds,
                        "calculix_seconds": peer.run.seconds,
                        "time_ratio": peer.run.seconds / seconds,
                        "calculix_memory_gb": peer.run.gigabytes,
                        "calculix_version": peer.run.version,
                    }
                )
    return pd.DataFrame(rows)


def _torque_by_turn(pair: SectorPair, position: float, torque: float) -> PchipInterpolator:
    """Torque (N m) against the turn (rad) of the pinion around `torque`."""
    torques = tuple(part * torque for part in AROUND)
    turns = [result.ste / pair.flanks.design.normal_arm for result in pair.solve(position, torques)]
    return PchipInterpolator(turns, torques, extrapolate=False)
