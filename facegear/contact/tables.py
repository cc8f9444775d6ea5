"""Contact results as a table and as arrays."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray
from facegear.contact.columns import LTCA_COLUMNS
from facegear.contact.flanks import PinionSurface
from facegear.contact.position import LoadedPosition
from facegear.contact.pressure import FlankPressure, LineLoads


def ltca_table(results: Sequence[LoadedPosition], pressure: FlankPressure) -> pd.DataFrame:
    """Tabulate contact results, one row a torque and position.

    nan: pressure where no plane is inside, average stiffness where the unloaded teeth interfere.

    Parameters
    ----------
    results : Sequence[LoadedPosition]
        Contact by position and torque.
    pressure : FlankPressure
        Pressure of the same results.

    Returns
    -------
    pd.DataFrame
        Columns LTCA_COLUMNS.
    """
    of_each = [
        (
            1e6 * r.ste,
            1e6 * r.unloaded_error,
            r.k_average,
            r.k_local,
            r.fillet_share,
            1e6 * r.overlap,
            r.residual,
        )
        for r in results
    ]
    ste, unloaded_error, average, local, in_fillets, overlap, residual = np.array(of_each).T
    shares = np.array([r.load_share for r in results])
    columns = (
        np.array([r.torque for r in results]),
        np.array([r.position for r in results]),
        *(ste, unloaded_error, average, local),
        np.count_nonzero(shares, axis=1),
        *shares.T,
        *np.array([_pressures(loads) for loads in pressure.loads]).T,
        *(in_fillets, overlap, residual),
        np.abs(shares.sum(axis=1) - 1.0),
    )
    order = np.lexsort((columns[1], columns[0]))
    return pd.DataFrame(
        {name: values[order] for name, values in zip(LTCA_COLUMNS, columns, strict=True)}, copy=False
    )


def _pressures(loads: LineLoads) -> tuple[float, ...]:
    """Largest pressure inside and its error (MPa), line load (N/mm) and loaded length (mm) of tip edges."""
    largest, error = loads.largest()
    tip, length = loads.at_tips()
    return 1e-6 * largest, 1e-6 * error, 1e-3 * tip, 1e3 * length


def pressure_arrays(
    results: Sequence[LoadedPosition], surface: PinionSurface, pressure: FlankPressure
) -> dict[str, AnyArray]:
    """Collect loads and pressures as PRESSURE_ARRAYS.

    First come the forces of all loaded basis functions, one a row, whether they act in a fillet, and the
    lattice (`shape`, `point_m`) of their nodes. Then come `line_*`, one row a loaded plane across the
    pinion's axis: its number, the line load along the contact line and the length it stands for, its edge
    (a number in EDGES), and the pressure there: 0 with an error of 0 unless inside. Last come the contact
    lines: a pair's points on the pinion in all planes, whether loaded or not.

    Parameters
    ----------
    results : Sequence[LoadedPosition]
        Contact by position and torque.
    surface : PinionSurface
        Contact surface of the pinion.
    pressure : FlankPressure
        Pressure of the same results.

    Returns
    -------
    dict of arrays
        Arrays with the (...) shapes of PRESSURE_ARRAYS.
    """
    lines: dict[str, list[AnyArray]] = {}
    for result, loads in zip(results, pressure.loads, strict=True):
        rows = {
            "line_torque_n_m": np.full(loads.line.size, result.torque),
            "line_position": np.full(loads.line.size, result.position),
            "line_tooth": pressure.tooth[loads.line],
            "line_plane": loads.plane,
            "line_where": loads.edge,
            "line_length_m": loads.length,
            "line_load_n_per_m": loads.line_load,
            "line_pressure_pa": np.nan_to_num(loads.pressure),
            "line_error_pa": np.nan_to_num(loads.error),
            "line_half_width_m": np.nan_to_num(loads.half_width),
        }
        for name, values in rows.items():
            lines.setdefault(name, []).append(values)
    position, tooth, points = pressure.every_point(surface.design)
    return {
        **_forces(results),
        "shape": np.array(surface.shape),
        "point_m": surface.nodes,
        **{name: np.concatenate(parts) for name, parts in lines.items()},
        "contact_position": position,
        "contact_tooth": tooth,
        "contact_point_m": points,
    }


def _forces(results: Sequence[LoadedPosition]) -> dict[str, AnyArray]:
    spots = [(result, spot) for result in results for spot in result.spots]
    count = [spot.hats.size for _, spot in spots]
    return {
        "torque_n_m": np.repeat([result.torque for result, _ in spots], count),
        "position": np.repeat([result.position for result, _ in spots], count),
        "tooth": np.repeat([spot.tooth for _, spot in spots], count),
        "node": np.concatenate([spot.hats for _, spot in spots]),
        "force_n": np.concatenate([spot.force for _, spot in spots]),
        "in_fillet": np.concatenate([spot.fillet for _, spot in spots]),
    }
