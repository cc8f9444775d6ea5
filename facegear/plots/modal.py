"""Mode shapes, one panel for each kind of mode."""

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.number_format import format_number
from facegear.plots.campbell import CLASS_COLOURS
from facegear.plots.colours import BLACK, grey
from facegear.plots.description import Axis, Bars, Figure, Line, Panel


def typical_modes(frequencies: pd.DataFrame) -> list[tuple[int, ...]]:
    """Return the orders of the first modes of each kind: one mode, or all modes of one frequency.

    A kind is a class with the same symbols; rigid modes are left out. A simple mode is taken if there is one,
    as a single vector out of several modes of one frequency is arbitrary.

    Parameters
    ----------
    frequencies : pd.DataFrame
        Table `frequencies` of stage modal.

    Returns
    -------
    list[tuple[int, ...]]
        Orders of the modes of each kind.
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
    """Draw bars over all DOF, relative to the largest in the mode (m and rad alike, as in the paper).

    Parameters
    ----------
    frequencies : pd.DataFrame
        Table `frequencies` of stage modal.
    shapes : pd.DataFrame
        Table `shapes` of stage modal.

    Returns
    -------
    Figure
        The figure.
    """
    by_order = frequencies.set_index("order")
    dofs = shapes[shapes["order"] == shapes["order"].iloc[0]].reset_index(drop=True)
    bodies = dofs["body"].drop_duplicates()
    names = [(float(first) + 1.5, str(body)) for first, body in bodies.items()]
    across = Axis("Degrees of freedom: x, y, z, θ of each body", "", ticks=names)
    panels = []
    for orders in typical_modes(frequencies):
        mode = by_order.loc[orders[0]]
        heights = amplitudes(shapes, orders)
        marks: list[Bars | Line] = [
            *(Line(edge - 0.5, colour=grey(0.8), width=0.6) for edge in bodies.index[1:]),
            Line(0.0, "y", colour=BLACK, width=0.6),
            Bars(dofs.index.to_numpy(dtype=float), heights, colour=CLASS_COLOURS[mode["class"]]),
        ]
        up = Axis("", "", low=-1.1 if len(orders) == 1 else 0.0, high=1.1)
        panels.append(Panel(across, up, marks, title=_title(orders, mode), height=0.85))
    return Figure(panels, y_label="Amplitude relative to the largest")


def _title(orders: tuple[int, ...], mode: pd.Series) -> str:
    if len(orders) == 1:
        return f"Mode {orders[0]}, {format_number(mode['frequency_hz'], 4)} Hz\n{mode['symbols']}"
    order_text = (
        f"Modes {orders[0]} to {orders[-1]} (x {len(orders)}), {format_number(mode['frequency_hz'], 4)} Hz"
    )
    return f"{order_text}, root sum of squares\n{mode['symbols']}"


def figures(frequencies: pd.DataFrame, shapes: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw typical mode shapes.

    Parameters
    ----------
    frequencies : pd.DataFrame
        Table `frequencies` of stage modal.
    shapes : pd.DataFrame
        Table `shapes` of stage modal.

    Returns
    -------
    tuple[Figure, ...]
        The figures.
    """
    return (mode_shapes(frequencies, shapes),)
