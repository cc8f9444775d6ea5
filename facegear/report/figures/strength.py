"""Figures of strength and friction: root stress, life, stress over speed, loss and heat."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from facegear.number_format import begin_with_capital, format_number
from facegear.report.figures.colours import BLUE, ORANGE, grey, shades
from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.marks import Curve, Line, LineStyle, Look, Span
from facegear.report.figures.motion import DIRECTION_STYLES

PART_SHOWN = 0.02
"""Fraction of the largest stress above which the passage is drawn."""
BODIES = {"pinion": "Pinion", "face_gear": "Face gear"}
"""Bodies in words."""
COLOURS = {"pinion": BLUE, "face_gear": ORANGE}
"""Colour of each body."""
LINES: Mapping[str, LineStyle] = {
    "finite elements": "solid",
    "ISO 6336-3": "dash",
    "contact analysis": "solid",
    "ISO 6336-2": "dash",
}
"""Line of each method of rating."""
MARKS = {
    "finite elements": "circle",
    "ISO 6336-3": "x",
    "contact analysis": "square",
    "ISO 6336-2": "triangle-up",
}
"""Marker of each method of rating."""


def passage_figure(table: pd.DataFrame) -> Figure:
    """Draw the largest tension below the loaded flank, and largest compression below the other, for each
    torque.

    Parameters
    ----------
    table : pd.DataFrame
        Table `passage` of stage root_stress: torque_n_m, body, fillet (`loaded` or `other`), passage
        (pitches), largest_mpa, smallest_mpa (negative: compression).

    Returns
    -------
    Figure
        A panel for each body, where stress exceeds PART_SHOWN of the largest.
    """
    largest_stress = table[["largest_mpa", "smallest_mpa"]].abs().max(axis=1)
    positions = table.loc[largest_stress > PART_SHOWN * largest_stress.max(), "passage"]
    rows_shown = table[table["passage"].between(positions.min() - 0.25, positions.max() + 0.25)]
    return _both_fillets_figure(rows_shown, "passage", Axis("Passage of a tooth", "pitches"))


def along_face_figure(table: pd.DataFrame) -> Figure:
    """Draw the root stress along the face: the largest over the passage.

    Parameters
    ----------
    table : pd.DataFrame
        Table `along_face` of stage root_stress: the same columns, with radius_mm in place of passage.

    Returns
    -------
    Figure
        A panel for each body, MPa over the distance from the gear's axis.
    """
    return _both_fillets_figure(table, "radius_mm", Axis("Gear radius", "mm"))


def _both_fillets_figure(table: pd.DataFrame, coordinate: str, along: Axis) -> Figure:
    """Draw largest_mpa of the loaded fillet (solid) and smallest_mpa of the other (dashed) over a
    column `coordinate` with axis `along`: a panel for each body, a colour for each torque.
    """
    torques = np.sort(table["torque_n_m"].unique())
    panels = []
    for body, name in BODIES.items():
        curves = []
        for torque, colour in zip(torques, shades(torques.size), strict=True):
            rows = table[(table["torque_n_m"] == torque) & (table["body"] == body)]
            loaded_fillet, other_fillet = (
                rows[rows["fillet"] == fillet].sort_values(coordinate) for fillet in ("loaded", "other")
            )
            label = f"{format_number(torque, 4)} N m"
            look: Look = {"line": "dash", "width": 0.9, "in_legend": False}
            curves += [
                Curve(loaded_fillet[coordinate], loaded_fillet["largest_mpa"], label, colour),
                Curve(
                    other_fillet[coordinate],
                    other_fillet["smallest_mpa"],
                    f"{label}, other fillet",
                    colour,
                    **look,
                ),
            ]
        stress = Axis(f"{name}: root stress", "MPa", "tension solid, compression dashed")
        panels.append(Panel(along, stress, curves, height=2.4))
    return Figure(panels, shared_x=coordinate == "passage")


def life(rating: pd.DataFrame, damage: pd.DataFrame, curves: pd.DataFrame) -> Figure:
    """Draw stress and cycles of every bin of a duty cycle, and the stress that may be repeated so often.

    Of all pinions, and of all face gears, the flank nearest to its limit is drawn.

    Parameters
    ----------
    rating : pd.DataFrame
        Table `rating` of stage rating: body, gear, flank, failure, method, safety, required.
    damage : pd.DataFrame
        Table `damage` of stage rating: a row for each bin and rating, with bin, cycles, stress_mpa,
        damage.
    curves : pd.DataFrame
        Table `curves` of stage rating: S-N curves, with cycles and allowed_mpa.

    Returns
    -------
    Figure
        A panel for bending and one for pitting, both logarithmic.
    """
    panels = []
    for failure, stress in (("bending", "Root stress"), ("pitting", "Contact stress")):
        marks = []
        for row in _nearest(rating[rating["failure"] == failure]).itertuples():
            curve, bins = (_of(table, row) for table in (curves, damage[damage["cycles"] > 0]))
            colour, name = COLOURS[row.gear], _subject(row)
            line_look: Look = {"line": LINES[row.method], "in_legend": False}
            marks += [
                Curve(curve["cycles"], curve["allowed_mpa"], f"{name}: allowed", colour, **line_look),
                Curve(
                    bins["cycles"], bins["stress_mpa"], name, colour, line="none", marker=MARKS[row.method]
                ),
            ]
        up = Axis(stress, "MPa", "lines: allowed, marks: bins", logarithmic=True)
        cycles = Axis("Load cycles", "", logarithmic=True)
        panels.append(Panel(cycles, up, marks, height=2.4, own_legend=True))
    return Figure(panels, shared_x=False)


def damage_by_bin(rating: pd.DataFrame, damage: pd.DataFrame) -> Figure:
    """Draw the damage of every bin of a duty cycle to the flanks that `life` shows; Miner's sum is 1 at the
    end.

    Parameters
    ----------
    rating : pd.DataFrame
        Table `rating` of stage rating, as for `life`.
    damage : pd.DataFrame
        Table `damage` of stage rating, as for `life`.

    Returns
    -------
    Figure
        One panel, logarithmic; its title names flanks without damage.
    """
    rows = list(_nearest(rating).itertuples())
    marks: list[Curve | Line] = [Line(1.0, "y")]
    smallest, largest = 1e-3, 3.0
    spared = []
    for number, row in enumerate(rows):
        bins = _of(damage[damage["damage"] > 0], row)
        name = f"{_subject(row)} ({row.failure})"
        if bins.empty:
            spared.append(name)
            continue
        at = bins["bin"] + 0.12 * (number - 0.5 * (len(rows) - 1))
        look: Look = {"line": "none", "marker": MARKS[row.method], "size": 5.0}
        marks.append(Curve(at, bins["damage"], name, COLOURS[row.gear], **look))
        smallest, largest = min(smallest, bins["damage"].min()), max(largest, bins["damage"].max())
    first, last = int(damage["bin"].min()), int(damage["bin"].max())
    across = Axis("Bin of the duty cycle", "", low=first - 0.6, high=last + 0.6, integer=True)
    up = Axis("Damage", "", low=0.7 * smallest, high=1.4 * largest, logarithmic=True)
    title = "\n".join(["No damage:", *spared]) if spared else ""
    return Figure([Panel(across, up, marks, title=title, height=2.6)])


def _nearest(rating: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of table `rating` with the smallest safety over required safety, one for each
    gear (pinion or face gear), failure and method.
    """
    spare = rating["safety"] / rating["required"]
    return rating.loc[
        spare.groupby([rating["gear"], rating["failure"], rating["method"]], sort=False).idxmin()
    ]


def _of(table: pd.DataFrame, row: Any) -> pd.DataFrame:
    """Return the rows of a table with the same body, flank, failure and method as `row`, a row of table
    `rating`.
    """
    keys = ("body", "flank", "failure", "method")
    return table[np.logical_and.reduce([table[key] == getattr(row, key) for key in keys])]


def _subject(row: Any) -> str:
    """Return body, flank and method of `row`, a row of table `rating`, in words."""
    body = BODIES.get(row.body, begin_with_capital(row.body))
    return f"{body}, {row.flank} flank, {row.method}"


def root_figures(passage: pd.DataFrame, along_face: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw root stress over a passage, and along the face.

    Parameters
    ----------
    passage : pd.DataFrame
        Table `passage` of stage root_stress.
    along_face : pd.DataFrame
        Table `along_face` of stage root_stress.

    Returns
    -------
    tuple[Figure, ...]
        Those of `passage_figure` and `along_face_figure`.
    """
    return passage_figure(passage), along_face_figure(along_face)


def rating_figures(rating: pd.DataFrame, damage: pd.DataFrame, curves: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw bins of the duty cycle beside the stress that may be repeated so often, and their damage.

    Parameters
    ----------
    rating : pd.DataFrame
        Table `rating` of stage rating.
    damage : pd.DataFrame
        Table `damage` of stage rating.
    curves : pd.DataFrame
        Table `curves` of stage rating.

    Returns
    -------
    tuple[Figure, ...]
        Those of `life` and `damage_by_bin`.
    """
    return life(rating, damage, curves), damage_by_bin(rating, damage)


PANELS = {
    "face_gear_mpa": ("Face gear:\nroot stress", "MPa"),
    "pinion_mpa": ("Pinion:\nroot stress", "MPa"),
    "pressure_mpa": ("Pressure", "MPa"),
    "dynamic_factor": ("Dynamic factor", ""),
}
"""Columns drawn over speed, with name and unit."""
BRANCH: Look = {"colour": grey(0.6), "line": "none", "marker": "dot", "size": 3.0}
"""Look of stable branches."""
BEYOND = "beyond the torques of the contact analysis"
"""Legend of the shaded range."""


def stress_over_speed(table: pd.DataFrame, speed_rpm: float) -> Figure:
    """Draw the largest values of all meshes over speed: the sweep as lines, stable branches as dots beneath.

    The operating speed is a line. Values beyond the torques of the contact analysis are shaded.

    Parameters
    ----------
    table : DataFrame
        Table of stage stress_over_speed: motion (`sweep up`, `sweep down` or `branch ...`), speed_rpm,
        keys of PANELS, within_torques_solved.
    speed_rpm : float
        Operating speed, rpm.

    Returns
    -------
    Figure
        A panel for each key of PANELS.
    """
    branch_rows = table[table["motion"].str.startswith("branch ")]
    rows_within_torques = table[table["within_torques_solved"]]
    speed = Axis("Input speed", "rpm")
    panels = []
    for column, (name, unit) in PANELS.items():
        marks: list[Curve | Line | Span] = []
        if len(branch_rows):
            marks.append(Curve(branch_rows["speed_rpm"], branch_rows[column], "stable branch", **BRANCH))
        for direction, (colour, line) in DIRECTION_STYLES.items():
            rows = table[table["motion"] == f"sweep {direction}"]
            if len(rows):
                name_of = f"sweep {direction}"
                marks.append(Curve(rows["speed_rpm"], rows[column], name_of, colour, line, width=1.0))
        marks.append(Line(speed_rpm, name="nominal speed", colour=grey(0.3), line="dot"))
        top = 1.05 * float(table[column].max())
        if len(rows_within_torques) < len(table):
            first = float(rows_within_torques[column].max()) if len(rows_within_torques) else 0.0
            marks.append(Span(first, top, "y", name=BEYOND, opacity=0.12))
        panels.append(Panel(speed, Axis(name, unit, low=0.0, high=top), marks, height=1.5))
    return Figure(panels)


def stress_over_speed_figures(table: pd.DataFrame, speed_rpm: float) -> tuple[Figure, ...]:
    """Draw root stress, pressure and dynamic factor over speed.

    Parameters
    ----------
    table : DataFrame
        Table of stage stress_over_speed.
    speed_rpm : float
        Operating speed, rpm.

    Returns
    -------
    tuple of Figure
        The figure of `stress_over_speed`.
    """
    return (stress_over_speed(table, speed_rpm),)
