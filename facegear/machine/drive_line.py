"""Shafts that bend below pinions, and turning masses on the other end of torsional springs.

A pinion whose shaft is given by its 5 x 5 stiffness may tilt: two coordinates, with the gyroscopic moments of
its spin. Its bearing in the layout is what remains without tilts and without moments, so that statics are
those of the layout alone. An engine, a rotor, or several of them in a row, adds one coordinate each; the
torque of the body acts on the last.
"""

from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Integers
from facegear.bearings.shaft import RollingShaft, ShaftState
from facegear.machine.layout import DOF_PER_BODY, TILT_LETTERS, Layout
from facegear.machine.linear_model import LinearModel, Spin
from facegear.parts.shafts import CondensedShaft
from facegear.rigid_body import MOTIONS

THETA = 3
"""Index of the rotation among the four coordinates of a body."""


@dataclass(frozen=True, eq=False)
class Seat:
    """Shaft that a pinion sits on.

    Attributes
    ----------
    shaft : CondensedShaft
        Compliance of the shaft on its bearings, condensed to the pinion's middle.
    tilt_inertia : float or None
        Moment of inertia about a diameter, kg m2; None for a pinion that does not tilt.
    rolling : RollingShaft or None
        Shaft on rolling bearings, whose tangent at `state` is `shaft`; None on springs.
    state : ShaftState or None
        Where the rolling bearings are linearised: under the mean load.
    """

    shaft: CondensedShaft
    tilt_inertia: float | None = None
    rolling: RollingShaft | None = None
    state: ShaftState | None = None

    @property
    def couples_axially(self) -> bool:
        """Whether the bearings couple z with x, y or tilts: a load across the axis moves the pinion along
        it.
        """
        axial_row = np.delete(self.shaft.compliance[2], 2)
        return bool((axial_row != 0.0).any())

    def bearing_loads(self, loads: Array) -> Array:
        """Return the loads of the shaft on its bearings by those of the pinion; rolling bearings by their
        tangent.

        Parameters
        ----------
        loads : (..., 5) array
            Forces and moments of the pinion on the shaft, N and N m.

        Returns
        -------
        (..., bearings, 5) array
            N and N m.
        """
        if self.state is None:
            return self.shaft.bearing_loads(loads)
        return np.asarray(self.state.forces + self.shaft.bearing_loads(loads - self.state.pinion_load))


@dataclass(frozen=True)
class TurningMass:
    """A turning mass behind a torsional spring, towards the body or the mass before it.

    stiffness of the spring, N m/rad; inertia, kg m2; damping_ratio of the two masses that the spring
    joins, free of all others.
    """

    name: str
    stiffness: float
    inertia: float
    damping_ratio: float = 0.0


@dataclass(frozen=True, eq=False)
class Spring:
    """A torsional spring between two coordinates of the model.

    first, second: indices of the coordinates, from the body outwards; stiffness, N m/rad; damping, N m
    s/rad.
    """

    first: int
    second: int
    stiffness: float
    damping: float


@dataclass(frozen=True, eq=False)
class DriveLine:
    """Shafts below pinions and chains of turning masses; called with a linear model it adds their
    coordinates.

    - seats: shaft of a pinion, by the pinion's number in the layout
    - masses: turning masses from a body outwards, by the body's number in the layout

    Its coordinates are tilt_x and tilt_y of each tilting pinion, then the rotation of each turning mass.
    """

    layout: Layout
    seats: Mapping[int, Seat]
    masses: Mapping[int, tuple[TurningMass, ...]]

    @property
    def rolling(self) -> tuple[int, ...]:
        """Numbers in the layout, rising, of the pinions whose shafts have rolling bearings."""
        return tuple(i for i, seat in sorted(self.seats.items()) if seat.rolling is not None)

    @property
    def tilting(self) -> tuple[int, ...]:
        """Numbers in the layout, rising, of the pinions that tilt: those whose seat has a tilt inertia."""
        return tuple(i for i, seat in sorted(self.seats.items()) if seat.tilt_inertia is not None)

    @property
    def size(self) -> int:
        """Number of coordinates that the drive line adds: two for each tilting pinion, one for each
        turning mass.
        """
        return 2 * len(self.tilting) + sum(len(chain) for chain in self.masses.values())

    @property
    def is_tilted_by_meshes(self) -> bool:
        """Whether meshes tilt pinions on shafts or push them along their axes."""
        seated = self.seats if self.layout.kind is not None else self.tilting
        return bool(seated) and self.layout.meshes_tilt_pinions

    def tilts(self, pinion: int) -> Integers:
        """Return the coordinates tilt_x and tilt_y of a pinion that tilts.

        Parameters
        ----------
        pinion : int
            Number of the pinion in the layout.

        Returns
        -------
        (2,) array of int
            Indices of coordinates of the model.
        """
        return self.layout.dof + 2 * self.tilting.index(pinion) + np.arange(2)

    def motions(self, pinion: int) -> Integers:
        """Return the coordinates of a pinion among x, y, z, tilt_x, tilt_y.

        Parameters
        ----------
        pinion : int
            Number of the pinion in the layout.

        Returns
        -------
        (5,) or (3,) array of int
            Indices of coordinates; three for a pinion that does not tilt.
        """
        straight = DOF_PER_BODY * pinion + np.arange(3)
        return np.append(straight, self.tilts(pinion)) if pinion in self.tilting else straight

    def chains(self) -> Iterator[tuple[int, int, tuple[TurningMass, ...]]]:
        """Yield every chain of turning masses, by rising number of its body.

        Yields
        ------
        tuple of int, int and tuple of TurningMass
            Number of the body in the layout, index of the first mass's coordinate in the model, and the
            masses from the body outwards.
        """
        first = self.layout.dof + 2 * len(self.tilting)
        for body, chain in sorted(self.masses.items()):
            yield body, first, chain
            first += len(chain)

    def torque_coordinates(self) -> Integers:
        """Return the coordinate on which the torque of every body acts.

        Returns
        -------
        (bodies,) array of int
            Indices of coordinates: the last mass of a chain, or the rotation of the body.
        """
        at = np.arange(len(self.layout.bodies)) * DOF_PER_BODY + THETA
        for body, first, chain in self.chains():
            at[body] = first + len(chain) - 1
        return at

    def springs(self) -> list[Spring]:
        """Return all torsional springs, chain by chain, from each body outwards.

        The damping is 2 zeta sqrt(k J), with J = J1 J2 / (J1 + J2) of the two inertias that the spring
        joins.

        Returns
        -------
        list of Spring
            Stiffness in N m/rad, damping in N m s/rad.
        """
        springs = []
        for body, first, chain in self.chains():
            before, inertia = DOF_PER_BODY * body + THETA, self.layout.bodies[body].inertia
            for number, mass in enumerate(chain, start=first):
                reduced_inertia = inertia * mass.inertia / (inertia + mass.inertia)
                damping = 2.0 * mass.damping_ratio * np.sqrt(mass.stiffness * reduced_inertia)
                springs.append(Spring(before, number, mass.stiffness, float(damping)))
                before, inertia = number, mass.inertia
        return springs

    def __call__(self, model: LinearModel) -> LinearModel:
        """Return the model with the drive line's coordinates behind its own.

        Torques move to the last mass of a chain. The stiffness of its shaft replaces the bearing of a
        pinion that tilts, or whose bearings couple axial motion with others. Rolling bearings are left out:
        `facegear.machine.supports` adds their tangent. The lumped damping acts on shafts and their
        bearings, and on no turning mass.
        """
        added_count = self.size
        inertias = self._inertias()
        mass = np.pad(model.mass, (0, added_count))
        mass[model.size :, model.size :] = np.diag(inertias)
        stiffness = np.pad(model.stiffness, (0, added_count))
        for pinion, seat in self.seats.items():
            coordinates = self.motions(pinion)
            if seat.rolling is not None:
                stiffness[np.ix_(coordinates, coordinates)] = 0.0
            elif coordinates.size == MOTIONS or seat.couples_axially:
                matrix = seat.shaft.stiffness if coordinates.size == MOTIONS else seat.shaft.square
                stiffness[np.ix_(coordinates, coordinates)] = matrix
        torsion, dampers = self._torsion_matrices(model)
        torques = np.pad(model.torques, (0, added_count))
        turning = self.torque_coordinates()
        torques[self.layout.spins] = 0.0
        torques[turning] = model.torques[self.layout.spins]
        return replace(
            model,
            labels=(*model.labels, *self._labels()),
            mass=mass,
            stiffness=stiffness + torsion,
            rows=self._rows(model),
            torques=torques,
            forces=np.pad(model.forces, (0, added_count)),
            lengths=np.append(model.lengths, self._lengths()),
            dampers=np.pad(model.dampers, (0, added_count)) + dampers,
            spin=self._spin(model),
        )

    def _rows(self, model: LinearModel) -> Array:
        """Return the rows of the flanks over all coordinates, (flanks, n + size): zero for turning masses,
        the moment of the flank's normal about the middle of the pinion's face for tilts.
        """
        rows, layout = np.pad(model.rows, ((0, 0), (0, self.size))), self.layout
        if not layout.meshes_tilt_pinions:
            return rows
        for mesh, (pinion, gear) in enumerate(layout.meshes):
            if pinion in self.tilting:
                for flank, frame in enumerate(layout.flank_frames[gear]):
                    rows[mesh + flank * len(layout.meshes), self.tilts(pinion)] = frame.moment[:2]
        return rows

    def _inertias(self) -> Array:
        """Return the inertias of the added coordinates (size,): tilts, then turning masses, kg m^2."""
        tilts = [self.seats[i].tilt_inertia for i in self.tilting for _ in range(2)]
        return np.array([*tilts, *(mass.inertia for *_, chain in self.chains() for mass in chain)], float)

    def _labels(self) -> list[str]:
        """Return the labels `body:letter` of the added coordinates: tilts, then turning masses by their
        names.
        """
        names = self.layout.body_names
        tilts = [f"{names[i]}:{letter}" for i in self.tilting for letter in TILT_LETTERS]
        return tilts + [f"{names[body]}:{mass.name}" for body, _, chain in self.chains() for mass in chain]

    def _lengths(self) -> Array:
        """Return the length of 1 rad of each added coordinate (size,), m: the layout's radius of the
        body.
        """
        layout = self.layout
        radii = [layout.pinion_radius] * len(layout.pinions) + [layout.gear_radius] * len(layout.gears)
        tilts = [layout.pinion_radius] * (2 * len(self.tilting))
        return np.array(tilts + [radii[body] for body, _, chain in self.chains() for _ in chain])

    def _torsion_matrices(self, model: LinearModel) -> tuple[Array, Array]:
        """Return stiffness and dampers of the torsional springs, (n + size, n + size), N m/rad and N m
        s/rad.

        The dampers are the springs' own less the lumped damping that the model's factors of M and K would
        add to springs and turning masses, so that these have their own damping alone.
        """
        whole = model.size + self.size
        stiffness, dampers = np.zeros((2, whole, whole))
        for spring in self.springs():
            ends = np.ix_([spring.first, spring.second], [spring.first, spring.second])
            apart = np.array([[1.0, -1.0], [-1.0, 1.0]])
            stiffness[ends] += spring.stiffness * apart
            dampers[ends] += (spring.damping - model.bearing_damping * spring.stiffness) * apart
            dampers[spring.second, spring.second] -= model.mass_damping * self._inertia(spring.second)
        return stiffness, dampers

    def _inertia(self, coordinate: int) -> float:
        """Return the inertia of an added coordinate by its index among all coordinates of the machine, kg
        m^2.
        """
        return float(self._inertias()[coordinate - self.layout.dof])

    def _spin(self, model: LinearModel) -> Spin | None:
        """Return the gyroscopic matrix of the tilting pinions, for 1 rad/s of the pinions; None if none
        tilts.

        Pinions turn against their z, which points away from the gears' axis.
        """
        if not self.tilting:
            return None
        whole = model.size + self.size
        gyroscopic = np.zeros((whole, whole))
        for pinion in self.tilting:
            about_x, about_y = self.tilts(pinion)
            polar = self.layout.pinions[pinion].body.inertia
            gyroscopic[about_x, about_y], gyroscopic[about_y, about_x] = -polar, polar
        return Spin(gyroscopic, np.zeros((whole, whole)), np.zeros((whole, whole)))

    def without_shafts(self, pinions: Set[int], layout: Layout) -> "DriveLine":
        """Return the drive line for a layout in which some pinions have bearings of their own.

        Parameters
        ----------
        pinions : Set[int]
            Numbers of these pinions.
        layout : Layout
            The layout.

        Returns
        -------
        DriveLine
            The seats of these pinions are left out.
        """
        seats = {i: seat for i, seat in self.seats.items() if i not in pinions}
        return DriveLine(layout, seats, self.masses)

    def static_from_layout(self, model: LinearModel) -> bool:
        """Whether the static displacement follows from that of the bodies by `extend_displacements`.

        Parameters
        ----------
        model : LinearModel
            Linear model of the layout.

        Returns
        -------
        bool
            False where an axial force loads a pinion whose bearings couple axial and other motions, and
            with rolling bearings, and where meshes push pinions along their axes or tilt them.
        """
        if self.rolling or self.is_tilted_by_meshes:
            return False
        axial_coordinates = [self.motions(i)[2] for i, seat in self.seats.items() if seat.couples_axially]
        return not model.forces[axial_coordinates].any()

    def extend_displacements(self, model: LinearModel, displacements: Array) -> Array:
        """Return static displacements with the drive line from those of the machine without it.

        No moment loads a pinion, and a torque passes its chain whole.

        Parameters
        ----------
        model : LinearModel
            Linear model of the layout.
        displacements : (K, n) array
            Displacements without the drive line, m and rad.

        Returns
        -------
        (K, n + size) array
            m and rad.
        """
        first = model.size
        displacements, added_displacements = displacements.copy(), np.zeros((len(displacements), self.size))
        loads = displacements[:, :first] @ model.stiffness
        for pinion, seat in self.seats.items():
            straight, compliance = self.motions(pinion)[:3], seat.shaft.compliance
            if seat.couples_axially:
                displacements[:, straight[2]] = loads[:, straight] @ compliance[:3, 2]
            if pinion in self.tilting:
                added_displacements[:, self.tilts(pinion) - first] = loads[:, straight] @ compliance[:3, 3:]
        for body, start, chain in self.chains():
            at = DOF_PER_BODY * body + THETA
            twist = np.cumsum([model.torques[at] / mass.stiffness for mass in chain])
            added_displacements[:, start - first : start - first + len(chain)] = (
                displacements[:, at, None] + twist
            )
        return np.concatenate(
            [displacements[:, :first], added_displacements, displacements[:, first:]], axis=1
        )
