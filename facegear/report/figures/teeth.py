"""Figures of the tooth pair: in mesh, sections, separation, flank charts, single teeth."""

from collections.abc import Mapping
from math import pi
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays
from facegear.number_format import format_number
from facegear.report.data_sheet import has_spur_teeth
from facegear.report.figures.colours import BLACK, BLUE, RED, channels, grey
from facegear.report.figures.description import Axis, Figure, Panel, apart
from facegear.report.figures.marks import Area, Bars, ColourScale, Curve, Levels, LineStyle, Look, Solid, Text
from facegear.report.figures.tooth_skins import (
    coast_array,
    gear_skin,
    pinion_skin,
    place_pinion,
    spur_gear_skin,
    spur_pinion_skin,
    turned_gear,
    turned_pinion,
)

PINION_COLOUR, GEAR_COLOUR = "#c98a3d", "#5b7fa6"
"""Colours of pinion and face gear, as in all drawings of teeth."""
AZIMUTH, ALTITUDE = np.radians([150.0, 50.0])
"""Direction of the light on the pair in mesh, rad."""
LIGHT = np.array([np.cos(AZIMUTH) * np.cos(ALTITUDE), np.sin(AZIMUTH) * np.cos(ALTITUDE), np.sin(ALTITUDE)])
"""Direction from which the pair in mesh is lit."""
LABEL_GAP = 0.1
"""Least distance of two radius labels, in whole depths of the tooth."""
GAPS = (0.0, 0.1, 0.3, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 40.0, 60.0, 80.0, 120.0, 200.0)
"""Levels of the separation, µm."""
RADII: Mapping[str, LineStyle] = {
    "pinion_tip": "solid",
    "pinion_pitch": "dashdot",
    "pinion_fillet_start": "dot",
    "pinion_base": "dash",
    "pinion_root": "solid",
}
"""Radii that the section of a pinion's tooth shows."""


def tooth_pair(record: Mapping[str, Any], flanks: Mapping[str, Array]) -> Figure:
    """Draw pinion and gear in mesh.

    Parameters
    ----------
    record : mapping
        Content of `geometry/pair.json`.
    flanks : mapping of (n, m, 3) arrays
        Arrays of `geometry/flanks.npz`, m.

    Returns
    -------
    Figure
        One panel in space, mm: all pinion teeth and 13 of the gear, lit from LIGHT.
    """
    design = record["design_si"]
    pinion_teeth, gear_teeth = design["pinion"]["teeth"], design["face_gear"]["teeth"]
    bore = design["pinion"]["bore_radius"]
    if has_spur_teeth(design):
        skins = spur_pinion_skin(flanks, bore), spur_gear_skin(flanks, gear_teeth)
    else:
        skins = pinion_skin(flanks, pinion_teeth, bore), gear_skin(flanks, gear_teeth)
    pinion, gear = (np.concatenate([_quads(grid) for grid in skin]) for skin in skins)
    parts = [
        place_pinion(turned_pinion(pinion, (tooth - 0.5) * 2 * pi / pinion_teeth), design)
        for tooth in range(pinion_teeth)
    ] + [turned_gear(gear, tooth * 2 * pi / gear_teeth) for tooth in range(-6, 7)]
    names = [PINION_COLOUR] * pinion_teeth + [GEAR_COLOUR] * 13
    faces = np.concatenate(parts) * 1e3
    colours = np.concatenate(
        [np.tile(channels(name), (len(part), 1)) for name, part in zip(names, parts, strict=True)]
    )
    normals = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    area = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, area, where=area > 0, out=np.zeros_like(normals))
    brightness = 0.4 + 0.6 * np.abs(normals @ LIGHT)
    low, high = faces.min(axis=(0, 1)), faces.max(axis=(0, 1))
    x, y, z = (
        Axis(letter, "mm", low=float(first), high=float(last))
        for letter, first, last in zip("xyz", low, high, strict=True)
    )
    solid = Solid(faces, colours * brightness[:, None])
    panel = Panel(x, y, [solid], z=z, equal=True, title="Pinion and face gear in mesh", height=3.1)
    return Figure([panel])


def tooth_sections(record: Mapping[str, Any], flanks: Mapping[str, Array]) -> Figure:
    """Draw sections of both teeth with limits and radii.

    Parameters
    ----------
    record : mapping
        Content of `geometry/pair.json`.
    flanks : mapping of (n, m, 3) arrays
        Arrays of `geometry/flanks.npz`, m.

    Returns
    -------
    Figure
        Two panels, mm: the pinion's section, and the gear's at three radii.
    """
    panels = [_pinion_section(record, flanks), _gear_sections(record, flanks)]
    return Figure(panels, shared_x=False, legend_title="face gear tooth at radius")


def _quads(grid: Array) -> Array:
    """Return the quadrilaterals (cells, 4, 3), corners in cyclic order, of a grid of points (n, m, 3)."""
    return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(-1, 4, 3)


def _pinion_section(record: Mapping[str, Any], flanks: Mapping[str, Array]) -> Panel:
    """Return the panel of a pinion tooth's section (mm, tip upwards) with arcs and labels of RADII."""
    half = 1e3 * flanks["pinion_section"]
    tooth = np.concatenate([half[::-1], 1e3 * coast_array(flanks, "pinion_section") * [-1, 1]])
    foot = half[:, 1].min() - 1.5
    body = np.append(tooth[:, 0], [tooth[-1, 0], tooth[0, 0]]), np.append(tooth[:, 1], [foot, foot])
    marks: list[Area | Curve | Text] = [
        Area(*body, colour=PINION_COLOUR, opacity=0.35),
        Curve(tooth[:, 0], tooth[:, 1], colour=PINION_COLOUR),
    ]
    reach = 1.2 * np.abs(tooth[:, 0]).max()
    x = np.linspace(-reach, reach, 101)
    radii = {name: record["radii_mm"][name] for name in RADII}
    apart = LABEL_GAP * (radii["pinion_tip"] - radii["pinion_root"])
    height = np.inf
    for name, radius in sorted(radii.items(), key=lambda item: -item[1]):
        marks.append(Curve(x, np.sqrt(radius**2 - x**2), colour=grey(0.4), line=RADII[name], width=0.8))
        label = name.removeprefix("pinion_").replace("_", " ")
        height = min(np.sqrt(radius**2 - reach**2), height - apart)
        marks.append(Text(reach, height, f"{label} {radius:.3f}"))
    across = Axis("Across", "mm", low=-reach, high=2.05 * reach)
    return Panel(across, Axis("Radius", "mm"), marks, title="Pinion tooth", equal=True, height=2.9)


def path_text(record: Mapping[str, Any]) -> str:
    """Give the mean radius of the contact path, and the nominal one if any point is 0.005 mm off it.

    Parameters
    ----------
    record : mapping
        Content of `geometry/pair.json`.

    Returns
    -------
    str
        The text, with radii from the gear's axis in mm.
    """
    path = np.asarray(record["unloaded"]["drive"]["path_pinion_y_mm"], dtype=float)
    nominal = float(record["radii_mm"]["gear_contact_path_nominal"])
    if not has_spur_teeth(record["design_si"]):
        first, last = f"{path.min():.3f}", f"{path.max():.3f}"
        part = f"at {first}" if first == last else f"from {first} to {last}"
        return f"contact path {part} mm along the pinion"
    text = f"contact path at {path.mean():.3f} mm"
    return text if np.abs(path - nominal).max() < 0.005 else f"{text}, nominal {nominal:.3f} mm"


def _gear_sections(record: Mapping[str, Any], flanks: Mapping[str, Array]) -> Panel:
    """Return the panel of a gear tooth's sections at three radii, z over arc length, mm, with limits."""
    left = 1e3 * np.concatenate([flanks["gear_flank"], flanks["gear_fillet"][1:]])
    coast = coast_array(flanks, "gear_flank"), coast_array(flanks, "gear_fillet")[1:]
    right = 1e3 * np.concatenate(coast)
    width = right.shape[1]
    radius = np.hypot(right[0, :, 0], right[0, :, 1])
    styles: tuple[tuple[int, LineStyle], ...] = ((0, "solid"), (width // 2, "dash"), (width - 1, "dot"))
    marks = []
    for column, line in styles:
        arcs = [radius[column] * np.arctan2(side[:, column, 0], side[:, column, 1]) for side in (left, right)]
        across = np.concatenate([-arcs[0][::-1], arcs[1]])
        height = np.concatenate([left[::-1, column, 2], right[:, column, 2]])
        name = f"{format_number(radius[column], 4)} mm"
        marks.append(Curve(across, height, name, GEAR_COLOUR, line))
    limits, radii = record["limits_mm"], record["radii_mm"]
    cause, pointing = "undercut", limits["outer_pointing"]
    if not has_spur_teeth(record["design_si"]):
        flank = max(record["flanks"].values(), key=lambda numbers: numbers["inner_limit_mm"])
        cause = str(flank["inner_cause"])
    inner, outer = (format_number(radii[f"gear_{end}"], 4) for end in ("inner", "outer"))
    pointed = f"pointed above {pointing:.3f} mm" if pointing is not None else "not pointed"
    note = (
        f"{cause} below {limits['inner_undercut']:.3f} mm\n"
        f"face {inner} to {outer} mm, {pointed}\n"
        f"{path_text(record)}"
    )
    return Panel(
        Axis("Arc", "mm", note), Axis("z", "mm"), marks, title="Face gear tooth", equal=True, height=2.4
    )


def separation(
    record: Mapping[str, Any], flanks: Mapping[str, Array], contact: Mapping[str, Array]
) -> Figure:
    """Draw the gap of the unloaded pair over the gear's flank, with the contact path.

    Parameters
    ----------
    record : mapping
        Content of `geometry/pair.json`.
    flanks : mapping of (n, m, 3) arrays
        Arrays of `geometry/flanks.npz`, m.
    contact : mapping of (...) arrays
        Arrays of `geometry/contact.npz`, SI units.

    Returns
    -------
    Figure
        One panel: contours of the gap, µm, over gear radius and height z, mm.
    """
    is_facing = contact["contour_facing"].astype(bool)
    gap = np.where(is_facing, 1e6 * contact["contour_gap"], np.nan)
    # places outside the flank have no gap, yet a map wants coordinates everywhere
    radius = np.where(is_facing, 1e3 * contact["contour_radius"], 1e3 * contact["contour_y"])
    height = np.where(is_facing, 1e3 * contact["contour_height"], np.nan)
    height = np.where(np.isnan(height), np.nanmean(height), height)
    largest = np.nanmax(gap)
    levels = (*(level for level in GAPS if level <= largest), float(np.ceil(largest + 1e-9)))
    scale = ColourScale("Separation", "µm", levels[0], levels[-1], "viridis_r", levels)
    marks: list[Levels | Curve | Text] = [Levels(radius, height, gap, scale)]
    top, flank = 1e3 * flanks["gear_flank"][0], 1e3 * flanks["gear_flank"][-1]
    for line, label, point, points in (
        (top, "tip edge", -1, 2.0),
        (flank, "end of the flank", len(flank) // 2, -3.0),
    ):
        out = np.hypot(line[:, 0], line[:, 1])
        marks.append(Curve(out, line[:, 2], colour=grey(0.2), width=0.8))
        look: Look = {"across": "right", "upright": "bottom" if points > 0 else "top"}
        marks.append(Text(out[point], line[point, 2], label, shift=(0.0, points), **look))
    path_radius = np.interp(contact["path_roll"], contact["contour_roll"][:, 0], np.arange(len(radius)))
    rows = np.clip(np.round(path_radius).astype(int), 0, len(radius) - 1)
    path = 1e3 * contact["path_y"], height[rows, height.shape[1] // 2]
    if not has_spur_teeth(record["design_si"]):
        # the path moves along the face, and places along the pinion are no radii: both follow from the map
        spots = [
            [
                np.interp(y, contact["contour_y"][row][on], part[row][on], np.nan, np.nan)
                for part in (radius, height)
            ]
            for row, y in zip(rows, contact["path_y"], strict=True)
            if (on := is_facing[row]).any()
        ]
        path = np.array(spots)[:, 0], np.array(spots)[:, 1]
    marks.append(Curve(*path, "contact path", RED, line="none", marker="dot"))
    gap_record = record["smallest_gap"]
    title = (
        f"Drive flank; smallest gap elsewhere {format_number(gap_record['gap_um'])} µm\n"
        f"at {format_number(gap_record['gear_radius_mm'], 4)} mm (gear {gap_record['gear_part']}, "
        f"pinion {gap_record['pinion_part']})"
    )
    ends = np.hypot(top[[0, -1], 0], top[[0, -1], 1])
    across = Axis("Gear radius", "mm", low=float(ends.min()), high=float(ends.max()))
    return Figure([Panel(across, Axis("z", "mm"), marks, title=title, height=3.0)])


def tooth_pair_figures(
    pair: Mapping[str, Any], flanks: Mapping[str, Array], contact: Mapping[str, Array]
) -> tuple[Figure, ...]:
    """Draw both gears in mesh, sections of both teeth, and the separation around the contact path.

    Parameters
    ----------
    pair : mapping
        Content of `geometry/pair.json`.
    flanks : mapping of (n, m, 3) arrays
        Arrays of `geometry/flanks.npz`, m.
    contact : mapping of (...) arrays
        Arrays of `geometry/contact.npz`, SI units.

    Returns
    -------
    tuple of Figure
        Those of `tooth_pair`, `tooth_sections` and `separation`.
    """
    return tooth_pair(pair, flanks), tooth_sections(pair, flanks), separation(pair, flanks, contact)


AXES = {
    "pinion": (("From the middle of the face", "mm"), ("Length of roll", "mm")),
    "face_gear": (("Gear radius", "mm"), ("Depth below the tip plane", "mm")),
}
"""Names and units of the axes of a flank chart, along the face and along the profile."""
EXCESS_COLOUR, LACK_COLOUR = RED, BLUE
"""Colours of material added and missing."""
HEIGHT = 0.14
"""Height of the largest deviation, in parts of the profile."""


def topography_figure(points: pd.DataFrame, body: str) -> Figure:
    """Draw left and right flank of a gear, with the mean of all teeth.

    Parameters
    ----------
    points : pd.DataFrame
        Table `points` of stage topography: body, flank, face_mm, profile_mm, deviation_um (> 0: added).
    body : str
        `pinion` or `face_gear`.

    Returns
    -------
    Figure
        A panel for each flank; deviations are exaggerated, HEIGHT of the profile at most.
    """
    body_points = points[points["body"] == body]
    largest = float(body_points["deviation_um"].abs().max())
    (across, width_unit), (up, unit) = AXES[body]
    face = body_points["face_mm"]
    margin = 0.2 * np.ptp(face)
    panels = []
    for side, flank in body_points.groupby("flank", sort=False):
        title = f"{body.replace('_', ' ')}, {side} flank: {_range(flank)}"
        panels.append(
            Panel(
                Axis(across, width_unit, low=face.min() - 0.25 * margin, high=face.max() + margin),
                Axis(up, unit, is_falling=body == "face_gear"),
                _chart(flank, largest),
                title=title,
                height=2.1,
            )
        )
    return Figure(panels)


def _chart(flank: pd.DataFrame, largest: float) -> list[Area | Curve | Text]:
    """Return lines of a flank, nominal and displaced by its deviations, areas between, and a scale bar.

    flank: rows of table `points`; largest: deviation (µm) that is drawn HEIGHT profiles high.
    """
    table = flank.pivot_table(index="profile_mm", columns="face_mm", values="deviation_um")
    face, profile, values = table.columns.to_numpy(float), table.index.to_numpy(float), table.to_numpy()
    up = HEIGHT * np.ptp(profile) * (-1.0 if flank["body"].iloc[0] == "face_gear" else 1.0) / (largest or 1.0)
    lifted = profile[:, None] + up * values
    flat = np.broadcast_to(profile[:, None], lifted.shape)
    marks: list[Area | Curve | Text] = [
        Area(*_between(face, flat, flat + up * part), name, colour, opacity=0.4)
        for part, name, colour in (
            (np.maximum(values, 0.0), "material added", EXCESS_COLOUR),
            (np.minimum(values, 0.0), "material missing", LACK_COLOUR),
        )
        if np.nanmax(np.abs(part)) > 0.0
    ]
    bar = _round_below(largest or 1.0)
    beside = face.max() + 0.05 * np.ptp(face)
    ends = profile.mean() + up * bar * np.array([-0.5, 0.5])
    return [
        *marks,
        Curve(*apart(face, flat), "nominal", grey(0.6), width=0.8),
        Curve(*apart(face, lifted), "flank with its deviations", grey(0.25), width=0.7),
        Curve(*apart(np.broadcast_to(face[:, None], lifted.T.shape), lifted.T), colour=grey(0.25), width=0.4),
        Curve(np.array([beside, beside]), ends, width=2.0),
        Text(beside, float(profile.mean()), f"{format_number(bar)} µm", shift=(4.0, 0.0)),
    ]


def _between(face: Array, flat: Array, lifted: Array) -> tuple[Array, Array]:
    """Return outlines, parted by nan, of areas between `flat` and `lifted` (lines, n) over `face` (n,)."""
    across = np.concatenate([face, face[::-1]])
    return apart(across, np.concatenate([flat, lifted[:, ::-1]], axis=1))


def _round_below(value: float) -> float:
    """Return the largest of 1, 2, 5 times a power of ten that is not above a value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value))


def _range(flank: pd.DataFrame) -> str:
    """Return the smallest and largest deviation of a flank as text, µm."""
    values = flank["deviation_um"]
    return f"{format_number(values.min())} to {format_number(values.max())} µm"


def topography_figures(points: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw charts of the pinion and of the face gear.

    Parameters
    ----------
    points : pd.DataFrame
        Table `points` of stage topography.

    Returns
    -------
    tuple[Figure, ...]
        Those of `topography_figure` for `pinion` and `face_gear`.
    """
    return topography_figure(points, "pinion"), topography_figure(points, "face_gear")


def tooth_error_figure(curves: Arrays, orders: pd.DataFrame) -> Figure:
    """Draw two panels for each gear whose teeth differ: the drive flank over a turn, and the orders of the
    gear's turns.

    Parameters
    ----------
    curves : mapping of (n,) arrays
        Arrays `<body>_drive_m` of stage tooth_errors: how early the drive flank touches over a turn, m.
    orders : DataFrame
        Table `orders` of stage tooth_errors: body, order (per turn), unloaded_um, loaded_um (amplitudes).

    Returns
    -------
    Figure
        The figure.
    """
    panels = []
    for body in orders["body"].unique():
        name, curve = body.replace("_", " "), 1e6 * curves[f"{body}_drive_m"]
        turns = np.arange(curve.size) / curve.size
        early = Curve(turns, curve, "drive flank, under load", BLUE, width=0.9)
        body_orders = orders[orders["body"] == body]
        at = body_orders["order"].to_numpy(float)
        bars = [
            Bars(at - 0.2, body_orders["unloaded_um"].to_numpy(float), "no load", BLACK, width=0.4),
            Bars(at + 0.2, body_orders["loaded_um"].to_numpy(float), "under load", BLUE, width=0.4),
        ]
        panels += [
            Panel(
                Axis(f"Turns of the {name}", ""), Axis("Early by", "µm"), [early], height=1.5, own_legend=True
            ),
            Panel(
                Axis(f"Order of its turns ({name})", "", integer=True),
                Axis("Amplitude", "µm", low=0.0),
                bars,
                height=1.5,
                own_legend=True,
            ),
        ]
    return Figure(panels, shared_x=False)


def tooth_errors_figures(curves: Arrays, orders: pd.DataFrame) -> tuple[Figure, ...]:
    """Draw the figure of teeth that differ from the others of their gear.

    Parameters
    ----------
    curves : mapping of (n,) arrays
        Arrays `curves` of stage tooth_errors, as `tooth_error_figure` reads them.
    orders : DataFrame
        Table `orders` of stage tooth_errors.

    Returns
    -------
    tuple of Figure
        The figure.
    """
    return (tooth_error_figure(curves, orders),)
