"""A casing that gives way below the bearings of a machine: seats and modes as coordinates behind the others.

A bearing strains by the motion of its body less the motion of its seat, v = q - H u, with u the coordinates
of the casing. The casing's own stiffness acts on u, so that K = P^T blockdiag(K_bearings, K_casing) P with P
= (1 -H; 0 1). At rest the unknowns v and u uncouple all bearings, which is what the compiled solver takes.

A gear that has no tilts of its own tilts with its seat. Without that it would hold the overturning moments of
its meshes against the ground, and the feet would not carry the applied torques.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from facegear.arrays import Array, Integers
from facegear.casing.mounted import MountedCasing
from facegear.casing.reduction import MOTIONS as SEAT_MOTIONS
from facegear.errors import InvalidInput
from facegear.machine.casing_coordinates import CASING, SeatMotion, casing_start
from facegear.machine.drive_line import DriveLine
from facegear.machine.kinematics import tilt_row
from facegear.machine.layout import DOF_PER_BODY, Layout
from facegear.machine.linear_model import LinearModel, Spin
from facegear.parts.shafts import SeatedShaft
from facegear.rigid_body import MOTIONS, carry_motion


@dataclass(frozen=True, eq=False)
class Casing:
    """A casing below the bodies of a machine; called with a linear model it adds its coordinates.

    Attributes
    ----------
    layout : Layout
        Bodies and mesh geometry.
    mounted : MountedCasing
        The casing on its feet.
    bearing_seats : mapping of int to tuple of str
        Seats of the bearings by the number of the body in the layout: one name for a body on a single
        bearing, one for each bearing of a shaft; empty text for the ground. Bodies that are left out stand
        on the ground.
    shafts : mapping of int to SeatedShaft
        Shafts of pinions by their numbers, for those on several bearings given by numbers or matrices.
    bearing_places : mapping of int to array
        Places of the bearings of these shafts along the pinion's axis from the gears' axis, (bearings,), m.
    frequency_limit : float or None
        Frequency, Hz, up to which motions of the casing are coordinates, while the others follow statically,
        as motion in time takes them (`casing_coordinates.keep_slow_motions`). None: seats and modes of the
        mounted casing are the coordinates.
    """

    layout: Layout
    mounted: MountedCasing
    bearing_seats: Mapping[int, tuple[str, ...]]
    shafts: Mapping[int, SeatedShaft]
    bearing_places: Mapping[int, Array]
    frequency_limit: float | None = None

    def __post_init__(self) -> None:
        for names in self.bearing_seats.values():
            for name in names:
                if name and name not in self.mounted.seats:
                    seat_names = ", ".join(self.mounted.seats)
                    raise InvalidInput("seat of a bearing", name, f"one of the casing's seats: {seat_names}")

    @property
    def size(self) -> int:
        """Number of coordinates of the casing."""
        return self.mounted.size

    @cached_property
    def tilting_with_seat(self) -> tuple[int, ...]:
        """Numbers of the gears that tilt with their seat: seated ones without tilts of their own."""
        first = len(self.layout.pinions)
        return tuple(
            g
            for g, gear in enumerate(self.layout.gears)
            if gear.body.tilt is None and any(self.bearing_seats.get(first + g, ()))
        )

    def without_modes(self) -> "Casing":
        """Return the casing without its modes, for questions at rest.

        Returns
        -------
        Casing
            With all motions of seats and feet as coordinates.
        """
        if not self.mounted.modes and self.frequency_limit is None:
            return self
        return replace(self, mounted=self.mounted.without_modes(), frequency_limit=None)

    @cached_property
    def strain_between_seats(self) -> Array:
        """Stiffness (size, size) of shafts that several seats strain with no load on the pinion, SI units."""
        stiffness = np.zeros((self.size, self.size))
        for body, shaft in self.shafts.items():
            motions = self.ring_motions(body)
            stiffness += motions.T @ shaft.strain @ motions
        return 0.5 * (stiffness + stiffness.T)

    def base_motions(self, body: int) -> Array:
        """Return the motion that the casing gives a body whose bearings carry nothing.

        Parameters
        ----------
        body : int
            Number of the body in the layout.

        Returns
        -------
        (5, size) array
            x, y, z, tilt_x, tilt_y in the body's own axes, of a pinion at its middle and of a gear on its
            axis, m and rad for a unit of each coordinate of the casing; zero for a body on the ground.
        """
        if body in self.shafts:
            return np.asarray(self.shafts[body].motion @ self.ring_motions(body))
        if body in self.bearing_places:
            # A shaft on rolling bearings: as a rigid shaft best follows its rings.
            distances = self.bearing_places[body] - self.layout.pinion_middle
            rigid = np.concatenate([carry_motion(float(distance)) for distance in distances])
            return np.asarray(np.linalg.lstsq(rigid, self.ring_motions(body))[0])
        names = self.bearing_seats.get(body, ())
        return self._motion_on(names[0], body, None) if names else np.zeros((MOTIONS, self.size))

    def ring_motions(self, body: int) -> Array:
        """Return the motions of the outer rings of a pinion's shaft by the casing.

        Parameters
        ----------
        body : int
            Number of the pinion.

        Returns
        -------
        (5 bearings, size) array
            m and rad for a unit of each coordinate of the casing; 0 for bearings on the ground.
        """
        distances = self.bearing_places[body]
        return np.concatenate(
            [
                self._motion_on(name, body, float(distance))
                for name, distance in zip(self.bearing_seats[body], distances, strict=True)
            ]
        )

    def _motion_on(self, seat: str, body: int, distance: float | None) -> Array:
        """Return the motion (5, size) that a seat gives a point of a body's axis, in the body's own axes.

        distance: of the point along a pinion's axis from the gears' axis, m; None for the pinion's middle, or
        the point on the gear's axis to which its motions belong.
        """
        motion = np.zeros((MOTIONS, self.size))
        if not seat:
            return motion
        axes, point = body_axes(self.layout, body, distance)
        at = self.mounted.seats[seat]
        number = at.start // SEAT_MOTIONS
        arm = point - self.mounted.seat_positions[number]
        x, y, z = arm
        around = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
        motion[:3, at] = axes @ np.hstack([np.eye(3), around])
        motion[3:, at.start + 3 : at.stop] = axes[:2]
        return motion

    def strain_loads(self, line: DriveLine, motion: Array) -> Array:
        """Return the loads of shafts on their bearings from motions of their seats against each other.

        Parameters
        ----------
        line : DriveLine
            Drive line with the shafts.
        motion : (K, size) array
            Motions of the casing, m and rad.

        Returns
        -------
        (K, bearings, 5) array
            N and N m, bearings pinion by pinion; 0 for shafts that the ground or a single seat carries.
        """
        loads = [np.zeros((len(motion), 0, MOTIONS))]
        for pinion, seat in sorted(line.seats.items()):
            rings = np.zeros((len(motion), len(seat.shaft.reactions), MOTIONS))
            if pinion in self.shafts:
                load = motion @ self.ring_motions(pinion).T @ self.shafts[pinion].strain
                rings = -load.reshape(rings.shape)
            loads.append(rings)
        return np.concatenate(loads, axis=1)

    def relative_motions(self, labels: Sequence[str], line: DriveLine | None) -> Array:
        """Return H: motions that the casing gives to the coordinates of the other parts.

        Parameters
        ----------
        labels : sequence of str
            Labels of the n coordinates before those of the casing.
        line : DriveLine or None
            Shafts of pinions that tilt.

        Returns
        -------
        (n, size) array
            m and rad for a unit of each coordinate of the casing.
        """
        motions = np.zeros((len(labels), self.size))
        pinions = len(self.layout.pinions)
        for body in self.bearing_seats:
            base = self.base_motions(body)
            coordinates: Integers = DOF_PER_BODY * body + np.arange(3)
            if body < pinions:
                if line is not None and body in line.tilting:
                    coordinates = line.motions(body)
            elif body - pinions in self.layout.first_tilts:
                tilts = self.layout.first_tilts[body - pinions] + np.arange(2)
                coordinates = np.append(coordinates, tilts)
            motions[coordinates] = base[: coordinates.size]
        return motions

    def gear_tilts(self, gear: int) -> Array:
        """Return tilt_x and tilt_y of a gear that tilts with its seat.

        Parameters
        ----------
        gear : int
            Number of the gear.

        Returns
        -------
        (2, size) array
            rad for a unit of each coordinate of the casing.
        """
        return self.base_motions(len(self.layout.pinions) + gear)[3:]

    def flank_rows(self, line: DriveLine | None = None) -> Array:
        """Return the derivatives of the flanks' deflections by the casing: bodies that tilt with their seats.

        Parameters
        ----------
        line : DriveLine or None
            Drive line, whose shafts let pinions tilt by themselves.

        Returns
        -------
        (2 meshes, size) array
            Drive flanks first; m for a unit of each coordinate.
        """
        layout = self.layout
        rows = np.zeros((2, len(layout.meshes), self.size))
        for mesh, (i, g) in enumerate(layout.meshes):
            if g in self.tilting_with_seat:
                by_tilts = [tilt_row(layout, frame, (i, g), 0.0) for frame in layout.flank_frames[g]]
                rows[:, mesh] = np.array(by_tilts) @ self.gear_tilts(g)
            if (
                layout.meshes_tilt_pinions
                and i in self.bearing_seats
                and (line is None or i not in line.tilting)
            ):
                moments = np.array([frame.moment[:2] for frame in layout.flank_frames[g]])
                rows[:, mesh] += moments @ self.base_motions(i)[3:]
        return rows.reshape(2 * len(layout.meshes), self.size)

    def __call__(self, base_model: LinearModel, line: DriveLine | None = None) -> LinearModel:
        """Return the model with the casing's coordinates behind its own.

        Parameters
        ----------
        base_model : LinearModel
            Model of the layout with its drive line.
        line : DriveLine or None
            That drive line.

        Returns
        -------
        LinearModel
            The lumped damping acts on bearings and bodies, not on the casing, which has its own.
        """
        old, new = base_model.size, self.size
        relative = np.hstack([np.eye(old), -self.relative_motions(base_model.labels, line)])
        casing_stiffness, strain = self.mounted.stiffness, self.strain_between_seats
        stiffness = relative.T @ base_model.stiffness @ relative
        stiffness[old:, old:] += casing_stiffness + strain
        mass, dampers = np.zeros((2, old + new, old + new))
        mass[:old, :old] = base_model.mass
        mass[old:, old:] = self.mounted.mass + self._gear_inertias()
        dampers[:old, :old] = base_model.dampers
        dampers[old:, old:] = (
            self.mounted.damping
            - base_model.bearing_damping * casing_stiffness
            - base_model.mass_damping * mass[old:, old:]
        )
        zeros = np.zeros(new)
        return replace(
            base_model,
            labels=(*base_model.labels, *(f"{CASING}:{letter}" for letter in self.mounted.letters)),
            mass=mass,
            stiffness=0.5 * (stiffness + stiffness.T),
            rows=np.hstack([base_model.rows, self.flank_rows(line)]),
            torques=np.append(base_model.torques, zeros),
            forces=np.append(base_model.forces, zeros),
            lengths=np.append(base_model.lengths, self._lengths()),
            dampers=dampers,
            spin=_pad_spin(base_model.spin, new),
            seat_tilts=self._seat_tilts(old, line),
        )

    def seat_motion(self, linear: LinearModel, line: DriveLine | None) -> SeatMotion:
        """Return the change of unknowns of a machine on the casing to motions against its seats.

        Parameters
        ----------
        linear : LinearModel
            Linear model of the machine with the casing.
        line : DriveLine or None
            Its drive line.

        Returns
        -------
        SeatMotion
            SI units.
        """
        first = casing_start(linear)
        last = first + self.size
        return SeatMotion(
            self.relative_motions(linear.labels[:first], line),
            slice(first, last),
            self.mounted.stiffness + self.strain_between_seats,
            np.arange(last - self.mounted.modes, last),
        )

    def _seat_tilts(self, before: int, line: DriveLine | None) -> Array:
        """Return the tilts (bodies, 2, before + size) of bodies that tilt with their seats alone, behind
        `before` other coordinates.
        """
        tilts = np.zeros((len(self.layout.bodies), 2, before + self.size))
        gears = [len(self.layout.pinions) + g for g in self.tilting_with_seat]
        tilting = () if line is None else line.tilting
        pinions = [i for i in range(len(self.layout.pinions)) if i in self.bearing_seats and i not in tilting]
        for body in (*pinions, *gears):
            tilts[body, :, before:] = self.base_motions(body)[3:]
        return tilts

    def _gear_inertias(self) -> Array:
        """Return the inertia (size, size) of gears that tilt with their seats: half of the polar one about a
        diameter, kg m2.
        """
        inertia = np.zeros((self.size, self.size))
        for g in self.tilting_with_seat:
            tilts = self.gear_tilts(g)
            inertia += 0.5 * self.layout.gears[g].body.inertia * tilts.T @ tilts
        return inertia

    def _lengths(self) -> Array:
        """Return the length of a unit of each coordinate (size,), m.

        It is 1 for motions along, the mesh radius for rotations, and for a mode the motion that a rigid body
        of the casing's mass has with the mode's kinetic energy.
        """
        lengths = np.ones(self.size)
        interface_motions = self.size - self.mounted.modes
        is_rotation = np.arange(interface_motions) % SEAT_MOTIONS >= 3
        lengths[:interface_motions][is_rotation] = self.layout.mesh_radius
        lengths[interface_motions:] = 1.0 / np.sqrt(max(float(self.mounted.total_mass[0]), 1e-12))
        return lengths


def body_axes(layout: Layout, body: int, distance: float | None = None) -> tuple[Array, Array]:
    """Return axes and place of a body in the axes of the casing, X to where angles of pinions begin and Z
    along the gears'.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    body : int
        Number of the body in the layout.
    distance : float or None
        Distance of a point on a pinion's axis from the gears' axis, m; None for the pinion's middle.

    Returns
    -------
    tuple of (3, 3) array and (3,) array
        Rows are the body's x, y and z; the point, for a gear the one to which its motions belong, m.
    """
    pinions = len(layout.pinions)
    if body < pinions:
        cosine, sine = np.cos(layout.angles[body]), np.sin(layout.angles[body])
        axes = np.array([[-sine, cosine, 0.0], [0.0, 0.0, 1.0], [cosine, sine, 0.0]])
        along = layout.pinion_middle if distance is None else distance
        if layout.kind is None:
            return axes, along * axes[2]
        axes = layout.kind.lean @ axes
        return axes, layout.kind.offset * axes[0] + along * axes[2]
    axes = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    gear = body - pinions
    return axes, np.array([0.0, 0.0, layout.gears[gear].sign * layout.tilt_distance(gear)])


def _pad_spin(spin: Spin | None, count: int) -> Spin | None:
    """Return the matrices of rotation with zeros for more coordinates behind."""
    if spin is None:
        return None
    return Spin(*(np.pad(part, (0, count)) for part in (spin.gyroscopic, spin.circulatory, spin.centrifugal)))
