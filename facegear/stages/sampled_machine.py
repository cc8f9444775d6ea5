"""One machine with its tolerances: its samples by number, and what each is judged by."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from facegear.config.lumped_model import wired_layout
from facegear.config.tolerances import Tolerances, population
from facegear.config.variants import movable, moved, variable_part
from facegear.load_sharing.quantity_names import quantity_names
from facegear.progress import Progress
from facegear.scenarios.chunks import Evaluate, run_chunk
from facegear.scenarios.sampling import Population, changes
from facegear.stages.many_machines import Judge, Question, judge
from facegear.stages.tooth_meshes import Flanks, tooth_meshes


@dataclass(frozen=True, eq=False)
class SampledMachine:
    """Causes, the nominal values that they move, what a machine is judged by, and the names of that."""

    causes: Population
    start: Mapping[str, Any]
    judge: Judge
    names: tuple[str, ...]

    def sample(self, values: Sequence[float]) -> dict[str, Any]:
        """The variable part of the config of a sample with these values of its causes."""
        return moved(self.start, changes(self.causes, values))


def sampled_machine(
    section: Tolerances,
    harmonics: pd.DataFrame,
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    accuracy: Mapping[str, Any],
    speed_rpm: float,
    options: Mapping[str, Any],
    pair: Mapping[str, Any] | None,
    flanks: Flanks | None,
) -> SampledMachine:
    """With `pair`, the sections that contact needs, and `flanks`, the compliance of its bodies, every tooth
    pair that differs is put into contact; without, all have the stiffness of `harmonics`.
    """
    causes = population(section)
    start = movable(
        variable_part(transmission, pair["tooth_pair"] if pair else teeth, speed_rpm),
        [key for cause in causes.causes for key, _ in cause.gains],
    )
    question = Question(section.model, section.hunting_cycles, accuracy, options)
    gauges = pair is not None and pair["contact"]["root_stress"]
    shape = wired_layout(start["transmission"], teeth)
    return SampledMachine(
        causes=causes,
        start=start,
        judge=judge(question, tooth_meshes(harmonics, pair, flanks or {}), "this sample"),
        names=quantity_names(shape, question.dynamic, pair is not None, gauges),
    )


def run_samples(
    evaluate: Evaluate,
    numbers: range,
    names: tuple[str, ...],
    partial: str | Path | None,
    same: str,
    progress: Progress,
) -> pd.DataFrame:
    """`run_chunk` with a record that is thrown away where `partial` is None."""
    if partial is not None:
        return run_chunk(evaluate, numbers, names, partial, same, progress.step)
    with TemporaryDirectory() as folder:
        return run_chunk(evaluate, numbers, names, Path(folder) / "partial", same, progress.step)
