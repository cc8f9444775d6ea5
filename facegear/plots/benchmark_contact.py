"""Speed against error of the contact chain."""

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from facegear.plots.style import styled

LIMITS = {"mean": 0.5, "amplitude_1": 3.0}
"""Percent that the default resolution may be off the finest."""


def speed_against_error(table: pd.DataFrame) -> Figure:
    """Errors of mean and first harmonic (worst torque) of every resolution against its whole time."""
    titles = {"mean": "Mean stiffness", "amplitude_1": "First harmonic"}
    with styled():
        figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharex=True)
        for axis, (name, title) in zip(axes, titles.items(), strict=True):
            worst = table.assign(error=table[f"{name}_error_percent"].abs()).groupby("rung", sort=False)
            for rung, rows in worst:
                seconds = rows["compliance_s"].iloc[0] + rows["contact_s"].iloc[0]
                error = max(rows["error"].max(), 1e-3)
                axis.loglog(seconds, error, "o")
                axis.annotate(
                    str(rung), (seconds, error), fontsize=6, xytext=(3, 3), textcoords="offset points"
                )
            axis.axhline(LIMITS[name], color="k", lw=0.7, ls="--")
            axis.set(xlabel="Compliance and contact (s)", ylabel="Error against the finest (%)", title=title)
    return figure
