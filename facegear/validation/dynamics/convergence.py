"""Is a sweep converged: each speed once more with everything finer that is discretised."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.averages import Averages
from facegear.dynamics.steady_state.simulate import Model, SteadyState
from facegear.dynamics.sweeps.sweep import Piece, collect, joined, run_speeds, tighter

Array = NDArray[np.float64]
CONVERGED = 1e-3
SAMPLES = 4096


def rerun(model: Model, piece: Piece, settings: Settings, step: Callable[[], None] = lambda: None) -> Piece:
    """Every speed of a sweep again, from the state that the sweep left there, and far finer.

    All that is discretised varies: the tolerance of the steps and their order, what counts as closed, and the
    samples, from which alone the moments of this run are taken (`sampled_piece`). What is not periodic is run
    again with half the tolerance and a longer watch, to see whether its class holds. A finer sweep carried
    through would also choose other branches after irregular motion, which says nothing about the accuracy of
    either.
    """
    again = []
    for i, period in enumerate(piece.period):
        finer = exact(settings) if period else tighter(settings)
        responses = run_speeds(model, piece.speeds[i : i + 1], finer, piece.state(i), step)
        again.append(collect(model, (sampled_response(found) for found in responses)))
    return joined(again)


def exact(settings: Settings) -> Settings:
    """What a periodic motion is held against: 1e-10 and 4096 samples a period."""
    return replace(settings, tolerance=1e-10, order=None, periodic_residual=1e-9, samples=SAMPLES)


def sampled_response(found: tuple[float, SteadyState]) -> tuple[float, SteadyState]:
    """A response whose averages come from its samples and not from the step polynomials."""
    speed, response = found
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
        lowest=deflections.min(axis=0),
        highest=deflections.max(axis=0),
        force=np.array([forces.mean(axis=0), np.abs(forces).mean(axis=0)]),
    )


def convergence_table(direction: str, piece: Piece, finer: Piece) -> pd.DataFrame:
    """One row for each speed: direction, speed_rpm, class, class_finer, multiplier, multiplier_finer,
    rms_change, verdict.

    rms_change: largest change of a mesh's AC RMS over the largest AC RMS at that speed; the multipliers are
    the leading ones of refined orbits. Verdicts: `converged`; `moved` (same class, more than 1e-3);
    `other class` (periodic in one of the two, or with another period); `irregular` (periodic in neither).
    """
    first, second = piece.deflection_ac_rms, finer.deflection_ac_rms
    change = np.abs(first - second).max(axis=1) / np.maximum(first.max(axis=1), 1e-300)
    verdicts = [_verdict(a, b, c) for a, b, c in zip(piece.period, finer.period, change, strict=True)]
    return pd.DataFrame(
        {
            "direction": direction,
            "speed_rpm": piece.speeds,
            "class": piece.labels,
            "class_finer": finer.labels,
            "multiplier": piece.leading_multiplier,
            "multiplier_finer": finer.leading_multiplier,
            "rms_change": change,
            "verdict": verdicts,
        }
    )


def _verdict(period: int, finer: int, change: float) -> str:
    """What a speed's periods (0: not periodic) in the two runs and the change of its RMS say."""
    if not period and not finer:
        return "irregular"
    if period != finer:
        return "other class"
    return "converged" if change <= CONVERGED else "moved"


def not_converged(table: pd.DataFrame) -> str:
    """Counts of the verdicts, and the speeds that moved or changed their class."""
    found = table["verdict"].value_counts()
    counts = ", ".join(f"{count} speeds {verdict}" for verdict, count in found.items())
    odd = table[table["verdict"].isin(["moved", "other class"])]
    places = [
        f"{row.direction} {row.speed_rpm:.0f} rpm ({row['class']}, finer {row.class_finer}, "
        f"{100.0 * row.rms_change:.2g} %)"
        for _, row in odd.iterrows()
    ]
    return "; ".join([counts, *places])
