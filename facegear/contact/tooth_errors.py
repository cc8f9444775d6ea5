"""Transmission error from single teeth that deviate from the mean of their gear, tooth by tooth.

A tooth numbered m, from 0 in the order in which teeth come into mesh, is at the place s = u - m of its way
through the mesh, where u counts mesh cycles of its gear. Without load, the pair whose flanks come first
determines the relative position of the gears: the transmission error is the largest of those of all pairs.
Under load all pairs in contact share it. To first order, a deviation adds to the transmission error at a
given load its mean over the share that each place carries of a little more load (Maxwell's theorem: the
approach changes with a gap as the force there does with the load).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Arrays
from facegear.contact.lines import contact_gaps
from facegear.contact.nodal_loads import loads_by_tooth
from facegear.contact.teeth import ContactSide
from facegear.quantities import BODIES, Body
from facegear.teeth import face_gear, pinion
from facegear.teeth.closest import PAIRS
from facegear.teeth.design import PairDesign
from facegear.teeth.flank_shapes import DeviationGrid
from facegear.teeth.limits import common_face
from facegear.teeth.modifications import deviation, flank_depth, tip_edge_as_made
from facegear.teeth.opposite import tip_edge_feet
from facegear.teeth.placement import pinion_angle
from facegear.teeth.unloaded_contact import unloaded_motion

Teeth = Sequence[DeviationGrid | None]
"""Deviation of each tooth's flank from the mean of its gear, by the number of the tooth; None without."""

PLANES = 121
"""Planes across the pinion's axis in which the flanks' gaps are looked at: on 25 mm of face within 2 nm."""

CLOSER_LOOKS, LOOKS = (6, 2, 2), 9
"""Number of positions around which each closer search for an extreme is made, and number of samples around
each of them."""


def at_places(teeth: Teeth, positions: tuple[Array, Array]) -> Array:
    """Compute the deviations of all teeth at positions on the flank.

    Parameters
    ----------
    teeth : Teeth
        Deviation of each tooth; 0 for None.
    positions : tuple of arrays (...)
        Distances along face and profile, m, as in `DeviationGrid`.

    Returns
    -------
    (teeth, ...) array
        Deviations, m, in the sign of `DeviationGrid`.
    """
    different = list(dict.fromkeys(teeth))
    values = np.stack([deviation(grid, *positions) for grid in different])
    return values[[different.index(grid) for grid in teeth]]


def loaded_curves(
    design: PairDesign,
    sides: Mapping[Body, ContactSide],
    loads: Arrays,
    torque: float,
    teeth: Mapping[Body, Teeth],
    variant: int = 0,
) -> dict[Body, Array]:
    """Compute what the teeth of each gear add to the transmission error over one of its turns, under
    load.

    To first order a tooth adds the mean of its deviation over the nodal forces of a little more load.
    These forces are differences over neighbouring torques, with no load as one of them, interpolated at
    `torque`.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    sides : Mapping[Body, ContactSide]
        Contact surface of each gear.
    loads : Arrays
        Arrays LOAD_ARRAYS of stage contact.
    torque : float
        On the pinion, N m.
    teeth : Mapping[Body, Teeth]
        Deviations of each gear's teeth.
    variant : int
        Variant of the assembly errors in `loads`.

    Returns
    -------
    dict of arrays
        Transmission error (teeth * positions,) by gear, m, evenly over one turn; positive for added
        material.
    """
    cases = loads["variant"] == variant
    torques, positions = (np.unique(loads[name][cases]) for name in ("torque_n_m", "position"))
    nodes = np.concatenate([[0.0], torques]) / design.normal_arm
    slopes: Array = np.asarray(np.gradient(np.eye(nodes.size), nodes, axis=0))
    load_weights = [np.interp(torque / design.normal_arm, nodes, column) for column in slopes.T[1:]]
    curves = {}
    for body in BODIES:
        forces = loads_by_tooth(loads, body, variant=variant)
        values = at_places(teeth[body], node_places(design, body, sides[body]))
        curve = np.zeros((len(teeth[body]), positions.size))
        for pair, matrix in forces.items():
            tooth_error = (matrix[:, : values.shape[1]] @ values.T).reshape(torques.size, positions.size, -1)
            mean = np.tensordot(np.array(load_weights), tooth_error, axes=1)
            curve += np.roll(mean.T, pair, axis=0)
        curves[body] = curve.ravel()
    return curves


def node_places(design: PairDesign, body: Body, side: ContactSide) -> tuple[Array, Array]:
    """Compute the positions of a contact surface's nodes on the flank; fillet nodes are placed at the flank's
    end.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    body : Body
        Gear of the surface.
    side : ContactSide
        Contact surface.

    Returns
    -------
    tuple of arrays
        Distances (nodes,) along face and profile, m.
    """
    rows = side.flank_rows
    if body == "pinion":
        roll = side.u.copy()
        roll[rows:] = pinion.junction_roll(design, side.v[rows:])
        along, across = pinion.deviation_place(design, roll, side.v)
        return along.ravel(), across.ravel()
    points = face_gear.flank_point(design, side.u[:rows], side.v[:rows])
    radius = np.concatenate([np.hypot(points[..., 0], points[..., 1]), side.v[rows:]])
    to_tip = design.family.gear_tip.height(radius[:rows]) - points[..., 2]
    depth = np.concatenate([to_tip, flank_depth(design)(side.v[rows:])])
    return radius.ravel(), depth.ravel()


@dataclass(frozen=True, eq=False)
class PairGaps:
    """Least gaps (m) of the mean flanks, and where they are.

    `gap` (5 pairs, positions, 2, planes): in planes across the pinion's axis, and of points along the
    gear's tip edge; inf where there is none. `positions`: distances along face and profile on each gear,
    m. `mean`: transmission error (positions,) m at which the gaps are taken.
    """

    mean: Array
    gap: Array
    positions: Mapping[Body, tuple[Array, Array]]


def pair_gaps(design: PairDesign, cycle_positions: Array, planes: int = PLANES) -> PairGaps:
    """Compute the gaps at the unloaded transmission error, at several positions of the mesh cycle.

    Parameters
    ----------
    design : PairDesign
        Pair with its mean flanks.
    cycle_positions : (positions,) array
        In pitches, from 0 to below 1.
    planes : int
        Number of planes across the pinion's axis, and of points of the gear's tip edge.

    Returns
    -------
    PairGaps
        Gaps, m.

    Raises
    ------
    NotConverged
        Where the flanks' touch is not found.
    """
    positions, phi1 = len(cycle_positions), pinion_angle(design, cycle_positions)
    phi2, error = unloaded_motion(design, phi1)
    y = np.linspace(*common_face(design), planes)
    tooth = np.repeat(PAIRS, positions)
    placement = np.tile(phi1, PAIRS.size), np.tile(phi2, PAIRS.size), tooth.astype(float)
    roll, gap, points = contact_gaps(design, placement, y)
    radius = np.hypot(points[..., 0], points[..., 1])
    depth = design.family.gear_tip.height(radius) - points[..., 2]
    inside = gap, roll, y + 0.0 * roll, radius, depth
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
    """Return gap (m), roll (rad) and y (m) on the pinion, and radius and depth (m) on the gear, each (p,
    count).

    They are those of `count` points along the gear's tip edge, even in radius, in p placements; the depth
    is 0.
    """
    radius = np.linspace(design.face_gear.inner_radius, design.face_gear.outer_radius, count)
    edge = tip_edge_as_made(design, radius) * np.array([-1.0, 1.0, 1.0])
    feet = tip_edge_feet(design, edge, placement, None, design.module)
    top, bottom = pinion.tip_roll(design, feet.y) ** 2, pinion.junction_roll(design, feet.y) ** 2
    roll = np.sqrt(np.maximum(top - feet.flank * (top - bottom), 0.0))
    radii = np.broadcast_to(radius, roll.shape)
    return feet.gap, roll, feet.y, radii, np.zeros(roll.shape)


def unloaded_errors(gaps: PairGaps, teeth: Mapping[Body, Teeth], cycles: int) -> Array:
    """Compute the transmission error without load; pair j of cycle k consists of tooth k - j of both
    gears.

    It is the mean flanks' error plus the largest of (deviation of both teeth - gap) over all pairs and
    points.

    Parameters
    ----------
    gaps : PairGaps
        Gaps of the mean flanks.
    teeth : Mapping[Body, Teeth]
        Deviations of each gear's teeth.
    cycles : int
        Number of mesh cycles.

    Returns
    -------
    (cycles, positions) array
        Transmission error, m, positive where the gear is ahead (opposite in sign to
        `LoadedPosition.ste`).
    """
    values = {body: at_places(teeth[body], gaps.positions[body]) for body in BODIES}
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

    Around the positions with the largest and with the smallest values all mesh cycles are computed again,
    on a finer grid each time.

    Parameters
    ----------
    design : PairDesign
        Pair with its mean flanks.
    teeth : Mapping[Body, Teeth]
        Deviations of each gear's teeth.
    errors : (cycles, positions) array
        Result of `unloaded_errors` at even positions, m.

    Returns
    -------
    peak_to_peak, left
        Largest less smallest value, and by how much the last closer search raised it, m.
    """
    cycles, positions = errors.shape
    peak_to_peak, left = 0.0, 0.0
    for sign in (1.0, -1.0):
        values, cycle_positions, step = (
            (sign * errors).max(axis=0),
            np.arange(positions) / positions,
            1.0 / positions,
        )
        largest = before = float(values.max())
        for position_count in CLOSER_LOOKS:
            centres = cycle_positions[np.argsort(values)[-position_count:]]
            cycle_positions = np.unique(
                (centres[:, None] + step * np.linspace(-1.0, 1.0, LOOKS)).ravel() % 1.0
            )
            values = (sign * unloaded_errors(pair_gaps(design, cycle_positions), teeth, cycles)).max(axis=0)
            largest, before = max(largest, float(values.max())), largest
            step *= 2.0 / (LOOKS - 1)
        peak_to_peak, left = peak_to_peak + largest, left + largest - before
    return peak_to_peak, left


def orders(error: Array, length: int, count: int) -> Array:
    """Compute the amplitudes of orders 1, 2, ... a turn of a gear in a transmission error over whole
    turns.

    Parameters
    ----------
    error : (cycles, n) array
        Transmission error, m; the cycles are a multiple of `length`.
    length : int
        Number of teeth of the gear.
    count : int
        Number of orders.

    Returns
    -------
    (count,) array
        Amplitudes (half of peak to peak), m.
    """
    spectrum = 2.0 * np.abs(np.fft.rfft(error.ravel())) / error.size
    return spectrum[np.arange(1, count + 1) * (len(error) // length)]
