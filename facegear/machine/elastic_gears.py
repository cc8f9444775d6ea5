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

from facegear.arrays import Array, Integers
from facegear.machine.elastic_coordinates import TILT_X, TILT_Y, Coordinates, X, Y, coordinates, gear_forces
from facegear.machine.layout import DOF_PER_BODY, Layout
from facegear.machine.linear_model import LinearModel, Spin
from facegear.parts.reduced_body import ReducedBody

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
            Shape (meshes, 2, 2), m/N, as `residuals`. An attached coordinate takes the same part of either
            flank's own compliance, so that what remains is diagonal and not negative.
        """
        left_out = self.residuals()
        for mesh in self.attached:
            left_out[mesh] = np.diag(np.diagonal(left_out[mesh]) - _attached_ways(left_out[mesh]) ** 2)
        return left_out

    def residuals(self) -> Array:
        """Compute the compliance of each mesh that the modes leave out: the residual of MacNeal 1971.

        Returns
        -------
        Array
            Shape (meshes, 2, 2), m/N. Entry [m, i, j] is the motion of flank i against its own force by a
            unit force on flank j; 0 is the drive flank, 1 the back flank.
        """
        of_gears = {
            gear: body.residual_of_flanks(gear_forces(self.layout, gear))
            for gear, body in self.bodies.items()
        }
        return np.array([of_gears.get(gear, np.zeros((2, 2))) for _, gear in self.layout.meshes])

    def __call__(self, base_model: LinearModel) -> LinearModel:
        """Return the model with the elastic coordinates of every gear behind its own, then the attached
        ones.

        The lumped damping stays on the coordinates that it is given for; elastic ones have their own.
        """
        model = base_model
        for gear, body in self.bodies.items():
            model = self._with_gear(model, gear, body)
        residuals = self.residuals()
        for mesh in self.attached:
            model = self._with_attached(model, mesh, residuals[mesh])
        return model

    def _with_attached(self, model: LinearModel, mesh: int, residual: Array) -> LinearModel:
        """Return the model with a coordinate that couples the two flanks of a mesh.

        residual (2, 2): motion of flanks by unit forces on them that the modes leave out, m/N. The
        coordinate has unit mass and ATTACHED_FREQUENCY times the frequency of the gear's fastest mode; its
        flank rows are scaled such that its compliance between the flanks is that of `residual`.
        """
        layout, gear = self.layout, self.layout.meshes[mesh][1]
        fastest = 2.0 * np.pi * self.bodies[gear].frequency.max()
        omega = ATTACHED_FREQUENCY * float(fastest)
        ways = _attached_ways(residual) * omega
        column = np.zeros((len(model.rows), 1))
        column[[mesh, mesh + len(layout.meshes)], 0] = ways[0], np.copysign(ways[1], residual[0, 1])
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
            lengths=np.append(model.lengths, ways.max()),
            dampers=append_block(
                model.dampers, np.array([[2.0 * ATTACHED_DAMPING * omega - damping_of_lumped_model]])
            ),
            slopes=model.with_slopes(np.zeros(len(layout.meshes), dtype=bool)),
            spin=spin,
        )

    def _with_gear(self, model: LinearModel, gear: int, body: ReducedBody) -> LinearModel:
        """Return the model with the elastic coordinates of one face gear behind its own.

        gear: number of the gear. Mass, stiffness, flank rows, slopes and gyroscopic terms get blocks for
        them, coupled with the coordinates of the gear's hub; the gear's rigid mass stays on the hub's
        coordinates.
        """
        layout, face_gear = self.layout, self.layout.gears[gear]
        elastic = coordinates(body, face_gear.sign, layout.angles, gear_forces(layout, gear))
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


def _attached_ways(residual: Array) -> Array:
    """Return the motions (2,) of both flanks by an attached coordinate of unit stiffness, square root of m/N.

    Their product is the compliance between the flanks in `residual` (2, 2), m/N, without its sign; their
    squares are the same part of the flanks' own compliances.
    """
    first, second = np.diagonal(residual)
    ratio = np.sqrt(np.sqrt(first / second)) if first > 0.0 < second else 1.0
    return np.asarray(np.sqrt(abs(residual[0, 1])) * np.array([ratio, 1.0 / ratio]))


def _hub_terms(
    layout: Layout, gear: int, body: ReducedBody, elastic: Coordinates
) -> tuple[Integers, Array, Array]:
    """Return indices (h,) of the coordinates of a gear's hub, and masses and velocity terms (h, k) that
    couple these to the k elastic coordinates; h is 4, or 6 for a gear that tilts.

    A tilt about a height h is a tilt about height 0 and a motion sideways: it moves (-(zeta - h), zeta -
    h, r).
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
    """Return masses between motion sideways and tilt of a gear's hub, kg m, and its gyroscopic moments
    for 1 rad/s of the gear, kg m2; each (size, size) over the coordinates of the model, zero for a gear
    that does not tilt.
    """
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
    """Return the height (m), in the body's section, of the point about which a gear's hub tilts."""
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
