"""Figure 9: deflection along the line of action against time, and its spectrum, one row for each pinion."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from facegear.plots.style import styled

SIDE_STYLES = {"upper": ("tab:red", "-"), "lower": ("tab:blue", "--")}
SHOWN_CYCLES = 16
SHOWN_ORDERS = 4


def deflections(
    response: pd.DataFrame, spectrum: pd.DataFrame, pinions: Sequence[str], speed_rpm: float
) -> Figure:
    """Both meshes of each pinion over at most 16 mesh cycles, and up to 4 times the mesh frequency."""
    with styled():
        figure, axes = plt.subplots(
            len(pinions), 2, figsize=(10, 1.9 * len(pinions)), sharex="col", squeeze=False
        )
        last = min(SHOWN_CYCLES, response["mesh_cycle"].max())
        for (left, right), pinion in zip(axes, pinions, strict=True):
            for side, (colour, line) in SIDE_STYLES.items():
                history = response[response["mesh"] == f"{pinion}/{side}"]
                if history.empty:
                    continue
                left.plot(
                    history["mesh_cycle"], history["deflection_um"], line, color=colour, lw=0.9, label=side
                )
                lines = spectrum[spectrum["mesh"] == f"{pinion}/{side}"]
                lines = lines[lines["order"] <= SHOWN_ORDERS].iloc[1:]
                right.plot(lines["order"], lines["amplitude_um"], line, color=colour, lw=0.9, label=side)
            left.set_title(f"{pinion} and face gears", fontsize=9)
            left.set_ylabel("d (µm)")
            left.set_xlim(0, last)
            right.set_ylabel("amplitude (µm)")
            right.set_ylim(bottom=0)
            right.set_xlim(0, SHOWN_ORDERS)
        axes[0, 0].legend(loc="upper right", fontsize=7, title="face gear", title_fontsize=7)
        axes[-1, 0].set_xlabel("time (mesh cycles)")
        axes[-1, 1].set_xlabel("multiple of the mesh frequency")
        figure.suptitle(f"Displacement along the line of action at {speed_rpm:g} rpm")
    return figure
