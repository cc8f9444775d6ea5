"""Samples of a machine with its tolerances: distributions, which errors decide them, and how."""

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.number_format import format_number
from facegear.report.figures.colours import BLACK, BLUE, COLOURS, RED, shades
from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.marks import Band, Bars, Curve, Line, LineStyle, Look, Span

BAR_COLOURS = (*COLOURS[1:], BLACK)
"""Colours of the bars, in their order."""
PERCENTILE_LINES: Mapping[float, LineStyle] = {
    50.0: "dot",
    95.0: "dash",
    99.0: "solid",
    5.0: "dash",
    1.0: "solid",
}
"""Line of each percentile."""
MAX_PANELS = 4
"""Worst paths that are drawn, beside what comes once a machine."""
FRICTION_QUANTITIES = ("friction_loss_w", "contact_temperature_c", "smallest_film_um")
"""Quantities that friction adds."""
ONCE = (
    "peak_mesh_force_n",
    "pressure_mpa",
    "root_stress_pinion_mpa",
    "root_stress_face_gear_mpa",
    "te_peak_to_peak_um",
    *FRICTION_QUANTITIES,
)
"""Quantities that are drawn once for the machine, not for each group."""
DECISIVE_QUANTITIES = (
    "pressure_mpa",
    "root_stress_face_gear_mpa",
    "te_peak_to_peak_um",
    *FRICTION_QUANTITIES,
)
"""Shown with the causes that decide them, beside the worst path; without them the largest mesh force is."""
BARS = 12
"""Largest number of causes with a bar."""
WORDS = {
    "k_gamma": ("Kᵧ of", ""),
    "k_v": ("Kᵥ of", ""),
    "coefficient": ("Mean coefficient,", ""),
    "peak_mesh_force_n": ("Largest mesh force", "N"),
    "open_fraction": ("Share of time with an open mesh", ""),
    "reversed_fraction": ("Share of time on the other flank", ""),
    "bearing_mass": ("Bearing mass over that of one for 10 kN", ""),
    "te_peak_to_peak_um": ("Transmission error, peak to peak", "µm"),
    "te_first_harmonic_um": ("Transmission error, mesh frequency", "µm"),
    "pressure_mpa": ("Largest pressure", "MPa"),
    "root_stress_pinion_mpa": ("Largest root stress, pinion", "MPa"),
    "root_stress_face_gear_mpa": ("Largest root stress, face gear", "MPa"),
    "friction_loss_w": ("Friction loss of all meshes", "W"),
    "contact_temperature_c": ("Largest contact temperature", "°C"),
    "smallest_film_um": ("Smallest film", "µm"),
}
"""Quantities and units of columns by their first word."""


def in_words(quantity: str) -> str:
    """Return a column of the table of samples as an axis label.

    Parameters
    ----------
    quantity : str
        Name of the column: a word of WORDS and, after a space, a group.

    Returns
    -------
    str
        Quantity and group with the unit in brackets.
    """
    return axis_of(quantity).label


def axis_of(quantity: str) -> Axis:
    """Return the axis of a column of the table of samples.

    Parameters
    ----------
    quantity : str
        Name of the column: a word of WORDS and, after a space, a group.

    Returns
    -------
    Axis
        The axis, in the unit of the column.
    """
    first, _, rest = quantity.partition(" ")
    name, unit = WORDS.get(first, (first.replace("_", " "), ""))
    return Axis(f"{name} {rest}".strip(), unit)


def worst_first(percentiles: pd.DataFrame) -> list[str]:
    """List the MAX_PANELS columns `k_gamma ...` with the largest 99th percentiles, largest first, then
    those of ONCE that were computed.

    Parameters
    ----------
    percentiles : pd.DataFrame
        Table `percentiles` of stage tolerances: quantity, percentile (0 to 100), value.

    Returns
    -------
    list[str]
        Names of the quantities.
    """
    top = percentiles[percentiles["percentile"] == 99.0].set_index("quantity")["value"]
    factors = top[top.index.str.startswith("k_gamma")].sort_values(ascending=False, kind="stable")
    return [*factors.index[:MAX_PANELS], *(name for name in ONCE if (percentiles["quantity"] == name).any())]


def distribution_figure(samples: pd.DataFrame, percentiles: pd.DataFrame) -> Figure:
    """Draw the share of the samples above each value, one panel a quantity, with its percentiles.

    Parameters
    ----------
    samples : pd.DataFrame
        Table `samples` of stage tolerances: a row for each sample, a column for each quantity and cause.
    percentiles : pd.DataFrame
        Table `percentiles` of stage tolerances: quantity, percentile, value, low and high end of its
        interval.

    Returns
    -------
    Figure
        A panel for each quantity of `worst_first`.
    """
    names = worst_first(percentiles)
    up = Axis("", "", low=0.0, high=100.0)
    panels = [
        Panel(
            axis_of(name),
            up,
            list(
                _exceedance(
                    samples[name].dropna().to_numpy(float), percentiles[percentiles["quantity"] == name]
                )
            ),
            height=1.0,
        )
        for name in names
    ]
    above = " (film: above)" if "smallest_film_um" in names else ""
    title = f"Distributions; lines: 50 %, 95 % and 99 % stay below{above}"
    shown_panels = panels or [Panel(Axis("", ""), up, [])]
    return Figure(shown_panels, title=title, shared_x=False, y_label="Share of samples above (%)")


def importance_figure(percentiles: pd.DataFrame, importance: pd.DataFrame, indices: pd.DataFrame) -> Figure:
    """Draw which cause decides: total Sobol indices where they were computed, else rank correlations.

    The worst path's K_gamma and DECISIVE_QUANTITIES are shown, with the BARS causes of the largest bars.

    Parameters
    ----------
    percentiles : pd.DataFrame
        Table `percentiles` of stage tolerances, as `worst_first` reads it.
    importance : pd.DataFrame
        Table `importance` of stage tolerances: quantity, cause, rank_correlation (-1 to 1).
    indices : pd.DataFrame
        Table `indices` of stage tolerances, empty if not computed: quantity, cause, total, total_low,
        total_high (ends of its interval).

    Returns
    -------
    Figure
        One panel of lying bars.
    """
    table, value = _sizes(importance, indices)
    quantities = worst_first(percentiles)
    force = [
        name
        for name in quantities
        if name == "peak_mesh_force_n" and not {*quantities} & {*DECISIVE_QUANTITIES}
    ]
    decisive_names = (name for name in quantities if name in DECISIVE_QUANTITIES)
    names = list(dict.fromkeys((*quantities[:1], *force, *decisive_names)))
    rows_of_names = table[table["quantity"].isin(names)]
    causes = list(rows_of_names.groupby("cause")["size"].max().sort_values(ascending=False).index[:BARS])[
        ::-1
    ]
    height = 0.76 / max(len(names), 1)
    marks: list[Bars | Line] = [Line(0.0, colour=BLACK, width=0.6)]
    for number, (name, colour) in enumerate(zip(names, BAR_COLOURS, strict=False)):
        rows = rows_of_names[rows_of_names["quantity"] == name].set_index("cause").reindex(causes)
        lengths = rows[value].to_numpy(float)
        ends: Look = {}
        if value == "total":
            ends = {
                "low": np.minimum(rows["total_low"].to_numpy(float), lengths),
                "high": np.maximum(rows["total_high"].to_numpy(float), lengths),
            }
        positions: Array = np.arange(float(len(causes))) + height * (0.5 * (len(names) - 1) - number)
        marks.append(Bars(positions, lengths, in_words(name), colour, 0.95 * height, flat=True, **ends))
    ticks = [(float(position), cause.replace("_", " ")) for position, cause in enumerate(causes)]
    panel = Panel(
        Axis("Total Sobol index", "", low=0.0) if value == "total" else Axis("Rank correlation", ""),
        Axis("", "", low=-0.6, high=max(len(causes), 1) - 0.4, ticks=ticks),
        marks,
        height=0.5 + 0.17 * max(len(names), 1) * max(len(causes), 1),
    )
    return Figure([panel], title="Which tolerance matters")


def scatter_figure(
    samples: pd.DataFrame, percentiles: pd.DataFrame, importance: pd.DataFrame, indices: pd.DataFrame
) -> Figure:
    """Draw the worst path's factor against the two causes that matter most for it.

    Parameters
    ----------
    samples : pd.DataFrame
        Table `samples` of stage tolerances: a row for each sample, a column for each quantity and cause.
    percentiles : pd.DataFrame
        Table `percentiles` of stage tolerances, as `worst_first` reads it.
    importance : pd.DataFrame
        Table `importance` of stage tolerances, as for `importance_figure`.
    indices : pd.DataFrame
        Table `indices` of stage tolerances; where it is not empty it decides which causes matter.

    Returns
    -------
    Figure
        Two panels, one for each cause; an empty one if no cause is known.
    """
    name = (worst_first(percentiles) or [""])[0]
    table, _ = _sizes(importance, indices)
    quantity_rows = table[table["quantity"] == name].sort_values("size", ascending=False)
    dots: Look = {"line": "none", "marker": "dot", "size": 2.5, "opacity": 0.5}
    panels = [
        Panel(
            Axis(f"{cause.replace('_', ' ')}, in units of the cause", ""),
            axis_of(name),
            [Curve(samples[cause], samples[name], colour=BLUE, **dots)],
            height=1.8,
        )
        for cause in quantity_rows["cause"][:2]
    ]
    title = "Every sample, against the two tolerances that matter most"
    return Figure(panels or [Panel(Axis("", ""), Axis("", ""), [])], title=title, shared_x=False)


def load_map_figure(table: pd.DataFrame) -> Figure:
    """Draw median and 99th percentile of the worst path's factor over torque, or over speed for each torque.

    The worst path is that of the largest 99th percentile; where no meshes share a load, the largest mesh
    force stands in its place.

    Parameters
    ----------
    table : pd.DataFrame
        Table `load_map` of stage tolerances_map: torque_factor (torque over the nominal one), speed_rpm,
        quantity, percentile, value, low and high.

    Returns
    -------
    Figure
        One panel, over speed if there are several speeds, else over torque.
    """
    name = (worst_first(table) or [""])[0]
    quantity_rows = table[table["quantity"] == name]
    over, lines = "torque_factor", "speed_rpm"
    if quantity_rows["speed_rpm"].nunique() > 1:
        over, lines = lines, over
    unit = {"torque_factor": "x torque", "speed_rpm": "rpm"}[lines]
    has_several = quantity_rows[lines].nunique() > 1
    marks: list[Band | Curve] = []
    styles: tuple[tuple[float, LineStyle], ...] = ((50.0, "dot"), (99.0, "solid"))
    for (value, rows), colour in zip(
        quantity_rows.groupby(lines), shades(quantity_rows[lines].nunique()), strict=True
    ):
        for level, line in styles:
            at = rows[rows["percentile"] == level].sort_values(over)
            words = f"{format_number(value, 4)} {unit}"
            look: Look = {"marker": "dot", "size": 4.0, "in_legend": has_several and level == 99.0}
            marks += [
                Band(at[over], at["low"], at["high"], colour=colour, opacity=0.15),
                Curve(
                    at[over],
                    at["value"],
                    f"{words}, {level:g} %" if level == 50.0 else words,
                    colour,
                    line,
                    **look,
                ),
            ]
    across = {
        "torque_factor": Axis("Torque over the nominal one", ""),
        "speed_rpm": Axis("Pinion speed", "rpm"),
    }
    panel = Panel(across[over], axis_of(name), marks, height=2.4)
    return Figure([panel], title="Solid: 99 % stay below; dotted: half; shaded: confidence interval")


def _sizes(importance: pd.DataFrame, indices: pd.DataFrame) -> tuple[pd.DataFrame, str]:
    """Return the table that tells which causes matter and the name of its decisive column: `indices`
    and `total` if that is not empty, else `importance` and `rank_correlation`. Column `size` is added:
    its magnitude.
    """
    table, value = (indices, "total") if not indices.empty else (importance.dropna(), "rank_correlation")
    return table.assign(size=table[value].abs()), value


def _exceedance(values: Array, percentiles: pd.DataFrame) -> Iterator[Curve | Line | Span]:
    """Yield the percentage of samples (n,) above each value as steps, with lines at percentiles and
    strips over their intervals. `percentiles`: rows of one quantity.
    """
    sorted_values = np.sort(values)
    above = 100.0 * (1.0 - np.arange(1, sorted_values.size + 1) / sorted_values.size)
    for row in percentiles.itertuples():
        if np.isfinite([row.low, row.high]).all():
            yield Span(row.low, row.high, colour=RED)
        yield Line(row.value, colour=RED, line=PERCENTILE_LINES[row.percentile], width=1.0)
    yield Curve(sorted_values, above, colour=BLUE, steps=True)


def tolerances_figures(
    samples: pd.DataFrame, percentiles: pd.DataFrame, importance: pd.DataFrame, indices: pd.DataFrame
) -> tuple[Figure, ...]:
    """Draw distributions, what matters most, and how.

    Parameters
    ----------
    samples : pd.DataFrame
        Table `samples` of stage tolerances.
    percentiles : pd.DataFrame
        Table `percentiles` of stage tolerances.
    importance : pd.DataFrame
        Table `importance` of stage tolerances.
    indices : pd.DataFrame
        Table `indices` of stage tolerances.

    Returns
    -------
    tuple[Figure, ...]
        Those of `distribution_figure`, `importance_figure` and `scatter_figure`.
    """
    return (
        distribution_figure(samples, percentiles),
        importance_figure(percentiles, importance, indices),
        scatter_figure(samples, percentiles, importance, indices),
    )


def map_figures(load_map: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw median and 99th percentile of the worst path over torque and speed.

    Parameters
    ----------
    load_map : pd.DataFrame
        Table `load_map` of stage tolerances_map.

    Returns
    -------
    tuple[Figure, ...]
        The figures.
    """
    return (load_map_figure(load_map),)
