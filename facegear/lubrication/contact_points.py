"""Points where flanks touch under load: load, curvature and velocities of every loaded plane of a contact
line.

Line loads are smoothed, which costs 1 to 3 % of the force at the ends of a line. Friction coefficients follow
the load scaled to the force of the line's hats: planes twice as close then change the loss by 0.1 % at most.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import TypeVar

import numpy as np

from facegear.arrays import Array, Arrays, Integers, Mask
from facegear.contact.hertz import strip_pressure
from facegear.contact.lines import ContactLines, unloaded_lines
from facegear.contact.pattern import EDGES
from facegear.lubrication.kinematics import line_kinematics
from facegear.lubrication.loss import HatSlip
from facegear.teeth.closest import PAIRS
from facegear.teeth.design import PairDesign

INSIDE = EDGES.index("inside")
"""Number of the planes without an edge near in array `line_where`."""


@dataclass(frozen=True, eq=False)
class ContactPoints:
    """Loaded planes across the pinion's axis, all (m,), SI units; velocities for a pinion at 1 rad/s, in m.

    `torque`, `position`, `tooth`, `plane` say which; `inside` whether no edge is near. `y` along the pinion's
    axis, `roll` on its flank. `line_load` along the line and the `length` it stands for; `scaled_load` the
    same load in the proportion in which all of a line carries the force of its hats; `pressure` and
    `half_width` of the strip and `half_length` of its line. Relative `radius` of curvature across the line,
    rolling velocities `u1`, `u2` across it, the whole `sliding` velocity and its parts `across` and `along`,
    and `line_entrainment`, half the sum of both rolling velocities along the line.
    """

    torque: Array
    position: Array
    tooth: Integers
    plane: Integers
    inside: Mask
    y: Array
    roll: Array
    line_load: Array
    scaled_load: Array
    length: Array
    pressure: Array
    half_width: Array
    half_length: Array
    radius: Array
    u1: Array
    u2: Array
    sliding: Array
    across: Array
    along: Array
    line_entrainment: Array

    @property
    def ellipse_force(self) -> Array:
        """Force (m,) N of an elliptic Hertzian contact with the point's largest pressure, half width and
        half length.

        It is 2/3 pi a b p, for film formulas of elliptic contacts.
        """
        return 2 / 3 * np.pi * self.half_width * self.half_length * self.pressure


def stored_lines(design: PairDesign, arrays: Arrays, unloaded_error: Mapping[float, float]) -> ContactLines:
    """Compute the unloaded contact lines of the positions and tooth pairs in stored pressure arrays.

    Parameters
    ----------
    design : PairDesign
        Geometry of the pair.
    arrays : Arrays
        Arrays PRESSURE_ARRAYS of `facegear.contact.pattern`; their `contact_position`, `contact_tooth`
        and the axial coordinates of the lattice `point_m` are used.
    unloaded_error : Mapping[float, float]
        Unloaded transmission error (m) by position, in pitches.

    Returns
    -------
    ContactLines
        A row for each entry of `contact_position`, a column for each plane across the pinion's axis.

    Raises
    ------
    NotConverged
        As `facegear.teeth.separation` does.
    """
    planes = arrays["point_m"].reshape(*arrays["shape"], 3)[0, :, 1]
    return unloaded_lines(design, arrays["contact_position"], arrays["contact_tooth"], unloaded_error, planes)


def contact_points(design: PairDesign, arrays: Arrays, lines: ContactLines, modulus: float) -> ContactPoints:
    """Collect load, curvature, pressure and velocities at every loaded plane of the stored contact lines.

    Beside an edge the curvature and slope are those of the nearest plane that has any, and the pressure
    that of a long strip: they serve the friction coefficient alone. Contact lines without any curvature
    are left out.

    Parameters
    ----------
    design : PairDesign
        Geometry of the pair.
    arrays : Arrays
        Arrays PRESSURE_ARRAYS of `facegear.contact.pattern`; each entry of the `line_...` arrays is a
        point.
    lines : ContactLines
        Contact lines of the arrays, from `stored_lines`.
    modulus : float
        Contact modulus E* of both flanks together, Pa.

    Returns
    -------
    ContactPoints
        The points (m,) of all torques; `scaled_load` is still `line_load`, which `loaded_contacts` changes.
    """
    complete_lines = _fill_edges(lines)
    position, tooth = arrays["contact_position"], arrays["contact_tooth"]
    velocities = line_kinematics(design, complete_lines, position, tooth)
    row = _rows(arrays)
    at = row, arrays["line_plane"]
    load, curvature = arrays["line_load_n_per_m"], complete_lines.curvature[at]
    inside = arrays["line_where"] == INSIDE
    long, strip = strip_pressure(load, curvature, modulus)
    whole = ContactPoints(
        torque=arrays["line_torque_n_m"],
        position=arrays["line_position"],
        tooth=arrays["line_tooth"],
        plane=arrays["line_plane"],
        inside=inside,
        y=lines.y[at[1]],
        roll=lines.roll[at],
        line_load=load,
        scaled_load=load,
        length=arrays["line_length_m"],
        pressure=np.where(inside, arrays["line_pressure_pa"], long),
        half_width=np.where(inside, arrays["line_half_width_m"], strip),
        half_length=_half_lengths(arrays, row),
        radius=1 / curvature,
        u1=velocities.u1[at],
        u2=velocities.u2[at],
        sliding=velocities.sliding[at],
        across=velocities.across[at],
        along=velocities.along[at],
        line_entrainment=velocities.line_entrainment[at],
    )
    return select(whole, np.isfinite(whole.radius))


@dataclass(frozen=True, eq=False)
class LoadedContact:
    """Contact at one torque (N m) over a pitch: its points (m,), its hats (h,), and which belong together.

    `nearest` (h,): the point of a hat's plane, or the nearest loaded one of its line; -1 where its line has
    none. `positions`: how many there are in the pitch.
    """

    torque: float
    points: ContactPoints
    hats: HatSlip
    nearest: Integers
    positions: int

    @property
    def weights(self) -> Array:
        """Mean loss over the pitch (m,) N m that each point stands for, at a friction coefficient of 1
        and 1 rad/s.

        `sum(weights * friction) * speed` is the loss in W. A hat's loss counts at its nearest point. The
        loss of hats whose line has no point is spread over all points in proportion to their load, as
        `at_hats` averages.
        """
        sliding_loss = self.hats.force * self.hats.sliding / self.positions
        loads, has_point = self.points.line_load * self.points.length, self.nearest >= 0
        point_weights = (
            sliding_loss[~has_point].sum() * loads / loads.sum() if loads.size else np.zeros_like(loads)
        )
        np.add.at(point_weights, self.nearest[has_point], sliding_loss[has_point])
        return point_weights

    def at_hats(self, values: Array) -> Array:
        """Take values of contact points at the hats, the basis functions of the contact force.

        Parameters
        ----------
        values : (m,) array
            Values of the points, any unit.

        Returns
        -------
        (h,) array
            For each hat the value of its nearest point (`nearest`), in the same unit. Where its line has
            no point, the load-weighted mean over all points; 0 without any point.
        """
        weights = self.points.line_load * self.points.length
        mean = np.average(values, weights=weights) if weights.size else 0.0
        return np.append(values, mean)[self.nearest]


def loaded_contacts(contact_places: ContactPoints, hats: HatSlip) -> tuple[LoadedContact, ...]:
    """Group contact points and basis functions (hats) by torque, and assign each hat its nearest point.

    Parameters
    ----------
    contact_places : ContactPoints
        Points of all torques, from `contact_points`.
    hats : HatSlip
        Hats of all torques, from `hat_slip`.

    Returns
    -------
    tuple[LoadedContact, ...]
        One contact for each torque of the hats, rising, with `scaled_load` computed.
    """
    return tuple(
        _contact(
            float(torque),
            select(contact_places, contact_places.torque == torque),
            select(hats, hats.torque == torque),
        )
        for torque in np.unique(hats.torque)
    )


Loads = TypeVar("Loads", ContactPoints, HatSlip)


def select(loads: Loads, on: Mask | Integers | slice) -> Loads:
    """Select entries of contact points or of hats: every field is indexed alike along its first axis.

    Parameters
    ----------
    loads : Loads
        ContactPoints or HatSlip with m entries.
    on : mask, indices or slice
        Entries to take: booleans (m,), indices or a slice.

    Returns
    -------
    Loads
        A new object of the same class with these entries.
    """
    return replace(loads, **{field.name: getattr(loads, field.name)[on] for field in fields(loads)})


def concatenate(parts: Sequence[Loads]) -> Loads:
    """Join contact points, or hats, of several contacts: every field is concatenated along its first axis.

    Parameters
    ----------
    parts : Sequence[Loads]
        At least one part, all ContactPoints or all HatSlip.

    Returns
    -------
    Loads
        A new object of the same class with all entries in order.
    """
    names = [field.name for field in fields(parts[0])]
    return replace(
        parts[0], **{name: np.concatenate([getattr(part, name) for part in parts]) for name in names}
    )


def _contact(torque: float, contact_places: ContactPoints, hats: HatSlip) -> LoadedContact:
    """Build the contact of one torque (N m) from its points and hats.

    Each hat gets the point of its plane on its contact line (same position and tooth pair), or else the
    nearest point of the line, or -1. `scaled_load` multiplies `line_load` so that a line carries the
    force of its hats.
    """
    positions, row = np.unique(np.concatenate([contact_places.position, hats.position]), return_inverse=True)
    line = row * PAIRS.size + np.concatenate([contact_places.tooth, hats.tooth]) - PAIRS[0]
    count, planes = (
        contact_places.plane.size,
        1 + int(max(contact_places.plane.max(initial=0), hats.plane.max())),
    )
    table = np.full((positions.size * PAIRS.size, planes), np.nan)
    table[line[:count], contact_places.plane] = np.arange(count)
    nearest_or_nan = _nearest(table)[line[count:], hats.plane]
    nearest = np.where(np.isfinite(nearest_or_nan), np.nan_to_num(nearest_or_nan), -1).astype(np.int64)
    smooth_forces = contact_places.line_load * contact_places.length
    forces, sums = (
        np.bincount(on, weights=weights, minlength=len(table))
        for on, weights in ((line[count:], hats.force), (line[:count], smooth_forces))
    )
    scaled_load = contact_places.line_load * (forces / np.where(sums > 0.0, sums, 1.0))[line[:count]]
    whole = replace(contact_places, scaled_load=scaled_load)
    return LoadedContact(torque, whole, hats, nearest, np.unique(hats.position).size)


def _fill_edges(lines: ContactLines) -> ContactLines:
    """Return contact lines (p, n) whose nan in curvature and slope is replaced by the value of the
    nearest plane.

    They are nan where the gear's flank ends; lines without any value stay nan.
    """
    return replace(lines, curvature=_nearest(lines.curvature), slope=_nearest(lines.slope))


def _nearest(values: Array) -> Array:
    """Replace each nan in rows (p, n) by the nearest finite value of its row, the one before it on a tie.

    Distance counts in columns. Rows without a finite value stay nan.
    """
    columns = np.arange(values.shape[1])
    is_finite = np.isfinite(values)
    before = np.maximum.accumulate(np.where(is_finite, columns, -1), axis=1)
    after = np.minimum.accumulate(np.where(is_finite, columns, 2 * columns.size)[:, ::-1], axis=1)[:, ::-1]
    back = np.where(before >= 0, columns - before, 3 * columns.size)
    take = np.where(back <= after - columns, before, after)
    nearest_values = np.take_along_axis(values, np.clip(take, 0, columns.size - 1), axis=1)
    return np.where(is_finite.any(axis=1, keepdims=True), nearest_values, np.nan)


def _rows(arrays: Arrays) -> Integers:
    """Return for each loaded plane (m,) the index of its contact line in `contact_position` and
    `contact_tooth`.
    """
    keys = zip(arrays["contact_position"].tolist(), arrays["contact_tooth"].tolist(), strict=True)
    row = {key: number for number, key in enumerate(keys)}
    plane_keys = zip(arrays["line_position"].tolist(), arrays["line_tooth"].tolist(), strict=True)
    return np.array([row[key] for key in plane_keys], dtype=np.int64)


def _half_lengths(arrays: Arrays, row: Integers) -> Array:
    """Return half the loaded length of each point's contact line at its torque, (m,), m.

    `row` (m,) is the index of the contact line from `_rows`; the length is the sum of the loaded planes'
    lengths.
    """
    _, torque = np.unique(arrays["line_torque_n_m"], return_inverse=True)
    _, line = np.unique(torque * (row.max() + 1) + row, return_inverse=True)
    whole = np.zeros(line.max(initial=0) + 1)
    np.add.at(whole, line, arrays["line_length_m"])
    return 0.5 * whole[line]
