"""Contact of the cases of a study side by side."""

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from facegear.arrays import Arrays
from facegear.contact.studies import StudiedContact
from facegear.plots.contact import closed, pattern_panels
from facegear.plots.style import COLOURS, NARROW, styled

LINES = ("-", "--", "-.", ":")


def contact_study(cases: Sequence[StudiedContact], torque: float, title: str) -> Figure:
    """Transmission error less its mean, average stiffness, contact radius over a pitch at a torque (N m)."""
    with styled():
        figure, axes = plt.subplots(3, 1, figsize=(NARROW, 7.8 + 0.22 * len(cases)), sharex=True)
        error, stiffness, path = axes
        for number, case in enumerate(cases):
            rows = closed(case.over_pitch(torque))
            look = {"color": COLOURS[number % len(COLOURS)], "ls": LINES[number // len(COLOURS) % len(LINES)]}
            error.plot(rows["position"], _variation(rows["ste_um"]), label=case.label_at(torque), **look)
            stiffness.plot(rows["position"], 1e-6 * rows["k_average_n_per_m"], **look)
            path.plot(rows["position"], rows["path_radius_mm"], **look)
            path.axhline(case.unloaded_path_mm, **{**look, "ls": ":"}, lw=0.9)
        error.set(ylabel="Static transmission error\nless its mean (µm)")
        stiffness.set(ylabel="Average stiffness (N/µm)")
        path.set(ylabel="Radius of the contact (mm)\nloaded; dotted: unloaded, mean", xlim=(0, 1))
        path.set_xlabel("Position (pitches)")
        figure.legend(*error.get_legend_handles_labels(), loc="outside lower center", ncols=2)
        figure.suptitle(f"{title}\nat {torque:g} N m on the pinion", fontsize=9)
    return figure


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
    machine, *others = StudiedContact.several(points, pair, ltca, by_torque, pressure)
    drawn = []
    for study, title in titles.items():
        shown = [machine, *(case for case in others if case.study == study)]
        drawn += [contact_study(shown, torque, title), pattern_study(shown, torque)]
    return drawn
