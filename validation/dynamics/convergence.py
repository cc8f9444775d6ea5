"""Is a sweep converged: each speed once more with everything finer that is discretised."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers
from facegear.dynamics.motion import Motion, Settings, State
from facegear.dynamics.steady_state.averages import Averages
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.steady_state.simulate import Model
from facegear.dynamics.sweeps.sweep import Piece, collect, join_pieces, run_speeds, tighter

CONVERGED = 1e-3
SAMPLES = 4096
LONG = 8192
"""Mesh periods for which a motion is watched whose class is not the same in both runs."""
FEW = 16
"""Periods on which such a motion is measured where it stays irregular: only its class is wanted."""


def rerun(model: Model, piece: Piece, settings: Settings, step: Callable[[], None] = lambda: None) -> Piece:
    """Every speed of a sweep again, from the state that the sweep left there, and far finer.

    All that is discretised varies: the tolerance of the steps and their order, what counts as closed, and the
    samples, from which alone the moments of this run are taken (`sampled_response`). What is not periodic is
    run again with half the tolerance and a longer watch, to see whether its class holds. A finer sweep
    carried through would also choose other branches after irregular motion, which says nothing about the
    accuracy of either.
    """
    again = []
    for i, period in enumerate(piece.period):
        finer = exact(settings) if period else tighter(settings)
        responses = run_speeds(model, piece.speeds[i : i + 1], finer, piece.state(i), step)
        again.append(collect(model, (sampled_response(response) for response in responses)))
    return join_pieces(again)


def exact(settings: Settings) -> Settings:
    """What a periodic motion is held against: 1e-10 and 4096 samples a period."""
    return replace(settings, tolerance=1e-10, order=None, periodic_residual=1e-9, samples=SAMPLES)


def sampled_response(watched: tuple[float, SteadyState]) -> tuple[float, SteadyState]:
    """A response whose averages come from its samples and not from the step polynomials."""
    speed, response = watched
    averages = sampled(response.averages, response.deflections, response.forces, response.per_period)
    return speed, replace(response, averages=averages)


def sampled(known: Averages, deflections: Array, forces: Array, per_period: int) -> Averages:
    """Averages with those of the meshes from samples (K, M) over whole periods, forces in N."""
    periods = len(deflections) // per_period
    batch = np.arange(periods) * len(known.weight) // periods
    by_period = deflections.reshape(periods, per_period, -1)

    def batches(values: Array) -> Array:
        sums = np.zeros((len(known.weight), values.shape[2]))
        np.add.at(sums, batch, values.mean(axis=1))
        return sums / known.weight[:, None]

    return replace(
        known,
        level=np.zeros(deflections.shape[1]),
        deflection=batches(by_period),
        square=batches(by_period**2),
        minimum=deflections.min(axis=0),
        maximum=deflections.max(axis=0),
        force=np.array([forces.mean(axis=0), np.abs(forces).mean(axis=0)]),
    )


@dataclass(frozen=True, eq=False)
class Watched:
    """A speed watched for long at the sweep's tolerance and at 1e-10, each from where both runs left it.

    labels (4,): in this order. period: that of all four, 0 if none is periodic, None if they differ. ac_rms
    (M,): of the mesh deflections, m, at 1e-10 from the sweep's own state.
    """

    labels: tuple[str, ...]
    period: int | None
    ac_rms: Array


def watched_longer(model: Model, piece: Piece, finer: Piece, settings: Settings) -> dict[int, Watched]:
    """What becomes of the speeds that are periodic in one of two runs only, or with another period."""
    long = replace(settings, settle=LONG, window=FEW)
    return {
        int(i): _watched(model, piece.speeds[i : i + 1], long, [piece.state(int(i)), finer.state(int(i))])
        for i in np.flatnonzero(piece.period != finer.period)
    }


def _watched(model: Model, speed: Array, settings: Settings, starts: list[State]) -> Watched:
    runs = [run_speeds(model, speed, each, start) for each in (settings, exact(settings)) for start in starts]
    pieces = [collect(model, (sampled_response(response) for response in run)) for run in runs]
    periods = {int(piece.period[0]) for piece in pieces}
    return Watched(
        labels=tuple(piece.labels[0] for piece in pieces),
        period=periods.pop() if len(periods) == 1 else None,
        ac_rms=pieces[len(starts)].deflection_ac_rms[0],
    )


def convergence_table(
    direction: str, piece: Piece, finer: Piece, watched: Mapping[int, Watched], images: Integers
) -> pd.DataFrame:
    """One row for each speed: direction, speed_rpm, class, class_finer, watched_longer, multiplier,
    multiplier_finer, rms_change, verdict.

    rms_change: largest change of a mesh's AC RMS over the largest AC RMS at that speed, against the nearest
    of the images (images, meshes) by which symmetries of the machine exchange meshes; the multipliers are
    the leading ones of refined orbits. watched_longer: the four classes of `watched_longer`, where the two
    runs do not agree. Verdicts:

    - `converged`, `moved`: the same periodic motion in both runs, or in all four that were watched for long
      where the finer one had not settled; within 1e-3 or not.
    - `irregular`: periodic in neither run, or in none of the four.
    - `not settled`: so named by the sweep, which claims nothing; one periodic motion in all four.
    - `transient`: chaotic or quasi-periodic while the sweep watched it, one periodic motion in all four.
    - `sensitive`: the four differ, so that the class hangs on the tolerance or on where in the motion the run
      begins.
    - `wrong`: named periodic, and something else in all four.
    """
    exact_rms = finer.deflection_ac_rms.copy()
    for i, pieces in watched.items():
        exact_rms[i] = pieces.ac_rms
    first = piece.deflection_ac_rms
    apart = np.abs(first[:, None] - exact_rms[:, images]).max(axis=2).min(axis=1)
    change = apart / np.maximum(first.max(axis=1), 1e-300)
    verdicts = [
        _verdict(label, int(piece.period[i]), int(finer.period[i]), change[i], watched.get(i))
        for i, label in enumerate(piece.labels)
    ]
    labels = ["; ".join(watched[i].labels) if i in watched else "" for i in range(len(change))]
    return pd.DataFrame(
        {
            "direction": direction,
            "speed_rpm": piece.speeds,
            "class": piece.labels,
            "class_finer": finer.labels,
            "watched_longer": labels,
            "multiplier": piece.leading_multiplier,
            "multiplier_finer": finer.leading_multiplier,
            "rms_change": change,
            "verdict": verdicts,
        }
    )


def _verdict(label: str, period: int, finer: int, change: float, watched: Watched | None) -> str:
    """What a speed's class, its periods (0: not periodic) in the two runs and the change of its RMS say."""
    agreed = finer if watched is None else watched.period
    if agreed is None:
        return "sensitive"
    if period == agreed:
        close = "converged" if change <= CONVERGED else "moved"
        return close if period else "irregular"
    if period:
        return "wrong"
    return label if label == Motion.NOT_SETTLED.value else "transient"


def not_converged(table: pd.DataFrame) -> str:
    """Counts of the verdicts, and the speeds where they are not what one hopes for."""
    verdicts = table["verdict"].value_counts()
    counts = ", ".join(f"{count} speeds {verdict}" for verdict, count in verdicts.items())
    odd = table[~table["verdict"].isin(["converged", "irregular", Motion.NOT_SETTLED.value])]
    places = [
        f"{row.direction} {row.speed_rpm:.0f} rpm {row.verdict} ({row['class']}, finer "
        f"{row.watched_longer or row.class_finer}, {100.0 * row.rms_change:.2g} %)"
        for _, row in odd.iterrows()
    ]
    return "\n".join([counts, *places])
