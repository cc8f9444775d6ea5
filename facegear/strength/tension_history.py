"""Largest tension in the fillets of a body over torque and place in the mesh cycle."""

import numpy as np

from facegear.arrays import Array, Integers
from facegear.strength.root_stress import RootStress, down_the_fillet


class TensionHistory:
    """Largest tension of all teeth of a body in mesh, over torque and place in the mesh cycle.

    Over torque the largest values go as those of each gauge in `RootStress.at_torque`, between the places
    solved linearly: the result is no less than the largest of the interpolated gauges.
    """

    def __init__(self, root: RootStress) -> None:
        within, position_of = np.unique(np.round(np.mod(root.passage, 1.0), 9), return_inverse=True)
        largest = np.array([down_the_fillet(stress).max(axis=(1, 2, 3)) for stress in root.stress])
        by_position = np.array(
            [largest[:, position_of == index].max(axis=1) for index in range(within.size)]
        ).T
        self._scale = root.scale
        self._positions = np.append(within, within[0] + 1.0)
        self._table = np.hstack([by_position, by_position[:, :1]])

    def __call__(self, torques: Array, positions: Array) -> Array:
        """Return the stress (n,) Pa at torques (n,) N m and positions (n,) in the mesh cycle, in [0, 1)."""
        column, on = _cell(self._positions, positions)
        row, below, above = self._scale.parts(torques)
        low, high = (
            (1.0 - on) * self._table[at, column] + on * self._table[at, column + 1]
            for at in (row, np.minimum(row + 1, len(self._table) - 1))
        )
        return below * low + above * high

    def over_passage(self, torque: float) -> float:
        """Return the largest stress while a torque stays constant all through the passage.

        Parameters
        ----------
        torque : float
            Torque on the pinion, N m.

        Returns
        -------
        float
            Stress, Pa.
        """
        positions = self._positions[:-1]
        return float(self(np.full(positions.size, torque), positions).max())


def _cell(edges: Array, values: Array) -> tuple[Integers, Array]:
    """Cell (n,) between rising edges in which each value lies, and how far into it, 0 to 1."""
    cell = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, edges.size - 2)
    return cell, np.clip((values - edges[cell]) / (edges[cell + 1] - edges[cell]), 0.0, 1.0)
