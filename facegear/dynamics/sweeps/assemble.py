"""Chunks of a sweep put together as if it had been run in one go."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.mirror_images import held_symmetries
from facegear.dynamics.steady_state.simulate import Model, simulate
from facegear.dynamics.sweeps.plan import SweepPlan
from facegear.dynamics.sweeps.rms_distance import SAME, distance
from facegear.dynamics.sweeps.sweep import Piece, collect, joined, run_speeds
from facegear.dynamics.symmetries import Symmetry, symmetries


class SeamKind(StrEnum):
    """How two chunks met."""

    AGREED = "agreed"
    RERUN = "rerun"
    IRREGULAR = "irregular"


@dataclass(frozen=True)
class Seam:
    """Where two chunks meet and how many speeds had to be run again from the end of the first.

    `irregular`: both are in irregular motion there, whose state is never forgotten; the chunks agree in RMS
    only.
    """

    direction: str
    speed_rpm: float
    kind: SeamKind
    rerun: int


def same_response(first: Piece, i: int, second: Piece, j: int) -> SeamKind | None:
    """Whether two responses at one speed are the same motion; None if not."""
    rms, other = first.deflection_ac_rms[i], second.deflection_ac_rms[j]
    periodic = first.periodic[i], second.periodic[j]
    if all(periodic):
        near = distance(rms, other) <= SAME
        return SeamKind.AGREED if near and first.period[i] == second.period[j] else None
    if any(periodic):
        return None
    doubt = first.deflection_ac_rms_interval[i] + second.deflection_ac_rms_interval[j]
    return SeamKind.IRREGULAR if (np.abs(rms - other) <= 2.0 * doubt + SAME * rms).all() else None


def symmetries_at_end(model: Model, piece: Piece, settings: Settings) -> tuple[Symmetry, ...]:
    """Return the symmetries that map the last motion of a piece to itself; all where it is not periodic."""
    if not piece.symmetry_broken[-1]:
        return symmetries(model.system)
    return held_symmetries(simulate(model, float(piece.speeds[-1]), settings, piece.state(-1)))


def assemble(
    model: Model, plan: SweepPlan, direction: str, chunks: list[tuple[Piece, Piece]]
) -> tuple[Piece, list[Seam]]:
    """Join (overlap, own) chunks; where a chunk started on another branch it is run again until it agrees."""
    whole = chunks[0][1]
    seams: list[Seam] = []
    for before, own in chunks[1:]:
        speed = float(whole.speeds[-1])
        kind = same_response(whole, -1, before, -1) if len(before.speeds) else None
        if kind is not None:
            seams.append(Seam(direction, speed, kind, 0))
            whole = joined([whole, own])
            continue
        redone: list[Piece] = []
        held = symmetries_at_end(model, whole, plan.settings)
        for i in range(len(own.speeds)):
            state = (redone[-1] if redone else whole).state(-1)
            (again,) = run_speeds(model, own.speeds[i : i + 1], plan.settings, state, held=held)
            redone.append(collect(model, iter([again])))
            held = held_symmetries(again[1])
            if same_response(redone[-1], -1, own, i) is not None:
                break
        seams.append(Seam(direction, speed, SeamKind.RERUN, len(redone)))
        whole = joined([whole, *redone, own.tail(len(redone))])
    return whole, seams
