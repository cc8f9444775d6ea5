"""Config sections `search` and `studies`: free numbers and goals of designs, changed keys."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from facegear.quantities import JUMP_MARGIN, QUANTITIES, is_jump_quantity
from facegear.schema.base import Section, refuse, require_all
from facegear.schema.motion import SWEEP_ACCURACY, SWEPT_TEXT, Accuracy

RESERVED_COLUMNS = ("design", "error", "generation", "seed")
"""Columns beside those of variables, objectives and constraints."""
ENTRY_NAME = r"^[a-z][a-z0-9_]{0,39}$"
"""Pattern of the names of variables, objectives and constraints, which are columns of tables."""
BoundedNumber = Annotated[float, Field(ge=-1e15, le=1e15)]
"""Value of a free number or a limit, in the unit of any quantity."""


class VariableSection(Section):
    """A number that is free, and the keys of the machine that take it."""

    name: str = Field(pattern=ENTRY_NAME, description="names its column in tables")
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
        """Refuse a variable with a reserved name or limits that do not rise."""
        if self.name in (*QUANTITIES, JUMP_MARGIN):
            refuse("name", self.name, "another one: the winners have a column of that name")
        if self.limits[1] <= self.limits[0]:
            refuse("limits", list(self.limits), "two numbers, the lower one first")
        if self.scale == "log" and self.limits[0] <= 0.0:
            refuse("limits", list(self.limits), "above 0 where scale is log")
        return self


class ObjectiveSection(Section):
    """Something that is to be small, or large."""

    name: str = Field(pattern=ENTRY_NAME, description="names its column in tables")
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
        """Whether larger values are better: the goal is given by `smallest_of`."""
        return bool(self.smallest_of)

    @property
    def quantities(self) -> tuple[str, ...]:
        """Beginnings of the names of quantities of which the worst counts: the smallest if `large`, else
        the largest.
        """
        return self.smallest_of or self.largest_of

    @model_validator(mode="after")
    def _one_way(self) -> "ObjectiveSection":
        """Refuse an objective with both or neither of its directions."""
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
        """Limit of the constraint, in the unit of its quantity: `at_least` or `at_most`."""
        bound = self.at_least if self.large else self.at_most
        assert bound is not None
        return bound

    @model_validator(mode="after")
    def _check_limit(self) -> "ConstraintSection":
        """Refuse a constraint without a limit on the side that it needs."""
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
        """Refuse a step beyond the range or too small for it."""
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
        """Whether some objective or constraint is a percentile over samples of the tolerances."""
        return any(goal.percentile is not None for goal in (*self.objectives, *self.constraints))

    @model_validator(mode="after")
    def _different(self) -> "Search":
        """Check names, keys and seeds; all mistakes are reported together."""
        require_all(self._check_names, self._check_keys, self._check_seeds)
        return self

    def _check_names(self) -> None:
        """Refuse reserved and repeated names."""
        goals = [entry.name for entry in (*self.objectives, *self.constraints)]
        names = [*(entry.name for entry in self.variables), *goals]
        for number, name in enumerate(names):
            if name in RESERVED_COLUMNS:
                refuse("name", name, f"another one: {', '.join(RESERVED_COLUMNS)} are columns of their own")
            if name in names[:number]:
                refuse("name", name, "one of its own for each variable, objective and constraint")

    def _check_keys(self) -> None:
        """Refuse a config key that two variables set."""
        keys = [key for variable in self.variables for key in variable.sets]
        if len(set(keys)) < len(keys):
            refuse("variables.sets", keys, "each key once")

    def _check_seeds(self) -> None:
        """Refuse repeated seeds."""
        if len(set(self.seeds)) < len(self.seeds):
            refuse("seeds", list(self.seeds), "different numbers")


NAME = r"^[a-z][a-z0-9_]{0,39}$"
"""Pattern of the names of cases and studies, which are names of folders and files."""
FigureNumber = Annotated[int, Field(ge=1, le=999)]


class StudyPoint(Section):
    """One value of an axis: a label for the figures and the keys it sets."""

    label: str = Field(min_length=1, max_length=160, description="name of the point in figures and tables")
    set: dict[str, Any] = Field(min_length=1, description="dotted config keys and their values")

    @model_validator(mode="after")
    def _each_key_once(self) -> "StudyPoint":
        """Refuse keys one of which holds another."""
        for first, second in combinations(self.set, 2):
            if _same_place(first, second):
                refuse("set", [first, second], "keys none of which holds another")
        return self


class Axis(Section):
    """One dimension of a study: either one `key` with its `values`, or `points` that set several keys."""

    label: str = Field(min_length=1, max_length=60, description="name of the axis in figures and tables")
    key: str | None = Field(None, description="dotted config key, such as transmission.backlash_um")
    values: tuple[Any, ...] = Field((), description="of the key, a point each")
    points: tuple[StudyPoint, ...] = Field((), description="instead of key and values")

    @model_validator(mode="after")
    def _one_form(self) -> "Axis":
        """Refuse an axis given both by points and by key with values, or by neither."""
        if bool(self.points) == bool(self.key):
            refuse("points", len(self.points), "given where there is no key, and left out beside one")
        if self.key and not self.values:
            refuse("values", list(self.values), "at least one value, as a key is given")
        labels = [point.label for point in self.study_points()]
        if len(set(labels)) < len(labels):
            refuse("points", labels, "points whose labels differ")
        return self

    def study_points(self) -> tuple[StudyPoint, ...]:
        """Return the points of the axis: as given, or one for each value of its key, labelled by the
        value.

        Returns
        -------
        tuple[StudyPoint, ...]
            Label and new values by dotted key of each point.
        """
        if self.key:
            return tuple(StudyPoint(label=f"{value}", set={self.key: value}) for value in self.values)
        return self.points

    def numbers(self) -> dict[str, tuple[float, ...]]:
        """Return the dotted keys that all points set to different numbers.

        Returns
        -------
        dict[str, tuple[float, ...]]
            Number of each point under every such key, in the unit of the key.
        """
        every = [dict(_leaves(point.set)) for point in self.study_points()]
        columns: dict[str, tuple[Any, ...]] = {
            key: tuple(point.get(key) for point in every) for key in every[0]
        }
        return {key: column for key, column in columns.items() if _all_differ(column)}

    @property
    def keys(self) -> set[str]:
        """Dotted keys that some point sets."""
        return {key for point in self.study_points() for key, _ in _leaves(point.set)}


def common_key(first: Iterable[str], second: Iterable[str]) -> str | None:
    """Find a dotted key of `second` that equals, contains or lies inside one of `first`.

    Parameters
    ----------
    first : Iterable[str]
        Dotted keys.
    second : Iterable[str]
        Dotted keys.

    Returns
    -------
    str or None
        The first such key in alphabetical order; None if there is none.
    """
    first = sorted(first)
    return next(
        (key for key in sorted(second) if any(_same_place(key, first_key) for first_key in first)), None
    )


def _same_place(key: str, other_key: str) -> bool:
    """Whether two dotted keys are equal or one holds the other."""
    return f"{key}.".startswith(f"{other_key}.") or f"{other_key}.".startswith(f"{key}.")


def _leaves(values: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield dotted key and value of everything inside nested mappings; an empty mapping is a value."""
    for key, value in values.items():
        if isinstance(value, Mapping) and value:
            yield from ((f"{key}.{inner}", leaf) for inner, leaf in _leaves(value))
        else:
            yield key, value


def _all_differ(column: tuple[Any, ...]) -> bool:
    """Whether all values of a column are numbers, each of which occurs once."""
    plain = all(isinstance(value, int | float) and not isinstance(value, bool) for value in column)
    return plain and len(set(column)) == len(column)


class Study(Section):
    """Cases over one axis, or over the product of two."""

    name: str = Field(pattern=NAME, description="names the study's folder and files")
    title: str = Field(min_length=1, max_length=120, description="title of the study's figures")
    axes: tuple[Axis, ...] = Field(
        min_length=1, max_length=2, description="one axis, or two for every combination of their points"
    )
    figures: tuple[FigureNumber, FigureNumber] | None = Field(
        None,
        description="numbers of these figures in the publication that the config reproduces: inputs, idlers",
    )

    @model_validator(mode="after")
    def _different_keys(self) -> "Study":
        """Refuse two axes that set the same key."""
        for first, second in combinations(self.axes, 2):
            if (key := common_key(first.keys, second.keys)) is not None:
                requirement = "keys that the other axis does not set, as one of the two values would be lost"
                refuse("axes", key, requirement)
        return self
