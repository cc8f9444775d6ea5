"""The contact of a pair that is known, where that of another one, little different, is sought."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Mask
from facegear.contact.position import LoadedPosition
from facegear.geometry.unloaded import PAIRS


@dataclass(frozen=True, eq=False)
class KnownContact:
    """A contact solved at p positions: the largest `turn` (p,) rad that a load made, and which nodes of the
    pinion's lattice carry load, or stand beside one that does across the profile: `near` (p, 5, nodes), of
    the pairs -2..2.
    """

    turn: Array
    near: Mask


def known_contact(
    results: Sequence[LoadedPosition], positions: Sequence[float], shape: tuple[int, int], base_radius: float
) -> KnownContact | None:
    """Of results at the positions, of a pair with a pinion's lattice of a shape and its base radius (m).

    None where fillets in the way turn the pinion back.
    """
    row_of = {position: row for row, position in enumerate(positions)}
    turn, loaded = np.zeros(len(positions)), np.zeros((len(positions), PAIRS.size, *shape), bool)
    for result in results:
        row = row_of[result.position]
        turn[row] = max(turn[row], (result.ste - result.unloaded) / base_radius)
        for spot in result.spots:
            loaded[row, np.searchsorted(PAIRS, spot.tooth)].flat[spot.hats] = True
    if turn.min() <= 0.0:
        return None
    near = loaded.copy()
    near[:, :, 1:] |= loaded[:, :, :-1]
    near[:, :, :-1] |= loaded[:, :, 1:]
    return KnownContact(turn, near.reshape(len(positions), PAIRS.size, -1))
