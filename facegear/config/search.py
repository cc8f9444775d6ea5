"""Config section `search`: which numbers of a machine are free, what is wanted of it, what it must hold."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse, require_all
from facegear.config.dynamics import SWEEP_ACCURACY, SWEPT_TEXT, Accuracy, settings
from facegear.dynamics.sweeps.plan import JumpRange
from facegear.load_sharing.quantity_names import JUMP_MARGIN, QUANTITIES, is_jump_quantity

RESERVED_COLUMNS = ("design", "error", "generation", "seed")
"""Columns beside those of variables, objectives and constraints."""
NAME = r"^[a-z][a-z0-9_]{0,39}$"
"""Pattern of the names of variables, objectives and constraints, which are columns of tables."""
BoundedNumber = Annotated[float, Field(ge=-1e15, le=1e15)]
"""Value of a free number or a limit, in the unit of any quantity."""


class VariableSection(Section):
    """A number that is free, and the keys of the machine that take it."""

    name: str = Field(pattern=NAME, description="names its column in tables")
    sets: tuple[str, ...] = Field(
        min_length=1, description="dotted keys of numbers of `transmission`, `tooth_pair`"
    )
    limits: tuple[BoundedNumber, BoundedNumber] = Field(description="smallest and largest value")
    steps: int | None = Field(
        None,
        ge=2,
        le=100_000,
        description="so many evenly spaced values only, as of angles that fit the teeth",
    )
    scale: Literal["linear", "log"] = Field("linear", description="log: evenly spaced in orders of magnitude")

    @model_validator(mode="after")
    def _consistent(self) -> "VariableSection":
        if self.name in (*QUANTITIES, JUMP_MARGIN):
            refuse("name", self.name, "another one: the winners have a column of that name")
        if self.limits[1] <= self.limits[0]:
            refuse("limits", list(self.limits), "two numbers, the lower one first")
        if self.scale == "log" and self.limits[0] <= 0.0:
            refuse("limits", list(self.limits), "above 0 where scale is log")
        return self


class ObjectiveSection(Section):
    """Something that is to be small, or large."""

    name: str = Field(pattern=NAME, description="names its column in tables")
    largest_of: tuple[str, ...] = Field(
        (),
        description="to be small: quantities of tolerances/samples.parquet, or what several begin with",
    )
    smallest_of: tuple[str, ...] = Field((), description="instead, to be large: the same, or jump_margin_rpm")
    percentile: float | None = Field(
        None, gt=0, lt=100, description="over the causes of `tolerances`; null: of the machine as designed"
    )

    @property
    def large(self) -> bool:
        """Whether it is to be large."""
        return bool(self.smallest_of)

    @property
    def quantities(self) -> tuple[str, ...]:
        """Quantities of which the largest, or smallest, counts."""
        return self.smallest_of or self.largest_of

    @model_validator(mode="after")
    def _one_way(self) -> "ObjectiveSection":
        if bool(self.largest_of) == bool(self.smallest_of):
            refuse("largest_of", list(self.largest_of), "either this or smallest_of")
        for text in self.largest_of:
            if is_jump_quantity(text):
                refuse("largest_of", text, "in smallest_of, as a margin is to be large")
        return self


class ConstraintSection(ObjectiveSection):
    """Something that may not be larger, or smaller, than a limit."""

    at_most: BoundedNumber | None = Field(None, description="required with largest_of")
    at_least: BoundedNumber | None = Field(None, description="required with smallest_of")

    @property
    def limit(self) -> float:
        """The one that is given."""
        bound = self.at_least if self.large else self.at_most
        assert bound is not None
        return bound

    @model_validator(mode="after")
    def _check_limit(self) -> "ConstraintSection":
        key, opposite_key = ("at_least", "at_most") if self.large else ("at_most", "at_least")
        for name, is_required in ((key, True), (opposite_key, False)):
            if (getattr(self, name) is not None) != is_required:
                quantities_key = "smallest_of" if self.large else "largest_of"
                refuse(
                    name,
                    getattr(self, name),
                    f"{'given' if is_required else 'left out'} with {quantities_key}",
                )
        return self


class Jumps(Section):
    """Sweeps up and down around the operating speed, where the margin to the nearest jump is asked for."""

    range_rpm: float = Field(
        500,
        ge=1e-3,
        le=100_000,
        description="on both sides of the speed; the margin where nothing jumps in it",
    )
    step_rpm: float = Field(50, ge=1e-3, le=10_000, description="at most, from speed to speed")
    resolution_rpm: float = Field(1.0, ge=1e-6, le=1000, description="to which a jump is bracketed")
    accuracy: Accuracy = Field(SWEEP_ACCURACY, description=SWEPT_TEXT)

    @model_validator(mode="after")
    def _inside(self) -> "Jumps":
        if self.step_rpm > self.range_rpm:
            refuse("step_rpm", self.step_rpm, f"at most range_rpm = {self.range_rpm:g}")
        if self.range_rpm > 1000 * self.step_rpm:
            refuse("step_rpm", self.step_rpm, f"a thousandth of range_rpm = {self.range_rpm:g} or more")
        return self


class Search(Section):
    """Designs that no other beats in every objective."""

    variables: tuple[VariableSection, ...] = Field(
        min_length=1, max_length=50, description="numbers that are free"
    )
    objectives: tuple[ObjectiveSection, ...] = Field(
        min_length=1, max_length=4, description="what is to be small, or large"
    )
    constraints: tuple[ConstraintSection, ...] = Field(
        (), max_length=20, description="what a design must hold"
    )
    model: Literal["quasi_static", "dynamic"] = Field(
        "quasi_static", description="of the loads; jumps are looked for in the motion with both"
    )
    jumps: Jumps = Jumps()
    hunting_cycles: int = Field(
        8, ge=1, le=100_000, description="mesh cycles taken from the hunting cycle; winners take all of them"
    )
    samples: int = Field(32, ge=2, le=100_000, description="of each design, where a percentile is asked for")
    winner_samples: int = Field(256, ge=2, le=100_000, description="the same of the winners")
    population: int = Field(24, ge=4, le=10_000, description="designs of a generation")
    generations: int = Field(20, ge=1, le=10_000, description="of the evolution, on each island")
    seeds: tuple[Annotated[int, Field(ge=0, le=2**31)], ...] = Field(
        (1, 2, 3), min_length=1, max_length=100, description="one island, a job, each"
    )

    @property
    def robust(self) -> bool:
        """Whether some objective or constraint is a percentile."""
        return any(goal.percentile is not None for goal in (*self.objectives, *self.constraints))

    @model_validator(mode="after")
    def _different(self) -> "Search":
        require_all(self._check_names, self._check_keys, self._check_seeds)
        return self

    def _check_names(self) -> None:
        goals = [entry.name for entry in (*self.objectives, *self.constraints)]
        names = [*(entry.name for entry in self.variables), *goals]
        for number, name in enumerate(names):
            if name in RESERVED_COLUMNS:
                refuse("name", name, f"another one: {', '.join(RESERVED_COLUMNS)} are columns of their own")
            if name in names[:number]:
                refuse("name", name, "one of its own for each variable, objective and constraint")

    def _check_keys(self) -> None:
        keys = [key for variable in self.variables for key in variable.sets]
        if len(set(keys)) < len(keys):
            refuse("variables.sets", keys, "each key once")

    def _check_seeds(self) -> None:
        if len(set(self.seeds)) < len(self.seeds):
            refuse("seeds", list(self.seeds), "different numbers")


def jump_range(section: Jumps) -> JumpRange:
    """Return the range of speeds in which jumps are looked for.

    Parameters
    ----------
    section : Jumps
        Section `search.jumps` of the config.

    Returns
    -------
    JumpRange
        Speeds in rpm, with the settings of the sweeps.
    """
    return JumpRange(
        range_rpm=section.range_rpm,
        step_rpm=section.step_rpm,
        resolution_rpm=section.resolution_rpm,
        settings=settings(section.accuracy),
    )
