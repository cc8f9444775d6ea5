"""Result of a stage: the content of its files and one line about it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, eq=False)
class Outcome:
    """Result of a stage in memory, before anything is written.

    - content: content of each of the stage's files by name: tables, mappings of arrays, records, bytes
    - summary: one line about the result, for the terminal and the manifest
    """

    content: Mapping[str, Any]
    summary: str
