"""Load-sharing coefficients over one mesh cycle, one line a point of a study."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plots.style import NARROW, styled

LINES = ("-", "--", "-.", ":")
COLOURS = ("black", "tab:red", "tab:blue", "tab:green", "tab:purple", "tab:orange")
YLABEL = {
    "inputs": "Load sharing coefficient of\n upper and lower face gear",
    "idlers": "Load sharing coefficient of\n idler pinions and tail rotor idler",
}
ENTRY_HEIGHT = 0.2
"""Inches by which a figure grows with each entry of its legend, 9 pt and its gap."""
ENVELOPE = 0.02
"""An envelope narrower than this is a line, and not drawn."""


def sharing_figure(curves: pd.DataFrame, summary: pd.DataFrame, kind: str, title: str) -> Figure:
    """Coefficient against time over one mesh cycle.

    Where the motion is not period-one a single cycle is drawn over the envelope of all cycles. Gaps are
    instants at which no path carries load. Of several groups of a kind the first is drawn, as in the paper.
    """
    rows = curves[curves["kind"] == kind]
    group = rows["group"].iloc[0]
    rows = rows[rows["group"] == group]
    means = summary[(summary["group"] == group) & (summary["study"] == rows["study"].iloc[0])]
    means = means.set_index("point")
    with styled():
        points = rows["point"].nunique()
        figure, axis = plt.subplots(figsize=(NARROW, 3.6 + ENTRY_HEIGHT * points))
        for number, (point, curve) in enumerate(rows.groupby("point", sort=False)):
            _draw(axis, curve, means.loc[point], number)
        axis.set_xlim(0.0, 1e4 * rows["time_s"].max() * len(curve) / (len(curve) - 1))
        top = max(2.0 if kind == "inputs" else 3.0, float(rows["envelope_high"].max()))
        axis.set_ylim(0.95, top + 0.05)
        axis.set_xlabel("Time over one mesh cycle (10$^{-4}$ s)")
        axis.set_ylabel(YLABEL[kind])
        axis.set_title(f"{title}: {group}", fontsize=9)
        figure.legend(*axis.get_legend_handles_labels(), loc="outside lower center", ncols=1)
    return figure


def _draw(axis: Axes, curve: pd.DataFrame, mean: pd.Series, number: int) -> None:
    """One point's curve, its envelope if it has one, and a legend line with mean and class of motion."""
    colour = COLOURS[number % len(COLOURS)]
    if mean["motion"] == "period-1":
        curve = _closed(curve)
    time = 1e4 * curve["time_s"]
    if (curve["envelope_high"] - curve["envelope_low"]).max() > ENVELOPE:
        axis.fill_between(time, curve["envelope_low"], curve["envelope_high"], color=colour, alpha=0.12, lw=0)
    width = f" ± {mean['half_width']:.2f}" if mean["half_width"] > 0.005 else ""
    label = f"{curve['label'].iloc[0]}: mean {mean['mean']:.2f}{width}, {mean['motion']}"
    if mean["undefined_fraction"] > 0.005:
        label += f", no load {100 * mean['undefined_fraction']:.0f} % of the time"
    axis.plot(time, curve["coefficient"], LINES[number % len(LINES)], color=colour, lw=1.3, label=label)


def _closed(curve: pd.DataFrame) -> pd.DataFrame:
    """The samples of one cycle of a motion that repeats with it, with the end of the cycle."""
    end = curve.iloc[[0]].copy()
    end["time_s"] = curve["time_s"].iloc[-1] + curve["time_s"].iloc[1]
    return pd.concat([curve, end], ignore_index=True)


def figures(
    studies: Sequence[pd.DataFrame],
    summary: pd.DataFrame,
    titles: Sequence[str],
    groups: Sequence[str],
) -> list[Figure]:
    """A figure for each study and kind of group."""
    return [
        sharing_figure(table, summary, kind, title)
        for table, title in zip(studies, titles, strict=True)
        for kind in groups
    ]
