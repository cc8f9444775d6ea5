"""The whole sweep from its chunks: table, jumps, resonances, seams, waterfall."""

from collections.abc import Iterable, Mapping

import pandas as pd

from facegear.arrays import AnyArray, Arrays
from facegear.config.dynamics import Sweep, sweep_plan
from facegear.dynamics.steady_state.simulate import build_model
from facegear.dynamics.steady_state.spectra import ORDERS
from facegear.dynamics.sweeps.chunk_arrays import from_arrays
from facegear.dynamics.sweeps.summary import sweep_summary
from facegear.dynamics.sweeps.sweep_tables import jump_table, resonance_table, seam_table, sweep_table
from facegear.dynamics.sweeps.whole_sweep import Direction, whole_sweep
from facegear.stages.outcome import Outcome
from facegear.transmission.loaded_modes import loaded_modes
from facegear.transmission.machine import Machine


def dynamics_sweep(
    chunks: Iterable[Arrays],
    machine: Machine,
    sweep: Sweep,
    threads: int = 1,
) -> Outcome:
    """Join the chunks of a sweep.

    Parameters
    ----------
    chunks : Iterable[Arrays]
        Arrays of all chunks, direction by direction in the order of the config.
    machine : Machine
        The machine.
    sweep : Sweep
        Section `sweep` of the config.
    threads : int
        Number of threads.

    Returns
    -------
    Outcome
        Tables `sweep`, `jumps`, `resonances` and `seams`, arrays `waterfall`.
    """
    model = build_model(machine)
    plan, layout = sweep_plan(sweep), model.machine.layout
    chunk_arrays = iter(chunks)
    pieces = {name: [from_arrays(next(chunk_arrays)) for _ in range(plan.chunks)] for name in plan.directions}
    directions = whole_sweep(model, plan, pieces, threads)
    modes = loaded_modes(model.machine)
    content = {
        "sweep": pd.concat([sweep_table(layout, n, d.piece) for n, d in directions.items()]),
        "jumps": pd.concat([jump_table(layout, n, d, modes) for n, d in directions.items()]),
        "resonances": pd.concat([resonance_table(layout, n, d.piece, modes) for n, d in directions.items()]),
        "seams": seam_table([seam for d in directions.values() for seam in d.seams]),
        "waterfall": _waterfall(directions),
    }
    return Outcome(content, sweep_summary(directions))


def _waterfall(directions: Mapping[str, Direction]) -> dict[str, AnyArray]:
    arrays = {"orders": ORDERS}
    for name, direction in directions.items():
        arrays[f"{name}_speed_rpm"] = direction.piece.speeds
        arrays[f"{name}_amplitude_m"] = direction.piece.spectrum
    return arrays
