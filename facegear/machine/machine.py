"""Lumped model of a transmission with everything that drives it."""

from dataclasses import dataclass, fields, replace
from enum import StrEnum
from functools import cached_property
from itertools import chain
from typing import Any

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.by_content import kept_by_content
from facegear.errors import InvalidInput
from facegear.harmonics import Harmonics
from facegear.machine.casing import Casing
from facegear.machine.casing_coordinates import keep_slow_motions
from facegear.machine.disturbances import (
    Excitation,
    MeshFriction,
    friction_rows,
    rigid_rotation,
    without_rigid_rotation,
)
from facegear.machine.drive_line import DriveLine
from facegear.machine.imperfections import Imperfections, perfect
from facegear.machine.layout import DOF_PER_BODY, Layout
from facegear.machine.linear_model import Bodies, LinearModel, lumped_model
from facegear.machine.mesh_phases import PhaseConvention, mesh_phases
from facegear.machine.supports import add_tangents
from facegear.machine.torques import require_balance
from facegear.meshing.force_table import ForceTable
from facegear.meshing.law import MeshLaw
from facegear.number_format import count_noun


class OpenFlanks(StrEnum):
    """Mesh damping where flanks are apart: `always` acting as in equation (20), or `contact_only`.

    In contact the damper may pull flanks together that are about to part. `push_only` cuts the force of a
    contact, spring and damper together, at zero. `mesh_deflection` is the classical definition: one damper
    for each mesh acts on the deflection of its drive flank at all times (Kahraman and Singh 1990), where
    `always` gives half of the damper to each of the two flanks.
    """

    ALWAYS = "always"
    CONTACT_ONLY = "contact_only"
    PUSH_ONLY = "push_only"
    MESH_DEFLECTION = "mesh_deflection"

    @property
    def is_damped_when_open(self) -> bool:
        """Whether dampers act on open flanks, too: True for `always` and `mesh_deflection`."""
        return self in (OpenFlanks.ALWAYS, OpenFlanks.MESH_DEFLECTION)


@dataclass(frozen=True)
class Damping:
    """Damping of a machine, equation (21).

    mesh: damping along the line of action, N s/m; mass: lambda, factor of the mass matrix, 1/s; bearing:
    beta, factor of the bearing stiffness, s; open_flanks: where mesh damping acts.
    """

    mesh: float
    mass: float
    bearing: float
    open_flanks: OpenFlanks = OpenFlanks.ALWAYS


@dataclass(frozen=True, eq=False)
class FlankTables:
    """Load-dependent forces of the flanks at one face gear over the reference's mesh cycle.

    - drive: force of the drive flank by mesh position and compression
    - back: the same table for the drive flank of the mirrored pair, in which the back flank drives; users
      of the back flank call back.mirror
    """

    drive: ForceTable
    back: ForceTable


@dataclass(frozen=True, eq=False)
class Machine:
    """Lumped model of a transmission with everything that drives it.

    Attributes
    ----------
    layout
        Bodies and mesh geometry.
    torques : (bodies,)
        Torques on the bodies, N m.
    stiffness
        Stiffness of the reference mesh over a mesh cycle, N/m.
    error
        Transmission error e(t) of the reference mesh, a Fourier series in m.
    half_backlash : (meshes,)
        Half the backlash of each mesh, m.
    damping, phase_convention
        Damping of bodies, bearings and meshes; how meshes lag.
    error_lags : (meshes,)
        Lag of the error in mesh periods. If None, each mesh lags by its stiffness phase.
    imperfections
        Errors of single meshes and bodies; none by default.
    forces : (bodies, 3)
        External forces on the bodies along x, y, z, N; none by default.
    law
        Law of all contacts, as facegear.machine.flanks.mesh_contacts orders them. If None, force =
        stiffness * compression. With a law, `stiffness` is only its scale.
    tables
        Force tables of the flanks at each gear, from which the law is made where it depends on the load.
    friction
        Friction of the meshes. It disturbs the motion, and does nothing at rest.
    bodies
        Function that makes more of the bodies than rigid masses on springs.
    softening : (meshes, 2, 2)
        Compliance in series with the teeth of each mesh, m/N: motion of the drive and the back flank (rows)
        by a unit force on either (columns); none by default. Motion takes its diagonal alone, after
        `loaded_modes.machine_in_motion` has attached coordinates for the rest.
    drive_line
        Shafts of pinions that bend, and turning masses behind torsional springs.
    casing
        Casing that gives way below bearings; None for seats that stand still.
    directions
        Function that turns the forces of the meshes away from the normals of the ideal contact; none by
        default.
    excitations
        Periodic torques beside the mean torques; without effect at rest.
    flank_stiffness
        Stiffness over a mesh cycle of the drive and the back flank at each gear, N/m, where flanks differ;
        None: `stiffness` for all. That of a back flank is of the mirrored pair, in which it drives.
    has_phase_shifts
        Whether the place of a mesh in its cycle moves in motion as its pinion turns and floats.
    """

    layout: Layout
    torques: Array
    stiffness: Harmonics
    error: Harmonics
    half_backlash: Array
    damping: Damping
    phase_convention: PhaseConvention = PhaseConvention.GEOMETRIC
    error_lags: Array | None = None
    imperfections: Imperfections = None  # type: ignore[assignment]
    forces: Array = None  # type: ignore[assignment]
    law: MeshLaw | None = None
    tables: tuple[FlankTables, ...] | None = None
    friction: MeshFriction | None = None
    bodies: Bodies | None = None
    softening: Array | None = None
    drive_line: DriveLine | None = None
    casing: Casing | None = None
    directions: Bodies | None = None
    excitations: tuple[Excitation, ...] = ()
    flank_stiffness: tuple[tuple[Harmonics, Harmonics], ...] | None = None
    has_phase_shifts: bool = False

    def __post_init__(self) -> None:
        if self.imperfections is None:
            object.__setattr__(self, "imperfections", perfect(self.layout))
        if self.forces is None:
            object.__setattr__(self, "forces", np.zeros((len(self.layout.bodies), 3)))
        if self.casing is not None and self.casing.layout is not self.layout:
            object.__setattr__(self, "casing", replace(self.casing, layout=self.layout))
        require_balance(self.layout, self.torques)
        meshes = len(self.layout.meshes)
        for quantity, values in (
            ("lags of the transmission error", self.error_lags),
            ("half backlashes", self.half_backlash),
            ("errors of the meshes", self.imperfections.error),
            ("softening of the meshes", self.softening),
        ):
            if values is not None and len(values) != meshes:
                raise InvalidInput(
                    quantity, count_noun(len(values), "mesh", "meshes"), f"one for each of {meshes}"
                )
        for series in (self.stiffness, *chain.from_iterable(self.flank_stiffness or ())):
            minimum = series.minimum
            if minimum <= 0.0:
                raise InvalidInput(
                    "mesh stiffness", f"{minimum:.3g} N/m", "positive everywhere in the mesh cycle"
                )

    @cached_property
    def linear(self) -> LinearModel:
        """Linear model of the whole machine, the tangents of its rolling bearings included; of a casing with
        a frequency limit the slow motions alone are coordinates.
        """
        casing, line = self.casing, self.drive_line
        if casing is None or casing.frequency_limit is None:
            return add_tangents(self.linear_without_rolling, line, casing)
        seated = add_tangents(self._seated_model, line, casing)
        return self._with_bodies(keep_slow_motions(seated, casing.frequency_limit))

    @cached_property
    def linear_without_rolling(self) -> LinearModel:
        """Linear model without rolling bearings: `lumped_model`, extended by the drive line, then by the
        casing with all of its coordinates, then by `bodies` (gears that bend), then by `directions`, each if
        given. Its first coordinates are the layout's.
        """
        return self._with_bodies(self._seated_model)

    @cached_property
    def _seated_model(self) -> LinearModel:
        """Linear model of the layout with drive line and casing."""
        model = self.lumped_model if self.drive_line is None else self.drive_line(self.lumped_model)
        return model if self.casing is None else self.casing(model, self.drive_line)

    def _with_bodies(self, model: LinearModel) -> LinearModel:
        """Return a model extended by `bodies` and `directions`."""
        for add_part in (self.bodies, self.directions):
            model = model if add_part is None else add_part(model)
        return model

    @cached_property
    def lumped_model(self) -> LinearModel:
        """Linear model of the layout alone: rigid bodies on bearing springs with torques, forces and
        damping, without drive line and bending gears; layout.dof coordinates.
        """
        damping = (self.damping.mass, self.damping.bearing)
        return lumped_model(
            self.layout, self.torques, self.forces, damping, self.imperfections.bearing_clearance
        )

    @cached_property
    def without_errors(self) -> "Machine":
        """Machine without backlash, constant errors, runouts, pitch deviations and errors of single
        teeth.

        Stiffness factors, clocking, the series e(t) of single meshes and the places of pinions along their
        axes stay. Bearing clearances become 1 m where they are positive, which only marks the bearing, and
        stay 0 elsewhere. Machines that differ in these errors alone share one object, so that results which
        do not depend on them are cached once.
        """
        imperfections, rest = self.imperfections, tuple([getattr(self, name) for name in _WITHOUT_ERRORS])
        return _machine_without_errors(
            rest,
            imperfections.stiffness,
            imperfections.clocking,
            imperfections.series,
            imperfections.bearing_clearance > 0.0,
            imperfections.outwards,
        )

    @cached_property
    def static_machine(self) -> "Machine":
        """Machine without its drive line, if `DriveLine.extend_displacements` gives the static results
        with it from those without it; else this machine.
        """
        line = self.drive_line
        if line is None or self.casing is not None or not line.static_from_layout(self.lumped_model):
            return self
        return replace(self, drive_line=None)

    @property
    def torque_coordinates(self) -> Integers:
        """Index of the coordinate on which the torque of each body acts, (bodies,): the body's rotation,
        or that of the last turning mass of its chain in the drive line.
        """
        if self.drive_line is not None:
            return self.drive_line.torque_coordinates()
        return np.arange(self.lumped_model.size)[self.layout.spins]

    @cached_property
    def stiffness_by_flank(self) -> tuple[tuple[Harmonics, ...], tuple[Harmonics, ...]]:
        """Linear stiffness series (N/m) of the drive and of the back flank of each mesh over the reference's
        mesh cycle, not shifted by its phase and of a back flank as in `flank_stiffness`: the common series
        times the mesh's stiffness factor, in series with `own_softening` where there is one.
        """
        drive = self._meshes([self.stiffness] * len(self.layout.gears))
        if self.flank_stiffness is None:
            return drive, drive
        drive, back = (self._meshes(list(series)) for series in zip(*self.flank_stiffness, strict=True))
        return drive, back

    @property
    def mesh_stiffness(self) -> tuple[Harmonics, ...]:
        """Series of the drive flanks in `stiffness_by_flank`, N/m."""
        return self.stiffness_by_flank[0]

    def _meshes(self, series_of_gears: list[Harmonics]) -> tuple[Harmonics, ...]:
        """Return the stiffness series of each mesh, N/m, from that of one flank at each gear."""
        series_of_teeth = [
            series_of_gears[g].scale(float(factor))
            for (_, g), factor in zip(self.layout.meshes, self.imperfections.stiffness, strict=True)
        ]
        if self.own_softening is None:
            return tuple(series_of_teeth)
        return tuple(
            series.add_compliance(float(soft))
            for series, soft in zip(series_of_teeth, self.own_softening, strict=True)
        )

    @property
    def own_softening(self) -> Array | None:
        """Compliance of the body behind a flank under that flank's force alone, (meshes,), m/N.

        It is entry [0, 0] of `softening`, equal for both flanks. Motion puts it in series with the teeth;
        for the coupling between the flanks see `loaded_modes.machine_in_motion`.
        """
        return None if self.softening is None else self.softening[:, 0, 0]

    @property
    def mean_stiffness(self) -> Array:
        """Mean stiffness of the drive flank of each mesh, (meshes,), N/m."""
        return np.array([series.mean for series in self.mesh_stiffness])

    @property
    def mean_flank_stiffness(self) -> Array:
        """Mean stiffness of each flank, (2 meshes,), N/m, drive flanks first."""
        drive, back = self.stiffness_by_flank
        return np.array([series.mean for series in (*drive, *back)])

    @property
    def constant_stiffness(self) -> bool:
        """Whether the force of every contact is proportional to its compression: neither `law` nor
        `tables` is given.
        """
        return self.law is None and self.tables is None

    @property
    def pushes(self) -> Array:
        """Directions (rows, n) of all forces that excite motion beside those of the flanks.

        First the external forces, normalised; then one row for each mesh and each part of friction
        (`disturbances.parts_of`), where there is friction; then the normalised `phase_rows`, where phases
        shift; then one normalised row for each periodic torque, without its rigid rotation. Rows that are
        zero are left out, except those of friction.
        """
        linear = self.linear
        pushes = [np.zeros((0, linear.size))]
        if linear.forces.any():
            pushes.append(linear.forces[None] / np.linalg.norm(linear.forces))
        if self.friction is not None:
            rows = friction_rows(self.layout, linear, self.drive_line)
            pushes.append(rows.reshape(-1, linear.size))
        if self.has_phase_shifts:
            pushes.append(self.phase_rows / np.linalg.norm(self.phase_rows))
        for excitation in self.excitations:
            force = self.straining_torque(excitation.body)
            if (size := float(np.linalg.norm(force))) > 0.0:
                pushes.append(force[None] / size)
        return np.concatenate(pushes)

    @property
    def phase_rows(self) -> Array:
        """Derivatives (flanks, n) of the places of the flanks in the mesh cycle by the coordinates, rad for
        a unit: the turn and the float of the pinion, as lengths along the drive flank's line of action over
        the base pitch. The common rotation of all bodies, which is even, moves no place.
        """
        layout, linear = self.layout, self.linear
        rows = np.zeros((2, len(layout.meshes), linear.size))
        for mesh, (i, g) in enumerate(layout.meshes):
            for row, frame in zip(rows[:, mesh], layout.flank_frames[g], strict=True):
                row[DOF_PER_BODY * i + 2] = frame.turn_by_place
                row[DOF_PER_BODY * i + 3] = layout.pinion_arm
        rotation = rigid_rotation(layout, linear, self.drive_line)
        flanks = rows.reshape(-1, linear.size) * (2.0 * np.pi / layout.base_pitch)
        return np.array([without_rigid_rotation(row, linear, rotation) for row in flanks])

    def straining_torque(self, body: int) -> Array:
        """Return the generalised force of a unit torque on a body, less the inertia force of the common
        rotation.

        The common rotation of all bodies strains no mesh and no bearing; `without_rigid_rotation` takes
        it off.

        Parameters
        ----------
        body : int
            Number of the body in the layout. The torque acts on its entry of `torque_coordinates`.

        Returns
        -------
        (n,) array
            Generalised force on all coordinates for a torque of 1 N m, N and N m.
        """
        torque = np.zeros(self.linear.size)
        torque[self.torque_coordinates[body]] = 1.0
        rotation = rigid_rotation(self.layout, self.linear, self.drive_line)
        return without_rigid_rotation(torque, self.linear, rotation)

    @cached_property
    def phases(self) -> Array:
        """Lag of each mesh's stiffness behind the reference mesh, mesh periods in [0, 1), shape
        (meshes,).
        """
        return mesh_phases(self.layout, self.phase_convention, self.imperfections.clocking)

    @property
    def error_phases(self) -> Array:
        """Lag of each mesh's transmission error, (meshes,), mesh periods: `error_lags` if given, else
        `phases`.
        """
        return self.phases if self.error_lags is None else self.error_lags


_WITHOUT_ERRORS = tuple(
    [part.name for part in fields(Machine) if part.name not in ("half_backlash", "imperfections")]
)
"""Names of the fields that are the same in `Machine.without_errors`."""


@kept_by_content(8)
def _machine_without_errors(
    rest: tuple[Any, ...],
    stiffness: Array,
    clocking: Array,
    series: dict[int, Harmonics],
    with_clearance: Mask,
    outwards: Array,
) -> Machine:
    """Return the machine with given fields, without backlash, constant and slow errors; equal arguments
    share it.

    `rest` holds the values of the fields `_WITHOUT_ERRORS`, in that order; stiffness (meshes,) are
    factors; clocking (pinions,), pitches; series: e(t) of single meshes by index; with_clearance
    (pinions,): bearings that get a clearance of 1 m; outwards (pinions,): their places, m.
    """
    field_values = dict(zip(_WITHOUT_ERRORS, rest, strict=True))
    flaws = replace(
        perfect(field_values["layout"]),
        stiffness=stiffness,
        clocking=clocking,
        series=series,
        bearing_clearance=np.where(with_clearance, 1.0, 0.0),
        outwards=outwards,
    )
    return Machine(**field_values, half_backlash=np.zeros(stiffness.size), imperfections=flaws)


def mesh_frequency(layout: Layout, speed_rpm: float) -> float:
    """Return the mesh frequency at a pinion speed: pinion teeth * speed / 60.

    Parameters
    ----------
    layout : Layout
        Tooth numbers.
    speed_rpm : float
        Speed of the pinions, rpm.

    Returns
    -------
    float
        Hz.
    """
    return layout.pinion_teeth * speed_rpm / 60.0
