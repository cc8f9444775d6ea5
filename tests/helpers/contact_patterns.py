"""Line loads as the contact stage stores them, made up for the tests of figures and tables."""

import numpy as np


def line_arrays(points, torques, pressure_pa):
    """Contact lines `points` (p, n, 3) of pair 0, loaded everywhere by `pressure_pa` (p, n)."""
    steps, planes = points.shape[:2]
    position = np.arange(steps) / steps
    count = steps * planes
    each = len(torques) * count
    return {
        "line_torque_n_m": np.repeat(torques, count),
        "line_position": np.tile(np.repeat(position, planes), len(torques)),
        "line_tooth": np.zeros(each, dtype=np.int64),
        "line_plane": np.tile(np.arange(planes), len(torques) * steps),
        "line_where": np.zeros(each, dtype=np.int64),
        "line_length_m": np.full(each, 1e-3),
        "line_load_n_per_m": np.full(each, 1e5),
        "line_pressure_pa": np.tile(np.ravel(pressure_pa), len(torques)),
        "line_error_pa": np.full(each, 1e7),
        "line_half_width_m": np.full(each, 2e-4),
        "contact_position": position,
        "contact_tooth": np.zeros(steps, dtype=np.int64),
        "contact_point_m": points,
    }
