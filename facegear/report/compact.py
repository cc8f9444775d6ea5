"""Compact pictures of the first screen: machine, contact pattern and sweep, as drawings inside the page.

They take their colours from the page (`page.css`), so that one drawing serves light, dark and print.
"""

from collections.abc import Mapping, Sequence
from html import escape
from math import ceil, cos, floor, hypot, log10, pi, radians, sin
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays
from facegear.contact.pattern import EDGES, pattern
from facegear.number_format import format_number

WIDTH, HEIGHT = 320.0, 205.0
"""Size of a drawing in px: three of them fit beside each other on 1280 px."""
LEVELS = ("#2a1a5e", "#4b1d78", "#7a1f7c", "#a82e6d", "#d0454f", "#ec6c35", "#f99b2c", "#f8d54a")
"""Colours of eight equal parts of the largest pressure, dark to bright."""
POINTS = 500
"""Most points of a drawn curve: more than its width in px."""
LONGEST_ARROW = 0.5
"""Longest arrow over the radius of the drawn gear, a free choice."""


class Compact(NamedTuple):
    """One picture: its title, its svg element, and what it shows in words."""

    title: str
    svg: str
    words: str


def machine_picture(values: Mapping[str, Any], meshes: pd.DataFrame | None) -> Compact | None:
    """Draw the machine from above with the mean forces of its meshes.

    Parameters
    ----------
    values : mapping
        Plain values of the config.
    meshes : DataFrame or None
        Table `meshes` of stage ratings: mesh, force_n, flank (a force of flank `back` points the other
        way).

    Returns
    -------
    Compact or None
        The picture; None for a pair of teeth alone.
    """
    transmission = values["transmission"]
    if transmission is None or meshes is None:
        return None
    sides = [side for side in ("upper", "lower") if side in transmission["face_gears"]]
    forces = meshes.set_index("mesh")
    largest = max(forces["force_n"].abs().max(), 1e-300)
    centre, radius = np.array([WIDTH / 2, HEIGHT / 2]), 60.0
    pair = values["tooth_pair"]
    half = max(radius * pair["pinion_teeth"] / pair["face_gear_teeth"], 4.0)
    parts = [
        f'<circle class="outline" cx="{centre[0]:.1f}" cy="{centre[1]:.1f}" r="{edge:.1f}"/>'
        for edge in (radius - 7, radius + 7)
    ]
    turns = 1.0 if sides[0] == "upper" else -1.0
    for pinion in transmission["pinions"]:
        pitches = pinion["angle_pitches"]
        turn = pinion["angle_deg"] / 360.0 if pitches is None else pitches / pair["face_gear_teeth"]
        angle = 2.0 * pi * turn
        along, outwards = np.array([cos(angle), -sin(angle)]), np.array([sin(angle), cos(angle)])
        middle = centre + radius * outwards
        corners = [
            middle + a * half * along + b * 8 * outwards for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
        parts.append(f'<polygon class="{escape(pinion["role"])}" points="{_points(corners)}"/>')
        row = forces.loc[f"{pinion['name']}/{sides[0]}"]
        size = (-1.0 if row["flank"] == "back" else 1.0) * turns * abs(row["force_n"]) / largest
        parts.append(_arrow(middle, middle + LONGEST_ARROW * radius * size * along))
        names = [f"{pinion['name']}/{side}" for side in sides]
        kilo = " | ".join(f"{1e-3 * abs(forces.loc[name, 'force_n']):.1f}" for name in names)
        parts.append(_label(centre + (radius + 16) * outwards, outwards, [pinion["name"], f"{kilo} kN"]))
    parts.append(_text(centre, f"⌀ {2.0 * _mesh_radius(values):.0f} mm", "middle"))
    title = "Machine and mean forces"
    units = "; kN on the upper | lower gear" if len(sides) > 1 else ""
    words = f"Seen from above; arrows: mean tangential force on the {sides[0]} face gear{units}."
    return Compact(title, _svg(parts, title), words)


def _mesh_radius(values: Mapping[str, Any]) -> float:
    """Return the pitch radius of the gear in mm: half of transverse module times teeth."""
    pair = values["tooth_pair"]
    return 0.5 * float(pair["module_mm"] * pair["face_gear_teeth"]) / cos(radians(pair["helix_angle_deg"]))


def pattern_picture(arrays: Arrays | None, torque: float | None) -> Compact | None:
    """Draw the largest pressure that each point of the pinion's flank sees in a passage.

    Parameters
    ----------
    arrays : mapping or None
        Arrays of the contact analysis (PRESSURE_ARRAYS).
    torque : float or None
        Torque of a mesh in N m; the smallest one solved that is not smaller (within 0.1 %) is shown,
        else the largest.

    Returns
    -------
    Compact or None
        The picture; None where no contact was solved.
    """
    if arrays is None:
        return None
    passage_map = pattern(arrays)
    torques = np.array(sorted(passage_map.pressure))
    enough = torques[torques >= (torques[-1] if torque is None else 0.999 * torque)]
    torque_shown = float(enough[0] if enough.size else torques[-1])
    pressure, edge_kind = passage_map.pressure[torque_shown], passage_map.edge[torque_shown]
    width, height = (
        1e3 * passage_map.points[..., 1],
        1e3 * np.hypot(passage_map.points[..., 0], passage_map.points[..., 2]),
    )
    left, top, right, bottom = 34.0, 12.0, WIDTH - 8.0, HEIGHT - 40.0
    x = left + (width - width.min()) / max(np.ptp(width), 1e-9) * (right - left)
    y = bottom - (height - height.min()) / max(np.ptp(height), 1e-9) * (bottom - top)
    largest = float(np.nanmax(pressure, initial=0.0))
    parts = [f'<rect class="flank" x="{left}" y="{top}" width="{right - left}" height="{bottom - top}"/>']
    if largest > 0.0:
        parts += _cells(x, y, pressure / largest)
    edges = np.isin(edge_kind, [k for k, kind in enumerate(EDGES) if kind != "inside"])
    dots = "".join(f"M{a:.1f} {b:.1f}h.01" for a, b in zip(x[edges], y[edges], strict=True))
    if dots:
        parts.append(f'<path class="edges" d="{dots}"/>')
    parts += [
        _text((left, bottom + 14), f"{width.min():.0f} mm", "start"),
        _text((right, bottom + 14), f"{width.max():.0f} mm", "end"),
        _text(((left + right) / 2, bottom + 14), "along the face", "middle"),
        _text((left - 4, top + 9), "tip", "end"),
        _text((left - 4, bottom), "root", "end"),
        *_scale(left, bottom + 22, right - left, 1e-6 * largest, bool(dots)),
    ]
    title = f"Contact pattern at {format_number(torque_shown, 4)} N m"
    words = (
        "Largest pressure on the pinion's flank over a passage; dots: edges, where only a line load is known."
    )
    return Compact(title, _svg(parts, title), words)


def _cells(x: Array, y: Array, share: Array) -> list[str]:
    """Return a svg path for each level of colour: the cells of a grid whose mean `share` falls into
    that level.

    share: (steps, planes), 0 to 1, nan where unknown; a cell needs two known corners. x, y: places
    (steps, planes) of the same points, px.
    """
    corners = np.stack([share[:-1, :-1], share[1:, :-1], share[1:, 1:], share[:-1, 1:]])
    is_known = np.isfinite(corners)
    mean = np.where(is_known, corners, 0.0).sum(axis=0) / np.maximum(is_known.sum(axis=0), 1)
    level = np.where(is_known.sum(axis=0) >= 2, np.minimum(len(LEVELS) * mean, len(LEVELS) - 1e-9), -1.0)
    paths_by_level: dict[int, list[str]] = {}
    for step in range(level.shape[0]):
        row = np.floor(level[step]).astype(int)
        ends = np.flatnonzero(np.diff(row)) + 1
        for first, last in zip([0, *ends], [*ends, row.size], strict=True):
            if row[first] >= 0:
                forth = [(x[step, k], y[step, k]) for k in range(first, last + 1)]
                back = [(x[step + 1, k], y[step + 1, k]) for k in range(last, first - 1, -1)]
                paths_by_level.setdefault(int(row[first]), []).append(
                    f"M{_points([*_ends(forth), *_ends(back)])}Z"
                )
    return [
        f'<path fill="{LEVELS[k]}" stroke="{LEVELS[k]}" stroke-width=".4" d="{"".join(paths)}"/>'
        for k, paths in sorted(paths_by_level.items())
    ]


def _ends(points: Sequence[tuple[float, float]]) -> Sequence[tuple[float, float]]:
    """Return the first and last point (x, y), px: all between lie on a straight line across the flank."""
    return [points[0], points[-1]]


def _scale(left: float, top: float, width: float, largest: float, edges: bool) -> list[str]:
    """Return the svg elements of the pressure scale from 0 to `largest` (MPa) at `left`, `top` in a row
    of `width`, px, and of the mark of edges if there are any.
    """
    bar = 0.34 * width
    step = bar / len(LEVELS)
    parts = [
        f'<rect fill="{colour}" x="{left + k * step:.1f}" y="{top}" width="{step + 0.3:.1f}" height="9"/>'
        for k, colour in enumerate(LEVELS)
    ]
    parts.append(_text((left + bar + 5, top + 9), f"0 to {format_number(largest)} MPa", "start"))
    if edges:
        parts.append(f'<path class="edges" d="M{left + bar + 114:.1f} {top + 5}h.01"/>')
        parts.append(_text((left + bar + 121, top + 9), "edge", "start"))
    return parts


def sweep_picture(sweep: pd.DataFrame | None, jumps: pd.DataFrame | None, speed_rpm: float) -> Compact | None:
    """Draw the vibration of the mesh that vibrates most over speed, up and down.

    Parameters
    ----------
    sweep, jumps : DataFrame or None
        Tables of stage dynamics_sweep: direction, speed_rpm, quantity, body_or_mesh, value; and
        direction, speed_after_rpm.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Compact or None
        The picture; None without a sweep.
    """
    if sweep is None:
        return None
    rows = sweep[(sweep["quantity"] == "deflection_ac_rms_um") & sweep["value"].notna()]
    if rows.empty:
        return None
    mesh = rows["body_or_mesh"].iloc[rows["value"].argmax()]
    rows = rows[rows["body_or_mesh"] == mesh].sort_values("speed_rpm")
    curves = {
        str(direction): curve[["speed_rpm", "value"]].to_numpy(float)
        for direction, curve in rows.groupby("direction", sort=False)
    }
    curves = {direction: curves[direction] for direction in ("up", "down") if direction in curves}
    marks = [] if jumps is None else list(zip(jumps["direction"], jumps["speed_after_rpm"], strict=True))
    title = f"Vibration of {mesh}"
    words = (
        "RMS of the mesh that vibrates most, without its mean; triangles: jumps; upright dashes: nominal "
        "speed."
    )
    axes = _Axes.around(curves.values(), "pinion speed (rpm)", "µm", speed_rpm)
    parts = axes.frame()
    at = axes.x(speed_rpm)
    parts.append(f'<path class="nominal" d="M{at:.1f} {axes.top}V{axes.bottom}"/>')
    for direction, curve in curves.items():
        parts.append(f'<path class="curve {direction}" d="{axes.path(curve)}"/>')
    for direction, speed in marks:
        x, y = axes.x(speed), axes.bottom
        parts.append(f'<path class="jump {direction}" d="M{x - 3:.1f} {y}h6l-3 -7z"/>')
    parts += axes.legend({direction: f"speed {direction}" for direction in curves})
    return Compact(title, _svg(parts, title), words)


def error_picture(ltca: pd.DataFrame | None) -> Compact | None:
    """Draw the transmission error over a pitch at the smallest and the largest torque solved.

    Parameters
    ----------
    ltca : DataFrame or None
        Table `ltca` of stage contact: torque_n_m, position (pitches), ste_um.

    Returns
    -------
    Compact or None
        The picture, µm; None without a contact analysis or with a single position.
    """
    if ltca is None or ltca["position"].nunique() < 2:
        return None
    torques = sorted(ltca["torque_n_m"].unique())
    curves, names = {}, {}
    for direction, torque in zip(("down", "up"), dict.fromkeys((torques[0], torques[-1])), strict=False):
        rows = ltca[ltca["torque_n_m"] == torque].sort_values("position")
        error = rows["ste_um"] - rows["ste_um"].mean()
        curve = np.column_stack([rows["position"], error])
        curves[direction] = np.vstack([curve, [curve[0, 0] + 1.0, curve[0, 1]]])
        names[direction] = f"{format_number(torque, 4)} N m"
    words = "Static transmission error less its mean over a pitch, at the smallest and largest torque solved."
    axes = _Axes.around(curves.values(), "position (pitches)", "µm", None)
    parts = axes.frame()
    for direction, curve in curves.items():
        parts.append(f'<path class="curve {direction}" d="{axes.path(curve)}"/>')
    parts += axes.legend(names)
    title = "Transmission error less its mean"
    return Compact(title, _svg(parts, title), words)


class _Axes(NamedTuple):
    """Axes of a curve: data ranges, names and the box (px) that they fill."""

    x_range: tuple[float, float]
    y_range: tuple[float, float]
    x_name: str
    y_name: str
    left: float = 38.0
    top: float = 22.0
    right: float = WIDTH - 22.0
    bottom: float = HEIGHT - 34.0

    @classmethod
    def around(cls, curves: Any, x_name: str, y_name: str, also: float | None) -> "_Axes":
        """Return axes that hold all `curves`, each (n, 2) of abscissa and ordinate, and the abscissa
        `also` if given. The ordinates start at 0 or a round number below, and end at a round number.
        """
        every = np.vstack(list(curves))
        x = np.append(every[:, 0], [] if also is None else also)
        low, high = min(0.0, every[:, 1].min()), every[:, 1].max()
        step = _step(high - low)
        y_range = (step * floor(low / step), step * ceil(high / step) or step)
        return cls((float(x.min()), float(x.max())), y_range, x_name, y_name)

    def x(self, value: float) -> float:
        """Return the place of an abscissa on the drawing, px from the left."""
        low, high = self.x_range
        return self.left + (value - low) / max(high - low, 1e-300) * (self.right - self.left)

    def y(self, value: float) -> float:
        """Return the place of an ordinate on the drawing, px from the top."""
        low, high = self.y_range
        return self.bottom - (value - low) / max(high - low, 1e-300) * (self.bottom - self.top)

    def frame(self) -> list[str]:
        """Return grid lines, numbers and names of both axes as svg elements."""
        parts = []
        for value in _ticks(*self.y_range):
            y = self.y(value)
            parts.append(f'<path class="grid" d="M{self.left} {y:.1f}H{self.right}"/>')
            parts.append(_text((self.left - 5, y + 4), format_number(value), "end"))
        for value in _ticks(*self.x_range):
            x = self.x(value)
            parts.append(f'<path class="grid" d="M{x:.1f} {self.bottom}v4"/>')
            parts.append(_text((x, self.bottom + 16), format_number(value), "middle"))
        parts.append(_text(((self.left + self.right) / 2, HEIGHT - 4), self.x_name, "middle"))
        parts.append(_text((self.left - 5, self.top - 9), self.y_name, "end"))
        return parts

    def legend(self, names: Mapping[str, str]) -> list[str]:
        """Return the names of curves above the axes as svg elements, each with a piece of its line.
        `names`: text by the class of the curve in `page.css` (`up` or `down`).
        """
        parts, x = [], self.left + 10
        for direction, name in names.items():
            parts.append(f'<path class="curve {direction}" d="M{x} {self.top - 13}h16"/>')
            parts.append(_text((x + 20, self.top - 9), name, "start"))
            x += 36 + 7 * len(name)
        return parts

    def path(self, curve: Array) -> str:
        """Return the svg path of a curve (n, 2) in units of the axes; more than POINTS points are thinned."""
        points = curve if len(curve) <= POINTS else _thinned(curve)
        return "M" + _points([(self.x(a), self.y(b)) for a, b in points])


def _thinned(curve: Array) -> Array:
    """Return about POINTS points of a curve (n, 2): of each of POINTS / 2 equal parts the ones with the
    smallest and the largest ordinate, in their order.
    """
    indices: list[int] = []
    for part in np.array_split(np.arange(len(curve)), POINTS // 2):
        values = curve[part, 1]
        indices += sorted({int(part[values.argmin()]), int(part[values.argmax()])})
    return np.asarray(curve[indices])


def _step(span: float) -> float:
    """Return a distance of ticks of 1, 2, 5 or 10 times a power of ten, at least a quarter of `span`."""
    rough = max(span, 1e-12) / 4.0
    power = 10.0 ** floor(log10(rough))
    return next((factor * power for factor in (1.0, 2.0, 5.0) if factor * power >= rough), 10.0 * power)


def _ticks(low: float, high: float) -> list[float]:
    """Return the multiples of a round step from `low` to `high`."""
    step = _step(high - low)
    return [step * k for k in range(ceil(low / step - 1e-9), floor(high / step + 1e-9) + 1)]


def _points(points: Sequence[Any]) -> str:
    """Return points (x, y), px, as text `x,y x,y` with one decimal, for a polyline of a svg."""
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)


def _text(at: Sequence[float] | Array, words: str, anchor: str) -> str:
    """Return a svg text at a point (x, y), px; `anchor` (start, middle, end) is the part of it that
    stands there.
    """
    return f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" text-anchor="{anchor}">{escape(words)}</text>'


def _label(at: Array, outwards: Array, lines: Sequence[str]) -> str:
    """Return lines of svg text beside a point (2,), px, on the side to which the unit vector `outwards`
    points (y downwards).
    """
    anchor = "middle" if abs(outwards[0]) < 0.35 else "start" if outwards[0] > 0.0 else "end"
    first = at[1] + (-12 if outwards[1] < -0.35 else 9 if outwards[1] > 0.35 else -2)
    return "".join(_text((at[0], first + 13 * k), line, anchor) for k, line in enumerate(lines))


def _arrow(start: Array, end: Array) -> str:
    """Return the svg elements of an arrow between two points (2,), px, with a head of at most half its
    length; empty if it is shorter than 1 px.
    """
    length = hypot(*(end - start))
    if length < 1.0:
        return ""
    unit = (end - start) / length
    across, head = np.array([-unit[1], unit[0]]), min(8.0, 0.5 * length)
    neck = end - head * unit
    tip = _points([end, neck + 0.5 * head * across, neck - 0.5 * head * across])
    return f'<path class="force" d="M{_points([start, neck])}"/><polygon class="force" points="{tip}"/>'


def _svg(parts: Sequence[str], title: str) -> str:
    """Return a svg of WIDTH by HEIGHT from its elements, with a title for screen readers."""
    size = f'viewBox="0 0 {WIDTH:.0f} {HEIGHT:.0f}"'
    return f'<svg class="compact" role="img" aria-label="{escape(title)}" {size}>{"".join(parts)}</svg>'
