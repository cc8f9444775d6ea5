"""Base of all results: content, origin, files, and figures in the size of a publication."""

from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from functools import wraps
from inspect import Parameter, signature
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import pandas as pd

from facegear.errors import FacegearError, extras_named, file_path
from facegear.io.tables import write_workbook
from facegear.pipeline.run import write_stage
from facegear.pipeline.table import STAGES
from facegear.report.figures.description import Figure

if TYPE_CHECKING:
    from facegear.report.figures.draw_matplotlib import MplFigure

Source = Literal["computed", "stored"]


@dataclass(frozen=True, eq=False)
class StageOutput:
    """Output of a stage: content of its files by name, its line of summary, and where it came from.

    `source` is `computed` if it was computed in this session, `stored` if it was read from files.
    """

    content: Mapping[str, Any]
    summary: str
    source: Source


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """Result of one stage, as an answer of a gearbox; `source` says whether it was computed now or
    stored by the workflow.

    Its tables are pandas frames; the unit of a column stands at the end of its name (`_um`,
    `_n_per_m`), and a column without one is a name, a count, a fraction or a ratio. Methods return
    copies.

    - STAGE: name of the stage
    - BESIDE: further parts of `content` by name, each from a stage and its file, which figures need
    - content: tables, arrays and records by name of the stage's file
    - values: plain values of the whole config
    """

    STAGE: ClassVar[str]
    BESIDE: ClassVar[Mapping[str, tuple[str, str]]] = {}

    content: Mapping[str, Any]
    summary: str
    source: Source
    values: Mapping[str, Any] = field(repr=False)

    def __post_init__(self) -> None:
        """Keep a copy of the config, so that no change of it by a user reaches later answers."""
        object.__setattr__(self, "values", deepcopy(self.values))

    def save(self, folder: str | Path) -> list[Path]:
        """Write the files that the workflow writes for this stage, below a folder.

        Parameters
        ----------
        folder : str or Path
            The folder.

        Returns
        -------
        list[Path]
            Paths of the files.
        """
        stage, folder = STAGES[self.STAGE], file_path(folder, "folder")
        paths = {name: str(folder / file.path) for name, file in stage.files.items()}
        return write_stage(stage, self.content, paths)

    def to_excel(self, path: str | Path) -> Path:
        """Write every table as a sheet of one workbook (.xlsx).

        Parameters
        ----------
        path : str or Path
            File to write.

        Returns
        -------
        Path
            The path. Raises MissingExtra where openpyxl is not installed.
        """
        with extras_named():
            return write_workbook(path, self._sheets())

    def _sheets(self) -> dict[str, pd.DataFrame]:
        """Return the tables of a workbook by the names of its sheets: all parts of `content` that are
        data frames.
        """
        return {name: part for name, part in self.content.items() if isinstance(part, pd.DataFrame)}

    def __repr__(self) -> str:
        """Return class, source and summary in one line."""
        return f"{type(self).__name__}({self.source}: {self.summary})"


def require_answers(beside: object, kind: type[Result]) -> None:
    """Refuse `beside` unless it maps labels to results of one class, as figures of several gearboxes
    need them.

    Parameters
    ----------
    beside : mapping of str to Result
        What a user gave as results of other gearboxes by label.
    kind : type
        Class that each result must have.

    Raises
    ------
    FacegearError
        For anything else.
    """
    if not isinstance(beside, Mapping) or not all(isinstance(answer, kind) for answer in beside.values()):
        raise FacegearError(
            f"beside = {beside!r}: must be answers of other gearboxes of the same kind by label"
        )


KEYWORDS_TEXT = """

        `size`: width and height in inches; `labels`: other words for texts of the figure (axes, titles,
        legend), by the text that stands there. Raises FacegearError for a text that the figure does not have.
        """
"""Text added to the docstring of a method that draws a figure."""


def fit_for_paper(plot: Callable[..., "Figure"]) -> Callable[..., "MplFigure"]:
    """Decorate a method that describes a figure, so that it draws the figure and takes the keywords
    `size` and `labels`.

    Parameters
    ----------
    plot : callable
        Method of a result that returns the description of a figure (`Figure`), independent of any
        library.

    Returns
    -------
    callable
        A method that returns a matplotlib figure. `size` is width and height in inches, `labels` maps
        texts of the figure to other ones. Attribute `describe` is the given method.
    """

    @wraps(plot)
    def drawn_to_size(
        self: Any,
        *arguments: Any,
        size: tuple[float, float] | None = None,
        labels: Mapping[str, str] | None = None,
        **keywords: Any,
    ) -> "MplFigure":
        """Draw what the method describes with matplotlib, at `size` (inches; None for the default),
        with texts replaced by `labels`.
        """
        # matplotlib: a second that only drawing needs
        from facegear.report.figures.draw_matplotlib import draw, rename_texts

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
    """Whether a value is a pair of finite numbers above 0, such as width and height in inches."""
    return (
        isinstance(size, Sequence)
        and len(size) == 2
        and all(isinstance(length, int | float) and 0.0 < length < inf for length in size)
    )
