"""Config section `studies`: the same machine with some keys changed, in one or two dimensions."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations
from typing import Annotated, Any

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse

NAME = r"^[a-z][a-z0-9_]{0,39}$"
"""Pattern of the names of cases and studies, which are names of folders and files."""
FigureNumber = Annotated[int, Field(ge=1, le=999)]


class StudyPoint(Section):
    """One value of an axis: a label for the figures and the keys it sets."""

    label: str = Field(min_length=1, max_length=160, description="name of the point in figures and tables")
    set: dict[str, Any] = Field(min_length=1, description="dotted config keys and their values")

    @model_validator(mode="after")
    def _each_key_once(self) -> "StudyPoint":
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
        if bool(self.points) == bool(self.key):
            refuse("points", len(self.points), "given where there is no key, and left out beside one")
        if self.key and not self.values:
            refuse("values", list(self.values), "at least one value, as a key is given")
        labels = [point.label for point in self.study_points()]
        if len(set(labels)) < len(labels):
            refuse("points", labels, "points whose labels differ")
        return self

    def study_points(self) -> tuple[StudyPoint, ...]:
        """Return the points of the axis; those of a key take its values as labels.

        Returns
        -------
        tuple[StudyPoint, ...]
            The points.
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
    """Find a dotted key of `second` that is, holds or stands in one of `first`.

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
    """Whether one dotted key is the other or holds it."""
    return f"{key}.".startswith(f"{other_key}.") or f"{other_key}.".startswith(f"{key}.")


def _leaves(values: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Dotted keys and values, also of whole sections."""
    for key, value in values.items():
        if isinstance(value, Mapping) and value:
            yield from ((f"{key}.{inner}", leaf) for inner, leaf in _leaves(value))
        else:
            yield key, value


def _all_differ(column: tuple[Any, ...]) -> bool:
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
        for first, second in combinations(self.axes, 2):
            if (key := common_key(first.keys, second.keys)) is not None:
                requirement = "keys that the other axis does not set, as one of the two values would be lost"
                refuse("axes", key, requirement)
        return self
