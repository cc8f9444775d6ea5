"""A chunk of samples of one machine with its tolerances."""

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from facegear.config.base import parse
from facegear.config.lumped_model import wired_layout
from facegear.config.tolerances import Design, Tolerances, population
from facegear.config.variants import movable, moved, variable_part
from facegear.load_sharing.quantity_names import quantity_names
from facegear.progress import Progress
from facegear.scenarios.chunks import Evaluate, identity, run_chunk
from facegear.scenarios.sampling import changes, index_samples, samples
from facegear.stages.many_machines import Question, judge
from facegear.stages.outcome import Outcome
from facegear.stages.tooth_meshes import Flanks, tooth_meshes


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

    With `pair`, the sections that contact needs, and `flanks`, the compliance of its bodies, every tooth pair
    that differs is put into contact; without, all have the stiffness of `harmonics`. A sample that cannot be
    built or computed is a row with its error. `partial` is a file that keeps finished samples, so that a
    killed chunk goes on after its last one; it counts only for the same config and `code`.
    """
    section = parse(Tolerances, tolerances)
    causes = population(section)
    draw = samples if design == "samples" else index_samples
    values = draw(causes, first, last - first + 1)
    start = movable(
        variable_part(transmission, pair["tooth_pair"] if pair else teeth, speed_rpm),
        [key for cause in causes.causes for key, _ in cause.gains],
    )
    question = Question(section.model, section.hunting_cycles, accuracy, options)
    ask = judge(question, tooth_meshes(harmonics, pair, flanks or {}), "this sample")
    gauges = pair is not None and pair["contact"]["root_stress"]
    shape = wired_layout(start["transmission"], teeth)
    names = quantity_names(shape, question.dynamic, pair is not None, gauges)

    def evaluate(number: int) -> dict[str, float]:
        return ask(moved(start, changes(causes, values[number - first])))

    same = identity(
        *(design, transmission, teeth, accuracy, speed_rpm, options, tolerances, pair),
        *(harmonics.to_csv(), code),
    )
    progress = Progress(f"{design} {first} to {last}", len(values))
    frame = _run(evaluate, range(first, last + 1), names, partial, same, progress)
    for place, name in enumerate(causes.names):
        frame.insert(1 + place, name, values[:, place])
    failed = int((frame["error"] != "").sum())
    return Outcome({"chunk": frame}, f"{len(frame)} samples, {failed} of them cannot be built or computed")


def _run(
    evaluate: Evaluate,
    numbers: range,
    names: tuple[str, ...],
    partial: str | Path | None,
    same: str,
    progress: Progress,
) -> pd.DataFrame:
    if partial is not None:
        return run_chunk(evaluate, numbers, names, partial, same, progress.step)
    with TemporaryDirectory() as folder:
        return run_chunk(evaluate, numbers, names, Path(folder) / "partial", same, progress.step)
