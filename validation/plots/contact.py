"""Speed against error of the contact chain."""

from string import ascii_uppercase

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

from facegear.report.figures.draw_matplotlib import styled
from validation.contact.refinement_levels import LIMITS

TITLES = {"mean": "Mean stiffness", "amplitude_1": "First harmonic"}


def speed_against_error(table: pd.DataFrame, growth: pd.DataFrame, default: str) -> Figure:
    """Draw the errors of mean and first harmonic (worst torque) of every resolution against its whole time.

    And the time of contact against the number of positions and of loads. Letters stand for the levels, the
    quickest first; the level `default` is drawn larger.

    Parameters
    ----------
    table : DataFrame
        Table of levels with errors.
    growth : DataFrame
        Times of contact against numbers of positions and loads.
    default : str
        Name of the default level.

    Returns
    -------
    Figure
        The figure.
    """
    levels = table.groupby("level").first().sort_values("total_s")
    exact = levels["mean_error_percent"] == 0.0
    finest, levels = _name(levels.index[exact][0], default), levels[~exact]
    letters = dict(zip(levels.index, ascii_uppercase, strict=False))
    with styled():
        figure, axes = plt.subplots(1, 3, figsize=(14, 5))
        for axis, (name, title) in zip(axes, TITLES.items(), strict=False):
            worst = table[f"{name}_error_percent"].abs().groupby(table["level"]).max()
            for level, row in levels.iterrows():
                axis.loglog(row["total_s"], worst[level], **_marker(level, row["element"], letters, default))
            axis.axhline(LIMITS[name], color="k", lw=0.7, ls="--")
            axis.xaxis.set(
                major_locator=LogLocator(subs=(1, 2, 5)),
                major_formatter=ScalarFormatter(),
                minor_formatter=NullFormatter(),
            )
            axis.set(xlabel="Whole time (s)", ylabel=f"Error against {finest} (%)", title=title)
        for quantity, rows in growth.groupby("varied", sort=False):
            axes[2].plot(rows[quantity], rows["contact_s"], "o-", label=f"{quantity}")
        axes[2].set(xlabel="Number", ylabel="Contact (s)", title="Growth with positions and loads")
        axes[2].set(xlim=(0, None), ylim=(0, None))
        axes[2].legend()
        keys = [
            Line2D([], [], label=_name(level, default), **_marker(level, row["element"], letters, default))
            for level, row in levels.iterrows()
        ]
        figure.legend(handles=keys, loc="outside lower center", ncols=5)
    return figure


def _marker(level, element, letters, default):  # type: ignore[no-untyped-def]
    size = 11 if level == default else 7
    color = "C0" if element == "hex27" else "C1"
    return {"marker": f"$\\mathrm{{{letters[level]}}}$", "ls": "", "ms": size, "color": color}


def _name(level: str, default: str) -> str:
    return level.replace("_", " ") + (" (default)" if level == default else "")
