"""Drawing and picture of a figure, made at once, are those that matplotlib makes one after the other."""

import re

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.font_manager import FontProperties
from PIL import Image

from facegear.plots import style
from facegear.plots.both import Picture

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
MADE_UP = re.compile(r'base64,[^"]*|id="[^"]*"|url\([^)]*\)|href="[^"]*"|(?s:<metadata>.*?</metadata>)')


def curves():
    """Lines, marks, areas, bars, a formula, turned text and a legend; a height that is no whole pixel."""
    with style.styled():
        figure, (axis, below) = plt.subplots(2, 1, figsize=(4.7, 1.2 + 1.7 * 3 + 0.003))
        x = np.linspace(0.0, 1.0, 200)
        axis.plot(x, np.sin(20.0 * x), "o--", markevery=9, label="10$^{-4}$ s")
        axis.fill_between(x, 0.1, 0.3, alpha=0.2)
        axis.set(ylabel="turned", ylim=(-0.5, 0.5))
        axis.annotate("a note", (0.5, 0.2), rotation=30)
        axis.legend()
        below.bar(["one", "two"], [1.0, 2.0])
        below.scatter([0, 1], [0.5, 0.7], s=20)
    return figure


def maps():
    """A map kept as pixels in the drawing, one of areas, and a bar of colours."""
    with style.styled():
        figure, axes = plt.subplots(2, 1, figsize=(4.0, 5.0))
        x, y = np.meshgrid(np.arange(9.0), np.arange(7.0))
        smooth = axes[0].pcolormesh(x, y, x * y, shading="gouraud", rasterized=True)
        axes[0].plot(x[0], x[0] / 2, "s", rasterized=True)
        axes[1].pcolormesh(x, y, (x * y)[:-1, :-1])
        figure.colorbar(smooth, ax=axes)
    return figure


@pytest.mark.parametrize("text", ["input rotation speed", "10$^{-4}$ s"])
def test_letters_are_as_wide_at_every_resolution(text):
    """Those that stand on whole pixels are wider or narrower by up to some per cent."""
    font = FontProperties(size=9)
    coarse, fine = (
        Picture(10, 10, dpi).get_text_width_height_descent(text, font, "$" in text) for dpi in (72, 301)
    )
    np.testing.assert_allclose(np.array(fine) / 301, np.array(coarse) / 72, rtol=1e-12)


def test_every_path_is_written_though_several_have_one_ending(tmp_path):
    """Of two paths with one ending only the last was written."""
    paths = [tmp_path / f"{name}.{ending}" for name in ("first", "last") for ending in ("svg", "png", "json")]
    style.save(curves(), *paths)
    assert all(path.stat().st_size for path in paths)


def drawing():
    """A drawing in space."""
    with style.styled():
        figure, axis = plt.subplots(subplot_kw={"projection": "3d"})
        axis.bar3d([0.0, 1.0], [0.0, 1.0], 0.0, 0.5, 0.5, [1.0, 2.0])
    return figure


@pytest.mark.parametrize("made", [curves, maps, drawing])
def test_both_are_what_matplotlib_draws_one_by_one(made, tmp_path):
    style.save(made(), tmp_path / "both.svg", tmp_path / "both.png")
    style.save(made(), tmp_path / "alone.png")
    style.save(made(), tmp_path / "alone.svg")
    pictures = [np.asarray(Image.open(tmp_path / f"{name}.png").convert("RGB")) for name in ("both", "alone")]
    np.testing.assert_array_equal(*pictures)
    texts = [MADE_UP.sub("", (tmp_path / f"{name}.svg").read_text()) for name in ("both", "alone")]
    parts = [NUMBER.sub("#", text).splitlines() for text in texts]
    assert parts[0] == parts[1], "the same parts, and no curve is coarser"
    curves = [
        np.array(
            [float(number) for line in re.findall(r' d="([^"]*)"', text) for number in NUMBER.findall(line)]
        )
        for text in texts
    ]
    np.testing.assert_allclose(*curves, atol=0.01)
