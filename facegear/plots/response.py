"""Deflection along the line of action against time, and its spectrum, one row for each pinion."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plots.style import NARROW, styled

SIDE_STYLES = {"upper": ("tab:red", "-"), "lower": ("tab:blue", "--")}
SHOWN_CYCLES = 16
SHOWN_ORDERS = 4
APART = 0.04
"""Orders by which the lines of the two gears stand apart, so that neither hides the other."""
VISIBLE = 1e-3
"""Lines below this fraction of the largest amplitude are not drawn."""


def deflections(
    response: pd.DataFrame, spectrum: pd.DataFrame, pinions: Sequence[str], speed_rpm: float
) -> Figure:
    """Both meshes of each pinion over at most 16 mesh cycles, and their lines up to 4 times the mesh
    frequency, the mean left out.
    """
    with styled():
        figure, axes = plt.subplots(
            len(pinions), 2, figsize=(NARROW, 0.9 + 1.6 * len(pinions)), sharex="col", squeeze=False
        )
        last = min(SHOWN_CYCLES, response["mesh_cycle"].max())
        for (left, right), pinion in zip(axes, pinions, strict=True):
            for side, (colour, line) in SIDE_STYLES.items():
                history = response[response["mesh"] == f"{pinion}/{side}"]
                if not history.empty:
                    left.plot(
                        history["mesh_cycle"],
                        history["deflection_um"],
                        line,
                        color=colour,
                        lw=0.9,
                        label=side,
                    )
                    _lines(right, spectrum[spectrum["mesh"] == f"{pinion}/{side}"], side)
            left.set_title(pinion, fontsize=9, loc="left")
            left.set_ylabel("d (µm)")
            left.set_xlim(0, last)
            right.set_title("amplitude (µm)", fontsize=9, loc="left")
            right.set_ylim(bottom=0)
            right.set_xlim(0, SHOWN_ORDERS + 2 * APART)
        axes[-1, 0].set_xlabel("time (mesh cycles)")
        axes[-1, 1].set_xlabel("times mesh frequency")
        figure.legend(
            *axes[0, 0].get_legend_handles_labels(),
            loc="outside lower center",
            ncols=2,
            title="face gear",
        )
        figure.suptitle(f"Displacement along the line of action\nat {speed_rpm:g} rpm", fontsize=9)
    return figure


def _lines(axis: Axes, spectrum: pd.DataFrame, side: str) -> None:
    """Amplitudes as lines at their orders; order 0 is the mean and left out."""
    colour, _ = SIDE_STYLES[side]
    rows = spectrum[(spectrum["order"] > 0.0) & (spectrum["order"] <= SHOWN_ORDERS)]
    rows = rows[rows["amplitude_um"] > VISIBLE * rows["amplitude_um"].max()]
    at = rows["order"] + (APART if side == "lower" else -APART)
    axis.vlines(at, 0.0, rows["amplitude_um"], color=colour, lw=1.2)
