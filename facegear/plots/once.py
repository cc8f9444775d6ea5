"""What matplotlib works out many times while it lays out and writes a figure, found once.

Each pass over a figure asks for the ticks of an axis some six times, and for the layout of a text as often.
Neither changes as long as the size of the axis, its limits and the resolution are the same, nor the files
of a font and its letters ever.
"""

import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any
from unittest.mock import patch

import numpy as np
from matplotlib.axis import Axis
from matplotlib.font_manager import FontManager, FontProperties
from matplotlib.text import Text
from matplotlib.textpath import TextToPath

Method = Callable[..., Any]
Kept = tuple[type, str, Callable[[Method], Method]]

_TURN = threading.RLock()
"""One thread at a time: what it has put in the place of matplotlib's methods it takes out again."""


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
            *(text.get_text(), text.get_fontproperties().copy(), _resolution(text)),
            type(getattr(renderer, "picture", renderer)),
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


def _kept_sizes(find: Method) -> Method:
    """The size of a text."""
    kept: dict[Any, Any] = {}

    def sizes(reader: TextToPath, text: str, font: FontProperties, formula: Any) -> Any:
        look = text, font.copy(), formula
        if look not in kept:
            kept[look] = find(reader, text, font, formula)
        return kept[look]

    return sizes


def _kept_curves(find: Method) -> Method:
    """The curves of a text."""
    kept: dict[Any, Any] = {}

    def curves(reader: TextToPath, font: FontProperties, text: str, ismath: Any = False, **more: Any) -> Any:
        look = text, font.copy(), ismath, *more.items()
        if look not in kept:
            points, codes = find(reader, font, text, ismath, **more)
            kept[look] = np.reshape(points, (-1, 2)), np.array(codes, dtype=np.uint8)
        return kept[look]

    return curves


def _kept_letters(find: Method) -> Method:
    """The letters of a text and their places, those that are new to a drawing with their curves."""
    kept: dict[Any, Any] = {}

    def letters(
        reader: TextToPath,
        font: Any,
        text: str,
        glyph_map: Any = None,
        return_new_glyphs_only: bool = False,
        **more: Any,
    ) -> Any:
        look = font.fname, text, *more.items()
        if look not in kept:
            kept[look] = find(reader, font, text, **more)
        places, curves, boxes = kept[look]
        if glyph_map is None:
            return places, curves, boxes
        if return_new_glyphs_only:
            return places, {name: curve for name, curve in curves.items() if name not in glyph_map}, boxes
        glyph_map.update(curves)
        return places, glyph_map, boxes

    return letters


TEXTS: tuple[Kept, ...] = (
    (Text, "_get_layout", _kept_layouts),
    (TextToPath, "get_text_width_height_descent", _kept_sizes),
    (TextToPath, "get_text_path", _kept_curves),
    (TextToPath, "get_glyphs_with_font", _kept_letters),
    (FontManager, "_find_fonts_by_props", _kept_fonts),
)
"""Kind of object, its method, and what makes from the method one that keeps its answers."""
KEPT: tuple[Kept, ...] = (*TEXTS, (Axis, "_update_ticks", _kept_ticks))


@contextmanager
def found_once(kept: Iterable[Kept] = KEPT) -> Iterator[None]:
    """Let matplotlib keep what `kept` names while the body runs, in which no artist is changed.

    While several figures are written TEXTS alone may be kept: those that they share are read once for all.
    The names are matplotlib's own, found in 3.11; where one is missing, that is found as often as before.
    """
    with _TURN, ExitStack() as stack:
        for kind, name, keep in kept:
            method = getattr(kind, name, None)
            if method is not None:
                stack.enter_context(patch.object(kind, name, keep(method)))
        yield


def _resolution(artist: Axis | Text) -> float:
    figure = artist.get_figure(root=True)
    return float("nan") if figure is None else figure.dpi
