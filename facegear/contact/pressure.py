"""Pressure on the flanks from line loads: what a load carried along a contact line means for the flank.

The loads of single hats depend on how the mesh lies to the strip of contact; what a plane across the pinion's
axis carries does not. So the pressure is that of Hertz for the line load and the exact relative curvature.
Where a tip edge or an end of the face is closer than the strip's half-width, pressure has no limit as a mesh
is refined, and the line load is all that can be said. What a fillet carries stands beside no contact line: it
is left out.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.columns import EDGES
from facegear.contact.fillet_contact import line_rows, on_flank
from facegear.contact.flanks import FlankPair
from facegear.contact.hertz import contact_modulus, strip_pressure
from facegear.contact.lines import ContactLines, unloaded_lines
from facegear.contact.position import LoadedPosition, Spot
from facegear.geometry.design import Material, PairDesign
from facegear.geometry.pinion_surface import flank_points
from facegear.geometry.unloaded import PAIRS

INSIDE, PINION_TIP, GEAR_TIP, END = range(len(EDGES))

KERNEL = np.array([1.0, 2.0, 1.0]) / 4
"""Weights of neighbouring planes, over an element of the face: forces alternate between its nodes."""

WIDER = np.array([1.0, 2.0, 2.0, 2.0, 1.0]) / 8
"""The same over two elements; the difference shows what the planes' distance leaves open."""

SHORT = 11
"""Loaded planes up to which a contact counts as a short ellipse."""
MIN_SPREAD = 0.02
"""Variance of a load along the face, in squares of the planes' distance, below which it is not given."""

NEIGHBOURHOOD = 5
"""Planes among which the largest difference is taken, as it may vanish at one by chance."""


@dataclass(frozen=True, eq=False)
class LineLoads:
    """Loaded planes across the pinion's axis, all (m,).

    `line` the row in `ContactLines`, `plane` its column; `length` (m) of the line that the plane stands
    for; `line_load` (N/m) along the line; `where` one of INSIDE, PINION_TIP, GEAR_TIP, END; `pressure` (Pa)
    and its `error` (Pa), nan unless inside; `half_width` (m) of the strip, nan off the flanks.
    """

    line: Integers
    plane: Integers
    length: Array
    line_load: Array
    where: Integers
    pressure: Array
    error: Array
    half_width: Array

    def largest(self) -> tuple[float, float]:
        """Largest pressure (Pa) and its error; nan where none is inside."""
        known = self.where == INSIDE
        if not known.any():
            return np.nan, np.nan
        at = int(np.argmax(np.where(known, self.pressure, -np.inf)))
        return float(self.pressure[at]), float(self.error[at])

    def part(self, rows: slice) -> "LineLoads":
        """Those of some rows."""
        return LineLoads(
            self.line[rows],
            self.plane[rows],
            self.length[rows],
            self.line_load[rows],
            self.where[rows],
            self.pressure[rows],
            self.error[rows],
            self.half_width[rows],
        )

    def at_tips(self) -> tuple[float, float]:
        """Largest line load (N/m) at tip edges and the length (m) that carries any; zero without."""
        on = (self.where == PINION_TIP) | (self.where == GEAR_TIP)
        return float(self.line_load[on].max(initial=0.0)), float(self.length[on].sum())


@dataclass(frozen=True, eq=False)
class FlankPressure:
    """Contact lines of the pairs that carry load at some torque, and what they carry at each.

    `position` and `tooth` (p,) of the lines; `unloaded` transmission error (m) of all positions by which they
    are placed; `loads` in the order of the results they were made from.
    """

    position: Array
    tooth: Integers
    lines: ContactLines
    unloaded: Mapping[float, float]
    loads: tuple[LineLoads, ...]

    def every_point(self, design: PairDesign) -> tuple[Array, Integers, Array]:
        """Positions and teeth (q,) of the pairs -2..2 at all positions, and the points (q, n, 3) of their
        lines on the pinion's right flank in its body frame, m.
        """
        position, tooth = np.repeat(sorted(self.unloaded), PAIRS.size), np.tile(PAIRS, len(self.unloaded))
        row = _rows(self.position, self.tooth)
        known = np.array([row.get(pair, -1) for pair in zip(position.tolist(), tooth.tolist(), strict=True)])
        roll = self.lines.roll[known]
        rest = known < 0
        if rest.any():
            others = position[rest], tooth[rest]
            roll[rest] = unloaded_lines(design, *others, self.unloaded, self.lines.y).roll
        return position, tooth, flank_points(design, roll, self.lines.y).position


def flank_pressure(
    results: Sequence[LoadedPosition], flanks: FlankPair, materials: tuple[Material, Material]
) -> FlankPressure:
    """Line loads and pressures of all results.

    Raises NotConverged as `facegear.geometry.separation` does.
    """
    design = flanks.design
    unloaded = {result.position: result.unloaded for result in results}
    loaded = sorted({(result.position, spot.tooth) for result in results for spot in result.spots})
    position, tooth = (np.array(part) for part in zip(*loaded, strict=True))
    lines = unloaded_lines(design, position, tooth, unloaded, flanks.pinion.planes)
    row = _rows(position, tooth)
    modulus = contact_modulus(materials)
    places = line_rows(lines.to_pinion_tip, flanks.pinion)
    spots, at = [], []
    for result in results:
        for spot in result.spots:
            at.append(row[result.position, spot.tooth])
            spots.append(on_flank(spot, places[at[-1]], flanks.pinion))
    every, ends = _along(_by_plane(spots, lines.y.size), np.array(at), lines, modulus)
    of_result = np.cumsum([0] + [len(result.spots) for result in results])
    loads = [every.part(slice(ends[first], ends[last])) for first, last in pairwise(of_result)]
    return FlankPressure(position, tooth, lines, unloaded, tuple(loads))


def _rows(position: Array, tooth: Integers) -> dict[tuple[float, int], int]:
    """Number of each line by position and tooth."""
    return {pair: row for row, pair in enumerate(zip(position.tolist(), tooth.tolist(), strict=True))}


def line_loads(spots: Sequence[Spot], rows: Sequence[int], lines: ContactLines, modulus: float) -> LineLoads:
    """Loads of one position and torque along its contact lines, of all the forces of `spots`.

    `rows` numbers the line of each spot; `modulus` E* (Pa).
    """
    return _along(_by_plane(spots, lines.y.size), np.array(rows), lines, modulus)[0]


def _by_plane(spots: Sequence[Spot], planes: int) -> Array:
    """Forces (s, n) N that n planes carry of each spot."""
    force = np.zeros((len(spots), planes))
    number = np.repeat(np.arange(len(spots)), [spot.hats.size for spot in spots])
    hats = np.concatenate([spot.hats for spot in spots])
    np.add.at(force, (number, hats % planes), np.concatenate([spot.force for spot in spots]))
    return force


def _along(force: Array, rows: Integers, lines: ContactLines, modulus: float) -> tuple[LineLoads, Integers]:
    """Of the forces (s, n) N that the planes of lines `rows` (s,) carry, and where those of each spot end
    (s + 1,), 0 first.
    """
    spots, face = np.arange(len(rows)), lines.face[rows]
    owner = _owners(face, lines.y[1] - lines.y[0])
    merged, widths = np.zeros_like(force), np.zeros_like(face)
    for target, values in ((merged, force), (widths, face)):
        np.add.at(target, (spots[:, None], owner), values)
    load, wider = (
        np.take_along_axis(_smoothed(merged, widths, weights), owner, 1) for weights in (KERNEL, WIDER)
    )
    loaded = np.take_along_axis(_closed(merged > 0), owner, 1) & (face > 0)
    counts = np.count_nonzero(loaded, axis=1)
    ends = np.concatenate([[0], np.cumsum(counts)])
    spot, plane = np.nonzero(loaded)
    row = rows[spot]
    slope = np.nan_to_num(lines.slope[row, plane])
    half = 0.5 * np.where(loaded, face, 0.0).sum(axis=1)[spot]
    along = half / np.cos(slope)
    line_load = load[loaded] * half / along
    pressure, width = strip_pressure(line_load, lines.curvature[row, plane], modulus, along)
    where = _where(lines, row, plane, width / np.cos(slope), owner[loaded] != plane)
    inside = where == INSIDE
    apart = _largest_nearby(np.abs(wider - load)[loaded], ends, spot)
    # in a short ellipse both averages are too low: load and length say by how much, and p goes with the root
    top_load = np.where(loaded, load, 0.0).max(axis=1, initial=0.0)
    peak = _peak_if_short(force, lines.y) / np.where(top_load > 0.0, top_load, np.inf)
    low = np.maximum(0.5 * (peak - 1.0), 0.0)[spot]
    loads = LineLoads(
        line=row,
        plane=plane,
        length=face[loaded] / np.cos(slope),
        line_load=line_load,
        where=where,
        pressure=np.where(inside, pressure, np.nan),
        error=np.where(inside, np.hypot(0.5 * apart / load[loaded], low) * pressure, np.nan),
        half_width=width,
    )
    return loads, ends


def _largest_nearby(values: Array, ends: Integers, spot: Integers) -> Array:
    """The largest (m,) of NEIGHBOURHOOD neighbouring values of the same spot; `ends` as `_along` has them."""
    at, reach = np.arange(values.size), NEIGHBOURHOOD // 2
    low, high = ends[spot], ends[spot + 1] - 1
    near = [values[np.clip(at + step, low, high)] for step in range(-reach, reach + 1)]
    return np.asarray(np.max(near, axis=0, initial=0.0))


def _closed(carries: Mask) -> Mask:
    """Planes (s, n) that carry load, with those between two that do."""
    padded = np.pad(carries, ((0, 0), (2, 2)))
    grown = padded[:, :-2] | padded[:, 1:-1] | padded[:, 2:]
    return np.asarray(grown[:, :-2] & grown[:, 1:-1] & grown[:, 2:])


def _peak_if_short(force: Array, y: Array) -> Array:
    """Largest load per width (s,) N/m of a parabola with the load and length of forces (s, n) on few planes.

    That is how a Hertz ellipse spreads its load along its length. 0 for more than SHORT loaded planes.
    """
    total, step = force.sum(axis=1), y[1] - y[0]
    short = (total > 0.0) & (np.count_nonzero(force, axis=1) <= SHORT)
    carried = np.where(total > 0.0, total, 1.0)
    middle = force @ y / carried
    spread = (force * (y - middle[:, None]) ** 2).sum(axis=1) / carried - step**2 / 6.0
    peak = 0.75 * total / np.sqrt(5.0 * np.maximum(spread, MIN_SPREAD * step**2))
    return np.where(short, peak, 0.0)


def _owners(face: Array, step: float) -> Integers:
    """The plane (s, n) that each one's load is counted with: itself, or the nearest that no end cuts.

    How two planes share their load where an end cuts one is arbitrary: their hats almost coincide.
    """
    whole = face > (1 - 1e-9) * step
    count = face.shape[1]
    none = ~whole.any(axis=1)
    first = np.where(none, 0, np.argmax(whole, axis=1))
    last = np.where(none, count, count - np.argmax(whole[:, ::-1], axis=1)) - 1
    return np.clip(np.arange(count), first[:, None], last[:, None])


def _smoothed(force: Array, face: Array, weights: Array) -> Array:
    """Load per width (s, n) N/m over neighbouring planes."""
    reach, count = weights.size // 2, force.shape[1]
    padded = [np.pad(values, ((0, 0), (reach, reach))) for values in (force, face)]
    carried, width = (
        sum(weight * values[:, start : start + count] for start, weight in enumerate(weights))
        for values in padded
    )
    return np.asarray(carried / np.where(width > 0, width, 1.0))


def _where(lines: ContactLines, row: Integers, planes: Integers, width: Array, cut: Mask) -> Integers:
    to_pinion, to_gear, to_end = (
        values[row, planes] for values in (lines.to_pinion_tip, lines.to_gear_tip, lines.to_end)
    )
    where = np.full(planes.size, INSIDE)
    where[cut | (to_end < width) | (to_end < 0)] = END
    where[(np.isnan(to_gear) & (to_end >= 0)) | (to_gear < width)] = GEAR_TIP
    where[(to_pinion < width) | (to_pinion <= 0)] = PINION_TIP
    return where
