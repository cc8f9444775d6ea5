"""Compiled: the linear law in statics."""

from typing import NamedTuple

from facegear.arrays import Array
from facegear.mesh_law import terms


class LinearHeld(NamedTuple):
    """Stiffness (K, M) of the contacts at K phases."""

    stiffness: Array


@terms.held_force.of(LinearHeld)
def held_force(held: LinearHeld, k: int, m: int, amount: float) -> tuple[float, float]:
    """k times the amount, and k."""
    stiffness = held.stiffness[k, m]
    return stiffness * amount, stiffness
