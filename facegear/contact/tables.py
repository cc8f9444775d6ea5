"""Contact results as a table and as arrays."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.contact.columns import LTCA_COLUMNS
from facegear.contact.flanks import PinionSurface
from facegear.contact.position import LoadedPosition


def ltca_table(results: Sequence[LoadedPosition]) -> pd.DataFrame:
    """One row a torque and position, columns as LTCA_COLUMNS."""
    rows = [
        (
            r.torque,
            r.position,
            1e6 * r.ste,
            1e6 * r.unloaded,
            r.k_average,
            r.k_local,
            r.pairs_in_contact,
            *r.share,
            1e-6 * r.peak_pressure,
            1e-6 * r.edge_pressure,
            r.residual,
            abs(r.share.sum() - 1.0),
        )
        for r in results
    ]
    frame = pd.DataFrame(rows, columns=list(LTCA_COLUMNS))
    return frame.sort_values(["torque_n_m", "position"], ignore_index=True)


def pressure_arrays(results: Sequence[LoadedPosition], surface: PinionSurface) -> dict[str, NDArray]:
    """All loaded hats, one a row, and the lattice they belong to, as PRESSURE_ARRAYS.

    `whole` is false for hats cut by an edge of either tooth, whose pressure has no limit as the mesh is
    refined.
    """
    names = ("torque_n_m", "position", "tooth", "node", "force_n", "pressure_pa", "whole")
    rows: dict[str, list[NDArray]] = {name: [] for name in names}
    for result in results:
        for spot in result.spots:
            count = spot.hats.size
            rows["torque_n_m"].append(np.full(count, result.torque))
            rows["position"].append(np.full(count, result.position))
            rows["tooth"].append(np.full(count, spot.tooth))
            rows["node"].append(spot.hats)
            rows["force_n"].append(spot.force)
            rows["pressure_pa"].append(spot.pressure)
            rows["whole"].append(spot.whole)
    arrays = {name: np.concatenate(parts) for name, parts in rows.items()}
    return arrays | {"shape": np.array(surface.shape), "point_m": surface.nodes, "area_m2": surface.full_area}


def pressure_surface(
    arrays: dict[str, NDArray],
) -> tuple[NDArray[np.float64], dict[str, NDArray[np.int64]], dict[str, NDArray[np.float64]]]:
    """Pinion flank as quadrilaterals for ParaView: points, cells, and the largest pressure (Pa) at each
    torque.

    The largest is over all positions and teeth, as one tooth passes through the mesh.
    """
    nu, nv = arrays["shape"]
    nodes = np.arange(nu * nv).reshape(nu, nv)
    corners = nodes[:-1, :-1], nodes[1:, :-1], nodes[1:, 1:], nodes[:-1, 1:]
    fields = {}
    for torque in np.unique(arrays["torque_n_m"]):
        on = (arrays["torque_n_m"] == torque) & arrays["whole"]
        largest = np.zeros(nu * nv)
        np.maximum.at(largest, arrays["node"][on], arrays["pressure_pa"][on])
        fields[f"largest_pressure_pa_at_{torque:g}_n_m"] = largest
    return arrays["point_m"], {"quad": np.stack([c.ravel() for c in corners], axis=-1)}, fields
