"""Config section `flanks` of either gear: deviations of flanks as measured or as wanted, in grids."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from facegear.arrays import Array
from facegear.config.base import Section, refuse
from facegear.config.flank_csv import CsvFault, read_flanks
from facegear.geometry.design import DeviationGrid, Flanks
from facegear.geometry.deviations import deviation
from facegear.geometry.nominal import Face, nominal_points
from facegear.number_format import count_noun

Side = Literal["right", "left"]
SIDES: tuple[Side, ...] = ("right", "left")
Teeth = tuple[DeviationGrid | None, ...]
"""Deviations of one flank of every tooth."""
COVERED = 0.5
"""Part of the flank, along the face and along the profile, that a grid must cover at least."""
POINT_MM, NORMAL = 0.05, 0.02
"""By how much nominal points and normals of a file may be off."""
LARGEST = 500.0
"""Largest deviation (um) after its amplitude."""


class GridSection(Section):
    """Deviations from the nominal flank at the places of a grid, along its outward normal."""

    tooth: int | None = Field(
        None, ge=1, le=2000, description="from 1 in the order in which they come into mesh; null: all others"
    )
    flank: Side = Field(
        description="as docs/explanation/geometry.md has them: the pinion's right drives the gear's left"
    )
    face_mm: tuple[Annotated[float, Field(ge=-1e5, le=1e5)], ...] = Field(
        min_length=2, max_length=1000, description="pinion: from the middle of its face; face gear: radius"
    )
    profile_mm: tuple[Annotated[float, Field(ge=-1e5, le=1e5)], ...] = Field(
        min_length=2,
        max_length=1000,
        description="pinion: length of roll; face gear: depth below the tip plane",
    )
    deviation_um: tuple[tuple[Annotated[float, Field(ge=-1e5, le=1e5)], ...], ...] = Field(
        description="a row for each place along the face; positive: material"
    )
    nominal: tuple[tuple[tuple[Annotated[float, Field(ge=-1e6, le=1e6)], ...], ...], ...] = Field(
        (), exclude=True, description="of a file that has them: nominal point (mm) and normal at each place"
    )

    @model_validator(mode="after")
    def _regular(self) -> "GridSection":
        for name in ("face_mm", "profile_mm"):
            line = getattr(self, name)
            for before, after in pairwise(line):
                if after <= before:
                    refuse(name, after, f"above the value before it, {before:g}")
        shape = len(self.face_mm), len(self.profile_mm)
        if len(self.deviation_um) != shape[0] or any(len(row) != shape[1] for row in self.deviation_um):
            given = [len(self.deviation_um), max(map(len, self.deviation_um), default=0)]
            refuse("deviation_um", given, f"{shape[0]} rows of {shape[1]}: face_mm times profile_mm")
        return self


class FlanksSection(Section):
    """Flanks as measured or as wanted: deviations from the nominal flank, of all teeth or of single ones."""

    file: str | None = Field(
        None, min_length=1, description="csv instead of grids; its path counts from this file's folder"
    )
    pitch_and_thickness: Literal["included", "left_out"] = Field(
        "included", description="left_out: each tooth counts from its value at the middle of its flank"
    )
    amplitude: float = Field(1.0, ge=-10, le=10, description="factor on all deviations")
    grids: tuple[GridSection, ...] = Field(
        (), max_length=4000, description="instead of a file: one a flank, for all teeth or for a single one"
    )

    @model_validator(mode="after")
    def _complete(self) -> "FlanksSection":
        for side in SIDES:
            teeth = [grid.tooth for grid in self.grids if grid.flank == side]
            for number, tooth in enumerate(teeth):
                if tooth in teeth[:number]:
                    refuse("grids", tooth or "all", f"one grid for each tooth of the {side} flank")
            axes = {(grid.face_mm, grid.profile_mm) for grid in self.grids if grid.flank == side}
            if len(axes) > 1:
                refuse(
                    "grids",
                    count_noun(len(axes), "grid"),
                    f"at the same places on all teeth of the {side} flank",
                )
        return self


def read_files(values: Any) -> Any:
    """Plain values of section tooth_pair with the grids of both bodies' files read into it."""
    if not isinstance(values, Mapping):
        return values
    for body in ("pinion", "face_gear"):
        own = values.get(body)
        if isinstance(own, Mapping) and isinstance(flanks := own.get("flanks"), Mapping):
            values = {**values, body: {**own, "flanks": _read(flanks, body)}}
    return values


def _read(values: Mapping[str, Any], body: str) -> dict[str, Any]:
    read = dict(values)
    if isinstance(name := values.get("file"), str):
        if values.get("grids"):
            refuse(f"{body}.flanks.file", name, "either file or grids, not both")
        if name.lower().endswith((".xml", ".gde")):
            refuse(f"{body}.flanks.file", name, "a csv of deviations: GDE files (VDI/VDE 2610) are not read")
        try:
            read |= {"file": None, **read_flanks(name, body)}
        except CsvFault as fault:
            refuse(f"{body}.flanks.file", name, f"a csv of deviations; {fault}")
    if isinstance(grids := read.get("grids"), list):
        read["grids"] = tuple(_tupled(grid) for grid in grids)
    return read


def _tupled(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _tupled(item) for key, item in value.items()}
    return tuple(_tupled(item) for item in value) if isinstance(value, list | tuple) else value


def check_flanks(section: FlanksSection, key: str, face: Face, teeth: int) -> None:
    """Refuse grids that are not of this gear: its teeth, places, nominal points and normals."""
    for grid in section.grids:
        which = f"{key}.grids: {grid.flank} flank of tooth {grid.tooth or 'all'}"
        if grid.tooth is not None and grid.tooth > teeth:
            refuse(f"{which}: tooth", grid.tooth, f"at most {teeth}, the number of teeth")
        _check_places(grid, which, face)
        largest = max(abs(value) for row in grid.deviation_um for value in row)
        if largest * abs(section.amplitude) > LARGEST:
            refuse(f"{which}: deviation_um", largest, f"at most {LARGEST:g} um with its amplitude")
        if grid.nominal:
            _check_nominal(grid, which, face)
    for side in SIDES:
        numbers = {grid.tooth for grid in section.grids if grid.flank == side}
        missing = set(range(1, teeth + 1)) - numbers
        if numbers and None not in numbers and missing:
            allowed = f"given for all {teeth} teeth, or with a grid for tooth all, which the others have"
            refuse(f"{key}.grids: {side} flank: tooth", min(missing), allowed)


def _check_places(grid: GridSection, which: str, face: Face) -> None:
    for name, (low, high) in (("face_mm", face.face), ("profile_mm", face.profile)):
        line, low, high = getattr(grid, name), 1e3 * low, 1e3 * high
        slack = 1e-3 * (high - low)
        for end in (line[0], line[-1]):
            if not low - slack <= end <= high + slack:
                refuse(f"{which}: {name}", end, f"from {low:.3f} to {high:.3f}, where the flank is")
        if line[-1] - line[0] < COVERED * (high - low):
            covered = [line[0], line[-1]]
            refuse(f"{which}: {name}", covered, f"at least {COVERED:.0%} of {low:.3f} to {high:.3f} mm")


def _check_nominal(grid: GridSection, which: str, face: Face) -> None:
    given, lines = np.array(grid.nominal), (1e-3 * np.array(line) for line in (grid.face_mm, grid.profile_mm))
    points, normals = nominal_points(face, grid.flank, *lines)
    off = 1e-3 * given[..., :3] - points
    worst = np.unravel_index(np.argmax(np.abs(off).max(axis=-1)), off.shape[:-1])
    if np.abs(off[worst]).max() > 1e-3 * POINT_MM:
        other = points * np.array([-1.0, 1.0, 1.0])
        mirrored = np.abs(1e-3 * given[..., :3] - other).max() <= 1e-3 * POINT_MM
        nominal = ", ".join(f"{1e3 * value:.3f}" for value in points[worst])
        allowed = f"{nominal}, within {POINT_MM:g}{'; the file is mirrored' if mirrored else ''}"
        refuse(f"{which}: x_mm, y_mm, z_mm", given[worst][:3].tolist(), allowed)
    along = np.sum(given[..., 3:] * normals, axis=-1)
    worst = np.unravel_index(np.argmin(along), along.shape)
    if along[worst] < 1.0 - NORMAL:
        turned = "; they are turned: they point into the material" if along.max() < NORMAL - 1.0 else ""
        outward = ", ".join(f"{value:.4f}" for value in normals[worst])
        refuse(f"{which}: nx, ny, nz", given[worst][3:].tolist(), f"the outward normal {outward}{turned}")


def fields_of(section: FlanksSection, side: Side, face: Face, teeth: int) -> Array | None:
    """Deviations (teeth, n_face, n_profile) m of one flank of all teeth; None where it is as designed."""
    grids = {grid.tooth: grid for grid in section.grids if grid.flank == side}
    if not grids:
        return None
    values = {tooth: _values(section, grid, face) for tooth, grid in grids.items()}
    numbered = range(1, teeth + 1)
    return np.stack([values[number if number in values else None] for number in numbered])


def _values(section: FlanksSection, grid: GridSection, face: Face) -> Array:
    """Deviations (n_face, n_profile) m of one grid."""
    values = 1e-6 * section.amplitude * np.array(grid.deviation_um)
    if section.pitch_and_thickness == "left_out":
        values = values - deviation(deviation_grid(grid, values), *face.middle)
    return values


def deviation_grid(grid: GridSection, values: Array) -> DeviationGrid:
    """Values (n_face, n_profile) m at the places of a grid."""
    face, profile = (tuple(1e-3 * at for at in line) for line in (grid.face_mm, grid.profile_mm))
    return DeviationGrid(face, profile, tuple(map(tuple, values.tolist())))


def common_flanks(section: FlanksSection, face: Face, teeth: int) -> Flanks:
    """The mean of all teeth."""
    return Flanks(**{side: common_grid(section, side, face, teeth) for side in SIDES})


def common_grid(section: FlanksSection, side: Side, face: Face, teeth: int) -> DeviationGrid | None:
    """The mean of one flank of all teeth; None where it is as designed."""
    grids = [grid for grid in section.grids if grid.flank == side]
    if not grids:
        return None
    if len(grids) == 1 and grids[0].tooth is None:
        return deviation_grid(grids[0], _values(section, grids[0], face))
    fields = fields_of(section, side, face, teeth)
    assert fields is not None
    return deviation_grid(grids[0], fields.mean(axis=0))


def differences(section: FlanksSection, side: Side, face: Face, teeth: int) -> Teeth | None:
    """What each tooth deviates by from the mean of one flank of all teeth; None where all are alike."""
    grids = [grid for grid in section.grids if grid.flank == side]
    fields = fields_of(section, side, face, teeth)
    if fields is None or len(grids) == 1:
        return None
    alike: dict[bytes, DeviationGrid] = {}
    for values in fields - fields.mean(axis=0):
        alike.setdefault(values.tobytes(), deviation_grid(grids[0], values))
    return tuple(alike[values.tobytes()] for values in fields - fields.mean(axis=0))
