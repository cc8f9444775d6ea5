"""A curve of two folders of results laid over each other."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from facegear.plots.style import NARROW, legend_above, styled


def curves_compared(
    old: pd.DataFrame, new: pd.DataFrame, x: str, y: str, labels: tuple[str, str], title: str
) -> Figure:
    """Above both curves `y` over `x`, below what the new one has more; both tables are of one series.

    `labels`: `x` and `y` in words.
    """
    both = old[[x, y]].merge(new[[x, y]], on=x, suffixes=("_old", "_new"))
    with styled():
        figure, (top, bottom) = plt.subplots(2, 1, figsize=(NARROW, 4.6), sharex=True, height_ratios=(2, 1))
        top.plot(old[x], old[y], "-", color="tab:blue", lw=2.2, alpha=0.6, label="old")
        top.plot(new[x], new[y], "--", color="k", lw=1.1, label="new")
        top.set(ylabel=labels[1])
        legend_above(top, 2, right=True)
        bottom.axhline(0.0, color="0.6", lw=0.8)
        bottom.plot(both[x], both[f"{y}_new"] - both[f"{y}_old"], "-", color="tab:red", lw=1.2)
        bottom.set(xlabel=labels[0], ylabel="new - old")
        figure.suptitle(title, fontsize=9)
    return figure
