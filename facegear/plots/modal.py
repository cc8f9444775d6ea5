"""Mode shapes, one panel for each kind of mode."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from facegear.arrays import Array
from facegear.plots.style import NARROW, styled

COLOURS = {"pinion": "tab:blue", "face gear": "tab:orange", "pinion coupled face gear": "tab:green"}


def typical_modes(frequencies: pd.DataFrame) -> list[tuple[int, ...]]:
    """Orders of the first modes of each kind: one mode, or all modes of one frequency.

    A kind is a class with the same symbols; rigid modes are left out. A simple mode is taken if there is one,
    as a single vector out of several modes of one frequency is arbitrary.
    """
    elastic = frequencies[frequencies["class"] != "rigid body"]
    modes = []
    for _, rows in elastic.groupby(["class", "symbols"], sort=False):
        first = rows.loc[rows["multiplicity"].idxmin()]
        modes.append(tuple(int(first["order"]) + i for i in range(int(first["multiplicity"]))))
    return sorted(modes)


def amplitudes(shapes: pd.DataFrame, orders: tuple[int, ...]) -> Array:
    """Amplitudes of all DOF (m and rad alike) over the largest; of several modes their root sum of squares,
    which does not depend on the vectors that stand for them.
    """
    vectors = [shapes.loc[shapes["order"] == order, "amplitude_m_or_rad"].to_numpy() for order in orders]
    if len(vectors) == 1:
        return vectors[0] / vectors[0][np.abs(vectors[0]).argmax()]
    together = np.sqrt(np.sum(np.square(vectors), axis=0))
    return together / together.max()


def mode_shapes(frequencies: pd.DataFrame, shapes: pd.DataFrame) -> Figure:
    """Bars over all DOF, relative to the largest in the mode (m and rad alike, as in the paper)."""
    shown = typical_modes(frequencies)
    by_order = frequencies.set_index("order")
    dofs = shapes[shapes["order"] == shapes["order"].iloc[0]].reset_index(drop=True)
    bodies = dofs["body"].drop_duplicates()
    with styled():
        figure, axes = plt.subplots(
            len(shown), 1, figsize=(NARROW, 1.6 + 1.35 * len(shown)), sharex=True, squeeze=False
        )
        for axis, orders in zip(axes[:, 0], shown, strict=True):
            mode = by_order.loc[orders[0]]
            axis.bar(dofs.index, amplitudes(shapes, orders), color=COLOURS[mode["class"]], width=0.8)
            axis.axhline(0.0, color="black", lw=0.6)
            axis.set_ylim(-1.1 if len(orders) == 1 else 0.0, 1.1)
            axis.set_title(_title(orders, mode), fontsize=9, loc="left")
            for edge in bodies.index[1:]:
                axis.axvline(edge - 0.5, color="0.8", lw=0.6)
            axis.grid(axis="x", visible=False)
        axes[-1, 0].set_xticks(bodies.index + 1.5, bodies, rotation=90)
        figure.supylabel("Amplitude relative to the largest", fontsize=9)
        figure.supxlabel("Degrees of freedom: x, y, z, θ of each body", fontsize=9)
    return figure


def _title(orders: tuple[int, ...], mode: pd.Series) -> str:
    if len(orders) == 1:
        return f"Mode {orders[0]}, {mode['frequency_hz']:.1f} Hz\n{mode['symbols']}"
    which = f"Modes {orders[0]} to {orders[-1]} (x {len(orders)}), {mode['frequency_hz']:.1f} Hz"
    return f"{which}, root sum of squares\n{mode['symbols']}"


def figures(frequencies: pd.DataFrame, shapes: pd.DataFrame) -> tuple[Figure, ...]:
    """Typical mode shapes."""
    return (mode_shapes(frequencies, shapes),)
