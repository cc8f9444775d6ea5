"""The paper's figures in its layout, with our curves and the numbers that it states."""

from collections.abc import Callable, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from facegear.report.figures.campbell import CLASS_COLOURS
from facegear.report.figures.colours import BLUE, COLOURS, RED, grey
from facegear.report.figures.description import NARROW, Axis, Figure, Key, Panel
from facegear.report.figures.marks import Bars, Curve, Line, Look
from facegear.report.figures.motion import AXIS_STYLES, DIRECTION_STYLES, SIDE_STYLES, select
from paper.figures.claims_of import STUDIES
from paper.scorecard.claims import Claim
from paper.scorecard.criteria_sharing import MAX_UNDEFINED
from paper.scorecard.outcome import Tables

MODES = (12, 7, 8, 25, 17, 11, 18, 19)
"""Orders of the panels (a) to (h) of figure 6."""
PINIONS = ("tail idler", "right idler", "right input", "left input", "left idler")
"""Pinions in the order of the panels of figure 9."""
SWEEP_PINIONS = PINIONS[:3]
"""Pinions whose sweeps the paper shows."""
SPEEDS = (200.0, 20000.0)
"""Range of the paper's sweeps, rpm."""
CYCLES, ORDERS = 8, 4
"""Mesh cycles and orders that figure 9 shows."""
CLAIM_STYLE: Mapping[str, Any] = {"colour": grey(0.45), "line": "dot", "width": 1.0}
"""Style of numbers that the paper states."""
SHARING = {
    "inputs": ((1.0, 2.0), "of upper and lower face gear\n(right input pinion)"),
    "idlers": ((1.0, 3.0), "of the idler pinions and the tail rotor idler"),
}
"""Range of the coefficient on the axis, and its subject in the axis label, by kind of group."""

Draw = Callable[[Tables, Sequence[Claim]], Figure]


def draw(number: int, tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Draw a figure of the paper.

    Parameters
    ----------
    number : int
        Number of the figure in the paper.
    tables : Tables
        Stored results by name.
    claims : Sequence[Claim]
        Claims that stand beside the figure.

    Returns
    -------
    Figure
        The figure.
    """
    return DRAW_FUNCTIONS[number](tables, claims)


def shown_data(figure: Figure) -> pd.DataFrame:
    """Return the data of a figure, row by row; stated numbers are series of their own.

    Parameters
    ----------
    figure : Figure
        The figure.

    Returns
    -------
    DataFrame
        Columns panel, series, x, y.
    """
    parts = []
    for number, panel in enumerate(figure.panels):
        title = panel.title or f"panel {number + 1}"
        for mark in panel.marks:
            if not isinstance(mark, Curve | Bars | Line):
                continue
            x, y = _points(mark)
            parts.append(pd.DataFrame({"panel": title, "series": mark.name, "x": x, "y": y}))
    return pd.concat(parts, ignore_index=True)


def _points(mark: Curve | Bars | Line) -> tuple[Any, Any]:
    """Points of a mark; a line across a panel has one, with a coordinate alone."""
    if isinstance(mark, Line):
        return ([mark.at], [np.nan]) if mark.of == "x" else ([np.nan], [mark.at])
    return (mark.positions, mark.lengths) if isinstance(mark, Bars) else (mark.x, mark.y)


def _modes(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 6: eight typical modes, each relative to its largest amplitude (m and rad alike)."""
    frequencies, shapes = tables["frequencies"].set_index("order"), tables["shapes"]
    across = Axis("degree of freedom: x, y, z, θ of each body", "")
    panels = []
    for letter, order in zip("abcdefgh", MODES, strict=True):
        mode, shape = frequencies.loc[order], shapes[shapes["order"] == order]
        amplitudes = shape["amplitude_m_or_rad"].to_numpy()
        heights = amplitudes / amplitudes[np.abs(amplitudes).argmax()]
        positions = np.arange(1.0, len(shape) + 1.0)
        bars = Bars(positions, heights, f"order {order}", CLASS_COLOURS[mode["class"]], in_legend=False)
        title = f"({letter}) order {order}: {mode['frequency_hz']:.1f} Hz, {mode['class']}"
        panels.append(Panel(across, Axis("", "", low=-1.1, high=1.1), [bars], title=title, height=1.4))
    by_row = [panels[column * 4 + row] for row in range(4) for column in range(2)]
    return Figure(by_row, columns=2, width=1.6 * NARROW, y_label="amplitude relative to the largest")


def _stiffness(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 7: k(t) of the upper mesh of the tail idler over a mesh period."""
    curve = tables["tvms"]
    whole = pd.concat([curve, curve.iloc[[0]].assign(position=1.0)])
    marks: list[Curve | Line] = [
        Curve(whole["position"], 1e-8 * whole["k_n_per_m"], "computed"),
        Curve(whole["position"], 1e-8 * whole["k_series_n_per_m"], "Fourier series kept", RED, "dash"),
    ]
    marks += [Line(1e-8 * mean, "y", "stated mean", **CLAIM_STYLE) for _, mean in _numbers(claims)]
    across = Axis("mesh period t/T", "", low=0.0, high=1.0)
    return Figure([Panel(across, Axis("mesh stiffness", "10⁸ N/m"), marks, height=2.5)])


def _harmonics(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 8: amplitudes of the stiffness variation."""
    rows = tables["harmonics"][tables["harmonics"]["order"] >= 1]
    orders = rows["order"].to_numpy(float)
    heights = 1e-8 * rows["amplitude_n_per_m"].to_numpy()
    bars = Bars(orders, heights, "amplitude", BLUE, width=0.5, in_legend=False)
    across = Axis(
        "harmonic order of the mesh frequency", "", ticks=[(order, f"{order:g}") for order in orders]
    )
    return Figure([Panel(across, Axis("amplitude", "10⁸ N/m", low=0.0), [bars], height=2.4)])


def _response(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 9: deflections of the ten meshes at 7500 rpm over time, and their spectra."""
    response, spectrum = tables["response"], tables["spectrum"]
    time, order = Axis("time", "ms"), Axis("times mesh frequency", "")
    panels = []
    for letter, pinion in zip("abcde", PINIONS, strict=True):
        curves, bars = [], []
        for side, (colour, line) in SIDE_STYLES.items():
            history = response[response["mesh"] == f"{pinion}/{side}"]
            history = history[history["mesh_cycle"] <= CYCLES]
            at, values = 1e3 * history["time_s"], history["deflection_um"]
            curves.append(Curve(at, values, side, colour, line, width=0.9))
            lines = spectrum[
                (spectrum["mesh"] == f"{pinion}/{side}") & spectrum["order"].between(1e-9, ORDERS)
            ]
            positions = lines["order"].to_numpy(float) + (0.03 if side == "lower" else -0.03)
            look: Look = {"colour": colour, "width": 0.05, "in_legend": False}
            bars.append(Bars(positions, lines["amplitude_um"].to_numpy(float), side, **look))
        panels += [
            Panel(time, Axis("d", "µm"), curves, title=f"({letter}) {pinion}", height=1.25),
            Panel(
                order,
                Axis("amplitude", "µm", low=0.0),
                bars,
                title=f"({letter}) {pinion}, spectrum",
                height=1.25,
            ),
        ]
    return Figure(panels, columns=2, width=1.6 * NARROW)


def _pinions(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 10: RMS of the pinions' translations, speed rising."""
    return _translations(tables["sweep"], SWEEP_PINIONS, "xy", claims)


def _gears(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 11: RMS of the face gears' translations, speed rising."""
    return _translations(tables["sweep"], ("lower face gear", "upper face gear"), "xyz", claims)


def _translations(
    sweep: pd.DataFrame, bodies: Sequence[str], letters: str, claims: Sequence[Claim]
) -> Figure:
    panels = []
    for panel, body in zip("abc", bodies, strict=False):
        marks: list[Curve | Line] = []
        for letter in letters:
            colour, line = AXIS_STYLES[letter]
            curve = select(sweep, "up", f"{letter}_ac_rms_um", body)
            marks.append(Curve(curve["speed_rpm"], curve["value"], letter, colour, line, width=1.0))
        marks += _stated_speeds([claim for claim in claims if claim.criterion == "peak_speed"])
        panels.append(_sweep_panel(marks, f"({panel}) {body}"))
    return Figure(panels, width=1.4 * NARROW, keys=_stated_key(panels))


def _deflections(tables: Tables, claims: Sequence[Claim]) -> Figure:
    """Figure 12: RMS of six meshes' deflections, speed rising and falling."""
    meshes = [f"{pinion}/{side}" for side, pinion in product(("upper", "lower"), SWEEP_PINIONS)]
    panels = []
    for panel, mesh in zip("abcdef", meshes, strict=True):
        marks: list[Curve | Line] = []
        for direction, (colour, line) in DIRECTION_STYLES.items():
            curve = select(tables["sweep"], direction, "deflection_ac_rms_um", mesh)
            name = f"speed {direction}"
            marks.append(Curve(curve["speed_rpm"], curve["value"], name, colour, line, width=1.0))
        marks += _stated_speeds([claim for claim in claims if _on_mesh(claim, mesh)])
        panels.append(_sweep_panel(marks, f"({panel}) {mesh}"))
    return Figure(panels, width=1.4 * NARROW, keys=_stated_key(panels))


def _on_mesh(claim: Claim, mesh: str) -> bool:
    """Whether a claim states a jump of this mesh: of all meshes where it names no pinion."""
    return "near" in claim.args and claim.args.get("pinion", mesh.split("/")[0]) == mesh.split("/")[0]


def stated_speed(claim: Claim) -> float:
    """Return the speed at which a claim states a peak or a jump.

    Parameters
    ----------
    claim : Claim
        A claim with argument `near`.

    Returns
    -------
    float
        Speed, rpm.
    """
    return float(claim.args["near"])


def _stated_speeds(claims: Sequence[Claim]) -> list[Line]:
    return [
        Line(speed, name=f"stated {speed:g} rpm", in_legend=False, **CLAIM_STYLE)
        for speed in dict.fromkeys(stated_speed(claim) for claim in claims)
    ]


def _stated_key(panels: Sequence[Panel]) -> list[Key]:
    """One entry of the legend for all speeds that the paper states."""
    is_stated = any(isinstance(mark, Line) for panel in panels for mark in panel.marks)
    return [Key("stated by the paper", **CLAIM_STYLE)] if is_stated else []


def _sweep_panel(marks: Sequence[Curve | Line], title: str) -> Panel:
    speed = Axis("input rotation speed", "rpm", low=SPEEDS[0], high=SPEEDS[1])
    return Panel(speed, Axis("RMS", "µm", low=0.0), marks, title=title, height=1.5)


def _sharing(study: str, kind: str) -> Draw:
    """Figures 13 to 20: a coefficient over one mesh cycle, a colour for each point of a study."""

    def draw_sharing(tables: Tables, claims: Sequence[Claim]) -> Figure:
        curves, sharing = tables["curves"], tables["sharing"]
        rows = curves[(curves["study"] == study) & (curves["kind"] == kind)]
        rows = rows[rows["group"] == rows["group"].iloc[0]]
        (low, high), subject = SHARING[kind]
        marks: list[Curve | Line] = []
        for colour, (point, curve) in zip(COLOURS, rows.groupby("point", sort=False), strict=False):
            label, time = curve["label"].iloc[0], 1e4 * curve["time_s"]
            marks.append(Curve(time, curve["coefficient"], label, colour))
            of_point = sharing[(sharing["study"] == study) & (sharing["point"] == point)]
            group_summary = of_point.set_index("group").loc[curve["group"].iloc[0]]
            if group_summary["undefined_fraction"] < MAX_UNDEFINED:
                look: Look = {"colour": colour, "line": "solid", "width": 3.0, "part": 0.04}
                marks.append(Line(group_summary["mean"], "y", f"{label}, our mean", **look))
            for claim, claimed_value in _numbers(claims):
                if claim.args.get("point") == point:
                    name = "minimum" if "column" in claim.args else "mean"
                    line = "dashdot" if name == "minimum" else "dot"
                    style: Look = {**CLAIM_STYLE, "colour": colour, "line": line}
                    marks.append(Line(claimed_value, "y", f"{label}, stated {name}", **style))
        panel = Panel(
            Axis("time over one mesh cycle", "10⁻⁴ s", low=0.0, high=float(time.max())),
            Axis(f"dynamic load sharing coefficient\n{subject}", "", low=low - 0.05, high=high + 0.05),
            marks,
            height=3.0,
        )
        return Figure([panel], width=1.2 * NARROW)

    return draw_sharing


def _numbers(claims: Sequence[Claim]) -> list[tuple[Claim, float]]:
    """The claims that state a number, and that number."""
    return [(claim, claim.paper) for claim in claims if claim.paper is not None]


DRAW_FUNCTIONS: Mapping[int, Draw] = {
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
