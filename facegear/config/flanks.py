"""Config section `flanks` of either gear: deviations of flanks as measured or as wanted, in grids."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from facegear.arrays import Array
from facegear.config.base import Section, refuse
from facegear.config.csv_file import CsvFault
from facegear.config.flank_csv import read_flanks
from facegear.geometry.design import DeviationGrid, Flanks
from facegear.geometry.deviations import deviation
from facegear.geometry.nominal import Face, nominal_points
from facegear.number_format import count_noun

Side = Literal["right", "left"]
SIDES: tuple[Side, ...] = ("right", "left")
Teeth = tuple[DeviationGrid | None, ...]
"""Deviations of one flank of every tooth."""
MIN_COVERAGE = 0.5
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
            actual_shape = [len(self.deviation_um), max(map(len, self.deviation_um), default=0)]
            refuse("deviation_um", actual_shape, f"{shape[0]} rows of {shape[1]}: face_mm times profile_mm")
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
    """Read the grids of both bodies' files into the plain values of section `tooth_pair`.

    Parameters
    ----------
    values : Any
        Plain values of the section; anything else than a mapping is returned as it is.

    Returns
    -------
    Any
        The values with grids in place of files.
    """
    if not isinstance(values, Mapping):
        return values
    for body in ("pinion", "face_gear"):
        body_values = values.get(body)
        if isinstance(body_values, Mapping) and isinstance(flanks := body_values.get("flanks"), Mapping):
            values = {**values, body: {**body_values, "flanks": _read(flanks, body)}}
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
    """Refuse grids that do not belong to this gear: its teeth, places, nominal points and normals.

    Parameters
    ----------
    section : FlanksSection
        Section `flanks` of a body.
    key : str
        Key of the section, for errors.
    face : Face
        Nominal flank.
    teeth : int
        Number of teeth.
    """
    for grid in section.grids:
        flank_name = f"{key}.grids: {grid.flank} flank of tooth {grid.tooth or 'all'}"
        if grid.tooth is not None and grid.tooth > teeth:
            refuse(f"{flank_name}: tooth", grid.tooth, f"at most {teeth}, the number of teeth")
        _check_places(grid, flank_name, face)
        largest = max(abs(value) for row in grid.deviation_um for value in row)
        if largest * abs(section.amplitude) > LARGEST:
            refuse(f"{flank_name}: deviation_um", largest, f"at most {LARGEST:g} um with its amplitude")
        if grid.nominal:
            _check_nominal(grid, flank_name, face)
    for side in SIDES:
        numbers = {grid.tooth for grid in section.grids if grid.flank == side}
        absent_teeth = set(range(1, teeth + 1)) - numbers
        if numbers and None not in numbers and absent_teeth:
            requirement = f"given for all {teeth} teeth, or with a grid for tooth all, which the others have"
            refuse(f"{key}.grids: {side} flank: tooth", min(absent_teeth), requirement)


def _check_places(grid: GridSection, flank_name: str, face: Face) -> None:
    for name, (low, high) in (("face_mm", face.face), ("profile_mm", face.profile)):
        line, low, high = getattr(grid, name), 1e3 * low, 1e3 * high
        slack = 1e-3 * (high - low)
        for end in (line[0], line[-1]):
            if not low - slack <= end <= high + slack:
                refuse(f"{flank_name}: {name}", end, f"from {low:.3f} to {high:.3f}, where the flank is")
        if line[-1] - line[0] < MIN_COVERAGE * (high - low):
            ends = [line[0], line[-1]]
            refuse(
                f"{flank_name}: {name}", ends, f"at least {MIN_COVERAGE:.0%} of {low:.3f} to {high:.3f} mm"
            )


def _check_nominal(grid: GridSection, flank_name: str, face: Face) -> None:
    file_values, lines = (
        np.array(grid.nominal),
        (1e-3 * np.array(line) for line in (grid.face_mm, grid.profile_mm)),
    )
    points, normals = nominal_points(face, grid.flank, *lines)
    off = 1e-3 * file_values[..., :3] - points
    worst = np.unravel_index(np.argmax(np.abs(off).max(axis=-1)), off.shape[:-1])
    if np.abs(off[worst]).max() > 1e-3 * POINT_MM:
        mirror_image = points * np.array([-1.0, 1.0, 1.0])
        is_mirrored = np.abs(1e-3 * file_values[..., :3] - mirror_image).max() <= 1e-3 * POINT_MM
        nominal = ", ".join(f"{1e3 * value:.3f}" for value in points[worst])
        requirement = f"{nominal}, within {POINT_MM:g}{'; the file is mirrored' if is_mirrored else ''}"
        refuse(f"{flank_name}: x_mm, y_mm, z_mm", file_values[worst][:3].tolist(), requirement)
    along = np.sum(file_values[..., 3:] * normals, axis=-1)
    worst = np.unravel_index(np.argmin(along), along.shape)
    if along[worst] < 1.0 - NORMAL:
        hint = "; they are turned: they point into the material" if along.max() < NORMAL - 1.0 else ""
        outward = ", ".join(f"{value:.4f}" for value in normals[worst])
        refuse(
            f"{flank_name}: nx, ny, nz",
            file_values[worst][3:].tolist(),
            f"the outward normal {outward}{hint}",
        )


def fields_of(section: FlanksSection, side: Side, face: Face, teeth: int) -> Array | None:
    """Return the deviations of one flank of all teeth.

    Parameters
    ----------
    section : FlanksSection
        Section `flanks` of a body.
    side : Side
        `right` or `left`.
    face : Face
        Nominal flank.
    teeth : int
        Number of teeth.

    Returns
    -------
    (teeth, n_face, n_profile) array or None
        Deviations along the outward normal, m; None where the flank is as designed.
    """
    grids = {grid.tooth: grid for grid in section.grids if grid.flank == side}
    if not grids:
        return None
    values = {tooth: _values(section, grid, face) for tooth, grid in grids.items()}
    tooth_numbers = range(1, teeth + 1)
    return np.stack([values[number if number in values else None] for number in tooth_numbers])


def _values(section: FlanksSection, grid: GridSection, face: Face) -> Array:
    """Deviations (n_face, n_profile) m of one grid."""
    values = 1e-6 * section.amplitude * np.array(grid.deviation_um)
    if section.pitch_and_thickness == "left_out":
        values = values - deviation(deviation_grid(grid, values), *face.middle)
    return values


def deviation_grid(grid: GridSection, values: Array) -> DeviationGrid:
    """Return values at the places of a grid, in SI units.

    Parameters
    ----------
    grid : GridSection
        Grid of the config.
    values : (n_face, n_profile) array
        Deviations, m.

    Returns
    -------
    DeviationGrid
        The grid with these values.
    """
    face, profile = (tuple(1e-3 * at for at in line) for line in (grid.face_mm, grid.profile_mm))
    return DeviationGrid(face, profile, tuple(map(tuple, values.tolist())))


def common_flanks(section: FlanksSection, face: Face, teeth: int) -> Flanks:
    """Return the mean deviations of all teeth.

    Parameters
    ----------
    section : FlanksSection
        Section `flanks` of a body.
    face : Face
        Nominal flank.
    teeth : int
        Number of teeth.

    Returns
    -------
    Flanks
        Mean deviations of both flanks, m.
    """
    return Flanks(**{side: common_grid(section, side, face, teeth) for side in SIDES})


def common_grid(section: FlanksSection, side: Side, face: Face, teeth: int) -> DeviationGrid | None:
    """Return the mean deviations of one flank of all teeth.

    Parameters
    ----------
    section : FlanksSection
        Section `flanks` of a body.
    side : Side
        `right` or `left`.
    face : Face
        Nominal flank.
    teeth : int
        Number of teeth.

    Returns
    -------
    DeviationGrid or None
        Mean deviations, m; None where the flank is as designed.
    """
    grids = [grid for grid in section.grids if grid.flank == side]
    if not grids:
        return None
    if len(grids) == 1 and grids[0].tooth is None:
        return deviation_grid(grids[0], _values(section, grids[0], face))
    fields = fields_of(section, side, face, teeth)
    assert fields is not None
    return deviation_grid(grids[0], fields.mean(axis=0))


def differences(section: FlanksSection, side: Side, face: Face, teeth: int) -> Teeth | None:
    """Return the difference of each tooth from the mean of one flank of all teeth.

    Parameters
    ----------
    section : FlanksSection
        Section `flanks` of a body.
    side : Side
        `right` or `left`.
    face : Face
        Nominal flank.
    teeth : int
        Number of teeth.

    Returns
    -------
    Teeth or None
        Differences (m) tooth by tooth; equal ones are one object. None where all teeth are alike.
    """
    grids = [grid for grid in section.grids if grid.flank == side]
    fields = fields_of(section, side, face, teeth)
    if fields is None or len(grids) == 1:
        return None
    distinct_grids: dict[bytes, DeviationGrid] = {}
    for values in fields - fields.mean(axis=0):
        distinct_grids.setdefault(values.tobytes(), deviation_grid(grids[0], values))
    return tuple(distinct_grids[values.tobytes()] for values in fields - fields.mean(axis=0))
