"""What a criterion answers, and where it looks."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

Tables = Mapping[str, pd.DataFrame]
"""Stored results by name: frequencies, tvms, sharing, curves, reference, response, spectrum, sweep, jumps."""


@dataclass(frozen=True)
class Outcome:
    """Our number (None for a statement), the same in words, and whether the statement holds.

    For a number `holds` is decided by the claim's tolerance and left None here.
    """

    value: float | None
    shown: str
    holds: bool | None = None


Criterion = Callable[..., Outcome]
"""Takes the tables and the claim's arguments by name; its docstring is the stated criterion."""


def number(value: float, digits: int = 6) -> Outcome:
    """Outcome of a numeric claim."""
    return Outcome(float(value), f"{value:.{digits}g}")


def statement(holds: bool, shown: str) -> Outcome:
    """Outcome of a statement with the evidence in words."""
    return Outcome(None, shown, bool(holds))


def describe(criterion: Criterion, args: Mapping[str, Any]) -> str:
    """The stated criterion: the first paragraph of its docstring, with the arguments."""
    text = " ".join((criterion.__doc__ or "").split("\n\n")[0].split())
    values = ", ".join(f"{name} = {value}" for name, value in args.items())
    return f"{text} ({values})" if values else text
