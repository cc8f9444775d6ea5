"""Stored pictures as text inside a page."""

import re
from string import ascii_letters, digits
from urllib.parse import quote

DECIMALS = 2
"""Of a coordinate (1/72 inch) of a drawing on the page: a hundredth is not seen."""
UNESCAPED_CHARACTERS = frozenset(f'{ascii_letters}{digits}_.-~ !"$()*+,/:;=?@[]^`{{|}}')
"""Characters that a data URI between single quotes may hold as they are."""
GAPS = re.compile(r"\s+")
NUMBER = re.compile(r"(-?\d+\.\d+(?:e[-+]?\d+)?)")


def data_uri(still: str) -> str:
    """The text of a svg as a data URI that holds no single quote, for an attribute between such quotes.

    A drawing keeps its text and colours; its coordinates are rounded to DECIMALS.
    """
    drawing = shortened(still).replace("%", quote("%"))
    for letter in set(drawing) - UNESCAPED_CHARACTERS - {"%"}:
        drawing = drawing.replace(letter, quote(letter, safe=""))
    return f"data:image/svg+xml,{drawing}"


def shortened(svg: str) -> str:
    """The same drawing without its metadata, with rounded coordinates and without needless gaps."""
    drawing = re.sub(r"(?s)<metadata>.*?</metadata>|<\?xml.*?\?>|<!DOCTYPE.*?>", "", svg)
    drawing = re.sub(r'(?<=[ \n])(d|x|y|points)="([^"]*)"', _round_numbers, drawing)
    return GAPS.sub(" ", re.sub(r">\s+<", "><", drawing)).strip()


def _round_numbers(attribute: re.Match[str]) -> str:
    parts = NUMBER.split(attribute[2])
    parts[1::2] = [f"{round(float(number_text), DECIMALS):g}" for number_text in parts[1::2]]
    return f'{attribute[1]}="{GAPS.sub(" ", "".join(parts)).strip()}"'
