"""Load-sharing coefficients over one mesh cycle, one line a point of a study."""

from collections.abc import Iterator, Sequence

import pandas as pd

from facegear.number_format import format_number
from facegear.plots.colours import colour_of
from facegear.plots.description import Axis, Band, Curve, Figure, LineStyle, Panel

LINES: tuple[LineStyle, ...] = ("solid", "dash", "dashdot", "dot")
LABEL = {
    "inputs": "Load sharing coefficient\nof upper and lower face gear",
    "idlers": "Load sharing coefficient\nof idlers and tail rotor idler",
}
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
    marks: list[Band | Curve] = []
    for number, (point, curve) in enumerate(rows.groupby("point", sort=False)):
        marks += _marks(curve, means.loc[point], number)
    cycle = 1e3 * rows["time_s"].max() * len(curve) / (len(curve) - 1)
    top = max(2.0 if kind == "inputs" else 3.0, float(rows["envelope_high"].max()))
    panel = Panel(
        Axis("Time over one mesh cycle", "ms", low=0.0, high=cycle),
        Axis(LABEL[kind], "", low=0.95, high=top + 0.05),
        marks,
        title=f"{title}: {group}",
        height=2.7,
    )
    return Figure([panel])


def _marks(curve: pd.DataFrame, mean: pd.Series, number: int) -> Iterator[Band | Curve]:
    """One point's curve, its envelope if it has one, and its name with mean and class of motion."""
    colour = colour_of(number)
    if mean["motion"] == "period-1":
        curve = _close_cycle(curve)
    time = 1e3 * curve["time_s"]
    if (curve["envelope_high"] - curve["envelope_low"]).max() > ENVELOPE:
        yield Band(time, curve["envelope_low"], curve["envelope_high"], colour=colour, opacity=0.12)
    width = f" ± {format_number(mean['half_width'], 1)}" if mean["half_width"] > 0.005 else ""
    name = f"{curve['label'].iloc[0]}: mean {format_number(mean['mean'])}{width}, {mean['motion']}"
    if mean["undefined_fraction"] > 0.005:
        name += f", unloaded {format_number(100 * mean['undefined_fraction'], 2)} %"
    yield Curve(time, curve["coefficient"], name, colour, LINES[number % len(LINES)], width=1.3)


def _close_cycle(curve: pd.DataFrame) -> pd.DataFrame:
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
