"""Root stress of a tooth that is loaded at one instant, and such stress as a power of the torque."""

from dataclasses import replace

import numpy as np

from facegear.strength.root_stress import RootStress


def root(largest):
    """Tension `largest` (Pa) below the loaded flank and as much compression below the other, at 500 N m."""
    stress = np.zeros((1, 3, 2, 4, 2))
    stress[0, 1, 0], stress[0, 1, 1] = largest, -largest
    along, error = np.array([0.25, 0.27]), np.array([0.01, 0.02])
    return RootStress(np.array([500.0]), np.arange(3.0), stress, along, np.ones((2, 4, 2)), error)


def power_law(torques, exponent):
    """Root stress that grows as a power of the torque, 400 MPa at 500 N m."""
    one = root(400e6)
    torques = np.array(torques)
    factors = (torques / 500.0) ** exponent
    return replace(one, torques=torques, stress=factors[:, None, None, None, None] * one.stress)
