"""Figures of the branches of periodic motions."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from facegear.plots.style import styled
from facegear.plots.sweep import select

PERIOD_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
"""Okabe and Ito's colours, which the colour-blind can distinguish; of period 1, 2, 4 and any other."""
NAMED = (1, 2, 4)
MARKERS = {
    "fold": ("^", "black"),
    "period doubling": ("s", "black"),
    "Neimark-Sacker": ("D", "black"),
    "branch point": ("o", "black"),
}
SWEEPS = {"up": ("1", "0.45"), "down": ("2", "0.7")}
IRREGULAR = "0.55"
SHOWN = 0.06
"""Smallest fraction of a bar that has room for its number."""


def typical_meshes(pinions: Sequence[Mapping[str, Any]], meshes: Iterable[str]) -> list[str]:
    """The first mesh of the first pinion of each role; pinions as in the config, meshes `pinion/side`."""
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
    """RMS without mean of mesh deflections over speed, a panel for each mesh: stable parts solid, unstable
    dashed, special points marked, points of the sweep beneath; the operating speed as a line.
    """
    low, high = branches["speed_rpm"].min(), branches["speed_rpm"].max()
    sweep = sweep[sweep["speed_rpm"].between(low, high)]
    with styled():
        figure, axes = plt.subplots(
            len(meshes), 1, figsize=(7.5, 2.6 * len(meshes) + 0.8), sharex=True, squeeze=False
        )
        for axis, mesh in zip(axes[:, 0], meshes, strict=True):
            for direction, (marker, colour) in SWEEPS.items():
                curve = select(sweep, direction, "deflection_ac_rms_um", mesh)
                axis.plot(curve["speed_rpm"], curve["value"], marker, ms=4, color=colour, zorder=1)
            rows = branches[branches["mesh"] == mesh]
            for number, branch in rows.groupby("branch"):
                _line(axis, branch)
                _points(axis, branch, special[special["branch"] == number])
            axis.axvline(speed_rpm, color="0.5", lw=0.8, ls=":")
            axis.set_title(f"mesh {mesh}", fontsize=9)
            axis.set_ylabel("RMS of d (µm)")
            axis.set_ylim(bottom=0)
            axis.set_xlim(low - 0.02 * (high - low), high + 0.02 * (high - low))
        axes[-1, 0].set_xlabel("pinion speed (rpm)")
        figure.legend(
            handles=_keys(branches, special), loc="outside lower center", ncols=4, fontsize=8, frameon=False
        )
        figure.suptitle("All periodic motions found: RMS of mesh deflections without their mean")
    return figure


def _line(axis: Axes, branch: pd.DataFrame) -> None:
    colour = _colour(int(branch["period"].iloc[0]))
    speed, value = branch["speed_rpm"].to_numpy(), branch["deflection_ac_rms_um"].to_numpy()
    stable = branch["stable"].to_numpy(dtype=bool)
    both = stable[:-1] & stable[1:]
    cuts = np.flatnonzero(np.diff(both.astype(int))) + 1
    for first, last in pairwise([0, *cuts.tolist(), both.size]):
        solid = bool(both[first]) if first < both.size else False
        part = slice(first, last + 1)
        style = {"ls": "-", "lw": 1.6} if solid else {"ls": (0, (4, 2)), "lw": 0.9}
        axis.plot(speed[part], value[part], color=colour, zorder=3 if solid else 2, **style)


def _points(axis: Axes, branch: pd.DataFrame, special: pd.DataFrame) -> None:
    for kind, (marker, colour) in MARKERS.items():
        rows = special[special["kind"] == kind]
        height = np.interp(rows["arc"], branch["arc"], branch["deflection_ac_rms_um"])
        axis.plot(rows["speed_rpm"], height, marker, ms=4.5, mfc="white", mec=colour, mew=0.9, zorder=4)


def _colour(period: int) -> str:
    return PERIOD_COLOURS[NAMED.index(period) if period in NAMED else len(NAMED)]


def _keys(branches: pd.DataFrame, special: pd.DataFrame) -> list[Line2D]:
    keys = [
        Line2D([], [], color=colour, lw=1.6, label=name)
        for name, colour in dict.fromkeys(
            _motion(f"period-{period}") for period in _by_size(branches["period"])
        )
    ]
    keys += [
        Line2D([], [], color="0.3", lw=1.6, label="stable"),
        Line2D([], [], color="0.3", lw=0.9, ls=(0, (4, 2)), label="unstable"),
    ]
    keys += [
        Line2D([], [], ls="", marker=marker, mfc="white", mec=colour, label=kind)
        for kind, (marker, colour) in MARKERS.items()
        if (special["kind"] == kind).any()
    ]
    keys += [
        Line2D([], [], ls="", marker=marker, color=colour, label=f"sweep {direction}")
        for direction, (marker, colour) in SWEEPS.items()
    ]
    return [*keys, Line2D([], [], color="0.5", lw=0.8, ls=":", label="nominal speed")]


def _by_size(periods: pd.Series) -> list[int]:
    """Periods with a colour of their own first."""
    return sorted(periods.unique(), key=lambda period: (period not in NAMED, period))


def loci(table: pd.DataFrame, speed_rpm: float) -> Figure:
    """Folds and period doublings in the plane of speed and each second parameter; the operating point."""
    parameters = list(dict.fromkeys(table["parameter"])) or ["torque"]
    styles = {"fold": ("#0072B2", "-"), "period doubling": ("#D55E00", "--")}
    with styled():
        figure, axes = plt.subplots(
            len(parameters), 1, figsize=(7, 3.6 * len(parameters)), squeeze=False, sharex=True
        )
        for axis, parameter in zip(axes[:, 0], parameters, strict=True):
            rows = table[table["parameter"] == parameter]
            corner = rows["corner"].fillna("")
            for _, locus in rows[corner == ""].groupby("locus"):
                colour, line = styles[locus["kind"].iloc[0]]
                axis.plot(locus["speed_rpm"], locus["factor"], line, color=colour, lw=1.4)
            cusps = rows[corner == "cusp"]
            axis.plot(cusps["speed_rpm"], cusps["factor"], "o", ms=5, mfc="white", mec="black")
            axis.plot([speed_rpm], [1.0], "*", ms=12, color="black")
            axis.set_ylabel(f"{parameter.replace('_', ' ')} over nominal")
        axes[-1, 0].set_xlabel("pinion speed (rpm)")
        keys = [Line2D([], [], color=c, ls=line, label=kind) for kind, (c, line) in styles.items()]
        keys += [
            Line2D([], [], ls="", marker="o", mfc="white", mec="black", label="cusp"),
            Line2D([], [], ls="", marker="*", ms=10, color="black", label="operating point"),
        ]
        figure.legend(handles=keys, loc="outside lower center", ncols=4, fontsize=8, frameon=False)
        figure.suptitle("Where motions end or double their period")
    return figure


def fractions(table: pd.DataFrame) -> Figure:
    """Share of random starts that ends on each motion, a stacked bar for each speed with standard errors.

    Colours tell the period as in amplitudes(), numbers the branch.
    """
    speeds = sorted(table["speed_rpm"].unique())
    used: dict[str, str] = {}
    with styled():
        figure, axis = plt.subplots(figsize=(7, 4))
        for bar, speed in enumerate(speeds):
            bottom = 0.0
            for row in table[table["speed_rpm"] == speed].itertuples():
                name, colour = _motion(str(row.motion))
                used[name] = colour
                axis.bar(bar, row.fraction, 0.7, bottom=bottom, color=colour, edgecolor="white")
                if str(row.branch).isdigit() and row.fraction > SHOWN:
                    middle = bottom + 0.5 * row.fraction
                    axis.text(bar, middle, row.branch, ha="center", va="center", color="white", fontsize=8)
                bottom += row.fraction
                if 0.0 < row.fraction < 1.0 and bottom < 1.0 - 1e-9:
                    axis.errorbar(bar, bottom, row.error, color="black", capsize=3, lw=0.8)
        axis.set_xticks(range(len(speeds)), [f"{speed:g}" for speed in speeds])
        axis.set_xlabel("pinion speed (rpm)")
        axis.set_ylabel("fraction of random starts")
        axis.set_ylim(0, 1.02)
        axis.grid(False, axis="x")
        keys = [plt.Rectangle((0, 0), 1, 1, color=used[name], label=name) for name in sorted(used)]
        figure.legend(handles=keys, loc="outside lower center", ncols=4, fontsize=8, frameon=False)
        figure.suptitle("Which motion the machine is likely to be on; number: branch, bar: standard error")
    return figure


def _motion(label: str) -> tuple[str, str]:
    """Name and colour of a class of motion."""
    if not label.startswith("period-"):
        return "not periodic", IRREGULAR
    period = int(label.removeprefix("period-"))
    if period in NAMED:
        return f"period {period}", _colour(period)
    return "other periods", _colour(period)


def multipliers(table: pd.DataFrame, branch: int = 0) -> Figure:
    """The largest Floquet multipliers of a branch in the complex plane, coloured by speed."""
    rows = table[table["branch"] == branch]
    angle = np.linspace(0.0, 2.0 * np.pi, 361)
    with styled():
        figure, axis = plt.subplots(figsize=(6, 5.2))
        axis.plot(np.cos(angle), np.sin(angle), color="black", lw=0.9)
        drawn = axis.scatter(
            rows["real"], rows["imaginary"], c=rows["speed_rpm"], s=5, cmap="viridis", linewidths=0
        )
        axis.set_aspect("equal")
        reach = 1.05 * float(np.clip(rows[["real", "imaginary"]].abs().to_numpy().max(), 1.0, 2.0))
        axis.set_xlim(-reach, reach)
        axis.set_ylim(-min(reach, 1.3), min(reach, 1.3))
        axis.set_xlabel("real part")
        axis.set_ylabel("imaginary part")
        figure.colorbar(drawn, ax=axis, label="pinion speed (rpm)", shrink=0.8)
        figure.suptitle(f"Floquet multipliers along branch {branch}; outside the circle: unstable")
    return figure


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
    """Amplitudes over speed, loci (`curves`), fractions of random starts, multipliers (`circle`)."""
    meshes = typical_meshes(pinions, branches["mesh"])
    return (
        amplitudes(branches, special, sweep, meshes, speed_rpm),
        loci(curves, speed_rpm),
        fractions(coexistence),
        multipliers(circle),
    )
