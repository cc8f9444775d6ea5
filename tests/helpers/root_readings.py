"""Root stress from made-up readings of gauges under given loads."""

import numpy as np

from facegear.strength.root_stress import root_stress

TORQUES, POSITIONS = np.array([100.0, 300.0]), np.array([0.0, 0.5])
GRID = (2, 4, 3)
ERROR = np.array([0.02, 0.01, 0.03])


def passing(loads):
    """Root stress by readings on five teeth of gauges GRID from seven flank nodes."""
    readings = np.random.default_rng(1).normal(size=(5, int(np.prod(GRID)), 7))
    angle = np.broadcast_to(np.linspace(0.4, 1.2, 4)[:, None], GRID)
    found = root_stress(readings, loads, TORQUES, POSITIONS, np.linspace(0.25, 0.27, 3), angle, ERROR)
    return readings, found
