"""Coordinates of face gears that bend, and the rows by which meshes and bearings feel them."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.machine.layout import Layout
from facegear.machine.mesh_frames import rim_forces
from facegear.parts.reduced_body import ReducedBody, RimForces

TURN = np.array([[0.0, 1.0], [-1.0, 0.0]])
"""J, which turns the cosine and sine coordinates of a wave by a quarter of a period."""
X, Y, Z, THETA, TILT_X, TILT_Y = range(6)
"""Rows of the hub's motions in `Coordinates.mass_hub`."""


def gear_forces(layout: Layout, gear: int) -> RimForces:
    """Return the unit forces of the flanks of a gear's meshes on its rim.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    gear : int
        Number of the gear.

    Returns
    -------
    RimForces
        The same at every mesh of the gear, N for 1 N and rad.
    """
    middle = 0.0 if layout.kind is None else layout.kind.middle_turn
    return rim_forces(layout.flank_frames[gear], layout.gears[gear].sign, middle)


@dataclass(frozen=True, eq=False)
class Coordinates:
    """Elastic coordinates of one gear, k of them; SI units.

    Attributes
    ----------
    letters : (k,)
        `n2 1c`: nodal diameters, number of the mode, cosine or sine; `n0 1` has no such pair.
    mode : (k,)
        Which mode of the body each belongs to.
    mass_hub : (6, k)
        Masses between the hub's x, y, z, theta, tilt_x, tilt_y and them; tilts about height 0.
    stiffness, damping : (k,)
        Of each at rest.
    gyroscopic, circulatory, centrifugal : (k, k)
        For a body's speed of 1 rad/s, the last for its square.
    gyroscopic_hub : (6, k)
        Velocity terms on the hub's coordinates by theirs; those on theirs are the negative.
    rows : (2 meshes of the gear, k)
        Derivative of the deflections of its flanks, drive flanks first.
    slopes : (2 or 4, meshes of the gear, k)
        Slopes of the rim below each mesh by the coordinates, as `LinearModel.slopes`.
    lengths : (k,)
        Motion of the pitch point by a unit of each, in the directions in which flanks press, m.
    """

    letters: tuple[str, ...]
    mass_hub: Array
    stiffness: Array
    damping: Array
    gyroscopic: Array
    circulatory: Array
    centrifugal: Array
    gyroscopic_hub: Array
    rows: Array
    slopes: Array
    lengths: Array


def coordinates(body: ReducedBody, sign: float, angles: Array, forces: RimForces) -> Coordinates:
    """Return the elastic coordinates of a gear with meshes at given angles, from its modes.

    Matrices of rotation are those for a speed of the body of 1 rad/s, in the frame that stands still in
    space.

    Parameters
    ----------
    body : ReducedBody
        The gear's reduced body.
    sign : float
        1 for the upper, -1 for the lower gear, dimensionless.
    angles : (n,) array
        Angles of the meshes, rad.
    forces : RimForces
        Unit forces of the flanks of a mesh on the gear's rim.

    Returns
    -------
    Coordinates
        SI units.
    """
    mode, part, letters = _number_coordinates(body)
    order, cosine = body.order[mode], part == 0
    pair = TURN[part[:, None], part]
    is_same_part = (part[:, None] == part) * 1.0
    shift = np.diag(body.order.astype(float)) + body.coriolis
    n = body.order[:, None].astype(float)
    slowed = body.stiffening - np.diag(body.order.astype(float) ** 2) - 2.0 * n * body.coriolis
    axial, around, radial = motions = body.mesh[:, mode]
    lengths = np.hypot(np.hypot(axial, around), radial * forces.push_outwards)
    stiffness = (2.0 * np.pi * body.frequency[mode]) ** 2
    coriolis = 2.0 * pair * np.where(order[:, None] > 0, shift[np.ix_(mode, mode)], 0.0)
    coriolis += _order_zero(body, mode)
    circulatory = pair * order * body.damping[mode] * (mode[:, None] == mode)
    return Coordinates(
        letters=letters,
        mass_hub=_hub_masses(body.hub[:, mode], order, cosine, body.round[mode], sign),
        stiffness=stiffness,
        damping=body.damping[mode],
        gyroscopic=coriolis,
        circulatory=circulatory,
        centrifugal=is_same_part * slowed[np.ix_(mode, mode)],
        gyroscopic_hub=_hub_coriolis(body, mode, cosine, sign),
        rows=flank_rows(order, part, motions, body.round[mode], forces, angles),
        slopes=rim_slopes(order, part, motions, body.slopes[mode], body.round[mode], forces, angles),
        lengths=np.maximum(lengths, 1e-9 * lengths.max(initial=1.0)),
    )


def _number_coordinates(body: ReducedBody) -> tuple[Integers, Integers, tuple[str, ...]]:
    """Return mode (k,), part (k,) and letters of every coordinate of a gear.

    mode: index of the mode of `body`; part: 0 cosine, 1 sine; letters as in `Coordinates`. A mode of
    order 0 has one coordinate, any other a cosine and a sine.
    """
    mode, part, letters = [], [], []
    for number, order in enumerate(body.order.tolist()):
        rank = number - int(np.searchsorted(body.order, order)) + 1
        for part_number, letter in enumerate(("c", "s") if order else ("",)):
            mode.append(number)
            part.append(part_number)
            letters.append(f"n{order} {rank}{letter}")
    return np.array(mode, np.int64), np.array(part, np.int64), tuple(letters)


def _order_zero(body: ReducedBody, mode: Integers) -> Array:
    """Return Coriolis terms (k, k) between coordinates of order 0 along the axis and round it, for 1
    rad/s.

    A motion along the axis has -2 g by the velocity round it, a motion round it 2 g by the velocity along
    it. mode (k,): mode of each coordinate.
    """
    order, turning = body.order[mode], body.round[mode] > 0.5
    are_order_zero = (order[:, None] == 0) & (order == 0)
    sign = np.where(turning, 1.0, -1.0)[:, None] * (turning[:, None] != turning)
    return np.asarray(2.0 * sign * are_order_zero * body.coriolis[np.ix_(mode, mode)])


def _hub_masses(hub: Array, order: Integers, cosine: Mask, turning: Array, sign: float) -> Array:
    """Return the masses (6, k) between the hub's x, y, z, theta, tilt_x, tilt_y and the modes'
    coordinates.

    hub (2, k): Q of `ReducedBody.hub` for each coordinate; order (k,); cosine (k,): which are cosines;
    turning (k,): 1 for order 0 round the axis; sign: 1 upper, -1 lower gear. Heights count towards the
    teeth, against z of the upper gear; X = -y and Y = x of the hub. Tilts raise the teeth of the upper
    gear as those of a wave do, and lower those of the lower gear.
    """
    masses = np.zeros((6, order.size))
    zero, single = order == 0, order == 1
    masses[Z, zero] = -sign * (hub[0] * (1.0 - turning))[zero]
    masses[THETA, zero] = sign * (hub[1] * turning)[zero]
    masses[Y, single & cosine] = -hub[0, single & cosine]
    masses[X, single & ~cosine] = hub[0, single & ~cosine]
    masses[TILT_X, single & cosine] = sign * hub[1, single & cosine]
    masses[TILT_Y, single & ~cosine] = sign * hub[1, single & ~cosine]
    return masses


def _hub_coriolis(body: ReducedBody, mode: Integers, cosine: Mask, sign: float) -> Array:
    """Return velocity terms (6, k), 2 (n M + g), on the hub's coordinates by those of the modes, for 1
    rad/s.

    For a tilt that is 2 int rho r W, about whatever point it turns. mode (k,), cosine (k,), sign: as in
    `_hub_masses`.
    """
    terms, order = np.zeros((6, mode.size)), body.order[mode]
    terms[THETA] = np.where(order == 0, 2.0 * sign * (body.hub_spin * (1.0 - body.round))[mode], 0.0)
    tilt = np.where(order == 1, 2.0 * sign * (body.hub[1] + body.hub_spin)[mode], 0.0)
    terms[TILT_X] = np.where(cosine, 0.0, tilt)
    terms[TILT_Y] = np.where(cosine, -tilt, 0.0)
    return terms


def flank_rows(
    order: Integers, part: Integers, motions: Array, turning: Array, forces: RimForces, angles: Array
) -> Array:
    """Return the derivatives of the deflections of the flanks, as `Coordinates.rows`.

    A deflection loses the motion of the pitch point along the force on the gear.

    Parameters
    ----------
    order : (k,) array of int
        Number of waves round the gear of each coordinate, dimensionless.
    part : (k,) array of int
        0 for the cosine, 1 for the sine, dimensionless.
    motions : (3, k) array
        Motion of the pitch point along the axis, round it and along the radius by a unit of each coordinate,
        m.
    turning : (k,) array
        1 for coordinates of order 0 that go round the axis, else 0; dimensionless.
    forces : RimForces
        Unit forces of the flanks of a mesh.
    angles : (n,) array
        Angles of the meshes, rad.

    Returns
    -------
    (2 n, k) array
        m for a unit of each coordinate, drive flanks first.
    """
    rows = []
    for (axial, tangential, radial), turn in zip(forces.directions, forces.turns, strict=True):
        at = angles + turn
        phase = order * at[:, None]
        along = motions[1] * np.where(part == 0, np.sin(phase), -np.cos(phase))
        along = np.where(order == 0, motions[1] * turning, along)
        up, out = (lifts(order, part, motion, turning, at) for motion in (motions[0], motions[2]))
        rows.append(-(axial * up + tangential * along + radial * out))
    return np.concatenate(rows)


def lifts(order: Integers, part: Integers, axial: Array, turning: Array, angles: Array) -> Array:
    """Return the axial or radial motion of the rim at some angles for a unit of each coordinate.

    Order n has axial * cos(n angle) or axial * sin(n angle); order 0 has `axial`, or 0 where it goes
    round the axis.

    Parameters
    ----------
    order : (k,) array of int
        Number of waves round the gear of each coordinate, dimensionless.
    part : (k,) array of int
        0 for the cosine, 1 for the sine, dimensionless.
    axial : (k,) array
        Amplitude of each wave, any unit.
    turning : (k,) array
        1 for coordinates of order 0 that go round the axis, else 0; dimensionless.
    angles : (n,) array
        Angles, rad.

    Returns
    -------
    (n, k) array
        In the unit of `axial`.
    """
    phase = order * angles[:, None]
    up = axial * np.where(part == 0, np.cos(phase), np.sin(phase))
    return np.where(order == 0, axial * (1.0 - turning), up)


def rim_slopes(
    order: Integers,
    part: Integers,
    motions: Array,
    radial: Array,
    turning: Array,
    forces: RimForces,
    angles: Array,
) -> Array:
    """Return the slopes of the rim along the radius and round the axis below the middles of pinions' faces,
    and where flanks push outwards its motions there along the axis and along the radius.

    Parameters
    ----------
    order : (k,) array of int
        Number of waves round the gear of each coordinate, dimensionless.
    part : (k,) array of int
        0 for the cosine, 1 for the sine, dimensionless.
    motions : (3, k) array
        Motion of the pitch point along the axis, round it and along the radius by a unit of each coordinate,
        m.
    radial : (k,) array
        Amplitude of the slope of the height along the radius, m/m.
    turning : (k,) array
        1 for coordinates of order 0 that go round the axis, else 0; dimensionless.
    forces : RimForces
        Unit forces of the flanks of a mesh.
    angles : (n,) array
        Angles of the meshes, rad.

    Returns
    -------
    (2 or 4, n, k) array
        dW/dr in m/m, dW/dphi in m/rad, and the motions in m, for a unit of each coordinate.
    """
    at = angles + forces.middle
    phase = order * at[:, None]
    around = order * motions[0] * np.where(part == 0, -np.sin(phase), np.cos(phase))
    slopes = [lifts(order, part, radial, turning, at), around]
    if forces.push_outwards:
        slopes += [lifts(order, part, motion, turning, at) for motion in (motions[0], motions[2])]
    return np.stack(slopes)
