"""A self-contained HTML page from chapters of text, tables and pictures."""

import base64
import gzip
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np

from facegear.arrays import AnyArray
from facegear.io import documents, pages
from facegear.io.pictures import read_svg
from facegear.report.first_screen import FirstScreen
from facegear.report.stills import data_uri
from facegear.report.table import Table

FOLDER = Path(__file__).parent
TEMPLATE = FOLDER / "page.html.j2"
LIBRARY = FOLDER / "plotly-cartesian.min.js"
"""plotly.js as its makers publish it, the part with curves, bars and maps; its licence stands beside it."""


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
        """Interactive form of the picture, from the file beside it; nothing where it has no such form.

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

    def packed(self) -> str:
        """Return the data as the page carries them.

        Returns
        -------
        str
            Text.
        """
        return _pack(_json(self.data))


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


def render(title: str, lead: str, chapters: Sequence[Chapter], first: FirstScreen | None = None) -> str:
    """Write the page as HTML text that needs no other file.

    Parameters
    ----------
    title, lead : str
        Heading, and a line below it.
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
    return (FOLDER / name).read_text(encoding="utf-8")


def _json(content: Any) -> bytes:
    return json.dumps(content, separators=(",", ":")).encode()


def _pack(content: bytes) -> str:
    """Compressed, as text; the same content gives the same text."""
    return base64.b64encode(gzip.compress(content, mtime=0)).decode()


def encode_array(values: AnyArray, kind: type) -> str:
    """Encode an array as text for a viewer: its bytes, little endian.

    Parameters
    ----------
    values : AnyArray
        The array, of any shape (...).
    kind : type
        Type of its numbers.

    Returns
    -------
    str
        Text; numbers keep their unit.
    """
    return base64.b64encode(values.astype(np.dtype(kind).newbyteorder("<")).tobytes()).decode()
