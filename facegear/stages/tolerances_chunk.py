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
    **given: Any,
) -> Outcome:
    """`chunk` (table): samples `first` to `last`, the values of their causes, what was found, the error.

    A sample that cannot be built or computed is a row with its error. `partial` is a file that keeps finished
    samples, so that a killed chunk goes on after its last one; it counts only for the same config and `code`.
    The columns MISSED hold, for the first CHECKED_SAMPLES samples, what the mesh cycles taken miss, and
    SIMPLIFIED what the few points miss that friction is taken at; they are empty else.
    `given`: fields of SampledMachine.
    """
    return chunk_of(SampledMachine.of_stage(**given), design, first, last, partial, code)


def chunk_of(
    machine: SampledMachine,
    design: Design,
    first: int,
    last: int,
    partial: str | Path | None = None,
    code: str = "",
) -> Outcome:
    """`tolerances_chunk` of a machine in memory."""
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
    failed = int((frame["error"] != "").sum())
    return Outcome(
        {"chunk": frame}, f"{count_noun(len(frame), 'sample')}, {failed} of them cannot be built or computed"
    )
