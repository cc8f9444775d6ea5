"""Work-precision diagram and cost tables of the integrators."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from facegear.report.figures.draw_matplotlib import styled

MARKERS = "osv^<>Dp*Xh"


def work_precision_diagram(table: pd.DataFrame) -> Figure:
    """Draw error against time in logarithms, one panel for each problem and one curve for each method.

    Parameters
    ----------
    table : DataFrame
        Table of `work_precision`.

    Returns
    -------
    Figure
        The figure.
    """
    problems = list(dict.fromkeys(table["problem"]))
    methods = list(dict.fromkeys(table["method"]))
    columns = 2
    rows = -(-len(problems) // columns)
    with styled():
        figure, axes = plt.subplots(rows, columns, figsize=(7.6, 3.2 * rows), squeeze=False)
        for axis, problem in zip(axes.flat, problems, strict=False):
            chance = table.loc[table["problem"] == problem, "interval"].median()
            for method, curve in table[table["problem"] == problem].groupby("method", sort=False):
                has_error = curve.dropna(subset="error")
                number, is_ours = methods.index(method), method.startswith("facegear")
                axis.loglog(
                    has_error["error"].clip(lower=1e-15),
                    has_error["seconds"],
                    MARKERS[number % len(MARKERS)],
                    # Chance decides on the order of the errors where motion is irregular.
                    linestyle="" if chance > 0.0 else "-" if number == 0 else "--",
                    color="black" if is_ours else f"C{number}",
                    lw=2 if is_ours else 1,
                    ms=4,
                    label=method,
                )
            if chance > 0.0:
                axis.axvline(chance, color="0.8", lw=3, zorder=0)
                axis.xaxis.set_minor_formatter(NullFormatter())
            axis.set_title(problem, fontsize=10)
            axis.set_xlabel(
                "error of the RMS (line: what chance leaves)"
                if chance > 0.0
                else "error of the tangents over the largest"
                if "tangents" in problem
                else "error of the deflection, scaled"
            )
            axis.set_ylabel("time (s)")
            axis.invert_xaxis()
        lines = axes[0, 0].get_legend_handles_labels()
        spare = axes.flat[len(problems) :]
        for axis in spare:
            axis.set_axis_off()
        if len(spare):
            spare[0].legend(*lines, loc="center", fontsize=9)
        else:
            figure.legend(*lines, loc="outside lower center", ncols=3, fontsize=9)
        figure.suptitle("Work and precision, median CPU times")
    return figure
