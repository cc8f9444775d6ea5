"""Shafts of pinions in side view, and how they deflect under the mean torques."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from facegear.arrays import Array
from facegear.config.machine_layout import ToothNumbers
from facegear.config.shafts import ShaftSection
from facegear.config.transmission import Transmission
from facegear.plots.style import NARROW, styled

SHAFT, BORE, PINION = "0.75", "white", "#E69F00"
CURVES = {
    "x": ("tangential to the gear (x)", "#0072B2", "-"),
    "y": ("along the gear's axis (y)", "#D55E00", "--"),
}
PAPER = {"facecolor": "white", "edgecolor": "none", "pad": 0.5}
MARGIN = 0.06
"""Room beside a shaft, in its length."""


def figures(
    bearings: pd.DataFrame,
    deflections: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
    width_mm: float | None,
) -> list[Figure]:
    """One figure with a pair of panels for each shaft; none without shafts. `width_mm`: of the pinions."""
    sections = {pinion.name: transmission.shaft_of(pinion) for pinion in transmission.pinions}
    drawn = {name: section for name, section in sections.items() if section is not None}
    if not drawn:
        return []
    radius = 1e3 * teeth.pinion_base_radius / np.cos(teeth.pressure_angle)
    return [shafts_figure(drawn, bearings, deflections, float(radius), width_mm)]


def shafts_figure(
    sections: Mapping[str, ShaftSection],
    bearings: pd.DataFrame,
    deflections: pd.DataFrame,
    radius_mm: float,
    width_mm: float | None,
) -> Figure:
    """Above: a shaft with its bearings and the forces on them; below: its deflections. Shafts alike in all
    of that share a pair of panels.
    """
    groups = _alike(sections, bearings, deflections)
    with styled():
        figure, axes = plt.subplots(
            2 * len(groups),
            1,
            figsize=(NARROW, 0.9 + 3.2 * len(groups)),
            height_ratios=[1.3, 1.0] * len(groups),
        )
        for number, names in enumerate(groups):
            side, below = axes[2 * number], axes[2 * number + 1]
            section = sections[names[0]]
            _side_view(side, section, bearings[bearings["pinion"] == names[0]], radius_mm, width_mm)
            side.set_title(", ".join(names), loc="left")
            own = deflections[deflections["pinion"] == names[0]]
            for key, (words, colour, line) in CURVES.items():
                below.plot(own["at_mm"], own[f"{key}_um"], line, color=colour, label=words)
            below.set_ylabel("Deflection (µm)")
            room = MARGIN * section.length_mm + 0.5 * (width_mm or 0.0)
            for axis in (side, below):
                for at in (section.pinion_mm, *(bearing.at_mm for bearing in section.bearings)):
                    axis.axvline(at, color="0.6", lw=0.8, ls=":", zorder=0)
                axis.set_xlim(-room, section.length_mm + room)
        axes[-1].set_xlabel("Along the shaft, from its inner end outwards (mm)")
        handles, labels = axes[1].get_legend_handles_labels()
        handles += [Patch(color=PINION, alpha=0.7), Line2D([], [], ls="none", marker="^", color="k")]
        figure.legend(
            handles,
            [*labels, "pinion", "bearing and radial force on it"],
            loc="outside lower center",
            ncols=2,
        )
    return figure


def _alike(
    sections: Mapping[str, ShaftSection], bearings: pd.DataFrame, deflections: pd.DataFrame
) -> list[list[str]]:
    """Names of pinions with equal shafts that carry and deflect alike."""
    groups: list[tuple[ShaftSection, Array, list[str]]] = []
    for name, section in sections.items():
        forces = bearings.loc[bearings["pinion"] == name, "radial_n"].to_numpy(dtype=float)
        moved = deflections.loc[deflections["pinion"] == name, ["x_um", "y_um"]].to_numpy(dtype=float)
        numbers = np.concatenate([forces, moved.ravel()])
        for other, known, names in groups:
            if other == section and np.allclose(numbers, known, rtol=1e-4, atol=1e-3):
                names.append(name)
                break
        else:
            groups.append((section, numbers, [name]))
    return [names for *_, names in groups]


def _side_view(
    axis: Axes,
    section: ShaftSection,
    bearings: pd.DataFrame,
    radius_mm: float,
    width_mm: float | None,
) -> None:
    begin = 0.0
    for segment in section.segments:
        for diameter, colour in ((segment.diameter_mm, SHAFT), (segment.bore_mm, BORE)):
            if diameter > 0.0:
                corner = (begin, -0.5 * diameter)
                axis.add_patch(
                    Rectangle(corner, segment.length_mm, diameter, facecolor=colour, edgecolor="0.3", lw=0.7)
                )
        begin += segment.length_mm
    width = width_mm or 0.0
    look = {"facecolor": PINION, "edgecolor": PINION, "alpha": 0.7, "lw": 2.0}
    axis.add_patch(Rectangle((section.pinion_mm - 0.5 * width, -radius_mm), width, 2.0 * radius_mm, **look))
    outer = max(segment.diameter_mm for segment in section.segments) / 2.0
    forces = bearings.set_index("bearing")["radial_n"]
    for letter, bearing in zip(forces.index, section.bearings, strict=True):
        half = 0.5 * _diameter_at(section, bearing.at_mm)
        axis.plot(bearing.at_mm, -half, "^", color="k", ms=9, clip_on=False)
        axis.plot(bearing.at_mm, half, "v", color="k", ms=9, clip_on=False)
        text = f"{letter}\n{1e-3 * forces[letter]:.2f} kN"
        look = {"textcoords": "offset points", "ha": "center", "va": "top", "bbox": PAPER}
        axis.annotate(text, (bearing.at_mm, -half), (0, -12), **look)
    reach = max(outer, radius_mm)
    axis.set_ylim(-1.1 * reach, 1.1 * reach)
    axis.set_axis_off()


def _diameter_at(section: ShaftSection, at: float) -> float:
    """Diameter (mm) at a distance from the beginning: the larger one at a step."""
    ends = np.cumsum([0.0, *(segment.length_mm for segment in section.segments)])
    there = [
        segment.diameter_mm
        for segment, begin, end in zip(section.segments, ends[:-1], ends[1:], strict=True)
        if begin <= at <= end
    ]
    return max(there or [section.segments[-1].diameter_mm])
