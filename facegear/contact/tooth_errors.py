"""How single teeth that deviate from the mean of their gear disturb a mesh, tooth by tooth.

A tooth numbered m, from 0 in the order in which teeth come into mesh, is at the place s = u - m of its way
through the mesh, where u counts mesh cycles of its gear. Without load, the pair whose flanks come first says
where the gears stand: the transmission error is the largest of all pairs' own. Under load all pairs in
contact share it: what a deviation adds to the transmission error at a given load is, to first order, its mean
over what each place carries of a little more load (Maxwell's theorem: the approach changes with a gap as the
force there does with the load).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Arrays
from facegear.contact.lines import contact_gaps
from facegear.contact.nodal_loads import loads_by_tooth
from facegear.contact.teeth import ContactSide
from facegear.geometry import face_gear, pinion
from facegear.geometry.bodies import BODIES, Body
from facegear.geometry.design import DeviationGrid, PairDesign
from facegear.geometry.deviations import deviation
from facegear.geometry.gear_modifications import flank_depth, tip_edge_as_made
from facegear.geometry.opposite import tip_edge_feet
from facegear.geometry.placement import pinion_angle
from facegear.geometry.unloaded import PAIRS, unloaded_motion

Teeth = Sequence[DeviationGrid | None]
"""By the number of a tooth, what its flank deviates by from the mean of its gear."""

PLANES = 121
"""Planes across the pinion's axis in which the flanks' gaps are looked at: on 25 mm of face within 2 nm."""

CLOSER_LOOKS, LOOKS = (6, 2, 2), 9
"""Places about which each closer look at an extreme is taken, and positions about each of them."""


def at_places(teeth: Teeth, places: tuple[Array, Array]) -> Array:
    """Deviations (teeth, ...) m at places along face and profile (m) as in `DeviationGrid`."""
    different = list(dict.fromkeys(teeth))
    values = np.stack([deviation(grid, *places) for grid in different])
    return values[[different.index(grid) for grid in teeth]]


def loaded_curves(
    design: PairDesign,
    sides: Mapping[Body, ContactSide],
    loads: Arrays,
    torque: float,
    teeth: Mapping[Body, Teeth],
    variant: int = 0,
) -> dict[Body, Array]:
    """Of each gear what its teeth add to the transmission error (teeth x positions,) m over one of its turns.

    At a torque (N m), by the forces at those of `loads`, arrays LOAD_ARRAYS of stage contact; of its
    `variant`. Forces of a little more load are differences over neighbouring torques, with no load as one.
    """
    cases = loads["variant"] == variant
    torques, positions = (np.unique(loads[name][cases]) for name in ("torque_n_m", "position"))
    nodes = np.concatenate([[0.0], torques]) / design.pinion_base_radius
    slopes: Array = np.asarray(np.gradient(np.eye(nodes.size), nodes, axis=0))
    added = [np.interp(torque / design.pinion_base_radius, nodes, column) for column in slopes.T[1:]]
    curves = {}
    for body in BODIES:
        forces = loads_by_tooth(loads, body, variant=variant)
        values = at_places(teeth[body], node_places(design, body, sides[body]))
        curve = np.zeros((len(teeth[body]), positions.size))
        for pair, matrix in forces.items():
            own = (matrix @ values.T).reshape(torques.size, positions.size, -1)
            mean = np.tensordot(np.array(added), own, axes=1)
            curve += np.roll(mean.T, pair, axis=0)
        curves[body] = curve.ravel()
    return curves


def node_places(design: PairDesign, body: Body, side: ContactSide) -> tuple[Array, Array]:
    """Face and profile (m) of the nodes of a contact surface, those in the fillet at the flank's end."""
    rows = side.flank_rows
    if body == "pinion":
        roll = side.u.copy()
        roll[rows:] = pinion.junction_roll(design)
        along, across = pinion.deviation_place(design, roll, side.v)
        return along.ravel(), across.ravel()
    points = face_gear.flank_point(design, side.u[:rows], side.v[:rows])
    radius = np.concatenate([np.hypot(points[..., 0], points[..., 1]), side.v[rows:]])
    depth = np.concatenate([design.gear_tip_plane - points[..., 2], flank_depth(design)(side.v[rows:])])
    return radius.ravel(), depth.ravel()


@dataclass(frozen=True, eq=False)
class PairGaps:
    """Least gaps (m) of the mean flanks, (5 pairs, positions, 2, planes): in planes across the pinion's axis,
    and of points along the gear's tip edge; inf where there is none. `places`: where they are on each gear,
    face and profile (m). `mean`: the transmission error (positions,) m that they are of.
    """

    mean: Array
    gap: Array
    places: Mapping[Body, tuple[Array, Array]]


def pair_gaps(design: PairDesign, places: Array, planes: int = PLANES) -> PairGaps:
    """Compute the gaps at the unloaded transmission error, at some positions of the mesh cycle.

    Parameters
    ----------
    design
        The pair with its mean flanks.
    places : (positions,)
        In pitches, from 0 to below 1.
    planes
        Planes across the pinion's axis, and points of the gear's tip edge.

    Raises
    ------
    NotConverged
        Where the flanks' touch is not found.
    """
    positions, phi1 = len(places), pinion_angle(design, places)
    phi2, error = unloaded_motion(design, phi1)
    gear, half = design.face_gear, design.pinion.width / 2
    first = max(gear.inner_radius, design.mean_radius - half)
    y = np.linspace(first, min(gear.outer_radius, design.mean_radius + half), planes)
    tooth = np.repeat(PAIRS, positions)
    placement = np.tile(phi1, PAIRS.size), np.tile(phi2, PAIRS.size), tooth.astype(float)
    roll, gap, points = contact_gaps(design, placement, y)
    inside = (
        gap,
        roll,
        y + 0.0 * roll,
        np.hypot(points[..., 0], points[..., 1]),
        design.gear_tip_plane - points[..., 2],
    )
    edge = _tip_edge_gaps(design, placement, planes)
    gap, roll, y, radius, depth = (
        np.stack(parts, axis=1).reshape(PAIRS.size, positions, 2, planes)
        for parts in zip(inside, edge, strict=True)
    )
    on = np.isfinite(gap)
    roll, y, radius, depth = (np.where(on, part, 0.0) for part in (roll, y, radius, depth))
    on_gears: dict[Body, tuple[Array, Array]] = {
        "pinion": pinion.deviation_place(design, roll, y),
        "face_gear": (radius, depth),
    }
    return PairGaps(error, gap, on_gears)


def _tip_edge_gaps(
    design: PairDesign, placement: tuple[Array, Array, Array], count: int
) -> tuple[Array, ...]:
    """Gap, roll (rad) and y on the pinion, radius and depth on the gear (p, count) along its tip edge."""
    radius = np.linspace(design.face_gear.inner_radius, design.face_gear.outer_radius, count)
    edge = tip_edge_as_made(design, radius) * np.array([-1.0, 1.0, 1.0])
    top, bottom = design.pinion_tip_roll**2, pinion.junction_roll(design) ** 2
    feet = tip_edge_feet(design, edge, placement, None, design.module)
    roll = np.sqrt(np.maximum(top - feet.flank * (top - bottom), 0.0))
    radii = np.broadcast_to(radius, roll.shape)
    return feet.gap, roll, feet.y, radii, np.zeros(roll.shape)


def unloaded_errors(gaps: PairGaps, teeth: Mapping[Body, Teeth], cycles: int) -> Array:
    """Transmission error (cycles, positions) m without load; pair j of cycle k: tooth k - j of both gears."""
    values = {body: at_places(teeth[body], gaps.places[body]) for body in BODIES}
    best = np.full((cycles, gaps.mean.size), -np.inf)
    for number, pair in enumerate(PAIRS):
        if not np.isfinite(gaps.gap[number]).any():
            continue
        for cycle in range(cycles):
            first, second = ((cycle - pair) % len(teeth[body]) for body in BODIES)
            ahead = values["pinion"][first, number] + values["face_gear"][second, number] - gaps.gap[number]
            best[cycle] = np.maximum(best[cycle], ahead.max(axis=(1, 2)))
    return gaps.mean + best


def located_range(design: PairDesign, teeth: Mapping[Body, Teeth], errors: Array) -> tuple[float, float]:
    """Locate the extremes of the unloaded transmission error between even positions.

    Around the positions with the largest and with the smallest values all mesh cycles are looked at again,
    more closely each time.

    Parameters
    ----------
    design, teeth
        As for unloaded_errors().
    errors : (cycles, positions)
        unloaded_errors() at even positions, m.

    Returns
    -------
    peak_to_peak, left
        Largest less smallest value, and by how much the last closer look changed it, m.
    """
    cycles, positions = errors.shape
    peak_to_peak, left = 0.0, 0.0
    for sign in (1.0, -1.0):
        values, places, step = (sign * errors).max(axis=0), np.arange(positions) / positions, 1.0 / positions
        largest = before = float(values.max())
        for kept in CLOSER_LOOKS:
            centres = places[np.argsort(values)[-kept:]]
            places = np.unique((centres[:, None] + step * np.linspace(-1.0, 1.0, LOOKS)).ravel() % 1.0)
            values = (sign * unloaded_errors(pair_gaps(design, places), teeth, cycles)).max(axis=0)
            largest, before = max(largest, float(values.max())), largest
            step *= 2.0 / (LOOKS - 1)
        peak_to_peak, left = peak_to_peak + largest, left + largest - before
    return peak_to_peak, left


def orders(error: Array, length: int, count: int) -> Array:
    """Amplitudes (count,) m of orders 1, 2, ... of a gear with `length` teeth in errors (cycles, n)."""
    spectrum = 2.0 * np.abs(np.fft.rfft(error.ravel())) / error.size
    return spectrum[np.arange(1, count + 1) * (len(error) // length)]
