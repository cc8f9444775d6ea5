"""A self-contained HTML page from chapters of text, tables and pictures."""

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from facegear.io import pages

TEMPLATE = Path(__file__).with_name("page.html.j2")
UNITS = {
    "n_per_m": "N/m",
    "n_m": "N m",
    "rpm": "rpm",
    "mpa": "MPa",
    "hz": "Hz",
    "um": "um",
    "mm": "mm",
    "kw": "kW",
    "percent": "%",
    "n": "N",
}
"""Units that end a column's name, as they are written."""


@dataclass(frozen=True)
class Picture:
    """A stored svg or png with its caption."""

    path: Path
    caption: str

    def data_uri(self) -> str:
        """The picture's bytes as a data URI."""
        kind = {".svg": "image/svg+xml", ".png": "image/png"}[self.path.suffix]
        return f"data:{kind};base64,{base64.b64encode(self.path.read_bytes()).decode()}"


@dataclass(frozen=True)
class Table:
    """Rows under a caption; numbers with `digits` significant digits. `folded`: opened by a click."""

    caption: str
    frame: pd.DataFrame
    digits: int = 5
    folded: bool = False

    def header(self) -> list[str]:
        """Column names as words, with their units as they are written."""
        return [self._words(str(name)) for name in self.frame.columns]

    @staticmethod
    def _words(name: str) -> str:
        for ending, unit in UNITS.items():
            if f"_{ending} " in f"{name} ":
                name = f"{name} ".replace(f"_{ending} ", f" ({unit}) ").strip()
                break
        return name.replace("_", " ")

    def rows(self) -> list[list[str]]:
        """Cells as text."""
        return [[self._cell(value) for value in row] for row in self.frame.itertuples(index=False)]

    def _cell(self, value: object) -> str:
        if isinstance(value, float):
            return "" if value != value else f"{value:.{self.digits}g}"
        return str(value)


@dataclass(frozen=True)
class Chapter:
    """One part of the page."""

    title: str
    text: str
    pictures: Sequence[Picture] = ()
    tables: Sequence[Table] = ()

    @property
    def anchor(self) -> str:
        """Name for links inside the page."""
        return "".join(letter if letter.isalnum() else "-" for letter in self.title.lower())


def render(title: str, lead: str, chapters: Sequence[Chapter]) -> str:
    """The page as HTML text that needs no other file."""
    return pages.render(TEMPLATE, title=title, lead=lead, chapters=chapters)
