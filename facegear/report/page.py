"""A self-contained HTML page from chapters of text, tables and pictures."""

import base64
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.io import pages

TEMPLATE = Path(__file__).with_name("page.html.j2")
VIEWER = Path(__file__).with_name("pair_view.js")
SCREEN_DPI, PNG_DPI = 96, 160
"""Points an inch of a page, and of a stored png."""
UNITS = {
    "n_per_mm": "N/mm",
    "n_per_m": "N/m",
    "n_m": "N m",
    "rpm": "rpm",
    "deg": "deg",
    "mpa": "MPa",
    "hz": "Hz",
    "um": "um",
    "mm": "mm",
    "kw": "kW",
    "percent": "%",
    "n": "N",
}
"""Units that end a column's name, as they are written."""
ROUNDING = 1e-9
"""A number below this part of the largest one with its unit is zero but for rounding, and is written as 0."""


@dataclass(frozen=True)
class Picture:
    """A stored svg or png with its caption."""

    path: Path
    caption: str

    @property
    def width_px(self) -> int:
        """Width at which the text has the size it was drawn with."""
        if self.path.suffix == ".svg":
            match = re.search(
                r'<svg[^>]* width="([\d.]+)(pt|px)?"', self.path.read_text(encoding="utf-8")[:4000]
            )
            return 0 if match is None else round(float(match[1]) * (4 / 3 if match[2] == "pt" else 1.0))
        return round(int.from_bytes(self.path.read_bytes()[16:20], "big") * SCREEN_DPI / PNG_DPI)

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
        return [words(str(name)) for name in self.frame.columns]

    def rows(self) -> list[list[str]]:
        """Cells as text."""
        units = [_unit(str(name)) for name in self.frame.columns]
        zero = [ROUNDING * self._largest(unit, units) for unit in units]
        return [
            [self._cell(*cell) for cell in zip(row, units, zero, strict=True)]
            for row in self.frame.itertuples(index=False)
        ]

    def _largest(self, unit: str, units: Sequence[str]) -> float:
        """The largest number of all columns with a unit; nothing for numbers without one."""
        columns = [self.frame.iloc[:, i] for i, other in enumerate(units) if unit and other == unit]
        numbers = [column.abs().max() for column in columns if pd.api.types.is_float_dtype(column)]
        return max((float(number) for number in numbers if number == number), default=0.0)

    def _cell(self, value: object, unit: str, zero: float) -> str:
        """A cell; stiffnesses (N/m) all with a power of ten, so that they can be read down a column."""
        if not isinstance(value, float):
            return str(value)
        if value != value:
            return ""
        number = 0.0 if abs(value) < zero else value
        return scientific(number, self.digits) if unit == "n_per_m" else f"{number:.{self.digits}g}"


@dataclass(frozen=True)
class View:
    """What the viewer of `pair_view.js` draws (plain values, arrays as base64), under a caption."""

    data: Mapping[str, Any]
    caption: str


@dataclass(frozen=True)
class Chapter:
    """One part of the page."""

    title: str
    text: str
    pictures: Sequence[Picture] = ()
    tables: Sequence[Table] = ()
    view: View | None = None

    @property
    def anchor(self) -> str:
        """Name for links inside the page."""
        return "".join(letter if letter.isalnum() else "-" for letter in self.title.lower())


def render(title: str, lead: str, chapters: Sequence[Chapter]) -> str:
    """The page as HTML text that needs no other file."""
    viewer = VIEWER.read_text(encoding="utf-8") if any(chapter.view for chapter in chapters) else ""
    return pages.render(TEMPLATE, title=title, lead=lead, chapters=chapters, viewer=viewer)


def words(name: str) -> str:
    """A column's name as words, with its unit as it is written."""
    ending = _unit(name)
    return (
        (f"{name} ".replace(f"_{ending} ", f" ({UNITS[ending]}) ") if ending else name)
        .replace("_", " ")
        .strip()
    )


def _unit(name: str) -> str:
    """The unit in a column's name, a key of UNITS; nothing where it has none."""
    return next((ending for ending in UNITS if f"_{ending} " in f"{name} "), "")


def scientific(value: float, digits: int) -> str:
    """A number with a power of ten, `digits` of it significant."""
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}e{int(exponent)}"
