"""Figures of answers in the size and with the words of a publication."""

from collections.abc import Callable, Mapping
from functools import wraps
from inspect import Parameter, signature
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from facegear.plots.style import Figure

ADDED = """

        `size`: width and height in inches; `labels`: other words for texts of the figure (axes, titles,
        legend), by the text that stands there. Raises FacegearError for a text that the figure does not have.
        """


def fit_for_paper(plot: Callable[..., "Figure"]) -> Callable[..., "Figure"]:
    """Give a method that draws a figure the keywords `size` and `labels`.

    Parameters
    ----------
    plot : callable
        Method of an answer that returns a figure.

    Returns
    -------
    callable
        The method with two more keywords.
    """

    @wraps(plot)
    def drawn_to_size(
        self: Any,
        *arguments: Any,
        size: tuple[float, float] | None = None,
        labels: Mapping[str, str] | None = None,
        **keywords: Any,
    ) -> "Figure":
        figure = plot(self, *arguments, **keywords)
        if size is not None:
            figure.set_size_inches(*size)
        if labels:
            from facegear.plots.style import rename_texts

            rename_texts(figure, labels)
        return figure

    known = signature(plot)
    extra = [Parameter(name, Parameter.KEYWORD_ONLY, default=None) for name in ("size", "labels")]
    drawn_to_size.__signature__ = known.replace(parameters=_before_keywords(known.parameters, extra))  # type: ignore[attr-defined]
    drawn_to_size.__doc__ = (plot.__doc__ or "").rstrip() + ADDED
    return drawn_to_size


def _before_keywords(known: Mapping[str, Parameter], extra: list[Parameter]) -> list[Parameter]:
    """Return parameters in an order that Python allows: any `**keywords` come last."""
    every = [*known.values(), *extra]
    return sorted(every, key=lambda one: one.kind)
