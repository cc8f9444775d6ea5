"""What is found once while a figure is written changes no byte of it."""

import threading
from contextlib import nullcontext

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axis import Axis

from facegear.plots import style
from facegear.plots.once import TEXTS, found_once


def stacked():
    """Panels of different height that share the ticks of x, with offsets and texts of several kinds."""
    with style.styled():
        figure, axes = plt.subplots(3, 1, figsize=(4.7, 6.0), sharex=True, height_ratios=(1, 2, 3))
        for axis, scale in zip(axes, (1e-7, 1.0, 1e8), strict=True):
            axis.plot(1e6 + np.arange(5.0), scale * np.arange(5.0) ** 2, label=f"scale 10$^{{{scale:g}}}$")
            axis.set_title("first\nsecond", fontsize=9 + axes.tolist().index(axis))
            axis.legend()
        axes[1].set_yscale("symlog")
        figure.supylabel("both")
    return figure


def shared_across():
    """Panels of different width that share the scale of x: the narrow one has fewer ticks."""
    with style.styled():
        figure, axes = plt.subplots(1, 2, figsize=(4.7, 2.0), sharex=True, width_ratios=(6, 1))
        for axis in axes:
            axis.plot(1e7 + np.arange(50.0), np.arange(50.0))
    return figure


def drawing():
    """A drawing in space."""
    with style.styled():
        figure, axis = plt.subplots(subplot_kw={"projection": "3d"})
        axis.plot([0.0, 1.0], [0.0, 2.0], [1.0, 3.0])
    return figure


@pytest.mark.parametrize("made", [stacked, shared_across, drawing])
def test_a_figure_is_the_same_file_as_with_everything_found_anew(made, tmp_path, monkeypatch):
    endings = ("svg", "png", "json")
    style.save(made(), *(tmp_path / f"once.{ending}" for ending in endings))
    monkeypatch.setattr(style, "found_once", nullcontext)
    style.save(made(), *(tmp_path / f"anew.{ending}" for ending in endings))
    for ending in endings:
        assert (tmp_path / f"once.{ending}").read_bytes() == (tmp_path / f"anew.{ending}").read_bytes()


def test_figures_that_share_texts_are_the_same_files_as_each_alone(tmp_path):
    with found_once(TEXTS):
        for made in (stacked, shared_across):
            style.save(made(), *(tmp_path / f"{made.__name__}.{ending}" for ending in ("svg", "png")))
    style.save(shared_across(), tmp_path / "alone.svg", tmp_path / "alone.png")
    for ending in ("svg", "png"):
        assert (tmp_path / f"shared_across.{ending}").read_bytes() == (
            tmp_path / f"alone.{ending}"
        ).read_bytes()


def test_nothing_is_kept_after_a_figure_is_written(tmp_path):
    before = Axis._update_ticks
    figure = stacked()
    style.save(figure, tmp_path / "a.png")
    assert Axis._update_ticks is before


def test_nothing_is_kept_where_two_threads_write_figures():
    """The one that began first took its own methods out, and the other put them in again for good."""
    before, begun, over = Axis._update_ticks, threading.Event(), threading.Event()

    def first():
        with found_once():
            begun.set()
            over.wait(0.3)

    def second():
        begun.wait()
        with found_once():
            over.set()
            one.join(0.3)

    one, other = threading.Thread(target=first), threading.Thread(target=second)
    for thread in (one, other):
        thread.start()
    for thread in (one, other):
        thread.join()
    assert Axis._update_ticks is before


def test_ticks_follow_the_limits_of_their_axis():
    figure = stacked()
    with found_once():
        figure.draw_without_rendering()
        few = [text.get_text() for text in figure.axes[2].get_yticklabels()]
        figure.axes[2].set_ylim(0.0, 1.0)
        figure.draw_without_rendering()
        assert [text.get_text() for text in figure.axes[2].get_yticklabels()] != few
    plt.close(figure)
