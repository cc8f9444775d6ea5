"""Pressure on the flanks from line loads: line load, half-width and Hertz pressure along a contact line.

The loads of single basis functions depend on how the mesh lies relative to the strip of contact. The load
that a plane across the pinion's axis carries does not. So the pressure is that of Hertz for the line load
and the exact relative curvature. Where a tip edge or an end of the face is closer than the strip's
half-width, pressure has no limit as a mesh is refined, and only the line load is given. Load in a fillet
lies beside no contact line and is left out.

Contact in fillets kept apart from that of the flanks. Where a tip runs into the fillet of the other gear, a
plane across the pinion's axis carries load at two places: along the contact line of the flanks, and in the
fillet, where an edge presses and pressure has no limit as a mesh is refined.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.flanks import FlankPair, PinionSurface
from facegear.contact.hertz import contact_modulus, strip_pressure
from facegear.contact.lines import ContactLines, first_roll, unloaded_lines
from facegear.contact.pattern import EDGES
from facegear.contact.position import LoadedPosition, Spot
from facegear.teeth.closest import PAIRS
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.pinion import tip_roll
from facegear.teeth.surfaces import flank_points

INSIDE, PINION_TIP, GEAR_TIP, END = range(len(EDGES))
"""Index in EDGES of the place where a plane carries its load."""

KERNEL = np.array([1.0, 2.0, 1.0]) / 4
"""Weights of neighbouring planes, over an element of the face: forces alternate between its nodes."""

WIDER = np.array([1.0, 2.0, 2.0, 2.0, 1.0]) / 8
"""Weights of five neighbouring planes, over two elements; the difference from KERNEL shows what the planes'
distance leaves open."""

SHORT = 11
"""Loaded planes up to which a contact counts as a short ellipse."""
MIN_SPREAD = 0.02
"""Variance of a load along the face, in squares of the planes' distance, below which it is not given."""

NEIGHBOURHOOD = 5
"""Planes among which the largest difference is taken, as it may vanish at one by chance."""


@dataclass(frozen=True, eq=False)
class LineLoads:
    """Loaded planes across the pinion's axis at one position and torque, all (m,).

    `line` the row in `ContactLines`, `plane` its column; `length` (m) of line that the plane stands for;
    `line_load` (N/m) along the line; `edge` an index of EDGES; `pressure` (Pa) and its `error` (Pa), nan
    unless inside; `half_width` (m) of the strip, nan off the flanks.
    """

    line: Integers
    plane: Integers
    length: Array
    line_load: Array
    edge: Integers
    pressure: Array
    error: Array
    half_width: Array

    def largest(self) -> tuple[float, float]:
        """Return the largest pressure inside the flank, and its error.

        Returns
        -------
        tuple[float, float]
            Pa; nan where no plane is inside.
        """
        is_inside = self.edge == INSIDE
        if not is_inside.any():
            return np.nan, np.nan
        at = int(np.argmax(np.where(is_inside, self.pressure, -np.inf)))
        return float(self.pressure[at]), float(self.error[at])

    def part(self, rows: slice) -> "LineLoads":
        """Return the line loads of a range of rows.

        Parameters
        ----------
        rows : slice
            Range of the m loaded planes.

        Returns
        -------
        LineLoads
            Line loads of these rows.
        """
        return LineLoads(
            self.line[rows],
            self.plane[rows],
            self.length[rows],
            self.line_load[rows],
            self.edge[rows],
            self.pressure[rows],
            self.error[rows],
            self.half_width[rows],
        )

    def at_tips(self) -> tuple[float, float]:
        """Return the largest line load at tip edges, and the length that carries any.

        Returns
        -------
        tuple[float, float]
            Line load, N/m, and length, m; both 0 without load at tip edges.
        """
        on = (self.edge == PINION_TIP) | (self.edge == GEAR_TIP)
        return float(self.line_load[on].max(initial=0.0)), float(self.length[on].sum())


@dataclass(frozen=True, eq=False)
class FlankPressure:
    """Contact lines of the pairs that carry load at some torque, and the load of each line.

    `position` (in pitches) and `tooth` (p,) of the lines; `unloaded_errors`: unloaded transmission error
    (m) by position, which places the lines; `loads` in the order of the results that they were made from.
    """

    position: Array
    tooth: Integers
    lines: ContactLines
    unloaded_errors: Mapping[float, float]
    loads: tuple[LineLoads, ...]

    def every_point(self, design: PairDesign) -> tuple[Array, Integers, Array]:
        """Return the contact lines of the pairs -2..2 at all positions, loaded or not.

        Parameters
        ----------
        design : PairDesign
            Pair of gears.

        Returns
        -------
        tuple of arrays
            Position (q,) in pitches and number of the pair (q,); points (q, n, 3) of its contact line on
            the pinion's right flank in its body frame, m.
        """
        position, tooth = (
            np.repeat(sorted(self.unloaded_errors), PAIRS.size),
            np.tile(PAIRS, len(self.unloaded_errors)),
        )
        row = _rows(self.position, self.tooth)
        line_number = np.array(
            [row.get(pair, -1) for pair in zip(position.tolist(), tooth.tolist(), strict=True)]
        )
        roll = self.lines.roll[line_number]
        rest = line_number < 0
        if rest.any():
            missing_pairs = position[rest], tooth[rest]
            roll[rest] = unloaded_lines(design, *missing_pairs, self.unloaded_errors, self.lines.y).roll
        return position, tooth, flank_points(design, roll, self.lines.y).position


def flank_pressure(
    results: Sequence[LoadedPosition], flanks: FlankPair, materials: tuple[Material, Material]
) -> FlankPressure:
    """Compute line loads and pressures of all results.

    Parameters
    ----------
    results : Sequence[LoadedPosition]
        Contact by position and torque.
    flanks : FlankPair
        Flanks that touch.
    materials : tuple[Material, Material]
        Pinion and face gear.

    Returns
    -------
    FlankPressure
        Contact lines of all loaded pairs, and the line loads of each result, in N/m and Pa.

    Raises
    ------
    NotConverged
        As `facegear.teeth.separation` does.
    """
    design = flanks.design
    unloaded_errors = {result.position: result.unloaded_error for result in results}
    loaded_pairs = sorted({(result.position, spot.tooth) for result in results for spot in result.spots})
    position, tooth = (np.array(part) for part in zip(*loaded_pairs, strict=True))
    lines = unloaded_lines(design, position, tooth, unloaded_errors, flanks.pinion.planes)
    row = _rows(position, tooth)
    modulus = contact_modulus(materials)
    lattice_rows = line_rows(lines, flanks.pinion)
    spots, at = [], []
    for result in results:
        for spot in result.spots:
            at.append(row[result.position, spot.tooth])
            spots.append(on_flank(spot, lattice_rows[at[-1]], flanks.pinion))
    every, ends = _along(_by_plane(spots, lines.y.size), np.array(at), lines, modulus)
    of_result = np.cumsum([0] + [len(result.spots) for result in results])
    loads = [every.part(slice(ends[first], ends[last])) for first, last in pairwise(of_result)]
    return FlankPressure(position, tooth, lines, unloaded_errors, tuple(loads))


def _rows(position: Array, tooth: Integers) -> dict[tuple[float, int], int]:
    """Return the row of each contact line by its key, position (pitches) and number of the tooth pair."""
    return {pair: row for row, pair in enumerate(zip(position.tolist(), tooth.tolist(), strict=True))}


def line_loads(spots: Sequence[Spot], rows: Sequence[int], lines: ContactLines, modulus: float) -> LineLoads:
    """Compute the loads of one position and torque along its contact lines, from all forces of `spots`.

    Parameters
    ----------
    spots : Sequence[Spot]
        Loaded basis functions of each tooth pair.
    rows : Sequence[int]
        Row in `lines` of the contact line of each spot.
    lines : ContactLines
        Contact lines.
    modulus : float
        Contact modulus E*, Pa.

    Returns
    -------
    LineLoads
        Loaded planes of all spots, in N/m and Pa.
    """
    return _along(_by_plane(spots, lines.y.size), np.array(rows), lines, modulus)[0]


def _by_plane(spots: Sequence[Spot], planes: int) -> Array:
    """Return the forces (s, n), N, that n planes across the pinion's axis carry, for each spot."""
    force = np.zeros((len(spots), planes))
    number = np.repeat(np.arange(len(spots)), [spot.hats.size for spot in spots])
    hats = np.concatenate([spot.hats for spot in spots])
    np.add.at(force, (number, hats % planes), np.concatenate([spot.force for spot in spots]))
    return force


def _along(force: Array, rows: Integers, lines: ContactLines, modulus: float) -> tuple[LineLoads, Integers]:
    """Return the line loads for plane forces (s, n) N on lines `rows` (s,), and the end of each spot's rows
    (s + 1,).

    The first entry of the ends is 0.
    """
    spots, face = np.arange(len(rows)), lines.face[rows]
    owner = _owners(face, lines.y[1] - lines.y[0])
    plane_force, widths = np.zeros_like(force), np.zeros_like(face)
    for target, values in ((plane_force, force), (widths, face)):
        np.add.at(target, (spots[:, None], owner), values)
    load, wider = (
        np.take_along_axis(_smooth_load(plane_force, widths, weights), owner, 1)
        for weights in (KERNEL, WIDER)
    )
    is_loaded = np.take_along_axis(_close_gaps(plane_force > 0), owner, 1) & (face > 0)
    counts = np.count_nonzero(is_loaded, axis=1)
    ends = np.concatenate([[0], np.cumsum(counts)])
    spot, plane = np.nonzero(is_loaded)
    row = rows[spot]
    lean, stretch = np.cos(np.nan_to_num(lines.slope[row, plane])), lines.stretch(row, plane)
    half = 0.5 * np.where(is_loaded, face, 0.0).sum(axis=1)[spot]
    line_load = load[is_loaded] / stretch
    pressure, width = strip_pressure(line_load, lines.curvature[row, plane], modulus, half * stretch)
    edge = _nearest_edge(lines, row, plane, width / lean, owner[is_loaded] != plane)
    inside = edge == INSIDE
    apart = _largest_nearby(np.abs(wider - load)[is_loaded], ends, spot)
    # in a short ellipse both averages are too low: load and length say by how much, and p goes with the root
    top_load = np.where(is_loaded, load, 0.0).max(axis=1, initial=0.0)
    peak = _peak_if_short(force, lines.y) / np.where(top_load > 0.0, top_load, np.inf)
    low = np.maximum(0.5 * (peak - 1.0), 0.0)[spot]
    loads = LineLoads(
        line=row,
        plane=plane,
        length=face[is_loaded] * stretch,
        line_load=line_load,
        edge=edge,
        pressure=np.where(inside, pressure, np.nan),
        error=np.where(inside, np.hypot(0.5 * apart / load[is_loaded], low) * pressure, np.nan),
        half_width=width,
    )
    return loads, ends


def _largest_nearby(values: Array, ends: Integers, spot: Integers) -> Array:
    """Return the largest (m,) of NEIGHBOURHOOD neighbouring values of the same spot; `ends` as returned by
    `_along`.
    """
    at, reach = np.arange(values.size), NEIGHBOURHOOD // 2
    low, high = ends[spot], ends[spot + 1] - 1
    near = [values[np.clip(at + step, low, high)] for step in range(-reach, reach + 1)]
    return np.asarray(np.max(near, axis=0, initial=0.0))


def _close_gaps(carries: Mask) -> Mask:
    """Mark the loaded planes (s, n), and single unloaded planes between two loaded ones."""
    padded_mask = np.pad(carries, ((0, 0), (2, 2)))
    dilated_mask = padded_mask[:, :-2] | padded_mask[:, 1:-1] | padded_mask[:, 2:]
    return np.asarray(dilated_mask[:, :-2] & dilated_mask[:, 1:-1] & dilated_mask[:, 2:])


def _peak_if_short(force: Array, y: Array) -> Array:
    """Return the peak load per width (s,) N/m of a parabola with load and length of forces (s, n) on few
    planes.

    A Hertz ellipse spreads its load along its length in this way. The result is 0 for more than SHORT
    loaded planes.
    """
    total, step = force.sum(axis=1), y[1] - y[0]
    short = (total > 0.0) & (np.count_nonzero(force, axis=1) <= SHORT)
    total_or_one = np.where(total > 0.0, total, 1.0)
    middle = force @ y / total_or_one
    spread = (force * (y - middle[:, None]) ** 2).sum(axis=1) / total_or_one - step**2 / 6.0
    peak = 0.75 * total / np.sqrt(5.0 * np.maximum(spread, MIN_SPREAD * step**2))
    return np.where(short, peak, 0.0)


def _owners(face: Array, step: float) -> Integers:
    """Return the plane (s, n) to which each plane's load is added: itself, or the nearest that no end
    cuts.

    A plane is cut if its width `face` (m) is below `step` (m). How two planes share load there is
    arbitrary: their basis functions almost coincide.
    """
    whole = face > (1 - 1e-9) * step
    count = face.shape[1]
    has_no_whole_plane = ~whole.any(axis=1)
    first = np.where(has_no_whole_plane, 0, np.argmax(whole, axis=1))
    last = np.where(has_no_whole_plane, count, count - np.argmax(whole[:, ::-1], axis=1)) - 1
    return np.clip(np.arange(count), first[:, None], last[:, None])


def _smooth_load(force: Array, face: Array, weights: Array) -> Array:
    """Return the load per width (s, n) N/m: weighted `force` (N) over weighted `face` (m) of neighbouring
    planes.
    """
    reach, count = weights.size // 2, force.shape[1]
    padded_values = [np.pad(values, ((0, 0), (reach, reach))) for values in (force, face)]
    weighted_force, width = (
        sum(weight * values[:, start : start + count] for start, weight in enumerate(weights))
        for values in padded_values
    )
    return np.asarray(weighted_force / np.where(width > 0, width, 1.0))


def _nearest_edge(lines: ContactLines, row: Integers, planes: Integers, width: Array, cut: Mask) -> Integers:
    """Return the index in EDGES that the strip of half-width `width` (m) reaches in each plane, tips
    first; `row` and `planes` index `lines`, `cut` marks planes that take the load of another.
    """
    to_pinion, to_gear, to_end = (
        values[row, planes] for values in (lines.to_pinion_tip, lines.to_gear_tip, lines.to_end)
    )
    edge = np.full(planes.size, INSIDE)
    edge[cut | (to_end < width) | (to_end < 0)] = END
    edge[(np.isnan(to_gear) & (to_end >= 0)) | (to_gear < width)] = GEAR_TIP
    edge[(to_pinion < width) | (to_pinion <= 0)] = PINION_TIP
    return edge


APART = 2.0
"""Rows of the lattice between two loaded basis functions of a plane from which on they belong to two
contacts."""


def line_rows(lines: ContactLines, surface: PinionSurface) -> Array:
    """Compute the row of the refined lattice at which contact lines lie, linear in the square of the roll
    angle.

    Parameters
    ----------
    lines : ContactLines
        Contact lines (p, n).
    surface : PinionSurface
        Contact surface of the pinion.

    Returns
    -------
    (p, n) array
        Row, dimensionless, 0 at the tip edge.
    """
    design = surface.design
    top, bottom = tip_roll(design, lines.y), first_roll(design, lines.y)
    height = design.pinion_base_radius * (top**2 - bottom**2) / 2
    rows = (surface.side.flank_rows - 1) * surface.lattice.refinement.profile
    return np.clip(lines.to_pinion_tip / height, 0.0, 1.0) * rows


def on_flank(spot: Spot, line: Array, surface: PinionSurface) -> Spot:
    """Return the spot without the load in a fillet, and without load beside a fillet and apart from the
    contact line.

    Parameters
    ----------
    spot : Spot
        Loaded basis functions of a tooth pair.
    line : (n,) array
        Row at which the contact line lies in each plane, dimensionless.
    surface : PinionSurface
        Contact surface of the pinion.

    Returns
    -------
    Spot
        Load on the flank.
    """
    if not spot.fillet.any():
        return spot
    row, plane = np.divmod(spot.hats, surface.shape[1])
    keep = kept_hats(row, plane, spot.fillet, line, APART)
    return replace(spot, hats=spot.hats[keep], force=spot.force[keep], fillet=spot.fillet[keep])


def kept_hats(row: Integers, plane: Integers, fillet: Mask, line: Array, apart: float) -> Mask:
    """Mark the loaded basis functions that are neither in a fillet nor part of a contact in one.

    A contact consists of the basis functions of a plane that are no more than `apart` rows from the next.
    A contact that reaches a fillet lies in it, unless the plane's contact line is within `apart` rows of
    it.

    Parameters
    ----------
    row : (m,) array of int
        Row of each basis function.
    plane : (m,) array of int
        Plane of each basis function.
    fillet : (m,) array of bool
        Whether each presses on a fillet.
    line : (n,) array
        Row of the contact line in each plane, dimensionless.
    apart : float
        Distance in rows, dimensionless.

    Returns
    -------
    (m,) array of bool
        True on the flank.
    """
    order = np.lexsort((row, plane))
    row, plane = row[order], plane[order]
    begins = np.concatenate([[True], (np.diff(plane) != 0) | (np.diff(row) > apart)])[: row.size]
    first = np.flatnonzero(begins)
    low, high = row[first], row[np.append(first[1:], row.size) - 1]
    at_line = line[plane[first]]
    on_line = (low - apart <= at_line) & (at_line <= high + apart)
    in_fillet = np.logical_or.reduceat(fillet[order], first) if row.size else on_line
    is_on_flank = ~fillet
    is_on_flank[order] &= (on_line | ~in_fillet)[np.cumsum(begins) - 1]
    return is_on_flank
