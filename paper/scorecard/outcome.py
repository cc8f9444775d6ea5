"""What a criterion answers, and where it looks."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

Tables = Mapping[str, pd.DataFrame]
"""Stored results by name: frequencies, tvms, sharing, curves, reference, response, spectrum, sweep, jumps."""


@dataclass(frozen=True)
class ClaimOutcome:
    """Our number (None for a statement), the same in words, and whether the statement holds.

    For a number `holds` is decided by the claim's tolerance and left None here. A number that is the nearest
    of several names all of them in `candidates`, and in `span` the range in which they were looked for. One
    that is not the same in every cycle, or from every start, names its range in `windows`.
    """

    value: float | None
    shown: str
    holds: bool | None = None
    candidates: tuple[float, ...] = ()
    span: tuple[float, float] | None = None
    windows: tuple[float, float] | None = None

    def chance(self, tolerance: float) -> float | None:
        """Share of the span from which some candidate is within the tolerance.

        With this probability a number picked at random in the span would be met. None for other outcomes.
        """
        if self.span is None:
            return None
        low, high = self.span
        edges = np.clip([[at - tolerance, at + tolerance] for at in sorted(self.candidates)], low, high)
        covered, end = 0.0, low
        for left, right in edges:
            covered += max(0.0, right - max(left, end))
            end = max(end, right)
        return covered / (high - low)


Criterion = Callable[..., ClaimOutcome]
"""Takes the tables and the claim's arguments by name; its docstring is the stated criterion."""


def number(value: float, digits: int = 6) -> ClaimOutcome:
    """Outcome of a numeric claim."""
    return ClaimOutcome(float(value), f"{value:.{digits}g}")


def nearest(candidates: Iterable[float], near: float, span: tuple[float, float], name: str) -> ClaimOutcome:
    """Outcome of a numeric claim that the nearest of several candidates answers."""
    values = tuple(float(value) for value in candidates)
    if not values:
        return ClaimOutcome(None, f"no {name}", span=span)
    value = min(values, key=lambda at: abs(at - near))
    return ClaimOutcome(value, f"{value:.6g}", candidates=values, span=span)


def statement(holds: bool, shown: str) -> ClaimOutcome:
    """Outcome of a statement with the evidence in words."""
    return ClaimOutcome(None, shown, bool(holds))


def describe(criterion: Criterion, args: Mapping[str, Any]) -> str:
    """The stated criterion: the first paragraph of its docstring, with the arguments."""
    text = " ".join((criterion.__doc__ or "").split("\n\n")[0].split())
    values = ", ".join(f"{name} = {value}" for name, value in args.items())
    return f"{text} ({values})" if values else text
