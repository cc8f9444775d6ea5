"""A chunk of samples of one machine with its tolerances."""

from pathlib import Path
from typing import Any

from facegear.config.tolerances import Design
from facegear.number_format import count_noun
from facegear.scenarios.sampling import index_samples, samples
from facegear.stages.outcome import Outcome
from facegear.variants.sampled_machine import CHECKED_SAMPLES, SampledMachine


def tolerances_chunk(
    design: Design,
    first: int,
    last: int,
    partial: str | Path | None = None,
    code: str = "",
    **machine_fields: Any,
) -> Outcome:
    """Compute samples `first` to `last` of a machine with its tolerances.

    A sample that cannot be built or computed is a row with its error. The columns MISSED hold, for the first
    CHECKED_SAMPLES samples, what the mesh cycles taken miss; SIMPLIFIED what is missed by the few points of
    the contact that friction is taken at. They are empty in other rows.

    Parameters
    ----------
    design : Design
        `samples`, or `indices` for those of the sensitivity indices.
    first : int
        Number of the first sample.
    last : int
        Number of the last sample.
    partial : str or Path or None
        File that keeps finished rows, so that a killed run resumes after its last one; None keeps none.
    code : str
        Identity of the code; rows in `partial` count only for the same config and code.
    **machine_fields : Any
        Fields of SampledMachine.

    Returns
    -------
    Outcome
        Table `chunk`: values of the causes of each sample, the computed quantities, the error.
    """
    return chunk_of(SampledMachine.of_stage(**machine_fields), design, first, last, partial, code)


def chunk_of(
    machine: SampledMachine,
    design: Design,
    first: int,
    last: int,
    partial: str | Path | None = None,
    code: str = "",
) -> Outcome:
    """Compute `tolerances_chunk` of a machine in memory.

    Parameters
    ----------
    machine : SampledMachine
        Machine with its tolerances.
    design : Design
        `samples`, or `indices` for those of the sensitivity indices.
    first : int
        Number of the first sample.
    last : int
        Number of the last sample.
    partial : str or Path or None
        File that keeps finished rows, so that a killed run resumes after its last one; None keeps none.
    code : str
        Identity of the code; rows in `partial` count only for the same config and code.

    Returns
    -------
    Outcome
        Table `chunk`: values of the causes of each sample, the computed quantities, the error.
    """
    draw = samples if design == "samples" else index_samples
    values = draw(machine.causes, first, last - first + 1)

    def evaluate(number: int) -> dict[str, float]:
        return machine.judge_sample(
            machine.sample(values[number - first]), design == "samples" and number < CHECKED_SAMPLES
        )

    label = f"{design} {first} to {last}"
    frame = machine.run(evaluate, range(first, last + 1), label, partial, design, code)
    for column, name in enumerate(machine.causes.names):
        frame.insert(1 + column, name, values[:, column])
    failure_count = int((frame["error"] != "").sum())
    return Outcome(
        {"chunk": frame},
        f"{count_noun(len(frame), 'sample')}, {failure_count} of them cannot be built or computed",
    )
