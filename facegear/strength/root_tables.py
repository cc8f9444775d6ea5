"""Tables of root stress: peaks with their places, histories over a passage, distributions along the face."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Array, Arrays, Integers
from facegear.contact.summary import join_flanks
from facegear.quantities import BODIES
from facegear.strength.columns import (
    ALONG_FACE_COLUMNS,
    FILLETS,
    PASSAGE_COLUMNS,
    ROOT_STRESS_BY_FLANK_COLUMNS,
    ROOT_STRESS_COLUMNS,
)
from facegear.strength.root_stress import RootStress, down_the_fillet
from facegear.teeth.placement import FLANKS, GEARS

STANDARD_ANGLE = np.radians(30.0)
"""Between the fillet's tangent and the tooth's middle line at the section of ISO 6336-3."""


def root_tables(roots: Mapping[str, RootStress]) -> dict[str, pd.DataFrame]:
    """Tabulate the root stress of each body.

    Largest and smallest values are of splines through the gauges down the fillet, but of the gauges
    themselves along the face, the outermost of which stand a fifth of an element from its ends.

    Parameters
    ----------
    roots : Mapping[str, RootStress]
        Root stress of each body.

    Returns
    -------
    dict[str, DataFrame]
        `summary`, `passage` and `along_face`; columns as ROOT_STRESS_COLUMNS, PASSAGE_COLUMNS and
        ALONG_FACE_COLUMNS.
    """
    summary, passage, along_face = [], [], []
    for body, root in roots.items():
        for row, torque in enumerate(root.torques):
            for side, fillet in enumerate(FILLETS):
                fine = down_the_fillet(root.stress[row, :, side])
                key = (torque, body, fillet)
                summary.append((*key, *_peak(root, side, fine)))
                history = zip(root.passage, fine.max(axis=(1, 2)), fine.min(axis=(1, 2)), strict=True)
                passage += [(*key, at, 1e-6 * high, 1e-6 * low) for at, high, low in history]
                ends = zip(root.along, fine.max(axis=(0, 1)), fine.min(axis=(0, 1)), strict=True)
                along_face += [(*key, 1e3 * at, 1e-6 * high, 1e-6 * low) for at, high, low in ends]
    return {
        "summary": pd.DataFrame(summary, columns=list(ROOT_STRESS_COLUMNS)),
        "passage": pd.DataFrame(passage, columns=list(PASSAGE_COLUMNS)),
        "along_face": pd.DataFrame(along_face, columns=list(ALONG_FACE_COLUMNS)),
    }


def _peak(root: RootStress, side: int, fine: Array) -> tuple[float, ...]:
    """Return the columns of ROOT_STRESS_COLUMNS from `largest_mpa` on, for one fillet at one torque.

    `side` is the fillet's index in FILLETS; `fine` (n, m, b), Pa: its stress at m points down the fillet.
    """
    when, down, column = np.unravel_index(np.argmax(fine), fine.shape)
    angle = down_the_fillet(root.angle[side])
    return (
        1e-6 * float(fine[when, down, column]),
        1e-6 * float(fine[when, down, column] * root.error[column]),
        float(root.passage[when]),
        1e3 * float(root.along[column]),
        float(np.degrees(angle[down, column])),
        1e-6 * _at_angle(fine, angle, STANDARD_ANGLE),
        1e-6 * float(fine.min()),
    )


def _at_angle(fine: Array, angle: Array, section_angle: float) -> float:
    """Return the largest stress (Pa) where the fillet's tangent has the angle `section_angle` (rad).

    `fine` (n, m, b): stress, interpolated over `angle` (m, b), rad; nan where no gauges enclose the
    angle.
    """
    values = [np.nan]
    for column in range(angle.shape[1]):
        order = np.argsort(angle[:, column])
        angles = angle[order, column]
        if angles[0] <= section_angle <= angles[-1]:
            values.append(
                max(np.interp(section_angle, angles, stress[order]) for stress in fine[..., column])
            )
    return float(np.nanmax(values)) if len(values) > 1 else np.nan


def root_by_flank(variants: Sequence[Mapping[str, RootStress]], flank_variant: Integers) -> pd.DataFrame:
    """Tabulate the `summary` for both flanks of both gears.

    Parameters
    ----------
    variants : Sequence[Mapping[str, RootStress]]
        Root stress of each body under each of the errors that flanks meet.
    flank_variant : (gears, flanks) array of int
        Index of the variant of each gear and flank.

    Returns
    -------
    DataFrame
        Columns as ROOT_STRESS_BY_FLANK_COLUMNS.
    """
    summaries = [root_tables(roots)["summary"] for roots in variants]
    return join_flanks(summaries, flank_variant)[list(ROOT_STRESS_BY_FLANK_COLUMNS)]


def root_arrays(
    variants: Sequence[Mapping[str, RootStress]],
    flank_variant: Integers,
    positions: Sequence[Mapping[str, Array]],
) -> dict[str, AnyArray]:
    """Return the root stress as ROOT_STRESS_ARRAYS.

    Variants on the first one's bodies, whose gauges are the same, stand in `<body>_other_stress_pa`; those on
    other bodies have arrays of their own, named as the first one's with `<number>_` in front.

    Parameters
    ----------
    variants : Sequence[Mapping[str, RootStress]]
        Root stress of each body under each of the errors that flanks meet.
    flank_variant : (gears, flanks) array of int
        Index of the variant of each gear and flank.
    positions : Sequence[Mapping[str, array]]
        Positions of the gauges of each body, (2, a, b, 3), m, by variant.

    Returns
    -------
    dict[str, array]
        Arrays by name, with the shapes (...) of ROOT_STRESS_ARRAYS, in SI units.
    """
    first = variants[0]
    arrays: dict[str, AnyArray] = {
        "torque_n_m": next(iter(first.values())).torques,
        "flank_variant": np.asarray(flank_variant),
    }
    for body, root in first.items():
        arrays[f"{body}_passage"] = root.passage
        arrays[f"{body}_stress_pa"] = root.stress
        other_stress = []
        for number, variant in enumerate(variants[1:], 1):
            if np.array_equal(positions[number][body], positions[0][body]):
                other_stress.append(variant[body].stress)
            else:
                arrays[f"{number}_{body}_stress_pa"] = variant[body].stress
                arrays |= _gauge_arrays(f"{number}_{body}", positions[number][body], variant[body])
        arrays[f"{body}_other_stress_pa"] = np.reshape(other_stress, (len(other_stress), *root.stress.shape))
        arrays |= _gauge_arrays(body, positions[0][body], root)
    return arrays


def _gauge_arrays(name: str, position: Array, root: RootStress) -> dict[str, AnyArray]:
    """Return places (2, a, b, 3) m, tangents and errors of gauges as arrays of ROOT_STRESS_ARRAYS."""
    return {f"{name}_position_m": position, f"{name}_tangent_rad": root.angle, f"{name}_error": root.error}


def root_from_arrays(arrays: Arrays, body: str, gear: str = "upper", flank: str = "drive") -> RootStress:
    """Restore the root stress of a body by the loads of a gear's drive or back flank.

    Parameters
    ----------
    arrays : Arrays
        ROOT_STRESS_ARRAYS.
    body : str
        `pinion` or `face_gear`.
    gear : str
        `upper` or `lower`.
    flank : str
        `drive` or `back`.

    Returns
    -------
    RootStress
        Root stress over torque and passage.
    """
    variant = int(arrays["flank_variant"][GEARS.index(gear), FLANKS.index(flank)])
    has_gauges = [f"{number}_{body}_stress_pa" in arrays for number in range(variant + 1)]
    name = f"{variant}_{body}" if has_gauges[variant] else body
    if variant == 0 or has_gauges[variant]:
        stress = arrays[f"{name}_stress_pa"]
    else:
        stress = arrays[f"{body}_other_stress_pa"][variant - 1 - sum(has_gauges)]
    x, y, _ = np.moveaxis(arrays[f"{name}_position_m"], -1, 0)
    return RootStress(
        torques=arrays["torque_n_m"],
        passage=arrays[f"{body}_passage"],
        stress=stress,
        along=(y if body == "pinion" else np.hypot(x, y)).mean(axis=(0, 1)),
        angle=arrays[f"{name}_tangent_rad"],
        error=arrays[f"{name}_error"],
    )


def stress_surface(
    arrays: Arrays,
) -> tuple[Array, dict[str, Integers], dict[str, Array]]:
    """Return the fillets as a surface with fields of stress.

    Fields are the largest and smallest stress (Pa) over the passage at each torque; `body` 0 pinion, 1 face
    gear; `fillet` 0 below the loaded flank, 1 below the other.

    Parameters
    ----------
    arrays : Arrays
        ROOT_STRESS_ARRAYS.

    Returns
    -------
    (n, 3) array, dict, dict
        Points in their body frames, m; cells, (cells, 4) indices of points under `quad`; fields (n,) by name,
        Pa or dimensionless.
    """
    points, cells, start = [], [], 0
    parts_by_name: dict[str, list[Array]] = {}
    for number, body in enumerate(BODIES):
        position, stress = arrays[f"{body}_position_m"], arrays[f"{body}_stress_pa"]
        down, along = position.shape[1:3]
        nodes = start + np.arange(position[..., 0].size).reshape(len(FILLETS), down, along)
        corners = nodes[:, :-1, :-1], nodes[:, 1:, :-1], nodes[:, 1:, 1:], nodes[:, :-1, 1:]
        cells.append(np.stack([corner.ravel() for corner in corners], axis=-1))
        points.append(position.reshape(-1, 3))
        start += nodes.size
        fields = {"body": np.full(nodes.size, float(number))}
        fields["fillet"] = np.repeat(np.arange(float(len(FILLETS))), down * along)
        for row, torque in enumerate(arrays["torque_n_m"]):
            fields[f"largest_pa_at_{torque:g}_n_m"] = stress[row].max(axis=0).ravel()
            fields[f"smallest_pa_at_{torque:g}_n_m"] = stress[row].min(axis=0).ravel()
        for name, values in fields.items():
            parts_by_name.setdefault(name, []).append(values)
    fields_by_name = {name: np.concatenate(parts) for name, parts in parts_by_name.items()}
    return np.concatenate(points), {"quad": np.concatenate(cells)}, fields_by_name
