"""Join the chunks of a sweep as if it had been run in one go."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.mirror_images import held_symmetries
from facegear.dynamics.steady_state.simulate import Model, simulate
from facegear.dynamics.sweeps.plan import SweepPlan
from facegear.dynamics.sweeps.rms_distance import SAME_ORBIT, distance
from facegear.dynamics.sweeps.sweep import Piece, collect, join_pieces, run_speeds
from facegear.dynamics.symmetries import Symmetry, symmetries


class SeamKind(StrEnum):
    """Agreement of two chunks where they meet."""

    AGREEMENT = "agreed"
    RERUN = "rerun"
    IRREGULAR = "irregular"


@dataclass(frozen=True)
class Seam:
    """Where two chunks meet, and how many speeds had to be run again from the end of the first.

    With `irregular`, both are in irregular motion there, whose state is never forgotten; the chunks agree in
    RMS only.
    """

    direction: str
    speed_rpm: float
    kind: SeamKind
    rerun: int


def same_response(first: Piece, i: int, second: Piece, j: int) -> SeamKind | None:
    """Compare two responses at one speed.

    Parameters
    ----------
    first : Piece
        First piece.
    i : int
        Position in it.
    second : Piece
        Second piece.
    j : int
        Position in it.

    Returns
    -------
    SeamKind or None
        None if they are different motions.
    """
    rms, other_rms = first.deflection_ac_rms[i], second.deflection_ac_rms[j]
    periodic = first.periodic[i], second.periodic[j]
    if all(periodic):
        near = distance(rms, other_rms) <= SAME_ORBIT
        return SeamKind.AGREEMENT if near and first.period[i] == second.period[j] else None
    if any(periodic):
        return None
    doubt = first.deflection_ac_rms_interval[i] + second.deflection_ac_rms_interval[j]
    return SeamKind.IRREGULAR if (np.abs(rms - other_rms) <= 2.0 * doubt + SAME_ORBIT * rms).all() else None


def symmetries_at_end(model: Model, piece: Piece, settings: Settings) -> tuple[Symmetry, ...]:
    """Return the symmetries that map the last motion of a piece to itself.

    Parameters
    ----------
    model : Model
        Reduced machine.
    piece : Piece
        Results in the order of running.
    settings : Settings
        Settings of the run.

    Returns
    -------
    tuple of Symmetry
        All symmetries of the system where the motion is not periodic.
    """
    if not piece.symmetry_broken[-1]:
        return symmetries(model.system)
    return held_symmetries(simulate(model, float(piece.speeds[-1]), settings, piece.state(-1)))


def assemble(
    model: Model, plan: SweepPlan, direction: str, chunks: list[tuple[Piece, Piece]]
) -> tuple[Piece, list[Seam]]:
    """Join chunks; where a chunk started on another branch it is run again until it agrees.

    Parameters
    ----------
    model : Model
        Reduced machine.
    plan : SweepPlan
        Speeds and settings.
    direction : str
        "up" or "down".
    chunks : list of tuple
        Overlap and own speeds of each chunk.

    Returns
    -------
    Piece
        Results at all speeds.
    list of Seam
        Seams between the chunks.
    """
    whole = chunks[0][1]
    seams: list[Seam] = []
    for before, own_piece in chunks[1:]:
        speed = float(whole.speeds[-1])
        kind = same_response(whole, -1, before, -1) if len(before.speeds) else None
        if kind is not None:
            seams.append(Seam(direction, speed, kind, 0))
            whole = join_pieces([whole, own_piece])
            continue
        redone: list[Piece] = []
        start_symmetries = symmetries_at_end(model, whole, plan.settings)
        for i in range(len(own_piece.speeds)):
            state = (redone[-1] if redone else whole).state(-1)
            (again,) = run_speeds(
                model, own_piece.speeds[i : i + 1], plan.settings, state, start_symmetries=start_symmetries
            )
            redone.append(collect(model, iter([again])))
            start_symmetries = held_symmetries(again[1])
            if same_response(redone[-1], -1, own_piece, i) is not None:
                break
        seams.append(Seam(direction, speed, SeamKind.RERUN, len(redone)))
        whole = join_pieces([whole, *redone, own_piece.tail(len(redone))])
    return whole, seams
