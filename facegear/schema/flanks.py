"""Config section `flanks` of either gear: deviations of flanks as measured or as wanted, in grids."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from facegear.number_format import count_noun
from facegear.schema.base import Section, refuse
from facegear.schema.csv_file import CsvFault, read_flanks

Side = Literal["right", "left"]
SIDES: tuple[Side, ...] = ("right", "left")
"""Flanks of a tooth."""


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
        """Refuse positions that do not rise and deviations of another shape."""
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
        """Refuse two grids of one tooth's flank."""
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
    """Return section `flanks` with the grids of its csv file in place of the file's name, if it names
    one.

    Lists become tuples. A fault is refused under the key of the body's file.
    """
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
    """Return nested values with all lists as tuples."""
    if isinstance(value, Mapping):
        return {key: _tupled(item) for key, item in value.items()}
    return tuple(_tupled(item) for item in value) if isinstance(value, list | tuple) else value
