"""Torques on the bodies of a machine, in balance for the rigid rotation of all of them."""

import numpy as np

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.machine.layout import Layout, Role

TORQUE_BALANCE = 1e-9
"""Sum of all tangential forces, over the sum of their sizes, up to which torques count as balanced."""


def pinion_torques(layout: Layout, per_input: float, tail_share: float) -> Array:
    """Return the torque on each pinion: inputs drive, tail pinions take a share of the sum, idlers have none.

    Parameters
    ----------
    layout : Layout
        Roles of the pinions.
    per_input : float
        Torque on each input pinion, N m.
    tail_share : float
        Torque of all tail pinions together, as a fraction of the sum of the input torques.

    Returns
    -------
    (pinions,) array
        N m.
    """
    roles = [pinion.role for pinion in layout.pinions]
    inputs, tails = roles.count(Role.INPUT), roles.count(Role.TAIL)
    each_tail = -tail_share * inputs * per_input / tails if tails else 0.0
    value = {Role.INPUT: per_input, Role.TAIL: each_tail, Role.IDLER: 0.0}
    return np.array([value[role] for role in roles])


def balanced_torques(layout: Layout, on_pinions: Array, on_other_gear: float = 0.0) -> Array:
    """Return the torques on all bodies with the output face gear in static balance.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    on_pinions : (pinions,) array
        Torques on the pinions, N m.
    on_other_gear : float
        Torque on the face gear that is not the output, where there are two, N m.

    Returns
    -------
    (bodies,) array
        N m.
    """
    on_gears = np.full(len(layout.gears), float(on_other_gear))
    on_gears[layout.output] = 0.0
    on_gears[layout.output] = -on_pinions.sum() * layout.gear_radius / layout.pinion_radius - on_gears.sum()
    return np.concatenate([on_pinions, on_gears])


def require_balance(layout: Layout, torques: Array) -> None:
    """Raise InvalidInput unless the torques are in balance for the rigid rotation of all bodies.

    Each torque over its body's radius is a force at the mesh; the sum of these forces must vanish.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    torques : (bodies,) array
        Torques on all bodies, pinions first, N m, positive in the body's positive sense of rotation.

    Raises
    ------
    InvalidInput
        If the size of the sum is above TORQUE_BALANCE times the sum of the sizes of these forces.
    """
    pinions = len(layout.pinions)
    tangential = np.concatenate(
        [torques[:pinions] / layout.pinion_radius, torques[pinions:] / layout.gear_radius]
    )
    excess = float(tangential.sum())
    if abs(excess) > TORQUE_BALANCE * np.abs(tangential).sum():
        requirement = (
            "0, as torques must balance: sum of pinion torques / r_pinion + sum of gear torques / r_gear"
        )
        raise InvalidInput("torques", f"{excess:.6g} N in excess at the mesh", requirement)
