"""Time and memory against size."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

from facegear.report.figures.draw_matplotlib import styled
from validation.growth.measure import exponents

COLUMNS = 2
BRIEF = 1e-2
"""Calls below this many seconds are drawn in microseconds."""
SPAN = 4.0
"""Ratio that the scale of times spans at least: what does not grow shall look so."""


def growth_figure(table: pd.DataFrame, texts: Mapping[str, tuple[str, str]]) -> Figure:
    """Draw one panel for each curve of a growth table: CPU time (left scale), memory of the process (right
    scale).

    The dashed line is the fitted power law.

    Parameters
    ----------
    table : DataFrame
        Table of `growth_table`.
    texts : Mapping[str, tuple[str, str]]
        Meaning of the sizes of each curve, and of its time.

    Returns
    -------
    Figure
        The figure.
    """
    fits = exponents(table).set_index("curve")
    curves = list(fits.index)
    rows = -(-len(curves) // COLUMNS)
    with styled():
        figure, axes = plt.subplots(rows, COLUMNS, figsize=(7.5, 2.7 * rows), squeeze=False)
        for axis, name in zip(axes.flat, curves, strict=False):
            curve, (size, task) = table[table["curve"] == name], texts[name]
            exponent = fits.loc[name, "exponent"]
            unit, factor = ("us", 1e6) if curve["seconds"].max() < BRIEF else ("s", 1.0)
            times = factor * curve["seconds"]
            middle = times.prod() ** (1 / len(curve))
            centre = curve["size"].prod() ** (1 / len(curve))
            axis.loglog(curve["size"], times, "o-", color="C0")
            axis.loglog(
                curve["size"], middle * (curve["size"] / centre) ** exponent, "--", color="C0", lw=0.8
            )
            low, high = axis.get_ylim()
            axis.set_ylim(min(low, middle / SPAN**0.5), max(high, middle * SPAN**0.5))
            axis.set(xlabel=size, title=f"{task}\nexponent {exponent:.2f}")
            axis.set_ylabel(f"CPU time ({unit})", color="C0")
            for scale in (axis.xaxis, axis.yaxis):
                _plain(scale)
            memory = axis.twinx()
            memory.plot(curve["size"], curve["peak_mb"] / 1e3, "s-", color="C1", ms=4)
            memory.set(ylim=(0, 1.15e-3 * curve["peak_mb"].max()))
            memory.set_ylabel("peak memory (GB)", color="C1")
            memory.grid(visible=False)
            memory.spines["right"].set_visible(True)
        for axis in axes.flat[len(curves) :]:
            axis.set_axis_off()
    return figure


def _plain(scale: Axis) -> None:
    """Numbers written out at 1, 2 and 5 of each decade of a logarithmic scale."""
    scale.set(
        major_locator=LogLocator(subs=(1, 2, 5)),
        major_formatter=ScalarFormatter(),
        minor_formatter=NullFormatter(),
    )
