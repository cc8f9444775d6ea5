"""One machine with its tolerances: its samples by number, and what each is judged by."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import nan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from facegear.config.changes import movable, moved, variable_part
from facegear.config.lumped_model import wired_layout
from facegear.config.tolerances import Tolerances, population
from facegear.load_sharing.quantity_names import K_GAMMA, MISSED, OPEN, REVERSED, columns_of
from facegear.progress import Progress
from facegear.scenarios.chunks import Evaluate, run_chunk
from facegear.scenarios.sampling import Population, changes
from facegear.variants.machines import WHOLE, Judge, Question, VariedMachine, judge
from facegear.variants.teeth import Values

CHECKED = 8
"""Number of samples that are computed over the whole hunting cycle as well."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SampledMachine(VariedMachine):
    """The machine with its tolerances, as plain config values: what the stages of its samples are given."""

    tolerances: Values
    teeth: Values

    @cached_property
    def section(self) -> Tolerances:
        """Its tolerances."""
        return Tolerances.of_config(self.tolerances)

    @cached_property
    def causes(self) -> Population:
        """What moves its values."""
        return population(self.section)

    @cached_property
    def start(self) -> dict[str, Any]:
        """The nominal values that the causes move."""
        teeth = self.pair["tooth_pair"] if self.pair else self.teeth
        keys = [key for cause in self.causes.causes for key, _ in cause.gains]
        return movable(variable_part(self.transmission, teeth, self.speed_rpm), keys)

    @property
    def question(self) -> Question:
        """How a sample is judged."""
        return Question(self.section.model, self.section.hunting_cycles, self.accuracy, self.options)

    @cached_property
    def judge(self) -> Judge:
        """What a sample is judged by, given its values."""
        return judge(self.question, self.meshes, "this sample")

    def sample(self, values: Sequence[float]) -> dict[str, Any]:
        """The variable part of the config of a sample with these values of its causes."""
        return moved(self.start, changes(self.causes, values))

    @cached_property
    def whole_judge(self) -> Judge:
        """The same over the whole hunting cycle."""
        return judge(replace(self.question, cycles=WHOLE), self.meshes, "this sample")

    def judged(self, sample: Mapping[str, Any], check: bool) -> dict[str, float]:
        """What a sample is judged by, and in the columns MISSED what its mesh cycles miss.

        The columns MISSED are nan unless `check` asks for the whole hunting cycle as well.
        """
        found = self.judge(sample)
        if not check:
            return found | dict.fromkeys(MISSED.values(), nan)
        whole = self.whole_judge(sample)
        paths = columns_of(f"{K_GAMMA} ", list(whole))
        missed = {name: whole[name] - found[name] for name in (OPEN, REVERSED)}
        ratios = (whole[name] / found[name] - 1.0 for name in paths if found[name] > 0.0)
        missed[K_GAMMA] = max(ratios, default=nan)
        return found | {MISSED[name]: value for name, value in missed.items()}

    def run(
        self,
        evaluate: Evaluate,
        numbers: range,
        told: str,
        partial: str | Path | None,
        *same: object,
        more: Sequence[str] = (),
    ) -> pd.DataFrame:
        """Rows of `run_chunk`, kept in `partial` for this machine and what else must be the `same`.

        `told` names them to who waits; where `partial` is None nothing is kept. `more`: further columns.
        """
        layout = wired_layout(self.start["transmission"], self.teeth)
        names = [*self.columns(layout, self.question), *more]
        known, progress = self.identity(*same), Progress(told, len(numbers))
        with TemporaryDirectory() as folder:
            kept = Path(folder) / "partial" if partial is None else partial
            return run_chunk(evaluate, numbers, names, kept, known, progress.step)
