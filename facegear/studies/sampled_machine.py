"""One machine with its tolerances: its samples by number, and their quantities."""

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
from facegear.build.machine_layout import wired_layout
from facegear.build.tooth_pair import ToothPair
from facegear.errors import FacegearError
from facegear.progress import Progress
from facegear.quantities import (
    BULK,
    CYCLE_SELECTION_ERRORS,
    K_GAMMA,
    OPEN_FRACTION,
    REVERSED_FRACTION,
    SIMPLIFICATION_ERRORS,
    matching_names,
)
from facegear.schema.base import parse
from facegear.schema.changes import add_changes, movable, variable_part
from facegear.schema.lubrication import LubricationSection
from facegear.schema.tolerances import Tolerances
from facegear.studies.lubricated_teeth import reduction_over
from facegear.studies.machines import WHOLE, Judge, Question, VariedMachine, tooth_meshes
from facegear.studies.sampling import Population, changes, population, samples
from facegear.studies.summary import Evaluate, run_chunk
from facegear.studies.tooth_contact import Meshes, Values

CHECKED_SAMPLES = 8
"""Number of samples that are also computed over the whole hunting cycle, and by all points of the contact."""
STATES = 16
"""Number of machines over whose lubrication and speed the contact is reduced to few points."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SampledMachine(VariedMachine):
    """Machine with its tolerances, as plain config values: what the stages of its samples are given.

    With `lubrication_sections`, lubrication and tooth_pair, friction is judged too: by `ltca` and
    `pressure` of stage contact, unless each sample has a contact of its own.
    """

    tolerances: Values
    teeth: Values
    lubrication_sections: Values | None = None
    ltca: pd.DataFrame | None = None
    pressure: Arrays | None = None

    @property
    def friction(self) -> bool:
        """Whether quantities of friction are computed: where `lubrication_sections` is given."""
        return self.lubrication_sections is not None

    @cached_property
    def meshes(self) -> Meshes:
        """Function from section tooth_pair to stiffness, error and contact of its meshes, lubricated
        where friction is asked for.

        Contact is reduced to few points over `lubricated_states`.
        """
        if self.lubrication_sections is None:
            return super().meshes
        rub = reduction_over(self.lubricated_states)
        lubricated_teeth = None
        if self.ltca is not None and self.pressure is not None:
            section = ToothPair.of_config(self.lubrication_sections["tooth_pair"])
            lubricated_teeth = rub(self.ltca, self.pressure, section)
        return tooth_meshes(
            self.harmonics, self.pair, self.flanks, self.gears, self.law, rub, lubricated_teeth
        )

    @cached_property
    def lubricated_states(self) -> list[tuple[LubricationSection, float]]:
        """Section `lubrication` and pinion speed (rpm) of STATES other machines, over which contact is
        reduced.

        They are drawn from the causes with another seed. Speeds are in turn the nominal one and the
        slowest and fastest of the load map, plus the sample's own deviation. Without any valid machine
        the nominal state is the only one.
        """
        other_population = replace(self.causes, seed=self.section.seed + 1)
        load_map = self.section.load_map
        speeds = [speed for _, speed in load_map.loads(self.speed_rpm)] if load_map else [self.speed_rpm]
        states = []
        for number, values in enumerate(samples(other_population, 0, STATES)):
            sample = self.sample(values)
            speed = (self.speed_rpm, min(speeds), max(speeds))[number % 3]
            off = sample["dynamics"]["speed_rpm"] - self.speed_rpm
            with suppress(FacegearError):
                section = parse(LubricationSection, sample["lubrication"], "this sample")
                states.append((section, speed + off))
        return states or [(LubricationSection.of_config(self.start["lubrication"]), self.speed_rpm)]

    @cached_property
    def section(self) -> Tolerances:
        """Section `tolerances` of the config."""
        return Tolerances.of_config(self.tolerances)

    @cached_property
    def causes(self) -> Population:
        """Causes of section `tolerances` with their distributions and seed."""
        return population(self.section)

    @cached_property
    def start(self) -> dict[str, Any]:
        """Nominal values of `variable_part`, with an entry for every key that a cause moves."""
        teeth = self.pair["tooth_pair"] if self.pair else self.teeth
        keys = [key for cause in self.causes.causes for key, _ in cause.gains]
        oil = self.lubrication_sections["lubrication"] if self.lubrication_sections else None
        return movable(variable_part(self.transmission, teeth, self.speed_rpm, oil), keys)

    @property
    def question(self) -> Question:
        """Settings by which a sample is judged: model and hunting cycles of `tolerances`, accuracy, load
        sharing.
        """
        return Question(self.section.model, self.section.hunting_cycles, self.accuracy, self.options)

    @cached_property
    def judge(self) -> Judge:
        """Function from the config values of a sample, see `sample`, to its quantities by column; near
        `start`.
        """
        return self.judge_near(self.start)

    def judge_near(self, nominal: Values) -> Judge:
        """Return the function that judges samples near other nominal values than `start`.

        Parameters
        ----------
        nominal : Values
            Values of `variable_part` from which samples differ by their causes alone; in motion their
            orbit is the first guess.

        Returns
        -------
        Judge
            Function from a sample's config values to its quantities by column.
        """
        return self.judge_of(self.question, "this sample", nominal)

    def sample(self, values: Sequence[float]) -> dict[str, Any]:
        """Return the config values of a sample: the nominal ones plus the changes by its causes.

        Parameters
        ----------
        values : Sequence[float]
            Values (causes,) of its causes, in the unit of each cause.

        Returns
        -------
        dict[str, Any]
            Plain values of `variable_part`, for a judge.
        """
        return add_changes(self.start, changes(self.causes, values))

    @cached_property
    def whole_judge(self) -> Judge:
        """Function from the config values of a sample, see `sample`, to its quantities by column, with
        loads over every mesh cycle of the hunting cycle.
        """
        return self.judge_of(replace(self.question, cycles=WHOLE), "this sample")

    @cached_property
    def thorough_judge(self) -> Judge:
        """Function from the config values of a sample to its quantities, with friction at all points of
        the contact.
        """
        return self.judge_of(replace(self.question, every_place=True), "this sample", self.start)

    @property
    def checks(self) -> tuple[str, ...]:
        """Columns with the errors of the first CHECKED_SAMPLES samples, NaN in the others.

        At rest they have those by mesh cycles left out, with friction those by few points of the contact.
        """
        hunting = () if self.question.dynamic else tuple(CYCLE_SELECTION_ERRORS.values())
        return (*hunting, *(SIMPLIFICATION_ERRORS.values() if self.friction else ()))

    def judge_sample(self, sample: Values, check: bool, judge: Judge | None = None) -> dict[str, float]:
        """Compute the quantities of a sample, and where asked the errors of its simplifications.

        They are mesh cycles left out of the hunting cycle, and few points that stand for the whole
        contact.

        Parameters
        ----------
        sample : Values
            Config values of the sample, see `sample`.
        check : bool
            Whether the columns `checks` are computed; they are nan otherwise.
        judge : Judge or None
            Function that judges samples near other values than `start`; None near `start`.

        Returns
        -------
        dict[str, float]
            Quantities in the units of their columns, and the columns `checks`: relative errors,
            differences of fractions, K for the bulk temperature.
        """
        values = (judge or self.judge)(sample)
        if not check:
            return values | dict.fromkeys(self.checks, nan)
        cycle_deviations = {} if self.question.dynamic else self._cycle_deviations(sample, values)
        return values | cycle_deviations | (self._reduction_errors(sample, values) if self.friction else {})

    def _reduction_errors(self, sample: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, float]:
        """Return by how much `values`, whose friction is taken at few points of the contact, differ from
        the quantities with all points, by column of SIMPLIFICATION_ERRORS: relative, for a temperature in
        K.
        """
        whole = self.thorough_judge(sample)
        off = {
            name: values[name] / whole[name] - 1.0 if whole[name] else nan for name in SIMPLIFICATION_ERRORS
        }
        off[BULK] = values[BULK] - whole[BULK]
        return {column: off[name] for name, column in SIMPLIFICATION_ERRORS.items()}

    def _cycle_deviations(self, sample: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, float]:
        """Return by how much quantities over all mesh cycles exceed those over few, `values`, of the same
        sample.

        Columns are those of CYCLE_SELECTION_ERRORS: differences of the open and reversed fractions of
        time, and the largest relative error of K_gamma over all meshes.
        """
        whole = self.whole_judge(sample)
        paths = matching_names(f"{K_GAMMA} ", list(whole))
        deviations = {name: whole[name] - values[name] for name in (OPEN_FRACTION, REVERSED_FRACTION)}
        ratios = (whole[name] / values[name] - 1.0 for name in paths if values[name] > 0.0)
        deviations[K_GAMMA] = max(ratios, default=nan)
        return {CYCLE_SELECTION_ERRORS[name]: value for name, value in deviations.items()}

    def run(
        self,
        evaluate: Evaluate,
        numbers: range,
        label: str,
        partial: str | Path | None,
        *identity_parts: object,
    ) -> pd.DataFrame:
        """Evaluate samples by number with `run_chunk`, which resumes from a journal.

        Parameters
        ----------
        evaluate : Evaluate
            Function from a sample's number to its quantities by column.
        numbers : range
            Numbers of the samples.
        label : str
            Name of the samples in the progress that is shown.
        partial : str or Path or None
            Journal of finished samples; nothing is kept if None.
        *identity_parts : object
            Further plain values that must be the same for the journal to count.

        Returns
        -------
        pd.DataFrame
            One row for each sample: columns sample, the quantities, `checks`, and error.
        """
        layout = wired_layout(self.start["transmission"], self.teeth)
        names = [*self.columns(layout, self.question), *self.checks]
        identity, progress = self.identity(*identity_parts), Progress(label, len(numbers))
        with TemporaryDirectory() as folder:
            partial_path = Path(folder) / "partial" if partial is None else partial
            return run_chunk(evaluate, numbers, names, partial_path, identity, progress.step)
