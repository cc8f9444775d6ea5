"""Root stress on the fillets as quadrilaterals between the gauges, for ParaView."""

import numpy as np

from facegear.arrays import Array, Arrays, Integers
from facegear.geometry.bodies import BODIES
from facegear.strength.columns import FILLETS


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
