"""A self-contained HTML page from chapters of text, tables and pictures."""

import base64
import gzip
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from pathlib import Path
from string import ascii_letters, digits
from typing import Any, Literal
from urllib.parse import quote

import numpy as np

from facegear.arrays import AnyArray
from facegear.io import documents, pages
from facegear.io.pages import read_svg
from facegear.report.first_screen import FirstScreen
from facegear.report.table import Table

DECIMALS = 2
"""Decimal places of a coordinate (1/72 inch) of a drawing on the page: a hundredth is not seen."""
UNESCAPED_CHARACTERS = frozenset(f'{ascii_letters}{digits}_.-~ !"$()*+,/:;=?@[]^`{{|}}')
"""Characters that a data URI between single quotes may hold as they are."""
GAPS = re.compile(r"\s+")
"""White space that one blank can stand for."""
NUMBER = re.compile(r"(-?\d+\.\d+(?:e[-+]?\d+)?)")
"""Decimal number in a svg."""


def data_uri(still: str) -> str:
    """Return a svg as a data URI without single quotes, for an attribute between such quotes.

    A drawing keeps its text and colours; its coordinates are rounded to DECIMALS.

    Parameters
    ----------
    still : str
        Text of the svg.

    Returns
    -------
    str
        The URI.
    """
    drawing = shortened(still).replace("%", quote("%"))
    for letter in set(drawing) - UNESCAPED_CHARACTERS - {"%"}:
        drawing = drawing.replace(letter, quote(letter, safe=""))
    return f"data:image/svg+xml,{drawing}"


def shortened(svg: str) -> str:
    """Return a drawing without its metadata, with rounded coordinates and without needless white space.

    Parameters
    ----------
    svg : str
        Text of the svg.

    Returns
    -------
    str
        The shorter text; values of d, x, y and points have DECIMALS decimals.
    """
    drawing = re.sub(r"(?s)<metadata>.*?</metadata>|<\?xml.*?\?>|<!DOCTYPE.*?>", "", svg)
    drawing = re.sub(r'(?<=[ \n])(d|x|y|points)="([^"]*)"', _round_numbers, drawing)
    return GAPS.sub(" ", re.sub(r">\s+<", "><", drawing)).strip()


def _round_numbers(attribute: re.Match[str]) -> str:
    """Return an attribute of a svg element, matched as (name, value), with its decimal numbers rounded
    to DECIMALS and single blanks.
    """
    parts = NUMBER.split(attribute[2])
    parts[1::2] = [f"{round(float(number_text), DECIMALS):g}" for number_text in parts[1::2]]
    return f'{attribute[1]}="{GAPS.sub(" ", "".join(parts)).strip()}"'


FOLDER = Path(__file__).parent
"""Folder of the page's parts."""
TEMPLATE = FOLDER / "page.html.j2"
"""Template of the page."""
LIBRARY = FOLDER / "plotly-cartesian.min.js"
"""plotly.js as its makers publish it, the part with curves, bars and maps; its licence stands beside it."""


@dataclass(frozen=True)
class Picture:
    """A stored svg with its caption."""

    path: Path
    caption: str

    @cached_property
    def still(self) -> str:
        """Text of the stored svg. Raises CorruptFile where the file is not whole."""
        return read_svg(self.path)

    @property
    def width_px(self) -> int:
        """Width of the svg in px (4/3 of a width in pt), at which its text has the size that it was
        drawn with; 0 if the svg states none.
        """
        match = re.search(r'<svg[^>]* width="([\d.]+)(pt|px)?"', self.still[:4000])
        return 0 if match is None else round(float(match[1]) * (4 / 3 if match[2] == "pt" else 1.0))

    @property
    def anchor(self) -> str:
        """Name of the figure for links inside the page: `figure-` and the file's name without its ending."""
        return f"figure-{self.path.stem}"

    @cached_property
    def interactive(self) -> Any:
        """Content of the json file beside the svg, which plotly.js draws in its place; None without
        such a file or data.

        Raises CorruptFile where that file is not whole.
        """
        json_path = self.path.with_suffix(".json")
        content = documents.read(json_path) if json_path.exists() else {}
        return content if content.get("data") else None

    def data_uri(self) -> str:
        """Return the picture as a data URI.

        Returns
        -------
        str
            The URI.
        """
        return data_uri(self.still)


@dataclass(frozen=True)
class View:
    """Content of an interactive view (plain values, arrays as base64), under a caption.

    Its controls stand in `<kind>_view.html.j2`, its script in `<kind>_view.js`.
    """

    data: Mapping[str, Any]
    caption: str
    kind: Literal["pair", "body"] = "pair"

    def compressed_data(self) -> str:
        """Return the data as JSON, compressed by gzip and encoded as base64, which the page's script unpacks.

        Returns
        -------
        str
            Text.
        """
        return _pack(_json(self.data))


@dataclass(frozen=True)
class Chapter:
    """One part of the page.

    Paragraphs of `text` are parted by empty lines; `view` is an interactive view in space.
    """

    title: str
    text: str
    pictures: Sequence[Picture] = ()
    tables: Sequence[Table] = ()
    view: View | None = None

    @property
    def anchor(self) -> str:
        """Title in small letters, with a hyphen for all but letters and digits, for links inside the page."""
        return "".join(letter if letter.isalnum() else "-" for letter in self.title.lower())


def render(title: str, lead: str, chapters: Sequence[Chapter], first: FirstScreen | None = None) -> str:
    """Write the page as HTML text that needs no other file.

    Parameters
    ----------
    title, lead : str
        Heading, and a line of text below it.
    chapters : sequence of Chapter
        Parts of the page in their order.
    first : FirstScreen or None
        What stands before the first chapter.

    Returns
    -------
    str
        The page.
    """
    pictures = [picture for chapter in chapters for picture in chapter.pictures]
    figures = {picture.anchor: picture.interactive for picture in pictures if picture.interactive}
    view_kinds = sorted({chapter.view.kind for chapter in chapters if chapter.view})
    return pages.render(
        TEMPLATE,
        title=title,
        lead=lead,
        chapters=chapters,
        first=first,
        css=_own_file("page.css"),
        tables=_own_file("tables.js"),
        packed=_own_file("packed.js") if view_kinds or figures else "",
        viewers=[_own_file(name) for name in ("viewer.js", *(f"{kind}_view.js" for kind in view_kinds))]
        if view_kinds
        else [],
        plots=_own_file("plots.js"),
        figures=_pack(_json(figures)) if figures else "",
        library=_pack(LIBRARY.read_bytes()) if figures else "",
    )


def _own_file(name: str) -> str:
    """Return the text of the file with a name in the folder of this module."""
    return (FOLDER / name).read_text(encoding="utf-8")


def _json(content: Any) -> bytes:
    """Return plain values as JSON without blanks, in UTF-8."""
    return json.dumps(content, separators=(",", ":")).encode()


def _pack(content: bytes) -> str:
    """Compress bytes and encode them as base64 text; equal content gives equal text."""
    return base64.b64encode(gzip.compress(content, mtime=0)).decode()


def encode_array(values: AnyArray, kind: type) -> str:
    """Encode an array for a viewer: its numbers as bytes, little endian, row by row, in base64.

    Parameters
    ----------
    values : AnyArray
        The array, of any shape (...).
    kind : type
        Type of number to which values are converted, such as np.float32.

    Returns
    -------
    str
        Text, without the shape; numbers keep their unit.
    """
    return base64.b64encode(values.astype(np.dtype(kind).newbyteorder("<")).tobytes()).decode()


END = "</header>"
"""End of the page's header, where the list stands."""
STYLE = "flex:1 1 100%;border:2px solid #b3261e;border-radius:6px;padding:.4em .8em;margin:.4em 0 0"
"""Style of the list: as wide as the header, whose layout is a row that wraps."""
LIST_STYLE = "margin:.2em 0;padding-left:1.2em"
"""Style of its lines."""


def with_omissions(page: str, omissions: Sequence[str]) -> str:
    """Return a page with a list of what is missing at the end of its header.

    Parameters
    ----------
    page : str
        The whole page, as HTML.
    omissions : sequence of str
        What could not be computed and why, a line each; nothing is inserted if there is none.

    Returns
    -------
    str
        The page.
    """
    if not omissions:
        return page
    head, end, rest = page.partition(END)
    lines = "".join(f"<li>{escape(line)}</li>" for line in omissions)
    note = (
        f'<section role="note" aria-label="Not computed" style="{STYLE}"><strong>Not computed. '
        f'The page shows everything else.</strong><ul style="{LIST_STYLE}">{lines}</ul></section>\n'
    )
    return f"{head}{note}{end}{rest}"
