"""Samples of a machine with its tolerances: distributions, which errors decide them, and how."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plots.style import NARROW, styled

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
PERCENTILE_LINES = {50.0: ":", 95.0: "--", 99.0: "-", 5.0: "--", 1.0: "-"}
SHOWN = 4
"""Worst paths that are drawn, beside what comes once a machine."""
RUBBED = ("friction_loss_w", "contact_temperature_c", "smallest_film_um")
"""What friction brings."""
ONCE = (
    "peak_mesh_force_n",
    "pressure_mpa",
    "root_stress_pinion_mpa",
    "root_stress_face_gear_mpa",
    "te_peak_to_peak_um",
    *RUBBED,
)
DECIDED = ("pressure_mpa", "root_stress_face_gear_mpa", "te_peak_to_peak_um", *RUBBED)
"""Shown with the causes that decide them, beside the worst path; without them the largest mesh force is."""
BARS = 12
WORDS = {
    "k_gamma": r"$K_\gamma$ of",
    "k_v": "$K_v$ of",
    "coefficient": "Mean coefficient,",
    "peak_mesh_force_n": "Largest mesh force (N)",
    "open_fraction": "Share of time with an open mesh",
    "reversed_fraction": "Share of time on the other flank",
    "bearing_mass": "Bearing mass (of one for 10 kN)",
    "te_peak_to_peak_um": "Transmission error, peak to peak (µm)",
    "te_first_harmonic_um": "Transmission error, mesh frequency (µm)",
    "pressure_mpa": "Largest pressure (MPa)",
    "root_stress_pinion_mpa": "Largest root stress, pinion (MPa)",
    "root_stress_face_gear_mpa": "Largest root stress, face gear (MPa)",
    "friction_loss_w": "Friction loss of all meshes (W)",
    "contact_temperature_c": "Largest contact temperature (°C)",
    "smallest_film_um": "Smallest film (µm)",
}


def in_words(quantity: str) -> str:
    """A column of the table of samples as an axis label."""
    first, _, rest = quantity.partition(" ")
    return f"{WORDS.get(first, first)} {rest}".strip()


def worst_first(percentiles: pd.DataFrame) -> list[str]:
    """Path factors by their 99th percentile, the largest first, then what comes once a machine."""
    top = percentiles[percentiles["percentile"] == 99.0].set_index("quantity")["value"]
    factors = top[top.index.str.startswith("k_gamma")].sort_values(ascending=False, kind="stable")
    return [*factors.index[:SHOWN], *(name for name in ONCE if (percentiles["quantity"] == name).any())]


def distribution_figure(samples: pd.DataFrame, percentiles: pd.DataFrame) -> Figure:
    """Share of the samples above each value, one panel a quantity, with its percentiles."""
    names = worst_first(percentiles)
    with styled():
        figure, axes = plt.subplots(
            max(len(names), 1), 1, figsize=(NARROW, 0.8 + 1.55 * max(len(names), 1)), squeeze=False
        )
        for axis, name in zip(axes[:, 0], names, strict=False):
            _exceedance(
                axis, samples[name].dropna().to_numpy(float), percentiles[percentiles["quantity"] == name]
            )
            axis.set_xlabel(in_words(name))
            axis.locator_params(axis="x", nbins=6)
        figure.supylabel("Share of samples above (%)", fontsize=9)
        above = " (film: above)" if "smallest_film_um" in names else ""
        figure.suptitle(f"Distributions; lines: 50 %, 95 % and 99 % stay below{above}", fontsize=9)
    return figure


def importance_figure(percentiles: pd.DataFrame, importance: pd.DataFrame, indices: pd.DataFrame) -> Figure:
    """Which cause decides: total Sobol indices where they were computed, else rank correlations."""
    table, value = _sizes(importance, indices)
    quantities = worst_first(percentiles)
    force = [name for name in quantities if name == "peak_mesh_force_n" and not {*quantities} & {*DECIDED}]
    decided = (name for name in quantities if name in DECIDED)
    names = list(dict.fromkeys((*quantities[:1], *force, *decided)))
    own = table[table["quantity"].isin(names)]
    causes = list(own.groupby("cause")["size"].max().sort_values(ascending=False).index[:BARS])[::-1]
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 1.1 + 0.17 * len(names) * (1 + max(len(causes), 1))))
        height = 0.76 / max(len(names), 1)
        for number, (name, colour) in enumerate(zip(names, COLOURS, strict=False)):
            rows = own[own["quantity"] == name].set_index("cause").reindex(causes)
            ends = None
            if value == "total":
                ends = np.array([rows[value] - rows["total_low"], rows["total_high"] - rows[value]]).clip(0.0)
            places = np.arange(len(causes)) + height * (0.5 * (len(names) - 1) - number)
            axis.barh(places, rows[value], 0.95 * height, xerr=ends, color=colour, label=in_words(name))
        axis.set_yticks(np.arange(len(causes)), [cause.replace("_", " ") for cause in causes])
        axis.axvline(0.0, color="black", lw=0.6)
        axis.set_xlabel("Total Sobol index" if value == "total" else "Rank correlation")
        axis.grid(axis="y", visible=False)
        if names:
            figure.legend(loc="outside lower center")
        figure.suptitle("Which tolerance matters", fontsize=9)
    return figure


def scatter_figure(
    samples: pd.DataFrame, percentiles: pd.DataFrame, importance: pd.DataFrame, indices: pd.DataFrame
) -> Figure:
    """The worst path's factor against the two causes that matter most for it."""
    name = (worst_first(percentiles) or [""])[0]
    table, _ = _sizes(importance, indices)
    own = table[table["quantity"] == name].sort_values("size", ascending=False)
    causes = list(own["cause"][:2])
    rows = max(len(causes), 1)
    with styled():
        figure, axes = plt.subplots(rows, 1, figsize=(NARROW, 0.6 + 2.3 * rows), squeeze=False)
        for axis, cause in zip(axes[:, 0], causes, strict=False):
            axis.plot(
                samples[cause], samples[name], ".", ms=2.5, color=COLOURS[0], alpha=0.5, rasterized=True
            )
            axis.set_xlabel(f"{cause.replace('_', ' ')} (units of the cause)")
            axis.set_ylabel(in_words(name))
        figure.suptitle("Every sample, against the two tolerances that matter most", fontsize=9)
    return figure


def load_map_figure(table: pd.DataFrame) -> Figure:
    """Median and 99th percentile of the worst path's factor over torque, or over speed for each torque.

    `table`: as of `facegear.stages.tolerances_map`. The worst path is that of the largest 99th percentile;
    where no meshes share a load, the largest mesh force stands in its place.
    """
    name = (worst_first(table) or [""])[0]
    own = table[table["quantity"] == name]
    over, lines = "torque_factor", "speed_rpm"
    if own["speed_rpm"].nunique() > 1:
        over, lines = lines, over
    label = {"torque_factor": "{:g} x torque", "speed_rpm": "{:.0f} rpm"}[lines]
    with styled():
        figure, axis = plt.subplots(figsize=(NARROW, 3.4))
        colours = plt.cm.viridis(np.linspace(0.0, 0.85, max(own[lines].nunique(), 1)))
        for (value, rows), colour in zip(own.groupby(lines), colours, strict=False):
            for level, style in ((50.0, ":"), (99.0, "-")):
                at = rows[rows["percentile"] == level].sort_values(over)
                entry = label.format(value) if level == 99.0 else None
                axis.plot(at[over], at["value"], style, marker=".", ms=4, color=colour, label=entry)
                axis.fill_between(at[over], at["low"], at["high"], color=colour, alpha=0.15, lw=0)
        axis.set_xlabel({"torque_factor": "Torque (of the nominal)", "speed_rpm": "Pinion speed (rpm)"}[over])
        axis.set_ylabel(in_words(name))
        if own[lines].nunique() > 1:
            figure.legend(loc="outside lower center", ncols=3)
        figure.suptitle("Solid: 99 % stay below; dotted: half; shaded: confidence interval", fontsize=9)
    return figure


def _sizes(importance: pd.DataFrame, indices: pd.DataFrame) -> tuple[pd.DataFrame, str]:
    """The table that tells what matters, with its size, and the column that holds it."""
    table, value = (indices, "total") if not indices.empty else (importance.dropna(), "rank_correlation")
    return table.assign(size=table[value].abs()), value


def _exceedance(axis: Axes, values: np.ndarray, percentiles: pd.DataFrame) -> None:
    ordered = np.sort(values)
    axis.step(
        ordered, 100.0 * (1.0 - np.arange(1, ordered.size + 1) / ordered.size), where="post", color=COLOURS[0]
    )
    axis.set_ylim(0.0, 100.0)
    for row in percentiles.itertuples():
        axis.axvline(row.value, color=COLOURS[1], lw=1.0, ls=PERCENTILE_LINES[row.percentile])
        if np.isfinite([row.low, row.high]).all():
            axis.axvspan(row.low, row.high, color=COLOURS[1], alpha=0.15, lw=0)


def figures(
    samples: pd.DataFrame, percentiles: pd.DataFrame, importance: pd.DataFrame, indices: pd.DataFrame
) -> tuple[Figure, ...]:
    """Distributions, what matters most, and how."""
    return (
        distribution_figure(samples, percentiles),
        importance_figure(percentiles, importance, indices),
        scatter_figure(samples, percentiles, importance, indices),
    )


def map_figures(load_map: pd.DataFrame) -> tuple[Figure, ...]:
    """K_gamma of the worst path over torque and speed."""
    return (load_map_figure(load_map),)
