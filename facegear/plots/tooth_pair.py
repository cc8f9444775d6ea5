"""Pictures of the tooth pair: in mesh, both sections with limits, separation with the contact path."""

from collections.abc import Mapping
from math import pi
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, LightSource, to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from facegear.arrays import Array
from facegear.plots.style import NARROW, styled

PINION_COLOUR, GEAR_COLOUR = "#c98a3d", "#5b7fa6"
LABEL_GAP = 0.1
"""Least distance of two radius labels, in whole depths of the tooth."""


def tooth_pair(record: Mapping[str, Any], flanks: Mapping[str, Array]) -> Figure:
    """Pinion and gear in mesh, from `geometry/pair.json` and `flanks.npz`."""
    with styled():
        figure = plt.figure(figsize=(NARROW, 4.0))
        _in_mesh(figure.add_subplot(projection="3d"), record, flanks)
    return figure


def tooth_sections(record: Mapping[str, Any], flanks: Mapping[str, Array]) -> Figure:
    """Sections of both teeth with limits and radii, from `geometry/pair.json` and `flanks.npz`."""
    with styled():
        figure, (pinion, gear) = plt.subplots(2, 1, figsize=(NARROW, 7.6))
        _pinion_section(pinion, record, flanks)
        _gear_sections(gear, record, flanks)
    return figure


def separation(
    record: Mapping[str, Any], flanks: Mapping[str, Array], contact: Mapping[str, Array]
) -> Figure:
    """Gap of the unloaded pair over the gear's flank, with the contact path, from all of `geometry/`."""
    with styled():
        figure, axes = plt.subplots(figsize=(NARROW, 4.2))
        _contours(axes, record, flanks, contact)
    return figure


def _in_mesh(axes: Axes, record: Mapping[str, Any], flanks: Mapping[str, Array]) -> None:
    design = record["design_si"]
    pinion_teeth, gear_teeth = design["pinion"]["teeth"], design["face_gear"]["teeth"]
    pinion = np.concatenate([_quads(grid) for grid in _pinion_skin(flanks, design["pinion"]["bore_radius"])])
    gear = np.concatenate([_quads(grid) for grid in _gear_skin(flanks, gear_teeth)])
    parts = [
        _turned_pinion(pinion, (tooth - 0.5) * 2 * pi / pinion_teeth) for tooth in range(pinion_teeth)
    ] + [_turned_gear(gear, tooth * 2 * pi / gear_teeth) for tooth in range(-6, 7)]
    names = [PINION_COLOUR] * pinion_teeth + [GEAR_COLOUR] * 13
    faces = np.concatenate(parts) * 1e3
    colours = np.concatenate(
        [np.tile(to_rgb(name), (len(part), 1)) for name, part in zip(names, parts, strict=True)]
    )
    normals = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    area = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, area, where=area > 0, out=np.zeros_like(normals))
    brightness = 0.4 + 0.6 * np.abs(normals @ LightSource(azdeg=300, altdeg=50).direction)
    shaded = colours * brightness[:, None]
    look = {"facecolors": shaded, "edgecolors": shaded, "linewidths": 0.2, "rasterized": True}
    axes.add_collection3d(Poly3DCollection(faces, **look))
    low, high = faces.min(axis=(0, 1)), faces.max(axis=(0, 1))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=1.0)
    axes.view_init(elev=22, azim=-62)
    axes.set(xlabel="x (mm)", ylabel="y (mm)", zlabel="z (mm)", title="Pinion and face gear in mesh")
    axes.yaxis.set_major_locator(MaxNLocator(2))
    axes.tick_params(labelsize=9)


def _pinion_skin(flanks: Mapping[str, Array], bore: float) -> list[Array]:
    """Grids (profile, 2, 3) of one tooth from space to space: its surface and the end that is looked at."""
    half = flanks["pinion_section"][::8]
    section = np.concatenate([half[::-1], half * [-1, 1]])
    first, last = flanks["pinion_flank"][0, [0, -1], 1]
    outer = np.insert(section * [1, -1], 1, first, axis=1)
    inner = np.insert(
        bore * section / np.linalg.norm(section, axis=1, keepdims=True) * [1, -1], 1, first, axis=1
    )
    return [np.stack([outer, outer + [0, last - first, 0]], axis=1), np.stack([outer, inner], axis=1)]


def _gear_skin(flanks: Mapping[str, Array], teeth: int) -> list[Array]:
    """Grids (profile, width, 3) of one tooth from space to space: its surface and its inner end."""
    right = np.concatenate([flanks["gear_flank"][::4, ::8], flanks["gear_fillet"][::4, ::8]])
    radius = np.hypot(right[0, :, 0], right[0, :, 1])
    middle = np.stack([radius * np.sin(pi / teeth), radius * np.cos(pi / teeth), right[-1, :, 2]], axis=-1)
    right = np.concatenate([right, middle[None]])
    surface = np.concatenate([right[::-1], right * [-1, 1, 1]])
    below = surface[:, 0].copy()
    below[:, 2] = 1.15 * surface[..., 2].min()
    return [surface, np.stack([surface[:, 0], below], axis=1)]


def _turned_pinion(points: Array, angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]).T


def _turned_gear(points: Array, angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]).T


def _quads(grid: Array) -> Array:
    return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(-1, 4, 3)


def _pinion_section(axes: Axes, record: Mapping[str, Any], flanks: Mapping[str, Array]) -> None:
    half = 1e3 * flanks["pinion_section"]
    tooth = np.concatenate([half[::-1], half * [-1, 1]])
    axes.fill(
        np.append(tooth[:, 0], [tooth[-1, 0], tooth[0, 0]]),
        np.append(tooth[:, 1], [half[:, 1].min() - 1.5] * 2),
        color=PINION_COLOUR,
        alpha=0.35,
    )
    axes.plot(tooth[:, 0], tooth[:, 1], color=PINION_COLOUR)
    reach = 1.2 * np.abs(tooth[:, 0]).max()
    x = np.linspace(-reach, reach, 101)
    styles = {
        "pinion_tip": "-",
        "pinion_pitch": "-.",
        "pinion_fillet_start": ":",
        "pinion_base": "--",
        "pinion_root": "-",
    }
    radii = {name: record["radii_mm"][name] for name in styles}
    apart = LABEL_GAP * (radii["pinion_tip"] - radii["pinion_root"])
    height = np.inf
    for name, radius in sorted(radii.items(), key=lambda item: -item[1]):
        axes.plot(x, np.sqrt(radius**2 - x**2), styles[name], color="0.4", lw=0.8)
        label = name.removeprefix("pinion_").replace("_", " ")
        height = min(np.sqrt(radius**2 - reach**2), height - apart)
        axes.annotate(f"{label} {radius:.3f}", (reach, height), fontsize=9, va="center")
    axes.set_aspect("equal")
    axes.set(xlabel="across (mm)", ylabel="radius (mm)", title="Pinion tooth", xlim=(-reach, 1.75 * reach))


def path_text(record: Mapping[str, Any]) -> str:
    """Where the contact path lies along the face, and the nominal place where errors of assembly move it."""
    path = np.asarray(record["unloaded"]["drive"]["path_pinion_y_mm"], dtype=float)
    nominal = float(record["radii_mm"]["gear_contact_path_nominal"])
    text = f"contact path at {path.mean():.3f} mm"
    return text if np.abs(path - nominal).max() < 0.005 else f"{text}, nominal {nominal:.3f} mm"


def _gear_sections(axes: Axes, record: Mapping[str, Any], flanks: Mapping[str, Array]) -> None:
    right = 1e3 * np.concatenate([flanks["gear_flank"], flanks["gear_fillet"][1:]])
    width = right.shape[1]
    radius = np.hypot(right[0, :, 0], right[0, :, 1])
    for column, style in ((0, "-"), (width // 2, "--"), (width - 1, ":")):
        arc = radius[column] * np.arctan2(right[:, column, 0], right[:, column, 1])
        across = np.concatenate([-arc[::-1], arc])
        height = np.concatenate([right[::-1, column, 2], right[:, column, 2]])
        axes.plot(across, height, style, color=GEAR_COLOUR, label=f"{radius[column]:.1f}")
    limits, radii = record["limits_mm"], record["radii_mm"]
    text = (
        f"undercut below {limits['inner_undercut']:.3f} mm\nface {radii['gear_inner']:.1f} to "
        f"{radii['gear_outer']:.1f} mm\npointed above {limits['outer_pointing']:.3f} mm\n"
        f"{path_text(record)}"
    )
    axes.margins(y=0.12)
    axes.set_aspect("equal")
    axes.set_xlim(right=1.55 * across.max())
    axes.legend(loc="upper right", title="gear radius\n(mm)")
    axes.set(xlabel=f"arc (mm)\n{text}", ylabel="z (mm)", title="Face gear tooth")


def _contours(
    axes: Axes, record: Mapping[str, Any], flanks: Mapping[str, Array], contact: Mapping[str, Array]
) -> None:
    facing = contact["contour_facing"].astype(bool)
    gap = np.ma.masked_where(~facing, 1e6 * contact["contour_gap"])
    # places outside the flank are masked, yet a contour plot wants coordinates everywhere
    radius = np.where(facing, 1e3 * contact["contour_radius"], 1e3 * contact["contour_y"])
    height = np.where(facing, 1e3 * contact["contour_height"], np.nan)
    height = np.where(np.isnan(height), np.nanmean(height), height)
    levels = [0, 0.1, 0.3, 1, 2, 5, 10, 20, 30, 40, 60, 80, 120, 200]
    levels = [level for level in levels if level <= gap.max()] + [float(np.ceil(gap.max() + 1e-9))]
    colours = BoundaryNorm(levels, plt.get_cmap("viridis_r").N)
    filled = axes.contourf(radius, height, gap, levels=levels, norm=colours, cmap="viridis_r", extend="min")
    axes.figure.colorbar(filled, ax=axes, label="separation (um)", ticks=levels)
    top, flank = 1e3 * flanks["gear_flank"][0], 1e3 * flanks["gear_flank"][-1]
    for line, label, point, points in (
        (top, "tip edge", -1, 2),
        (flank, "end of the flank", len(flank) // 2, -3),
    ):
        out, side = np.hypot(line[:, 0], line[:, 1]), "bottom" if points > 0 else "top"
        axes.plot(out, line[:, 2], color="0.2", lw=0.8)
        options = {"xytext": (0, points), "textcoords": "offset points", "va": side, "ha": "right"}
        axes.annotate(label, (out[point], line[point, 2]), fontsize=9, **options)
    path_radius = np.interp(contact["path_roll"], contact["contour_roll"][:, 0], np.arange(len(radius)))
    rows = np.clip(np.round(path_radius).astype(int), 0, len(radius) - 1)
    axes.plot(1e3 * contact["path_y"], height[rows, height.shape[1] // 2], "r.", ms=4, label="contact path")
    gap_record = record["smallest_gap"]
    axes.set(
        xlabel="gear radius (mm)",
        ylabel="z (mm)",
        title=f"Drive flank of the gear; smallest gap elsewhere\n{gap_record['gap_um']:.1f} um at "
        f"{gap_record['gear_radius_mm']:.1f} mm (gear {gap_record['gear_part']},\n"
        f"pinion {gap_record['pinion_part']})",
    )
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.16), borderaxespad=0.0)


def figures(
    pair: Mapping[str, Any], flanks: Mapping[str, Array], contact: Mapping[str, Array]
) -> tuple[Figure, ...]:
    """Both gears in mesh, sections of both teeth, separation around the contact path."""
    return tooth_pair(pair, flanks), tooth_sections(pair, flanks), separation(pair, flanks, contact)
