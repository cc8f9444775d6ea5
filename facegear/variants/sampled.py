"""One machine with its tolerances: its samples by number, and what each is judged by."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from math import nan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.base import parse
from facegear.config.changes import movable, moved, variable_part
from facegear.config.lubrication import LubricationSection
from facegear.config.machine_layout import wired_layout
from facegear.config.tolerances import Tolerances, population
from facegear.config.tooth_pair import ToothPair
from facegear.errors import FacegearError
from facegear.load_sharing.quantity_names import (
    BULK,
    CYCLE_SELECTION_ERRORS,
    K_GAMMA,
    OPEN_FRACTION,
    REVERSED_FRACTION,
    SIMPLIFICATION_ERRORS,
    matching_names,
)
from facegear.progress import Progress
from facegear.scenarios.chunks import Evaluate, run_chunk
from facegear.scenarios.sampling import Population, changes, samples
from facegear.variants.machines import WHOLE, Judge, Question, VariedMachine, tooth_meshes
from facegear.variants.teeth import Meshes, Values

CHECKED = 8
"""Number of samples that are computed over the whole hunting cycle, and by all places of the contact, too."""
STATES = 16
"""Machines over whose lubrication and speed the contact is reduced to few places."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SampledMachine(VariedMachine):
    """The machine with its tolerances, as plain config values: what the stages of its samples are given.

    With `lubricated`, the sections lubrication and tooth_pair, friction is judged too: by `ltca` and
    `pressure` of stage contact, unless each sample has a contact of its own.
    """

    tolerances: Values
    teeth: Values
    lubricated: Values | None = None
    ltca: pd.DataFrame | None = None
    pressure: Arrays | None = None

    @property
    def friction(self) -> bool:
        """Whether friction is asked for."""
        return self.lubricated is not None

    @cached_property
    def meshes(self) -> Meshes:
        """The mesh of each one's tooth pair, lubricated where friction is asked for."""
        if self.lubricated is None:
            return super().meshes
        from facegear.variants.rubbed_teeth import rubbing  # only friction needs it

        rub = rubbing(self.lubricated_states)
        rubbed = None
        if self.ltca is not None and self.pressure is not None:
            section = ToothPair.of_config(self.lubricated["tooth_pair"])
            rubbed = rub(self.ltca, self.pressure, section)
        return tooth_meshes(self.harmonics, self.pair, self.flanks, self.law, rub, rubbed)

    @cached_property
    def lubricated_states(self) -> list[tuple[LubricationSection, float]]:
        """Lubrication and speed (rpm) of STATES machines that are none of the samples, where they can be."""
        others = replace(self.causes, seed=self.section.seed + 1)
        asked = self.section.load_map
        speeds = [speed for _, speed in asked.loads(self.speed_rpm)] if asked else [self.speed_rpm]
        states = []
        for number, values in enumerate(samples(others, 0, STATES)):
            sample = self.sample(values)
            speed = (self.speed_rpm, min(speeds), max(speeds))[number % 3]
            off = sample["dynamics"]["speed_rpm"] - self.speed_rpm
            with suppress(FacegearError):
                section = parse(LubricationSection, sample["lubrication"], "this sample")
                states.append((section, speed + off))
        return states or [(LubricationSection.of_config(self.start["lubrication"]), self.speed_rpm)]

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
        oil = self.lubricated["lubrication"] if self.lubricated else None
        return movable(variable_part(self.transmission, teeth, self.speed_rpm, oil), keys)

    @property
    def question(self) -> Question:
        """How a sample is judged."""
        return Question(self.section.model, self.section.hunting_cycles, self.accuracy, self.options)

    @cached_property
    def judge(self) -> Judge:
        """What a sample is judged by, given its values."""
        return self.judge_near(self.start)

    def judge_near(self, nominal: Values) -> Judge:
        """The same of samples that differ from these values by their causes alone."""
        return self.judge_of(self.question, "this sample", nominal)

    def sample(self, values: Sequence[float]) -> dict[str, Any]:
        """The variable part of the config of a sample with these values of its causes."""
        return moved(self.start, changes(self.causes, values))

    @cached_property
    def whole_judge(self) -> Judge:
        """The same over the whole hunting cycle."""
        return self.judge_of(replace(self.question, cycles=WHOLE), "this sample")

    @cached_property
    def thorough_judge(self) -> Judge:
        """The same by every place of the contact."""
        return self.judge_of(replace(self.question, every_place=True), "this sample", self.start)

    @property
    def checks(self) -> tuple[str, ...]:
        """Columns that say what a sample misses, of the first CHECKED samples."""
        hunting = () if self.question.dynamic else tuple(CYCLE_SELECTION_ERRORS.values())
        return (*hunting, *(SIMPLIFICATION_ERRORS.values() if self.friction else ()))

    def judged(self, sample: Values, check: bool, judge: Judge | None = None) -> dict[str, float]:
        """What a sample is judged by, and in the columns `checks` what it misses; nan unless `check`.

        judge: that of samples near other values than `start`.
        """
        values = (judge or self.judge)(sample)
        if not check:
            return values | dict.fromkeys(self.checks, nan)
        missed = {} if self.question.dynamic else self._missed(sample, values)
        return values | missed | (self._simplified(sample, values) if self.friction else {})

    def _simplified(self, sample: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, float]:
        """What the few places of the contact miss: columns SIMPLIFIED."""
        whole = self.thorough_judge(sample)
        off = {
            name: values[name] / whole[name] - 1.0 if whole[name] else nan for name in SIMPLIFICATION_ERRORS
        }
        off[BULK] = values[BULK] - whole[BULK]
        return {column: off[name] for name, column in SIMPLIFICATION_ERRORS.items()}

    def _missed(self, sample: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, float]:
        """What the mesh cycles taken miss: columns MISSED."""
        whole = self.whole_judge(sample)
        paths = matching_names(f"{K_GAMMA} ", list(whole))
        missed = {name: whole[name] - values[name] for name in (OPEN_FRACTION, REVERSED_FRACTION)}
        ratios = (whole[name] / values[name] - 1.0 for name in paths if values[name] > 0.0)
        missed[K_GAMMA] = max(ratios, default=nan)
        return {CYCLE_SELECTION_ERRORS[name]: value for name, value in missed.items()}

    def run(
        self,
        evaluate: Evaluate,
        numbers: range,
        label: str,
        partial: str | Path | None,
        *same: object,
    ) -> pd.DataFrame:
        """Rows of `run_chunk`, kept in `partial` for this machine and what else must be the `same`.

        `label` names them to who waits; where `partial` is None nothing is kept. Columns `checks` come last.
        """
        layout = wired_layout(self.start["transmission"], self.teeth)
        names = [*self.columns(layout, self.question), *self.checks]
        known, progress = self.identity(*same), Progress(label, len(numbers))
        with TemporaryDirectory() as folder:
            kept = Path(folder) / "partial" if partial is None else partial
            return run_chunk(evaluate, numbers, names, kept, known, progress.step)
