"""Face gears that bend in a machine: modes with the hub held, beside the hub's own coordinates.

Meshes stand still in space and bodies turn below them. A wave of n nodal diameters is described by what a
point in space sees of it: `z_s = z e^(i n W t)` with W the body's speed towards growing angles (that of a
lower gear is negative), as two real coordinates q_c + i q_s. With J = ((0, 1), (-1, 0)) they obey

    M = 1 x M,   C = 1 x D + 2 W J x (n M + g),   K = 1 x [K + W^2 (S - P - n^2 M - 2 n g)] + n W J x D

(Kronecker products). The last term is circulatory: damping sits in the steel and turns with it. Modes of
order 0 are single coordinates, along the axis or round it, which the Coriolis force couples. The hub's own
motions couple with orders 0 and 1 by masses alone, and its rotation with order 0 by the Coriolis force.
A hub that tilts about a point of its axis moves the whole body in order 1, with gyroscopic moments on itself
and on the modes.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.gear_body.reduced_body import ReducedBody
from facegear.transmission.layout import DOF_PER_BODY, Layout
from facegear.transmission.linear_model import LinearModel, Spin

TURN = np.array([[0.0, 1.0], [-1.0, 0.0]])
"""J, which turns the cosine and sine coordinates of a wave by a quarter of a period."""
X, Y, Z, THETA, TILT_X, TILT_Y = range(6)
"""Rows of the hub's motions in `Coordinates.mass_hub`."""


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
    slopes : (2, meshes of the gear, k)
        Of the rim below each, as `LinearModel.slopes`.
    lengths : (k,)
        Motion of the pitch point by a unit of each, m.
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


def coordinates(body: ReducedBody, sign: float, angles: Array, pressure_angle: float) -> Coordinates:
    """Return the elastic coordinates of a gear with meshes at given angles.

    Parameters
    ----------
    body : ReducedBody
        The gear's reduced body.
    sign : float
        1 for the upper, -1 for the lower gear, dimensionless.
    angles : (n,) array
        Angles of the meshes, rad.
    pressure_angle : float
        Pressure angle, rad.

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
    axial, around = body.mesh[:, mode]
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
        rows=flank_rows(order, part, axial, around, body.round[mode], sign, angles, pressure_angle),
        slopes=rim_slopes(order, part, axial, body.slopes[mode], body.round[mode], angles),
        lengths=np.maximum(np.hypot(axial, around), 1e-9 * np.hypot(axial, around).max(initial=1.0)),
    )


def _number_coordinates(body: ReducedBody) -> tuple[Integers, Integers, tuple[str, ...]]:
    """Return mode and part (0 cosine, 1 sine) of every coordinate, and their letters."""
    mode, part, letters = [], [], []
    for number, order in enumerate(body.order.tolist()):
        rank = number - int(np.searchsorted(body.order, order)) + 1
        for part_number, letter in enumerate(("c", "s") if order else ("",)):
            mode.append(number)
            part.append(part_number)
            letters.append(f"n{order} {rank}{letter}")
    return np.array(mode, np.int64), np.array(part, np.int64), tuple(letters)


def _order_zero(body: ReducedBody, mode: Integers) -> Array:
    """Coriolis terms between modes along the axis and round it: -2 g on the first, 2 g on the second."""
    order, turning = body.order[mode], body.round[mode] > 0.5
    are_order_zero = (order[:, None] == 0) & (order == 0)
    sign = np.where(turning, 1.0, -1.0)[:, None] * (turning[:, None] != turning)
    return np.asarray(2.0 * sign * are_order_zero * body.coriolis[np.ix_(mode, mode)])


def _hub_masses(hub: Array, order: Integers, cosine: Mask, turning: Array, sign: float) -> Array:
    """Return the masses between the hub's motions and the modes, (6, k).

    Heights count towards the teeth, against z of the upper gear; X = -y and Y = x of the hub. Tilts raise the
    teeth of the upper gear as those of a wave do, and lower those of the lower gear.
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
    """2 (n M + g) between hub and modes. For a tilt that is 2 int rho r W, about whatever point it turns."""
    terms, order = np.zeros((6, mode.size)), body.order[mode]
    terms[THETA] = np.where(order == 0, 2.0 * sign * (body.hub_spin * (1.0 - body.round))[mode], 0.0)
    tilt = np.where(order == 1, 2.0 * sign * (body.hub[1] + body.hub_spin)[mode], 0.0)
    terms[TILT_X] = np.where(cosine, 0.0, tilt)
    terms[TILT_Y] = np.where(cosine, -tilt, 0.0)
    return terms


def flank_rows(
    order: Integers,
    part: Integers,
    axial: Array,
    around: Array,
    turning: Array,
    sign: float,
    angles: Array,
    pressure_angle: float,
) -> Array:
    """Return the derivatives of the deflections of the flanks, as `Coordinates.rows`.

    The deflection d loses the motion of the pitch point along the force on the gear, -sin a axially and +-cos
    a round it.

    Parameters
    ----------
    order : (k,) array of int
        Number of waves round the gear of each coordinate, dimensionless.
    part : (k,) array of int
        0 for the cosine, 1 for the sine, dimensionless.
    axial : (k,) array
        Axial motion of the pitch point by a unit of each coordinate, m.
    around : (k,) array
        Its motion round the axis, m.
    turning : (k,) array
        1 for coordinates of order 0 that go round the axis, else 0; dimensionless.
    sign : float
        1 for the upper, -1 for the lower gear, dimensionless.
    angles : (n,) array
        Angles of the meshes, rad.
    pressure_angle : float
        Pressure angle, rad.

    Returns
    -------
    (2 n, k) array
        m for a unit of each coordinate, drive flanks first.
    """
    phase = order * angles[:, None]
    cos, sin = np.cos(phase), np.sin(phase)
    along = around * np.where(part == 0, sin, -cos)
    along = np.where((order == 0), around * turning, along)
    up = lifts(order, part, axial, turning, angles)
    separating_motion, tangential = np.sin(pressure_angle) * up, sign * np.cos(pressure_angle) * along
    return np.concatenate([separating_motion - tangential, separating_motion + tangential])


def lifts(order: Integers, part: Integers, axial: Array, turning: Array, angles: Array) -> Array:
    """Return the heights at some angles by coordinates whose waves have given amplitudes.

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
    order: Integers, part: Integers, axial: Array, radial: Array, turning: Array, angles: Array
) -> Array:
    """Return the slopes of the rim along the radius and round the axis by waves of heights and radial slopes.

    Parameters
    ----------
    order : (k,) array of int
        Number of waves round the gear of each coordinate, dimensionless.
    part : (k,) array of int
        0 for the cosine, 1 for the sine, dimensionless.
    axial : (k,) array
        Amplitude of the height of each wave, m.
    radial : (k,) array
        Amplitude of its slope along the radius, m/m.
    turning : (k,) array
        1 for coordinates of order 0 that go round the axis, else 0; dimensionless.
    angles : (n,) array
        Angles of the meshes, rad.

    Returns
    -------
    (2, n, k) array
        dW/dr in m/m and dW/dphi in m/rad for a unit of each coordinate.
    """
    phase = order * angles[:, None]
    around = order * axial * np.where(part == 0, -np.sin(phase), np.cos(phase))
    return np.stack([lifts(order, part, radial, turning, angles), around])


ATTACHED_FREQUENCY = 4.0
"""Frequency of an attached coordinate over that of the fastest mode kept of its gear.

The modes that it stands for lie above all that are kept. Its own motion changes an answer at f by the square
of f over its frequency. Larger factors cost shorter steps."""
ATTACHED_DAMPING = 0.1
"""Damping ratio of an attached coordinate, so that its own vibration dies out. It has no effect at rest."""


@dataclass(frozen=True, eq=False)
class ElasticGears:
    """The bodies of a machine whose face gears bend.

    Attributes
    ----------
    layout
        Bodies and mesh geometry.
    bodies
        Reduced bodies by the gears' numbers in the layout.
    attached
        Meshes whose compliance between the two flanks, which the modes leave out, has a coordinate of its own
        (residual attachment modes, after Rubin 1975): motion couples the flanks by it.
    """

    layout: Layout
    bodies: Mapping[int, ReducedBody]
    attached: tuple[int, ...] = ()

    def softening(self) -> Array:
        """Return the compliance of each mesh that neither modes nor attached coordinates hold.

        Returns
        -------
        Array
            Shape (meshes, 2, 2), m/N, as `residuals`. An attached coordinate takes the same part of each
            entry, so that what remains is diagonal.
        """
        left_out = self.residuals()
        for mesh in self.attached:
            left_out[mesh] = np.eye(2) * (left_out[mesh, 0, 0] - abs(left_out[mesh, 0, 1]))
        return left_out

    def residuals(self) -> Array:
        """Compute the compliance of each mesh that the modes leave out: the residual of MacNeal 1971.

        Returns
        -------
        Array
            Shape (meshes, 2, 2), m/N. Entry [m, i, j] is the motion of flank i against its own force by a
            unit force on flank j; 0 is the drive flank, 1 the back flank.
        """
        sine, cosine = np.sin(self.layout.pressure_angle), np.cos(self.layout.pressure_angle)
        directions = np.array([[-sine, cosine], [-sine, -cosine]])
        of_gears = {gear: body.residual_of_flanks(directions) for gear, body in self.bodies.items()}
        return np.array([of_gears.get(gear, np.zeros((2, 2))) for _, gear in self.layout.meshes])

    def __call__(self, base_model: LinearModel) -> LinearModel:
        """Return the model with the coordinates of every gear behind its own.

        The lumped damping stays on the coordinates that it is given for.
        """
        model = base_model
        for gear, body in self.bodies.items():
            model = self._with_gear(model, gear, body)
        residuals = self.residuals()
        for mesh in self.attached:
            model = self._with_attached(model, mesh, float(residuals[mesh, 0, 1]))
        return model

    def _with_attached(self, model: LinearModel, mesh: int, between: float) -> LinearModel:
        """Return the model with a coordinate of unit mass that couples the two flanks of a mesh.

        `between` is the motion of either flank by a unit force on the other, m/N.
        """
        layout, gear = self.layout, self.layout.meshes[mesh][1]
        modes = coordinates(self.bodies[gear], layout.gears[gear].sign, layout.angles, layout.pressure_angle)
        omega = ATTACHED_FREQUENCY * float(np.sqrt(modes.stiffness.max()))
        way = np.sqrt(abs(between)) * omega
        column = np.zeros((len(model.rows), 1))
        column[[mesh, mesh + len(layout.meshes)], 0] = way, np.copysign(way, between)
        damping_of_lumped_model = model.mass_damping + model.bearing_damping * omega**2
        spin = model.spin
        if spin is not None:
            turning = (spin.gyroscopic, spin.circulatory, spin.centrifugal)
            spin = Spin(*(append_block(matrix, np.zeros((1, 1))) for matrix in turning))
        return replace(
            model,
            labels=(*model.labels, f"attached:{layout.mesh_names[mesh]}"),
            mass=append_block(model.mass, np.eye(1)),
            stiffness=append_block(model.stiffness, np.array([[omega**2]])),
            rows=np.hstack([model.rows, column]),
            torques=np.append(model.torques, 0.0),
            forces=np.append(model.forces, 0.0),
            lengths=np.append(model.lengths, way),
            dampers=append_block(
                model.dampers, np.array([[2.0 * ATTACHED_DAMPING * omega - damping_of_lumped_model]])
            ),
            slopes=model.with_slopes(np.zeros(len(layout.meshes), dtype=bool), np.zeros((2, 0, 1))),
            spin=spin,
        )

    def _with_gear(self, model: LinearModel, gear: int, body: ReducedBody) -> LinearModel:
        layout, face_gear = self.layout, self.layout.gears[gear]
        elastic = coordinates(body, face_gear.sign, layout.angles, layout.pressure_angle)
        old, new = model.size, len(elastic.letters)
        speed = face_gear.sign * layout.pinion_teeth / layout.gear_teeth
        hub, mass_hub, gyroscopic_hub = _hub_terms(layout, gear, body, elastic)
        rigid, moments = _hub_tilts(layout, gear, body, old)
        mass = append_block(model.mass + rigid, np.eye(new), hub, mass_hub)
        stiffness = append_block(model.stiffness, np.diag(elastic.stiffness))
        damping_of_lumped_model = model.mass_damping * mass + model.bearing_damping * stiffness
        damping_of_lumped_model[:old, :old] = model.mass_damping * rigid
        dampers = append_block(model.dampers, np.diag(elastic.damping)) - damping_of_lumped_model
        meshes = np.array([g == gear for _, g in layout.meshes])
        rows = np.zeros((len(model.rows), new))
        rows[np.tile(meshes, 2)] = elastic.rows
        no_spin = Spin(*(np.zeros((old, old)) for _ in range(3)))
        before = no_spin if model.spin is None else model.spin
        turning = before.gyroscopic + speed * moments
        gyroscopic = append_block(turning, speed * elastic.gyroscopic, hub, speed * gyroscopic_hub)
        gyroscopic[old:, :old] *= -1.0
        return replace(
            model,
            labels=(*model.labels, *(f"{face_gear.name}:{letter}" for letter in elastic.letters)),
            mass=mass,
            stiffness=stiffness,
            rows=np.hstack([model.rows, rows]),
            torques=np.append(model.torques, np.zeros(new)),
            forces=np.append(model.forces, np.zeros(new)),
            lengths=np.append(model.lengths, elastic.lengths),
            dampers=dampers,
            slopes=model.with_slopes(meshes, elastic.slopes),
            spin=Spin(
                gyroscopic,
                append_block(before.circulatory, speed * elastic.circulatory),
                append_block(before.centrifugal, speed**2 * elastic.centrifugal),
            ),
        )


def _hub_terms(
    layout: Layout, gear: int, body: ReducedBody, elastic: Coordinates
) -> tuple[Integers, Array, Array]:
    """Coordinates (h,) of a gear's hub, and its masses and velocity terms (h, k) with those of the body.

    A tilt about a height h is that about height 0 and a motion sideways: it moves (-(zeta - h), zeta - h, r).
    """
    hub = DOF_PER_BODY * (len(layout.pinions) + gear) + np.arange(DOF_PER_BODY)
    if layout.gears[gear].body.tilt is None:
        return hub, elastic.mass_hub[:DOF_PER_BODY], elastic.gyroscopic_hub[:DOF_PER_BODY]
    height = layout.gears[gear].sign * _centre(layout, gear, body)
    masses = elastic.mass_hub.copy()
    masses[TILT_X] -= height * masses[Y]
    masses[TILT_Y] += height * masses[X]
    return np.append(hub, layout.first_tilts[gear] + np.arange(2)), masses, elastic.gyroscopic_hub


def _hub_tilts(layout: Layout, gear: int, body: ReducedBody, size: int) -> tuple[Array, Array]:
    """Masses between motion sideways and tilt of a hub, and its gyroscopic moments; each (size, size)."""
    masses, moments = np.zeros((2, size, size))
    face_gear = layout.gears[gear]
    if face_gear.body.tilt is not None:
        x, y = DOF_PER_BODY * (len(layout.pinions) + gear) + np.arange(2)
        tilt_x, tilt_y = layout.first_tilts[gear] + np.arange(2)
        off = face_gear.sign * float(body.moment - body.mass * _centre(layout, gear, body))
        masses[[y, tilt_x], [tilt_x, y]] = off
        masses[[x, tilt_y], [tilt_y, x]] = -off
        moments[[tilt_x, tilt_y], [tilt_y, tilt_x]] = face_gear.body.inertia, -face_gear.body.inertia
    return masses, moments


def _centre(layout: Layout, gear: int, body: ReducedBody) -> float:
    """Height (m) in the section of the point about which a hub tilts."""
    tilt = layout.gears[gear].body.tilt
    return float(body.pitch_height) - (0.0 if tilt is None else tilt.below)


def append_block(
    matrix: Array, corner: Array, at: Integers | None = None, border: Array | None = None
) -> Array:
    """Append a block on the diagonal of a symmetric matrix.

    Parameters
    ----------
    matrix : (n, n) array
        The matrix, any unit.
    corner : (k, k) array
        The block, in the same unit.
    at : (h,) array of int or None
        Rows of the matrix that are coupled with the block, as an index.
    border : (h, k) array or None
        Their coupling, in the same unit.

    Returns
    -------
    (n + k, n + k) array
        In the same unit.
    """
    old, new = len(matrix), len(corner)
    whole = np.zeros((old + new, old + new))
    whole[:old, :old], whole[old:, old:] = matrix, corner
    if at is not None and border is not None:
        whole[at, old:] = border
        whole[old:, at] = border.T
    return whole
