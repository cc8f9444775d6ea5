"""Figures of answers in the size and with the words of a publication."""

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from inspect import Parameter, signature
from math import inf
from typing import TYPE_CHECKING, Any

from facegear.errors import FacegearError

if TYPE_CHECKING:
    from facegear.plots.description import Figure
    from facegear.plots.draw_matplotlib import MplFigure

KEYWORDS_TEXT = """

        `size`: width and height in inches; `labels`: other words for texts of the figure (axes, titles,
        legend), by the text that stands there. Raises FacegearError for a text that the figure does not have.
        """


def fit_for_paper(plot: Callable[..., "Figure"]) -> Callable[..., "MplFigure"]:
    """Give a method that describes a figure the keywords `size` and `labels`, and draw what it describes.

    Parameters
    ----------
    plot : callable
        Method of an answer that returns the description of a figure.

    Returns
    -------
    callable
        A method with two more keywords that returns a figure of matplotlib; its `describe` is the given one.
    """

    @wraps(plot)
    def drawn_to_size(
        self: Any,
        *arguments: Any,
        size: tuple[float, float] | None = None,
        labels: Mapping[str, str] | None = None,
        **keywords: Any,
    ) -> "MplFigure":
        from facegear.plots.draw_matplotlib import draw, rename_texts

        if size is not None and not _is_size(size):
            raise FacegearError(f"size = {size!r}: must be width and height in inches, both above 0")
        mpl_figure = draw(plot(self, *arguments, **keywords), size)
        if labels:
            rename_texts(mpl_figure, labels)
        return mpl_figure

    plot_signature = signature(plot)
    extra = [Parameter(name, Parameter.KEYWORD_ONLY, default=None) for name in ("size", "labels")]
    parameters = sorted([*plot_signature.parameters.values(), *extra], key=lambda parameter: parameter.kind)
    drawn_to_size.__signature__ = plot_signature.replace(  # type: ignore[attr-defined]
        parameters=parameters, return_annotation="matplotlib.figure.Figure"
    )
    drawn_to_size.__doc__ = (plot.__doc__ or "").rstrip() + KEYWORDS_TEXT
    drawn_to_size.describe = plot  # type: ignore[attr-defined]
    return drawn_to_size


def _is_size(size: object) -> bool:
    """Whether a value is two numbers above 0."""
    return (
        isinstance(size, Sequence)
        and len(size) == 2
        and all(isinstance(length, int | float) and 0.0 < length < inf for length in size)
    )
