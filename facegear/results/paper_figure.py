"""Figures of answers in the size and with the words of a publication."""

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from inspect import Parameter, signature
from math import inf
from typing import TYPE_CHECKING, Any

from facegear.errors import FacegearError

if TYPE_CHECKING:
    from facegear.plots.style import Figure

KEYWORDS_TEXT = """

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
        if size is not None and not _is_size(size):
            raise FacegearError(f"size = {size!r}: must be width and height in inches, both above 0")
        figure = plot(self, *arguments, **keywords)
        if size is not None:
            figure.set_size_inches(*size)
        if labels:
            from facegear.plots.style import rename_texts

            rename_texts(figure, labels)
        return figure

    plot_signature = signature(plot)
    extra = [Parameter(name, Parameter.KEYWORD_ONLY, default=None) for name in ("size", "labels")]
    parameters = sorted([*plot_signature.parameters.values(), *extra], key=lambda parameter: parameter.kind)
    drawn_to_size.__signature__ = plot_signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    drawn_to_size.__doc__ = (plot.__doc__ or "").rstrip() + KEYWORDS_TEXT
    return drawn_to_size


def _is_size(size: object) -> bool:
    """Whether a value is two numbers above 0."""
    return (
        isinstance(size, Sequence)
        and len(size) == 2
        and all(isinstance(length, int | float) and 0.0 < length < inf for length in size)
    )
