"""Config sections `shafts` and `torsion` of a transmission: what pinions sit on, and what torques turn."""

from string import ascii_uppercase
from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from facegear.arrays import Array
from facegear.rigid_body import MOTIONS, is_held
from facegear.schema.base import Section, refuse, require_all
from facegear.schema.bodies import Position
from facegear.schema.gear_body import MaterialSection
from facegear.schema.rolling import ONE_WAY, RollingSection

SOFTEST_BEARING, STIFFEST_BEARING = 1e6, 1e14
"""Limits of a bearing's stiffness across and along the shaft, N/m."""
SHORTEST_MM, LONGEST_MM = 0.5, 1e4
"""Limits of the length of a segment, mm."""
STEEL = MaterialSection(young_modulus_gpa=206.0, poisson_ratio=0.3)
"""Material of a shaft that gives none."""
MOTIONS_KEPT = "x, y, z, tilt_x, tilt_y"
"""Order of rows and columns of a bearing's stiffness matrix."""
SYMMETRIC = 1e-9
"""Relative size up to which the skew part and a negative eigenvalue of a bearing's matrix count as rounding.
"""
HOLDING_STIFFNESS = 1e8
"""Stiffness that stands for a rolling bearing where only it counts which motions it holds, N/m."""
RESERVED = ("x", "y", "z", "theta", "tilt_x", "tilt_y")
"""Names that no turning mass may have: those of motions."""
OUTPUT = "output"
"""Key of the masses behind the face gear that gives the power out."""


class SegmentSection(Section):
    """A piece of shaft between two steps."""

    length_mm: float = Field(ge=SHORTEST_MM, le=LONGEST_MM, description="along the shaft")
    diameter_mm: float = Field(ge=1, le=5000, description="outer diameter")
    bore_mm: float = Field(0.0, ge=0, le=5000, description="diameter of the bore; 0: a solid shaft")

    @model_validator(mode="after")
    def _hollow(self) -> "SegmentSection":
        """Refuse a bore that is not below the outer diameter."""
        if self.bore_mm >= self.diameter_mm:
            refuse("bore_mm", self.bore_mm, f"below diameter_mm = {self.diameter_mm:g}")
        return self


class ShaftBearing(Section):
    """A bearing: stiffness across and along the shaft and against tilting, or its matrix, or a rolling
    bearing.
    """

    at_mm: float = Field(ge=0, le=LONGEST_MM * 100, description="from the beginning of the first segment")
    radial_n_per_m: float | None = Field(
        None, ge=SOFTEST_BEARING, le=STIFFEST_BEARING, description="stiffness across the shaft"
    )
    axial_n_per_m: float | None = Field(
        None,
        ge=SOFTEST_BEARING,
        le=STIFFEST_BEARING,
        description="stiffness along the shaft; null: it does not hold the shaft that way",
    )
    tilt_n_m_per_rad: float | None = Field(
        None, ge=1e-3, le=1e12, description="stiffness against tilting; null: none"
    )
    matrix: tuple[tuple[Annotated[float, Field(ge=-1e16, le=1e16)], ...], ...] | None = Field(
        None, description=f"5 x 5 in {MOTIONS_KEPT}, N/m, N/rad and N m/rad, in place of the others"
    )
    rolling: RollingSection | None = Field(
        None, description="in place of all stiffnesses: a rolling bearing that knows its load"
    )

    position_um: Position = Field(
        Position(), description="of the bore of a rolling bearing relative to its nominal place"
    )

    @model_validator(mode="after")
    def _given_once(self) -> "ShaftBearing":
        """Check that stiffness is given once and the matrix is valid."""
        require_all(self._not_twice, self._square, self._check_position)
        return self

    def _check_position(self) -> None:
        """Refuse the position of a bore of springs, and one of 0.02 element diameters or more."""
        if self.rolling is None:
            if self.position_um != Position():
                requirement = "left out without rolling: single_pinions.<name>.position_um moves all bearings"
                refuse("position_um", self.position_um.model_dump(), requirement)
            return
        largest = 20.0 * self.rolling.element_diameter_mm
        for axis in "xyz":
            distance = getattr(self.position_um, axis)
            if abs(distance) >= largest:
                requirement = f"smaller than 0.02 element_diameter_mm, which is {largest:g} um"
                refuse(f"position_um.{axis}", distance, requirement)

    def _not_twice(self) -> None:
        """Refuse a bearing with a matrix and single stiffnesses, with rolling and any, or with nothing."""
        keys = ("radial_n_per_m", "axial_n_per_m", "tilt_n_m_per_rad")
        if self.rolling is not None:
            for key in (*keys, "matrix"):
                if (value := getattr(self, key)) is not None:
                    refuse(key, value, "left out beside rolling, whose stiffness follows from its load")
            return
        if self.matrix is None:
            if self.radial_n_per_m is None:
                refuse("radial_n_per_m", None, "given, or else matrix or rolling")
            return
        for key in keys:
            if (value := getattr(self, key)) is not None:
                refuse(key, value, "left out beside matrix, which holds it")

    def _square(self) -> None:
        """Refuse a stiffness matrix that is not 5 by 5, symmetric and positive."""
        if self.matrix is None:
            return
        if [len(row) for row in self.matrix] != [MOTIONS] * MOTIONS:
            refuse("matrix", [len(row) for row in self.matrix], f"5 rows of 5 numbers, in {MOTIONS_KEPT}")
        matrix = np.array(self.matrix)
        size = np.sqrt(np.abs(np.outer(matrix.diagonal(), matrix.diagonal())))
        if (np.abs(matrix - matrix.T) > SYMMETRIC * size).any():
            refuse("matrix", self.matrix, "symmetric")
        if np.linalg.eigvalsh(matrix).min() < -SYMMETRIC * np.abs(matrix).max():
            refuse("matrix", self.matrix, "such that it resists every motion: no negative eigenvalue")

    def stiffness(self) -> Array:
        """Return the stiffness matrix of the bearing: the given one, else diagonal from its single
        stiffnesses.

        Returns
        -------
        (5, 5) array
            Forces and moments over displacements in x, y, z, tilt_x and tilt_y, N/m, N/rad and N m/rad. A
            rolling bearing has HOLDING_STIFFNESS where it holds the shaft.
        """
        if self.rolling is not None:
            holds_along = self.rolling.type != "cylindrical_roller"
            return np.diag([HOLDING_STIFFNESS, HOLDING_STIFFNESS, HOLDING_STIFFNESS * holds_along, 0.0, 0.0])
        if self.matrix is not None:
            return np.array(self.matrix, float)
        across, along, tilting = (
            value or 0.0 for value in (self.radial_n_per_m, self.axial_n_per_m, self.tilt_n_m_per_rad)
        )
        return np.diag([across, across, along, tilting, tilting])


class PreloadSection(Section):
    """Preload of two rolling bearings of a shaft, before it is loaded."""

    bearings: tuple[str, ...] = Field(
        description="letters of the two, A being the first bearing of the list: [A, B]"
    )
    axial_um: float | None = Field(
        None, ge=-500, le=500, description="by which the inner rings are pressed together; negative: endplay"
    )
    axial_n: float | None = Field(None, gt=0, le=1e6, description="thrust in the pair, in place of axial_um")

    @model_validator(mode="after")
    def _of_two(self) -> "PreloadSection":
        """Refuse a preload of other than two bearings, and one given twice or not at all."""
        require_all(self._two_letters, self._one_amount)
        return self

    def _two_letters(self) -> None:
        """Refuse anything but two different letters."""
        letters = list(self.bearings)
        if len(letters) != 2 or len(set(letters)) != 2:
            refuse("bearings", letters, "two different letters, such as [A, B]")

    def _one_amount(self) -> None:
        """Refuse both amounts or none."""
        if (self.axial_um is None) == (self.axial_n is None):
            refuse("axial_um", self.axial_um, "given, or else axial_n, but not both")


class ShaftSection(Section):
    """Shaft of a pinion, in place of its bearing stiffness; lengths count away from the gears' axis."""

    segments: tuple[SegmentSection, ...] = Field(max_length=100, description="one or more")
    pinion_mm: float = Field(
        ge=0, le=LONGEST_MM * 100, description="middle of the pinion, from the beginning of the first segment"
    )
    bearings: tuple[ShaftBearing, ...] = Field(
        max_length=10, description="one or more, named A, B and so on in this order"
    )
    material: MaterialSection = Field(STEEL, description="of the shaft")
    tilt_inertia_kg_m2: float | None = Field(
        None,
        ge=1e-12,
        le=1e5,
        description="of the pinion about a diameter; null: it does not tilt in the dynamics, or, with teeth "
        "that are not spur teeth at right angles, half of its inertia about its axis",
    )
    preload: PreloadSection | None = Field(None, description="of two rolling bearings; null: none")

    def at_speed(self, speed_rpm: float) -> "ShaftSection":
        """Return the shaft with its speed filled in where rolling elements feel centrifugal force.

        Parameters
        ----------
        speed_rpm : float
            Speed of the shaft, rpm.

        Returns
        -------
        ShaftSection
            The shaft itself where none do.
        """
        bearings = tuple(
            bearing
            if bearing.rolling is None or not bearing.rolling.centrifugal
            else bearing.model_copy(
                update={"rolling": bearing.rolling.model_copy(update={"speed_rpm": speed_rpm})}
            )
            for bearing in self.bearings
        )
        return self if bearings == self.bearings else self.model_copy(update={"bearings": bearings})

    @property
    def length_mm(self) -> float:
        """Sum of the lengths of all segments, mm, rounded to 9 decimals against rounding errors."""
        return round(sum(segment.length_mm for segment in self.segments), 9)

    @property
    def is_round(self) -> bool:
        """Whether every bearing is equally stiff in all radial directions: none is given by a matrix or
        rolling.
        """
        return all(bearing.matrix is None and bearing.rolling is None for bearing in self.bearings)

    @property
    def is_rolling(self) -> bool:
        """Whether a bearing of the shaft is a rolling bearing."""
        return any(bearing.rolling is not None for bearing in self.bearings)

    @model_validator(mode="after")
    def _stands(self) -> "ShaftSection":
        """Refuse a shaft without segments or bearings, or one that its bearings do not hold."""
        for key in ("segments", "bearings"):
            if not getattr(self, key):
                refuse(key, [], "one or more")
        require_all(self._stations, self._check_support, self._check_preload)
        return self

    def _stations(self) -> None:
        """Refuse a pinion or a bearing beyond the end of the shaft."""
        length = self.length_mm
        requirement = f"on the shaft, from 0 to {length:g} mm"
        if self.pinion_mm > length:
            refuse("pinion_mm", self.pinion_mm, requirement)
        for number, bearing in enumerate(self.bearings):
            if bearing.at_mm > length:
                refuse(f"bearings[{number}].at_mm", bearing.at_mm, requirement)

    def _check_support(self) -> None:
        """Refuse bearings that leave the shaft free to move."""
        stations = [bearing.at_mm for bearing in self.bearings]
        if max(self.pinion_mm, *stations) > self.length_mm:
            return
        distances = [1e-3 * (at - self.pinion_mm) for at in stations]
        stiffnesses = [bearing.stiffness() for bearing in self.bearings]
        if not is_held(distances, stiffnesses, 1e-3 * self.length_mm):
            condition = "such that they hold it along its axis and against tilting"
            if self.is_rolling:
                condition += (
                    "; cylindrical rollers take no thrust, and one rolling bearing does not count there"
                )
            refuse("bearings", f"at {', '.join(f'{at:g}' for at in stations)} mm", condition)
        self._check_thrust()

    def _check_thrust(self) -> None:
        """Refuse bearings that hold the shaft along its axis one way only."""
        ways, first = set(), None
        for number, bearing in enumerate(self.bearings):
            if bearing.rolling is None or bearing.rolling.type not in ONE_WAY:
                if bearing.stiffness()[2, 2] > 0.0:
                    return
                continue
            ways.add(bearing.rolling.loaded_by)
            first = number if first is None else first
        if len(ways) == 1:
            way = ways.pop()
            requirement = (
                "the opposite of it at another bearing: no bearing takes the shaft's thrust that way"
            )
            refuse(f"bearings[{first}].rolling.loaded_by", way, requirement)

    def _check_preload(self) -> None:
        """Refuse a preload of bearings that cannot be pressed against each other."""
        if self.preload is None:
            return
        letters, ways = ascii_uppercase[: len(self.bearings)], []
        for letter in self.preload.bearings:
            if letter not in letters or not letter:
                refuse(
                    "preload.bearings",
                    letter,
                    f"letters of the shaft's bearings, {letters[0]} to {letters[-1]}",
                )
            section = self.bearings[letters.index(letter)].rolling
            if section is None or section.type == "cylindrical_roller":
                requirement = "rolling bearings that take thrust: neither springs nor cylindrical rollers"
                refuse("preload.bearings", letter, requirement)
            ways.append(section.loaded_by)
        if ways[0] is not None and ways[0] == ways[1]:
            refuse("preload.bearings", list(self.preload.bearings), "bearings with opposite loaded_by")


class TurningMassSection(Section):
    """A turning mass behind a torsional spring."""

    name: str = Field(
        pattern="^[a-z][a-z0-9_]*$", max_length=30, description="names the mass in tables and modes"
    )
    inertia_kg_m2: float = Field(ge=1e-12, le=1e7, description="reduced to the speed of the gear")
    stiffness_n_m_per_rad: float | None = Field(
        None, ge=1, le=1e12, description="of the spring before it, reduced to the speed of the gear"
    )
    segments: tuple[SegmentSection, ...] = Field(
        (), max_length=100, description="in place of the stiffness: the shaft that twists"
    )
    material: MaterialSection = Field(STEEL, description="of the shaft that the segments make")
    damping_ratio: float = Field(
        0.01, ge=0, le=0.5, description="of the two masses that the spring joins, by themselves"
    )

    @model_validator(mode="after")
    def _one_spring(self) -> "TurningMassSection":
        """Refuse a torsional spring given twice or not at all."""
        if (self.stiffness_n_m_per_rad is None) != bool(self.segments):
            requirement = "given, or else segments, but not both"
            refuse("stiffness_n_m_per_rad", self.stiffness_n_m_per_rad, requirement)
        if self.name in RESERVED:
            refuse("name", self.name, f"none of {', '.join(RESERVED)}, which name motions of the gear itself")
        return self
