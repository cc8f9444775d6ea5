"""Read stored pictures, refusing those that are cut off or altered."""

import re
from pathlib import Path

from facegear.errors import CorruptFile
from facegear.io.checksums import verify

PNG_START, PNG_END = b"\x89PNG\r\n\x1a\n", b"IEND\xaeB`\x82"
"""First and last bytes of every PNG file."""
WHOLE_SVG, TAIL = re.compile(r"(</svg>|<svg[^<]*/>)\s*$"), 1000
"""How a drawing ends, an empty one with its only element; letters at its end that are looked at."""


def read_svg(path: Path) -> str:
    """Return the text of a drawing. Raises CorruptFile if it is missing, altered or cut off."""
    verify(path)
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise CorruptFile(path, "not a readable svg") from None
    if "<svg" not in text or not WHOLE_SVG.search(text[-TAIL:]):
        raise CorruptFile(path, "not a whole svg")
    return text


def read_png(path: Path) -> bytes:
    """Return the bytes of a picture. Raises CorruptFile if it is missing, altered or cut off."""
    verify(path)
    content = path.read_bytes()
    if not (content.startswith(PNG_START) and content.endswith(PNG_END)):
        raise CorruptFile(path, "not a whole png")
    return content
