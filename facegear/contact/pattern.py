"""The contact pattern: pressures of one tooth's passage on the surface that its contact lines sweep."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Arrays, Integers
from facegear.contact.columns import EDGES


@dataclass(frozen=True, eq=False)
class Pattern:
    """One tooth's passage through the mesh in p steps and n planes across the pinion's axis.

    points (p, n, 3) m: its contact lines, on the right flank in the pinion's body frame; for each torque:
    `pressure` (p, n) Pa, nan where none is known, and `where` (p, n), a number in EDGES, -1 where unloaded;
    `line_load` (p, n) N/m.
    """

    points: Array
    pressure: dict[float, Array]
    where: dict[float, Integers]
    line_load: dict[float, Array]

    @property
    def largest(self) -> float:
        """Largest pressure of all torques, Pa; 0 where there is none."""
        return max((float(np.nanmax(p, initial=0.0)) for p in self.pressure.values()), default=0.0)


def passage(position: Array, tooth: Integers) -> Array:
    """Where a tooth is in its passage (pitches): pair j at position x is where pair 0 is at x + j."""
    return np.round(position + tooth, 9)


def pattern(arrays: Arrays) -> Pattern:
    """Of arrays as PRESSURE_ARRAYS."""
    stages, first = np.unique(passage(arrays["contact_position"], arrays["contact_tooth"]), return_index=True)
    points = arrays["contact_point_m"][first]
    at = np.searchsorted(stages, passage(arrays["line_position"], arrays["line_tooth"]))
    shape = points.shape[:2]
    pressure, where, line_load = {}, {}, {}
    for torque in np.unique(arrays["line_torque_n_m"]):
        on = arrays["line_torque_n_m"] == torque
        cells = at[on], arrays["line_plane"][on]
        values, kind, load = np.full(shape, np.nan), np.full(shape, -1), np.zeros(shape)
        inside = arrays["line_where"][on] == EDGES.index("inside")
        values[cells] = np.where(inside, arrays["line_pressure_pa"][on], np.nan)
        kind[cells], load[cells] = arrays["line_where"][on], arrays["line_load_n_per_m"][on]
        pressure[float(torque)], where[float(torque)], line_load[float(torque)] = values, kind, load
    return Pattern(points=points, pressure=pressure, where=where, line_load=line_load)


def imprint(arrays: Arrays, face: tuple[float, float]) -> Array:
    """Torque (N m) and the imprint of a passage along the pinion's axis, (torques, 4): its length (m), that
    over the width of a face from `face[0]` to `face[1]` (m from the gear's axis), and its middle (m).

    Of arrays as PRESSURE_ARRAYS; each loaded plane counts half way to its neighbours, within the face.
    """
    swept = pattern(arrays)
    half = 0.5 * float(np.diff(swept.points[0, :, 1]).mean())
    rows = []
    for torque, where in swept.where.items():
        y = swept.points[..., 1][where >= 0]
        ends = np.clip([y.min() - half, y.max() + half], *face) if y.size else np.zeros(2)
        length = float(np.ptp(ends))
        rows.append((torque, length, length / (face[1] - face[0]), float(ends.mean())))
    return np.array(rows)


def pressure_surface(
    arrays: Arrays,
) -> tuple[Array, dict[str, Integers], dict[str, Array]]:
    """The pattern as quadrilaterals for ParaView: points, cells, and pressure (Pa) and line load (N/m) at
    each torque; a pressure of nan where none is known.
    """
    swept = pattern(arrays)
    steps, planes = swept.points.shape[:2]
    nodes = np.arange(steps * planes).reshape(steps, planes)
    corners = nodes[:-1, :-1], nodes[1:, :-1], nodes[1:, 1:], nodes[:-1, 1:]
    fields = {}
    for torque in swept.pressure:
        fields[f"pressure_pa_at_{torque:g}_n_m"] = swept.pressure[torque].ravel()
        fields[f"line_load_n_per_m_at_{torque:g}_n_m"] = swept.line_load[torque].ravel()
    cells = {"quad": np.stack([c.ravel() for c in corners], axis=-1)}
    return swept.points.reshape(-1, 3), cells, fields
