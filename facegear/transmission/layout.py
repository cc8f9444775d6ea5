"""What is connected to what: pinions around one or two face gears."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from facegear.errors import ConfigError

DOF_PER_BODY = 4
DOF_LETTERS = ("x", "y", "z", "theta")


class Role(StrEnum):
    """What a pinion does in the power flow."""

    INPUT = "input"
    IDLER = "idler"
    TAIL = "tail"


class Side(StrEnum):
    """Which face gear: `lower` (6 in the paper) or `upper` (7, the output)."""

    LOWER = "lower"
    UPPER = "upper"


@dataclass(frozen=True)
class Body:
    """Mass (kg), moment of inertia about the own axis (kg m2), bearing stiffness along x, y, z (N/m)."""

    mass: float
    inertia: float
    bearing: tuple[float, float, float]


@dataclass(frozen=True)
class Pinion:
    """One pinion; `pitches` is its distribution angle in angular pitches of the face gear."""

    name: str
    role: Role
    pitches: float
    body: Body


@dataclass(frozen=True)
class FaceGear:
    """One face gear."""

    side: Side
    body: Body

    @property
    def name(self) -> str:
        """Name in tables and figures."""
        return f"{self.side.value} face gear"


@dataclass(frozen=True)
class Layout:
    """Bodies and mesh geometry, in m and rad. Bodies are ordered pinions, then gears, as in equation (1).

    Meshes are ordered gear by gear and within a gear pinion by pinion: (1,6) .. (n,6), (1,7) .. (n,7).
    """

    pinions: tuple[Pinion, ...]
    gears: tuple[FaceGear, ...]
    pinion_teeth: int
    gear_teeth: int
    pressure_angle: float
    pinion_radius: float
    gear_radius: float

    def __post_init__(self) -> None:
        if not self.pinions:
            raise ConfigError("transmission.pinions", [], "at least one pinion")
        if not self.gears or len({gear.side for gear in self.gears}) != len(self.gears):
            raise ConfigError(
                "transmission.face_gears", [g.side.value for g in self.gears], "lower, upper or both"
            )
        names = [pinion.name for pinion in self.pinions]
        if len(set(names)) != len(names):
            raise ConfigError("transmission.pinions", names, "each pinion needs a name of its own")

    @property
    def bodies(self) -> tuple[Body, ...]:
        """All bodies in the order of the degrees of freedom."""
        return tuple(part.body for part in (*self.pinions, *self.gears))

    @property
    def body_names(self) -> tuple[str, ...]:
        """Names of the bodies in the same order."""
        return tuple(part.name for part in (*self.pinions, *self.gears))

    @property
    def dof_names(self) -> tuple[str, ...]:
        """`body:letter` of each degree of freedom, 4 a body."""
        return tuple(f"{name}:{letter}" for name in self.body_names for letter in DOF_LETTERS)

    @property
    def meshes(self) -> tuple[tuple[int, int], ...]:
        """(pinion, gear) of each mesh, each counted from 0 in its own list."""
        return tuple((i, g) for g in range(len(self.gears)) for i in range(len(self.pinions)))

    @property
    def mesh_names(self) -> tuple[str, ...]:
        """`pinion/side` of each mesh."""
        return tuple(f"{self.pinions[i].name}/{self.gears[g].side.value}" for i, g in self.meshes)

    @property
    def angles(self) -> NDArray[np.float64]:
        """Distribution angles, shape (pinions,), rad."""
        return 2.0 * np.pi * np.array([pinion.pitches for pinion in self.pinions]) / self.gear_teeth

    def mesh_index(self, pinion: int, side: Side) -> int:
        """Position of a mesh in `meshes`. Raises KeyError if the layout has no such gear."""
        sides = [gear.side for gear in self.gears]
        if side not in sides:
            raise KeyError(side)
        return sides.index(side) * len(self.pinions) + pinion
