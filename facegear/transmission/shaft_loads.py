"""What the bearings of pinions' shafts carry, from the forces and moments of the pinions on their shafts."""

from collections.abc import Mapping
from string import ascii_uppercase

import numpy as np

from facegear.arrays import Array
from facegear.transmission.drive_line import DriveLine


def bearing_names(line: DriveLine) -> list[tuple[int, str]]:
    """Pinion and letter of every bearing of a shaft, by pinions; A is the first that the config lists."""
    return [
        (pinion, ascii_uppercase[number])
        for pinion, seat in sorted(line.seats.items())
        for number in range(len(seat.shaft.reactions))
    ]


def shaft_bearing_loads(line: DriveLine, forces: Array, moments: Mapping[int, Array] | None = None) -> Array:
    """Loads x, y, z, tilt_x, tilt_y of the shafts on their bearings, (K, bearings, 5), N and N m.

    In the order of `bearing_names`.
    forces (K, bodies, 3): of the bodies on what they sit on; moments (K, 2) by the numbers of pinions, about
    x and y.
    """
    loads = [np.zeros((len(forces), 0, 5))]
    for pinion, seat in sorted(line.seats.items()):
        about = (moments or {}).get(pinion, np.zeros((len(forces), 2)))
        loads.append(seat.shaft.bearing_loads(np.concatenate([forces[:, pinion], about], axis=1)))
    return np.concatenate(loads, axis=1)
