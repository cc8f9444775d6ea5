"""Config section `studies`: the same machine with some keys changed, in one or two dimensions."""

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse

NAME = r"^[a-z][a-z0-9_]{0,39}$"


class StudyPoint(Section):
    """One value of an axis: a label for the figures and the keys it sets."""

    label: str = Field(min_length=1, max_length=160)
    set: dict[str, Any] = Field(min_length=1, description="dotted config keys and their values")


class Axis(Section):
    """One dimension of a study: either one `key` with its `values`, or `points` that set several keys."""

    label: str = Field(min_length=1, max_length=60)
    key: str | None = Field(None, description="dotted config key, such as transmission.backlash_um")
    values: tuple[Any, ...] = ()
    points: tuple[StudyPoint, ...] = ()

    @model_validator(mode="after")
    def _one_form(self) -> "Axis":
        if bool(self.points) == bool(self.key):
            refuse("points", len(self.points), "given where there is no key, and left out beside one")
        if self.key and not self.values:
            refuse("values", list(self.values), "at least one value, as a key is given")
        labels = [point.label for point in self.resolved()]
        if len(set(labels)) < len(labels):
            refuse("points", labels, "points whose labels differ")
        return self

    def resolved(self) -> tuple[StudyPoint, ...]:
        """The axis as labelled points."""
        if self.key:
            return tuple(StudyPoint(label=f"{value}", set={self.key: value}) for value in self.values)
        return self.points

    def numbers(self) -> dict[str, tuple[float, ...]]:
        """Number of each point under every dotted key that all points set to numbers, no two alike."""
        every = [dict(_leaves(point.set)) for point in self.resolved()]
        columns: dict[str, tuple[Any, ...]] = {
            key: tuple(point.get(key) for point in every) for key in every[0]
        }
        return {key: column for key, column in columns.items() if _all_differ(column)}


def _leaves(values: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Dotted keys and values, also of whole sections."""
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield from ((f"{key}.{inner}", leaf) for inner, leaf in _leaves(value))
        else:
            yield key, value


def _all_differ(column: tuple[Any, ...]) -> bool:
    plain = all(isinstance(value, int | float) and not isinstance(value, bool) for value in column)
    return plain and len(set(column)) == len(column)


class Study(Section):
    """Cases over one axis, or over the product of two."""

    name: str = Field(pattern=NAME)
    title: str = Field(min_length=1, max_length=120)
    axes: tuple[Axis, ...] = Field(min_length=1, max_length=2)
    figures: tuple[int, int] | None = Field(
        None,
        description="numbers of these figures in the publication that the config reproduces: inputs, idlers",
    )
