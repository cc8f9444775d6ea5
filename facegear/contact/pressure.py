"""Pressure on the flanks from line loads: what a load carried along a contact line means for the flank.

The loads of single hats depend on how the mesh lies to the strip of contact; what a plane across the pinion's
axis carries does not. So the pressure is that of Hertz for the line load and the exact relative curvature.
Where a tip edge or an end of the face is closer than the strip's half-width, pressure has no limit as a mesh
is refined, and the line load is all that can be said. What a fillet carries stands beside no contact line: it
is left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from scipy.ndimage import binary_closing, maximum_filter1d

from facegear.arrays import Array, Integers, Mask
from facegear.contact.columns import EDGES
from facegear.contact.fillet_contact import line_rows, on_flank
from facegear.contact.flanks import FlankPair
from facegear.contact.hertz import contact_modulus, strip_pressure
from facegear.contact.lines import ContactLines, unloaded_lines
from facegear.contact.position import LoadedPosition, Spot
from facegear.geometry.design import Material
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
        if not (self.where == INSIDE).any():
            return np.nan, np.nan
        at = np.nanargmax(self.pressure)
        return float(self.pressure[at]), float(self.error[at])

    def at_tips(self) -> tuple[float, float]:
        """Largest line load (N/m) at tip edges and the length (m) that carries any; zero without."""
        on = np.isin(self.where, (PINION_TIP, GEAR_TIP))
        return float(self.line_load[on].max(initial=0.0)), float(self.length[on].sum())


@dataclass(frozen=True, eq=False)
class FlankPressure:
    """Contact lines of all pairs at all positions, and what they carry at each position and torque.

    `position` and `tooth` (p,) of the lines and `points` (p, n, 3) of theirs on the pinion's right flank in
    its body frame, m; `loads` in the order of the results they were made from.
    """

    position: Array
    tooth: Integers
    lines: ContactLines
    points: Array
    loads: tuple[LineLoads, ...]


def flank_pressure(
    results: Sequence[LoadedPosition], flanks: FlankPair, materials: tuple[Material, Material]
) -> FlankPressure:
    """Line loads and pressures of all results; pairs -2..2 at every position.

    Raises NotConverged as `facegear.geometry.separation` does.
    """
    design = flanks.design
    unloaded = {result.position: result.unloaded for result in results}
    position, tooth = np.repeat(sorted(unloaded), PAIRS.size), np.tile(PAIRS, len(unloaded))
    lines = unloaded_lines(design, position, tooth, unloaded, flanks.pinion.planes)
    row = {key: i for i, key in enumerate(zip(position.tolist(), tooth.tolist(), strict=True))}
    modulus = contact_modulus(materials)
    places = line_rows(lines.to_pinion_tip, flanks.pinion)
    loads = []
    for result in results:
        at = [row[result.position, spot.tooth] for spot in result.spots]
        spots = [
            on_flank(spot, places[line], flanks.pinion) for spot, line in zip(result.spots, at, strict=True)
        ]
        loads.append(line_loads(spots, at, lines, modulus))
    points = flank_points(design, lines.roll, lines.y).position
    return FlankPressure(position=position, tooth=tooth, lines=lines, points=points, loads=tuple(loads))


def line_loads(spots: Sequence[Spot], rows: Sequence[int], lines: ContactLines, modulus: float) -> LineLoads:
    """Loads of one position and torque along its contact lines, of all the forces of `spots`.

    `rows` numbers the line of each spot; `modulus` E* (Pa).
    """
    planes = lines.y.size
    parts = []
    for spot, row in zip(spots, rows, strict=True):
        force = np.zeros(planes)
        np.add.at(force, spot.hats % planes, spot.force)
        parts.append(_along(force, lines, row, modulus))
    names = [field.name for field in fields(LineLoads)]
    return LineLoads(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in names})


def _along(force: Array, lines: ContactLines, row: int, modulus: float) -> LineLoads:
    """Of the forces (n,) N that the planes of one line carry."""
    face = lines.face[row]
    owner = _owners(face, lines.y[1] - lines.y[0])
    merged, widths = np.zeros_like(force), np.zeros_like(face)
    np.add.at(merged, owner, force)
    np.add.at(widths, owner, face)
    load, wider = (_smoothed(merged, widths, weights)[owner] for weights in (KERNEL, WIDER))
    carries = binary_closing(np.pad(merged > 0, 2))[2:-2][owner]
    loaded = np.flatnonzero(carries & (face > 0))
    slope = np.nan_to_num(lines.slope[row, loaded])
    half = 0.5 * face[loaded].sum()
    along = half / np.cos(slope)
    line_load = load[loaded] * half / along
    pressure, width = strip_pressure(line_load, lines.curvature[row, loaded], modulus, along)
    cut = owner[loaded] != loaded
    where = _where(lines, row, loaded, width / np.cos(slope), cut)
    inside = where == INSIDE
    peak = _peak_if_short(force, lines.y)
    apart = maximum_filter1d(np.abs(wider - load)[loaded], NEIGHBOURHOOD, mode="nearest")
    # in a short ellipse both averages are too low: load and length say by how much, and p goes with the root
    low = max(0.5 * (peak / load[loaded].max() - 1.0), 0.0) if loaded.size else 0.0
    return LineLoads(
        line=np.full(loaded.size, row),
        plane=loaded,
        length=face[loaded] / np.cos(slope),
        line_load=line_load,
        where=where,
        pressure=np.where(inside, pressure, np.nan),
        error=np.where(inside, np.hypot(0.5 * apart / load[loaded], low) * pressure, np.nan),
        half_width=width,
    )


def _peak_if_short(force: Array, y: Array) -> float:
    """Largest load per width (N/m) of a parabola with the load and length of forces (n,) on few planes.

    That is how a Hertz ellipse spreads its load along its length. 0 for more than SHORT loaded planes.
    """
    total, step = force.sum(), y[1] - y[0]
    if total == 0.0 or np.count_nonzero(force) > SHORT:
        return 0.0
    middle = force @ y / total
    spread = force @ (y - middle) ** 2 / total - step**2 / 6.0
    return float(0.75 * total / np.sqrt(5.0 * max(spread, MIN_SPREAD * step**2)))


def _owners(face: Array, step: float) -> Integers:
    """The plane (n,) that each one's load is counted with: itself, or the nearest that no end cuts.

    How two planes share their load where an end cuts one is arbitrary: their hats almost coincide.
    """
    whole = np.flatnonzero(face > (1 - 1e-9) * step)
    planes = np.arange(face.size)
    return np.clip(planes, whole[0], whole[-1]) if whole.size else planes


def _smoothed(force: Array, face: Array, weights: Array) -> Array:
    """Load per width (n,) N/m over neighbouring planes."""
    carried, width = (np.convolve(values, weights, mode="same") for values in (force, face))
    return carried / np.where(width > 0, width, 1.0)


def _where(lines: ContactLines, row: int, planes: Integers, width: Array, cut: Mask) -> Integers:
    to_pinion, to_gear, to_end = (
        values[row, planes] for values in (lines.to_pinion_tip, lines.to_gear_tip, lines.to_end)
    )
    where = np.full(planes.size, INSIDE)
    where[cut | (to_end < width) | (to_end < 0)] = END
    where[(np.isnan(to_gear) & (to_end >= 0)) | (to_gear < width)] = GEAR_TIP
    where[(to_pinion < width) | (to_pinion <= 0)] = PINION_TIP
    return where
