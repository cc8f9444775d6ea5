"""The contact pattern: pressures of one tooth's passage on the surface that its contact lines sweep."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Arrays, Integers
from facegear.contact.columns import EDGES


@dataclass(frozen=True, eq=False)
class Pattern:
    """One tooth's passage through the mesh in p steps and n planes across the pinion's axis.

    points (p, n, 3) m: its contact lines, on the right flank in the pinion's body frame; for each torque:
    `pressure` (p, n) Pa, nan where it is not known, and `edge` (p, n), a number in EDGES, -1 where
    unloaded; `line_load` (p, n) N/m.
    """

    points: Array
    pressure: dict[float, Array]
    edge: dict[float, Integers]
    line_load: dict[float, Array]

    @property
    def largest(self) -> float:
        """Largest pressure of all torques, Pa; 0 where there is none."""
        return max((float(np.nanmax(p, initial=0.0)) for p in self.pressure.values()), default=0.0)


def passage(position: Array, tooth: Integers) -> Array:
    """Return the position of a tooth in its passage: pair j at position x is where pair 0 is at x + j.

    Parameters
    ----------
    position : (...) array
        In pitches.
    tooth : (...) array of int
        Number of the pair.

    Returns
    -------
    (...) array
        Position in pitches, rounded to 9 digits.
    """
    return np.round(position + tooth, 9)


def pattern(arrays: Arrays) -> Pattern:
    """Build the contact pattern from stored pressures.

    Parameters
    ----------
    arrays : Arrays
        Arrays as PRESSURE_ARRAYS.

    Returns
    -------
    Pattern
        Pattern at each torque, in SI units (m, Pa, N/m).
    """
    stages, first = np.unique(passage(arrays["contact_position"], arrays["contact_tooth"]), return_index=True)
    points = arrays["contact_point_m"][first]
    at = np.searchsorted(stages, passage(arrays["line_position"], arrays["line_tooth"]))
    shape = points.shape[:2]
    pressure, edge, line_load = {}, {}, {}
    for torque in np.unique(arrays["line_torque_n_m"]):
        on = arrays["line_torque_n_m"] == torque
        cells = at[on], arrays["line_plane"][on]
        values, kind, load = np.full(shape, np.nan), np.full(shape, -1), np.zeros(shape)
        inside = arrays["line_where"][on] == EDGES.index("inside")
        values[cells] = np.where(inside, arrays["line_pressure_pa"][on], np.nan)
        kind[cells], load[cells] = arrays["line_where"][on], arrays["line_load_n_per_m"][on]
        pressure[float(torque)], edge[float(torque)], line_load[float(torque)] = values, kind, load
    return Pattern(points=points, pressure=pressure, edge=edge, line_load=line_load)


def imprint(arrays: Arrays, face: tuple[float, float]) -> Array:
    """Measure the imprint of a passage along the pinion's axis, at each torque.

    Each loaded plane counts half way to its neighbours, within the face.

    Parameters
    ----------
    arrays : Arrays
        Arrays as PRESSURE_ARRAYS.
    face : tuple[float, float]
        Ends of the face, m from the gear's axis.

    Returns
    -------
    (torques, 4) array
        Torque (N m), length of the imprint (m), length over the width of the face, and its middle (m).
    """
    contact_pattern = pattern(arrays)
    half = 0.5 * float(np.diff(contact_pattern.points[0, :, 1]).mean())
    rows = []
    for torque, edge in contact_pattern.edge.items():
        y = contact_pattern.points[..., 1][edge >= 0]
        ends = np.clip([y.min() - half, y.max() + half], *face) if y.size else np.zeros(2)
        length = float(np.ptp(ends))
        rows.append((torque, length, length / (face[1] - face[0]), float(ends.mean())))
    return np.array(rows)


def pressure_surface(
    arrays: Arrays,
) -> tuple[Array, dict[str, Integers], dict[str, Array]]:
    """Return the pattern as quadrilaterals for ParaView.

    Parameters
    ----------
    arrays : Arrays
        Arrays as PRESSURE_ARRAYS.

    Returns
    -------
    tuple
        Points (n, 3), m; cells by kind (m, 4); fields (n,) by name: pressure (Pa, nan where it is not
        known) and line load (N/m) at each torque.
    """
    contact_pattern = pattern(arrays)
    steps, planes = contact_pattern.points.shape[:2]
    nodes = np.arange(steps * planes).reshape(steps, planes)
    corners = nodes[:-1, :-1], nodes[1:, :-1], nodes[1:, 1:], nodes[:-1, 1:]
    fields = {}
    for torque in contact_pattern.pressure:
        fields[f"pressure_pa_at_{torque:g}_n_m"] = contact_pattern.pressure[torque].ravel()
        fields[f"line_load_n_per_m_at_{torque:g}_n_m"] = contact_pattern.line_load[torque].ravel()
    cells = {"quad": np.stack([c.ravel() for c in corners], axis=-1)}
    return contact_pattern.points.reshape(-1, 3), cells, fields
