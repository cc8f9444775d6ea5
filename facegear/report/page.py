"""A self-contained HTML page from chapters of text, tables and pictures."""

import base64
import gzip
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import floor, isfinite, log10
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray
from facegear.io import documents, pages
from facegear.io.pictures import read_svg
from facegear.report.stills import data_uri
from facegear.report.units import UNITS, ending_of

FOLDER = Path(__file__).parent
TEMPLATE = FOLDER / "page.html.j2"
LIBRARY = FOLDER / "plotly-cartesian.min.js"
"""plotly.js as its makers publish it, the part with curves, bars and maps; its licence stands beside it."""
PLAIN = (1e-3, 1e6)
"""Numbers between these are written without a power of ten."""
NAMED = 5
"""Words of a caption that name its file."""
PAPER_PT, COLUMN_GAP_PT, LETTER_WIDTH = 532.0, 8.0, 0.64
"""On A4: width of a table, room beside a column (pt), and the mean width of a letter in its height."""
PRINTED = (4.0, 8.0)
"""Smallest and largest size of letters in a printed table, in pt."""
LONG, LONG_COLUMN = 60, 22
"""Letters of a cell from which on a printed table may break it anywhere, and of a line of it then."""
ROUNDING = 1e-9
"""A number below this part of the largest one with its unit is zero but for rounding, and is written as 0."""


@dataclass(frozen=True)
class Picture:
    """A stored svg with its caption."""

    path: Path
    caption: str

    @cached_property
    def still(self) -> str:
        """Text of the svg. Raises CorruptFile where the file is not whole."""
        return read_svg(self.path)

    @property
    def width_px(self) -> int:
        """Width at which the text has the size it was drawn with."""
        match = re.search(r'<svg[^>]* width="([\d.]+)(pt|px)?"', self.still[:4000])
        return 0 if match is None else round(float(match[1]) * (4 / 3 if match[2] == "pt" else 1.0))

    @property
    def anchor(self) -> str:
        """Name of the figure inside the page."""
        return f"figure-{self.path.stem}"

    @cached_property
    def interactive(self) -> Any:
        """What plotly.js draws in its place, from the file beside it; nothing where it has no such form.

        Raises CorruptFile where that file is not whole.
        """
        stored = self.path.with_suffix(".json")
        content = documents.read(stored) if stored.exists() else {}
        return content if content.get("data") else None

    def data_uri(self) -> str:
        """The picture as a data URI."""
        return data_uri(self.still)


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

    def numeric(self) -> list[bool]:
        """Of each column whether it holds numbers."""
        return [
            pd.api.types.is_numeric_dtype(kind) and not pd.api.types.is_bool_dtype(kind)
            for kind in self.frame.dtypes
        ]

    def rows(self) -> list[list[str]]:
        """Cells as text."""
        units = [ending_of(str(name)) for name in self.frame.columns]
        largest = {unit: self._largest(unit, units) for unit in set(units)}
        zero = [ROUNDING * largest[unit] for unit in units]
        return [
            [self._cell(*cell) for cell in zip(row, units, zero, strict=True)]
            for row in self.frame.itertuples(index=False)
        ]

    def print_pt(self) -> float:
        """Size of the letters (pt) at which no word or number is broken on A4, within PRINTED."""
        cells = [self.header(), *self.rows()]
        longest = [
            max((_longest_word(text) for text in column), default=1) for column in zip(*cells, strict=True)
        ]
        room = PAPER_PT - COLUMN_GAP_PT * len(longest)
        return round(float(np.clip(room / (LETTER_WIDTH * sum(longest)), *PRINTED)), 2)

    def csv_name(self, chapter: str) -> str:
        """Name of the file in which a reader keeps the table."""
        said = re.findall(r"[a-z0-9]+", self.caption.lower())[:NAMED]
        return f"{chapter}-{'-'.join(said)}.csv"

    def csv_uri(self) -> str:
        """The table as csv with all its digits, as a data URI."""
        text = self.frame.to_csv(index=False)
        return f"data:text/csv;base64,{base64.b64encode(text.encode()).decode()}"

    def _largest(self, unit: str, units: Sequence[str]) -> float:
        """The largest number of all columns with a unit; nothing for numbers without one."""
        columns = [self.frame.iloc[:, i] for i, other in enumerate(units) if unit and other == unit]
        floats = [column for column in columns if pd.api.types.is_float_dtype(column)]
        sizes = [column[np.isfinite(column)].abs().max() for column in floats]
        return max((float(size) for size in sizes if isfinite(size)), default=0.0)

    def _cell(self, value: object, unit: str, zero: float) -> str:
        """A cell; stiffnesses (N/m) all with a power of ten, so that they can be read down a column."""
        if isinstance(value, bool | np.bool_):
            return "yes" if value else "no"
        if not isinstance(value, float):
            return "face gear" if value == "face_gear" else str(value)
        if value != value:
            return ""
        shown = 0.0 if abs(value) < zero else value
        return scientific(shown, self.digits) if unit == "n_per_m" and shown else number(shown, self.digits)


@dataclass(frozen=True)
class View:
    """What the viewer of a kind draws (plain values, arrays as base64), under a caption.

    Its controls stand in `<kind>_view.html.j2`, its script in `<kind>_view.js`.
    """

    data: Mapping[str, Any]
    caption: str
    kind: Literal["pair", "body"] = "pair"

    def packed(self) -> str:
        """The data as the page carries them."""
        return _packed(_json(self.data))


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
    pictures = [picture for chapter in chapters for picture in chapter.pictures]
    figures = {picture.anchor: picture.interactive for picture in pictures if picture.interactive}
    viewed = sorted({chapter.view.kind for chapter in chapters if chapter.view})
    return pages.render(
        TEMPLATE,
        title=title,
        lead=lead,
        chapters=chapters,
        css=_own("page.css"),
        tables=_own("tables.js"),
        packed=_own("packed.js") if viewed or figures else "",
        viewers=[_own(name) for name in ("viewer.js", *(f"{kind}_view.js" for kind in viewed))]
        if viewed
        else [],
        plots=_own("plots.js"),
        figures=_packed(_json(figures)) if figures else "",
        library=_packed(LIBRARY.read_bytes()) if figures else "",
    )


def _own(name: str) -> str:
    return (FOLDER / name).read_text(encoding="utf-8")


def _json(content: Any) -> bytes:
    return json.dumps(content, separators=(",", ":")).encode()


def _packed(content: bytes) -> str:
    """Compressed, as text; the same content gives the same text."""
    return base64.b64encode(gzip.compress(content, mtime=0)).decode()


def encoded(values: AnyArray, kind: type) -> str:
    """An array as text for a viewer: its bytes, little endian."""
    return base64.b64encode(values.astype(np.dtype(kind).newbyteorder("<")).tobytes()).decode()


def words(name: str) -> str:
    """A column's name as words, with its unit as it is written."""
    ending = ending_of(name)
    return (
        (f"{name} ".replace(f"_{ending} ", f" ({UNITS[ending]}) ") if ending else name)
        .replace("_", " ")
        .strip()
    )


def _longest_word(text: str) -> int:
    """Letters of the longest part of a cell that is not broken; a unit stays with its brackets."""
    return (
        LONG_COLUMN if len(text) > LONG else max((len(word) for word in unbroken(text).split(" ")), default=0)
    )


def unbroken(text: str) -> str:
    """Text whose units in brackets are not broken."""
    return re.sub(r"\(N m\)", "(N\u00a0m)", text)


def number(value: float, digits: int) -> str:
    """A number as all tables write it: `digits` of it significant, whole numbers in full.

    Below 1e-3 and from 1e6 on it has a power of ten.
    """
    if value == 0.0 or not isfinite(value):
        return f"{value:g}"
    if not PLAIN[0] <= abs(value) < PLAIN[1]:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{_shortened(mantissa)}e{int(exponent)}"
    return _shortened(f"{value:.{max(digits - 1 - floor(log10(abs(value))), 0)}f}")


def _shortened(text: str) -> str:
    """Without zeros at the end of a fraction."""
    return text.rstrip("0").rstrip(".") if "." in text else text


def scientific(value: float, digits: int) -> str:
    """A number with a power of ten, `digits` of it significant."""
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}e{int(exponent)}"
