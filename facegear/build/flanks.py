"""Measured flanks against the nominal ones: checks, deviation grids, and what all teeth have in common."""

import numpy as np

from facegear.arrays import Array
from facegear.schema.base import refuse
from facegear.schema.flanks import LARGEST, SIDES, FlanksSection, GridSection, Side
from facegear.teeth.flank_shapes import DeviationGrid, Flanks
from facegear.teeth.modifications import deviation
from facegear.teeth.surfaces import Face, nominal_points

Teeth = tuple[DeviationGrid | None, ...]
"""Deviations of one flank of every tooth."""
MIN_COVERAGE = 0.5
"""Part of the flank, along the face and along the profile, that a grid must cover at least."""
POINT_MM, NORMAL = 0.05, 0.02
"""By how much nominal points and normals of a file may be off."""


def check_flanks(section: FlanksSection, key: str, face: Face, teeth: int) -> None:
    """Raise ConfigError for grids of deviations that do not belong to this gear.

    Checked are tooth numbers, size of the deviations, grid places, nominal points and normals where the
    file has them, and that a flank measured tooth by tooth has a grid for every tooth.

    Parameters
    ----------
    section : FlanksSection
        Section `flanks` of the pinion or face gear: grids, amplitude, what becomes of pitch and
        thickness.
    key : str
        Dotted key of the section, for the error.
    face : Face
        Nominal flank of this body; its `face` and `profile` bound the grid coordinates, m.
    teeth : int
        Number of teeth of this body.
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
    """Raise ConfigError for grid lines that leave the flank or cover less than MIN_COVERAGE of it.

    Checked are `face_mm` and `profile_mm`; `flank_name` says in the error which flank and tooth.
    """
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
    """Raise ConfigError where the nominal points or outward normals of a file are not those of this
    flank.

    Points may be off by POINT_MM in each coordinate, the cosine between normals by NORMAL. The error
    tells of a file that is mirrored, or whose normals point into the material.
    """
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
    """Return the deviations of one flank of every tooth on its grid, times the amplitude of the section.

    A tooth without a grid of its own has that of tooth `all`. Where pitch and thickness are left out, the
    value at the middle of the flank is subtracted.

    Parameters
    ----------
    section : FlanksSection
        Section `flanks` of the pinion or face gear: grids, amplitude, what becomes of pitch and
        thickness.
    side : Side
        Flank of the teeth: `right` or `left`.
    face : Face
        Nominal flank of this body; its `face` and `profile` bound the grid coordinates, m.
    teeth : int
        Number of teeth of this body.

    Returns
    -------
    (teeth, n_face, n_profile) array or None
        Deviations along the outward normal, positive where material is added, m; None where the flank has
        no grid and is as designed.
    """
    grids = {grid.tooth: grid for grid in section.grids if grid.flank == side}
    if not grids:
        return None
    values = {tooth: _values(section, grid, face) for tooth, grid in grids.items()}
    tooth_numbers = range(1, teeth + 1)
    return np.stack([values[number if number in values else None] for number in tooth_numbers])


def _values(section: FlanksSection, grid: GridSection, face: Face) -> Array:
    """Return the deviations (n_face, n_profile) of one grid in m, times the amplitude of the section.

    Where pitch and thickness are left out, the deviation at the middle of the flank is subtracted.
    """
    values = 1e-6 * section.amplitude * np.array(grid.deviation_um)
    if section.pitch_and_thickness == "left_out":
        values = values - deviation(deviation_grid(grid, values), *face.middle)
    return values


def deviation_grid(grid: GridSection, values: Array) -> DeviationGrid:
    """Put deviations on the places of a config's grid, in SI units.

    Parameters
    ----------
    grid : GridSection
        Grid of the config, of which only the places `face_mm` and `profile_mm` are taken.
    values : (n_face, n_profile) array
        Deviations at these places, m.

    Returns
    -------
    DeviationGrid
        Places and deviations in m.
    """
    face, profile = (tuple(1e-3 * at for at in line) for line in (grid.face_mm, grid.profile_mm))
    return DeviationGrid(face, profile, tuple(map(tuple, values.tolist())))


def common_flanks(section: FlanksSection, face: Face, teeth: int) -> Flanks:
    """Return the mean deviations of all teeth, for both flanks: the flanks of the design.

    Parameters
    ----------
    section : FlanksSection
        Section `flanks` of the pinion or face gear: grids, amplitude, what becomes of pitch and
        thickness.
    face : Face
        Nominal flank of this body; its `face` and `profile` bound the grid coordinates, m.
    teeth : int
        Number of teeth of this body.

    Returns
    -------
    Flanks
        Mean over the teeth of `right` and `left` flank, m; None for a flank as designed.
    """
    return Flanks(**{side: common_grid(section, side, face, teeth) for side in SIDES})


def common_grid(section: FlanksSection, side: Side, face: Face, teeth: int) -> DeviationGrid | None:
    """Return the deviations of one flank as a mean over all teeth, place by place.

    Parameters
    ----------
    section : FlanksSection
        Section `flanks` of the pinion or face gear: grids, amplitude, what becomes of pitch and
        thickness.
    side : Side
        Flank of the teeth: `right` or `left`.
    face : Face
        Nominal flank of this body; its `face` and `profile` bound the grid coordinates, m.
    teeth : int
        Number of teeth of this body.

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
    """Return what the deviations of each tooth have beyond the mean of all teeth, `common_grid`, for one
    flank.

    Parameters
    ----------
    section : FlanksSection
        Section `flanks` of the pinion or face gear: grids, amplitude, what becomes of pitch and
        thickness.
    side : Side
        Flank of the teeth: `right` or `left`.
    face : Face
        Nominal flank of this body; its `face` and `profile` bound the grid coordinates, m.
    teeth : int
        Number of teeth of this body.

    Returns
    -------
    Teeth or None
        One grid of differences (m) for each tooth, in their order; equal ones are the same object. None
        where one grid or none serves all teeth.
    """
    grids = [grid for grid in section.grids if grid.flank == side]
    fields = fields_of(section, side, face, teeth)
    if fields is None or len(grids) == 1:
        return None
    distinct_grids: dict[bytes, DeviationGrid] = {}
    for values in fields - fields.mean(axis=0):
        distinct_grids.setdefault(values.tobytes(), deviation_grid(grids[0], values))
    return tuple(distinct_grids[values.tobytes()] for values in fields - fields.mean(axis=0))
