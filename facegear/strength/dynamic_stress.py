"""Root stress under the mesh forces of a running machine."""

from collections.abc import Callable, Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.strength.columns import DYNAMIC_STRESS_COLUMNS
from facegear.strength.root_stress import RootStress, down_the_fillet, largest_tension

Array = NDArray[np.float64]


def dynamic_stress_table(
    forces: Mapping[str, Array],
    places: Mapping[str, Array],
    base_radius: float,
    roots: Mapping[str, RootStress],
    pressure: Callable[[float], float],
) -> pd.DataFrame:
    """One row a mesh, columns as DYNAMIC_STRESS_COLUMNS.

    forces (n,) N along the line of action by mesh, negative on the back flank, evenly in time; places (n,) of
    the loaded flank in the mesh cycle, in [0, 1); base_radius (m) of the pinion; pressure (Pa): the largest
    over the passage at a torque (N m). `mean`: largest over the passage with the mesh's mean force;
    `running`: largest of the history, every tooth with its share of the force of that moment (a tooth is
    quasi-static); `bound`: with the largest force all through the passage.
    """
    tension = {body: largest_tension(root) for body, root in roots.items()}
    history = {body: TensionHistory(root) for body, root in roots.items()}
    rows = []
    for mesh, force in forces.items():
        mean, most = float(np.abs(force).mean()), float(np.abs(force).max())
        torques = base_radius * np.abs(force)
        stresses: list[float] = []
        for body in roots:
            running = float(history[body](torques, places[mesh]).max())
            bound = history[body].over_passage(base_radius * most)
            stresses += [tension[body](base_radius * mean), running, bound]
        stresses += [pressure(base_radius * value) for value in (mean, most)]
        growth = next(iter(roots.values())).scale
        within = growth.solved(base_radius * mean) and growth.solved(base_radius * most)
        factor = most / mean if mean > 0.0 else np.nan
        rows.append((mesh, mean, most, factor, *(1e-6 * stress for stress in stresses), within))
    return pd.DataFrame(rows, columns=list(DYNAMIC_STRESS_COLUMNS))


class TensionHistory:
    """Largest tension of all teeth of a body in mesh, over torque and place in the mesh cycle.

    Over torque the largest values go as those of each gauge in `RootStress.at_torque`, between the places
    solved linearly: the result is no less than the largest of the interpolated gauges.
    """

    def __init__(self, root: RootStress) -> None:
        within, where = np.unique(np.round(np.mod(root.passage, 1.0), 9), return_inverse=True)
        largest = np.array([down_the_fillet(one).max(axis=(1, 2, 3)) for one in root.stress])
        by_place = np.array([largest[:, where == place].max(axis=1) for place in range(within.size)]).T
        self._scale = root.scale
        self._places = np.append(within, within[0] + 1.0)
        self._table = np.hstack([by_place, by_place[:, :1]])

    def __call__(self, torques: Array, places: Array) -> Array:
        """Stress (n,) Pa at torques (n,) N m and places (n,) in [0, 1)."""
        column, on = _cell(self._places, places)
        row, own, above = self._scale.parts(torques)
        low, high = (
            (1.0 - on) * self._table[at, column] + on * self._table[at, column + 1]
            for at in (row, np.minimum(row + 1, len(self._table) - 1))
        )
        return own * low + above * high

    def over_passage(self, torque: float) -> float:
        """Largest stress (Pa) while a torque (N m) stays as it is all through the passage."""
        places = self._places[:-1]
        return float(self(np.full(places.size, torque), places).max())


def _cell(edges: Array, values: Array) -> tuple[NDArray[np.int64], Array]:
    """Cell (n,) between rising edges in which each value lies, and how far into it, 0 to 1."""
    cell = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, edges.size - 2)
    return cell, np.clip((values - edges[cell]) / (edges[cell + 1] - edges[cell]), 0.0, 1.0)
