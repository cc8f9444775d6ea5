"""One chunk of a speed sweep in one direction."""

from facegear.config.dynamics import Sweep, sweep_plan
from facegear.dynamics.steady_state.simulate import build_model
from facegear.dynamics.sweeps.chunk_arrays import to_arrays
from facegear.dynamics.sweeps.sweep import run_chunk
from facegear.number_format import count_noun
from facegear.progress import Progress
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine


def dynamics_sweep_chunk(
    direction: str,
    number: int,
    machine: Machine,
    sweep: Sweep,
) -> Outcome:
    """Compute one chunk of a sweep.

    Parameters
    ----------
    direction : str
        Direction of the sweep, `up` or `down`.
    number : int
        Number of the chunk.
    machine : Machine
        The machine.
    sweep : Sweep
        Section `sweep` of the config.

    Returns
    -------
    Outcome
        Arrays `chunk`.

    Raises
    ------
    NotConverged
        Naming the speed.
    """
    plan = sweep_plan(sweep)
    total = sum(map(len, plan.chunk(direction, number)))
    progress = Progress(f"sweep {direction}, chunk {number}", total)
    model = build_model(machine)
    before, piece = run_chunk(model, plan, direction, number, progress.step)
    summary = f"{count_noun(len(piece.speeds), 'speed')} {direction}, {len(before.speeds)} for overlap"
    return Outcome({"chunk": to_arrays(before, piece)}, summary)
