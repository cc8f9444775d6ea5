"""Where flanks touch under load: load, curvature and velocities of every loaded plane of a contact line.

Line loads are smoothed, which costs 1 to 3 % of the force at the ends of a line. Friction coefficients follow
the load scaled to the force of the line's hats: planes twice as close then change the loss by 0.1 % at most.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import TypeVar

import numpy as np

from facegear.arrays import Array, Arrays, Integers, Mask
from facegear.contact.columns import EDGES
from facegear.contact.hertz import strip_pressure
from facegear.contact.lines import ContactLines, unloaded_lines
from facegear.geometry.design import PairDesign
from facegear.geometry.unloaded import PAIRS
from facegear.lubrication.kinematics import line_kinematics
from facegear.lubrication.loss import HatSlip

INSIDE = EDGES.index("inside")


@dataclass(frozen=True, eq=False)
class Places:
    """Loaded planes across the pinion's axis, all (m,), SI units; velocities for a pinion at 1 rad/s, in m.

    `torque`, `position`, `tooth`, `plane` say which; `inside` whether no edge is near. `y` along the pinion's
    axis, `roll` on its flank. `line_load` along the line and the `length` it stands for; `carried` the same
    load in the proportion in which all of a line carries the force of its hats; `pressure` and `half_width`
    of the strip and `half_length` of its line. Relative `radius` of curvature across the line, rolling
    velocities `u1`, `u2` across it, the whole `sliding` velocity and its parts `across` and `along`,
    and what is `entrained` along the line.
    """

    torque: Array
    position: Array
    tooth: Integers
    plane: Integers
    inside: Mask
    y: Array
    roll: Array
    line_load: Array
    carried: Array
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
    entrained: Array

    @property
    def ellipse_force(self) -> Array:
        """Force (N) of an ellipse of the largest pressure, the strip's width and the line's length."""
        return 2 / 3 * np.pi * self.half_width * self.half_length * self.pressure


def stored_lines(design: PairDesign, arrays: Arrays, unloaded: Mapping[float, float]) -> ContactLines:
    """The contact lines of arrays as PRESSURE_ARRAYS; `unloaded` error (m) by position.

    Raises NotConverged as `facegear.geometry.separation` does.
    """
    planes = arrays["point_m"].reshape(*arrays["shape"], 3)[0, :, 1]
    return unloaded_lines(design, arrays["contact_position"], arrays["contact_tooth"], unloaded, planes)


def places(design: PairDesign, arrays: Arrays, lines: ContactLines, modulus: float) -> Places:
    """Of the line loads in arrays as PRESSURE_ARRAYS, with their contact lines; `modulus` E* (Pa).

    Beside an edge the curvature and slope are those of the nearest plane that has any, and the pressure that
    of a long strip: they serve the friction coefficient alone. Lines without any are left out.
    """
    filled = _filled(lines)
    position, tooth = arrays["contact_position"], arrays["contact_tooth"]
    moving = line_kinematics(design, filled, position, tooth)
    row = _rows(arrays)
    at = row, arrays["line_plane"]
    load, curvature = arrays["line_load_n_per_m"], filled.curvature[at]
    inside = arrays["line_where"] == INSIDE
    long, strip = strip_pressure(load, curvature, modulus)
    whole = Places(
        torque=arrays["line_torque_n_m"],
        position=arrays["line_position"],
        tooth=arrays["line_tooth"],
        plane=arrays["line_plane"],
        inside=inside,
        y=lines.y[at[1]],
        roll=lines.roll[at],
        line_load=load,
        carried=load,
        length=arrays["line_length_m"],
        pressure=np.where(inside, arrays["line_pressure_pa"], long),
        half_width=np.where(inside, arrays["line_half_width_m"], strip),
        half_length=_half_lengths(arrays, row),
        radius=1 / curvature,
        u1=moving.u1[at],
        u2=moving.u2[at],
        sliding=moving.sliding[at],
        across=moving.across[at],
        along=moving.along[at],
        entrained=moving.entrained[at],
    )
    return taken(whole, np.isfinite(whole.radius))


@dataclass(frozen=True, eq=False)
class LoadedContact:
    """The contact at one torque (N m) over a pitch: its places (m,), its hats (h,), which belong to which.

    `nearest` (h,): the place of a hat's plane, or the nearest loaded one of its line; -1 where its line has
    none. `positions`: how many there are in the pitch.
    """

    torque: float
    places: Places
    hats: HatSlip
    nearest: Integers
    positions: int

    @property
    def weights(self) -> Array:
        """Loss (m,) N m of each place at a friction coefficient of 1 and the pinion's 1 rad/s.

        What hats without a place lose is spread as `at_hats` takes their mean.
        """
        lost = self.hats.force * self.hats.sliding / self.positions
        loads, own = self.places.line_load * self.places.length, self.nearest >= 0
        summed = lost[~own].sum() * loads / loads.sum() if loads.size else np.zeros_like(loads)
        np.add.at(summed, self.nearest[own], lost[own])
        return summed

    def at_hats(self, values: Array) -> Array:
        """Values (m,) of places at every hat (h,); their mean, weighted with load, where a line has none."""
        weights = self.places.line_load * self.places.length
        mean = np.average(values, weights=weights) if weights.size else 0.0
        return np.append(values, mean)[self.nearest]


def loaded_contacts(contact_places: Places, hats: HatSlip) -> tuple[LoadedContact, ...]:
    """Places and hats apart by torque, rising."""
    return tuple(
        _contact(
            float(torque),
            taken(contact_places, contact_places.torque == torque),
            taken(hats, hats.torque == torque),
        )
        for torque in np.unique(hats.torque)
    )


Loads = TypeVar("Loads", Places, HatSlip)


def taken(loads: Loads, on: Mask | Integers | slice) -> Loads:
    """Some of the places or hats."""
    return replace(loads, **{field.name: getattr(loads, field.name)[on] for field in fields(loads)})


def joined(parts: Sequence[Loads]) -> Loads:
    """Places or hats one after the other; at least one part."""
    names = [field.name for field in fields(parts[0])]
    return replace(
        parts[0], **{name: np.concatenate([getattr(part, name) for part in parts]) for name in names}
    )


def _contact(torque: float, contact_places: Places, hats: HatSlip) -> LoadedContact:
    positions, row = np.unique(np.concatenate([contact_places.position, hats.position]), return_inverse=True)
    line = row * PAIRS.size + np.concatenate([contact_places.tooth, hats.tooth]) - PAIRS[0]
    count, planes = (
        contact_places.plane.size,
        1 + int(max(contact_places.plane.max(initial=0), hats.plane.max())),
    )
    table = np.full((positions.size * PAIRS.size, planes), np.nan)
    table[line[:count], contact_places.plane] = np.arange(count)
    picked = _nearest(table)[line[count:], hats.plane]
    nearest = np.where(np.isfinite(picked), np.nan_to_num(picked), -1).astype(np.int64)
    smoothed = contact_places.line_load * contact_places.length
    forces, sums = (
        np.bincount(on, weights=weights, minlength=len(table))
        for on, weights in ((line[count:], hats.force), (line[:count], smoothed))
    )
    carried = contact_places.line_load * (forces / np.where(sums > 0.0, sums, 1.0))[line[:count]]
    whole = replace(contact_places, carried=carried)
    return LoadedContact(torque, whole, hats, nearest, np.unique(hats.position).size)


def _filled(lines: ContactLines) -> ContactLines:
    return replace(lines, curvature=_nearest(lines.curvature), slope=_nearest(lines.slope))


def _nearest(values: Array) -> Array:
    """Rows (p, n) in which a nan takes the value of the nearest column that has one, if any has."""
    columns = np.arange(values.shape[1])
    known = np.isfinite(values)
    before = np.maximum.accumulate(np.where(known, columns, -1), axis=1)
    after = np.minimum.accumulate(np.where(known, columns, 2 * columns.size)[:, ::-1], axis=1)[:, ::-1]
    back = np.where(before >= 0, columns - before, 3 * columns.size)
    take = np.where(back <= after - columns, before, after)
    taken = np.take_along_axis(values, np.clip(take, 0, columns.size - 1), axis=1)
    return np.where(known.any(axis=1, keepdims=True), taken, np.nan)


def _rows(arrays: Arrays) -> Integers:
    """Contact line (m,) of every loaded plane."""
    keys = zip(arrays["contact_position"].tolist(), arrays["contact_tooth"].tolist(), strict=True)
    row = {key: number for number, key in enumerate(keys)}
    asked = zip(arrays["line_position"].tolist(), arrays["line_tooth"].tolist(), strict=True)
    return np.array([row[key] for key in asked], dtype=np.int64)


def _half_lengths(arrays: Arrays, row: Integers) -> Array:
    """Half the loaded length (m,) of the line that each plane belongs to."""
    _, torque = np.unique(arrays["line_torque_n_m"], return_inverse=True)
    _, line = np.unique(torque * (row.max() + 1) + row, return_inverse=True)
    whole = np.zeros(line.max(initial=0) + 1)
    np.add.at(whole, line, arrays["line_length_m"])
    return 0.5 * whole[line]
