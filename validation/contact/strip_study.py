"""Flank pressure against a strip fine in both directions: exact gaps, half spaces, the same line load."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.contact.pressure import INSIDE, FlankPressure
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import conjugate_angle
from facegear.teeth.separation import separation
from facegear.teeth.surfaces import SurfacePoints, flank_points
from validation.contact.half_space import half_space, pressures

ACROSS, ALONG = 12, 2
"""Cells in the strip's half-width across the line and along the axis."""

BESIDE = 2.0
"""Half-widths of flank on each side of the strip."""

ENDS = 6.0
"""Half-widths at the ends of the piece that are left out: the strip continues there, not the piece."""


@dataclass(frozen=True, eq=False)
class Strip:
    """Largest pressure (Pa) across the line on planes y (m,) m: of the strip, and of the line load."""

    y: Array
    strip: Array
    line: Array


def strip_at(
    design: PairDesign,
    pressure: FlankPressure,
    result: int,
    transmission_error: float,
    modulus: float,
    half_length: float = 4e-3,
) -> Strip:
    """Solve the piece of a contact line around the largest pressure of a result.

    Parameters
    ----------
    design : PairDesign
        The pair.
    pressure : FlankPressure
        Pressure on the flanks.
    result : int
        Index of the load in `pressure`.
    transmission_error : float
        Unloaded transmission error there, m.
    modulus : float
        E*, Pa.
    half_length : float
        Length of the piece each way, m.

    Returns
    -------
    Strip
        Pressures of both.
    """
    loads, lines = pressure.loads[result], pressure.lines
    at = int(np.nanargmax(loads.pressure))
    row = loads.line[at]
    y0 = lines.y[loads.plane[at]]
    on = (loads.line == row) & (loads.edge == INSIDE) & (np.abs(lines.y[loads.plane] - y0) <= half_length)
    planes, width = loads.plane[on], loads.half_width[at]
    our_pressure = lines.y[planes]
    arcs = 0.5 * design.pinion_base_radius * lines.roll[row, planes] ** 2
    y = np.arange(our_pressure[0], our_pressure[-1], width / ALONG)
    arc = np.arange(arcs.min() - BESIDE * width, arcs.max() + BESIDE * width, width / ACROSS)
    gap = _gap(design, pressure, row, transmission_error, arc, y)
    across = np.interp(y, our_pressure, loads.line_load[on] / np.cos(lines.slope[row, planes]))
    size = arc[1] - arc[0], y[1] - y[0]
    peak = pressures(half_space(gap.shape, size, modulus), gap, across / size[0]).max(axis=0)
    inner = (y > y[0] + ENDS * width) & (y < y[-1] - ENDS * width)
    return Strip(y[inner], peak[inner], np.interp(y[inner], our_pressure, loads.pressure[on]))


def _gap(
    design: PairDesign, pressure: FlankPressure, row: int, transmission_error: float, arc: Array, y: Array
) -> Array:
    """Exact gaps (n, m) m of one pair at lengths of the involute (n,) and planes (m,)."""
    phi1 = (pressure.position[row] - 0.5) * 2 * np.pi / design.pinion.teeth
    phi2 = conjugate_angle(design, phi1) - transmission_error / design.gear_base_radius
    roll, along = np.meshgrid(np.sqrt(2 * arc / design.pinion_base_radius), y, indexing="ij")
    points: SurfacePoints = flank_points(design, roll, along).flat()
    distance = separation(design, points, phi1, phi2, pressure.tooth[row])
    return distance.continued[0].reshape(roll.shape)
