"""Speed against error of the contact chain."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

from facegear.contact.rungs import LIMITS
from facegear.plots.style import styled

TITLES = {"mean": "Mean stiffness", "amplitude_1": "First harmonic"}


def speed_against_error(table: pd.DataFrame, growth: pd.DataFrame) -> Figure:
    """Errors of mean and first harmonic (worst torque) of every resolution against its whole time.

    And the time of contact against the number of positions and of loads.
    """
    with styled():
        figure, axes = plt.subplots(1, 3, figsize=(14, 4.2))
        for axis, (name, title) in zip(axes, TITLES.items(), strict=False):
            worst = table.assign(error=table[f"{name}_error_percent"].abs()).groupby("rung", sort=False)
            for rung, rows in worst:
                seconds, error = rows["total_s"].iloc[0], rows["error"].max()
                if error == 0.0:
                    continue
                axis.loglog(seconds, error, "o", color="C0" if rows["element"].iloc[0] == "hex27" else "C1")
                axis.annotate(
                    str(rung), (seconds, error), fontsize=6, xytext=(3, 3), textcoords="offset points"
                )
            axis.axhline(LIMITS[name], color="k", lw=0.7, ls="--")
            axis.margins(x=0.25)
            axis.xaxis.set(
                major_locator=LogLocator(subs=(1, 2, 5)),
                major_formatter=ScalarFormatter(),
                minor_formatter=NullFormatter(),
            )
            axis.set(xlabel="Whole time (s)", ylabel="Error against the finest (%)", title=title)
        for varied, rows in growth.groupby("varied", sort=False):
            axes[2].plot(rows[varied], rows["contact_s"], "o-", label=f"{varied}")
        axes[2].set(xlabel="Number", ylabel="Contact (s)", title="Growth with positions and loads")
        axes[2].set(xlim=(0, None), ylim=(0, None))
        axes[2].legend()
    return figure
