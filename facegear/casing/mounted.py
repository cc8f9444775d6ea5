"""A reduced casing on its feet, in the axes of the machine: what a machine couples with."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Self

import numpy as np
import scipy

from facegear.arrays import Array, Arrays
from facegear.casing.reduction import MOTIONS, Interface, Reduction, own_modes
from facegear.errors import InvalidInput
from facegear.number_format import count_noun

LETTERS = ("x", "y", "z", "tilt_x", "tilt_y", "tilt_z")
"""Motions of a seat or foot, along and about the casing's X (to a pinion at angle 0), Y and Z (the
gears' axis).
"""
HOLDING_LIMIT = 1e-9
"""Smallest eigenvalue over the largest, rows scaled to a unit diagonal, above which feet hold a casing."""
NEGATIVE = 1e-8
"""Negative eigenvalue over the largest, rows scaled to a unit diagonal, up to which it counts as rounding."""

VALID = 0.5
"""Part of the highest mode with seats and feet held up to which modes and vibration hold, dimensionless: a
rule of thumb of component mode synthesis."""


@dataclass(frozen=True, eq=False)
class Foot:
    """A foot on the ground: held, or on springs.

    - interface: its nodes
    - stiffness (6,): of its springs along and about the file's axes, N/m and N m/rad; None for held
    """

    interface: Interface
    stiffness: Array | None = None


@dataclass(frozen=True, eq=False)
class MountedCasing:
    """A casing on its feet by n coordinates: six for each seat and each foot on springs, then modes.

    Axes are those of the machine: X from the gears' axis to a pinion at angle 0, Z along the axis from the
    lower to the upper gear. SI units.

    Attributes
    ----------
    seat_names : (seats,) array of str
        Names of the seats.
    seat_positions : (seats, 3)
        Their positions from the point where the pinions' axes meet the gears' axis, m.
    foot_names : (feet,) array of str
        Names of the feet.
    foot_positions : (feet, 3)
        Their positions, m.
    sensor_names : (sensors,) array of str
        Names of the sensors.
    letters : (n,) array of str
        `seat x` for motions of seats and feet, `mode 3` for modes.
    stiffness, mass, damping : (n, n)
        With the springs of feet.
    foot_loads : (6 feet, n)
        Forces and moments of the casing on its feet, about each foot, by the coordinates.
    foot_inertia : (6 feet, n)
        The same by accelerations: mass of the casing that stands on held feet.
    sensors : (sensors, n)
        Motion of each sensor by the coordinates, m.
    frequencies : (modes,)
        Of the modes with seats and feet held, Hz.
    total_mass : (1,)
        Mass of the whole casing, kg.
    """

    seat_names: Array
    seat_positions: Array
    foot_names: Array
    foot_positions: Array
    sensor_names: Array
    letters: Array
    stiffness: Array
    mass: Array
    damping: Array
    foot_loads: Array
    foot_inertia: Array
    sensors: Array
    frequencies: Array
    total_mass: Array

    def __post_init__(self) -> None:
        # Machines of a study share the casing; arrays that cannot change are compared once.
        for part in fields(self):
            getattr(self, part.name).flags.writeable = False

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return int(self.letters.size)

    @cached_property
    def seats(self) -> dict[str, slice]:
        """Coordinates of each seat by its name."""
        return {
            str(name): slice(MOTIONS * number, MOTIONS * (number + 1))
            for number, name in enumerate(self.seat_names)
        }

    @property
    def modes(self) -> int:
        """Number of coordinates that are modes; they stand last."""
        return int(self.frequencies.size)

    @property
    def valid_up_to(self) -> float:
        """Frequency up to which the kept modes hold, Hz: VALID of the highest; infinite without modes."""
        return VALID * float(self.frequencies[-1]) if self.modes else float("inf")

    @cached_property
    def own_frequencies(self) -> Array:
        """Natural frequencies of the casing on its feet without the machine, Hz, rising."""
        return own_modes(self.stiffness, self.mass)[0]

    def without_modes(self) -> Self:
        """Return the casing by the motions of its seats and feet alone, which is exact at rest.

        Returns
        -------
        Self
            The casing after Guyan.
        """
        if not self.modes:
            return self
        n = self.size - self.modes
        return replace(
            self,
            letters=self.letters[:n],
            stiffness=self.stiffness[:n, :n],
            mass=self.mass[:n, :n],
            damping=self.damping[:n, :n],
            foot_loads=self.foot_loads[:, :n],
            foot_inertia=self.foot_inertia[:, :n],
            sensors=self.sensors[:, :n],
            frequencies=self.frequencies[:0],
        )

    def to_arrays(self) -> dict[str, Array]:
        """Return all fields by their names.

        Returns
        -------
        dict of arrays
            Arrays (n, n) and the others in the shapes and units of the fields.
        """
        return {part.name: getattr(self, part.name) for part in fields(self)}

    @classmethod
    def of_arrays(cls, arrays: Arrays) -> Self:
        """Return the casing that `to_arrays` has stored.

        Parameters
        ----------
        arrays : mapping of arrays
            All fields by their names.

        Returns
        -------
        Self
            The casing.
        """
        return cls(**{part.name: arrays[part.name] for part in fields(cls)})


def mount(
    reduction: Reduction,
    seats: Sequence[Interface],
    feet: Sequence[Foot],
    sensor_names: Sequence[str],
    axes: tuple[Array, Array],
    damping_ratio: float,
    total_mass: float,
) -> MountedCasing:
    """Put a reduced casing on its feet, and turn it to the axes of the machine.

    Parameters
    ----------
    reduction : Reduction
        Its interfaces are the seats, then the feet.
    seats : sequence of Interface
        Seats in the order of the reduction.
    feet : sequence of Foot
        Feet in that order.
    sensor_names : sequence of str
        Names of its sensors.
    axes : tuple of (3, 3) array and (3,) array
        Rows are the machine's X, Y and Z in the file; place of the machine's origin in the file, m.
    damping_ratio : float
        Of every mode of the casing on its feet, dimensionless; used where the file has no damping.
    total_mass : float
        kg.

    Returns
    -------
    MountedCasing
        SI units.

    Raises
    ------
    InvalidInput
        If the matrices have negative eigenvalues or the feet leave the casing free.
    """
    rotation, origin = axes
    interfaces = [*seats, *(foot.interface for foot in feet)]
    stiffness, mass = reduction.stiffness.copy(), reduction.mass
    _require_positive("stiffness", stiffness)
    _require_positive("mass", mass)
    if reduction.damping is not None:
        _require_positive("damping", reduction.damping)
    first, size = MOTIONS * len(seats), len(stiffness)
    is_held = np.zeros(size, bool)
    springs = np.zeros((MOTIONS * len(feet), size))
    for number, foot in enumerate(feet):
        rows = first + MOTIONS * number + np.arange(MOTIONS)
        if foot.stiffness is None:
            is_held[rows] = True
        else:
            stiffness[rows, rows] += foot.stiffness
            springs[MOTIONS * number + np.arange(MOTIONS), rows] = foot.stiffness
    kept_rows = np.flatnonzero(~is_held)
    turn = np.eye(size)
    for number in range(2 * len(interfaces)):
        turn[3 * number : 3 * number + 3, 3 * number : 3 * number + 3] = rotation
    at_feet = first + np.arange(MOTIONS * len(feet))
    # The ground holds a held foot with K u; the foot presses on the ground with the opposite.
    loads = np.where(is_held[at_feet, None], -stiffness[at_feet], springs)
    inertia = np.where(is_held[at_feet, None], -mass[at_feet], 0.0)
    foot_turn = turn[np.ix_(at_feet, at_feet)]
    kept_rotation = turn[np.ix_(kept_rows, kept_rows)]
    kept_stiffness = kept_rotation @ stiffness[np.ix_(kept_rows, kept_rows)] @ kept_rotation.T
    _require_held(kept_stiffness)
    kept_mass = kept_rotation @ mass[np.ix_(kept_rows, kept_rows)] @ kept_rotation.T
    damping = reduction.damping
    letters = [f"{interface.name} {letter}" for interface in interfaces for letter in LETTERS]
    letters += [f"mode {number}" for number in range(1, reduction.frequencies.size + 1)]
    return MountedCasing(
        seat_names=_names([seat.name for seat in seats]),
        seat_positions=_interface_positions(seats, rotation, origin),
        foot_names=_names([foot.interface.name for foot in feet]),
        foot_positions=_interface_positions([foot.interface for foot in feet], rotation, origin),
        sensor_names=_names(sensor_names),
        letters=_names([letters[row] for row in kept_rows]),
        stiffness=_symmetric(kept_stiffness),
        mass=_symmetric(kept_mass),
        damping=_symmetric(kept_rotation @ damping[np.ix_(kept_rows, kept_rows)] @ kept_rotation.T)
        if damping is not None
        else _modal_damping(_symmetric(kept_stiffness), _symmetric(kept_mass), damping_ratio),
        foot_loads=(foot_turn @ loads)[:, kept_rows] @ kept_rotation.T,
        foot_inertia=(foot_turn @ inertia)[:, kept_rows] @ kept_rotation.T,
        sensors=reduction.sensors[:, kept_rows] @ kept_rotation.T,
        frequencies=reduction.frequencies,
        total_mass=np.array([total_mass]),
    )


def _interface_positions(interfaces: Sequence[Interface], rotation: Array, origin: Array) -> Array:
    """Return the positions (k, 3) of interfaces in the axes of the machine, m."""
    positions = np.array([interface.position for interface in interfaces]).reshape(-1, 3)
    return np.asarray((positions - origin) @ rotation.T)


def _names(names: Sequence[str]) -> Array:
    """Return names as an array of text that an npz file holds."""
    return np.array(list(names), dtype=np.str_)


def _symmetric(matrix: Array) -> Array:
    """Return the symmetric part of a matrix, which removes rounding."""
    return np.asarray(0.5 * (matrix + matrix.T))


def _scaled_values(matrix: Array) -> Array:
    """Return the eigenvalues, rising, of a symmetric matrix with its rows scaled to a unit diagonal."""
    diagonal = np.abs(np.diagonal(matrix))
    scale = np.where(diagonal > 0.0, 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0)), 0.0)
    return np.asarray(scipy.linalg.eigvalsh(matrix * np.outer(scale, scale)))


def _require_positive(quantity: str, matrix: Array) -> None:
    """Refuse a matrix (n, n) with a negative eigenvalue."""
    if not matrix.size:
        return
    values = _scaled_values(matrix)
    if values[0] < -NEGATIVE * max(values[-1], 1e-300):
        value = f"eigenvalue {values[0] / values[-1]:.2e} of the largest"
        condition = "without negative eigenvalues: is one triangle missing, or a row in the wrong place?"
        raise InvalidInput(f"{quantity} of the casing", value, condition)


def _require_held(stiffness: Array) -> None:
    """Refuse a casing that its feet leave free to move."""
    values = _scaled_values(stiffness)
    if values[0] < HOLDING_LIMIT * values[-1]:
        loose = int((values < HOLDING_LIMIT * values[-1]).sum())
        raise InvalidInput(
            "feet of the casing", count_noun(loose, "free motion"), "such that they hold the casing"
        )


def _modal_damping(stiffness: Array, mass: Array, ratio: float) -> Array:
    """Return the damping (n, n), N s/m, that gives every mode of K and M one ratio: sum of 2 ratio w M p p^T
    M.

    Motions without mass have none.
    """
    frequencies, shapes = own_modes(stiffness, mass)
    loads = mass @ shapes
    return np.asarray((loads * (4.0 * np.pi * ratio * frequencies)) @ loads.T)
