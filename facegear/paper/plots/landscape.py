"""Landscape of the search for undisclosed inputs."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from facegear.plots.style import styled

AXES = (
    ("per_input_n_m", "Torque per engine (N m)"),
    ("tail_share", "Share of the power at the tail"),
    ("error_phase_deg", "Phase of e(t) (deg)"),
)


def landscape(evaluations: pd.DataFrame, sets: pd.DataFrame) -> Figure:
    """Misfit against each number, one row a branch, all evaluations; kept optima are ringed and named."""
    branches = list(dict.fromkeys(evaluations["branch"]))
    with styled():
        figure, axes = plt.subplots(
            len(branches), len(AXES), figsize=(9.5, 1.6 * len(branches) + 0.6), squeeze=False, sharey=True
        )
        for row, branch in zip(axes, branches, strict=True):
            row[0].set_ylabel("misfit")
            points = evaluations[evaluations["branch"] == branch]
            kept = sets[sets["branch"] == branch]
            for axis, (column, label) in zip(row, AXES, strict=True):
                axis.plot(points[column], points["misfit"], ".", ms=2, color="tab:blue", alpha=0.5)
                axis.plot(kept[column], kept["misfit"], "o", ms=7, mfc="none", color="tab:red")
                for one in kept.itertuples():
                    axis.annotate(one.set, (getattr(one, column), one.misfit), fontsize=8, color="tab:red")
                if column == "per_input_n_m":
                    axis.set_xscale("log")
                    axis.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
                    axis.xaxis.set_major_formatter("{x:g}")
                    axis.xaxis.set_minor_locator(NullLocator())
                if branch == branches[-1]:
                    axis.set_xlabel(label)
            row[1].set_title(branch, fontsize=7)
    return figure
