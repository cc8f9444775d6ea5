"""Texts, numbers and colours of matplotlib as plotly.js takes them."""

import re
from typing import Any

import numpy as np
from matplotlib.colors import to_hex, to_rgba

from facegear.arrays import Array

DIGITS = 6
"""Significant digits of a value of a curve."""
LETTERS = {r"\gamma": "γ", r"\mu": "µ", r"\theta": "θ", r"\delta": "δ", r"\lambda": "λ"}


def markup(text: str) -> str:
    """Text of matplotlib as that of plotly.js: formulas and line ends."""
    formula = re.sub(r"\$([^$]*)\$", lambda match: _formula(match[1]), text)
    return formula.replace("\n", "<br>")


def _formula(text: str) -> str:
    for name, letter in LETTERS.items():
        text = text.replace(name, letter)
    for sign, tag in (("^", "sup"), ("_", "sub")):
        text = re.sub(rf"\{sign}(?:\{{([^}}]*)\}}|(.))", rf"<{tag}>\1\2</{tag}>", text)
    return text.replace("-", "−")


def name_and_unit(label: str) -> tuple[str, str]:
    """An axis label's first words, and the unit in its last brackets."""
    unit = re.search(r"\(([^()]*)\)", label)
    name = label.partition("(")[0] if unit else label
    return markup(" ".join(name.split())), markup(unit[1]) if unit else ""


def numbers(values: Any, digits: int = DIGITS) -> list[float | None]:
    """Plain values with so many significant digits; None where there is none."""
    given: Array = np.ma.filled(np.ma.asarray(values, dtype=float), np.nan).ravel()
    return [float(f"{value:.{digits}g}") if np.isfinite(value) else None for value in given]


def colour(value: Any) -> str:
    """A colour as CSS writes it."""
    red, green, blue, alpha = to_rgba(value)
    if alpha >= 1.0:
        return str(to_hex(value))
    return f"rgba({round(255 * red)},{round(255 * green)},{round(255 * blue)},{alpha:.3g})"


def scale(colours: Any, steps: int = 12) -> list[list[Any]]:
    """A colour map as plotly.js takes it."""
    return [[round(float(at), 4), to_hex(colours(float(at)))] for at in np.linspace(0.0, 1.0, steps)]
