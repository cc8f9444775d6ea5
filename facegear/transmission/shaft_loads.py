"""Loads of the bearings of pinions' shafts, from the forces and moments of the pinions on their shafts."""

from collections.abc import Mapping
from string import ascii_uppercase

import numpy as np

from facegear.arrays import Array
from facegear.transmission.drive_line import DriveLine


def bearing_names(line: DriveLine) -> list[tuple[int, str]]:
    """Return pinion and letter of every bearing of a shaft, by pinions.

    Parameters
    ----------
    line : DriveLine
        The drive line.

    Returns
    -------
    list of tuple of int and str
        Number of the pinion, and letter; A is the first bearing that the config lists.
    """
    return [
        (pinion, ascii_uppercase[number])
        for pinion, seat in sorted(line.seats.items())
        for number in range(len(seat.shaft.reactions))
    ]


def shaft_bearing_loads(line: DriveLine, forces: Array, moments: Mapping[int, Array] | None = None) -> Array:
    """Return the loads of the shafts on their bearings.

    Parameters
    ----------
    line : DriveLine
        The drive line.
    forces : (K, bodies, 3) array
        Forces of the bodies on what they sit on, N.
    moments : mapping of int to (K, 2) array, or None
        Moments about x and y by the numbers of pinions, N m.

    Returns
    -------
    (K, bearings, 5) array
        x, y, z, tilt_x, tilt_y in N and N m, in the order of `bearing_names`.
    """
    loads = [np.zeros((len(forces), 0, 5))]
    for pinion, seat in sorted(line.seats.items()):
        about = (moments or {}).get(pinion, np.zeros((len(forces), 2)))
        loads.append(seat.shaft.bearing_loads(np.concatenate([forces[:, pinion], about], axis=1)))
    return np.concatenate(loads, axis=1)
