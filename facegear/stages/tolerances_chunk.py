"""A chunk of samples of one machine with its tolerances."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.config.base import parse
from facegear.config.tolerances import Design, Tolerances
from facegear.progress import Progress
from facegear.scenarios.chunks import identity
from facegear.scenarios.sampling import index_samples, samples
from facegear.stages.outcome import Outcome
from facegear.stages.sampled_machine import run_samples, sampled_machine
from facegear.stages.tooth_meshes import Flanks


def tolerances_chunk(
    design: Design,
    first: int,
    last: int,
    harmonics: pd.DataFrame,
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    accuracy: Mapping[str, Any],
    speed_rpm: float,
    options: Mapping[str, Any],
    tolerances: Mapping[str, Any],
    pair: Mapping[str, Any] | None = None,
    flanks: Flanks | None = None,
    partial: str | Path | None = None,
    code: str = "",
) -> Outcome:
    """`chunk` (table): samples `first` to `last`, the values of their causes, what was found, the error.

    `pair` and `flanks` as of `sampled_machine`. A sample that cannot be built or computed is a row with its
    error. `partial` is a file that keeps finished samples, so that a killed chunk goes on after its last one;
    it counts only for the same config and `code`.
    """
    section = parse(Tolerances, tolerances)
    given = transmission, teeth, accuracy, speed_rpm, options, pair
    machine = sampled_machine(section, harmonics, *given, flanks)
    draw = samples if design == "samples" else index_samples
    values = draw(machine.causes, first, last - first + 1)

    def evaluate(number: int) -> dict[str, float]:
        return machine.judge(machine.sample(values[number - first]))

    same = identity(design, *given, tolerances, harmonics.to_csv(), code)
    progress = Progress(f"{design} {first} to {last}", len(values))
    frame = run_samples(evaluate, range(first, last + 1), machine.names, partial, same, progress)
    for place, name in enumerate(machine.causes.names):
        frame.insert(1 + place, name, values[:, place])
    failed = int((frame["error"] != "").sum())
    return Outcome({"chunk": frame}, f"{len(frame)} samples, {failed} of them cannot be built or computed")
