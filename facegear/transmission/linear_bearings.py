"""Bearings with play as modes take them: springs about the place where the mean torques hold them."""

from dataclasses import replace

import numpy as np

from facegear.transmission.layout import DOF_PER_BODY, Layout
from facegear.transmission.machine import Machine
from facegear.transmission.statics import mean_equilibrium


def linear_bearings(machine: Machine) -> Layout:
    """The layout with every ring of play replaced by its tangent.

    A bearing pressed against its ring is stiff along its load, k, and less across it, k (1 - play / way); one
    that floats inside carries nothing. Raises NotConverged.
    """
    layout = machine.layout
    play = machine.imperfections.clearance
    if not (play > 0.0).any():
        return layout
    standing = mean_equilibrium(machine).displacements[0]
    pinions = list(layout.pinions)
    for i in np.flatnonzero(play > 0.0):
        moved = standing[DOF_PER_BODY * i : DOF_PER_BODY * i + 2]
        distance = float(np.hypot(*moved))
        stiffness = pinions[i].body.bearing[0]
        across = stiffness * max(1.0 - play[i] / distance, 0.0) if distance > 0.0 else 0.0
        along = stiffness if distance > play[i] else 0.0
        direction = moved / distance if distance > 0.0 else np.zeros(2)
        tangent = across * np.eye(2) + (along - across) * np.outer(direction, direction)
        body = pinions[i].body
        bearing = (float(tangent[0, 0]), float(tangent[1, 1]), body.bearing[2])
        own = replace(body, bearing=bearing, bearing_xy=float(tangent[0, 1]))
        pinions[i] = replace(pinions[i], body=own)
    return replace(layout, pinions=tuple(pinions))
