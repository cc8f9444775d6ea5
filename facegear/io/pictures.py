"""Read stored pictures, refusing those that are cut off or altered."""

import re
from pathlib import Path

from facegear.errors import CorruptFile
from facegear.io.atomic import verify

WHOLE_SVG, TAIL = re.compile(r"(</svg>|<svg[^<]*/>)\s*$"), 1000
"""How a drawing ends, an empty one with its only element; letters at its end that are looked at."""


def read_svg(path: Path) -> str:
    """Return the text of a drawing.

    Parameters
    ----------
    path : Path
        File to read (svg).

    Returns
    -------
    str
        The text.

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
