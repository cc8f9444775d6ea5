"""Deflection along the line of action against time, and its spectrum, one row for each pinion."""

from collections.abc import Mapping, Sequence

import pandas as pd

from facegear.plots.colours import BLUE, RED
from facegear.plots.description import Axis, Curve, Figure, LineStyle, Panel, stems

SIDE_STYLES: Mapping[str, tuple[str, LineStyle]] = {"upper": (RED, "solid"), "lower": (BLUE, "dash")}
SHOWN_CYCLES = 16
SHOWN_ORDERS = 4
APART = 0.04
"""Orders by which the lines of the two gears stand apart, so that neither hides the other."""
VISIBLE = 1e-3
"""Lines below this fraction of the largest amplitude are not drawn."""


def deflections(response: pd.DataFrame, spectrum: pd.DataFrame, pinions: Sequence[str]) -> Figure:
    """Both meshes of each pinion over at most 16 mesh cycles, and their lines up to 4 times the mesh
    frequency, the mean left out.
    """
    last = float(min(SHOWN_CYCLES, response["mesh_cycle"].max()))
    cycles, orders = (
        Axis("Time", "mesh cycles", low=0.0, high=last),
        Axis("Times mesh frequency", "", low=0.0, high=SHOWN_ORDERS + 2 * APART),
    )
    panels = []
    for pinion in pinions:
        histories, lines = [], []
        for side, (colour, line) in SIDE_STYLES.items():
            history = response[response["mesh"] == f"{pinion}/{side}"]
            if not history.empty:
                at, values = history["mesh_cycle"], history["deflection_um"]
                histories.append(Curve(at, values, side, colour, line, width=0.9))
                lines.append(_lines(spectrum[spectrum["mesh"] == f"{pinion}/{side}"], side))
        panels += [
            Panel(cycles, Axis("d", "µm"), histories, title=pinion, height=1.15),
            Panel(orders, Axis("Amplitude", "µm", low=0.0), lines, height=1.15),
        ]
    title = "Deflection d along the line of action; it holds half the backlash"
    return Figure(panels, title=title, columns=2, legend_title="face gear")


def _lines(spectrum: pd.DataFrame, side: str) -> Curve:
    """Amplitudes as lines at their orders; order 0 is the mean and left out."""
    colour, _ = SIDE_STYLES[side]
    rows = spectrum[(spectrum["order"] > 0.0) & (spectrum["order"] <= SHOWN_ORDERS)]
    rows = rows[rows["amplitude_um"] > VISIBLE * rows["amplitude_um"].max()]
    at = rows["order"] + (APART if side == "lower" else -APART)
    return Curve(*stems(at, rows["amplitude_um"]), side, colour)
