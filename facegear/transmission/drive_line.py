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
from facegear.shafts.condensed import MOTIONS, CondensedShaft
from facegear.transmission.layout import DOF_PER_BODY, TILT_LETTERS, Layout
from facegear.transmission.linear_model import LinearModel, Spin

THETA = 3


@dataclass(frozen=True, eq=False)
class Seat:
    """What a pinion sits on; tilt_inertia: about a diameter, kg m2, None for a pinion that does not tilt."""

    shaft: CondensedShaft
    tilt_inertia: float | None = None

    @property
    def couples_axially(self) -> bool:
        """Whether the bearings move a pinion along its axis where it is loaded across."""
        others = np.delete(self.shaft.compliance[2], 2)
        return bool((others != 0.0).any())


@dataclass(frozen=True)
class TurningMass:
    """A turning mass behind a torsional spring: N m/rad, kg m2, and the damping ratio of the two masses that
    the spring joins, by themselves.
    """

    name: str
    stiffness: float
    inertia: float
    damping_ratio: float = 0.0


@dataclass(frozen=True, eq=False)
class Spring:
    """A torsional spring between two coordinates of the model: N m/rad, N m s/rad."""

    first: int
    second: int
    stiffness: float
    damping: float


@dataclass(frozen=True, eq=False)
class DriveLine:
    """Seats by the pinions' numbers in the layout, chains of turning masses by those of the bodies."""

    layout: Layout
    seats: Mapping[int, Seat]
    masses: Mapping[int, tuple[TurningMass, ...]]

    @property
    def tilting(self) -> tuple[int, ...]:
        """The pinions that tilt."""
        return tuple(i for i, seat in sorted(self.seats.items()) if seat.tilt_inertia is not None)

    @property
    def size(self) -> int:
        """How many coordinates it adds."""
        return 2 * len(self.tilting) + sum(len(chain) for chain in self.masses.values())

    def tilts(self, pinion: int) -> Integers:
        """Coordinates tilt_x and tilt_y of a pinion that tilts."""
        return self.layout.dof + 2 * self.tilting.index(pinion) + np.arange(2)

    def motions(self, pinion: int) -> Integers:
        """Coordinates of a pinion among x, y, z, tilt_x, tilt_y."""
        straight = DOF_PER_BODY * pinion + np.arange(3)
        return np.append(straight, self.tilts(pinion)) if pinion in self.tilting else straight

    def chains(self) -> Iterator[tuple[int, int, tuple[TurningMass, ...]]]:
        """Body, first coordinate and masses of every chain."""
        first = self.layout.dof + 2 * len(self.tilting)
        for body, chain in sorted(self.masses.items()):
            yield body, first, chain
            first += len(chain)

    def torque_coordinates(self) -> Integers:
        """Where the torque of every body acts, (bodies,)."""
        at = np.arange(len(self.layout.bodies)) * DOF_PER_BODY + THETA
        for body, first, chain in self.chains():
            at[body] = first + len(chain) - 1
        return at

    def springs(self) -> list[Spring]:
        """All torsional springs, from each body outwards."""
        springs = []
        for body, first, chain in self.chains():
            before, inertia = DOF_PER_BODY * body + THETA, self.layout.bodies[body].inertia
            for number, mass in enumerate(chain, start=first):
                reduced = inertia * mass.inertia / (inertia + mass.inertia)
                damping = 2.0 * mass.damping_ratio * np.sqrt(mass.stiffness * reduced)
                springs.append(Spring(before, number, mass.stiffness, float(damping)))
                before, inertia = number, mass.inertia
        return springs

    def __call__(self, lumped: LinearModel) -> LinearModel:
        """The model with these coordinates behind its own.

        The lumped damping acts on shafts and their bearings, and on no turning mass.
        """
        added = self.size
        inertias = self._inertias()
        mass = np.pad(lumped.mass, (0, added))
        mass[lumped.size :, lumped.size :] = np.diag(inertias)
        stiffness = np.pad(lumped.stiffness, (0, added))
        for pinion, seat in self.seats.items():
            own = self.motions(pinion)
            if own.size == MOTIONS or seat.couples_axially:
                matrix = seat.shaft.stiffness if own.size == MOTIONS else seat.shaft.square
                stiffness[np.ix_(own, own)] = matrix
        twisted, dampers = self._twisted(lumped)
        torques = np.pad(lumped.torques, (0, added))
        turning = self.torque_coordinates()
        torques[self.layout.spins] = 0.0
        torques[turning] = lumped.torques[self.layout.spins]
        return replace(
            lumped,
            labels=(*lumped.labels, *self._labels()),
            mass=mass,
            stiffness=stiffness + twisted,
            rows=np.pad(lumped.rows, ((0, 0), (0, added))),
            torques=torques,
            forces=np.pad(lumped.forces, (0, added)),
            lengths=np.append(lumped.lengths, self._lengths()),
            dampers=np.pad(lumped.dampers, (0, added)) + dampers,
            spin=self._spin(lumped),
        )

    def _inertias(self) -> Array:
        tilts = [self.seats[i].tilt_inertia for i in self.tilting for _ in range(2)]
        return np.array([*tilts, *(mass.inertia for *_, chain in self.chains() for mass in chain)], float)

    def _labels(self) -> list[str]:
        names = self.layout.body_names
        tilts = [f"{names[i]}:{letter}" for i in self.tilting for letter in TILT_LETTERS]
        return tilts + [f"{names[body]}:{mass.name}" for body, _, chain in self.chains() for mass in chain]

    def _lengths(self) -> Array:
        layout = self.layout
        radii = [layout.pinion_radius] * len(layout.pinions) + [layout.gear_radius] * len(layout.gears)
        tilts = [layout.pinion_radius] * (2 * len(self.tilting))
        return np.array(tilts + [radii[body] for body, _, chain in self.chains() for _ in chain])

    def _twisted(self, lumped: LinearModel) -> tuple[Array, Array]:
        """Stiffness of the torsional springs, and dampers with which the lumped damping leaves them out."""
        whole = lumped.size + self.size
        stiffness, dampers = np.zeros((2, whole, whole))
        for spring in self.springs():
            ends = np.ix_([spring.first, spring.second], [spring.first, spring.second])
            apart = np.array([[1.0, -1.0], [-1.0, 1.0]])
            stiffness[ends] += spring.stiffness * apart
            dampers[ends] += (spring.damping - lumped.bearing_damping * spring.stiffness) * apart
            dampers[spring.second, spring.second] -= lumped.mass_damping * self._inertia(spring.second)
        return stiffness, dampers

    def _inertia(self, coordinate: int) -> float:
        return float(self._inertias()[coordinate - self.layout.dof])

    def _spin(self, lumped: LinearModel) -> Spin | None:
        """Pinions turn against their z, which points away from the gears' axis."""
        if not self.tilting:
            return None
        whole = lumped.size + self.size
        gyroscopic = np.zeros((whole, whole))
        for pinion in self.tilting:
            about_x, about_y = self.tilts(pinion)
            polar = self.layout.pinions[pinion].body.inertia
            gyroscopic[about_x, about_y], gyroscopic[about_y, about_x] = -polar, polar
        return Spin(gyroscopic, np.zeros((whole, whole)), np.zeros((whole, whole)))

    def without_shafts(self, pinions: Set[int], layout: Layout) -> "DriveLine":
        """The same for a layout in which these pinions have bearings of their own."""
        kept = {i: seat for i, seat in self.seats.items() if i not in pinions}
        return DriveLine(layout, kept, self.masses)

    def static_from_layout(self, lumped: LinearModel) -> bool:
        """Whether `extended` holds: not where a force along its axis loads a pinion whose bearings couple."""
        coupled = [self.motions(i)[2] for i, seat in self.seats.items() if seat.couples_axially]
        return not lumped.forces[coupled].any()

    def extended(self, lumped: LinearModel, moved: Array) -> Array:
        """Static displacements (K, n + size) from those (K, n) of the machine without it.

        lumped: the model of the layout. No moment loads a pinion, and a torque passes its chain whole.
        """
        first = lumped.size
        moved, added = moved.copy(), np.zeros((len(moved), self.size))
        loads = moved[:, :first] @ lumped.stiffness
        for pinion, seat in self.seats.items():
            straight, compliance = self.motions(pinion)[:3], seat.shaft.compliance
            if seat.couples_axially:
                moved[:, straight[2]] = loads[:, straight] @ compliance[:3, 2]
            if pinion in self.tilting:
                added[:, self.tilts(pinion) - first] = loads[:, straight] @ compliance[:3, 3:]
        for body, start, chain in self.chains():
            at = DOF_PER_BODY * body + THETA
            twist = np.cumsum([lumped.torques[at] / mass.stiffness for mass in chain])
            added[:, start - first : start - first + len(chain)] = moved[:, at, None] + twist
        return np.concatenate([moved[:, :first], added, moved[:, first:]], axis=1)
