"""What matplotlib works out many times while it lays out and writes a figure, found once.

Each pass over a figure asks for the ticks of an axis some six times, and for the layout of a text as often.
Neither changes as long as the size of the axis, its limits and the resolution are the same, nor the files
of a font ever.
"""

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any
from unittest.mock import patch

from matplotlib.axis import Axis
from matplotlib.font_manager import FontManager, FontProperties
from matplotlib.text import Text

Method = Callable[..., Any]

_TURN = threading.RLock()
"""One thread at a time: what it has put in the place of matplotlib's methods it takes out again."""


@contextmanager
def found_once() -> Iterator[None]:
    """Let matplotlib keep ticks, text layouts and fonts while the body runs, in which no artist is changed.

    The names are matplotlib's own, found in 3.11; where one is missing, that is found as often as before.
    """
    with _TURN, ExitStack() as stack:
        for kind, name, keep in KEPT:
            method = getattr(kind, name, None)
            if method is not None:
                stack.enter_context(patch.object(kind, name, keep(method)))
        yield


def _kept_ticks(find: Method) -> Method:
    """The ticks of an axis with the same limits and length as when they were last found.

    Axes that share a scale share what names its ticks: theirs are kept while they all look the same.
    """
    kept: dict[Axis, tuple[Any, Any]] = {}
    named: dict[Any, Any] = {}

    def ticks(axis: Axis) -> Any:
        look = (*axis.get_view_interval(), *axis.axes.bbox.size, _resolution(axis))
        if axis.axes.name == "3d":
            return find(axis)
        if named.get(axis.major) != look or kept.get(axis, (None,))[0] != look:
            kept[axis] = look, find(axis)
            named[axis.major] = look
        return kept[axis][1]

    return ticks


def _kept_layouts(find: Method) -> Method:
    """The layout of a text, which all texts have that are written and turned alike."""
    kept: dict[Any, Any] = {}

    def layout(text: Text, renderer: Any) -> Any:
        if text.get_wrap() or text.get_transform_rotates_text():
            return find(text, renderer)
        look = (
            *(text.get_text(), text.get_fontproperties().copy(), _resolution(text), type(renderer)),
            *(text.get_rotation(), text.get_rotation_mode(), text.get_ha(), text.get_va()),
            *(text.get_usetex(), text.get_parse_math(), text._linespacing, text._multialignment),
        )
        if look not in kept:
            kept[look] = find(text, renderer)
        return kept[look]

    return layout


def _kept_fonts(find: Method) -> Method:
    """The files of a font."""
    kept: dict[FontProperties, Any] = {}

    def fonts(manager: FontManager, font: FontProperties) -> Any:
        if font not in kept:
            kept[font.copy()] = find(manager, font)
        return kept[font]

    return fonts


KEPT = (
    (Axis, "_update_ticks", _kept_ticks),
    (Text, "_get_layout", _kept_layouts),
    (FontManager, "_find_fonts_by_props", _kept_fonts),
)
"""Kind of object, its method, and what makes from the method one that keeps its answers."""


def _resolution(artist: Axis | Text) -> float:
    figure = artist.get_figure(root=True)
    return float("nan") if figure is None else figure.dpi
