"""Nominal points and normals of all flanks with their mean deviations, in the columns of `flanks.file`."""

from pathlib import Path

import numpy as np
import pandas as pd

from facegear.build.tooth_pair import ToothPair, pair_design
from facegear.io.atomic import atomic_path
from facegear.quantities import BODIES, Body
from facegear.schema.csv_file import HEADER, NOMINAL, SIDES
from facegear.teeth.design import PairDesign
from facegear.teeth.modifications import deviation, flank_depth
from facegear.teeth.placement import mirror_teeth
from facegear.teeth.surfaces import flank_face, nominal_points

GRID_SHAPE = 11, 9
"""Numbers of grid points along face and profile."""
INSET = 0.02
"""Part of face and profile left out at their ends, where no probe measures."""
COLUMNS = ("body", "tooth", "flank", "face_mm", "profile_mm", "deviation_um", *NOMINAL)
"""Columns of `flank_table`."""


def flank_table(section: ToothPair) -> pd.DataFrame:
    """Tabulate nominal points and normals on a grid of each flank, with the flanks' mean deviations there.

    Parameters
    ----------
    section : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    pd.DataFrame
        One row for each grid point of the right and left flank of both bodies, columns COLUMNS: face and
        profile coordinate (mm), deviation (um), point (mm) and unit normal of tooth 1 in the body frame,
        see `facegear.teeth.design`; column tooth is "all".

    Raises
    ------
    ConfigError
        For a pair without bodies.
    """
    design = pair_design(section)
    return pd.concat([_rows(design, body, side) for body in BODIES for side in SIDES], ignore_index=True)


def _rows(design: PairDesign, body: Body, side: str) -> pd.DataFrame:
    """Return the rows of `flank_table` of one flank, `side` one of SIDES, on a grid of GRID_SHAPE points
    (face, profile).
    """
    face = flank_face(design, body)
    deepest = face.profile[1]
    if body == "face_gear":
        # both flanks end where the shaper's tip leaves them, helical ones at unequal depths
        ends = (flank_depth(pair)(design.face_gear.inner_radius) for pair in (design, mirror_teeth(design)))
        deepest = float(min(ends))
    along, across = (
        low + (high - low) * np.linspace(INSET, 1.0 - INSET, count)
        for (low, high), count in zip((face.face, (face.profile[0], deepest)), GRID_SHAPE, strict=True)
    )
    along, across = np.round(along, 6), np.round(across, 6)
    points, normals = nominal_points(face, side, along, across)
    grid = getattr(getattr(design, body).flanks, side)
    values = np.concatenate([1e3 * points, normals], axis=-1).reshape(-1, 6)
    grid_points = np.stack(np.meshgrid(along, across, indexing="ij"), axis=-1).reshape(-1, 2)
    table = pd.DataFrame({"body": body, "tooth": "all", "flank": side, "face_mm": 1e3 * grid_points[:, 0]})
    table["profile_mm"] = 1e3 * grid_points[:, 1]
    table["deviation_um"] = 1e6 * deviation(grid, grid_points[:, 0], grid_points[:, 1])
    return table.assign(**dict(zip(NOMINAL, values.T, strict=True)))[list(COLUMNS)]


def write_nominal_points(path: str | Path, section: ToothPair) -> Path:
    """Write nominal points and normals as a file that `flanks.file` reads, with deviations of zero.

    Parameters
    ----------
    path : str or Path
        The file to write.
    section : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    Path
        The path.

    Raises
    ------
    ConfigError
        For a pair without bodies.
    """
    table = flank_table(section).assign(deviation_um=0.0)
    with atomic_path(path) as temporary, open(temporary, "w", encoding="utf-8", newline="") as stream:
        stream.write(f"# {HEADER}: included\n")
        table.to_csv(stream, index=False, float_format="%.7f")
    return Path(path)
