"""Figures of load sharing: over a cycle, over the hunting cycle, map, studies."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from facegear.build.machine_layout import layout
from facegear.build.tooth_numbers import ToothNumbers
from facegear.number_format import format_number
from facegear.report.figures.colours import BLACK, BLUE, GREEN, RED, colour_of, mesh_looks
from facegear.report.figures.comparison import split_label
from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.machine import layout_figure
from facegear.report.figures.marks import Band, Bars, Curve, Line, LineStyle, Look
from facegear.schema.transmission import Transmission
from facegear.sharing.sharing_map import AS_GIVEN

LINES: tuple[LineStyle, ...] = ("solid", "dash", "dashdot", "dot")
"""Lines of the points of a study, in their order."""


LABEL = {
    "inputs": "Load sharing coefficient\nof upper and lower face gear",
    "idlers": "Load sharing coefficient\nof idlers and tail rotor idler",
}
"""Label of the coefficient's axis by kind of group."""


ENVELOPE = 0.02
"""An envelope narrower than this is a line, and not drawn."""


def sharing_figure(curves: pd.DataFrame, summary: pd.DataFrame, kind: str, title: str) -> Figure:
    """Draw the load sharing coefficient of a group over one mesh cycle, a curve for each point of a study.

    Where the motion is not period-one a single cycle is drawn over the envelope of all cycles. Gaps are
    instants at which no path carries load. Of several groups of a kind the first is drawn, as in the paper.

    Parameters
    ----------
    curves : DataFrame
        A table `studies` of stage load_sharing_summary, of one study: study, point, label, kind, group,
        time_s, coefficient, envelope_low and envelope_high.
    summary : DataFrame
        Table `summary` of stage load_sharing_summary: study, point, group, mean, half_width,
        undefined_fraction and motion (class).
    kind : str
        Kind of group, `inputs` or `idlers`.
    title : str
        Title of the study.

    Returns
    -------
    Figure
        One panel over time, ms.
    """
    rows = curves[curves["kind"] == kind]
    group = rows["group"].iloc[0]
    rows = rows[rows["group"] == group]
    means = summary[(summary["group"] == group) & (summary["study"] == rows["study"].iloc[0])]
    means = means.set_index("point")
    marks: list[Band | Curve] = []
    for number, (point, curve) in enumerate(rows.groupby("point", sort=False)):
        marks += _marks(curve, means.loc[point], number)
    cycle = 1e3 * rows["time_s"].max() * len(curve) / (len(curve) - 1)
    top = max(2.0 if kind == "inputs" else 3.0, float(rows["envelope_high"].max()))
    panel = Panel(
        Axis("Time over one mesh cycle", "ms", low=0.0, high=cycle),
        Axis(LABEL[kind], "", low=0.95, high=top + 0.05),
        marks,
        title=f"{title}: {group}",
        height=2.7,
    )
    return Figure([panel])


def _marks(curve: pd.DataFrame, mean: pd.Series, number: int) -> Iterator[Band | Curve]:
    """Yield the curve of one point of a study over time (ms), below it its envelope if wider than
    ENVELOPE, and the legend's name with mean, half-width and class of motion.

    curve: the point's rows of the curves; mean: its row of the summary; number: of the point, for
    colour and line.
    """
    colour = colour_of(number)
    if mean["motion"] == "period-1":
        curve = _close_cycle(curve)
    time = 1e3 * curve["time_s"]
    if (curve["envelope_high"] - curve["envelope_low"]).max() > ENVELOPE:
        yield Band(time, curve["envelope_low"], curve["envelope_high"], colour=colour, opacity=0.12)
    width = f" ± {format_number(mean['half_width'], 1)}" if mean["half_width"] > 0.005 else ""
    name = f"{curve['label'].iloc[0]}: mean {format_number(mean['mean'])}{width}, {mean['motion']}"
    if mean["undefined_fraction"] > 0.005:
        name += f", unloaded {format_number(100 * mean['undefined_fraction'], 2)} %"
    yield Curve(time, curve["coefficient"], name, colour, LINES[number % len(LINES)], width=1.3)


def _close_cycle(curve: pd.DataFrame) -> pd.DataFrame:
    """Return the samples of one cycle of a period-one motion with the first one repeated one time step
    (time_s) after the last.
    """
    end = curve.iloc[[0]].copy()
    end["time_s"] = curve["time_s"].iloc[-1] + curve["time_s"].iloc[1]
    return pd.concat([curve, end], ignore_index=True)


def load_sharing_figures(
    studies: Sequence[pd.DataFrame],
    summary: pd.DataFrame,
    titles: Sequence[str],
    groups: Sequence[str],
) -> list[Figure]:
    """Draw a figure for each study and kind of group.

    Parameters
    ----------
    studies : sequence of DataFrame
        Curves of each study, as `sharing_figure` reads them.
    summary : DataFrame
        Table `summary` of stage load_sharing_summary.
    titles : sequence of str
        Title of each study.
    groups : sequence of str
        Kinds of groups, `inputs` or `idlers`.

    Returns
    -------
    list of Figure
        The figures.
    """
    return [
        sharing_figure(table, summary, kind, title)
        for table, title in zip(studies, titles, strict=True)
        for kind in groups
    ]


CYCLE_LINES: Mapping[str, LineStyle] = {"geometric": "solid", "printed": "dash"}
"""Line of each kinematics."""


MAX_BARS = 20
"""Bars of the sensitivity chart."""


def hunting_figure(cycles: pd.DataFrame, meshes: pd.DataFrame) -> Figure:
    """Draw the share of its group's load that each mesh carries in each mesh cycle, a panel for each group.

    Parameters
    ----------
    cycles : DataFrame
        Table `cycles` of stage hunting: cycle (number of the mesh cycle) and the mean load of each mesh
        in it in a column `<mesh> (N)`.
    meshes : DataFrame
        Table `meshes` of stage hunting: mesh and group; meshes without a group are left out.

    Returns
    -------
    Figure
        A panel for each group, %; a dotted line is the even share.
    """
    panels = []
    for group in [name for name in meshes["group"].dropna().unique() if name]:
        names = meshes.loc[meshes["group"] == group, "mesh"]
        loads = cycles[[f"{name} (N)" for name in names]].to_numpy()
        total = loads.sum(axis=1)
        shares = 100.0 * loads / np.where(total > 0.0, total, np.nan)[:, None]
        has_several = len(shares) > 1
        at = cycles["cycle"].to_numpy() if has_several else np.array([0, 1])
        marks: list[Curve | Line] = [
            Curve(at, share if has_several else np.repeat(share, 2), name, colour_of(number + 1), width=0.9)
            for number, (share, name) in enumerate(zip(shares.T, names, strict=True))
        ]
        marks.append(Line(100.0 / len(names), "y", line="dot"))
        cycle = Axis("Mesh cycle", "", low=float(at.min()), high=float(at.max()))
        share_axis = Axis("Share", "%")
        title = f"Group: {group}"
        panels.append(Panel(cycle, share_axis, marks, title=title, height=1.4, own_legend=True))
    return Figure(panels, title="Load of each mesh over the hunting cycle, quasi-static")


def bearing_figure(scan: pd.DataFrame) -> Figure:
    """Draw K_gamma over the bearing stiffness of the inputs (top) and of the idlers (below), for each
    kinematics of the table.

    Parameters
    ----------
    scan : DataFrame
        Table `scan` of stage hunting: varied (`inputs` or `idlers`, whose bearings vary), kind (of the
        group), kinematics, stiffness_n_per_m, k_gamma.

    Returns
    -------
    Figure
        Two panels over stiffness, N/µm, logarithmic.
    """
    panels = []
    for role in ("inputs", "idlers"):
        curves = []
        for number, kind in enumerate(scan["kind"].unique()):
            for kinematics, line in CYCLE_LINES.items():
                mask = (scan["varied"] == role) & (scan["kind"] == kind)
                rows = scan[mask & (scan["kinematics"] == kinematics)]
                if rows.empty:
                    continue
                name = f"Kᵧ of the {kind}, {kinematics}"
                stiffness = 1e-6 * rows["stiffness_n_per_m"]
                curves.append(Curve(stiffness, rows["k_gamma"], name, colour_of(number + 1), line))
        across = Axis(f"Bearing stiffness of the {role}", "N/µm", logarithmic=True)
        panels.append(Panel(across, Axis("Largest Kᵧ of the paths", ""), curves, height=2.2))
    return Figure(panels, title="Static load sharing against bearing stiffness", shared_x=False)


def sensitivity_figure(table: pd.DataFrame) -> Figure:
    """Draw the largest sensitivities of K_gamma, a bar for each error: that of the group whose factor changes
    most.

    Parameters
    ----------
    table : DataFrame
        Change of K_gamma of each group by each error: group, error (name), per_um (1/µm, signed).

    Returns
    -------
    Figure
        Bars in 1e-3/µm, the largest on top.
    """
    largest = table.loc[table.groupby("error")["per_um"].apply(lambda rows: rows.abs().idxmax())]
    rows = largest.sort_values("per_um", key=np.abs, ascending=False).head(MAX_BARS)[::-1]
    positions = np.arange(len(rows), dtype=float)
    marks: list[Bars | Line] = [Line(0.0, colour=BLACK, width=0.6)]
    for number, group in enumerate(table["group"].unique()):
        in_group = (rows["group"] == group).to_numpy()
        if in_group.any():
            lengths = 1e3 * rows["per_um"].to_numpy()[in_group]
            marks.append(
                Bars(positions[in_group], lengths, f"Kᵧ of {group}", colour_of(number + 1), flat=True)
            )
    errors = [(position, str(name)) for position, name in zip(positions, rows["error"], strict=True)]
    panel = Panel(
        Axis("Change of Kᵧ", "10⁻³/µm"),
        Axis("", "", low=-0.6, high=len(rows) - 0.4, ticks=errors),
        marks,
        height=0.5 + 0.22 * len(rows),
    )
    return Figure([panel], title="Which errors matter: largest first")


def hunting_figures(
    meshes: pd.DataFrame,
    bearings: pd.DataFrame,
    cycles: pd.DataFrame,
    scan: pd.DataFrame,
    sensitivity: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
) -> tuple[Figure, ...]:
    """Draw the layout with its mean forces, loads over the hunting cycle, K_gamma over bearings,
    sensitivities.

    Parameters
    ----------
    meshes, bearings, cycles, scan, sensitivity : DataFrame
        Tables of stage hunting and its sensitivities, as the four figures read them.
    transmission : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Numbers of teeth and sizes of the pair.

    Returns
    -------
    tuple of Figure
        Those of `layout_figure`, `hunting_figure`, `bearing_figure` and `sensitivity_figure`.
    """
    return (
        layout_figure(layout(transmission, teeth), meshes, bearings),
        hunting_figure(cycles, meshes),
        bearing_figure(scan),
        sensitivity_figure(sensitivity),
    )


FLOATING: Mapping[str, tuple[str, str]] = {
    AS_GIVEN: ("as given", BLACK),
    "upper": ("upper gear floats", BLUE),
    "lower": ("lower gear floats", RED),
    "both": ("both gears float", GREEN),
}
"""Name and colour of each curve of the idlers."""


OTHER_LEVELS: Mapping[int, LineStyle] = {50: "dash", 99: "dashdot"}
"""Percentiles that are drawn beside P95 for the machine as given."""


ALL_CARRY = 1.0 - 1e-9
"""Fraction of samples in which every path carries, from which the closed form may hold."""


HOLDS = 0.02
"""Relative difference from the statics below which a closed form is drawn: little beside what it explains."""


CLOSED_NAME = "closed form"
"""Legend of the closed form."""


MARKERS = ("circle", "square", "diamond", "triangle-up", "triangle-down", "cross", "star")
"""Markers of the meshes by colour."""


WIDE = 30.0
"""Ratio of the largest number to the smallest from which the axis is logarithmic."""


PERIODIC = "period-1"
"""Class of a motion that repeats with the mesh cycle."""


def study_forces_figures(forces: pd.DataFrame, titles: Mapping[str, str]) -> list[Figure]:
    """Draw a figure of mesh forces for each study whose axis is a number.

    Parameters
    ----------
    forces : DataFrame
        Table `forces` of stage study_forces, as `forces_figure` reads it; empty texts may be nan, as
        they are read from csv.
    titles : mapping of str to str
        Title of each study by its name.

    Returns
    -------
    list of Figure
        The figures.
    """
    text = {name: forces[name].astype(object).where(forces[name].notna(), "") for name in ("group", "beside")}
    every = forces.assign(**text).groupby("study", sort=False)
    return [forces_figure(rows, titles[str(name)]) for name, rows in every]


def forces_figure(forces: pd.DataFrame, title: str) -> Figure:
    """Draw two panels for each label of the other axis of a study: fraction of the group's load, largest
    force.

    Parameters
    ----------
    forces : DataFrame
        Rows of one study of table `forces`: mesh, group, axis (name and unit of the study's number),
        number, beside (label of the other axis), fraction, largest_n, motion.
    title : str
        Title of the figure.

    Returns
    -------
    Figure
        Panels in pairs: fraction, %, and force, kN.
    """
    looks = mesh_looks(dict.fromkeys(forces["mesh"]))
    name, unit = split_label(str(forces["axis"].iloc[0]))
    if unit == "N/m":
        forces, unit = forces.assign(number=1e-6 * forces["number"]), "N/µm"
    numbers = forces["number"]
    is_wide = numbers.min() > 0.0 and numbers.max() > WIDE * numbers.min()
    across = Axis(name, unit, logarithmic=bool(is_wide))
    panels = []
    for beside, rows in forces.groupby("beside", sort=False):
        group_rows = rows[rows["group"] != ""]
        panels += [
            Panel(
                across,
                Axis("Mean fraction of the\nload of its group", "%"),
                list(_curves(group_rows, looks, "fraction", 100.0, in_legend=False)),
                title=str(beside),
                height=1.9,
            ),
            Panel(
                across,
                Axis("Largest dynamic\nforce", "kN", low=0.0),
                list(_curves(rows, looks, "largest_n", 1e-3)),
                height=1.9,
            ),
        ]
    return Figure(panels, title=title)


def _curves(
    rows: pd.DataFrame, looks: Mapping[str, Any], column: str, scale: float, in_legend: bool = True
) -> Iterator[Curve]:
    """Yield `scale` times a column over `number`, a curve for each mesh, and hollow marks where the
    motion is not PERIODIC.

    rows: rows of table `forces`; looks: colour and line by mesh, see `mesh_looks`; in_legend: whether
    meshes stand in the legend.
    """
    colours = list(dict.fromkeys(look["colour"] for look in looks.values()))
    for mesh, every in rows.groupby("mesh", sort=False):
        look = looks[str(mesh)]
        marker = MARKERS[colours.index(look["colour"]) % len(MARKERS)]
        sorted_rows = every.sort_values("number")
        yield Curve(
            sorted_rows["number"],
            scale * sorted_rows[column],
            str(mesh),
            width=1.3,
            marker=marker,
            in_legend=in_legend,
            **look,
        )
        irregular_rows = sorted_rows[sorted_rows["motion"] != PERIODIC]
        if len(irregular_rows):
            hollow: Look = {"colour": look["colour"], "line": "none", "marker": marker, "hollow": True}
            yield Curve(
                irregular_rows["number"], scale * irregular_rows[column], str(mesh), in_legend=False, **hollow
            )
