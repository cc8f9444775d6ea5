"""Manufacturing errors that usual grades of the standards allow."""

from math import cbrt, sqrt


def cumulative_pitch_um(diameter_mm: float, module_mm: float) -> float:
    """Total cumulative pitch deviation F_p, um, that ISO 1328-1:2013 allows in grade 5.

    Parameters
    ----------
    diameter_mm, module_mm : float
        Pitch diameter and module, mm.

    Returns
    -------
    float
        Deviation, um.
    """
    return 0.002 * diameter_mm + 0.55 * sqrt(diameter_mm) + 0.7 * module_mm + 12.0


def position_um(radius: float) -> float:
    """Distance, um, by which a bearing is out of place: half of the tolerance IT5 of ISO 286-1 for its
    radius.

    Parameters
    ----------
    radius : float
        Distance of the bearing from the gears' axis, m.

    Returns
    -------
    float
        Distance from its place, um.
    """
    size = 1e3 * radius
    return 0.5 * 7.0 * (0.45 * cbrt(size) + 0.001 * size)
