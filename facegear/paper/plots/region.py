"""The region of likely inputs: how each number is spread in it, and how they hang together."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator

from facegear.paper.config.sections import Ranges
from facegear.paper.identify.inputs import BEARINGS, LOGARITHMIC
from facegear.plots.style import NARROW, styled

BINS = 12
LABELS = {
    "per_input_n_m": "Torque per engine (N m)",
    "tail_share": "Power at the tail, share",
    "error_phase_deg": "Phase of e(t) (deg)",
    "stiffness_variation": "Variation of k(t), factor",
    "mid_bearing_n_per_m": "Mid pinion bearing (N/m)",
    "stiff_bearing_n_per_m": "Stiff pinion bearing (N/m)",
}
SHORT = ("torque", "tail", "phase", "variation", "mid bearing", "stiff bearing")


def region_figure(region: pd.DataFrame, correlations: pd.DataFrame, ranges: Ranges) -> Figure:
    """Histograms of the numbers over the ranges searched, and their rank correlations below."""
    limits = {
        "per_input_n_m": ranges.per_input_n_m,
        "tail_share": ranges.tail_share,
        "error_phase_deg": (0.0, 360.0),
        "stiffness_variation": ranges.stiffness_variation,
        **dict.fromkeys(BEARINGS, ranges.stiffer_bearings_n_per_m),
    }
    with styled():
        figure = plt.figure(figsize=(NARROW, 7.6))
        grid = figure.add_gridspec(4, 2, height_ratios=(1, 1, 1, 2.4))
        for place, (name, label) in enumerate(LABELS.items()):
            axis = figure.add_subplot(grid[place // 2, place % 2])
            _histogram(axis, region[name].to_numpy(float), limits[name], name in LOGARITHMIC)
            axis.set_xlabel(label)
            if place % 2 == 0:
                axis.set_ylabel("inputs")
        _matrix(figure.add_subplot(grid[3, :]), correlations.to_numpy(float))
    return figure


def _histogram(axis: Axes, values: np.ndarray, limits: tuple[float, float], logarithmic: bool) -> None:
    edges = np.geomspace(*limits, BINS + 1) if logarithmic else np.linspace(*limits, BINS + 1)
    axis.hist(values, bins=edges.tolist(), color="tab:blue")
    if logarithmic:
        axis.set_xscale("log")
        steps = (1.0, 2.0, 5.0) if limits[1] < 50 * limits[0] else (1.0,)
        axis.xaxis.set_major_locator(LogLocator(subs=steps))
        axis.xaxis.set_minor_locator(NullLocator())
    if limits[1] < 1e4:
        axis.xaxis.set_major_formatter("{x:g}")
    axis.set_xlim(*limits)
    axis.yaxis.set_major_locator(MaxNLocator(nbins=4, integer=True))


def _matrix(axis: Axes, values: np.ndarray) -> None:
    axis.imshow(values, cmap="PuOr", vmin=-1.0, vmax=1.0)
    axis.grid(False)
    axis.set_xticks(range(len(SHORT)), SHORT, rotation=30, ha="right")
    axis.set_yticks(range(len(SHORT)), SHORT)
    for row, column in np.ndindex(values.shape):
        value = values[row, column]
        color = "white" if abs(value) > 0.6 else "black"
        axis.text(
            column, row, f"{float(np.round(value, 1)) + 0.0:.1f}", ha="center", va="center", color=color
        )
    axis.set_title("rank correlation over the region")
