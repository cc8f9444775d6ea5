"""Forces on the bodies beside the meshes' springs: periodic torques, and friction of the meshes.

Friction of the meshes as forces on the bodies, in first order a part of each flank's elastic force. The
forces of friction at all points of the contact of a flank, with the signs of sliding that they have at each
place of the mesh cycle, make one force on the pinion and two moments about the axes; of teeth that are not
spur teeth, the whole wrench. Each part is the elastic force of the flank times a ratio that depends on the
place in the mesh cycle alone. Vibration changes the force, but not the direction of sliding.

The machine turns evenly: the output gives way by the torque that friction takes, at every instant.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.harmonics import Harmonics, stacked_values
from facegear.machine.drive_line import DriveLine
from facegear.machine.layout import DOF_PER_BODY, Layout
from facegear.machine.linear_model import LinearModel

WHOLE = 1e-9
"""Distance of a frequency over that of the mesh from a whole number that counts as rounding."""


@dataclass(frozen=True)
class Excitation:
    """Torque amplitude * cos(order * turns + phase) beside the mean torque of a body, `turns` its
    rotation in rad.

    Attributes
    ----------
    body : int
        Its number in the layout; the torque acts where the body's mean torque acts.
    order : float
        Vibrations in one turn of the body, dimensionless.
    teeth : int
        Number of teeth of the body.
    amplitude : float
        N m.
    phase : float
        At the start, rad.
    """

    body: int
    order: float
    teeth: int
    amplitude: float
    phase: float = 0.0

    @property
    def of_mesh(self) -> float:
        """Frequency over that of the mesh: order / teeth, dimensionless."""
        return self.order / self.teeth

    @property
    def mesh_harmonic(self) -> int:
        """Number k >= 1 of the mesh harmonic with this frequency.

        Raises InvalidInput where `of_mesh` is no whole number, as motion in time repeats with the mesh
        period.
        """
        nearest = round(self.of_mesh)
        if nearest < 1 or abs(self.of_mesh - nearest) > WHOLE * nearest:
            multiples = (
                f"an order that is a multiple of {self.teeth}, the teeth of its body, for motion in time, "
                "which repeats with the mesh; vibration at the orders of turns (shaft_orders) takes every one"
            )
            raise InvalidInput("order of an excitation", self.order, multiples)
        return nearest


def rigid_rotation(layout: Layout, linear: LinearModel, line: DriveLine | None) -> Array:
    """Return the common rotation of all bodies, which no mesh and no bearing feels.

    Parameters
    ----------
    layout : Layout
        Bodies, with geometric meshes.
    linear : LinearModel
        Their coordinates.
    line : DriveLine or None
        Turning masses behind torsional springs, which turn with their body.

    Returns
    -------
    (n,) array
        Displacement of every coordinate for a pinion rotation of 1: 1 for each pinion, pinion teeth /
        gear teeth for each gear, 0 for all other coordinates; dimensionless.
    """
    pinions = len(layout.pinions)
    ratio = layout.pinion_teeth / layout.gear_teeth
    turns = np.array([1.0 if body < pinions else ratio for body in range(len(layout.bodies))])
    rotation = np.zeros(linear.size)
    rotation[: layout.dof][layout.spins] = turns
    for body, first, chain in () if line is None else line.chains():
        rotation[first : first + len(chain)] = turns[body]
    return rotation


def without_rigid_rotation(force: Array, linear: LinearModel, rotation: Array) -> Array:
    """Take off a force the part that accelerates all bodies together, which strains nothing.

    It is f - M r (r . f) / (r . M r) with r the rigid rotation.

    Parameters
    ----------
    force : (n,) array
        Generalised force f, N and N m.
    linear : LinearModel
        Coordinates and masses M.
    rotation : (n,) array
        `rigid_rotation` r, dimensionless.

    Returns
    -------
    (n,) array
        N and N m: the rest, in balance with the inertia of all bodies.
    """
    inertia = linear.momentum(rotation)
    return np.asarray(force - inertia * (rotation @ force) / (rotation @ inertia))


PARTS = ("tangential", "along_pinion_axis", "along_gear_axis", "pinion_lever", "face_gear_lever")
"""Ratios of friction to the elastic force of a flank.

Force on the pinion along the tangent of the face gear, along the pinion's axis (away from the gear's) and
along the gear's axis, in the frame of the upper gear's mesh, and the moments on pinion and face gear about
their own axes, positive as they turn, over the arms of the elastic force.
"""
TILTS = ("pinion_tilt_x", "pinion_tilt_y")
"""Ratios that come after PARTS for teeth that are not spur teeth at right angles, in the frame of the upper
gear's mesh: moments on the pinion about the middle of its face, about the tangent and about the direction
square to tangent and pinion's axis (towards the gear), over the pinion's arm of the elastic force."""
MIRROR = np.array([1.0, -1.0, -1.0, 1.0, 1.0, -1.0, 1.0])
"""Signs of PARTS and TILTS on the mirror image that turns the other way."""


def parts_of(layout: Layout) -> tuple[str, ...]:
    """Return the names of the ratios of friction: PARTS, with TILTS for all teeth but spur ones.

    Parameters
    ----------
    layout : Layout
        Mesh geometry.

    Returns
    -------
    tuple of str
        Names in the order of the ratios.
    """
    return PARTS if layout.kind is None else (*PARTS, *TILTS)


@dataclass(frozen=True, eq=False)
class MeshFriction:
    """Ratios of friction to elastic force as Fourier series over the reference's mesh cycle.

    Attributes
    ----------
    ratios : (meshes, parts, 2, orders) array
        Series of the drive flank of each mesh without its lag, parts as `parts_of`, sine part first;
        dimensionless.
    back : (meshes, parts, 2, orders) array or None
        Series of the drive flank of the mirrored pair, in which the back flank drives; None where it is that
        of the pair itself.
    """

    ratios: Array
    back: Array | None = None

    def flank_ratios(self, lags: Array) -> Array:
        """Return the series of all drive flanks, then all back flanks, each with its lag.

        The back flank is the mirror image of the mirrored pair's drive flank that turns the other way: its
        tangential force, the moments about the axes and that about the direction square to tangent and
        pinion's axis are those at the mirrored place, the other parts are opposite.

        Parameters
        ----------
        lags : (2 meshes,) array
            Lag of each flank, drive flanks first, mesh periods.

        Returns
        -------
        (2 meshes, parts, 2, orders) array
            Dimensionless.
        """
        mirror_ratios = self.ratios if self.back is None else self.back
        parts = self.ratios.shape[1]
        mirror = MIRROR[:parts, None, None] * np.array([-1.0, 1.0])[:, None]
        flank_series = np.concatenate([self.ratios, mirror_ratios * mirror])
        lagged_series = np.empty_like(flank_series)
        for flank, lag in zip(np.ndindex(flank_series.shape[:2]), np.repeat(lags, parts), strict=True):
            series = Harmonics(*flank_series[flank]).shift(float(lag))
            lagged_series[flank] = series.sine, series.cosine
        return lagged_series

    def loss(self, lags: Array, cycles: Array, forces: Array) -> Array:
        """Return the force that friction takes along the base circles: power lost over their speed.

        It is minus the sum of both lever ratios times the elastic force of the flank. The machine turns
        evenly.

        Parameters
        ----------
        lags : (2 meshes,) array
            Lag of each flank, drive flanks first, mesh periods.
        cycles : (K,) array
            Positions, mesh periods.
        forces : (K, meshes) array
            Elastic forces, those of the drive flank positive and those of the back flank negative, N.

        Returns
        -------
        (K, meshes) array
            N; positive where power is lost.
        """
        levers = -self.flank_ratios(lags)[:, 3:5].sum(axis=1)
        drive, back = np.split(stacked_values(levers, cycles), 2, axis=1)
        return np.maximum(forces, 0.0) * drive + np.maximum(-forces, 0.0) * back


@dataclass(frozen=True, eq=False)
class FrictionWrench:
    """Force and moment on a pinion for one of a part of friction; the gear feels the opposite.

    Vectors (3,) are along tangent, gear axis (from the lower to the upper gear) and outwards.

    Attributes
    ----------
    part : int
        Number of the part.
    point
        Where the force acts, from the gear's axis and over the pitch plane, m.
    force, moment
        Dimensionless, and m about the point.
    """

    part: int
    point: Array
    force: Array
    moment: Array

    def gear_tilts(self, angle: float, height: float) -> Array:
        """Return the moments on the gear about a point of its axis.

        Parameters
        ----------
        angle : float
            Distribution angle of the pinion, rad.
        height : float
            Height of the point over the pitch plane, along the gear axis, m.

        Returns
        -------
        (2,) array
            About the gear's x and y, m.
        """
        about = self.moment + np.cross(self.point - [0.0, height, 0.0], self.force)
        return np.asarray(-(about[0] * _along(angle) + about[2] * _away(angle)))


def _along(angle: float) -> Array:
    """Return the direction (2,) of the tangent in the gears' frame at a distribution angle (rad)."""
    return np.array([np.cos(angle), np.sin(angle)])


def _away(angle: float) -> Array:
    """Return the direction (2,) outwards in the gears' frame at a distribution angle (rad)."""
    return np.array([np.sin(angle), -np.cos(angle)])


def friction_rows(
    layout: Layout, linear: LinearModel, line: DriveLine | None, at_output: bool = True
) -> Array:
    """Return the generalised forces of the parts of friction, equal for both flanks.

    Friction of a flank is the sum over parts of ratio * elastic force * row. A spur pinion without a bearing
    along its axis gets no axial force, and spur pinions are not tilted.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    linear : LinearModel
        Coordinates of the machine.
    line : DriveLine or None
        Pinions that tilt.
    at_output : bool
        Whether a moment on the output gear balances each moment, so that none turns the machine as a
        whole.

    Returns
    -------
    (meshes, parts, n) array
        Force on each coordinate for 1 N of each part, N/N, and m for moments; parts as `parts_of`.
    """
    rows = np.zeros((len(layout.meshes), len(parts_of(layout)), linear.size))
    # Bodies that tilt with the seats of their casing alone.
    seat_tilts = None if linear.seat_tilts is None else linear.over_all(linear.seat_tilts)
    output = DOF_PER_BODY * (len(layout.pinions) + layout.output) + 3
    for row, (pinion, g) in zip(rows, layout.meshes, strict=True):
        gear, side, angle = len(layout.pinions) + g, layout.gears[g].sign, float(layout.angles[pinion])
        has_axial_bearing = layout.kind is not None or layout.pinions[pinion].body.bearing[2] > 0.0
        lean = np.eye(3) if layout.kind is None else layout.kind.lean
        for wrench in _wrenches(layout, side):
            part = row[wrench.part]
            across, height, outwards = wrench.force
            part[DOF_PER_BODY * pinion : DOF_PER_BODY * pinion + 3] = lean @ wrench.force
            part[DOF_PER_BODY * pinion + 2] *= float(has_axial_bearing)
            part[DOF_PER_BODY * gear : DOF_PER_BODY * gear + 2] = -(
                across * _along(angle) + outwards * _away(angle)
            )
            part[DOF_PER_BODY * gear + 2] = -height
            if g in layout.first_tilts:
                tilt = layout.gears[g].body.tilt
                below = 0.0 if tilt is None else side * tilt.below
                part[layout.first_tilts[g] + np.arange(2)] = wrench.gear_tilts(angle, below)
            if layout.kind is not None and line is not None and pinion in line.tilting:
                part[line.tilts(pinion)] = (lean @ wrench.moment)[:2]
            if seat_tilts is not None:
                part += wrench.gear_tilts(angle, 0.0) @ seat_tilts[gear]
                part += (lean @ wrench.moment)[:2] @ seat_tilts[pinion]
        row[3, DOF_PER_BODY * pinion + 3] = layout.pinion_arm
        row[4, DOF_PER_BODY * gear + 3] = layout.gear_arm
        if at_output:
            row[3:5, output] -= layout.gear_arm
    return rows


def _wrenches(layout: Layout, side: float) -> list[FrictionWrench]:
    """Return the wrenches of the parts of friction at the meshes of a gear, without moments about the axes of
    both bodies, which `friction_rows` adds.

    Forces of spur teeth act at the pitch point. Other forces along the axes of pinion and gear are
    projections of one force. Each therefore acts along the direction square to the other axis. side: 1 for
    the upper, -1 for the lower gear.
    """
    zero, kind = np.zeros(3), layout.kind
    if kind is None:
        point = np.array([0.0, 0.0, layout.mesh_radius])
        forces = np.diag([side, side, 1.0])[[0, 2, 1]]
        return [FrictionWrench(part, point, force, zero) for part, force in enumerate(forces)]
    point, arm = np.array(kind.face_middle(side)), layout.pinion_arm
    across, axis = kind.lean[1:]
    cosine, sine = axis[1:]
    forces_and_moments = {
        0: (np.array([side, 0.0, 0.0]), zero),
        1: (np.array([0.0, 0.0, 1.0 / sine]), zero),
        2: (np.array([0.0, side, -side * cosine / sine]), zero),
        3: (zero, -arm * axis),
        5: (zero, np.array([side * arm, 0.0, 0.0])),
        6: (zero, side * arm * across),
    }
    return [FrictionWrench(part, point, *vectors) for part, vectors in forces_and_moments.items()]
