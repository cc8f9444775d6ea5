"""Result of a criterion, and the tables that it reads."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

Tables = Mapping[str, pd.DataFrame]
"""Stored results by name: frequencies, tvms, sharing, curves, reference, response, spectrum, sweep, jumps."""


@dataclass(frozen=True)
class ClaimOutcome:
    """Our number (None for a statement), the same in words (`text`), and whether the statement holds.

    For a number `holds` is decided by the claim's tolerance and left None here. A number that is the nearest
    of several names all of them in `candidates`, and in `span` the range in which they were searched. One
    that is not the same in every cycle, or from every start, names its range in `windows`.
    """

    value: float | None
    text: str
    holds: bool | None = None
    candidates: tuple[float, ...] = ()
    span: tuple[float, float] | None = None
    windows: tuple[float, float] | None = None

    def chance(self, tolerance: float) -> float | None:
        """Return the share of the span from which some candidate is within the tolerance.

        With this probability a number picked at random in the span would be met.

        Parameters
        ----------
        tolerance : float
            Tolerance of the claim, in its unit.

        Returns
        -------
        float or None
            Share, 0 to 1; None for outcomes without a span.
        """
        if self.span is None:
            return None
        low, high = self.span
        edges = np.clip([[at - tolerance, at + tolerance] for at in sorted(self.candidates)], low, high)
        covered_length, end = 0.0, low
        for left, right in edges:
            covered_length += max(0.0, right - max(left, end))
            end = max(end, right)
        return covered_length / (high - low)


Criterion = Callable[..., ClaimOutcome]
"""Takes the tables and the claim's arguments by name; its docstring is the stated criterion."""


def number(value: float, digits: int = 6) -> ClaimOutcome:
    """Return the outcome of a numeric claim.

    Parameters
    ----------
    value : float
        The number, in the unit of the claim.
    digits : int
        Number of digits of the text.

    Returns
    -------
    ClaimOutcome
        The number and its text.
    """
    return ClaimOutcome(float(value), f"{value:.{digits}g}")


def nearest(candidates: Iterable[float], near: float, span: tuple[float, float], name: str) -> ClaimOutcome:
    """Return the outcome of a numeric claim that the nearest of several candidates answers.

    Parameters
    ----------
    candidates : Iterable[float]
        Numbers, in the unit of the claim.
    near : float
        The number of the paper, in the same unit.
    span : tuple[float, float]
        Range in which they were searched, in the same unit.
    name : str
        Noun for a candidate, for the text if there is none.

    Returns
    -------
    ClaimOutcome
        The nearest number, or none.
    """
    values = tuple(float(value) for value in candidates)
    if not values:
        return ClaimOutcome(None, f"no {name}", span=span)
    value = min(values, key=lambda at: abs(at - near))
    return ClaimOutcome(value, f"{value:.6g}", candidates=values, span=span)


def statement(holds: bool, text: str) -> ClaimOutcome:
    """Return the outcome of a statement with the evidence in words.

    Parameters
    ----------
    holds : bool
        Whether the statement holds.
    text : str
        The evidence.

    Returns
    -------
    ClaimOutcome
        The outcome.
    """
    return ClaimOutcome(None, text, bool(holds))


def describe(criterion: Criterion, args: Mapping[str, Any]) -> str:
    """Return the stated criterion: the first paragraph of its docstring, with the arguments.

    Parameters
    ----------
    criterion : Criterion
        The criterion.
    args : Mapping[str, Any]
        Arguments of the claim by name.

    Returns
    -------
    str
        One line of text.
    """
    text = " ".join((criterion.__doc__ or "").split("\n\n")[0].split())
    values = ", ".join(f"{name} = {value}" for name, value in args.items())
    return f"{text} ({values})" if values else text
