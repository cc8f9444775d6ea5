"""Pages from templates, and the drawings on them."""

from pathlib import Path
from typing import Any

from facegear.errors import extras_named

with extras_named():
    import jinja2
import re

from facegear.errors import CorruptFile
from facegear.io.atomic import verify


def render(template: Path, **values: Any) -> str:
    """Fill a template.

    Parameters
    ----------
    template : Path
        Jinja2 template.
    **values : Any
        Values by the names that the template uses; texts are escaped. A name that is missing is an error.

    Returns
    -------
    str
        The page.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(template.parent),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(template.name).render(**values)


WHOLE_SVG, TAIL = re.compile(r"(</svg>|<svg[^<]*/>)\s*$"), 1000
"""How a drawing ends, an empty one with its only element; letters at its end that are looked at."""


def read_svg(path: Path) -> str:
    """Return the text of a drawing, after it is checked against its manifest and for being whole.

    Parameters
    ----------
    path : Path
        File to read (svg).

    Returns
    -------
    str
        The text of the svg file.

    Raises
    ------
    CorruptFile
        If the file is missing, altered or cut off.
    """
    verify(path)
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise CorruptFile(path, "not a readable svg") from None
    if "<svg" not in text or not WHOLE_SVG.search(text[-TAIL:]):
        raise CorruptFile(path, "not a whole svg")
    return text
