"""Known contact of a pair, which guides the search for the contact of another pair that differs little."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Mask
from facegear.contact.position import LoadedPosition
from facegear.geometry.unloaded import PAIRS


@dataclass(frozen=True, eq=False)
class KnownContact:
    """Contact solved at p positions: largest rotation `turn` (p,) rad under any load, and loaded nodes.

    `near` (p, 5, nodes) marks the nodes of the pinion's lattice, for the pairs -2..2, that carry load or
    are next to one that does across the profile.
    """

    turn: Array
    near: Mask


def known_contact(
    results: Sequence[LoadedPosition], positions: Sequence[float], shape: tuple[int, int], base_radius: float
) -> KnownContact | None:
    """Extract the rotation and the loaded nodes from results.

    Parameters
    ----------
    results : Sequence[LoadedPosition]
        Contact by position and torque.
    positions : Sequence[float]
        All positions, in pitches.
    shape : tuple[int, int]
        Lattice of the pinion.
    base_radius : float
        Of the pinion, m.

    Returns
    -------
    KnownContact, optional
        Known contact; None where fillets in the way turn the pinion back.
    """
    row_of = {position: row for row, position in enumerate(positions)}
    turn, is_loaded = np.zeros(len(positions)), np.zeros((len(positions), PAIRS.size, *shape), bool)
    for result in results:
        row = row_of[result.position]
        turn[row] = max(turn[row], (result.ste - result.unloaded_error) / base_radius)
        for spot in result.spots:
            is_loaded[row, np.searchsorted(PAIRS, spot.tooth)].flat[spot.hats] = True
    if turn.min() <= 0.0:
        return None
    near = is_loaded.copy()
    near[:, :, 1:] |= is_loaded[:, :, :-1]
    near[:, :, :-1] |= is_loaded[:, :, 1:]
    return KnownContact(turn, near.reshape(len(positions), PAIRS.size, -1))
