"""How sharp the fillets of both gears are."""

import numpy as np

from facegear.geometry import face_gear, pinion
from facegear.geometry.design import PairDesign
from facegear.geometry.limits import sharpest_fillet_radius

SAMPLES = 401
"""Points of a section, evenly in its parameter."""


def smallest_radius(design: PairDesign, body: str) -> float:
    """Compute the smallest radius of curvature of a fillet's sections: the pinion's, or the gear's over its
    face.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    body : str
        `pinion` or `face_gear`.

    Returns
    -------
    float
        m.
    """
    if body == "pinion":
        gamma = np.linspace(design.pressure_angle, np.pi / 2, SAMPLES)
        radius, angle = pinion.trochoid_point(design, gamma)
        return _sharpest(radius * np.sin(angle), radius * np.cos(angle))
    ends = design.face_gear.inner_radius, design.face_gear.outer_radius
    radii = []
    for gear_radius in (*ends, float(np.clip(sharpest_fillet_radius(design), *ends))):
        slopes = face_gear.fillet_slopes(design, gear_radius, np.linspace(0.0, 1.0, SAMPLES))
        angle, z = face_gear.fillet_section(design, gear_radius, slopes)
        radii.append(_sharpest(gear_radius * angle, z))
    return min(radii)


def _sharpest(x: np.ndarray, z: np.ndarray) -> float:
    dx, dz = np.gradient(x), np.gradient(z)
    bend = np.abs(dx * np.gradient(dz) - dz * np.gradient(dx)) / np.hypot(dx, dz) ** 3
    return float(1.0 / bend[2:-2].max())
