"""Result of a stage: the content of its files and one line about it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, eq=False)
class Outcome:
    """`content` of the stage's files by name (tables, mappings of arrays, records), and one line about it."""

    content: Mapping[str, Any]
    summary: str
