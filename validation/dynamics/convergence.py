"""Check whether a sweep is converged: each speed once more, with all discretisation finer."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers
from facegear.motion.plan import Motion, Settings, State
from facegear.motion.steady_state.averages import Averages
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.steady_state.simulate import Model
from facegear.motion.sweeps.sweep import Piece, collect, join_pieces, run_speeds, tighter

MAX_CHANGE = 1e-3
"""Relative change of the RMS up to which a speed counts as converged."""
SAMPLES = 4096
"""Samples of a mesh period in the finer run."""
LONG = 8192
"""Mesh periods of the long runs of a motion whose class is not the same in both runs."""
FEW = 16
"""Periods on which such a motion is measured where it stays irregular: only its class is needed."""


def rerun(model: Model, piece: Piece, settings: Settings, step: Callable[[], None] = lambda: None) -> Piece:
    """Run every speed of a sweep again, from the state that the sweep left there, and far finer.

    All that is discretised varies: the tolerance of the steps and their order, the residual of a closed
    orbit, and the samples, from which alone the moments of this run are taken (`sampled_response`). A motion
    that is not periodic is run again with half the tolerance and over more periods, to see whether its class
    holds. A finer sweep carried through would also choose other branches after irregular motion, which says
    nothing about the accuracy of either.

    Parameters
    ----------
    model : Model
        Model of the machine.
    piece : Piece
        The sweep.
    settings : Settings
        Settings of the sweep.
    step : Callable[[], None]
        Called after each speed.

    Returns
    -------
    Piece
        The finer run.
    """
    again = []
    for i, period in enumerate(piece.period):
        finer = exact(settings) if period else tighter(settings)
        responses = run_speeds(model, piece.speeds[i : i + 1], finer, piece.state(i), step)
        again.append(collect(model, (sampled_response(response) for response in responses)))
    return join_pieces(again)


def exact(settings: Settings) -> Settings:
    """Return the settings of the reference of a periodic motion: 1e-10 and 4096 samples a period.

    Parameters
    ----------
    settings : Settings
        Settings of the sweep.

    Returns
    -------
    Settings
        Finer settings.
    """
    return replace(settings, tolerance=1e-10, order=None, periodic_residual=1e-9, samples=SAMPLES)


def sampled_response(speed_and_response: tuple[float, SteadyState]) -> tuple[float, SteadyState]:
    """Return a response whose averages come from its samples and not from the step polynomials.

    Parameters
    ----------
    speed_and_response : tuple[float, SteadyState]
        Speed in rpm, and response.

    Returns
    -------
    tuple[float, SteadyState]
        The same speed in rpm, and the response with new averages.
    """
    speed, response = speed_and_response
    averages = sample_averages(response.averages, response.deflections, response.forces, response.per_period)
    return speed, replace(response, averages=averages)


def sample_averages(averages: Averages, deflections: Array, forces: Array, per_period: int) -> Averages:
    """Return averages with those of the meshes from samples over whole periods.

    Parameters
    ----------
    averages : Averages
        Averages from the step polynomials.
    deflections : (K, M) array
        Mesh deflections, m.
    forces : (K, M) array
        Mesh forces, N.
    per_period : int
        Number of samples in a period.

    Returns
    -------
    Averages
        The averages.
    """
    periods = len(deflections) // per_period
    batch = np.arange(periods) * len(averages.weight) // periods
    by_period = deflections.reshape(periods, per_period, -1)

    def batches(values: Array) -> Array:
        sums = np.zeros((len(averages.weight), values.shape[2]))
        np.add.at(sums, batch, values.mean(axis=1))
        return sums / averages.weight[:, None]

    return replace(
        averages,
        level=np.zeros(deflections.shape[1]),
        deflection=batches(by_period),
        square=batches(by_period**2),
        minimum=deflections.min(axis=0),
        maximum=deflections.max(axis=0),
        force=np.array([forces.mean(axis=0), np.abs(forces).mean(axis=0)]),
    )


@dataclass(frozen=True, eq=False)
class LongRuns:
    """Long runs of a speed at the sweep's tolerance and at 1e-10, each from the ends of both runs.

    `labels` (4,): classes in this order. `period`: the period of all four, 0 if none is periodic, None if
    they differ. `ac_rms` (M,): AC RMS of the mesh deflections, m, at 1e-10 from the sweep's own state.
    """

    labels: tuple[str, ...]
    period: int | None
    ac_rms: Array


def watched_longer(model: Model, piece: Piece, finer: Piece, settings: Settings) -> dict[int, LongRuns]:
    """Run the speeds for longer that are periodic in one of two runs only, or with another period.

    Parameters
    ----------
    model : Model
        Model of the machine.
    piece : Piece
        The sweep.
    finer : Piece
        The finer run.
    settings : Settings
        Settings of the sweep.

    Returns
    -------
    dict[int, LongRuns]
        Long runs by index of the speed.
    """
    long = replace(settings, settle=LONG, window=FEW)
    return {
        int(i): _run_longer(model, piece.speeds[i : i + 1], long, [piece.state(int(i)), finer.state(int(i))])
        for i in np.flatnonzero(piece.period != finer.period)
    }


def _run_longer(model: Model, speed: Array, settings: Settings, starts: list[State]) -> LongRuns:
    runs = [
        run_speeds(model, speed, run_settings, start)
        for run_settings in (settings, exact(settings))
        for start in starts
    ]
    pieces = [collect(model, (sampled_response(response) for response in run)) for run in runs]
    periods = {int(piece.period[0]) for piece in pieces}
    return LongRuns(
        labels=tuple(piece.labels[0] for piece in pieces),
        period=periods.pop() if len(periods) == 1 else None,
        ac_rms=pieces[len(starts)].deflection_ac_rms[0],
    )


def convergence_table(
    direction: str, piece: Piece, finer: Piece, long_runs: Mapping[int, LongRuns], images: Integers
) -> pd.DataFrame:
    """Judge each speed of a sweep.

    Columns direction, speed_rpm, class, class_finer, watched_longer, multiplier, multiplier_finer,
    rms_change, verdict.

    rms_change: largest change of a mesh's AC RMS over the largest AC RMS at that speed, against the nearest
    of the images (images, meshes) by which symmetries of the machine exchange meshes; the multipliers are the
    leading ones of refined orbits. watched_longer: the four classes of `watched_longer`, where the two runs
    do not agree. Verdicts:

    - `converged`, `moved`: the same periodic motion in both runs, or in all four long runs where the finer
    one
      had not settled; within 1e-3 or not.
    - `irregular`: periodic in neither run, or in none of the four.
    - `not settled`: so named by the sweep, which claims nothing; one periodic motion in all four.
    - `transient`: chaotic or quasi-periodic in the sweep, one periodic motion in all four.
    - `sensitive`: the four differ, so that the class depends on the tolerance or on where in the motion the
    run
      begins.
    - `wrong`: named periodic, and something else in all four.

    Parameters
    ----------
    direction : str
        Direction of the sweep.
    piece : Piece
        The sweep.
    finer : Piece
        The finer run.
    long_runs : Mapping[int, LongRuns]
        Long runs by index of the speed.
    images : (images, meshes) array of int
        Indices of the meshes in each image of the machine.

    Returns
    -------
    DataFrame
        One row for each speed.
    """
    exact_rms = finer.deflection_ac_rms.copy()
    for i, pieces in long_runs.items():
        exact_rms[i] = pieces.ac_rms
    first = piece.deflection_ac_rms
    apart = np.abs(first[:, None] - exact_rms[:, images]).max(axis=2).min(axis=1)
    change = apart / np.maximum(first.max(axis=1), 1e-300)
    verdicts = [
        _verdict(label, int(piece.period[i]), int(finer.period[i]), change[i], long_runs.get(i))
        for i, label in enumerate(piece.labels)
    ]
    labels = ["; ".join(long_runs[i].labels) if i in long_runs else "" for i in range(len(change))]
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


def _verdict(label: str, period: int, finer: int, change: float, long_runs: LongRuns | None) -> str:
    """Judge a speed by its class, its periods (0: not periodic) in the two runs and the change of its RMS."""
    common_period = finer if long_runs is None else long_runs.period
    if common_period is None:
        return "sensitive"
    if period == common_period:
        close = "converged" if change <= MAX_CHANGE else "moved"
        return close if period else "irregular"
    if period:
        return "wrong"
    return label if label == Motion.NOT_SETTLED.value else "transient"


def not_converged(table: pd.DataFrame) -> str:
    """Count the verdicts, and list the speeds where they are neither converged, irregular nor not settled.

    Parameters
    ----------
    table : DataFrame
        Table of `convergence_table`.

    Returns
    -------
    str
        The text.
    """
    verdicts = table["verdict"].value_counts()
    counts = ", ".join(f"{count} speeds {verdict}" for verdict, count in verdicts.items())
    odd = table[~table["verdict"].isin(["converged", "irregular", Motion.NOT_SETTLED.value])]
    exceptions = [
        f"{row.direction} {row.speed_rpm:.0f} rpm {row.verdict} ({row['class']}, finer "
        f"{row.watched_longer or row.class_finer}, {100.0 * row.rms_change:.2g} %)"
        for _, row in odd.iterrows()
    ]
    return "\n".join([counts, *exceptions])
