"""Figures of loaded contact: transmission error, load share, pattern, studies, poses."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays, Integers
from facegear.contact.pattern import EDGES, SHARES, Pattern, pattern
from facegear.contact.summary import StudiedContact
from facegear.machine.poses.tables import hardest_mesh
from facegear.number_format import format_number
from facegear.report.figures.colours import (
    BLACK,
    BLUE,
    COLOURS,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    grey,
    mesh_looks,
    shades,
)
from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.marks import ColourScale, Curve, Line, LineStyle, Look, Map

PAIR_NAMES = ("-2", "-1", "0", "1", "2")
"""Numbers of the tooth pairs, as their legend has them."""

MARKS = (
    (("pinion tip", "gear tip"), "square", BLUE, "tip edge: line load only"),
    (("end",), "diamond", GREEN, "end of the face: the same"),
)
"""Kinds of edges, marker, colour and legend: where a flank carries load and no pressure is known."""
UNLOADED_COLOUR = grey(0.92)
"""Colour of a flank where it carries no load."""
PAIR_LOOKS: tuple[tuple[str, LineStyle], ...] = (
    (PURPLE, "dot"),
    (RED, "dash"),
    (BLACK, "solid"),
    (BLUE, "dash"),
    (ORANGE, "dot"),
)
"""Colour and line of each of PAIR_NAMES."""


def contact_curves(ltca: pd.DataFrame) -> Figure:
    """Draw static transmission error and both stiffnesses for each torque, load shares at the smallest and
    largest.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact: a row for each torque_n_m and position (pitches).

    Returns
    -------
    Figure
        Three or four panels over one pitch.
    """
    torques = np.sort(ltca["torque_n_m"].unique())
    error, stiffness = [], []
    for torque, colour in zip(torques, shades(torques.size), strict=True):
        rows = close_pitch(ltca[ltca["torque_n_m"] == torque])
        at, name = rows["position"], f"{format_number(torque, 4)} N m"
        error.append(Curve(at, rows["ste_um"], name, colour))
        stiffness += [
            Curve(at, 1e-6 * rows["k_average_n_per_m"], name, colour, in_legend=False),
            Curve(
                at,
                1e-6 * rows["k_local_n_per_m"],
                f"{name}, local",
                colour,
                "dash",
                width=0.9,
                in_legend=False,
            ),
        ]
    unloaded_rows = close_pitch(ltca[ltca["torque_n_m"] == torques[0]])
    error.append(Curve(unloaded_rows["position"], unloaded_rows["unloaded_ste_um"], "unloaded", BLACK, "dot"))
    position = Axis("Position", "pitches", low=0.0, high=1.0)
    panels = [
        Panel(position, Axis("Static transmission error", "µm"), error, height=2.2, own_legend=True),
        Panel(position, Axis("Stiffness", "N/µm", "average solid, local dashed"), stiffness, height=2.2),
    ]
    for torque in torques[[0, -1]] if torques.size > 1 else torques:
        rows = close_pitch(ltca[ltca["torque_n_m"] == torque])
        pairs = [
            Curve(rows["position"], rows[column], f"pair {name}", colour, line)
            for column, name, (colour, line) in zip(SHARES, PAIR_NAMES, PAIR_LOOKS, strict=True)
            if (rows[column] > 0).any()
        ]
        label = Axis(f"Load share\nat {format_number(torque, 4)} N m", "", low=-0.02, high=1.05)
        panels.append(Panel(position, label, pairs, height=2.0, own_legend=True))
    return Figure(panels)


def close_pitch(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of one torque in the order of position, with the first row added again one pitch later.

    There each load share moves to the pair before: pair k + 1 at the begin is pair k one pitch later.

    Parameters
    ----------
    rows : pd.DataFrame
        Rows of table `ltca` at one torque: position (pitches), SHARES and others.

    Returns
    -------
    pd.DataFrame
        The rows with the added one.
    """
    rows = rows.sort_values("position")
    last = rows.iloc[[0]].copy()
    last["position"] = rows["position"].iloc[0] + 1.0
    last[list(SHARES)] = np.append(last[list(SHARES)].to_numpy()[0, 1:], 0.0)
    return pd.concat([rows, last], ignore_index=True)


def contact_pattern(arrays: Arrays) -> Figure:
    """Draw the pressure that each point of the pinion's flank sees as it passes through the mesh, one panel a
    torque.

    Parameters
    ----------
    arrays : Arrays
        Arrays `pressure` of stage contact (PRESSURE_ARRAYS), SI units.

    Returns
    -------
    Figure
        The figure.
    """
    torques = np.unique(arrays["line_torque_n_m"])
    return pattern_panels({_title(arrays, torque): (arrays, torque) for torque in torques})


def pattern_panels(panels: Mapping[str, tuple[Arrays, float]], title: str = "") -> Figure:
    """Draw contact patterns as panels with one scale, which ends at their largest pressure.

    Marks show where only a line load is known.

    Parameters
    ----------
    panels : mapping of str to (arrays, float)
        Arrays `pressure` of stage contact, of shape (...) in SI units, and the torque to show, N m, by title
        of the panel.
    title : str
        Title of the figure.

    Returns
    -------
    Figure
        A panel for each entry: pinion radius over the place along its axis, mm.
    """
    patterns = {name: (pattern(arrays), float(torque)) for name, (arrays, torque) in panels.items()}
    top = max(
        np.nanmax(flank_pattern.pressure[torque], initial=0.0) for flank_pattern, torque in patterns.values()
    )
    scale = ColourScale("Pressure", "MPa", 0.0, 1e-6 * top or 1.0, "inferno")
    nodes = np.concatenate([1e3 * arrays["point_m"] for arrays, _ in panels.values()])
    height = np.hypot(nodes[:, 0], nodes[:, 2])
    across = Axis(
        "Along the pinion's axis, from the gear's",
        "mm",
        low=float(nodes[:, 1].min()),
        high=float(nodes[:, 1].max()),
    )
    up = Axis("Pinion\nradius", "mm", low=float(height.min()), high=float(height.max()))
    drawn_panels = [
        Panel(
            across, up, _marks(flank_pattern, torque, scale), title=name, height=1.1, ground=UNLOADED_COLOUR
        )
        for name, (flank_pattern, torque) in patterns.items()
    ]
    return Figure(drawn_panels, title=title)


def _marks(flank_pattern: Pattern, torque: float, scale: ColourScale) -> list[Map | Curve]:
    """Return a panel's marks over width and radius (mm) of the pinion: a map of the pressure (MPa) that
    the contact lines sweep at a torque (N m, a key of the pattern), and points where an edge carries
    the load.
    """
    width = 1e3 * flank_pattern.points[..., 1]
    radius = 1e3 * np.hypot(flank_pattern.points[..., 0], flank_pattern.points[..., 2])
    edge_kind = flank_pattern.edge[torque]
    marks: list[Map | Curve] = [
        Map(width, radius, 1e-6 * _fade_edges(flank_pattern.pressure[torque], edge_kind), scale, smooth=True)
    ]
    for edges, marker, colour, name in MARKS:
        on = np.isin(edge_kind, [EDGES.index(kind) for kind in edges])
        if on.any():
            marks.append(Curve(width[on], radius[on], name, colour, line="none", marker=marker, size=2.5))
    return marks


def _fade_edges(field: Array, edge_kind: Integers) -> Array:
    """Return a pressure field (stages, planes), Pa, with 0 in place of nan where nothing is in contact
    (`edge_kind` < 0) and the plane before or after is loaded: there the loaded length ends.
    """
    is_finite = np.isfinite(field)
    beside = np.zeros_like(is_finite)
    beside[:, 1:] |= is_finite[:, :-1]
    beside[:, :-1] |= is_finite[:, 1:]
    return np.where(beside & (edge_kind < 0), 0.0, field)


def _title(arrays: Arrays, torque: float) -> str:
    """Return a panel's title: torque (N m), largest pressure and error (MPa), largest tip line load
    (N/mm).
    """
    on = arrays["line_torque_n_m"] == torque
    at = np.argmax(arrays["line_pressure_pa"][on])
    pressure, error = (1e-6 * arrays[f"line_{name}_pa"][on][at] for name in ("pressure", "error"))
    tips = np.isin(arrays["line_where"][on], [EDGES.index("pinion tip"), EDGES.index("gear tip")])
    tip = 1e-3 * arrays["line_load_n_per_m"][on][tips].max(initial=0.0)
    edge = f"; tip edges {format_number(tip)} N/mm" if tip > 0 else ""
    return (
        f"{format_number(torque, 4)} N m: {format_number(pressure)} ± {format_number(round(error))} MPa{edge}"
    )


def contact_figures(ltca: pd.DataFrame, pressure: Arrays) -> tuple[Figure, ...]:
    """Draw curves over a pitch, and the contact pattern.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact.
    pressure : Arrays
        Arrays `pressure` of stage contact.

    Returns
    -------
    tuple[Figure, ...]
        Those of `contact_curves` and `contact_pattern`.
    """
    return contact_curves(ltca), contact_pattern(pressure)


LINES: tuple[LineStyle, ...] = ("solid", "dash", "dashdot", "dot")
"""Lines of the cases after the colours are used up."""


def contact_study(cases: Sequence[StudiedContact], torque: float, title: str) -> Figure:
    """Draw transmission error less its mean, average stiffness and contact radius over a pitch, a curve for
    each case.

    Parameters
    ----------
    cases : sequence of StudiedContact
        Contact of each case; the first one is the machine itself.
    torque : float
        Torque on the pinion, N m; each case shows its nearest one.
    title : str
        Title of the figure.

    Returns
    -------
    Figure
        Three panels over one pitch.
    """
    error: list[Curve] = []
    stiffness: list[Curve] = []
    path: list[Curve | Line] = []
    for number, case in enumerate(cases):
        rows = close_pitch(case.over_pitch(torque))
        colour, line = COLOURS[number % len(COLOURS)], LINES[number // len(COLOURS) % len(LINES)]
        at, name = rows["position"], case.label_at(torque)
        error.append(Curve(at, _variation(rows["ste_um"]), name, colour, line))
        stiffness.append(Curve(at, 1e-6 * rows["k_average_n_per_m"], name, colour, line))
        path.append(Curve(at, rows["path_radius_mm"], name, colour, line))
        path.append(Line(case.unloaded_path_mm, "y", colour=colour, line="dot", width=0.9))
    position = Axis("Position", "pitches", low=0.0, high=1.0)
    return Figure(
        [
            Panel(position, Axis("Transmission error\nless its mean", "µm"), error, height=2.0),
            Panel(position, Axis("Average stiffness", "N/µm"), stiffness, height=2.0),
            Panel(position, Axis("Contact radius", "mm", "dotted: unloaded"), path, height=2.0),
        ],
        title=title,
    )


def _variation(closed_curve: pd.Series) -> pd.Series:
    """Return a curve less its mean over the pitch; the last value repeats the first, so the mean leaves
    it out.
    """
    return closed_curve - closed_curve.iloc[:-1].mean()


def pattern_study(cases: Sequence[StudiedContact], torque: float) -> Figure:
    """Draw the contact patterns of several cases at one torque, a panel for each case, all with one scale.

    Parameters
    ----------
    cases : sequence of StudiedContact
        Contact of each case.
    torque : float
        Torque on the pinion, N m; each case shows its nearest one.

    Returns
    -------
    Figure
        The figure.
    """
    return pattern_panels(
        {case.label_at(torque): (case.pressure, case.torque_near(torque)) for case in cases}
    )


def contact_study_figures(
    points: Sequence[Sequence[str]],
    titles: Mapping[str, str],
    torque: float,
    pair: Sequence[Mapping[str, Any]],
    ltca: Sequence[pd.DataFrame],
    by_torque: Sequence[pd.DataFrame],
    pressure: Sequence[Arrays],
) -> list[Figure]:
    """Draw curves and patterns of each study beside those of the machine itself.

    Parameters
    ----------
    points : sequence of sequences of str
        Study, point and label of each case.
    titles : mapping of str to str
        Title of each study by its name.
    torque : float
        Torque on the pinion, N m.
    pair : sequence of mappings
        Record of the tooth geometry of each case; the first is the machine.
    ltca : sequence of DataFrame
        Table `ltca` of stage contact of each case.
    by_torque : sequence of DataFrame
        Table `by_torque` of stage contact of each case.
    pressure : sequence of mappings of (...) arrays
        Arrays `pressure` of stage contact of each case, SI units.

    Returns
    -------
    list of Figure
        Two figures for each study: curves and patterns.
    """
    machine, *other_cases = StudiedContact.from_columns(points, pair, ltca, by_torque, pressure)
    study_figures = []
    for study, title in titles.items():
        cases = [machine, *(case for case in other_cases if case.study == study)]
        study_figures += [contact_study(cases, torque, title), pattern_study(cases, torque)]
    return study_figures


NEAR = 8.0
"""Distance (mm) between a contact path and an end of the face below which that end is drawn."""


def operating_pose_figures(
    meshes: pd.DataFrame, loads: pd.DataFrame, as_assembled: Arrays, running: Arrays
) -> tuple[Figure, ...]:
    """Draw the pattern of the mesh that its pose changes most, and unloaded paths of all meshes over the
    load.

    Parameters
    ----------
    meshes : pd.DataFrame
        Table `meshes` of stage operating_pose, as `pose_pattern` reads it.
    loads : pd.DataFrame
        Table `loads` of stage operating_pose.
    as_assembled : Arrays
        Contact arrays `as_assembled` of stage operating_pose, SI units.
    running : Arrays
        Contact arrays `running` of stage operating_pose: at the pose under the machine's forces.

    Returns
    -------
    tuple[Figure, ...]
        The figures.
    """
    return pose_pattern(meshes, as_assembled, running), pose_paths(meshes, loads)


def pose_pattern(meshes: pd.DataFrame, as_assembled: Arrays, running: Arrays) -> Figure:
    """Draw two panels of the contact pattern: as assembled, and at the pose under the machine's forces.

    Parameters
    ----------
    meshes : pd.DataFrame
        Table `meshes` of stage operating_pose.
    as_assembled : Arrays
        Contact arrays `as_assembled` of stage operating_pose, SI units.
    running : Arrays
        Contact arrays `running`, of the mesh whose stiffness its pose changes most.

    Returns
    -------
    Figure
        The figure.
    """
    torque = float(np.unique(running["line_torque_n_m"])[0])
    row = meshes.iloc[hardest_mesh(meshes)]
    panels = {
        _operating_pose_title("as assembled", row["path_as_assembled_mm"], as_assembled): (
            as_assembled,
            torque,
        ),
        _operating_pose_title("as the machine runs", row["path_mm"], running): (running, torque),
    }
    return pattern_panels(panels, title=f"{row['mesh']} at {format_number(torque)} N m")


def _operating_pose_title(words: str, path_mm: float, arrays: Arrays) -> str:
    """Return a panel's title: `words`, contact path (mm from the gear's axis), largest pressure (MPa)."""
    pressure = 1e-6 * float(np.nanmax(arrays["line_pressure_pa"], initial=0.0))
    return f"{words}: path at {format_number(path_mm, 4)} mm, {format_number(pressure)} MPa"


def pose_paths(meshes: pd.DataFrame, loads: pd.DataFrame) -> Figure:
    """Draw the unloaded contact of every mesh along the pinion, and the ends of the face.

    Parameters
    ----------
    meshes : pd.DataFrame
        Table `meshes` of stage operating_pose.
    loads : pd.DataFrame
        Table `loads` of stage operating_pose: mesh, load_fraction, unloaded_path_mm.

    Returns
    -------
    Figure
        Distance from the gear's axis (mm) over load (%); an end of the face only if within NEAR.
    """
    row = meshes.iloc[0]
    ends: Look = {
        "inner end of the face": row["unloaded_path_mm"] - row["to_inner_end_mm"],
        "outer end of the face": row["unloaded_path_mm"] + row["to_outer_end_mm"],
    }
    marks: list[Curve | Line] = []
    for name, look in mesh_looks(dict.fromkeys(loads["mesh"])).items():
        rows = loads[loads["mesh"] == name]
        marks.append(Curve(100.0 * rows["load_fraction"], rows["unloaded_path_mm"], name, **look))
    paths = loads["unloaded_path_mm"]
    styles: tuple[LineStyle, ...] = ("dot", "dashdot")
    for (name, radius), line in zip(ends.items(), styles, strict=True):
        if paths.min() - NEAR < radius < paths.max() + NEAR:
            marks.append(Line(radius, "y", name, line=line, width=2.0))
    across = Axis("Mean torques over the machine's own", "%")
    up = Axis("Unloaded contact,\nfrom the gear's axis", "mm")
    return Figure([Panel(across, up, marks, height=2.9)])
