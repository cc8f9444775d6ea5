"""Figures of the branches of periodic motions."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.report.figures.colours import BLACK, BLUE, GREEN, PURPLE, RED, grey
from facegear.report.figures.description import Axis, Figure, Key, Panel
from facegear.report.figures.marks import Bars, ColourScale, Curve, Line, LineStyle, Look, Scatter
from facegear.report.figures.motion import rms_axis, select

PERIOD_COLOURS = (BLUE, RED, GREEN, PURPLE)
"""Colours of period 1, 2, 4 and any other."""
LABELLED_PERIODS = (1, 2, 4)
"""Periods with a colour of their own, mesh periods."""
MARKERS = {
    "fold": "triangle-up",
    "period doubling": "square",
    "Neimark-Sacker": "diamond",
    "branch point": "circle",
}
"""Marker of each kind of special point."""
SWEEPS = {"up": ("y-up", grey(0.45)), "down": ("y-down", grey(0.7))}
"""Marker and colour of the jumps of a sweep by its direction."""
IRREGULAR = grey(0.55)
"""Colour of motions that are not periodic."""
MIN_FRACTION_SHOWN = 0.06
"""Smallest fraction of a bar that has room for its number."""
LOCI: Mapping[str, tuple[str, LineStyle]] = {"fold": (BLUE, "solid"), "period doubling": (RED, "dash")}
"""Colour and line of each kind of locus."""
UNIT_CIRCLE = 2.0 * np.pi * np.arange(361) / 360
"""Angles at which the unit circle is drawn, rad."""


def typical_meshes(pinions: Sequence[Mapping[str, Any]], meshes: Iterable[str]) -> list[str]:
    """Return the first mesh of the first pinion of each role.

    Parameters
    ----------
    pinions : Sequence[Mapping[str, Any]]
        Pinions as in the config; keys name and role are read.
    meshes : Iterable[str]
        Names `pinion/side` of the meshes.

    Returns
    -------
    list[str]
        For each role in the order of the pinions the first of `meshes` that begins with the pinion's
        name.
    """
    roles = [pinion["role"] for pinion in pinions]
    names = [pinion["name"] for i, pinion in enumerate(pinions) if roles[i] not in roles[:i]]
    different = list(dict.fromkeys(meshes))
    return [next(mesh for mesh in different if mesh.startswith(f"{name}/")) for name in names]


def amplitudes(
    branches: pd.DataFrame,
    special: pd.DataFrame,
    sweep: pd.DataFrame,
    meshes: Sequence[str],
    speed_rpm: float,
) -> Figure:
    """Draw the RMS without mean of mesh deflections over speed, a panel for each mesh.

    Stable parts are solid, unstable ones dashed, special points marked, points of the sweep beneath; the
    operating speed is a line.

    Parameters
    ----------
    branches : pd.DataFrame
        Table `branches` of stage branches: a row for each point and mesh, with branch, period (mesh
        periods), stable, arc, speed_rpm and deflection_ac_rms_um.
    special : pd.DataFrame
        Table `special` of stage branches: branch, kind, arc and speed_rpm of folds and bifurcations.
    sweep : pd.DataFrame
        Table `sweep` of stage dynamics_sweep.
    meshes : Sequence[str]
        Names of the meshes.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Figure
        A panel for each mesh: RMS, µm, over speed, rpm.
    """
    low, high = branches["speed_rpm"].min(), branches["speed_rpm"].max()
    sweep = sweep[sweep["speed_rpm"].between(low, high)]
    speed = Axis("Pinion speed", "rpm", low=low - 0.02 * (high - low), high=high + 0.02 * (high - low))
    panels = []
    for mesh in meshes:
        marks: list[Curve | Line] = []
        for direction, (marker, colour) in SWEEPS.items():
            curve = select(sweep, direction, "deflection_ac_rms_um", mesh)
            if len(curve):
                look: Look = {"line": "none", "marker": marker, "size": 4.0}
                marks.append(Curve(curve["speed_rpm"], curve["value"], f"sweep {direction}", colour, **look))
        rows = branches[branches["mesh"] == mesh]
        for number, branch in rows.groupby("branch"):
            marks += _parts(branch)
            marks += _points(branch, special[special["branch"] == number])
        marks.append(Line(speed_rpm, name="nominal speed", line="dot"))
        panels.append(Panel(speed, rms_axis(), marks, title=f"mesh {mesh}", height=2.0))
    title = "All periodic motions found: RMS of mesh deflections without their mean"
    return Figure(panels, title=title, width=7.5, keys=list(_keys(branches)))


def _parts(branch: pd.DataFrame) -> Iterator[Curve]:
    """Yield a branch of one mesh as curves of RMS (µm) over speed (rpm), cut where its stability
    changes: solid between two stable points, dashed elsewhere. The colour tells the period.

    branch: rows of table `branches` in the order of their arc.
    """
    colour = _colour(int(branch["period"].iloc[0]))
    speed, value = branch["speed_rpm"].to_numpy(), branch["deflection_ac_rms_um"].to_numpy()
    stable = branch["stable"].to_numpy(dtype=bool)
    stable_pairs = stable[:-1] & stable[1:]
    cuts = np.flatnonzero(np.diff(stable_pairs.astype(int))) + 1
    for first, last in pairwise([0, *cuts.tolist(), stable_pairs.size]):
        solid = bool(stable_pairs[first]) if first < stable_pairs.size else False
        part = slice(first, last + 1)
        look: Look = {"line": "solid", "width": 1.6} if solid else {"line": "dash", "width": 0.9}
        yield Curve(speed[part], value[part], colour=colour, **look)


def _points(branch: pd.DataFrame, special: pd.DataFrame) -> Iterator[Curve]:
    """Yield hollow marks at the special points of a branch, one curve for each kind; their height is
    interpolated in the branch's RMS (µm) over arc length. `special`: rows of table `special` on this
    branch.
    """
    for kind, marker in MARKERS.items():
        rows = special[special["kind"] == kind]
        if len(rows):
            height = np.interp(rows["arc"], branch["arc"], branch["deflection_ac_rms_um"])
            yield Curve(rows["speed_rpm"], height, kind, line="none", marker=marker, hollow=True)


def _colour(period: int) -> str:
    """Return the colour of a motion by its period in mesh periods: one each for LABELLED_PERIODS, one
    for all others.
    """
    return PERIOD_COLOURS[
        LABELLED_PERIODS.index(period) if period in LABELLED_PERIODS else len(LABELLED_PERIODS)
    ]


def _keys(branches: pd.DataFrame) -> Iterator[Key]:
    """Yield the entries of the legend: one for each period that occurs in table `branches`, then stable
    and, if there are any, unstable lines.
    """
    for name, colour in dict.fromkeys(_motion(f"period-{period}") for period in _by_size(branches["period"])):
        yield Key(name, colour, width=1.6)
    yield Key("stable", grey(0.3), width=1.6)
    if not branches["stable"].astype(bool).all():
        yield Key("unstable", grey(0.3), "dash", width=0.9)


def _by_size(periods: pd.Series) -> list[int]:
    """Return the different periods (mesh periods) in rising order, LABELLED_PERIODS before all others."""
    return sorted(periods.unique(), key=lambda period: (period not in LABELLED_PERIODS, period))


def loci(table: pd.DataFrame, speed_rpm: float) -> Figure:
    """Draw folds and period doublings in the plane of speed and each second parameter, and the operating
    point.

    Parameters
    ----------
    table : pd.DataFrame
        Table `loci` of stage branches_loci: locus, kind, parameter, speed_rpm, factor (parameter over its
        nominal value) and corner (`cusp` for a cusp, else empty).
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Figure
        A panel for each second parameter.
    """
    panels = []
    for parameter in list(dict.fromkeys(table["parameter"])) or ["torque"]:
        rows = table[table["parameter"] == parameter]
        corner = rows["corner"].fillna("")
        marks = []
        for _, locus in rows[corner == ""].groupby("locus"):
            kind = locus["kind"].iloc[0]
            colour, line = LOCI[kind]
            marks.append(Curve(locus["speed_rpm"], locus["factor"], kind, colour, line, width=1.4))
        cusps = rows[corner == "cusp"]
        if len(cusps):
            look: Look = {"line": "none", "marker": "circle", "size": 5.0, "hollow": True}
            marks.append(Curve(cusps["speed_rpm"], cusps["factor"], "cusp", **look))
        point = np.array([speed_rpm]), np.array([1.0])
        marks.append(Curve(*point, "operating point", line="none", marker="star", size=12.0))
        up = Axis(f"{parameter.replace('_', ' ').capitalize()} over nominal", "")
        panels.append(Panel(Axis("Pinion speed", "rpm"), up, marks, height=2.8))
    return Figure(panels, title="Where motions end or double their period", width=7.0)


def fractions(table: pd.DataFrame) -> Figure:
    """Draw the share of random starts that ends on each motion, a stacked bar for each speed with standard
    errors.

    Colours tell the period as in amplitudes(), numbers the branch.

    Parameters
    ----------
    table : pd.DataFrame
        Table `coexistence` of stage branches: speed_rpm, motion, branch, fraction of the starts and its
        standard error.

    Returns
    -------
    Figure
        The figure.
    """
    speeds = sorted(table["speed_rpm"].unique())
    bars = []
    for position, speed in enumerate(speeds):
        bottom = 0.0
        for row in table[table["speed_rpm"] == speed].itertuples():
            name, colour = _motion(str(row.motion))
            top = bottom + row.fraction
            has_number = str(row.branch).isdigit() and row.fraction > MIN_FRACTION_SHOWN
            is_inner = 0.0 < row.fraction < 1.0 and top < 1.0 - 1e-9
            ends: Look = (
                {"low": _array_of(top - row.error), "high": _array_of(top + row.error)} if is_inner else {}
            )
            labels = (str(row.branch),) if has_number else ()
            look: Look = {"width": 0.7, "base": _array_of(bottom), "labels": labels, **ends}
            bars.append(Bars(_array_of(position), _array_of(row.fraction), name, colour, **look))
            bottom = top
    panel = Panel(
        Axis("Pinion speed", "rpm", ticks=[(float(at), f"{speed:g}") for at, speed in enumerate(speeds)]),
        Axis("Fraction of random starts", "", low=0.0, high=1.02),
        bars,
        height=2.8,
    )
    title = "Which motion the machine is likely to be on; number: branch, bar: standard error"
    return Figure([panel], title=title, width=7.0)


def _array_of(value: float) -> Array:
    """Return a number as an array of shape (1,)."""
    return np.array([float(value)])


def _motion(label: str) -> tuple[str, str]:
    """Return legend name and colour of a class of motion, such as `period-2` (mesh periods); all
    classes that do not begin with `period-` are `not periodic`.
    """
    if not label.startswith("period-"):
        return "not periodic", IRREGULAR
    period = int(label.removeprefix("period-"))
    if period in LABELLED_PERIODS:
        return f"period {period}", _colour(period)
    return "other periods", _colour(period)


def multipliers(table: pd.DataFrame, branch: int = 0) -> Figure:
    """Draw the largest Floquet multipliers of a branch in the complex plane, coloured by speed.

    Parameters
    ----------
    table : pd.DataFrame
        Table `multipliers` of stage branches: branch, speed_rpm, real and imaginary part of a multiplier.
    branch : int
        Number of the branch.

    Returns
    -------
    Figure
        One panel with the unit circle; it ends at a real part of at most 2.1 in magnitude.
    """
    rows = table[table["branch"] == branch]
    reach = 1.05 * float(np.clip(rows[["real", "imaginary"]].abs().to_numpy().max(), 1.0, 2.0))
    speeds = rows["speed_rpm"].to_numpy(float)
    scale = ColourScale("Pinion speed", "rpm", float(speeds.min()), float(speeds.max()))
    marks: list[Curve | Scatter] = [
        Curve(np.cos(UNIT_CIRCLE), np.sin(UNIT_CIRCLE), colour=BLACK, width=0.9),
        Scatter(rows["real"], rows["imaginary"], np.full(len(rows), 2.2), values=speeds, scale=scale),
    ]
    high = min(reach, 1.3)
    panel = Panel(
        Axis("Real part", "", low=-reach, high=reach),
        Axis("Imaginary part", "", low=-high, high=high),
        marks,
        equal=True,
        height=4.0,
    )
    title = f"Floquet multipliers along branch {branch}; outside the circle: unstable"
    return Figure([panel], title=title, width=6.0)


def figures(
    branches: pd.DataFrame,
    special: pd.DataFrame,
    circle: pd.DataFrame,
    coexistence: pd.DataFrame,
    curves: pd.DataFrame,
    sweep: pd.DataFrame,
    speed_rpm: float,
    pinions: Sequence[Mapping[str, Any]],
) -> tuple[Figure, ...]:
    """Draw amplitudes over speed, loci (`curves`), fractions of random starts and multipliers (`circle`).

    Parameters
    ----------
    branches : pd.DataFrame
        Table `branches` of stage branches.
    special : pd.DataFrame
        Table `special` of stage branches.
    circle : pd.DataFrame
        Table `multipliers` of stage branches.
    coexistence : pd.DataFrame
        Table `coexistence` of stage branches.
    curves : pd.DataFrame
        Table `loci` of stage branches_loci.
    sweep : pd.DataFrame
        Table `sweep` of stage dynamics_sweep.
    speed_rpm : float
        Nominal speed of the pinions, rpm.
    pinions : Sequence[Mapping[str, Any]]
        Pinions as in the config.

    Returns
    -------
    tuple[Figure, ...]
        Amplitudes, loci, fractions and multipliers of branch 0, as their functions draw them.
    """
    meshes = typical_meshes(pinions, branches["mesh"])
    return (
        amplitudes(branches, special, sweep, meshes, speed_rpm),
        loci(curves, speed_rpm),
        fractions(coexistence),
        multipliers(circle),
    )
