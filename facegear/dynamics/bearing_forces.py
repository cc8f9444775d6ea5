"""Forces on the bearings of every body: at rest, and over the response at one speed."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.steady_state.simulate import Model, SteadyState
from facegear.dynamics.steady_state.statistics import moments
from facegear.transmission.layout import DOF_PER_BODY
from facegear.transmission.linear_bearings import linear_bearings
from facegear.transmission.matrices import bearing_matrix
from facegear.transmission.statics import static_bearing_forces

Array = NDArray[np.float64]
DIRECTIONS = ("x", "y", "z", "radial")
BEARING_COLUMNS = (
    "body",
    "direction",
    "static_n",
    "mean_n",
    "rms_n",
    "ac_rms_n",
    "ac_rms_interval_n",
    "peak_n",
    "class",
)


def bearing_history(model: Model, response: SteadyState) -> Array:
    """Force of every body on its bearing along x, y, z, shape (K, bodies, 3), N: K q + beta K q'.

    Springs and their damping, equation (21); mass damping acts from outside and is no bearing's. A bearing
    with play is the spring that the dynamics takes it for.
    """
    layout, held = linear_bearings(model.machine)
    moved = response.coordinates + model.machine.damping.bearing * velocities(response)
    bodies = len(layout.bodies)
    stiffness = bearing_matrix(layout)[:, : DOF_PER_BODY * bodies]
    forces = moved @ (model.reduced.basis.T @ stiffness) - held[: DOF_PER_BODY * bodies]
    return forces.reshape(len(forces), bodies, DOF_PER_BODY)[..., :3]


def velocities(response: SteadyState) -> Array:
    """Time derivatives of the coordinates (K, n), 1/s, from cubic splines through the samples."""
    time = np.arange(len(response.coordinates) + 1) * TAU / (response.frequency * response.per_period)
    if response.period > 0:
        closed = np.concatenate([response.coordinates, response.coordinates[:1]])
        return CubicSpline(time, closed, bc_type="periodic")(time[:-1], 1)
    return CubicSpline(time[:-1], response.coordinates)(time[:-1], 1)


def bearing_table(model: Model, response: SteadyState) -> pd.DataFrame:
    """BEARING_COLUMNS, four rows a body: along x, y, z, and the magnitude of x and y together.

    static: at rest under the mean torques; peak: the largest magnitude of the samples; interval: 95 %
    half-width, 0 for a periodic motion. A pinion's x is tangential and y along the gears' axis, both radial
    for its bearing; a face gear's axis is z.
    """
    layout = model.machine.layout
    moving = _with_radial(bearing_history(model, response))
    static = _with_radial(static_bearing_forces(model.machine)[None])[0]
    found = moments(moving.reshape(len(moving), -1), response.per_period, response.period > 0)
    names = [(body, direction) for body in layout.body_names for direction in DIRECTIONS]
    table = pd.DataFrame(names, columns=["body", "direction"])
    values = (
        static.ravel(),
        found.mean,
        found.rms,
        found.ac_rms,
        found.ac_rms_interval,
        np.maximum(np.abs(found.least), np.abs(found.most)),
    )
    for column, value in zip(BEARING_COLUMNS[2:-1], values, strict=True):
        table[column] = value
    return table.assign(**{"class": response.label})


def _with_radial(forces: Array) -> Array:
    """Forces (K, bodies, 3) with their radial magnitude as a fourth."""
    return np.concatenate([forces, np.hypot(forces[..., :1], forces[..., 1:2])], axis=-1)
