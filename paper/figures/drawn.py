"""The paper's figures in its layout, with our curves and the numbers that it states."""

from collections.abc import Callable, Mapping, Sequence
from itertools import product

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from facegear.plots.modal import COLOURS as CLASS_COLOURS
from facegear.plots.style import NARROW, legend_above, styled
from facegear.plots.sweep import AXIS_STYLES, DIRECTION_STYLES, select
from paper.figures.claims_of import STUDIES
from paper.scorecard.claims import Claim
from paper.scorecard.criteria_sharing import MAX_UNDEFINED
from paper.scorecard.outcome import Tables

MODES = (12, 7, 8, 25, 17, 11, 18, 19)
"""Orders of the panels (a) to (h) of figure 6."""
PINIONS = ("tail idler", "right idler", "right input", "left input", "left idler")
"""In the order of the panels of figure 9."""
SWEPT = PINIONS[:3]
"""Pinions whose sweeps the paper shows."""
SPEEDS = (200.0, 20000.0)
"""Range of the paper's sweeps, rpm."""
CYCLES, ORDERS = 8, 4
"""Mesh cycles and orders that figure 9 shows."""
STUDY_COLOURS = ("black", "tab:red", "tab:blue")
STATED = {"color": "0.45", "ls": ":", "lw": 1.0}
"""Style of numbers that the paper states."""
SHARING = {
    "inputs": ((1.0, 2.0), "of upper and lower face gear\n(right input pinion)"),
    "idlers": ((1.0, 3.0), "of the idler pinions and the tail rotor idler"),
}

Draw = Callable[[Tables, Sequence[Claim]], Figure]


def draw(number: int, tables: Tables, claims: Sequence[Claim]) -> Figure:
    """A figure by its number in the paper; `claims` are those that stand beside it."""
    with styled():
        return DRAWN[number](tables, claims)


def shown_data(figure: Figure) -> pd.DataFrame:
    """What a figure shows, row by row: panel, series, x, y; stated numbers are series of their own."""
    parts = []
    for number, axis in enumerate(figure.axes):
        panel = axis.get_title(loc="left") or f"panel {number + 1}"
        series = [(line.get_label(), line.get_xdata(), line.get_ydata()) for line in axis.lines]
        for bars in axis.containers:
            heights = [(bar.get_x() + 0.5 * bar.get_width(), bar.get_height()) for bar in bars]
            series.append((bars.get_label(), *np.array(heights).T))
        for label, x, y in series:
            if not str(label).startswith("_"):
                parts.append(pd.DataFrame({"panel": panel, "series": label, "x": x, "y": y}))
    return pd.concat(parts, ignore_index=True)


def _modes(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 6: eight typical modes, each relative to its largest amplitude (m and rad alike)."""
    frequencies, shapes = tables["frequencies"].set_index("order"), tables["shapes"]
    figure, axes = plt.subplots(4, 2, figsize=(1.6 * NARROW, 8.0), sharex=True)
    for letter, order, axis in zip("abcdefgh", MODES, axes.T.ravel(), strict=True):
        mode, shape = frequencies.loc[order], shapes[shapes["order"] == order].reset_index(drop=True)
        heights = (
            shape["amplitude_m_or_rad"]
            / shape["amplitude_m_or_rad"].iloc[shape["amplitude_m_or_rad"].abs().argmax()]
        )
        bars = axis.bar(np.arange(1, len(shape) + 1), heights, color=CLASS_COLOURS[mode["class"]])
        bars.set_label(f"order {order}")
        title = f"({letter}) order {order}: {mode['frequency_hz']:.1f} Hz, {mode['class']}"
        axis.set_title(title, fontsize=8, loc="left")
        axis.set_ylim(-1.1, 1.1)
    for axis in axes[-1]:
        axis.set_xlabel("degree of freedom: x, y, z, θ of each body", fontsize=8)
    figure.supylabel("amplitude relative to the largest", fontsize=9)
    return figure


def _stiffness(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 7: k(t) of the upper mesh of the tail idler over a mesh period."""
    curve = tables["tvms"]
    figure, axis = plt.subplots(figsize=(NARROW, 3.4))
    closed = pd.concat([curve, curve.iloc[[0]].assign(position=1.0)])
    axis.plot(closed["position"], 1e-8 * closed["k_n_per_m"], "k-", label="computed")
    axis.plot(closed["position"], 1e-8 * closed["k_series_n_per_m"], "r--", lw=1, label="Fourier series kept")
    for _, mean in _numbers(claims):
        axis.axhline(1e-8 * mean, label="stated mean", **STATED)
    axis.set(xlabel="mesh period t/T", ylabel="mesh stiffness (10$^8$ N/m)", xlim=(0, 1))
    legend_above(axis, 2)
    return figure


def _harmonics(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 8: amplitudes of the stiffness variation."""
    rows = tables["harmonics"][tables["harmonics"]["order"] >= 1]
    figure, axis = plt.subplots(figsize=(NARROW, 3.2))
    bars = axis.bar(rows["order"], 1e-8 * rows["amplitude_n_per_m"], width=0.5)
    bars.set_label("amplitude")
    axis.set(xlabel="harmonic order of the mesh frequency", ylabel="amplitude (10$^8$ N/m)")
    axis.set_xticks(rows["order"])
    return figure


def _response(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 9: deflections of the ten meshes at 7500 rpm over time, and their spectra."""
    response, spectrum = tables["response"], tables["spectrum"]
    figure, axes = plt.subplots(5, 2, figsize=(1.6 * NARROW, 9.0), sharex="col")
    for letter, pinion, (left, right) in zip("abcde", PINIONS, axes, strict=True):
        for side, colour, line in (("upper", "tab:red", "-"), ("lower", "tab:blue", "--")):
            history = response[response["mesh"] == f"{pinion}/{side}"]
            history = history[history["mesh_cycle"] <= CYCLES]
            left.plot(
                1e3 * history["time_s"], history["deflection_um"], line, color=colour, lw=0.9, label=side
            )
            lines = spectrum[
                (spectrum["mesh"] == f"{pinion}/{side}") & spectrum["order"].between(1e-9, ORDERS)
            ]
            shift = 0.03 if side == "lower" else -0.03
            bars = right.bar(lines["order"] + shift, lines["amplitude_um"], width=0.05, color=colour)
            bars.set_label(side)
        left.set_title(f"({letter}) {pinion}", fontsize=9, loc="left")
        right.set_title(f"({letter}) {pinion}, spectrum", fontsize=9, loc="left")
        left.set_ylabel("d (µm)")
        right.set_ylabel("amplitude (µm)")
    axes[-1, 0].set_xlabel("time (ms)")
    axes[-1, 1].set_xlabel("times mesh frequency")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _pinions(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 10: RMS of the pinions' translations, speed rising."""
    return _translations(tables["sweep"], SWEPT, "xy", claims)


def _gears(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 11: RMS of the face gears' translations, speed rising."""
    return _translations(tables["sweep"], ("lower face gear", "upper face gear"), "xyz", claims)


def _translations(
    sweep: pd.DataFrame, bodies: Sequence[str], letters: str, claims: Sequence[Claim]
) -> Figure:
    figure, axes = plt.subplots(len(bodies), 1, figsize=(1.4 * NARROW, 1.2 + 2.1 * len(bodies)), sharex=True)
    for panel, body, axis in zip("abc", bodies, axes, strict=False):
        for letter in letters:
            colour, line = AXIS_STYLES[letter]
            curve = select(sweep, "up", f"{letter}_ac_rms_um", body)
            axis.plot(curve["speed_rpm"], curve["value"], line, color=colour, lw=1, label=letter)
        _stated_speeds(axis, [claim for claim in claims if claim.criterion == "peak_speed"])
        axis.set_title(f"({panel}) {body}", fontsize=9, loc="left")
        axis.set(ylabel="RMS (µm)", xlim=SPEEDS)
        axis.set_ylim(bottom=0)
    return _swept(figure, axes)


def _deflections(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 12: RMS of six meshes' deflections, speed rising and falling."""
    meshes = [f"{pinion}/{side}" for side, pinion in product(("upper", "lower"), SWEPT)]
    figure, axes = plt.subplots(6, 1, figsize=(1.4 * NARROW, 11.0), sharex=True)
    for panel, mesh, axis in zip("abcdef", meshes, axes, strict=True):
        for direction, (colour, line) in DIRECTION_STYLES.items():
            curve = select(tables["sweep"], direction, "deflection_ac_rms_um", mesh)
            axis.plot(
                curve["speed_rpm"], curve["value"], line, color=colour, lw=1, label=f"speed {direction}"
            )
        _stated_speeds(axis, [claim for claim in claims if _on_mesh(claim, mesh)])
        axis.set_title(f"({panel}) {mesh}", fontsize=9, loc="left")
        axis.set(ylabel="RMS (µm)", xlim=SPEEDS)
        axis.set_ylim(bottom=0)
    return _swept(figure, axes)


def _on_mesh(claim: Claim, mesh: str) -> bool:
    """Whether a claim states a jump of this mesh: of all meshes where it names no pinion."""
    return "near" in claim.args and claim.args.get("pinion", mesh.split("/")[0]) == mesh.split("/")[0]


def stated_speed(claim: Claim) -> float:
    """The speed (rpm) at which a claim states a peak or a jump."""
    return float(claim.args["near"])


def _stated_speeds(axis: Axes, claims: Sequence[Claim]) -> None:
    for speed in dict.fromkeys(stated_speed(claim) for claim in claims):
        axis.axvline(speed, label=f"stated {speed:g} rpm", **STATED)


def _swept(figure: Figure, axes: Sequence[Axes]) -> Figure:
    axes[-1].set_xlabel("input rotation speed (rpm)")
    labels = {
        label: handle
        for axis in axes
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)
    }
    curves = {label: handle for label, handle in labels.items() if not label.startswith("stated")}
    stated = [handle for label, handle in labels.items() if label.startswith("stated")]
    handles = {**curves, **({"stated by the paper": stated[0]} if stated else {})}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)
    return figure


def _sharing(study: str, kind: str) -> Draw:
    """Figures 13 to 20: a coefficient over one mesh cycle, a colour for each point of a study."""

    def drawn(tables: Tables, claims: Sequence[Claim]) -> Figure:
        curves, sharing = tables["curves"], tables["sharing"]
        rows = curves[(curves["study"] == study) & (curves["kind"] == kind)]
        rows = rows[rows["group"] == rows["group"].iloc[0]]
        (low, high), what = SHARING[kind]
        figure, axis = plt.subplots(figsize=(1.2 * NARROW, 4.6))
        for colour, (point, curve) in zip(STUDY_COLOURS, rows.groupby("point", sort=False), strict=False):
            label, time = curve["label"].iloc[0], 1e4 * curve["time_s"]
            axis.plot(time, curve["coefficient"], color=colour, label=label)
            of_point = sharing[(sharing["study"] == study) & (sharing["point"] == point)]
            own = of_point.set_index("group").loc[curve["group"].iloc[0]]
            if own["undefined_fraction"] < MAX_UNDEFINED:
                axis.axhline(own["mean"], xmax=0.04, color=colour, lw=3, label=f"{label}, our mean")
            for claim, stated in _numbers(claims):
                if claim.args.get("point") == point:
                    name = "minimum" if "column" in claim.args else "mean"
                    style = {**STATED, "color": colour, "ls": "-." if name == "minimum" else ":"}
                    axis.axhline(stated, label=f"{label}, stated {name}", **style)
        axis.set(xlim=(0, time.max()), ylim=(low - 0.05, high + 0.05))
        axis.set(
            xlabel="time over one mesh cycle (10$^{-4}$ s)",
            ylabel=f"dynamic load sharing coefficient\n{what}",
        )
        figure.legend(loc="outside lower center", ncols=2)
        return figure

    return drawn


def _numbers(claims: Sequence[Claim]) -> list[tuple[Claim, float]]:
    """The claims that state a number, and that number."""
    return [(claim, claim.paper) for claim in claims if claim.paper is not None]


DRAWN: Mapping[int, Draw] = {
    6: _modes,
    7: _stiffness,
    8: _harmonics,
    9: _response,
    10: _pinions,
    11: _gears,
    12: _deflections,
    **{
        first + i: _sharing(study, kind) for study, first in STUDIES.items() for i, kind in enumerate(SHARING)
    },
}
