"""Contact of the cases of a study side by side."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from facegear.arrays import Arrays
from facegear.contact.studies import StudiedContact
from facegear.plots.colours import COLOURS
from facegear.plots.contact import close_pitch, pattern_panels
from facegear.plots.description import Axis, Curve, Figure, Line, LineStyle, Panel

LINES: tuple[LineStyle, ...] = ("solid", "dash", "dashdot", "dot")


def contact_study(cases: Sequence[StudiedContact], torque: float, title: str) -> Figure:
    """Transmission error less its mean, average stiffness, contact radius over a pitch at a torque (N m)."""
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
    """Less the mean over the pitch, whose end repeats its beginning."""
    return closed_curve - closed_curve.iloc[:-1].mean()


def pattern_study(cases: Sequence[StudiedContact], torque: float) -> Figure:
    """Contact patterns at a torque (N m), one panel a case, one scale."""
    return pattern_panels(
        {case.label_at(torque): (case.pressure, case.torque_near(torque)) for case in cases}
    )


def figures(
    points: Sequence[Sequence[str]],
    titles: Mapping[str, str],
    torque: float,
    pair: Sequence[Mapping[str, Any]],
    ltca: Sequence[pd.DataFrame],
    by_torque: Sequence[pd.DataFrame],
    pressure: Sequence[Arrays],
) -> list[Figure]:
    """Curves and patterns of each study beside those of the machine itself.

    `points`: study, point and label of each case; `titles`: of each study by its name.
    """
    machine, *other_cases = StudiedContact.from_columns(points, pair, ltca, by_torque, pressure)
    study_figures = []
    for study, title in titles.items():
        cases = [machine, *(case for case in other_cases if case.study == study)]
        study_figures += [contact_study(cases, torque, title), pattern_study(cases, torque)]
    return study_figures
