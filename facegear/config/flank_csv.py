"""Reading of csv files of deviations of measured flanks, as plain values of the config's section `flanks`."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from facegear.config.csv_file import CsvFault, read_table

NUMBERS = ("face_mm", "profile_mm", "deviation_um")
"""Columns of numbers of a csv of flanks."""
TEXTS = ("body", "tooth", "flank")
"""Columns of texts of a csv of flanks."""
NOMINAL = ("x_mm", "y_mm", "z_mm", "nx", "ny", "nz")
"""Columns that may stand beside the others: the nominal point and its outward normal."""
BODIES = ("pinion", "face_gear")
"""Texts allowed in column `body`."""
SIDES = ("right", "left")
"""Texts allowed in column `flank`."""
HEADER = "pitch and thickness"
"""Name of the remark that says whether pitch and thickness are included."""
PITCH_REMARKS = {"included": "included", "left out": "left_out"}
"""Values of the remark `pitch and thickness`, each with the value of the config's key."""
LARGEST = 300.0
"""Largest deviation (um) of a gear that could run."""
SMALLEST = 0.05
"""Largest deviation (um) of a whole file, not all zero, that no measuring machine sees."""


class _Point(NamedTuple):
    line: int
    deviation: float
    nominal: tuple[float, ...]


def read_flanks(path: str | Path, body: str) -> dict[str, Any]:
    """Read the flanks of one body as keys `pitch_and_thickness` and `grids` of section `flanks`.

    Parameters
    ----------
    path : str or Path
        The csv file.
    body : str
        `pinion` or `face_gear`.

    Returns
    -------
    dict[str, Any]
        Plain values of both keys.

    Raises
    ------
    CsvFault
        With the line where there is one.
    """
    table = read_table(path, NUMBERS, TEXTS, NOMINAL)
    pitch_and_thickness = _header(table.remarks)
    grids: dict[tuple[int | None, str], dict[tuple[float, float], _Point]] = {}
    for row, texts in table.rows:
        _check_texts(row.line, texts)
        if texts["body"] != body:
            continue
        values = row.values
        if abs(values["deviation_um"]) > LARGEST:
            requirement = f"must be from -{LARGEST:g} to {LARGEST:g} um"
            raise CsvFault(f"line {row.line}: deviation_um = {values['deviation_um']:g} {requirement}")
        grid = grids.setdefault((_tooth(row.line, texts["tooth"]), texts["flank"]), {})
        at = round(values["face_mm"], 6), round(values["profile_mm"], 6)
        if at in grid:
            raise CsvFault(f"line {row.line}: the same place stands in line {grid[at].line}")
        nominal = tuple(values[name] for name in NOMINAL if name in values)
        grid[at] = _Point(row.line, values["deviation_um"], nominal)
    if not grids:
        raise CsvFault(f"it has no rows with body {body}")
    _check_unit(grids)
    return {
        "pitch_and_thickness": pitch_and_thickness,
        "grids": [_grid(*key, grid) for key, grid in grids.items()],
    }


def _header(remarks: Iterable[str]) -> str:
    for remark in remarks:
        name, _, remark_value = remark.partition(":")
        if name.strip() == HEADER:
            if remark_value.strip() in PITCH_REMARKS:
                return PITCH_REMARKS[remark_value.strip()]
            raise CsvFault(f"{HEADER} = {remark_value.strip()!r} must be {' or '.join(PITCH_REMARKS)}")
    raise CsvFault(f"before its column names it must have the line '# {HEADER}: included' or '...: left out'")


def _check_texts(line: int, texts: Mapping[str, str]) -> None:
    for column, known_texts in (("body", BODIES), ("flank", SIDES)):
        if texts[column] not in known_texts:
            raise CsvFault(
                f"line {line}: {column} = {texts[column][:40]!r} must be {' or '.join(known_texts)}"
            )


def _tooth(line: int, text: str) -> int | None:
    if text == "all":
        return None
    if not (text.isascii() and text.isdigit() and int(text) > 0):
        raise CsvFault(f"line {line}: tooth = {text[:40]!r} must be all, or a number from 1")
    return int(text)


def _check_unit(grids: Mapping[Any, Mapping[Any, _Point]]) -> None:
    largest = max(abs(point.deviation) for grid in grids.values() for point in grid.values())
    if 0.0 < largest < SMALLEST:
        raise CsvFault(
            f"its largest deviation_um = {largest:g} must be 0 or above {SMALLEST:g}: are they in mm?"
        )


def _grid(tooth: int | None, flank: str, points: Mapping[tuple[float, float], _Point]) -> dict[str, Any]:
    faces, profiles = (sorted({at[axis] for at in points}) for axis in (0, 1))
    for face in faces:
        for profile in profiles:
            if (face, profile) not in points:
                flank_name = f"tooth {tooth or 'all'}, {flank} flank"
                grid_point = f"face_mm = {face:g}, profile_mm = {profile:g}"
                raise CsvFault(f"{flank_name}: no row at {grid_point}; the places must fill a grid")
    rows = [[points[face, profile] for profile in profiles] for face in faces]
    nominal = [[point.nominal for point in row] for row in rows] if rows[0][0].nominal else []
    return {
        "tooth": tooth,
        "flank": flank,
        "face_mm": faces,
        "profile_mm": profiles,
        "deviation_um": [[point.deviation for point in row] for row in rows],
        "nominal": nominal,
    }
